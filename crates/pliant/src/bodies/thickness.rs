//! Thickness of a body: of each vertex, and the largest.

use super::checks;
use super::per_vertex::PerVertex;
use crate::error::ErrorKind;
use crate::held::{self, Held};
use crate::mesh::{Order, Outcome};
use crate::queries::{Thickness, most};

/// Thickness of the vertices of a body.
#[derive(Default)]
pub(crate) struct BodyThickness {
    /// None where all is 0.
    of_vertices: Option<Box<PerVertex<f64, Thickness>>>,
    most: f64,
}

impl BodyThickness {
    pub(crate) fn copy(&self) -> Self {
        let all = self.of_vertices.as_ref();
        Self {
            of_vertices: all.map(|all| Box::new(all.copy())),
            ..*self
        }
    }

    /// Sets the thickness of every vertex. Refuses numbers that are negative or not finite.
    pub(crate) fn set(&mut self, all: &[f64], vertices: usize) -> Result<(), ErrorKind> {
        checks::length("thicknesses", vertices, all.len())?;
        let bad = |thickness: &f64| !(thickness.is_finite() && *thickness >= 0.0);
        if let Some(vertex) = all.iter().position(bad) {
            let thickness = all[vertex];
            return Err(ErrorKind::BadThickness { vertex, thickness });
        }
        self.most = most(all.iter().copied());
        self.of_vertices = (self.most > 0.0).then(|| Box::new(PerVertex::new(all)));
        Ok(())
    }

    /// Thickness of every vertex.
    pub(crate) fn all(&self, vertices: usize) -> Vec<f64> {
        let all = self.of_vertices.as_ref();
        all.map_or_else(|| vec![0.0; vertices], |all| all.callers().to_vec())
    }

    /// Largest thickness that a vertex has or had.
    #[inline]
    pub(crate) fn most(&self) -> f64 {
        self.most
    }

    /// Brings the thickness into tree order, unless it is in it. O(n).
    pub(crate) fn know(&mut self, order: &Order) {
        if let Some(all) = &mut self.of_vertices {
            all.know(|callers| Thickness::new(callers, order));
        }
    }

    /// Thickness in tree order, if there is any and it is known.
    pub(crate) fn known(&self) -> Option<&Thickness> {
        self.of_vertices.as_ref()?.known()
    }

    /// Forgets what is in tree order, because the mesh gets another order.
    pub(crate) fn forget_tree_order(&mut self) {
        if let Some(all) = &mut self.of_vertices {
            all.forget_tree_order();
        }
    }

    /// Updates the thickness after an edit. A vertex that was split from another is as thick as
    /// that; other new ones have the largest thickness.
    pub(crate) fn follow<S: Copy>(&mut self, outcome: &Outcome<S>) {
        if let Some(all) = &mut self.of_vertices {
            all.follow(outcome, |_| self.most);
        }
    }

    /// Gives all vertices of another mesh the largest thickness.
    pub(crate) fn spread(&mut self, vertices: usize) {
        if let Some(all) = &mut self.of_vertices {
            **all = PerVertex::new(&vec![self.most; vertices]);
        }
    }
}

impl Held for BodyThickness {
    fn held(&self) -> usize {
        held::boxes(&self.of_vertices)
    }
}
