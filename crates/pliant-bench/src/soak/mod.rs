//! Soak test: a long-lived world under random changes, compared with worlds built fresh.
//!
//! Hundreds of bodies are added, moved, teleported, filtered, rebuilt and removed. After a parade
//! the world holds the same bodies, and has done at least the same work, as after every earlier
//! parade. So memory counted there (by the example `soak`) should be equal: a difference is a leak.
//! Nothing here reads a clock or prints; the seed determines everything.
//!
//! | unit | content |
//! |---|---|
//! | step | bodies move: none, one, a few, all; some twice, some far away or out of loose boxes |
//! | | one other call: add, remove, rebuild, filter, ignore, loose box, motions, another mesh |
//! | | or a call that must be refused |
//! | | perhaps an edit of a mesh |
//! | | perhaps a query before, and one after |
//! | | once in eight steps: the comparison (`fresh`) |
//! | parade | every body goes, the same ones come and meet in one heap, all queries are asked |

mod edits;
mod fresh;
mod kinds;
mod random;
mod shapes;

use kinds::{Much, every_kind};
use pliant::{
    BodyId, CloseEdgeEdge, CloseTriangles, CloseVertexTriangle, EdgeEdge, EdgeEdgeImpact, Error,
    ErrorKind, Impact, Options, Pair, Scalar, Selection, VertexTriangle, VertexTriangleImpact,
    World,
};
use random::Random;
use shapes::Surface;
use std::ops::ControlFlow;

/// Range of the number of bodies: bodies come below it, and go above it.
const FEWEST: usize = 150;
const MOST: usize = 250;
/// Number of bodies of a parade.
const PARADE: usize = 200;
/// Side of the cube in which bodies live. Each meets a few others there.
const SIDE: f64 = 12.0;
/// Longest motion of one of many bodies, on each axis.
const SHIFT: f64 = 1.0 / 8.0;
/// Widest margin of candidates, and longest distance of close pairs, that is asked for.
const FAR_APART: f64 = 0.05;
const FAR_BUT_CLOSE: f64 = 0.02;

/// A wrong answer: the step, and the expectation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wrong(pub String);

impl std::fmt::Display for Wrong {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Wrong {}

/// Counts of what was done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Steps played.
    pub steps: u64,
    /// Bodies added, including the bodies of parades.
    pub added: u64,
    /// Bodies removed.
    pub removed: u64,
    /// Shapes set.
    pub moved: u64,
    /// Edits of meshes.
    pub edited: u64,
    /// Calls that were refused, as required.
    pub refused: u64,
    /// Comparisons with a fresh world.
    pub compared: u64,
    /// Pairs equal in both worlds, between bodies and within them.
    pub pairs: u64,
    /// Candidates equal in both worlds.
    pub near: u64,
    /// Close pairs equal in both worlds, with all figures.
    pub close: u64,
    /// Impacts equal in both worlds, with their times.
    pub met: u64,
    /// Distances of bodies equal in both worlds, except for rounding.
    pub distances: u64,
}

/// Data of a body, enough to build it anew.
struct Known<S> {
    id: BodyId,
    /// Original or last surface; and the mesh, if edits have changed it.
    surface: usize,
    edited: Option<Vec<[u32; 3]>>,
    place: [f64; 3],
    positions: Vec<[S; 3]>,
    /// Shape at the end of the motion, if it has one.
    end: Option<Vec<[S; 3]>>,
    membership: u32,
    mask: u32,
    environment: u32,
    loose: Option<([S; 3], [S; 3])>,
}

/// A long-lived world, and the data to build its like.
pub struct Soak<S: Scalar> {
    world: World<S>,
    /// Data of all bodies, in the order of ids.
    known: Vec<Known<S>>,
    ignored: Vec<(BodyId, BodyId)>,
    /// Ids that were removed last.
    gone: Vec<BodyId>,
    surfaces: Vec<Surface>,
    random: Random,
    /// Present offset of the cube.
    here: f64,
    /// Offset of the cube at other times, and of a body that is sent away alone.
    far: [f64; 2],
    convert: fn(f64) -> S,
    tally: Tally,
}

impl Soak<f32> {
    /// A world of 32-bit coordinates. Bodies are sent a long way away: boxes are exact everywhere.
    pub fn single(options: Options, seed: u64) -> Self {
        Self::new(options, seed, [1000.0, 1e30], |x| x as f32)
    }
}

impl Soak<f64> {
    /// A world of 64-bit coordinates, whose origin has to follow the bodies.
    pub fn double(options: Options, seed: u64) -> Self {
        Self::new(options, seed, [1e6, 1e4], |x| x)
    }
}

impl<S: Scalar> Soak<S> {
    fn new(options: Options, seed: u64, far: [f64; 2], convert: fn(f64) -> S) -> Self {
        Self {
            world: World::with_options(options),
            known: Vec::new(),
            ignored: Vec::new(),
            gone: Vec::new(),
            surfaces: shapes::surfaces(),
            random: Random::new(seed),
            here: 0.0,
            far,
            convert,
            tally: Tally::default(),
        }
    }

    /// Counts of what was done so far.
    pub fn tally(&self) -> Tally {
        self.tally
    }

    /// Number of bodies, and of their triangles.
    pub fn size(&self) -> [usize; 2] {
        let triangles = |body: &Known<S>| self.mesh(body).len();
        [self.known.len(), self.known.iter().map(triangles).sum()]
    }

    /// Plays one step.
    ///
    /// # Errors
    ///
    /// A wrong answer of the library.
    pub fn step(&mut self) -> Result<(), Wrong> {
        self.tally.steps += 1;
        while self.known.len() < FEWEST {
            self.add()?;
        }
        let moved = self.tally.moved;
        self.move_some()?;
        let still = moved == self.tally.moved;
        // Before and after the call: whatever is valid or found already must not outlive it.
        self.ask_something()?;
        self.call_something()?;
        if self.random.one_in(2) {
            self.edit()?;
        }
        self.ask_something()?;
        // Movement renews much. Without it, more can be stale.
        if self.random.one_in(if still { 3 } else { 12 }) {
            self.compare_with_a_fresh_world()?;
        }
        Ok(())
    }

    /// Replaces all bodies by the bodies of every parade, heaped up in one place, and asks every
    /// query.
    ///
    /// # Errors
    ///
    /// As [`step`](Self::step).
    pub fn parade(&mut self) -> Result<(), Wrong> {
        while !self.known.is_empty() {
            self.remove(0)?;
        }
        self.gone.clear();
        let random = std::mem::replace(&mut self.random, Random::new(0));
        self.here = 0.0;
        for number in 0..PARADE {
            let surface = number % self.surfaces.len();
            let place = [(); 3].map(|()| self.random.unit() * SIDE / 4.0);
            self.add_one(surface, place)?;
        }
        self.random = random;
        // All apart, all in one place, and back: the longest lists of bodies that may meet. Only
        // these lists matter here.
        for (apart, together) in [(4.0, 0.0), (0.0, 1.0), (0.0, 0.0)] {
            for number in 0..PARADE {
                let Known {
                    place, positions, ..
                } = &self.known[number];
                let shift = |axis: usize| apart * number as f64 - together * place[axis];
                let moved = |p: &[S; 3]| {
                    std::array::from_fn(|axis| (self.convert)(p[axis].to_f64() + shift(axis)))
                };
                let positions: Vec<[S; 3]> = positions.iter().map(moved).collect();
                self.take_over(number, &positions, true)?;
            }
            let prepared = self.world.intersections(Selection::World).prepare();
            self.good("prepare", prepared)?;
        }
        // The longest list of pairs of two bodies: the largest surface twice, in one point.
        let large = [0, self.surfaces.len()];
        let shapes = large.map(|place| self.known[place].positions.clone());
        for place in large {
            self.known[place].positions.fill([(self.convert)(1.0); 3]);
            let positions = self.known[place].positions.clone();
            self.take_over(place, &positions, false)?;
        }
        let [a, b] = large.map(|place| self.known[place].id);
        let every = self.world.intersections(Selection::Between(a, b)).all();
        let every = every.map(<[_]>::len);
        let triangles = self.surfaces[0].triangles.len();
        if self.good("a query", every)? != triangles * triangles {
            return self.wrong("in one point every pair of triangles meets");
        }
        // With all others, and each with itself. In random steps, single bodies are in one point
        // when they are very far away.
        let every = self.world.intersections(Selection::Everything).all();
        let every = every.map(<[_]>::len);
        self.good("a query", every)?;
        // Candidates along the longest motion. No step asks for a wider margin.
        for number in 0..PARADE {
            let end = self.shifted(number, [SHIFT / 2.0; 3]);
            let set = self.world.set_motion(self.known[number].id, &end);
            self.good("set_motion", set)?;
            self.known[number].end = Some(end);
        }
        for kind in every_kind::<S>() {
            let all = (kind.ask)(&mut self.world, Selection::Everything, FAR_APART, Much::All);
            self.good(kind.name, all)?;
        }
        let met = Met::of(&mut self.world, 1e-6, 0.0);
        self.good("what meets", met)?;
        self.compare_with_a_fresh_world()?;
        for (place, positions) in large.into_iter().zip(shapes) {
            self.take_over(place, &positions, false)?;
            self.known[place].positions = positions;
        }
        Ok(())
    }

    /// A random place in the cube.
    fn somewhere(&mut self) -> [f64; 3] {
        [(); 3].map(|()| self.here + self.random.unit() * SIDE)
    }

    /// A random shape of a surface at a place, in the world's precision.
    fn shape(&mut self, surface: usize, place: [f64; 3]) -> Vec<[S; 3]> {
        self.surfaces[surface]
            .somewhere(&mut self.random, place)
            .into_iter()
            .map(|position| position.map(self.convert))
            .collect()
    }

    /// A random shape of a body at a place. Vertices that edits added reuse positions of the
    /// surface.
    fn shape_of(&mut self, body: usize, place: [f64; 3]) -> Vec<[S; 3]> {
        let Known {
            surface, positions, ..
        } = &self.known[body];
        let (surface, count) = (*surface, positions.len());
        let shape = self.shape(surface, place);
        shape.iter().copied().cycle().take(count).collect()
    }

    fn add(&mut self) -> Result<(), Wrong> {
        let surface = self.random.index(self.surfaces.len());
        let place = self.somewhere();
        self.add_one(surface, place)
    }

    fn add_one(&mut self, surface: usize, place: [f64; 3]) -> Result<(), Wrong> {
        let positions = self.shape(surface, place);
        let added = self
            .world
            .add(&self.surfaces[surface].triangles, &positions);
        let id = self.good("add", added)?;
        if self.known.last().is_some_and(|last| last.id >= id) || self.gone.contains(&id) {
            return self.wrong(format!("{id} was given away before"));
        }
        self.tally.added += 1;
        self.known.push(Known {
            id,
            surface,
            edited: None,
            place,
            positions,
            end: None,
            membership: u32::MAX,
            mask: u32::MAX,
            environment: 0,
            loose: None,
        });
        Ok(())
    }

    fn remove(&mut self, place: usize) -> Result<(), Wrong> {
        let id = self.known.remove(place).id;
        let removed = self.world.remove(id);
        self.good("remove", removed)?;
        self.ignored.retain(|&(a, b)| a != id && b != id);
        self.gone.push(id);
        if self.gone.len() > 8 {
            self.gone.remove(0);
        }
        self.tally.removed += 1;
        Ok(())
    }

    fn move_some(&mut self) -> Result<(), Wrong> {
        // Now and then the whole cube is elsewhere.
        if self.random.one_in(100) {
            self.here = if self.here == 0.0 { self.far[0] } else { 0.0 };
        }
        let count = [0, 1, 1, 3, 10, self.known.len()][self.random.index(6)];
        for number in 0..count {
            // All bodies, or some, perhaps one of them twice.
            let body = if count == self.known.len() {
                number
            } else {
                self.random.index(self.known.len())
            };
            let place = match self.random.below(20) {
                0..10 => self.known[body]
                    .place
                    .map(|x| x + (self.random.unit() - 0.5) / 4.0),
                10..19 => self.somewhere(),
                _ if self.random.one_in(10) => [self.far[1] * self.random.unit(); 3],
                _ => self.known[body].place,
            };
            let positions = self.shape_of(body, place);
            let written = self.random.one_in(2);
            if self.take_over(body, &positions, written)? {
                self.known[body].place = place;
                self.known[body].positions = positions;
            }
        }
        Ok(())
    }

    /// Sets a shape in one of the two ways. Returns whether it was accepted, as it must be inside
    /// the loose box.
    fn take_over(
        &mut self,
        place: usize,
        positions: &[[S; 3]],
        written: bool,
    ) -> Result<bool, Wrong> {
        let id = self.known[place].id;
        let answer = if written {
            self.world
                .write_positions(id, |buffer| buffer.copy_from_slice(positions))
        } else {
            self.world.set_positions(id, positions)
        };
        self.is_held(place, positions, answer)
    }

    /// Whether a shape was accepted, as it must be unless it reaches out of the loose box.
    fn is_held(
        &mut self,
        place: usize,
        positions: &[[S; 3]],
        answer: Result<(), Error>,
    ) -> Result<bool, Wrong> {
        let Known { id, loose, .. } = self.known[place];
        let outside = loose.and_then(|corners| positions.iter().position(|&p| !inside(corners, p)));
        if let Some(vertex) = outside {
            return match answer {
                Err(Error {
                    body: Some(body),
                    kind: ErrorKind::OutsideLooseBox { vertex: said, .. },
                }) if (body, said) == (id, vertex) => {
                    self.tally.refused += 1;
                    Ok(false)
                }
                other => self.wrong(format!(
                    "vertex {vertex} of {id} is outside its loose box, and was answered {other:?}"
                )),
            };
        }
        self.good("take over", answer)?;
        self.known[place].end = None;
        self.tally.moved += 1;
        Ok(true)
    }

    /// Makes one call that is no movement.
    fn call_something(&mut self) -> Result<(), Wrong> {
        let some = self.random.index(self.known.len());
        let id = self.known[some].id;
        match self.random.below(22) {
            15..17 => self.cut(some),
            17..20 => self.begin_motions(),
            20 => self.end_motions(),
            0..3 if self.known.len() < MOST => self.add(),
            0..6 => self.remove(some),
            6 => {
                let rebuilt = self.world.rebuild(id);
                self.good("rebuild", rebuilt)
            }
            7 => {
                let mut bits = || match self.random.below(4) {
                    0 => 0,
                    1 => 1 << self.random.below(3) | 1 << self.random.below(3),
                    _ => u32::MAX,
                };
                let (membership, mask) = (bits(), bits());
                (self.known[some].membership, self.known[some].mask) = (membership, mask);
                let set = self.world.set_filter(id, membership, mask);
                self.good("set_filter", set)?;
                let environment = self.random.below(8) / 7;
                self.known[some].environment = environment;
                let set = self.world.set_environment(id, environment);
                self.good("set_environment", set)
            }
            8 => self.ignore_or_not(id),
            9..11 => self.hold_or_let_go(some),
            11..15 => self.ask_what_must_be_refused(some),
            _ => {
                for of in [Selection::Everything, Selection::Within(id)] {
                    let prepared = self.world.intersections(of).prepare();
                    self.good("prepare", prepared)?;
                }
                Ok(())
            }
        }
    }

    /// Gives some bodies motions. A body that would leave its loose box stays as it is.
    fn begin_motions(&mut self) -> Result<(), Wrong> {
        let count = [1, 3, self.known.len()][self.random.index(3)];
        for _ in 0..count {
            let some = self.random.index(self.known.len());
            let Known { id, place, .. } = self.known[some];
            // One body goes anywhere; many go a little, so that no step finds more than a parade.
            let end = if count == 1 {
                self.shape_of(some, place)
            } else {
                let by = [(); 3].map(|()| (self.random.unit() - 0.5) * SHIFT);
                self.shifted(some, by)
            };
            let answer = self.world.set_motion(id, &end);
            let Known { loose, .. } = self.known[some];
            if loose.is_some_and(|corners| end.iter().any(|&p| !inside(corners, p))) {
                self.tally.refused += 1;
                if answer.is_ok() {
                    return self.wrong(format!("{id} goes out of its loose box"));
                }
                continue;
            }
            self.good("set_motion", answer)?;
            self.known[some].end = Some(end);
        }
        Ok(())
    }

    /// Shape of a body, carried away.
    fn shifted(&self, some: usize, by: [f64; 3]) -> Vec<[S; 3]> {
        let carried =
            |p: &[S; 3]| std::array::from_fn(|axis| (self.convert)(p[axis].to_f64() + by[axis]));
        self.known[some].positions.iter().map(carried).collect()
    }

    /// Ends motions: bodies arrive, or stop on the way.
    fn end_motions(&mut self) -> Result<(), Wrong> {
        let part = self.random.unit();
        if self.random.one_in(2) {
            self.world.finish_motion();
            for known in &mut self.known {
                known.positions = known
                    .end
                    .take()
                    .unwrap_or(std::mem::take(&mut known.positions));
            }
            return Ok(());
        }
        let advanced = self.world.advance_motion(part);
        self.good("advance_motion", advanced)?;
        for place in 0..self.known.len() {
            let Some(end) = self.known[place].end.take() else {
                continue;
            };
            let id = self.known[place].id;
            let now = self.world.positions(id);
            let now = self.good("positions", now)?;
            let from = &self.known[place].positions;
            for ((now, from), end) in now.iter().zip(from).zip(&end) {
                for axis in 0..3 {
                    let [now, from, end] = [now, from, end].map(|it| it[axis].to_f64());
                    if !(from.min(end)..=from.max(end)).contains(&now) {
                        return self.wrong(format!("{id} is not on the way"));
                    }
                }
            }
            self.known[place].positions = now;
        }
        Ok(())
    }

    /// Gives a body the mesh of another surface, at its place. Refused if that reaches out of the
    /// loose box.
    fn cut(&mut self, some: usize) -> Result<(), Wrong> {
        let Known { id, place, .. } = self.known[some];
        let surface = self.random.index(self.surfaces.len());
        let positions = self.shape(surface, place);
        let triangles = &self.surfaces[surface].triangles;
        let set = self.world.set_mesh(id, triangles, &positions);
        if self.is_held(some, &positions, set)? {
            (self.known[some].surface, self.known[some].positions) = (surface, positions);
            self.known[some].edited = None;
        }
        Ok(())
    }

    fn ignore_or_not(&mut self, a: BodyId) -> Result<(), Wrong> {
        let b = self.known[self.random.index(self.known.len())].id;
        if a == b {
            return Ok(());
        }
        // Half the time an ignored pair is restored, named in either order.
        match self.ignored.len() {
            some @ 1.. if self.random.one_in(2) => {
                let (a, b) = self.ignored.swap_remove(self.random.index(some));
                self.ignored
                    .retain(|&pair| pair != (a, b) && pair != (b, a));
                let unignored = self.world.unignore(b, a);
                self.good("unignore", unignored)
            }
            _ => {
                self.ignored.push((a, b));
                let ignored = self.world.ignore(a, b);
                self.good("ignore", ignored)
            }
        }
    }

    /// Puts a body into a loose box, out of which later shapes may reach, or releases it.
    fn hold_or_let_go(&mut self, some: usize) -> Result<(), Wrong> {
        let Known {
            id, loose, place, ..
        } = self.known[some];
        let corners = loose.is_none().then(|| {
            let room = 1.0 + self.random.unit();
            let corner = |x: f64| (self.convert)(x);
            (
                place.map(|x| corner(x - room)),
                place.map(|x| corner(x + 1.0 + room)),
            )
        });
        let fits = corners.is_none_or(|corners| {
            let Known { positions, end, .. } = &self.known[some];
            let mut all = positions.iter().chain(end.iter().flatten());
            all.all(|&p| inside(corners, p))
        });
        let answer = self.world.set_loose_box(id, corners);
        if fits {
            self.known[some].loose = corners;
            return self.good("set_loose_box", answer);
        }
        self.tally.refused += 1;
        match answer {
            Err(Error {
                kind: ErrorKind::OutsideLooseBox { .. },
                ..
            }) => Ok(()),
            other => self.wrong(format!(
                "{id} is not inside the loose box, and was answered {other:?}"
            )),
        }
    }

    /// Makes calls that must be refused and change nothing: the next comparison would see it.
    fn ask_what_must_be_refused(&mut self, some: usize) -> Result<(), Wrong> {
        let Known {
            id, surface, place, ..
        } = self.known[some];
        let mut bad = self.shape_of(some, place);
        let vertex = self.random.index(bad.len());
        bad[vertex][self.random.index(3)] = (self.convert)(
            [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e39][self.random.index(4)],
        );
        let bad_position = |answer: Result<(), Error>| match answer {
            Err(Error {
                body: Some(body),
                kind: ErrorKind::BadPosition { vertex: said, .. },
            }) => (body, said) == (id, vertex),
            _ => false,
        };
        let nan = (self.convert)(f64::NAN);
        let world = &mut self.world;
        let mut refused = vec![
            bad_position(world.set_positions(id, &bad)),
            world
                .write_positions(id, |buffer| buffer[1..].copy_from_slice(&bad[1..]))
                .is_err(),
            world.set_positions(id, &bad[1..]).is_err(),
            world.set_loose_box(id, Some(([nan; 3], [nan; 3]))).is_err(),
            world.add(&self.surfaces[surface].triangles, &bad).is_err(),
            world.add(&[[0, 1, u32::MAX]], &bad).is_err(),
            world
                .intersections(Selection::Between(id, id))
                .all()
                .is_err(),
        ];
        for &gone in &self.gone {
            refused.extend([
                world.set_positions(gone, &bad).is_err(),
                world.remove(gone).is_err(),
                world.rebuild(gone).is_err(),
                world.set_filter(gone, 0, 0).is_err(),
                world.intersections(Selection::Within(gone)).all().is_err(),
                world
                    .intersections(Selection::Between(id, gone))
                    .first()
                    .is_err(),
            ]);
        }
        if let Some(place) = refused.iter().position(|&refused| !refused) {
            return self.wrong(format!("bad call {place} about {id} was not refused"));
        }
        self.tally.refused += refused.len() as u64;
        Ok(())
    }

    /// Asks a query between comparisons, so that some boxes are valid when the next step comes.
    fn ask_something(&mut self) -> Result<(), Wrong> {
        let [a, b] = [(); 2].map(|()| self.known[self.random.index(self.known.len())].id);
        let answer = match self.random.below(12) {
            0 => self
                .world
                .intersections(Selection::Everything)
                .all()
                .map(drop),
            1 => self.world.intersections(Selection::World).first().map(drop),
            2 => {
                // A visitor that stops on the way leaves some boxes valid.
                let mut left = self.random.below(50);
                let visit = |_: Pair| match left.checked_sub(1) {
                    Some(fewer) => {
                        left = fewer;
                        ControlFlow::Continue(())
                    }
                    None => ControlFlow::Break(()),
                };
                let visited = self.world.intersections(Selection::World).visit(visit);
                visited.map(drop)
            }
            3 => self
                .world
                .intersections(Selection::Within(a))
                .all()
                .map(drop),
            4 => self
                .world
                .intersections(Selection::Within(a))
                .first()
                .map(drop),
            5 if a != b => self
                .world
                .intersections(Selection::Between(a, b))
                .all()
                .map(drop),
            6 if a != b => self.world.distance(a, b, f64::INFINITY).map(drop),
            7 => self.world.nearest_body(a, SIDE / 4.0).map(drop),
            8 | 9 => {
                let kinds = every_kind::<S>();
                let kind = &kinds[self.random.index(kinds.len())];
                let (of, much) = if self.random.one_in(2) {
                    (Selection::World, Much::First)
                } else {
                    (Selection::Within(a), Much::All)
                };
                (kind.ask)(&mut self.world, of, FAR_BUT_CLOSE, much).map(drop)
            }
            _ => Ok(()),
        };
        self.good("a query", answer)
    }

    /// Result of a call with good input; an error is a wrong answer.
    fn good<T>(&self, call: &str, answer: Result<T, Error>) -> Result<T, Wrong> {
        answer.or_else(|error| self.wrong(format!("{call} was refused: {error}")))
    }

    fn wrong<T>(&self, what: impl std::fmt::Display) -> Result<T, Wrong> {
        Err(Wrong(format!("step {}: {what}", self.tally.steps)))
    }
}

fn inside<S: Scalar>((lo, hi): ([S; 3], [S; 3]), point: [S; 3]) -> bool {
    (0..3).all(|axis| lo[axis] <= point[axis] && point[axis] <= hi[axis])
}

/// Candidates: vertices near triangles, and edges near edges.
struct Near {
    vertex_triangle: Vec<VertexTriangle>,
    edge_edge: Vec<EdgeEdge>,
}

impl Near {
    fn of<S: Scalar>(world: &mut World<S>, radius: f64) -> Result<Self, Error> {
        let of = Selection::Everything;
        Ok(Self {
            vertex_triangle: world.vertex_triangle_candidates(of, radius).all()?.to_vec(),
            edge_edge: world.edge_edge_candidates(of, radius).all()?.to_vec(),
        })
    }
}

/// Close pairs of all kinds, with figures.
struct AllClose {
    vertex_triangle: Vec<CloseVertexTriangle>,
    edge_edge: Vec<CloseEdgeEdge>,
    triangles: Vec<CloseTriangles>,
}

impl AllClose {
    fn of<S: Scalar>(world: &mut World<S>, distance: f64) -> Result<Self, Error> {
        let of = Selection::Everything;
        Ok(Self {
            vertex_triangle: world
                .close_vertex_triangle_pairs(of, distance)
                .all()?
                .to_vec(),
            edge_edge: world.close_edge_edge_pairs(of, distance).all()?.to_vec(),
            triangles: world.close_triangle_pairs(of, distance).all()?.to_vec(),
        })
    }

    fn counts(&self) -> [usize; 3] {
        [
            self.vertex_triangle.len(),
            self.edge_edge.len(),
            self.triangles.len(),
        ]
    }
}

/// Impacts, the first impact, and free steps.
struct Met {
    vertex_triangle: Vec<VertexTriangleImpact>,
    edge_edge: Vec<EdgeEdgeImpact>,
    first: Option<Impact>,
    step: f64,
}

impl Met {
    fn of<S: Scalar>(world: &mut World<S>, width: f64, distance: f64) -> Result<Self, Error> {
        let of = Selection::Everything;
        Ok(Self {
            vertex_triangle: world
                .vertex_triangle_impacts(of)
                .width(width)
                .all()?
                .to_vec(),
            edge_edge: world.edge_edge_impacts(of).width(width).all()?.to_vec(),
            first: world.first_impact(of, width)?,
            step: world.collision_free_step(of, distance)?,
        })
    }

    fn summary(&self) -> String {
        format!(
            "{} vertices, {} edges, first {:?}, a step of {}",
            self.vertex_triangle.len(),
            self.edge_edge.len(),
            self.first,
            self.step
        )
    }
}
