//! What happens when.

use super::change::{Change, Event};

/// What happens when, and how many vertices there are then.
pub(super) struct Timeline {
    /// Of each step the number of vertices of each body; before step 1 first.
    pub(super) counts: Vec<Vec<usize>>,
    /// Of each step.
    pub(super) events: Vec<Vec<Event>>,
}

impl Timeline {
    /// Of bodies with so many vertices, to which nothing happens.
    pub(super) fn new(vertices: Vec<usize>, steps: u32) -> Self {
        Self {
            counts: vec![vertices; steps as usize + 1],
            events: vec![Vec::new(); steps as usize],
        }
    }

    /// Something happens to a body in a step, after which it has so many vertices; nothing, if these changes are none.
    pub(super) fn edit(&mut self, step: u32, body: usize, changes: Vec<Change>, vertices: usize) {
        if changes.is_empty() {
            return;
        }
        self.events[step as usize - 1].push(Event::Edit { body, changes });
        for counts in &mut self.counts[step as usize..] {
            counts[body] = vertices;
        }
    }

    /// Two bodies become one in a step.
    pub(super) fn fuse(&mut self, step: u32, kept: usize, gone: usize) {
        self.events[step as usize - 1].push(Event::Fuse { kept, gone });
        for counts in &mut self.counts[step as usize..] {
            counts[kept] += counts[gone];
            counts[gone] = 0;
        }
    }
}
