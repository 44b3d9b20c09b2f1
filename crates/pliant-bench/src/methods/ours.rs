//! pliant, in any configuration and precision: what a user of the library would write.

use crate::method::{Counters, Method, Pair};
use crate::motion::{BodyMesh, Shape};
use pliant::{BodyId, Options, Scalar, Selection, World};

/// A world of the library, of either precision.
pub struct Ours<S: Scalar = f32> {
    name: String,
    world: World<S>,
    bodies: Vec<BodyId>,
    /// Whether boxes are made at every step, also of bodies that meet nobody.
    always: bool,
    /// Positions in the world's precision, if it is another.
    positions: Vec<[S; 3]>,
    pairs: Vec<Pair>,
    counters: Counters,
    /// The margin round each element, of those who are asked what is near.
    radius: f64,
    /// How far elements may be apart, of those who are asked which are close.
    distance: Option<f64>,
}

/// How shapes come into a world of this precision.
trait Precision: Scalar {
    /// The positions themselves, or as they are in `buffer`, if they have to be widened.
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
    /// The library with these options, under this name.
    pub fn new(name: &str, options: Options) -> Self {
        Self {
            name: name.to_owned(),
            world: World::with_options(options),
            bodies: Vec::new(),
            always: false,
            positions: Vec::new(),
            pairs: Vec::new(),
            counters: Counters::default(),
            radius: 0.0,
            distance: None,
        }
    }

    /// With a margin round each vertex, edge and triangle.
    #[must_use]
    pub fn within(self, radius: f64) -> Self {
        Self { radius, ..self }
    }

    /// Is asked for close pairs, at most so far apart.
    #[must_use]
    pub fn closer_than(self, distance: f64) -> Self {
        Self {
            distance: Some(distance),
            ..self
        }
    }

    /// Does at every step what the options say is done ahead of a query, whether or not a body meets another.
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

impl<S: Precision> Method for Ours<S> {
    fn name(&self) -> String {
        format!("{}: {:?}", self.name, self.world.options())
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        for body in bodies {
            self.bodies.push(
                self.world
                    .add(body.triangles, S::of(body.shape.world, &mut self.positions))
                    .expect("a scene's bodies are good"),
            );
        }
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        for (&body, shape) in self.bodies.iter().zip(shapes) {
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
        let (of, radius) = (Selection::Everything, self.radius);
        if let Some(distance) = self.distance {
            let found = self.world.close_vertex_triangle_pairs(of, distance).all();
            let found = found.expect("the whole world is there").iter();
            self.pairs.extend(found.map(|close| Pair::from(close.pair)));
            self.count();
            let found = self.world.close_edge_edge_pairs(of, distance).all();
            let found = found.expect("the whole world is there").iter();
            self.pairs.extend(found.map(|close| Pair::from(close.pair)));
            self.count();
            return Some(&self.pairs);
        }
        let found = self.world.vertex_triangle_candidates(of, radius).all();
        let found = found.expect("the whole world is there").iter();
        self.pairs.extend(found.copied().map(Pair::from));
        self.count();
        let found = self.world.edge_edge_candidates(of, radius).all();
        let found = found.expect("the whole world is there").iter();
        self.pairs.extend(found.copied().map(Pair::from));
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
