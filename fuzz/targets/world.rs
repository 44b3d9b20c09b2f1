//! Fuzzes the life of a world, call by call, against `pliant::reference`.
//!
//! Every answer equals the reference's, and every refusal changes nothing. Bodies are few and
//! small, since the reference decides every pair. Coordinates are where exactness is hard.
#![no_main]

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use arbitrary::Arbitrary;
use pliant::reference::{Moving, Timed};
use pliant::{
    BodyId, BroadPhase, Degree, FeaturePairs, HitRows, Labels, Options, Pair, Partition, Scalar,
    Selection, Update, World, reference,
};
use pliant_fuzz::places::Grid;

/// Limits: bodies alive, triangles and vertices of a body, and calls.
const BODIES: usize = 4;
const TRIANGLES: usize = 12;
const VERTICES: usize = 16;
const CALLS: usize = 32;

#[derive(Arbitrary, Debug)]
struct Life {
    wide: bool,
    degree: u8,
    partition: u8,
    leaf_size: u8,
    update: u8,
    level: Option<u8>,
    levels_at_once: u8,
    broad_phase: u8,
    calls: Vec<Call>,
}

#[derive(Arbitrary, Clone, Debug)]
struct Shape {
    grid: Grid,
    points: Vec<[i8; 3]>,
}

/// A call of the world. A number names a body alive, modulo their count.
#[derive(Arbitrary, Debug)]
enum Call {
    Add {
        vertices: u8,
        triangles: Vec<[u8; 3]>,
        shape: Shape,
    },
    Remove(u8),
    Move(u8, Shape),
    Write(u8, Shape),
    Mesh(u8, u8, Vec<[u8; 3]>, Shape),
    Rebuild(u8),
    Filter(u8, u8, u8),
    Ignore(u8, u8),
    Unignore(u8, u8),
    Loose(u8, Option<([i8; 3], [i8; 3])>),
    BadCoordinate {
        body: u8,
        vertex: u8,
        axis: u8,
        which: u8,
        write: bool,
    },
    WrongLength(u8, i8),
    Unwritten(u8, u8),
    BadTriangle(u8),
    Stranger(u32),
    Update,
    UpdateBody(u8),
    All,
    First,
    Visit(u8),
    Between(u8, u8),
    Itself(u8),
    Motion(u8, Shape),
    Finish,
    Advance(u8),
    Groups(u8, Vec<u8>),
    Near(u8, u8, u8),
    Close(u8, u8, u8),
    Distance(u8, u8, Option<u8>),
    Meet(u8, u8, u8, u8),
    Edit(u8, Vec<Change>),
    Rest(u8, Option<Shape>),
    Thickness(u8, Vec<u8>),
    Labels(u8, Option<Vec<u8>>, Option<Vec<[u8; 2]>>),
}

/// A step of an edit. Numbers are taken modulo one more than the count, so that some name nothing.
#[derive(Arbitrary, Debug)]
enum Change {
    AddVertex([i8; 3]),
    PlaceVertex(u8, [i8; 3]),
    SplitVertex(u8, Vec<u8>),
    MergeVertices(u8, u8),
    AddTriangle([u8; 3]),
    SetTriangle(u8, [u8; 3]),
    RemoveTriangle(u8),
}

libfuzzer_sys::fuzz_target!(|life: Life| {
    if life.wide {
        Lived::<f64>::begin(&life, |x| x).live(&life.calls);
    } else {
        Lived::<f32>::begin(&life, |x| x as f32).live(&life.calls);
    }
});

fn options(life: &Life) -> Options {
    let positive = |number: u8, most: u8| {
        (u32::from(number % most) + 1)
            .try_into()
            .expect("at least 1")
    };
    let mut options = Options::default();
    options.degree = [Degree::Two, Degree::Four, Degree::Eight][usize::from(life.degree % 3)];
    options.partition = [
        Partition::Centre,
        Partition::Mean,
        Partition::Balanced,
        Partition::Connectivity,
    ][usize::from(life.partition % 4)];
    options.leaf_size = positive(life.leaf_size, 20);
    options.update = match life.update % 3 {
        0 => Update::BottomUp,
        1 => Update::TopDown,
        _ => Update::Hybrid {
            level: life.level.map(|level| u32::from(level % 8)),
            levels_at_once: positive(life.levels_at_once, 4),
        },
    };
    options.broad_phase = [
        BroadPhase::BruteForce,
        BroadPhase::SweepAndPrune,
        BroadPhase::Tree,
    ][usize::from(life.broad_phase % 3)];
    options
}

/// Facts about a body: enough for the reference.
struct Known<S> {
    id: BodyId,
    /// Triangles that are not empty, and their numbers. `count` is the number of all numbers.
    triangles: Vec<[u32; 3]>,
    numbers: Vec<u32>,
    count: usize,
    /// Positions; arbitrary for an empty vertex.
    positions: Vec<[S; 3]>,
    empty: Vec<bool>,
    /// End of the motion, if any; and the group of every vertex.
    end: Option<Vec<[S; 3]>>,
    groups: Vec<u32>,
    /// Rest shape and thickness, if there are any.
    rest: Option<Vec<[S; 3]>>,
    thickness: Option<Vec<f64>>,
    /// Labels of the triangles that are not empty, and neighbours, if there are any.
    labels: Option<(Vec<u32>, Option<Vec<[u32; 2]>>)>,
    membership: u32,
    mask: u32,
    environment: u32,
    loose: Option<([S; 3], [S; 3])>,
}

struct Lived<S: Scalar> {
    world: World<S>,
    known: Vec<Known<S>>,
    removed: Vec<BodyId>,
    ignored: Vec<[BodyId; 2]>,
    convert: fn(f64) -> S,
    wide: bool,
}

impl<S: Scalar> Lived<S> {
    fn begin(life: &Life, convert: fn(f64) -> S) -> Self {
        Self {
            world: World::with_options(options(life)),
            known: Vec::new(),
            removed: Vec::new(),
            ignored: Vec::new(),
            convert,
            wide: life.wide,
        }
    }

    fn live(mut self, calls: &[Call]) {
        for call in calls.iter().take(CALLS) {
            self.call(call);
        }
        self.all();
        for body in 0..self.known.len() {
            self.itself(body);
        }
        self.all();
        self.every_kind();
        self.world.validate().expect("the world is well");
    }

    /// Whatever is asked, a copy of the world, whose boxes are all made anew, says the same.
    fn every_kind(&mut self) {
        for (name, ask) in every_kind::<S>() {
            let mut copy = self.world.clone();
            for length in [0.0, 0.5] {
                assert_eq!(
                    ask(&mut self.world, length),
                    ask(&mut copy, length),
                    "{name}"
                );
            }
        }
    }

    fn body(&self, number: u8) -> Option<usize> {
        usize::from(number).checked_rem(self.known.len())
    }

    /// Returns `count` positions; a shape with fewer points repeats them.
    fn places(&self, shape: &Shape, count: usize) -> Vec<[S; 3]> {
        let places = shape.grid.places(&shape.points, self.wide);
        let points = places
            .iter()
            .cycle()
            .copied()
            .chain(std::iter::repeat([0.0; 3]));
        points
            .take(count)
            .map(|place| place.map(self.convert))
            .collect()
    }

    /// A mesh with its shape, perhaps without triangles.
    fn mesh(
        &self,
        vertices: u8,
        triangles: &[[u8; 3]],
        shape: &Shape,
    ) -> (Vec<[u32; 3]>, Vec<[S; 3]>) {
        let count = usize::from(vertices) % VERTICES + 1;
        let corner = |corner: u8| u32::from(corner) % count as u32;
        let triangles = triangles.iter().take(TRIANGLES);
        let triangles = triangles.map(|three| three.map(corner)).collect();
        (triangles, self.places(shape, count))
    }

    /// Whether a loose box holds all vertices that are not empty.
    fn all_inside(corners: Option<([S; 3], [S; 3])>, positions: &[[S; 3]], empty: &[bool]) -> bool {
        let mut live = positions.iter().zip(empty).filter(|(_, empty)| !**empty);
        corners.is_none_or(|(lo, hi)| {
            live.all(|(p, _)| (0..3).all(|axis| lo[axis] <= p[axis] && p[axis] <= hi[axis]))
        })
    }

    /// Gives a body a shape by either call. It is refused if it leaves the loose box.
    fn moved(&mut self, body: usize, positions: Vec<[S; 3]>, write: bool) {
        let known = &mut self.known[body];
        let moved = if write {
            self.world
                .write_positions(known.id, |there| there.copy_from_slice(&positions))
        } else {
            self.world.set_positions(known.id, &positions)
        };
        assert_eq!(
            moved.is_ok(),
            Self::all_inside(known.loose, &positions, &known.empty),
            "{moved:?}"
        );
        if moved.is_ok() {
            known.positions = positions;
            known.end = None;
        }
    }

    #[allow(clippy::too_many_lines, reason = "one arm a call of the library")]
    fn call(&mut self, call: &Call) {
        match *call {
            Call::Add {
                vertices,
                ref triangles,
                ref shape,
            } => {
                if self.known.len() == BODIES {
                    return;
                }
                let (triangles, positions) = self.mesh(vertices, triangles, shape);
                let added = self.world.add(&triangles, &positions);
                assert_eq!(added.is_ok(), !triangles.is_empty());
                let Ok(id) = added else { return };
                let earlier = self
                    .known
                    .iter()
                    .map(|body| body.id)
                    .chain(self.removed.iter().copied());
                assert!(
                    earlier.into_iter().all(|earlier| earlier < id),
                    "an id is never used again"
                );
                let (membership, mask, loose) = (u32::MAX, u32::MAX, None);
                self.known.push(Known {
                    id,
                    numbers: (0..triangles.len() as u32).collect(),
                    count: triangles.len(),
                    triangles,
                    empty: vec![false; positions.len()],
                    groups: vec![0; positions.len()],
                    rest: None,
                    thickness: None,
                    labels: None,
                    end: None,
                    positions,
                    membership,
                    mask,
                    environment: 0,
                    loose,
                });
            }
            Call::Remove(number) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                let id = self.known.remove(body).id;
                self.world.remove(id).expect("the body is there");
                self.removed.push(id);
                self.ignored.retain(|pair| !pair.contains(&id));
            }
            Call::Move(number, ref shape) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                let positions = self.places(shape, self.known[body].positions.len());
                self.moved(body, positions, false);
            }
            Call::Write(number, ref shape) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                let positions = self.places(shape, self.known[body].positions.len());
                self.moved(body, positions, true);
            }
            Call::Mesh(number, vertices, ref triangles, ref shape) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                let (triangles, positions) = self.mesh(vertices, triangles, shape);
                let known = &mut self.known[body];
                let set = self.world.set_mesh(known.id, &triangles, &positions);
                let none_is_empty = vec![false; positions.len()];
                let is_good = !triangles.is_empty()
                    && Self::all_inside(known.loose, &positions, &none_is_empty);
                assert_eq!(set.is_ok(), is_good, "{set:?}");
                if is_good {
                    let is_same = triangles == known.triangles
                        && triangles.len() == known.count
                        && known.empty == none_is_empty;
                    if !is_same {
                        known.groups = vec![0; positions.len()];
                        known.rest = None;
                        known.labels = None;
                        if let Some(all) = &mut known.thickness {
                            let most = all.iter().copied().fold(0.0, f64::max);
                            *all = vec![most; positions.len()];
                        }
                    }
                    known.numbers = (0..triangles.len() as u32).collect();
                    known.count = triangles.len();
                    known.empty = none_is_empty;
                    (known.triangles, known.positions) = (triangles, positions);
                    known.end = None;
                }
            }
            Call::Rebuild(number) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                self.world
                    .rebuild(self.known[body].id)
                    .expect("the body is there");
            }
            Call::Filter(number, membership, mask) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                let known = &mut self.known[body];
                (known.membership, known.mask) = (u32::from(membership % 8), u32::from(mask % 8));
                let set = self
                    .world
                    .set_filter(known.id, known.membership, known.mask);
                set.expect("the body is there");
                known.environment = u32::from(membership / 8 % 3);
                let set = self.world.set_environment(known.id, known.environment);
                set.expect("the body is there");
            }
            Call::Ignore(a, b) | Call::Unignore(a, b) => {
                let (Some(a), Some(b)) = (self.body(a), self.body(b)) else {
                    return;
                };
                let pair = [self.known[a].id, self.known[b].id];
                let ignore = matches!(call, Call::Ignore(..));
                let done = if ignore {
                    self.world.ignore(pair[0], pair[1])
                } else {
                    self.world.unignore(pair[0], pair[1])
                };
                // Both may be the same body.
                done.expect("both are there");
                self.ignored
                    .retain(|&[a, b]| [a, b] != pair && [b, a] != pair);
                self.ignored.extend(ignore.then_some(pair));
            }
            Call::Loose(number, corners) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                let corner = |corner: [i8; 3]| corner.map(|small| (self.convert)(f64::from(small)));
                let corners = corners.map(|(lo, hi)| (corner(lo), corner(hi)));
                let known = &mut self.known[body];
                let set = self.world.set_loose_box(known.id, corners);
                let end = known.end.as_deref().unwrap_or(&[]);
                assert_eq!(
                    set.is_ok(),
                    Self::all_inside(corners, &known.positions, &known.empty)
                        && Self::all_inside(corners, end, &known.empty),
                    "{set:?}"
                );
                if set.is_ok() {
                    known.loose = corners;
                }
            }
            Call::BadCoordinate {
                body,
                vertex,
                axis,
                which,
                write,
            } => {
                let Some(body) = self.body(body) else { return };
                let known = &self.known[body];
                let mut positions = known.positions.clone();
                let vertex = usize::from(vertex) % positions.len();
                if known.empty[vertex] {
                    return;
                }
                let bad =
                    [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX][usize::from(which % 4)];
                positions[vertex][usize::from(axis % 3)] = (self.convert)(bad);
                let refused = if write {
                    self.world
                        .write_positions(known.id, |there| there.copy_from_slice(&positions))
                } else {
                    self.world.set_positions(known.id, &positions)
                };
                assert!(refused.is_err());
                assert!(self.world.add(&known.triangles, &positions).is_err());
            }
            Call::WrongLength(number, by) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                let known = &self.known[body];
                let length = known.positions.len().saturating_add_signed(by.into());
                let mut positions = known.positions.clone();
                positions.resize(length, [(self.convert)(0.0); 3]);
                let is_right = length == known.positions.len();
                let set = self.world.set_positions(known.id, &positions);
                assert_eq!(set.is_ok(), is_right);
                if is_right {
                    self.known[body].end = None;
                }
            }
            Call::Unwritten(number, vertex) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                let known = &self.known[body];
                let vertex = usize::from(vertex) % known.positions.len();
                if known.empty[vertex] {
                    return;
                }
                let refused = self.world.write_positions(known.id, |there| {
                    there[..vertex].copy_from_slice(&known.positions[..vertex]);
                    there[vertex + 1..].copy_from_slice(&known.positions[vertex + 1..]);
                });
                assert!(refused.is_err());
            }
            Call::BadTriangle(number) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                let known = &self.known[body];
                let beyond = known.positions.len() as u32;
                assert!(self.world.add(&[[0, 0, beyond]], &known.positions).is_err());
                assert!(
                    self.world
                        .add(&[[0, u32::MAX, 0]], &known.positions)
                        .is_err()
                );
                assert!(self.world.add(&[], &known.positions).is_err());
            }
            Call::Stranger(number) => {
                let strangers = self.removed.iter().copied().chain([BodyId(number)]);
                for id in strangers.filter(|id| self.known.iter().all(|body| body.id != *id)) {
                    assert!(self.world.set_positions(id, &[]).is_err());
                    assert!(self.world.write_positions(id, |_| {}).is_err());
                    assert!(self.world.set_mesh(id, &[[0; 3]], &[]).is_err());
                    assert!(self.world.remove(id).is_err());
                    assert!(self.world.rebuild(id).is_err());
                    assert!(self.world.set_filter(id, 1, 1).is_err());
                    assert!(self.world.set_loose_box(id, None).is_err());
                    assert!(
                        self.world
                            .intersections(Selection::Within(id))
                            .prepare()
                            .is_err()
                    );
                    assert!(
                        self.world
                            .intersections(Selection::Within(id))
                            .all()
                            .is_err()
                    );
                    assert!(
                        self.world
                            .intersections(Selection::Within(id))
                            .first()
                            .is_err()
                    );
                    for other in self.known.iter().map(|body| body.id).chain([id]) {
                        assert!(self.world.ignore(id, other).is_err());
                        assert!(self.world.unignore(other, id).is_err());
                        assert!(
                            self.world
                                .intersections(Selection::Between(other, id))
                                .all()
                                .is_err()
                        );
                        assert!(
                            self.world
                                .intersections(Selection::Between(id, other))
                                .first()
                                .is_err()
                        );
                    }
                }
            }
            Call::Update => self
                .world
                .intersections(Selection::World)
                .prepare()
                .unwrap(),
            Call::UpdateBody(number) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                self.world
                    .intersections(Selection::Within(self.known[body].id))
                    .prepare()
                    .expect("the body is there");
            }
            Call::All => self.all(),
            Call::First => {
                let (first, expected) = (
                    self.world.intersections(Selection::World).first().unwrap(),
                    self.expected(),
                );
                assert_eq!(first.is_some(), !expected.is_empty());
                assert!(first.is_none_or(|pair| expected.contains(&pair)));
            }
            Call::Visit(budget) => {
                let (mut seen, budget, expected) =
                    (Vec::new(), usize::from(budget) + 1, self.expected());
                let flow = self.world.intersections(Selection::World).visit(|pair| {
                    seen.push(pair);
                    if seen.len() == budget {
                        ControlFlow::Break(())
                    } else {
                        ControlFlow::Continue(())
                    }
                });
                assert_eq!(
                    flow.expect("nothing interrupts it").is_break(),
                    expected.len() >= budget
                );
                assert_eq!(seen.len(), expected.len().min(budget));
                seen.sort_unstable();
                seen.dedup();
                assert_eq!(
                    seen.len(),
                    expected.len().min(budget),
                    "each pair is shown once"
                );
                assert!(seen.iter().all(|pair| expected.contains(pair)));
            }
            Call::Between(a, b) => {
                let (Some(a), Some(b)) = (self.body(a), self.body(b)) else {
                    return;
                };
                self.between(a, b);
            }
            Call::Itself(number) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                self.itself(body);
            }
            Call::Motion(number, ref shape) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                let end = self.places(shape, self.known[body].positions.len());
                let known = &mut self.known[body];
                let set = self.world.set_motion(known.id, &end);
                let is_inside = Self::all_inside(known.loose, &end, &known.empty);
                assert_eq!(set.is_ok(), is_inside, "{set:?}");
                if set.is_ok() {
                    known.end = Some(end);
                }
            }
            Call::Finish => {
                self.world.finish_motion();
                for known in &mut self.known {
                    known.positions = known.end.take().unwrap_or(known.positions.clone());
                }
            }
            Call::Advance(part) => {
                let t = f64::from(part) / 255.0;
                self.world.advance_motion(t).expect("a part of the step");
                for known in &mut self.known {
                    let Some(end) = known.end.take() else {
                        continue;
                    };
                    let now = self.world.positions(known.id).expect("the body is there");
                    let all = now.iter().zip(&known.positions).zip(&end);
                    let all = all.zip(&known.empty).filter(|(_, empty)| !**empty);
                    for (((now, from), to), _) in all {
                        for axis in 0..3 {
                            let (x, from, to) = (now[axis], from[axis], to[axis]);
                            assert!(from <= x && x <= to || to <= x && x <= from);
                        }
                    }
                    known.positions = now;
                    known.fill_empty((self.convert)(0.0));
                }
            }
            Call::Groups(number, ref groups) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                let known = &mut self.known[body];
                let groups = groups.iter().map(|group| u32::from(group % 4));
                let groups = groups
                    .chain(std::iter::repeat(0))
                    .take(known.positions.len());
                known.groups = groups.collect();
                let set = self.world.set_vertex_groups(known.id, &known.groups);
                set.expect("one for each vertex");
            }
            Call::Rest(number, ref shape) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                let count = self.known[body].positions.len();
                let rest = shape.as_ref().map(|shape| self.places(shape, count));
                let known = &mut self.known[body];
                let set = self.world.set_rest_positions(known.id, rest.as_deref());
                set.expect("places are good");
                known.rest = rest;
            }
            Call::Thickness(number, ref thickness) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                let known = &mut self.known[body];
                let all = thickness.iter().map(|&it| f64::from(it) / 64.0);
                let all = all.chain(std::iter::repeat(0.0));
                let all: Vec<f64> = all.take(known.positions.len()).collect();
                let set = self.world.set_vertex_thickness(known.id, &all);
                set.expect("one for each vertex");
                known.thickness = all.iter().any(|&it| it > 0.0).then_some(all);
            }
            Call::Labels(number, ref labels, ref neighbours) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                let known = &mut self.known[body];
                let label = |&it: &u8| match it % 8 {
                    7 => Labels::NONE,
                    label => u32::from(label),
                };
                known.labels = labels.as_ref().map(|labels| {
                    let labels = labels.iter().map(label).chain(std::iter::repeat(0));
                    let labels = labels.take(known.triangles.len()).collect();
                    let pairs = neighbours.as_ref().map(|pairs| {
                        let pairs = pairs.iter();
                        pairs.map(|[a, b]| [label(a), label(b)]).collect()
                    });
                    (labels, pairs)
                });
                // Labels of empty triangles are not looked at.
                let mut all = vec![0; known.count];
                for (&number, &label) in known
                    .numbers
                    .iter()
                    .zip(known.labels.iter().flat_map(|it| &it.0))
                {
                    all[number as usize] = label;
                }
                let labels = known.labels.as_ref().map(|(_, neighbours)| Labels {
                    of_triangles: &all,
                    neighbours: neighbours.as_deref(),
                });
                let set = self.world.set_labels(known.id, labels);
                set.expect("one for each triangle");
            }
            Call::Near(a, b, radius) => {
                let (Some(a), Some(b)) = (self.body(a), self.body(b)) else {
                    return;
                };
                self.near(a, b, f64::from(radius) / 16.0);
            }
            Call::Close(a, b, distance) => {
                let (Some(a), Some(b)) = (self.body(a), self.body(b)) else {
                    return;
                };
                self.close(a, b, f64::from(distance) / 16.0);
            }
            Call::Distance(a, b, cut_off) => {
                let (Some(a), Some(b)) = (self.body(a), self.body(b)) else {
                    return;
                };
                let cut_off = cut_off.map_or(f64::INFINITY, |cut_off| f64::from(cut_off) / 16.0);
                self.distance(a, b, cut_off);
            }
            Call::Meet(a, b, width, gap) => {
                let (Some(a), Some(b)) = (self.body(a), self.body(b)) else {
                    return;
                };
                // Powers of one half, down to neighbouring numbers.
                let width = if width == u8::MAX {
                    0.0
                } else {
                    f64::powi(0.5, i32::from(width % 64))
                };
                self.meet(a, b, width, f64::from(gap / 64) / 16.0);
            }
            Call::Edit(number, ref changes) => {
                let Some(body) = self.body(number) else {
                    return;
                };
                self.edit(body, changes);
            }
        }
    }

    /// Applies changes to a body, or has them refused, and compares with a naive edit.
    fn edit(&mut self, body: usize, changes: &[Change]) {
        let known = &self.known[body];
        let mut mesh = Draft::of(known);
        let mut edit = self.world.edit(known.id).expect("the body is there");
        let point = |point: [i8; 3]| point.map(|x| (self.convert)(f64::from(x) / 8.0));
        let mut is_good = true;
        for change in changes.iter().take(TRIANGLES) {
            let [vertices, triangles] = [mesh.vertices.len(), mesh.triangles.len()];
            if vertices > 2 * VERTICES || triangles > 2 * TRIANGLES {
                break;
            }
            let vertex = |number: u8| u32::from(number) % (vertices as u32 + 1);
            let triangle = |number: u8| u32::from(number) % (triangles as u32 + 1);
            is_good &= match *change {
                Change::AddVertex(at) => {
                    edit.add_vertex(point(at));
                    mesh.add_vertex(mesh.new_at(point(at)));
                    true
                }
                Change::PlaceVertex(number, at) => {
                    edit.place_vertex(vertex(number), point(at));
                    mesh.place_vertex(vertex(number), point(at))
                }
                Change::SplitVertex(number, ref of) => {
                    let of: Vec<u32> = of.iter().take(4).map(|&it| triangle(it)).collect();
                    edit.split_vertex(vertex(number), &of);
                    mesh.split_vertex(vertex(number), &of)
                }
                Change::MergeVertices(kept, gone) => {
                    edit.merge_vertices(vertex(kept), vertex(gone));
                    mesh.merge_vertices(vertex(kept), vertex(gone))
                }
                Change::AddTriangle(corners) => {
                    edit.add_triangle(corners.map(vertex));
                    mesh.triangles.push(None);
                    mesh.set_triangle(triangles as u32, corners.map(vertex))
                }
                Change::SetTriangle(number, corners) => {
                    edit.set_triangle(triangle(number), corners.map(vertex));
                    mesh.set_triangle(triangle(number), corners.map(vertex))
                }
                Change::RemoveTriangle(number) => {
                    edit.remove_triangle(triangle(number));
                    mesh.remove_triangle(triangle(number))
                }
            };
            if !is_good {
                break;
            }
        }
        is_good &= mesh.triangles.iter().any(Option::is_some);
        let edited = self.world.apply(&edit);
        if is_good && known.loose.is_some() {
            // A vertex that came and went in between might have been outside.
            is_good = edited.is_ok();
        }
        assert_eq!(edited.is_ok(), is_good, "{edited:?}");
        if is_good {
            mesh.into_known(&mut self.known[body], (self.convert)(0.0));
            let known = &self.known[body];
            let all_inside = Self::all_inside(known.loose, &known.positions, &known.empty);
            assert!(all_inside);
        }
        let known = &self.known[body];
        let mut triangles = vec![[u32::MAX; 3]; known.count];
        for (&number, corners) in known.numbers.iter().zip(&known.triangles) {
            triangles[number as usize] = *corners;
        }
        assert_eq!(self.world.triangles(known.id), Ok(&triangles[..]));
        let live = self
            .world
            .live_vertices(known.id)
            .expect("the body is there");
        assert!(live.into_iter().eq(known.empty.iter().map(|empty| !empty)));
        let groups = self
            .world
            .vertex_groups(known.id)
            .expect("the body is there");
        let live = known.empty.iter().zip(known.groups.iter().zip(groups));
        assert!(
            live.filter(|(empty, _)| !**empty)
                .all(|(_, (known, group))| *known == group)
        );
        let labels = self.world.labels(known.id).expect("the body is there");
        assert_eq!(labels.is_some(), known.labels.is_some());
        if let (Some(labels), Some((own, _))) = (labels, &known.labels) {
            let numbers = known.numbers.iter();
            let live = numbers.map(|&number| labels.of_triangles[number as usize]);
            assert!(live.eq(own.iter().copied()));
        }
        let thickness = self.world.thickness(known.id).expect("the body is there");
        let rest = self
            .world
            .rest_positions(known.id)
            .expect("the body is there");
        assert_eq!(rest.is_some(), known.rest.is_some());
        for vertex in (0..known.empty.len()).filter(|&vertex| !known.empty[vertex]) {
            assert_eq!(thickness[vertex], known.thick(vertex as u32));
            let own = known.rest.as_ref().map(|rest| rest[vertex]);
            assert_eq!(rest.map(|rest| rest[vertex]), own);
        }
    }

    /// Compares the candidates of two bodies, or of one with itself.
    fn near(&mut self, a: usize, b: usize, radius: f64) {
        let (one, other) = (&self.known[a], &self.known[b]);
        let of = selection(one, other);
        let [moving_a, moving_b] = [one, other].map(Known::moving);
        let mut expected = Vec::new();
        let mut add = |(of, with): (&Known<S>, &Known<S>), pairs: Vec<[u32; 2]>| {
            let row = |[i, j]: [u32; 2]| [of.id.0, i, with.id.0, with.numbers[j as usize]];
            expected.extend(pairs.into_iter().map(row));
        };
        if a == b {
            let pairs = reference::self_vertex_triangle_pairs(&moving_a, radius);
            add((one, one), pairs.expect("the body was taken"));
        } else {
            let pairs = reference::vertex_triangle_pairs(&moving_a, &moving_b, radius);
            add((one, other), pairs.expect("the bodies were taken"));
            let pairs = reference::vertex_triangle_pairs(&moving_b, &moving_a, radius);
            add((other, one), pairs.expect("the bodies were taken"));
        }
        expected.sort_unstable();
        let found = self.world.vertex_triangle_candidates(of, radius).all();
        let found = found.expect("both are there").iter();
        assert!(found.map(|&hit| <[u32; 4]>::from(hit)).eq(expected));

        let pairs = if a == b {
            reference::self_edge_edge_pairs(&moving_a, radius)
        } else {
            reference::edge_edge_pairs(&moving_a, &moving_b, radius)
        };
        let pairs = pairs.expect("the bodies were taken").into_iter();
        let expected = by_ends(
            one.id == other.id,
            [one.edges(), other.edges()],
            pairs.map(|it| (it, ())),
        );
        let found = self.world.edge_edge_candidates(of, radius).all();
        let found = found.expect("both are there").to_vec().into_iter();
        let found = found.map(|hit| ([hit.edge_a, hit.edge_b], ()));
        assert_eq!(self.found_by_ends([one.id, other.id], found), expected);
    }

    /// Compares the close pairs of two bodies, or of one with itself.
    fn close(&mut self, a: usize, b: usize, distance: f64) {
        let most = distance + self.known[a].thickest() + self.known[b].thickest();
        let (one, other) = (&self.known[a], &self.known[b]);
        let of = selection(one, other);
        let [moving_a, moving_b] = [one, other].map(Known::moving);
        let mut expected = Vec::new();
        let mut add = |(of, with): (&Known<S>, &Known<S>), pairs: Vec<[u32; 2]>| {
            let row = |[i, j]: [u32; 2]| [of.id.0, i, with.id.0, with.numbers[j as usize]];
            expected.extend(pairs.into_iter().map(row));
        };
        if a == b {
            let pairs = reference::self_close_vertex_triangle_pairs(&moving_a, distance);
            add((one, one), pairs.expect("the body was taken"));
        } else {
            let pairs = reference::close_vertex_triangle_pairs(&moving_a, &moving_b, distance);
            add((one, other), pairs.expect("the bodies were taken"));
            let pairs = reference::close_vertex_triangle_pairs(&moving_b, &moving_a, distance);
            add((other, one), pairs.expect("the bodies were taken"));
        }
        expected.sort_unstable();
        let found = self.world.close_vertex_triangle_pairs(of, distance).all();
        let found = found.expect("both are there").iter();
        let figures = found.clone().map(|it| (it.distance, it.direction));
        figures.for_each(|it| check_figures(it, most));
        assert!(found.map(|it| <[u32; 4]>::from(it.pair)).eq(expected));

        let pairs = if a == b {
            reference::self_close_edge_edge_pairs(&moving_a, distance)
        } else {
            reference::close_edge_edge_pairs(&moving_a, &moving_b, distance)
        };
        let pairs = pairs.expect("the bodies were taken").into_iter();
        let expected = by_ends(
            one.id == other.id,
            [one.edges(), other.edges()],
            pairs.map(|it| (it, ())),
        );
        let found = self.world.close_edge_edge_pairs(of, distance).all();
        let found = found.expect("both are there").to_vec().into_iter();
        let figures = found.clone().map(|it| (it.distance, it.direction));
        figures.for_each(|it| check_figures(it, most));
        let found = found.map(|it| ([it.pair.edge_a, it.pair.edge_b], ()));
        assert_eq!(self.found_by_ends([one.id, other.id], found), expected);

        // Contacts stand for all pairs of both lists, rows have each hit once.
        let vertices = self.world.close_vertex_triangle_pairs(of, distance).all();
        let vertices = vertices.expect("both are there").to_vec();
        let mut edges = Vec::new();
        let asked = self
            .world
            .close_edge_edge_pairs(of, distance)
            .unsorted(&mut edges);
        asked.expect("both are there");
        let mut contacts = FeaturePairs::new();
        let found = contacts.update(&self.world, &vertices, &edges);
        found.expect("the lists are of this world");
        let count: u32 = contacts.all().iter().map(|it| it.multiplicity).sum();
        assert_eq!(count as usize, vertices.len() + edges.len());
        let mut rows = HitRows::new();
        let found = rows.update(&self.world, &edges);
        found.expect("the list is of this world");
        let mut places = rows.places().to_vec();
        places.sort_unstable();
        assert!(places.into_iter().eq(0..edges.len() as u32));

        // Between two bodies, the first is the one named first in the selection.
        let expected = close_triangles(&self.known[a], &self.known[b], distance);
        let found = self.world.close_triangle_pairs(of, distance).all();
        let found = found.expect("both are there").iter();
        let figures = found.clone().map(|it| (it.distance, it.direction));
        figures.for_each(|it| check_figures(it, most));
        assert!(found.map(|it| it.pair.triangles()).eq(expected));
    }

    /// Compares the impacts of two bodies, or of one with itself, the first impact, and a
    /// collision-free step.
    fn meet(&mut self, a: usize, b: usize, width: f64, gap: f64) {
        let (one, other) = (&self.known[a], &self.known[b]);
        let of = selection(one, other);
        let [moving_a, moving_b] = [one, other].map(Known::moving);
        let mut expected = Vec::new();
        let mut add = |(of, with): (&Known<S>, &Known<S>), met: Vec<Timed>| {
            let rows = met.into_iter();
            let number = |j: u32| with.numbers[j as usize];
            expected.extend(rows.map(|([i, j], cell)| ([of.id.0, i, with.id.0, number(j)], cell)));
        };
        if a == b {
            let met = reference::self_vertex_triangle_impacts(&moving_a, width);
            add((one, one), met.expect("the body was taken"));
        } else {
            let met = reference::vertex_triangle_impacts(&moving_a, &moving_b, width);
            add((one, other), met.expect("the bodies were taken"));
            let met = reference::vertex_triangle_impacts(&moving_b, &moving_a, width);
            add((other, one), met.expect("the bodies were taken"));
        }
        expected.sort_unstable_by_key(|&(row, _)| row);
        let found = self.world.vertex_triangle_impacts(of).width(width).all();
        let found = found.expect("both are there").iter();
        let rows = found.map(|it| (<[u32; 4]>::from(it.pair), [it.low, it.high]));
        assert!(rows.eq(expected.iter().copied()));
        let mut earliest = expected.iter().map(|&(_, cell)| cell).collect::<Vec<_>>();

        let met = if a == b {
            reference::self_edge_edge_impacts(&moving_a, width)
        } else {
            reference::edge_edge_impacts(&moving_a, &moving_b, width)
        };
        let met = met.expect("the bodies were taken").into_iter();
        let expected = by_ends(one.id == other.id, [one.edges(), other.edges()], met);
        let found = self.world.edge_edge_impacts(of).width(width).all();
        let found = found.expect("both are there").to_vec().into_iter();
        let found = found.map(|it| ([it.pair.edge_a, it.pair.edge_b], [it.low, it.high]));
        assert_eq!(self.found_by_ends([one.id, other.id], found), expected);

        earliest.extend(expected.iter().map(|&(_, cell)| cell));
        let earliest = earliest.into_iter().min_by(|p, q| p[1].total_cmp(&q[1]));
        let first = self.world.first_impact(of, width).expect("both are there");
        assert_eq!(first.map(|it| [it.low(), it.high()]), earliest);

        // On the way that the step allows, nothing meets but what meets at its start.
        let step = self
            .world
            .collision_free_step(of, gap)
            .expect("both are there");
        assert!((0.0..=1.0).contains(&step));
        let is_thick = [a, b].iter().any(|&it| self.known[it].thickest() > 0.0);
        assert!(gap > 0.0 || is_thick || first.is_some() || step == 1.0);
        let mut there = World::<S>::new();
        let moved = [a, b].map(|body| {
            let known = &self.known[body];
            let id = there
                .add(&known.triangles, &known.positions)
                .expect("it was taken");
            if let Some(end) = &known.end {
                there.set_motion(id, end).expect("it was taken");
            }
            id
        });
        there.advance_motion(step).expect("a part of the step");
        let ends = moved.map(|id| there.positions(id).expect("it was taken"));
        for ((id, body), end) in moved.into_iter().zip([a, b]).zip(&ends) {
            let known = &self.known[body];
            there
                .set_positions(id, &known.positions)
                .expect("it was taken");
            there.set_motion(id, end).expect("it was taken");
        }
        let of = if a == b {
            Selection::Within(moved[0])
        } else {
            Selection::Between(moved[0], moved[1])
        };
        for (body, id) in [a, b].into_iter().zip(moved) {
            there
                .set_vertex_groups(id, &self.known[body].groups)
                .expect("it was taken");
        }
        let met = there
            .vertex_triangle_impacts(of)
            .all()
            .expect("both are there");
        assert!(met.iter().all(|it| it.high == 0.0));
        let met = there.edge_edge_impacts(of).all().expect("both are there");
        assert!(met.iter().all(|it| it.high == 0.0));
    }

    /// Compares the distance of two bodies: some pair is as near as that, and none nearer.
    fn distance(&mut self, a: usize, b: usize, cut_off: f64) {
        let (one, other) = (&self.known[a], &self.known[b]);
        let answer = self.world.distance(one.id, other.id, cut_off);
        if a == b {
            assert!(answer.is_err());
            return;
        }
        let Some(found) = answer.expect("both are there") else {
            assert!(close_triangles(one, other, cut_off).is_empty());
            return;
        };
        check_figures((found.distance, found.direction), cut_off);
        assert_eq!([found.pair.body_a, found.pair.body_b], [one.id, other.id]);
        let slack = f64::powi(0.5, 30);
        let above = found.distance * (1.0 + slack) + f64::MIN_POSITIVE;
        assert!(close_triangles(one, other, above).contains(&found.pair.triangles()));
        if found.distance > f64::MIN_POSITIVE {
            let below = found.distance * (1.0 - 2.0 * slack);
            assert!(close_triangles(one, other, below).is_empty());
        }
    }

    /// Pairs of edges of the world, by their vertices.
    fn found_by_ends<T>(
        &self,
        bodies: [BodyId; 2],
        found: impl Iterator<Item = ([u32; 2], T)>,
    ) -> Vec<([[u32; 2]; 2], T)> {
        let [a, b] = bodies.map(|id| self.world.edges(id).expect("both are there").to_vec());
        by_ends(bodies[0] == bodies[1], [a, b], found)
    }

    fn all(&mut self) {
        let expected = self.expected();
        assert_eq!(
            self.world.intersections(Selection::World).all().unwrap(),
            expected
        );
        assert_eq!(self.world.statistics().pairs, expected.len() as u64);
        // The same pairs, and the pairs of each body with itself.
        let mut everything = expected;
        for known in &self.known {
            let meets_itself =
                known.membership & known.mask != 0 && !self.ignored.contains(&[known.id; 2]);
            if meets_itself {
                let within = self.world.intersections(Selection::Within(known.id)).all();
                everything.extend_from_slice(within.expect("the body is there"));
            }
        }
        everything.sort_unstable();
        let found = self.world.intersections(Selection::Everything).all();
        assert_eq!(found.expect("nothing interrupts it"), everything);
    }

    fn between(&mut self, a: usize, b: usize) {
        let (one, other) = (&self.known[a], &self.known[b]);
        let answer = self
            .world
            .intersections(Selection::Between(one.id, other.id))
            .all();
        if a == b {
            assert!(answer.is_err());
            return;
        }
        let expected = pairs(one, other);
        let found = answer.expect("both are there").iter();
        assert!(found.map(Pair::triangles).eq(expected.iter().copied()));
        let first = self
            .world
            .intersections(Selection::Between(other.id, one.id))
            .first()
            .expect("both are there");
        assert_eq!(first.is_some(), !expected.is_empty());
        assert!(first.is_none_or(|pair| expected.contains(&[pair.triangle_b, pair.triangle_a])));
    }

    fn itself(&mut self, body: usize) {
        let known = &self.known[body];
        let expected = reference::self_intersection_pairs(&known.triangles, &known.positions);
        let mut expected = expected.expect("the body was taken");
        reference::leave_out(&known.moving(), &mut expected);
        let expected = numbered(known, known, expected);
        let answer = self.world.intersections(Selection::Within(known.id)).all();
        let found = answer.expect("the body is there").iter();
        assert!(found.map(Pair::triangles).eq(expected.iter().copied()));
        let first = self
            .world
            .intersections(Selection::Within(known.id))
            .first()
            .expect("the body is there");
        assert_eq!(first.is_some(), !expected.is_empty());
        assert!(first.is_none_or(|pair| expected.contains(&pair.triangles())));
    }

    /// All pairs of the world, by the reference.
    fn expected(&self) -> Vec<Pair> {
        let mut all = Vec::new();
        for (place, a) in self.known.iter().enumerate() {
            for b in &self.known[place + 1..] {
                let filtered = a.environment != b.environment
                    || a.membership & b.mask == 0
                    || b.membership & a.mask == 0;
                let ignored = self
                    .ignored
                    .iter()
                    .any(|pair| *pair == [a.id, b.id] || *pair == [b.id, a.id]);
                if !filtered && !ignored {
                    all.extend(
                        pairs(a, b)
                            .into_iter()
                            .map(|[triangle_a, triangle_b]| Pair {
                                body_a: a.id,
                                triangle_a,
                                body_b: b.id,
                                triangle_b,
                            }),
                    );
                }
            }
        }
        all.sort_unstable();
        all
    }
}

/// A vertex in a naive edit.
#[derive(Clone, Copy)]
struct Vertex<S> {
    at: [S; 3],
    group: u32,
    rest: [S; 3],
    thickness: f64,
}

/// A naive edit of a mesh. A step that is refused makes all of it bad.
struct Draft<S> {
    triangles: Vec<Option<[u32; 3]>>,
    /// `None` if it is empty.
    vertices: Vec<Option<Vertex<S>>>,
    /// Largest thickness, which new vertices have.
    thickest: f64,
    /// Empty vertices that were placed again.
    placed: Vec<u32>,
}

impl<S: Scalar> Draft<S> {
    fn of(known: &Known<S>) -> Self {
        let mut triangles = vec![None; known.count];
        for (&number, &corners) in known.numbers.iter().zip(&known.triangles) {
            triangles[number as usize] = Some(corners);
        }
        let vertex = |vertex: usize| {
            (!known.empty[vertex]).then(|| Vertex {
                at: known.positions[vertex],
                group: known.groups[vertex],
                rest: known
                    .rest
                    .as_ref()
                    .map_or(known.positions[vertex], |it| it[vertex]),
                thickness: known.thickness.as_ref().map_or(0.0, |it| it[vertex]),
            })
        };
        let thickness = known.thickness.iter().flatten();
        Self {
            triangles,
            vertices: (0..known.positions.len()).map(vertex).collect(),
            thickest: thickness.copied().fold(0.0, f64::max),
            placed: Vec::new(),
        }
    }

    fn is_live(&self, vertex: u32) -> bool {
        matches!(self.vertices.get(vertex as usize), Some(Some(_)))
    }

    fn is_used(&self, vertex: u32) -> bool {
        let mut triangles = self.triangles.iter().flatten();
        triangles.any(|corners| corners.contains(&vertex))
    }

    /// A vertex that is new at a place.
    fn new_at(&self, at: [S; 3]) -> Vertex<S> {
        Vertex {
            at,
            group: 0,
            rest: at,
            thickness: self.thickest,
        }
    }

    fn add_vertex(&mut self, vertex: Vertex<S>) -> u32 {
        self.vertices.push(Some(vertex));
        self.vertices.len() as u32 - 1
    }

    fn place_vertex(&mut self, vertex: u32, at: [S; 3]) -> bool {
        let new = self.new_at(at);
        match self.vertices.get_mut(vertex as usize) {
            Some(place @ None) => {
                *place = Some(new);
                self.placed.push(vertex);
                true
            }
            _ => false,
        }
    }

    fn split_vertex(&mut self, vertex: u32, of: &[u32]) -> bool {
        let Some(&Some(same)) = self.vertices.get(vertex as usize) else {
            return false;
        };
        let new = self.add_vertex(same);
        of.iter().all(|&triangle| {
            let corners = self.triangles.get_mut(triangle as usize);
            let Some(Some(corners)) =
                corners.filter(|it| it.is_some_and(|it| it.contains(&vertex)))
            else {
                return false;
            };
            *corners = corners.map(|it| if it == vertex { new } else { it });
            true
        })
    }

    fn merge_vertices(&mut self, kept: u32, gone: u32) -> bool {
        if !self.is_live(kept) || !self.is_live(gone) {
            return false;
        }
        if kept != gone {
            for corners in self.triangles.iter_mut().flatten() {
                *corners = corners.map(|it| if it == gone { kept } else { it });
            }
            self.vertices[gone as usize] = None;
        }
        true
    }

    fn set_triangle(&mut self, triangle: u32, corners: [u32; 3]) -> bool {
        let are_live = corners.iter().all(|&it| self.is_live(it));
        let place = self.triangles.get_mut(triangle as usize);
        place
            .filter(|_| are_live)
            .map(|it| *it = Some(corners))
            .is_some()
    }

    fn remove_triangle(&mut self, triangle: u32) -> bool {
        let place = self.triangles.get_mut(triangle as usize);
        place.is_some_and(|it| it.take().is_some())
    }

    /// Whether the steps changed nothing: then a motion goes on.
    fn is_nothing(&self, known: &Known<S>) -> bool {
        let before = Self::of(known);
        let are_live =
            |mesh: &Self| -> Vec<bool> { mesh.vertices.iter().map(Option::is_some).collect() };
        self.triangles == before.triangles
            && are_live(self) == are_live(&before)
            && self.placed.is_empty()
    }

    /// Stores the facts after all steps. Vertices that lost their last triangle are empty.
    fn into_known(mut self, known: &mut Known<S>, anything: S) {
        if self.is_nothing(known) {
            return;
        }
        for vertex in known.triangles.concat() {
            // One that was merged into another and placed again is a new one.
            if !self.is_used(vertex) && !self.placed.contains(&vertex) {
                self.vertices[vertex as usize] = None;
            }
        }
        let live = (0..).zip(&self.triangles);
        let live = live.filter_map(|(number, corners)| Some((number, (*corners)?)));
        let before = std::mem::take(&mut known.numbers);
        (known.numbers, known.triangles) = live.unzip();
        if let Some((labels, _)) = &mut known.labels {
            let before: BTreeMap<u32, u32> = before.into_iter().zip(labels.drain(..)).collect();
            let label = |number| before.get(number).copied().unwrap_or(Labels::NONE);
            *labels = known.numbers.iter().map(label).collect();
        }
        known.count = self.triangles.len();
        known.empty = self.vertices.iter().map(Option::is_none).collect();
        let empty = Vertex {
            at: [anything; 3],
            group: 0,
            rest: [anything; 3],
            thickness: 0.0,
        };
        let vertices = self.vertices.into_iter();
        let vertices: Vec<Vertex<S>> = vertices.map(|it| it.unwrap_or(empty)).collect();
        known.positions = vertices.iter().map(|it| it.at).collect();
        known.groups = vertices.iter().map(|it| it.group).collect();
        if let Some(rest) = &mut known.rest {
            *rest = vertices.iter().map(|it| it.rest).collect();
        }
        if let Some(thickness) = &mut known.thickness {
            *thickness = vertices.iter().map(|it| it.thickness).collect();
        }
        known.end = None;
    }
}

impl<S> Known<S> {
    /// Thickness of a vertex.
    fn thick(&self, vertex: u32) -> f64 {
        let all = self.thickness.as_ref();
        all.map_or(0.0, |all| all[vertex as usize])
    }

    /// Largest thickness.
    fn thickest(&self) -> f64 {
        let all = self.thickness.iter().flatten();
        all.copied().fold(0.0, f64::max)
    }

    /// Edges, numbered as before any edit.
    fn edges(&self) -> Vec<[u32; 2]> {
        reference::edges(&self.triangles)
    }

    /// Sets the positions of empty vertices.
    fn fill_empty(&mut self, anything: S)
    where
        S: Copy,
    {
        for (position, _) in self
            .positions
            .iter_mut()
            .zip(&self.empty)
            .filter(|(_, it)| **it)
        {
            *position = [anything; 3];
        }
    }

    fn moving(&self) -> Moving<'_, S> {
        Moving {
            triangles: &self.triangles,
            positions: &self.positions,
            end: self.end.as_deref(),
            groups: Some(&self.groups),
            rest: self.rest.as_deref(),
            thickness: self.thickness.as_deref(),
            labels: self
                .labels
                .as_ref()
                .map(|(of_triangles, neighbours)| Labels {
                    of_triangles,
                    neighbours: neighbours.as_deref(),
                }),
        }
    }
}

macro_rules! list {
    ($($name:ident: $kept:ty => $($hit:ty: $method:ident($of:ident $(, $length:ident)?)),+;)*) => {
        /// The methods of every kind of query that the library's registry lists: all hits, as text.
        fn every_kind<S: Scalar>() -> Vec<(&'static str, fn(&mut World<S>, f64) -> String)> {
            vec![$($((stringify!($method), |world, within| {
                // A kind without a length takes none of it.
                let ($of, ($($length,)? ..)) = (Selection::Everything, (within,));
                format!("{:?}", world.$method($of $(, $length)?).all())
            }),)+)*]
        }
    };
}

pliant::every_kind! { list }

/// Selection of two bodies, or of one with itself.
fn selection<S>(a: &Known<S>, b: &Known<S>) -> Selection {
    if a.id == b.id {
        Selection::Within(a.id)
    } else {
        Selection::Between(a.id, b.id)
    }
}

fn pairs<S: Scalar>(a: &Known<S>, b: &Known<S>) -> Vec<[u32; 2]> {
    let pairs =
        reference::intersection_pairs(&a.triangles, &a.positions, &b.triangles, &b.positions);
    numbered(a, b, pairs.expect("the bodies were taken"))
}

/// Distances and thicknesses are multiples of 1/64, so their sums are exact.
fn close_triangles<S: Scalar>(a: &Known<S>, b: &Known<S>, distance: f64) -> Vec<[u32; 2]> {
    let is_one = a.id == b.id;
    let thick = |body: &Known<S>, triangle: [u32; 3]| {
        let all = triangle.map(|vertex| body.thick(vertex));
        all.into_iter().fold(0.0, f64::max)
    };
    let mut pairs = Vec::new();
    for (i, &of_a) in (0..).zip(&a.triangles) {
        for (j, &of_b) in (0..).zip(&b.triangles) {
            let distance = distance + thick(a, of_a) + thick(b, of_b);
            let are_close = |at_a: &[[S; 3]], at_b: &[[S; 3]]| {
                let close = if is_one {
                    reference::self_close_triangle_pairs(&[of_a, of_b], at_a, distance)
                } else {
                    reference::close_triangle_pairs(&[of_a], at_a, &[of_b], at_b, distance)
                };
                !close.expect("the bodies were taken").is_empty()
            };
            let rest = a.rest.as_deref().filter(|_| is_one);
            let is_pair = !is_one || i < j;
            if is_pair
                && are_close(&a.positions, &b.positions)
                && !rest.is_some_and(|rest| are_close(rest, rest))
            {
                pairs.push([i, j]);
            }
        }
    }
    if is_one {
        reference::leave_out(&a.moving(), &mut pairs);
    }
    numbered(a, b, pairs)
}

/// Pairs of triangles that are not empty, by their numbers.
fn numbered<S>(a: &Known<S>, b: &Known<S>, pairs: Vec<[u32; 2]>) -> Vec<[u32; 2]> {
    let pairs = pairs.into_iter();
    let numbers = pairs.map(|[i, j]| [a.numbers[i as usize], b.numbers[j as usize]]);
    numbers.collect()
}

/// Pairs of edges by their vertices, sorted, however the edges are numbered.
///
/// In one body with itself either edge may come first.
fn by_ends<T>(
    is_one: bool,
    [edges_a, edges_b]: [Vec<[u32; 2]>; 2],
    pairs: impl Iterator<Item = ([u32; 2], T)>,
) -> Vec<([[u32; 2]; 2], T)> {
    let pairs = pairs.map(|([a, b], more)| {
        let ends = [edges_a[a as usize], edges_b[b as usize]];
        let [a, b] = ends;
        (if is_one { [a.min(b), a.max(b)] } else { ends }, more)
    });
    let mut pairs: Vec<_> = pairs.collect();
    pairs.sort_by_key(|&(ends, _)| ends);
    pairs
}

/// Asserts that a distance is within its bound, and has a direction unless it is 0.
fn check_figures((distance, direction): (f64, Option<[f64; 3]>), within: f64) {
    assert!(distance >= 0.0 && distance <= within * (1.0 + f64::powi(0.5, 30)));
    assert_eq!(direction.is_none(), distance == 0.0);
    if let Some(direction) = direction {
        let length = direction.iter().map(|x| x * x).sum::<f64>();
        assert!((length - 1.0).abs() < f64::powi(0.5, 40), "{direction:?}");
    }
}
