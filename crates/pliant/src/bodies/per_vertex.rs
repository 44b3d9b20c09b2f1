//! Values that the caller gives the vertices of a body, and their form in tree order once known.

use crate::held::{Held, plain};
use crate::mesh::Outcome;

/// Values of type `C` in the caller's order, and what tree order makes of them.
pub(super) struct PerVertex<C, T> {
    callers: Vec<C>,
    in_order: Option<T>,
}

impl<C: Copy + Default, T> PerVertex<C, T> {
    pub(super) fn new(values: &[C]) -> Self {
        Self {
            callers: values.to_vec(),
            in_order: None,
        }
    }

    /// Values in the caller's order.
    pub(super) fn callers(&self) -> &[C] {
        &self.callers
    }

    /// Copies the values, not what tree order makes of them.
    pub(super) fn copy(&self) -> Self {
        Self::new(&self.callers)
    }

    /// Brings the values into tree order, unless they are in it.
    pub(super) fn know(&mut self, bring: impl FnOnce(&[C]) -> T) {
        if self.in_order.is_none() {
            self.in_order = Some(bring(&self.callers));
        }
    }

    /// The values in tree order, if they are known.
    pub(super) fn known(&self) -> Option<&T> {
        self.in_order.as_ref()
    }

    /// Forgets tree order, because the mesh gets another one.
    pub(super) fn forget_tree_order(&mut self) {
        self.in_order = None;
    }

    /// Updates the values after an edit. A vertex that was split from another has its value, other
    /// new ones have what their position gives.
    pub(super) fn follow<S: Copy>(&mut self, outcome: &Outcome<S>, of_new: impl Fn([S; 3]) -> C) {
        self.forget_tree_order();
        // Values before the edit: a vertex that was split may have gone since, and its number may
        // be reused.
        let value = |&(vertex, position): &(u32, [S; 3])| {
            let from = outcome.split_from.get(&vertex);
            let value = from.map(|&from| self.callers[from as usize]);
            (vertex as usize, value.unwrap_or_else(|| of_new(position)))
        };
        let new: Vec<(usize, C)> = outcome.new_vertices.iter().map(value).collect();
        self.callers.resize(outcome.vertices, C::default());
        for (vertex, value) in new {
            self.callers[vertex] = value;
        }
    }
}

impl<C, T: Held> Held for PerVertex<C, T> {
    fn held(&self) -> usize {
        plain(&self.callers) + self.in_order.held()
    }
}
