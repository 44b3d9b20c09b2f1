//! pliant in any configuration and precision, called as a user of the library would.

use crate::method::{Counters, Method, Pair};
use crate::motion::{BodyMesh, Shape};
use pliant::{BodyId, Edit, Impact, Options, Scalar, Selection, World};
use pliant_scenes::{Change, ChangingMesh, Event};
use std::ops::ControlFlow;

/// A world of the library, of either precision.
pub struct Ours<S: Scalar = f32> {
    name: String,
    world: World<S>,
    bodies: Vec<BodyId>,
    /// Whether every step begins with fresh trees, whose building is not timed.
    builds_anew: bool,
    /// Whether boxes are made at every step, also of bodies that meet nobody.
    always: bool,
    /// Positions in the world's precision, where that is not `f32`.
    positions: Vec<[S; 3]>,
    pairs: Vec<Pair>,
    counters: Counters,
    /// Query about vertices, edges and triangles.
    asked: Asked,
}

/// Queries that a world can be asked about its elements.
#[derive(Clone, Copy, Debug)]
enum Asked {
    /// Candidates, with this margin round each element.
    Candidates(f64),
    /// Number of candidates, with this margin round each element.
    Count(f64),
    /// Close pairs, at most this far apart.
    ClosePairs(f64),
    /// Impacts during the motion.
    Impacts,
    /// First impact during the motion.
    FirstImpact,
    /// Intersecting triangles, of all bodies and of each with itself.
    Intersections,
}

/// Width of the intervals that locate impacts, as a fraction of the motion.
const WIDTH: f64 = 1e-6;

/// A precision, and the conversion of shapes into it.
pub trait Precision: Scalar {
    /// Positions in this precision: themselves, or widened into `buffer`.
    fn of<'p>(positions: &'p [[f32; 3]], buffer: &'p mut Vec<[Self; 3]>) -> &'p [[Self; 3]];
}

impl Precision for f32 {
    fn of<'p>(positions: &'p [[f32; 3]], _: &'p mut Vec<[f32; 3]>) -> &'p [[f32; 3]] {
        positions
    }
}

impl Precision for f64 {
    fn of<'p>(positions: &'p [[f32; 3]], buffer: &'p mut Vec<[f64; 3]>) -> &'p [[f64; 3]] {
        buffer.clear();
        buffer.extend(positions.iter().map(|point| point.map(f64::from)));
        buffer
    }
}

impl<S: Scalar> Ours<S> {
    /// The library with these options, under this name in tables.
    pub fn new(name: &str, options: Options) -> Self {
        Self {
            name: name.to_owned(),
            world: World::with_options(options),
            bodies: Vec::new(),
            builds_anew: false,
            always: false,
            positions: Vec::new(),
            pairs: Vec::new(),
            counters: Counters::default(),
            asked: Asked::Candidates(0.0),
        }
    }

    /// Asks for candidates, with this margin round each element.
    #[must_use]
    pub fn within(self, radius: f64) -> Self {
        self.asked(Asked::Candidates(radius))
    }

    /// Counts candidates in a visitor.
    ///
    /// The only row is the number of vertices with triangles, of edges with edges, and two zeros.
    #[must_use]
    pub fn counting(self, radius: f64) -> Self {
        self.asked(Asked::Count(radius))
    }

    /// Asks for close pairs, at most this far apart.
    #[must_use]
    pub fn closer_than(self, distance: f64) -> Self {
        self.asked(Asked::ClosePairs(distance))
    }

    /// Asks for impacts during the motion.
    #[must_use]
    pub fn impacts(self) -> Self {
        self.asked(Asked::Impacts)
    }

    /// Asks for the first impact during the motion.
    #[must_use]
    pub fn first_impact(self) -> Self {
        self.asked(Asked::FirstImpact)
    }

    /// Asks for intersecting triangles where others are asked for candidates.
    #[must_use]
    pub fn intersections(self) -> Self {
        self.asked(Asked::Intersections)
    }

    fn asked(self, asked: Asked) -> Self {
        Self { asked, ..self }
    }

    /// Builds fresh trees before every query; that is not timed.
    #[must_use]
    pub fn fresh(self) -> Self {
        Self {
            builds_anew: true,
            ..self
        }
    }

    /// Updates every body at every step as far as the options say, whether or not it meets another.
    #[must_use]
    pub fn always(self) -> Self {
        Self {
            always: true,
            ..self
        }
    }

    fn count(&mut self) {
        let work = self.world.statistics();
        self.counters.boxes += work.boxes_bottom_up + work.boxes_top_down + work.triangle_boxes;
        self.counters.box_tests += work.node_pairs;
        self.counters.decisions += work.candidate_pairs;
    }
}

/// Adds one change to an edit. New vertices get their positions in `at`.
pub fn add_step<S: Scalar>(edit: &mut Edit<S>, change: &Change, at: &[[S; 3]]) {
    match change {
        Change::AddVertices(count) => {
            let first = edit.vertex_count();
            edit.add_vertices(&at[first..first + count]);
        }
        &Change::PlaceVertex(vertex) => edit.place_vertex(vertex, at[vertex as usize]),
        Change::SplitVertex { vertex, triangles } => {
            edit.split_vertex(*vertex, triangles);
        }
        &Change::MergeVertices { kept, gone } => edit.merge_vertices(kept, gone),
        Change::AddTriangles(triangles) => {
            edit.add_triangles(triangles);
        }
        &Change::SetTriangle { triangle, corners } => edit.set_triangle(triangle, corners),
        Change::RemoveTriangles(triangles) => edit.remove_triangles(triangles),
    }
}

impl<S: Precision> Method for Ours<S> {
    fn name(&self) -> String {
        format!("{}: {:?}", self.name, self.world.options())
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        self.world = World::with_options(*self.world.options());
        self.bodies.clear();
        for body in bodies {
            self.bodies.push(
                self.world
                    .add(body.triangles, S::of(body.shape.world, &mut self.positions))
                    .expect("a scene's bodies are good"),
            );
        }
    }

    fn change(&mut self, events: &[Event], shapes: &[Shape<'_>], _: &[ChangingMesh]) {
        for event in events {
            match event {
                Event::Edit { body, changes } => {
                    let at = S::of(shapes[*body].world, &mut self.positions);
                    let mut edit = self.world.edit(self.bodies[*body]).expect("it is there");
                    changes.iter().for_each(|it| add_step(&mut edit, it, at));
                    self.world.apply(&edit).expect("a scene's events are good");
                }
                Event::Fuse { kept, gone } => {
                    let [kept, gone] = [kept, gone].map(|&body| self.bodies[body]);
                    self.world.fuse(kept, gone).expect("both are there");
                }
            }
        }
    }

    fn untimed(&mut self) {
        if self.builds_anew {
            for &body in &self.bodies {
                // Bodies that were fused with others are gone.
                let _ = self.world.rebuild(body);
            }
            // Tables of neighbours are part of building.
            let prepared = self.world.intersections(Selection::Everything).prepare();
            prepared.expect("the whole world is there");
        }
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        for (&body, shape) in self.bodies.iter().zip(shapes) {
            if shape.world.is_empty() {
                continue;
            }
            self.world
                .set_positions(body, S::of(shape.world, &mut self.positions))
                .expect("a scene's shapes are good");
            if let Some(end) = shape.end {
                self.world
                    .set_motion(body, S::of(end, &mut self.positions))
                    .expect("a scene's shapes are good");
            }
            if self.always {
                let within = self.world.intersections(Selection::Within(body));
                within.prepare().expect("the body is there");
            }
        }
    }

    fn all_pairs(&mut self) -> &[Pair] {
        self.pairs.clear();
        let pairs = self.world.intersections(Selection::World).all();
        let pairs = pairs.expect("the whole world is there").iter();
        self.pairs.extend(pairs.copied().map(Pair::from));
        self.count();
        &self.pairs
    }

    fn first_pair(&mut self) -> Option<Pair> {
        let pair = self.world.intersections(Selection::World).first();
        let pair = pair.expect("the whole world is there").map(Pair::from);
        self.count();
        pair
    }

    fn self_pairs(&mut self) -> Option<&[Pair]> {
        self.pairs.clear();
        for place in 0..self.bodies.len() {
            let body = self.bodies[place];
            let pairs = self.world.intersections(Selection::Within(body)).all();
            let pairs = pairs.expect("the body is there").iter();
            self.pairs.extend(pairs.copied().map(Pair::from));
            self.count();
        }
        Some(&self.pairs)
    }

    fn candidates(&mut self) -> Option<&[Pair]> {
        self.pairs.clear();
        let of = Selection::Everything;
        let there = "the whole world is there";
        match self.asked {
            Asked::Candidates(radius) => {
                let found = self.world.vertex_triangle_candidates(of, radius).all();
                let found = found.expect(there).iter();
                self.pairs.extend(found.copied().map(Pair::from));
                self.count();
                let found = self.world.edge_edge_candidates(of, radius).all();
                let found = found.expect(there).iter();
                self.pairs.extend(found.copied().map(Pair::from));
            }
            Asked::Count(radius) => {
                let mut counts = [0; 2];
                let found = self.world.vertex_triangle_candidates(of, radius);
                let seen = found.visit_some(|some| {
                    counts[0] += some.len() as u32;
                    ControlFlow::<()>::Continue(())
                });
                let _ = seen.expect(there);
                self.count();
                let found = self.world.edge_edge_candidates(of, radius);
                let seen = found.visit_some(|some| {
                    counts[1] += some.len() as u32;
                    ControlFlow::<()>::Continue(())
                });
                let _ = seen.expect(there);
                self.pairs.push([counts[0], counts[1], 0, 0]);
            }
            Asked::ClosePairs(distance) => {
                let found = self.world.close_vertex_triangle_pairs(of, distance).all();
                let found = found.expect(there).iter();
                self.pairs.extend(found.map(|close| Pair::from(close.pair)));
                self.count();
                let found = self.world.close_edge_edge_pairs(of, distance).all();
                let found = found.expect(there).iter();
                self.pairs.extend(found.map(|close| Pair::from(close.pair)));
            }
            Asked::Impacts => {
                let found = self.world.vertex_triangle_impacts(of).width(WIDTH).all();
                let found = found.expect(there).iter();
                self.pairs
                    .extend(found.map(|impact| Pair::from(impact.pair)));
                self.count();
                let found = self.world.edge_edge_impacts(of).width(WIDTH).all();
                let found = found.expect(there).iter();
                self.pairs
                    .extend(found.map(|impact| Pair::from(impact.pair)));
            }
            Asked::FirstImpact => {
                let first = self.world.first_impact(of, WIDTH).expect(there);
                self.pairs.extend(first.map(|impact| match impact {
                    Impact::VertexTriangle(impact) => Pair::from(impact.pair),
                    Impact::EdgeEdge(impact) => Pair::from(impact.pair),
                }));
            }
            Asked::Intersections => {
                let found = self.world.intersections(of).all();
                let found = found.expect(there).iter();
                self.pairs.extend(found.copied().map(Pair::from));
            }
        }
        self.count();
        Some(&self.pairs)
    }

    fn distance(&mut self) -> Option<f64> {
        let [a, b, ..] = self.bodies[..] else {
            return None;
        };
        let nearest = self.world.distance(a, b, f64::INFINITY);
        self.count();
        nearest.expect("both are there").map(|close| close.distance)
    }

    fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.counters)
    }
}
