//! Labels of a body's triangles, through edits and new orders.

use super::checks;
use crate::error::ErrorKind;
use crate::held::{self, Held};
use crate::labels::Labels;
use crate::mesh::{EMPTY, Elements, Order, Outcome};
use crate::queries::LabelPairs;

/// Labels of the triangles of a body, as the caller gave them, and what they leave out.
pub(crate) struct BodyLabels {
    of_triangles: Vec<u32>,
    neighbours: Option<Vec<[u32; 2]>>,
    /// In tree order, once known.
    pairs: Option<LabelPairs>,
}

impl BodyLabels {
    /// Takes labels over after checking that each of the triangles has one.
    pub(crate) fn new(labels: Labels, triangles: usize) -> Result<Self, ErrorKind> {
        checks::length("labels", triangles, labels.of_triangles.len())?;
        Ok(Self {
            of_triangles: labels.of_triangles.to_vec(),
            neighbours: labels.neighbours.map(<[_]>::to_vec),
            pairs: None,
        })
    }

    /// Labels as the caller gave them.
    pub(crate) fn callers(&self) -> Labels<'_> {
        Labels {
            of_triangles: &self.of_triangles,
            neighbours: self.neighbours.as_deref(),
        }
    }

    /// Copies the labels, not what tree order makes of them.
    pub(crate) fn copy(&self) -> Self {
        Self {
            of_triangles: self.of_triangles.clone(),
            neighbours: self.neighbours.clone(),
            pairs: None,
        }
    }

    /// Finds which pairs of triangles are left out, unless that is known.
    pub(crate) fn know(&mut self, triangles: &[[u32; 3]], order: &Order) {
        if self.pairs.is_none() {
            self.pairs = Some(LabelPairs::new(self.callers(), triangles, order));
        }
    }

    /// Finds which pairs of elements are left out, unless that is known.
    pub(crate) fn know_elements(
        &mut self,
        triangles: &[[u32; 3]],
        order: &Order,
        elements: &Elements,
    ) {
        self.know(triangles, order);
        if let Some(pairs) = &mut self.pairs {
            pairs.know_elements(triangles, order, elements);
        }
    }

    /// Pairs that are left out, if they are known.
    pub(crate) fn known(&self) -> Option<&LabelPairs> {
        self.pairs.as_ref()
    }

    /// Forgets tree order, because the mesh gets another one.
    pub(crate) fn forget_tree_order(&mut self) {
        self.pairs = None;
    }

    /// Updates the labels after an edit. New triangles have none; others keep theirs.
    pub(crate) fn follow<S>(&mut self, outcome: &Outcome<S>) {
        self.forget_tree_order();
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
