//! Keys of one thread's hits, with as many bits as its largest numbers need; or the hits
//! themselves, where 63 bits are too few.

use super::hit::Hit;
use super::packing::Packing;
use crate::held::held;

/// Keys of hits, or the hits in place of them.
#[derive(Debug)]
pub(super) struct Keys<T> {
    pub(super) packing: Packing,
    pub(super) packed: Vec<u64>,
    /// Least and largest key.
    pub(super) extent: [u64; 2],
    hits: Vec<T>,
}

impl<T> Default for Keys<T> {
    fn default() -> Self {
        Self {
            packing: Packing::default(),
            packed: Vec::new(),
            extent: NOTHING,
            hits: Vec::new(),
        }
    }
}

/// Extent of an empty list of keys.
pub(super) const NOTHING: [u64; 2] = [u64::MAX, 0];

/// Union of two extents.
pub(super) fn both([a, b]: [u64; 2], [c, d]: [u64; 2]) -> [u64; 2] {
    [a.min(c), b.max(d)]
}

impl<T> Keys<T> {
    pub(super) fn clear(&mut self) {
        self.packing = Packing::default();
        self.packed.clear();
        self.extent = NOTHING;
        self.hits.clear();
    }
}

impl<T: Hit> Keys<T> {
    /// Appends hits.
    pub(super) fn push(&mut self, hits: &[T]) {
        self.pack(self.packing.with(hits));
        if self.packing.fits() {
            let (packing, before) = (self.packing, self.packed.len());
            let keys = hits.iter().map(|hit| packing.key(hit.numbers()));
            self.packed.extend(keys);
            let new = self.packed[before..].iter();
            self.extent = new.fold(self.extent, |extent, &key| both(extent, [key; 2]));
        } else {
            self.hits.extend_from_slice(hits);
        }
    }

    /// Repacks all keys with more bits, or turns them into hits if 63 bits are too few.
    pub(super) fn pack(&mut self, packing: Packing) {
        let old = std::mem::replace(&mut self.packing, packing);
        if packing == old {
            return;
        }
        if packing.fits() {
            for key in &mut self.packed {
                *key = packing.key(old.numbers(*key));
            }
            // Keys of more bits are in the same order.
            if !self.packed.is_empty() {
                self.extent = self.extent.map(|key| packing.key(old.numbers(key)));
            }
        } else if old.fits() {
            let keys = self.packed.drain(..);
            self.hits
                .extend(keys.map(|key| T::of_numbers(old.numbers(key))));
        }
    }

    /// Turns keys into hits, and moves all hits to the end of `others`.
    pub(super) fn unpack_to(&mut self, others: &mut Vec<T>) {
        self.pack(Packing::UNFIT);
        others.append(&mut self.hits);
    }
}

held!(Keys<T>: packed[], hits[]);
