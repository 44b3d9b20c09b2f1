//! Hints: the triangles that were nearest to points the last time, and are measured first.
//!
//! They bound distances from above, and decide nothing: with any hint the answer is the same. Each
//! body has the hints of its last question. They are of use if the next one has as many points.

use super::candidates::{Hint, Nearest};
use crate::held::{self, Held};
use crate::ids::BodyId;
use std::collections::BTreeMap;

/// Hints of a world's bodies, one for each point of the last question.
#[derive(Debug, Default)]
pub(crate) struct Hints(BTreeMap<BodyId, Vec<Option<Hint>>>);

impl Hints {
    /// Gives each point its hint, if the last question about the body had as many.
    pub(crate) fn give(&self, body: BodyId, nearest: &mut [Nearest]) {
        let known = self
            .0
            .get(&body)
            .filter(|known| known.len() == nearest.len());
        for (its, hint) in nearest.iter_mut().zip(known.into_iter().flatten()) {
            its.hint = *hint;
        }
    }

    /// Takes the hints for the next question.
    pub(crate) fn take(&mut self, body: BodyId, nearest: &[Nearest]) {
        let hint = |its: &Nearest| {
            let place = its.found.as_ref()?.place;
            let distance = its.limit;
            Some(Hint { place, distance })
        };
        let known = self.0.entry(body).or_default();
        known.clear();
        known.extend(nearest.iter().map(hint));
    }

    /// Forgets the hints about a body that is removed, or whose triangles have a new order.
    pub(crate) fn forget(&mut self, body: BodyId) {
        self.0.remove(&body);
    }
}

impl Held for Hints {
    fn held(&self) -> usize {
        let lists = self.0.values().map(held::list);
        lists.sum::<usize>() + held::entries::<(BodyId, Vec<Option<Hint>>)>(self.0.len())
    }
}
