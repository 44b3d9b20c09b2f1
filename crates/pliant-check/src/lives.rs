//! The lives of places: from which frame to which, and what each was where it was largest.
//!
//! However many frames there are, memory is bounded: of places that have ended those with the most pairs are kept, a thousand,
//! and the others are counted.

use crate::places::Place;
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// So many places that have ended are kept: nobody reads more.
pub(crate) const MOST_KEPT: usize = 1000;

/// A place, from its first frame to its last.
#[derive(Clone, Debug, PartialEq)]
pub struct Life {
    /// The first frame that has it.
    pub first_frame: usize,
    /// The last so far.
    pub last_frame: usize,
    /// The first frame in which it has the most pairs.
    pub worst_frame: usize,
    /// What it is there.
    pub worst: Place,
}

/// All places of a check.
#[derive(Debug, Default)]
pub struct Lives {
    /// Those of the last frame, by number.
    living: BTreeMap<usize, Life>,
    ended: Vec<Life>,
    /// How many places there were.
    count: usize,
}

impl Lives {
    /// None yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes the places of the next frame.
    pub fn take(&mut self, frame: usize, places: &[Place]) {
        let mut before = std::mem::take(&mut self.living);
        for place in places {
            let mut life = before.remove(&place.number).unwrap_or_else(|| {
                self.count += 1;
                Life {
                    first_frame: frame,
                    last_frame: frame,
                    worst_frame: frame,
                    worst: place.clone(),
                }
            });
            life.last_frame = frame;
            if place.count > life.worst.count {
                life.worst_frame = frame;
                life.worst = place.clone();
            }
            self.living.insert(place.number, life);
        }
        self.ended.extend(before.into_values());
        if self.ended.len() > 2 * MOST_KEPT {
            keep_largest(&mut self.ended);
        }
    }

    /// How many places there were so far.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The places so far, those with the most pairs in a frame first, of equally many the lower number first; of very
    /// many, a thousand.
    pub fn largest(&self) -> Vec<Life> {
        let mut all = self.ended.clone();
        all.extend(self.living.values().cloned());
        keep_largest(&mut all);
        all
    }
}

fn keep_largest(lives: &mut Vec<Life>) {
    lives.sort_unstable_by_key(|life| (Reverse(life.worst.count), life.worst.number));
    lives.truncate(MOST_KEPT);
}
