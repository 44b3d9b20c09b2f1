//! Memory accounting: bytes of the heap that things hold, counted as capacity, used or not.
//!
//! Maps and sets do not say their capacity: it is estimated from their entries.

/// A thing that holds memory of the heap.
pub(crate) trait Held {
    /// Bytes of the heap, without the bytes of the thing itself.
    fn held(&self) -> usize;
}

/// Bytes of a list whose items hold none.
pub(crate) fn list<T>(list: &Vec<T>) -> usize {
    list.capacity() * size_of::<T>()
}

/// Bytes of a list and of what its items hold.
pub(crate) fn lists<T: Held>(things: &Vec<T>) -> usize {
    list(things) + within(things)
}

/// Bytes that things hold, without the things themselves.
pub(crate) fn within<'t, T: Held + 't>(things: impl IntoIterator<Item = &'t T>) -> usize {
    things.into_iter().map(Held::held).sum()
}

/// Bytes of boxed things, and of what they hold.
pub(crate) fn boxes<'t, T: Held + 't>(things: impl IntoIterator<Item = &'t Box<T>>) -> usize {
    let all = things.into_iter();
    all.map(|thing| size_of::<T>() + thing.held()).sum()
}

/// Estimated bytes of a B-tree with `count` entries, whose nodes are about two thirds full.
pub(crate) fn entries<T>(count: usize) -> usize {
    count * size_of::<T>() * 3 / 2
}

/// Bytes of a list of plain things, checked at compile time to hold none.
pub(crate) fn plain<T>(things: &Vec<T>) -> usize {
    const { assert!(!std::mem::needs_drop::<T>(), "these hold memory") };
    list(things)
}

/// Implements `Held` for a type, as the sum over its fields that hold memory.
///
/// A field with `[]` behind it is a list of plain things; any other implements `Held` itself.
/// Whatever no field says is a closure at the end.
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

/// Implements `Default` for a type, field by field, whatever its parameters are.
///
/// A derive would demand `Default` of the parameters, too.
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

// `Box` has no implementation: `held` called on a box counts what its content holds, without the
// bytes of the content itself.

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
