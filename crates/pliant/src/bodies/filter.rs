//! Collision filters of a body: membership and mask, environment, a loose box, groups of vertices,
//! a rest shape, labels of triangles.

use super::checks;
use super::labels::BodyLabels;
use super::per_vertex::PerVertex;
use crate::error::ErrorKind;
use crate::geometry::{Bounds, Points, Real};
use crate::held::{self, Held};
use crate::labels::Labels;
use crate::mesh::{Elements, Order, Outcome};
use crate::queries::{Groups, LabelPairs};

/// Filters of a body: which bodies it may meet, and which of its vertices may meet.
pub(crate) struct Filter<S> {
    membership: u32,
    mask: u32,
    environment: u32,
    loose: Option<Bounds<S>>,
    /// Collision groups of vertices. None where all vertices meet.
    groups: Option<Box<PerVertex<u32, Groups>>>,
    /// Rest shape, in which elements that are close do not count as close. None if all count.
    rest: Option<Box<PerVertex<[S; 3], Points<S>>>>,
    /// Labels of triangles, of which some pairs do not count as hits. None if all count.
    labels: Option<Box<BodyLabels>>,
}

impl<S: Real> Filter<S> {
    /// The filter that lets everything meet.
    pub(crate) const fn none() -> Self {
        Self {
            membership: u32::MAX,
            mask: u32::MAX,
            environment: 0,
            loose: None,
            groups: None,
            rest: None,
            labels: None,
        }
    }

    pub(crate) fn copy(&self) -> Self {
        Self {
            groups: self.groups.as_ref().map(|groups| Box::new(groups.copy())),
            rest: self.rest.as_ref().map(|rest| Box::new(rest.copy())),
            labels: self.labels.clone(),
            ..*self
        }
    }

    pub(crate) fn set_masks(&mut self, membership: u32, mask: u32) {
        (self.membership, self.mask) = (membership, mask);
    }

    /// Membership and mask.
    pub(crate) fn masks(&self) -> (u32, u32) {
        (self.membership, self.mask)
    }

    pub(crate) fn set_environment(&mut self, environment: u32) {
        self.environment = environment;
    }

    pub(crate) fn environment(&self) -> u32 {
        self.environment
    }

    /// Whether two bodies may meet: they are in one environment, and each membership shares a bit
    /// with the other mask.
    pub(crate) fn lets_meet(&self, other: &Self) -> bool {
        self.environment == other.environment
            && self.membership & other.mask != 0
            && other.membership & self.mask != 0
    }

    /// Loose box, which holds every pose, if there is one.
    pub(crate) fn loose(&self) -> Option<Bounds<S>> {
        self.loose
    }

    /// Sets the loose box, which was checked, or removes it.
    pub(crate) fn set_loose(&mut self, loose: Option<Bounds<S>>) {
        self.loose = loose;
    }

    /// Gives every vertex a group. Vertices of one group do not meet, unless it is 0.
    pub(crate) fn set_groups(&mut self, groups: &[u32], vertices: usize) -> Result<(), ErrorKind> {
        checks::length("groups", vertices, groups.len())?;
        let is_any = groups.iter().any(|&group| group != 0);
        self.groups = is_any.then(|| Box::new(PerVertex::new(groups)));
        Ok(())
    }

    /// Group of every vertex.
    pub(crate) fn groups(&self, vertices: usize) -> Vec<u32> {
        match &self.groups {
            None => vec![0; vertices],
            Some(groups) => groups.callers().to_vec(),
        }
    }

    /// Computes the groups of all elements, unless they are known or vertices have none.
    pub(crate) fn know_groups(&mut self, order: &Order, elements: &Elements) {
        if let Some(groups) = &mut self.groups {
            groups.know(|callers| Groups::new(callers, order, elements));
        }
    }

    /// Groups of all elements, if they are known.
    pub(crate) fn known_groups(&self) -> Option<&Groups> {
        self.groups.as_ref()?.known()
    }

    /// Sets the rest shape, which was checked, or removes it.
    pub(crate) fn set_rest(&mut self, rest: Option<&[[S; 3]]>) {
        self.rest = rest.map(|rest| Box::new(PerVertex::new(rest)));
    }

    /// Rest shape in the caller's order.
    pub(crate) fn rest(&self) -> Option<&[[S; 3]]> {
        self.rest.as_ref().map(|rest| rest.callers())
    }

    /// Brings the rest shape into tree order, unless it is in it. O(n).
    pub(crate) fn know_rest(&mut self, order: &Order) {
        if let Some(rest) = &mut self.rest {
            let in_order = order.vertex_order().iter();
            rest.know(|callers| Points::of(in_order.map(|&vertex| callers[vertex as usize])));
        }
    }

    /// Rest shape in tree order, if there is one and it is known.
    pub(crate) fn known_rest(&self) -> Option<&Points<S>> {
        self.rest.as_ref()?.known()
    }

    /// Sets the label of every triangle, or takes all away.
    pub(crate) fn set_labels(
        &mut self,
        labels: Option<Labels>,
        triangles: &[[u32; 3]],
        vertices: usize,
    ) -> Result<(), ErrorKind> {
        let labels = labels.map(|labels| BodyLabels::new(labels, triangles, vertices));
        self.labels = labels.transpose()?.map(Box::new);
        Ok(())
    }

    /// Labels of triangles as the caller gave them.
    pub(crate) fn labels(&self) -> Option<Labels<'_>> {
        self.labels.as_ref().map(|labels| labels.callers())
    }

    /// Finds which pairs labels leave out, unless that is known.
    pub(crate) fn know_labels(&mut self, triangles: &[[u32; 3]], vertices: usize) {
        if let Some(labels) = &mut self.labels {
            labels.know(triangles, vertices);
        }
    }

    /// Pairs that labels leave out, if there are labels and they are known.
    pub(crate) fn known_labels(&self) -> Option<&LabelPairs> {
        self.labels.as_ref()?.known()
    }

    /// Forgets what vertices and triangles were given, because the mesh is another: all meet.
    pub(crate) fn forget_elements(&mut self) {
        (self.groups, self.rest, self.labels) = (None, None, None);
    }

    /// Forgets what is in tree order, because the mesh gets another order.
    pub(crate) fn forget_tree_order(&mut self) {
        if let Some(groups) = &mut self.groups {
            groups.forget_tree_order();
        }
        if let Some(rest) = &mut self.rest {
            rest.forget_tree_order();
        }
    }

    /// Updates groups, rest shape and labels after an edit. A vertex that was split from another
    /// has its group and place; other new ones have no group, and rest where they were put.
    pub(crate) fn follow(&mut self, outcome: &Outcome<S>) {
        if let Some(groups) = &mut self.groups {
            groups.follow(outcome, |_| 0);
        }
        if let Some(rest) = &mut self.rest {
            rest.follow(outcome, |position| position);
        }
        if let Some(labels) = &mut self.labels {
            labels.follow(outcome);
        }
    }
}

impl<S> Held for Filter<S> {
    fn held(&self) -> usize {
        held::boxes(&self.groups) + held::boxes(&self.rest) + held::boxes(&self.labels)
    }
}
