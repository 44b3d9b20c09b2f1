//! Labels of a body's triangles, through edits.

use super::checks;
use crate::error::ErrorKind;
use crate::held::{self, Held};
use crate::labels::Labels;
use crate::mesh::{EMPTY, Outcome};
use crate::queries::LabelPairs;

/// Labels of the triangles of a body, as the caller gave them, and what they leave out.
#[derive(Clone)]
pub(crate) struct BodyLabels {
    of_triangles: Vec<u32>,
    neighbours: Option<Vec<[u32; 2]>>,
    /// None after an edit, until a query asks.
    pairs: Option<LabelPairs>,
}

impl BodyLabels {
    /// Takes labels over after checking that each of the triangles has one. `vertices` is their
    /// count.
    pub(crate) fn new(
        labels: Labels,
        triangles: &[[u32; 3]],
        vertices: usize,
    ) -> Result<Self, ErrorKind> {
        checks::length("labels", triangles.len(), labels.of_triangles.len())?;
        Ok(Self {
            of_triangles: labels.of_triangles.to_vec(),
            neighbours: labels.neighbours.map(<[_]>::to_vec),
            pairs: Some(LabelPairs::new(labels, triangles, vertices)),
        })
    }

    /// Labels as the caller gave them.
    pub(crate) fn callers(&self) -> Labels<'_> {
        Labels {
            of_triangles: &self.of_triangles,
            neighbours: self.neighbours.as_deref(),
        }
    }

    /// Finds which pairs are left out, unless that is known.
    pub(crate) fn know(&mut self, triangles: &[[u32; 3]], vertices: usize) {
        if self.pairs.is_none() {
            self.pairs = Some(LabelPairs::new(self.callers(), triangles, vertices));
        }
    }

    /// Pairs that are left out, if they are known.
    pub(crate) fn known(&self) -> Option<&LabelPairs> {
        self.pairs.as_ref()
    }

    /// Updates the labels after an edit. New triangles have none; others keep theirs.
    pub(crate) fn follow<S>(&mut self, outcome: &Outcome<S>) {
        self.pairs = None;
        self.of_triangles.resize(outcome.triangles, Labels::NONE);
        let changed = outcome.changed.iter();
        for &(triangle, _) in changed.filter(|(_, [old, new])| [*old, *new].contains(&EMPTY)) {
            if let Some(label) = self.of_triangles.get_mut(triangle as usize) {
                *label = Labels::NONE;
            }
        }
    }
}

impl Held for BodyLabels {
    fn held(&self) -> usize {
        held::plain(&self.of_triangles)
            + self.neighbours.as_ref().map_or(0, held::plain)
            + self.pairs.held()
    }
}
