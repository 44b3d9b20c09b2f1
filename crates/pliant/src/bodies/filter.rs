//! Collision filters of a body: membership and mask, environment, a loose box, groups of vertices.

use crate::error::ErrorKind;
use crate::geometry::Bounds;
use crate::held::{self, Held, held};
use crate::mesh::{Elements, Order, Outcome};
use crate::queries::Groups;

/// Filters of a body: which bodies it may meet, and which of its vertices may meet.
pub(crate) struct Filter<S> {
    membership: u32,
    mask: u32,
    environment: u32,
    loose: Option<Bounds<S>>,
    /// Collision groups of vertices. None where all vertices meet.
    groups: Option<Box<VertexGroups>>,
}

/// Groups of the caller's vertices, and of all elements in tree order once these are known.
struct VertexGroups {
    callers: Vec<u32>,
    of_elements: Option<Groups>,
}

impl VertexGroups {
    fn boxed(callers: &[u32]) -> Box<Self> {
        Box::new(Self {
            callers: callers.to_vec(),
            of_elements: None,
        })
    }
}

impl<S: Copy> Filter<S> {
    /// The filter that lets everything meet.
    pub(crate) const fn none() -> Self {
        Self {
            membership: u32::MAX,
            mask: u32::MAX,
            environment: 0,
            loose: None,
            groups: None,
        }
    }

    pub(crate) fn copy(&self) -> Self {
        let groups = self.groups.as_ref();
        Self {
            groups: groups.map(|groups| VertexGroups::boxed(&groups.callers)),
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
        if groups.len() != vertices {
            return Err(ErrorKind::WrongLength {
                what: "groups",
                expected: vertices,
                found: groups.len(),
            });
        }
        let is_any = groups.iter().any(|&group| group != 0);
        self.groups = is_any.then(|| VertexGroups::boxed(groups));
        Ok(())
    }

    /// Group of every vertex.
    pub(crate) fn groups(&self, vertices: usize) -> Vec<u32> {
        match &self.groups {
            None => vec![0; vertices],
            Some(groups) => groups.callers.clone(),
        }
    }

    /// Computes the groups of all elements, unless they are known or vertices have none.
    pub(crate) fn know_groups(&mut self, order: &Order, elements: &Elements) {
        if let Some(groups) = &mut self.groups
            && groups.of_elements.is_none()
        {
            groups.of_elements = Some(Groups::new(&groups.callers, order, elements));
        }
    }

    /// Groups of all elements, if they are known.
    pub(crate) fn known_groups(&self) -> Option<&Groups> {
        self.groups.as_ref()?.of_elements.as_ref()
    }

    /// Forgets the groups: all vertices meet.
    pub(crate) fn forget_groups(&mut self) {
        self.groups = None;
    }

    /// Forgets the groups of elements, because the mesh gets another order.
    pub(crate) fn forget_tree_order(&mut self) {
        if let Some(groups) = &mut self.groups {
            groups.of_elements = None;
        }
    }

    /// Updates the groups after an edit. A vertex that was split from another has its group, other
    /// new ones have none.
    pub(crate) fn follow(&mut self, outcome: &Outcome<S>) {
        self.forget_tree_order();
        let Some(groups) = &mut self.groups else {
            return;
        };
        // Groups before the edit: a vertex that was split may have gone since, and its number may
        // be reused.
        let group = |vertex: u32| {
            let from = outcome.split_from.get(&vertex);
            from.map_or(0, |&from| groups.callers[from as usize])
        };
        let new = outcome.new_vertices.iter();
        let new: Vec<(u32, u32)> = new.map(|&(vertex, _)| (vertex, group(vertex))).collect();
        groups.callers.resize(outcome.vertices, 0);
        for (vertex, group) in new {
            groups.callers[vertex as usize] = group;
        }
    }
}

held!(VertexGroups: callers[], of_elements);

impl<S> Held for Filter<S> {
    fn held(&self) -> usize {
        held::boxes(&self.groups)
    }
}
