//! Every kind of query that the library's registry lists, called through one interface.

use pliant::{Error, Query, Scalar, Selection, World};
use std::fmt::{self, Debug, Write};
use std::hash::{DefaultHasher, Hasher};

/// A method of a world that asks for hits, by its name.
pub(super) struct AnyKind<S: Scalar> {
    pub(super) name: &'static str,
    /// Digest of the hits of a selection, within a length if the kind has one.
    pub(super) ask: fn(&mut World<S>, Selection, f64, Much) -> Result<Digest, Error>,
}

/// How much is wanted.
#[derive(Clone, Copy)]
pub(super) enum Much {
    All,
    First,
}

/// Number of hits in a list, and a hash over all their figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Digest(usize, u64);

/// Writer that hashes everything written to it.
struct Hash(DefaultHasher);

impl Write for Hash {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.write(text.as_bytes());
        Ok(())
    }
}

/// Digest of a query's hits, hashed as text: numbers with different bits have different texts.
fn digest<H: Copy + Debug>(query: Query<'_, H>, much: Much) -> Result<Digest, Error> {
    let first;
    let hits = match much {
        Much::All => query.all()?,
        Much::First => {
            first = query.first()?;
            first.as_slice()
        }
    };
    let mut hash = Hash(DefaultHasher::new());
    for hit in hits {
        // A hash takes every text.
        let _ = write!(hash, "{hit:?}");
    }
    Ok(Digest(hits.len(), hash.0.finish()))
}

macro_rules! list {
    ($($name:ident: $kept:ty => $($hit:ty: $method:ident($of:ident $(, $length:ident)?)),+;)*) => {
        /// The methods of every kind, in the order of the registry.
        pub(super) fn every_kind<S: Scalar>() -> Vec<AnyKind<S>> {
            vec![$($(AnyKind {
                name: stringify!($method),
                ask: |world, $of, within, much| {
                    // A kind without a length takes none of it.
                    let ($($length,)? ..) = (within,);
                    digest(world.$method($of $(, $length)?), much)
                },
            },)+)*]
        }
    };
}

pliant::every_kind! { list }
