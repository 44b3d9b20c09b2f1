//! Lives of places: first frame, last frame, and the place when it was largest.
//!
//! Memory is bounded for any number of frames. Of ended places the thousand with the most pairs are
//! kept, the others only counted.

use crate::places::Place;
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// Most ended places that are kept; nobody reads more.
pub(crate) const MOST_KEPT: usize = 1000;

/// The life of a place, from its first frame to its last.
#[derive(Clone, Debug, PartialEq)]
pub struct Life {
    /// First frame with the place.
    pub first_frame: usize,
    /// Last frame so far with the place.
    pub last_frame: usize,
    /// First frame in which the place has its most pairs.
    pub worst_frame: usize,
    /// The place in `worst_frame`.
    pub worst: Place,
}

/// Lives of all places of a check.
#[derive(Debug, Default)]
pub struct Lives {
    /// Places of the last frame, by number.
    living: BTreeMap<usize, Life>,
    ended: Vec<Life>,
    /// Number of places so far, kept or not.
    count: usize,
}

impl Lives {
    /// Without any places.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes the places of the next frame. O(p log p) for p places, amortised.
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

    /// Number of places so far.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Lives of the places so far, at most a thousand, the most pairs in a frame first.
    ///
    /// Of equally many pairs, the lower number is first.
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
