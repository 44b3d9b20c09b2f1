//! World face octree of Smith, Kitamura, Takemura and Kishino 1995.
//!
//! *A Simple and Efficient Method for Accurate Collision Detection among Deformable Polyhedral
//! Objects in Arbitrary Motion*. From step to step nothing is kept except memory, and only the
//! faces of a body are known. The paper calls it fast in easy cases, and slow where large regions
//! overlap.
//!
//! 1. A box around every body; brute force over pairs of bodies.
//! 2. The overlap of two boxes is a *region* of either body.
//! 3. A face is kept if its box meets a region of its body; with **clip** on, if the face itself
//!    does (`clip`).
//! 4. The kept faces go down an octree over the smallest cube around all regions. A cell with faces
//!    of two bodies is divided, down to **depth**. A face lies in every cell that its *box* meets
//!    (`octree`).
//! 5. In the deepest cells, faces of different bodies are compared: boxes, then triangles. A pair
//!    that meets in several cells is tested in one, with the lower corner of the overlap of the two
//!    boxes. Only this is newer than the method.
//!
//! | measure | what counts |
//! |---|---|
//! | update | steps 1 to 3, in [`step`](Method::step) |
//! | query | steps 4 and 5; there is no query of a body with itself |
//! | boxes | of faces in question, and cells |
//! | box tests | face against region, face against face |
//! | box tests | face against the cell in which it is handed down, once for all eight children |

mod clip;
mod octree;

use crate::decision::Decision;
use crate::method::{Counters, Method, Pair};
use crate::methods::aabb::Aabb;
use crate::methods::answer::{Answer, Wanted};
use crate::methods::bodies::Bodies;
use crate::methods::triangle_box::triangle_box;
use crate::motion::{BodyMesh, Shape};
use octree::{Face, Octree};

/// World face octree.
pub struct Smith {
    clip: bool,
    bodies: Bodies,
    /// Overlaps of a body's box with others, for each body.
    regions: Vec<Vec<Aabb>>,
    /// Kept faces, body after body.
    faces: Vec<Face>,
    octree: Octree,
    answer: Answer,
}

impl Smith {
    /// An octree down to `depth` divisions, with or without the clip.
    ///
    /// Cells a little larger than a face are best. For two spheres of 20,480 triangles the depth is
    /// 5, and one more for four times as many.
    ///
    /// # Panics
    ///
    /// If `depth` is more than 16.
    pub fn new(depth: u32, clip: bool, decision: Decision) -> Self {
        Self {
            clip,
            bodies: Bodies::default(),
            regions: Vec::new(),
            faces: Vec::new(),
            octree: Octree::new(depth),
            answer: Answer::new(decision),
        }
    }

    fn find_regions(&mut self) {
        self.regions.iter_mut().for_each(Vec::clear);
        let mut all = Aabb::EMPTY;
        for [a, b] in self.bodies.overlapping_pairs() {
            let overlap = self.bodies.boxes[a].overlap(&self.bodies.boxes[b]);
            self.regions[a].push(overlap);
            self.regions[b].push(overlap);
            all = all.merge(&overlap);
        }
        self.octree.cover(&all);
    }

    fn keep_faces(&mut self) {
        let counters = &mut self.answer.counters;
        self.faces.clear();
        for (body, regions) in self.regions.iter().enumerate() {
            if regions.is_empty() {
                continue;
            }
            let positions = &self.bodies.positions[body];
            let triangles = &self.bodies.triangles[body];
            counters.boxes += triangles.len() as u64;
            for (triangle, &corners) in (0..).zip(triangles) {
                let bounds = triangle_box(corners, positions);
                let meets = |region: &Aabb| {
                    counters.box_tests += 1;
                    region.overlaps(&bounds)
                        && (!self.clip
                            || region.merge(&bounds) == *region
                            || clip::meets(&self.bodies.corners(body, triangle), region))
                };
                if regions.iter().any(meets) {
                    self.faces.push(Face {
                        bounds,
                        body: body as u32,
                        triangle,
                    });
                }
            }
        }
    }

    fn query(&mut self, wanted: Wanted) {
        self.answer.begin(wanted);
        // Breaks when there are enough pairs.
        let _ = self
            .octree
            .descend(&self.faces, &self.bodies, &mut self.answer);
    }
}

impl Method for Smith {
    fn name(&self) -> String {
        let clip = if self.clip { "clip" } else { "no clip" };
        let depth = self.octree.depth();
        format!("Smith et al. (depth {depth}, cells by box, {clip})")
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        self.bodies = Bodies::build(bodies);
        self.regions = vec![Vec::new(); bodies.len()];
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        self.bodies.take_over(shapes);
        self.find_regions();
        self.keep_faces();
    }

    fn all_pairs(&mut self) -> &[Pair] {
        self.query(Wanted::All);
        self.answer.sorted()
    }

    fn first_pair(&mut self) -> Option<Pair> {
        self.query(Wanted::First);
        self.answer.first()
    }

    fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.answer.counters)
    }
}
