//! Events of a scene by step.

use super::change::{Change, Event};

/// Events by step, and the numbers of vertices that they leave.
pub(super) struct Timeline {
    /// Numbers of vertices of each body, by step; index 0 is the beginning.
    pub(super) counts: Vec<Vec<usize>>,
    /// Events of each step, from step 1.
    pub(super) events: Vec<Vec<Event>>,
}

impl Timeline {
    /// A timeline without events, for bodies with these numbers of vertices.
    pub(super) fn new(vertices: Vec<usize>, steps: u32) -> Self {
        Self {
            counts: vec![vertices; steps as usize + 1],
            events: vec![Vec::new(); steps as usize],
        }
    }

    /// Adds changes of a body in a step, after which it has `vertices` vertices.
    ///
    /// Does nothing if there are no changes.
    pub(super) fn edit(&mut self, step: u32, body: usize, changes: Vec<Change>, vertices: usize) {
        if changes.is_empty() {
            return;
        }
        self.events[step as usize - 1].push(Event::Edit { body, changes });
        for counts in &mut self.counts[step as usize..] {
            counts[body] = vertices;
        }
    }

    /// Adds the fusion of two bodies in a step.
    pub(super) fn fuse(&mut self, step: u32, kept: usize, gone: usize) {
        self.events[step as usize - 1].push(Event::Fuse { kept, gone });
        for counts in &mut self.counts[step as usize..] {
            counts[kept] += counts[gone];
            counts[gone] = 0;
        }
    }
}
