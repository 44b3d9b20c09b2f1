//! Contacts as callers get them: two triangles that intersect, and how.

use crate::queries::Pair;
use crate::sort::Numbered;
/// Kind of a contact: crossing, overlapping, or only touching.
///
#[doc = include_str!("../../../pictures/contacts.svg")]
///
pub use pliant_exact::ContactKind;

/// Two triangles that intersect, and the kind of their contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Contact {
    /// The two triangles.
    pub pair: Pair,
    /// Kind of contact: how they intersect.
    pub kind: ContactKind,
}

impl From<Contact> for Pair {
    fn from(contact: Contact) -> Self {
        contact.pair
    }
}

impl Numbered for Contact {
    #[inline]
    fn numbers(&self) -> [u32; 4] {
        self.pair.numbers()
    }
}
