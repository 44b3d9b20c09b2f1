//! pliant, in any configuration: what a user of the library would write.

use crate::method::{Counters, Method, Pair};
use crate::motion::{BodyMesh, Shape};
use pliant::{BodyId, Options, World};

/// A world of the library.
pub struct Ours {
    name: String,
    world: World<f32>,
    bodies: Vec<BodyId>,
    pairs: Vec<Pair>,
    counters: Counters,
}

impl Ours {
    /// The library with these options, under this name.
    pub fn new(name: &str, options: Options) -> Self {
        Self {
            name: name.to_owned(),
            world: World::with_options(options),
            bodies: Vec::new(),
            pairs: Vec::new(),
            counters: Counters::default(),
        }
    }

    fn count(&mut self) {
        let work = self.world.statistics();
        self.counters.boxes += work.boxes_bottom_up + work.boxes_top_down + work.triangle_boxes;
        self.counters.box_tests += work.node_pairs;
        self.counters.decisions += work.candidate_pairs;
    }
}

fn row(pair: pliant::Pair) -> Pair {
    [
        pair.body_a.0,
        pair.triangle_a,
        pair.body_b.0,
        pair.triangle_b,
    ]
}

impl Method for Ours {
    fn name(&self) -> String {
        format!("{}: {:?}", self.name, self.world.options())
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        for body in bodies {
            self.bodies.push(
                self.world
                    .add(body.triangles, body.shape.world)
                    .expect("a scene's bodies are good"),
            );
        }
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        for (&body, shape) in self.bodies.iter().zip(shapes) {
            self.world
                .set_positions(body, shape.world)
                .expect("a scene's shapes are good");
        }
    }

    fn all_pairs(&mut self) -> &[Pair] {
        self.pairs.clear();
        self.pairs
            .extend(self.world.intersection_pairs().iter().copied().map(row));
        self.count();
        &self.pairs
    }

    fn first_pair(&mut self) -> Option<Pair> {
        let pair = self.world.first_intersection().map(row);
        self.count();
        pair
    }

    fn self_pairs(&mut self) -> Option<&[Pair]> {
        self.pairs.clear();
        for place in 0..self.bodies.len() {
            let body = self.bodies[place];
            let pairs = self
                .world
                .self_intersection_pairs(body)
                .expect("the body is there");
            self.pairs
                .extend(pairs.iter().map(|&[a, b]| [body.0, a, body.0, b]));
            self.count();
        }
        Some(&self.pairs)
    }

    fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.counters)
    }
}
