//! How much memory things hold: bytes of the heap, counted from what lists have room for, used or not.
//!
//! Maps and sets do not say what they have room for: they are reckoned by their entries.

/// What holds memory.
pub(crate) trait Held {
    /// Bytes of the heap, without those of the thing itself.
    fn held(&self) -> usize;
}

/// Of a list of things that hold none.
pub(crate) fn list<T>(list: &Vec<T>) -> usize {
    list.capacity() * size_of::<T>()
}

/// Of a list of things that hold some.
pub(crate) fn lists<T: Held>(things: &Vec<T>) -> usize {
    list(things) + within(things)
}

/// Of things, without those of the things themselves.
pub(crate) fn within<'t, T: Held + 't>(things: impl IntoIterator<Item = &'t T>) -> usize {
    things.into_iter().map(Held::held).sum()
}

/// Of things in boxes, and the things themselves.
pub(crate) fn boxes<'t, T: Held + 't>(things: impl IntoIterator<Item = &'t Box<T>>) -> usize {
    let all = things.into_iter();
    all.map(|thing| size_of::<T>() + thing.held()).sum()
}

/// Of so many entries in a tree of them, whose nodes are two thirds full, about.
pub(crate) fn entries<T>(count: usize) -> usize {
    count * size_of::<T>() * 3 / 2
}

/// Bytes of a list of plain things; the compiler sees that they hold none.
pub(crate) fn plain<T>(things: &Vec<T>) -> usize {
    const { assert!(!std::mem::needs_drop::<T>(), "these hold memory") };
    list(things)
}

/// Implements `Held` for a type: the sum over those of its fields that hold memory.
///
/// A field with `[]` behind it is a list of plain things; any other is `Held` itself.
/// What no field says is a closure at the end.
macro_rules! held {
    (@$this:ident $field:tt []) => {
        $crate::held::plain(&$this.$field)
    };
    (@$this:ident $field:tt) => {
        $crate::held::Held::held(&$this.$field)
    };
    (
        $name:ident $(<$parameter:ident $(: $bound:ident)?>)?:
        $($field:tt $([$($nothing:tt)?])?),+ $(; |$it:ident| $more:expr)?
    ) => {
        impl $(<$parameter $(: $bound)?>)? $crate::held::Held for $name $(<$parameter>)? {
            fn held(&self) -> usize {
                let this = self;
                $(let $it = self;)?
                0 $(+ $crate::held::held!(@this $field $([$($nothing)?])?))+ $(+ $more)?
            }
        }
    };
}
pub(crate) use held;

/// Implements `Default` for a type by that of every field, whatever its parameters are: a derive
/// would ask it of these, too.
macro_rules! empty {
    ($name:ident<$parameter:ident $(: $bound:ident)?>: $($field:ident),+) => {
        impl<$parameter $(: $bound)?> Default for $name<$parameter> {
            fn default() -> Self {
                Self {
                    $($field: Default::default(),)+
                }
            }
        }
    };
}
pub(crate) use empty;

impl Held for () {
    fn held(&self) -> usize {
        0
    }
}

// `Box` has no implementation: `held` called on a box is that of what is in it, without its bytes.

impl<T: Held> Held for Option<T> {
    fn held(&self) -> usize {
        within(self)
    }
}

impl<T: Held> Held for Vec<T> {
    fn held(&self) -> usize {
        lists(self)
    }
}

impl<A: Held, B: Held> Held for (A, B) {
    fn held(&self) -> usize {
        self.0.held() + self.1.held()
    }
}

impl<T: Held, const LEN: usize> Held for [T; LEN] {
    fn held(&self) -> usize {
        within(self)
    }
}
