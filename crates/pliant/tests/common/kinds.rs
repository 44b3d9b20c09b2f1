//! Every kind of query in the library's registry, behind one interface.

use pliant::{Error, Query, Scalar, Selection, World};
use std::fmt::Debug;
use std::ops::ControlFlow;

/// How a query is run: all hits, the first, a visit, or preparation alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wanted {
    All,
    First,
    Visit,
    Prepare,
}

/// A method of `World` that asks for hits, with its name.
pub(crate) struct AnyKind<S: Scalar> {
    pub(crate) name: &'static str,
    /// Whether it takes a length: a margin or a distance.
    pub(crate) takes_length: bool,
    ask: fn(&mut World<S>, (Selection, f64), Wanted, &mut dyn FnMut(&dyn Debug)) -> Answer,
}

type Answer = Result<(), Error>;

impl<S: Scalar> AnyKind<S> {
    /// Calls `show` with every hit, which is borrowed for the call. Allocates nothing.
    pub(crate) fn show(
        &self,
        world: &mut World<S>,
        (of, length): (Selection, f64),
        wanted: Wanted,
        show: &mut dyn FnMut(&dyn Debug),
    ) -> Answer {
        (self.ask)(world, (of, length), wanted, show)
    }

    /// Hits as text. Two texts are equal only if all numbers in them are equal to the last bit.
    pub(crate) fn texts(
        &self,
        world: &mut World<S>,
        of: (Selection, f64),
        wanted: Wanted,
    ) -> Result<Vec<String>, Error> {
        let mut texts = Vec::new();
        self.show(world, of, wanted, &mut |hit| texts.push(format!("{hit:?}")))?;
        Ok(texts)
    }
}

fn ask<H: Copy + Debug>(
    query: Query<'_, H>,
    wanted: Wanted,
    show: &mut dyn FnMut(&dyn Debug),
) -> Answer {
    match wanted {
        Wanted::All => query.all()?.iter().for_each(|hit| show(hit)),
        Wanted::First => query.first()?.iter().for_each(|hit| show(hit)),
        Wanted::Visit => {
            let flow = query.visit(|hit| {
                show(&hit);
                ControlFlow::<()>::Continue(())
            })?;
            assert!(flow.is_continue());
        }
        Wanted::Prepare => query.prepare()?,
    }
    Ok(())
}

macro_rules! list {
    ($($name:ident: $kept:ty => $($hit:ty: $method:ident($of:ident $(, $length:ident)?)),+;)*) => {
        /// The methods of every kind, in the order of the registry.
        pub(crate) fn every_kind<S: Scalar>() -> Vec<AnyKind<S>> {
            vec![$($(AnyKind {
                name: stringify!($method),
                takes_length: !stringify!($($length)?).is_empty(),
                ask: |world, ($of, within), wanted, show| {
                    // A kind without a length takes none of it.
                    let ($($length,)? ..) = (within,);
                    ask(world.$method($of $(, $length)?), wanted, show)
                },
            },)+)*]
        }
    };
}

pliant::every_kind! { list }
