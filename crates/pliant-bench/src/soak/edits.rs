//! Random edits of a body's mesh, and their effect on what is known of it.
//!
//! A triangle may be empty, but no vertex ever is: no answer would tell.

use super::{Known, Soak, Wrong};
use pliant::Scalar;

/// The empty triangle, as the world reports it.
pub(super) const EMPTY: [u32; 3] = [u32::MAX; 3];

/// Most vertices that edits leave a body: none gets larger than the bodies of a parade.
const MOST_VERTICES: usize = 64;

impl<S: Scalar> Soak<S> {
    /// Mesh of a body, empty triangles included.
    pub(super) fn mesh<'a>(&'a self, body: &'a Known<S>) -> &'a [[u32; 3]] {
        let surface = &self.surfaces[body.surface].triangles;
        body.edited.as_deref().unwrap_or(surface)
    }

    /// Changes a few triangles of a random body: removes, restores, detaches or adds one each.
    pub(super) fn edit(&mut self) -> Result<(), Wrong> {
        let some = self.random.index(self.known.len());
        let mut mesh = self.mesh(&self.known[some]).to_vec();
        let mut positions = self.known[some].positions.clone();
        let id = self.known[some].id;
        let edit = self.world.edit(id);
        let mut edit = self.good("edit", edit)?;
        for _ in 0..=self.random.below(4) {
            let triangle = self.random.index(mesh.len());
            let corners = mesh[triangle];
            let stays = |vertex: &u32| {
                let mut others = mesh.iter().enumerate();
                others.any(|(other, it)| other != triangle && it.contains(vertex))
            };
            match self.random.below(4) {
                // Every vertex keeps another triangle.
                0 if corners != EMPTY => {
                    if corners.iter().all(stays) {
                        edit.remove_triangle(triangle as u32);
                        mesh[triangle] = EMPTY;
                    }
                }
                1 if corners != EMPTY && positions.len() < MOST_VERTICES => {
                    let vertex = corners[self.random.index(3)];
                    if stays(&vertex) {
                        let new = edit.split_vertex(vertex, &[triangle as u32]);
                        mesh[triangle] = corners.map(|it| if it == vertex { new } else { it });
                        positions.push(positions[vertex as usize]);
                    }
                }
                _ => {
                    // Corners of existing triangles, so that no vertex is left without.
                    let all: Vec<u32> = mesh
                        .iter()
                        .filter(|it| **it != EMPTY)
                        .flatten()
                        .copied()
                        .collect();
                    let corners = [(); 3].map(|()| all[self.random.index(all.len())]);
                    let new = mesh.len() as u32;
                    if mesh[triangle] == EMPTY {
                        edit.set_triangle(triangle as u32, corners);
                        mesh[triangle] = corners;
                    } else if mesh.len() < 2 * MOST_VERTICES {
                        assert_eq!(edit.add_triangle(corners), new, "behind all others");
                        mesh.push(corners);
                    }
                }
            }
        }
        if self.mesh(&self.known[some]) == mesh {
            return Ok(());
        }
        let applied = self.world.apply(&edit);
        self.good("apply", applied)?;
        let said = self.world.triangles(id);
        if self.good("triangles", said)? != mesh {
            return self.wrong(format!("{id} has not the triangles that it was given"));
        }
        let known = &mut self.known[some];
        (known.edited, known.positions, known.end) = (Some(mesh), positions, None);
        self.tally.edited += 1;
        Ok(())
    }
}
