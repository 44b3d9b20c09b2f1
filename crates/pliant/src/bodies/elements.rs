//! The edges of a body's mesh, who owns what, and groups of vertices.

use crate::error::ErrorKind;
use crate::held::{self, Held, held};
use crate::ids::TreeTriangle;
use crate::mesh::{Bits, Elements, Order, Outcome, Topology};
use crate::queries::Groups;
use std::sync::OnceLock;

/// The elements of a body's mesh: they are found out the first time that somebody asks.
#[derive(Default)]
pub(crate) struct BodyElements {
    known: OnceLock<Box<Elements>>,
    /// Whether somebody asked before the tree was exchanged, or another body was made like this one.
    were_known: bool,
    /// None where all vertices meet.
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

impl BodyElements {
    /// The same, of another body with this mesh. What was found out is found out again, but for numbers
    /// of edges that an edit has kept.
    pub(crate) fn copy(&self) -> Self {
        let groups = self.groups.as_ref();
        Self {
            known: self.edited(),
            were_known: self.have_numbers(),
            groups: groups.map(|groups| VertexGroups::boxed(&groups.callers)),
        }
    }

    /// The edges as they are numbered, if the mesh was edited since they were: these numbers stay.
    fn edited(&self) -> OnceLock<Box<Elements>> {
        let known = self.known.get().filter(|known| known.follows());
        known.map_or_else(OnceLock::new, |known| OnceLock::from(known.clone()))
    }

    /// Finds them out, unless they are known. Returns false if it was stopped.
    pub(crate) fn know(
        &mut self,
        topology: &Topology,
        order: &Order,
        stop: &dyn Fn() -> bool,
    ) -> bool {
        let Self { known, groups, .. } = self;
        if known.get().is_none() {
            let Some(new) = Elements::new(topology, order, stop) else {
                return false;
            };
            *known = OnceLock::from(Box::new(new));
        }
        if let (Some(known), Some(groups)) = (known.get(), groups)
            && groups.of_elements.is_none()
        {
            groups.of_elements = Some(Groups::new(&groups.callers, order, known));
        }
        true
    }

    /// The elements; they are found out the first time.
    pub(crate) fn get(&self, topology: &Topology, order: &Order) -> Option<&Elements> {
        self.known().or_else(|| {
            let new = Elements::new(topology, order, &|| false)?;
            Some(self.known.get_or_init(|| Box::new(new)))
        })
    }

    /// The elements, if they are known.
    pub(crate) fn known(&self) -> Option<&Elements> {
        self.known.get().map(Box::as_ref)
    }

    /// The same, to append to them.
    pub(crate) fn known_mut(&mut self) -> Option<&mut Elements> {
        self.known.get_mut().map(Box::as_mut)
    }

    /// Whether the edges have numbers that stay: from when somebody asks for them on.
    pub(crate) fn have_numbers(&self) -> bool {
        self.were_known || self.known.get().is_some()
    }

    /// Numbers the edges as those of another body with this mesh are. Returns false if they are not its
    /// edges, or have numbers already.
    pub(crate) fn number(
        &mut self,
        edges: &[[u32; 2]],
        topology: &Topology,
        order: &Order,
    ) -> bool {
        let is_new = !self.have_numbers() && self.get(topology, order).is_some();
        let known = self.known_mut();
        is_new && known.is_some_and(|known| known.renumber(edges, topology))
    }

    /// The mesh is going to be edited: finds out the edges if they have numbers that stay, which they
    /// do while they follow.
    pub(crate) fn begin_to_follow(&mut self, topology: &Topology, order: &Order) {
        if self.were_known {
            self.get(topology, order);
        }
        if let Some(known) = self.known_mut() {
            known.begin_to_follow(topology);
        }
    }

    /// The mesh has another order; these triangles in it were taken out, if it was edited.
    pub(crate) fn exchange_order(&mut self, order: &Order, gone: Option<&Bits>) {
        self.forget_groups_of_elements();
        self.were_known = self.have_numbers();
        match (self.known_mut(), gone) {
            (Some(known), Some(gone)) if known.follows() => {
                known.append(order, gone, TreeTriangle(0), 0);
            }
            _ => drop(self.known.take()),
        }
    }

    /// Gives every vertex a group; those of one group do not meet, unless it is 0.
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

    /// The group of every vertex, unless all meet.
    pub(crate) fn groups(&self) -> Option<&[u32]> {
        self.groups.as_ref().map(|groups| &groups.callers[..])
    }

    /// The groups of all elements, if these were made and vertices have groups.
    pub(crate) fn groups_of_elements(&self) -> Option<&Groups> {
        self.groups.as_ref()?.of_elements.as_ref()
    }

    /// All vertices meet.
    pub(crate) fn forget_groups(&mut self) {
        self.groups = None;
    }

    fn forget_groups_of_elements(&mut self) {
        if let Some(groups) = &mut self.groups {
            groups.of_elements = None;
        }
    }

    /// New vertices get the groups of those that they were split from, else none.
    pub(crate) fn change_groups<S>(&mut self, outcome: &Outcome<S>) {
        let Some(groups) = &mut self.groups else {
            return;
        };
        // Of vertices as they were before: one that was split may have gone since, and its number may be another's.
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
        groups.of_elements = None;
    }
}

held!(VertexGroups: callers[], of_elements);

impl Held for BodyElements {
    fn held(&self) -> usize {
        held::boxes(self.known.get()) + held::boxes(&self.groups)
    }
}
