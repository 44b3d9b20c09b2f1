//! Watches a world frame by frame and keeps what a page can hold.
//!
//! However many frames come, and however many triangles meet, what is kept stays within [`BUDGET`]: when it is full, every
//! second frame that is kept is let go, again and again. The first frame with a contact, the one with the most pairs and the
//! last are kept whatever happens. Moments between frames are kept with the frame before them, and the first, where there is room. Numbers (pairs in each frame) are kept for all frames.
//!
//! A body that gets another mesh has a record more from that frame on, and each frame says which record it shows. Once the meshes
//! alone take half of what a page can hold, frames with further ones are counted and not drawn.

use crate::frames::{
    BodyRecord, Frame, Gap, GapShown, Hits, Moment, MomentShown, Motion, Shape, Spot,
};
use pliant::{BodyId, Scalar, World};
use std::borrow::Cow;

/// The most bytes of frames that go into a page, before they are compressed: positions rounded to two bytes, pairs as eight.
/// In memory a frame takes twice as much.
const BUDGET: usize = 30 << 20;

/// Above this number of pairs in a frame, only which triangles are red is kept, not with whom each meets.
const MOST_PAIRS: usize = 100_000;

/// Gaps of a frame that are kept.
const MOST_GAPS: usize = 5_000;

/// Places of a frame that are kept.
const MOST_SPOTS: usize = 40;

/// Levels of a tree that can be shown.
const MOST_LEVELS: u32 = 16;

/// A body, drawn and named.
#[derive(Clone, Debug, Default)]
pub struct BodyLabel {
    /// What people call it; its file, say. Anything may be in it.
    pub name: String,
    /// For each triangle the polygon of the file that it is a part of, where they differ.
    pub faces: Option<Vec<u32>>,
}

/// Keeps the frames of one motion for a report.
pub struct Recorder {
    labels: Vec<BodyLabel>,
    /// The bodies of the first frame, and the record of each that is its mesh now.
    known: Vec<(BodyId, usize)>,
    /// Bodies, vertices and triangles in all.
    sizes: [usize; 3],
    bodies: Vec<BodyRecord>,
    /// Bytes of a page that the bodies take, whatever the frames are.
    fixed: usize,
    budget: usize,
    numbers: Vec<u32>,
    pairs: Vec<u64>,
    kept: Vec<Frame>,
    /// The sum of the costs of `kept`.
    cost: usize,
    /// Frames whose place is a multiple of this are kept.
    stride: usize,
    first_contact: Option<Frame>,
    worst: Option<Frame>,
    last: Option<Frame>,
    first_moment: Option<Frame>,
    too_large: bool,
}

impl Recorder {
    /// Labels for the bodies, in their order; bodies without one have numbers only.
    pub fn new(labels: Vec<BodyLabel>) -> Self {
        Self::within(labels, BUDGET)
    }

    /// The same for one of several motions on a page, which share what a page can hold; at least a few frames of bodies of
    /// 20,000 triangles each find room.
    pub fn one_of(labels: Vec<BodyLabel>, motions: usize) -> Self {
        Self::within(labels, (BUDGET / motions.max(1)).max(BUDGET / 8))
    }

    fn within(labels: Vec<BodyLabel>, budget: usize) -> Self {
        Self {
            labels,
            known: Vec::new(),
            sizes: [0; 3],
            bodies: Vec::new(),
            fixed: 0,
            budget,
            numbers: Vec::new(),
            pairs: Vec::new(),
            kept: Vec::new(),
            cost: 0,
            stride: 1,
            first_contact: None,
            worst: None,
            last: None,
            first_moment: None,
            too_large: false,
        }
    }

    /// Takes a frame: its number, the world in it, and the pairs found: body, triangle, body, triangle. The bodies are those of
    /// the first frame; pairs of others are counted and not drawn. The world's boxes are as the queries left them.
    pub fn frame<S: Scalar>(&mut self, number: u32, world: &World<S>, pairs: &[[u32; 4]]) {
        self.frame_with(number, world, pairs, &[], &[]);
    }

    /// The same, with the places where the pairs hang together, most pairs first; and of pairs that are close and do not intersect the
    /// gaps, sorted by pair.
    pub fn frame_with<S: Scalar>(
        &mut self,
        number: u32,
        world: &World<S>,
        pairs: &[[u32; 4]],
        spots: &[Spot],
        gaps: &[Gap],
    ) {
        let place = self.numbers.len();
        self.numbers.push(number);
        self.pairs.push(pairs.len() as u64);
        if place == 0 {
            self.meet_bodies(world);
        }
        if self.too_large || !self.meet_meshes(world) {
            return;
        }
        let mut frame = self.look(place, world, pairs, gaps);
        frame.spots = spots.iter().take(MOST_SPOTS).cloned().collect();
        frame.all_spots = spots.len();
        let count = pairs.len();
        if count > 0 && self.first_contact.is_none() {
            self.first_contact = Some(frame.clone());
        }
        let most = |worst: &Frame| self.pairs[worst.place];
        if count as u64 > self.worst.as_ref().map_or(0, most) {
            self.worst = Some(frame.clone());
        }
        self.keep(&frame);
        self.last = Some(frame);
        self.thin();
    }

    /// Takes the first contact on the way from the frame taken last to another: the world is in that frame, and its bodies have motions to the
    /// other. The page shows the bodies as they are at that time.
    pub fn moment<S: Scalar>(&mut self, world: &World<S>, moment: &Moment) {
        // Where the frame is not drawn neither is what follows.
        let Some(place) = self.numbers.len().checked_sub(1) else {
            return;
        };
        if self.last.as_ref().is_none_or(|last| last.place != place) {
            return;
        }
        let mut frame = self.look(place, world, &moment.pairs, &[]);
        // Boxes are of the shape of the frame.
        frame.made.fill(false);
        let mut moved: Vec<(u32, Vec<[f64; 3]>)> = Vec::new();
        for (body, shape) in self.bodies.iter().zip(&mut frame.shapes) {
            if shape.is_some()
                && let Some(positions) = positions_at(world, body.id, moment.time)
            {
                *shape = Some(Shape::of(&positions));
                moved.push((body.id.0, positions));
            }
        }
        let position = |&[body, vertex]: &[u32; 2]| {
            let (_, positions) = moved.iter().find(|(id, _)| *id == body)?;
            positions.get(vertex as usize).copied()
        };
        let corners = moment.corners.each_ref();
        let corners = corners.map(|of| of.iter().filter_map(position).collect::<Vec<_>>());
        let all = || corners.iter().flatten();
        let lower = all().fold([f64::INFINITY; 3], |low, at| least(low, *at, f64::min));
        let upper = all().fold([f64::NEG_INFINITY; 3], |high, at| {
            least(high, *at, f64::max)
        });
        let size = (0..3)
            .map(|axis| upper[axis] - lower[axis])
            .fold(0.0, f64::max);
        if let Hits::Pairs(pairs) = &frame.hits
            && let Some(&triangles) = pairs.first()
        {
            let lines = corners.iter().flat_map(|of| outline(of, size / 8.0));
            let lines = lines.map(|points| GapShown { triangles, points });
            frame.gaps = lines.collect();
            frame.spots = vec![Spot {
                number: 0,
                count: moment.count,
                lower,
                upper,
                label: moment.label.clone(),
            }];
            frame.all_spots = 1;
        }
        frame.moment = Some(MomentShown {
            until: moment.until,
            time: moment.time,
            count: moment.count,
            label: moment.label.clone(),
        });
        // Beside the four frames that have room whatever happens.
        if self.first_moment.is_none() && self.fixed + 5 * frame.cost() <= self.budget {
            self.first_moment = Some(frame.clone());
        }
        self.keep(&frame);
        self.thin();
    }

    fn keep(&mut self, frame: &Frame) {
        if frame.place.is_multiple_of(self.stride) {
            self.cost += frame.cost();
            self.kept.push(frame.clone());
        }
    }

    /// Lets go what does not fit.
    fn thin(&mut self) {
        while self.cost + self.fixed > self.budget && self.kept.len() > 1 {
            self.stride *= 2;
            let stride = self.stride;
            self.kept.retain(|frame| frame.place.is_multiple_of(stride));
            self.cost = self.kept.iter().map(Frame::cost).sum();
        }
    }

    /// What was kept.
    pub fn finish(self) -> Motion {
        let mut frames = self.kept;
        frames.extend(
            [self.first_contact, self.worst, self.last, self.first_moment]
                .into_iter()
                .flatten(),
        );
        // A moment comes behind its frame.
        frames.sort_by_key(|frame| (frame.place, frame.moment.is_some()));
        frames.dedup_by_key(|frame| (frame.place, frame.moment.is_some()));
        Motion {
            sizes: self.sizes,
            bodies: self.bodies,
            numbers: self.numbers,
            pairs: self.pairs,
            frames,
            too_large: self.too_large,
        }
    }

    /// The bodies, their triangles and trees.
    fn meet_bodies<S: Scalar>(&mut self, world: &World<S>) {
        let ids: Vec<BodyId> = world.bodies().collect();
        let sizes = ids
            .iter()
            .filter_map(|&id| Some((world.vertex_count(id).ok()?, world.triangle_count(id).ok()?)));
        let (vertices, triangles) =
            sizes.fold((0, 0), |sum, size| (sum.0 + size.0, sum.1 + size.1));
        self.sizes = [ids.len(), vertices, triangles];
        // Corners and the order of the tree; its levels together are about as long again.
        self.fixed = triangles * 20;
        // The frames that are kept whatever happens must fit.
        self.too_large = self.fixed + 4 * 6 * vertices > self.budget;
        if self.too_large {
            return;
        }
        self.fixed = 0;
        let labels = std::mem::take(&mut self.labels).into_iter();
        let unnamed = (0..).map(|number| BodyLabel {
            name: format!("body {number}"),
            faces: None,
        });
        let named = labels.map(Some).chain(std::iter::repeat(None)).zip(unnamed);
        for (id, (label, unnamed)) in ids.into_iter().zip(named) {
            self.known.push((id, self.bodies.len()));
            self.record(world, id, label.unwrap_or(unnamed));
        }
    }

    /// Another mesh, or the first, of a body.
    fn record<S: Scalar>(&mut self, world: &World<S>, id: BodyId, label: BodyLabel) {
        let vertices = world.vertex_count(id).unwrap_or_default();
        let triangles = drawn_triangles(world, id).unwrap_or_default().into_owned();
        let depth = world.tree_shape(id).map_or(0, |shape| shape.depth);
        let levels: Vec<Vec<u32>> = (0..=depth.min(MOST_LEVELS - 1))
            .map(|level| drawn_parts(world, id, level))
            .collect();
        self.fixed += 20 * triangles.len();
        self.bodies
            .push(BodyRecord::new(id, label, vertices, triangles, &levels));
    }

    /// Takes the meshes that bodies have now and had not in the frame before; says whether there is room for them.
    fn meet_meshes<S: Scalar>(&mut self, world: &World<S>) -> bool {
        for place in 0..self.known.len() {
            let (id, record) = self.known[place];
            let triangles = drawn_triangles(world, id);
            let (Some(triangles), Ok(vertices)) = (triangles, world.vertex_count(id)) else {
                // It was removed.
                continue;
            };
            let is_mesh = |record: &BodyRecord| {
                record.id == id && record.vertices == vertices && record.triangles == *triangles
            };
            if is_mesh(&self.bodies[record]) {
                continue;
            }
            // Meshes may come back.
            if let Some(earlier) = self.bodies.iter().position(is_mesh) {
                self.known[place].1 = earlier;
                continue;
            }
            if self.fixed + 20 * triangles.len() > self.budget / 2 {
                return false;
            }
            // What is known of faces is known of the first mesh.
            let label = BodyLabel {
                name: self.bodies[record].label.name.clone(),
                faces: None,
            };
            self.known[place].1 = self.bodies.len();
            self.record(world, id, label);
        }
        true
    }

    fn look<S: Scalar>(
        &self,
        place: usize,
        world: &World<S>,
        pairs: &[[u32; 4]],
        gaps: &[Gap],
    ) -> Frame {
        let mut firsts = Vec::with_capacity(self.bodies.len());
        let mut first = 0;
        for body in &self.bodies {
            firsts.push(first);
            first += body.triangles.len() as u32;
        }
        let global = |body: u32, triangle: u32| {
            let known = self.known.binary_search_by_key(&body, |(id, _)| id.0);
            let (_, place) = self.known[known.ok()?];
            let is_there = (triangle as usize) < self.bodies[place].triangles.len();
            is_there.then(|| firsts[place] + triangle)
        };
        let global_pair =
            |&[body_a, a, body_b, b]: &[u32; 4]| Some([global(body_a, a)?, global(body_b, b)?]);
        let hits = if pairs.len() <= MOST_PAIRS {
            let mut rows: Vec<[u32; 2]> = pairs.iter().filter_map(global_pair).collect();
            rows.sort_unstable();
            Hits::Pairs(rows)
        } else {
            let mut is_red = vec![false; first as usize];
            for triangle in pairs.iter().filter_map(global_pair).flatten() {
                is_red[triangle as usize] = true;
            }
            Hits::Triangles(
                (0..first)
                    .filter(|&triangle| is_red[triangle as usize])
                    .collect(),
            )
        };
        let mut near: Vec<u32> = Vec::new();
        let mut kept: Vec<&Gap> = Vec::new();
        if !gaps.is_empty() {
            let is_apart =
                |pair: &&[u32; 4]| gaps.binary_search_by_key(*pair, |gap| gap.pair).is_ok();
            let mut is_red = vec![false; first as usize];
            let intersecting = pairs.iter().filter(|pair| !is_apart(pair));
            for triangle in intersecting.filter_map(global_pair).flatten() {
                is_red[triangle as usize] = true;
            }
            near = pairs.iter().filter_map(global_pair).flatten().collect();
            near.retain(|&triangle| !is_red[triangle as usize]);
            near.sort_unstable();
            near.dedup();
            kept = gaps.iter().collect();
            kept.sort_by(|a, b| a.distance.total_cmp(&b.distance));
            kept.truncate(MOST_GAPS);
        }
        let gaps = kept.into_iter().filter_map(|gap| {
            let triangles = global_pair(&gap.pair)?;
            Some(GapShown {
                triangles,
                points: gap.points,
            })
        });
        let gaps = gaps.collect();
        let (mut shapes, mut made) = (Vec::with_capacity(self.bodies.len()), Vec::new());
        for (number, body) in self.bodies.iter().enumerate() {
            let is_now = self.known.contains(&(body.id, number));
            let positions = drawn_positions(world, body.id).filter(|_| is_now);
            let positions = positions.filter(|positions| positions.len() == body.vertices);
            let is_shown = positions.is_some();
            shapes.push(positions.map(|positions| Shape::of(&positions)));
            if !is_shown {
                made.resize(
                    made.len() + body.starts.iter().map(Vec::len).sum::<usize>(),
                    false,
                );
                continue;
            }
            for (level, starts) in body.starts.iter().enumerate() {
                let boxes = world.tree_boxes(body.id, level as u32).unwrap_or_default();
                let end = made.len() + starts.len();
                made.extend(boxes.iter().map(|node| node.valid));
                made.resize(end, false);
            }
        }
        Frame {
            place,
            shapes,
            hits,
            near,
            gaps,
            made,
            spots: Vec::new(),
            all_spots: 0,
            moment: None,
        }
    }
}

/// A vertex of a body that is there.
fn some_vertex(triangles: &[[u32; 3]]) -> u32 {
    let mut live = triangles.iter().filter(|corners| **corners != EMPTY);
    live.next().map_or(0, |corners| corners[0])
}

/// The corners of a number that an edit has left empty.
const EMPTY: [u32; 3] = [u32::MAX; 3];

/// The triangles of a body; a number that is empty is drawn as a point.
fn drawn_triangles<S: Scalar>(world: &World<S>, id: BodyId) -> Option<Cow<'_, [[u32; 3]]>> {
    let triangles = world.triangles(id).ok()?;
    if !triangles.contains(&EMPTY) {
        return Some(Cow::Borrowed(triangles));
    }
    let point = [some_vertex(triangles); 3];
    let drawn = |&corners: &[u32; 3]| if corners == EMPTY { point } else { corners };
    Some(triangles.iter().map(drawn).collect())
}

/// Where the vertices of a body are; one that is empty is where another is.
fn drawn_positions<S: Scalar>(world: &World<S>, id: BodyId) -> Option<Vec<[S; 3]>> {
    let mut positions = world.positions(id).ok()?;
    let is_live = world.live_vertices(id).ok()?;
    let place = positions.get(some_vertex(world.triangles(id).ok()?) as usize);
    let place = place.copied()?;
    for (position, _) in positions.iter_mut().zip(is_live).filter(|(_, is)| !is) {
        *position = place;
    }
    Some(positions)
}

/// The parts of a tree that is cut at a level; a number that is empty is in the first.
fn drawn_parts<S: Scalar>(world: &World<S>, id: BodyId, level: u32) -> Vec<u32> {
    let mut parts = world.tree_cut(id, level).unwrap_or_default();
    for part in parts.iter_mut().filter(|part| **part == u32::MAX) {
        *part = 0;
    }
    parts
}

/// Where the vertices of a body are on their way.
fn positions_at<S: Scalar>(world: &World<S>, id: BodyId, time: f64) -> Option<Vec<[f64; 3]>> {
    let start = drawn_positions(world, id)?;
    let start: Vec<[f64; 3]> = start.iter().map(|at| at.map(S::to_f64)).collect();
    let Some(end) = world.end_positions(id).ok()? else {
        return Some(start);
    };
    let moved = start.iter().zip(&end).map(|(from, to)| {
        std::array::from_fn(|axis| from[axis] + time * (to[axis].to_f64() - from[axis]))
    });
    Some(moved.collect())
}

/// The smaller, or the larger, of each coordinate.
fn least(a: [f64; 3], b: [f64; 3], of: fn(f64, f64) -> f64) -> [f64; 3] {
    std::array::from_fn(|axis| of(a[axis], b[axis]))
}

/// Lines round an element: a cross of this size of a vertex, an edge, the sides of a triangle.
fn outline(corners: &[[f64; 3]], size: f64) -> Vec<[[f64; 3]; 2]> {
    match *corners {
        [at] => (0..3)
            .map(|axis| {
                let mut ends = [at; 2];
                ends[0][axis] -= size;
                ends[1][axis] += size;
                ends
            })
            .collect(),
        [a, b] => vec![[a, b]],
        [a, b, c] => vec![[a, b], [b, c], [c, a]],
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pliant::Options;

    /// One triangle that moves, in frames of 18 bytes and 8 for each pair; the body alone takes 20.
    fn record(budget: usize, counts: &[usize]) -> Motion {
        let mut world = World::<f32>::new();
        let body = world
            .add(&[[0, 1, 2]], &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
            .unwrap();
        let mut recorder = Recorder::within(Vec::new(), budget);
        for (number, &count) in counts.iter().enumerate() {
            let x = number as f32;
            let shape = [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0]];
            world.set_positions(body, &shape).unwrap();
            recorder.frame(number as u32, &world, &vec![[0, 0, 0, 0]; count]);
            assert!(recorder.cost + recorder.fixed <= budget || recorder.kept.len() == 1);
            let cost: usize = recorder.kept.iter().map(Frame::cost).sum();
            assert_eq!(recorder.cost, cost);
        }
        recorder.finish()
    }

    #[test]
    fn frames_are_thinned_evenly_and_those_that_matter_stay() {
        let mut counts = [0; 100];
        // The first contact, the most pairs, and as many once more.
        (counts[37], counts[71], counts[83]) = (1, 2, 2);
        let all = 20 + 18 * 100 + 8 * 5;
        assert_eq!(record(all, &counts).shown().count(), 100);
        for (budget, stride) in [(all - 1, 2), (20 + 18 * 30, 4), (20 + 18 * 20, 8)] {
            let mut expected: Vec<u32> = (0..100).step_by(stride).chain([37, 71, 99]).collect();
            expected.sort_unstable();
            assert!(
                record(budget, &counts).shown().eq(expected),
                "every {stride}th"
            );
        }
        let motion = record(20 + 18 * 30, &counts);
        // Figures are of all frames.
        assert_eq!(motion.pairs().len(), 100);
        assert_eq!(
            (motion.first_contact(), motion.worst()),
            (Some(37), Some((71, 2)))
        );
    }

    #[test]
    fn a_moment_has_the_shape_of_its_time_and_comes_behind_its_frame() {
        let shape = |z: f32| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
        let mut world = World::<f32>::new();
        let [still, moves] = [0.0, 2.0].map(|z| world.add(&[[0, 1, 2]], &shape(z)).unwrap());
        let mut recorder = Recorder::new(Vec::new());
        let moment = Moment {
            until: 8,
            time: 0.25,
            count: 3,
            corners: [vec![[1, 2]], vec![[0, 0], [0, 1], [0, 2]]],
            pairs: vec![[0, 0, 1, 0]],
            label: "both".to_owned(),
        };
        // There is no frame yet.
        recorder.moment(&world, &moment);
        recorder.frame(5, &world, &[]);
        world.set_motion(moves, &shape(-6.0)).unwrap();
        recorder.moment(&world, &moment);
        world.finish_motion();
        recorder.frame(8, &world, &[]);
        let motion = recorder.finish();
        let places: Vec<_> = motion
            .frames
            .iter()
            .map(|it| (it.place, it.moment.is_some()))
            .collect();
        assert_eq!(places, [(0, false), (0, true), (1, false)]);
        assert!(motion.shown().eq([5, 8]) && motion.pairs() == [0, 0]);
        let frame = &motion.frames[1];
        let heights = |id: BodyId| {
            let place = motion.bodies.iter().position(|it| it.id == id).unwrap();
            frame.shapes[place].as_ref().unwrap().lower[2]
        };
        assert_eq!((heights(still), heights(moves)), (0.0, 0.0));
        // A cross and a triangle; the box round both.
        assert_eq!(frame.gaps.len(), 6);
        let [spot] = &frame.spots[..] else {
            panic!("{:?}", frame.spots)
        };
        assert_eq!(
            (spot.count, spot.lower, spot.upper),
            (3, [0.0; 3], [1.0, 1.0, 0.0])
        );
        assert!(matches!(&frame.hits, Hits::Pairs(pairs) if *pairs == [[0, 1]]));
        assert!(!motion.pack().is_empty());
    }

    #[test]
    fn the_first_moment_is_kept_where_there_is_room() {
        let flat = [[0.0_f32; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let mut world = World::new();
        world.add(&[[0, 1, 2]], &flat).unwrap();
        let moments = |budget: usize| -> Vec<usize> {
            let mut recorder = Recorder::within(Vec::new(), budget);
            for number in 0..64 {
                recorder.frame(number, &world, &[]);
                let moment = Moment {
                    until: number + 1,
                    time: 0.5,
                    count: 1,
                    corners: Default::default(),
                    pairs: Vec::new(),
                    label: String::new(),
                };
                if number > 4 {
                    recorder.moment(&world, &moment);
                }
                assert!(recorder.cost + recorder.fixed <= budget || recorder.kept.len() == 1);
            }
            let frames = recorder.finish().frames;
            let moments = frames.iter().filter(|it| it.moment.is_some());
            moments.map(|it| it.place).collect()
        };
        assert_eq!(moments(1 << 20), (5..64).collect::<Vec<_>>());
        // A moment costs 118 bytes.
        assert_eq!(moments(20 + 5 * 118), [5, 16, 32, 48]);
        assert_eq!(moments(20 + 5 * 118 - 1), [16, 32, 48]);
    }

    #[test]
    fn bodies_that_no_page_can_hold_are_not_drawn() {
        let motion = record(20 + 4 * 18 - 1, &[0, 1, 0]);
        assert!(motion.too_large && motion.shown().count() == 0);
        assert_eq!(
            (motion.first_contact(), motion.sizes()),
            (Some(1), [1, 3, 1])
        );
        assert!(!record(20 + 4 * 18, &[0, 1, 0]).too_large);
    }

    #[test]
    fn nothing_that_becomes_of_a_world_stops_the_recorder() {
        let mut world = World::<f32>::new();
        let shape = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let [a, b] = [(); 2].map(|()| world.add(&[[0, 1, 2]], &shape).unwrap());
        let mut recorder = Recorder::new(Vec::new());
        let foreign = [
            [9, 0, 8, 0],
            [0, 7, 1, 0],
            [0, 0, u32::MAX, u32::MAX],
            [0, 0, 1, 0],
        ];
        recorder.frame(0, &world, &foreign);
        world.remove(a).unwrap();
        recorder.frame(1, &world, &vec![[0, 0, 9, 0]; MOST_PAIRS + 1]);
        world.remove(b).unwrap();
        world.add(&[[0, 1, 2]; 9], &shape).unwrap();
        recorder.frame(2, &World::<f64>::new(), &[]);
        recorder.frame(3, &world, &[[2, 0, 2, 1]]);
        let motion = recorder.finish();
        assert!(matches!(&motion.frames[0].hits, Hits::Pairs(pairs) if *pairs == [[0, 1]]));
        assert_eq!(motion.pairs(), [4, MOST_PAIRS as u64 + 1, 0, 1]);
        assert!(
            motion
                .frames
                .iter()
                .all(|frame| frame.made.len() == motion.frames[0].made.len())
        );
        // Bodies that are gone are not drawn.
        let shown = |frame: &Frame| frame.shapes.iter().map(Option::is_some).collect();
        let shown: Vec<Vec<bool>> = motion.frames.iter().map(shown).collect();
        assert_eq!(
            shown,
            [[true, true], [false, true], [false, false], [false, false]]
        );
        assert!(!motion.pack().is_empty() && motion.view().radius > 0.0);
    }

    #[test]
    fn every_frame_has_its_own_mesh() {
        let mut world = World::<f32>::new();
        let flat = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let square = [flat[0], flat[1], flat[2], [1.0, 1.0, 0.0]];
        let [still, body] = [(); 2].map(|()| world.add(&[[0, 1, 2]], &flat).unwrap());
        let mut recorder = Recorder::new(Vec::new());
        recorder.frame(0, &world, &[[0, 0, 1, 0]]);
        world
            .set_mesh(body, &[[0, 1, 2], [2, 1, 3]], &square)
            .unwrap();
        recorder.frame(1, &world, &[[0, 0, 1, 1]]);
        // Back to the first, then as many triangles as the second has, but others.
        world.set_mesh(body, &[[0, 1, 2]], &flat).unwrap();
        recorder.frame(2, &world, &[[0, 0, 1, 0], [0, 0, 1, 1]]);
        world
            .set_mesh(body, &[[0, 1, 2], [0, 1, 3]], &square)
            .unwrap();
        recorder.frame(3, &world, &[[0, 0, 1, 1]]);
        let motion = recorder.finish();
        let ids: Vec<_> = motion.bodies.iter().map(|it| it.id).collect();
        assert_eq!(ids, [still, body, body, body]);
        let vertices = |frame: &Frame| -> Vec<Option<usize>> {
            let shapes = frame.shapes.iter();
            shapes.map(|it| Some(it.as_ref()?.inside.len())).collect()
        };
        let shown: Vec<_> = motion.frames.iter().map(vertices).collect();
        let (first, third, fourth) = (Some(3), Some(4), Some(4));
        assert_eq!(
            shown,
            [
                vec![first, first],
                vec![first, None, third],
                vec![first, first, None],
                vec![first, None, None, fourth]
            ]
        );
        let pairs = |frame: &Frame| match &frame.hits {
            Hits::Pairs(pairs) => pairs.clone(),
            Hits::Triangles(_) => Vec::new(),
        };
        let pairs: Vec<_> = motion.frames.iter().map(pairs).collect();
        // Triangle 1 of the first mesh there is not.
        assert_eq!(pairs, [[[0, 1]], [[0, 3]], [[0, 1]], [[0, 5]]]);
        assert!(!motion.pack().is_empty());
    }

    #[test]
    fn meshes_without_end_find_no_room() {
        let mut world = World::<f32>::new();
        let flat = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let body = world.add(&[[0, 1, 2]], &flat).unwrap();
        let mut recorder = Recorder::within(Vec::new(), 4000);
        for frame in 0..50 {
            world
                .set_mesh(body, &vec![[0, 1, 2]; frame + 1], &flat)
                .unwrap();
            recorder.frame(frame as u32, &world, &[]);
            assert!(recorder.fixed <= 2000);
        }
        let motion = recorder.finish();
        assert_eq!((motion.pairs().len(), motion.shown().count()), (50, 13));
    }

    #[test]
    fn pairs_are_kept_in_order() {
        let mut world = World::<f32>::new();
        let shape = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        for triangles in [2, 3] {
            world.add(&vec![[0, 1, 2]; triangles], &shape).unwrap();
        }
        let mut recorder = Recorder::new(Vec::new());
        recorder.frame(0, &world, &[[1, 0, 1, 2], [0, 1, 1, 1], [0, 1, 1, 0]]);
        let motion = recorder.finish();
        assert!(
            matches!(&motion.frames[0].hits, Hits::Pairs(pairs) if *pairs == [[1, 2], [1, 3], [2, 4]])
        );
    }

    #[test]
    fn the_deepest_levels_of_a_deep_tree_are_not_shown() {
        // Each triangle half as far from the origin as the one before: every cut at the centre takes one off.
        let corners = (0..40).map(|triangle| 0.5_f32.powi(triangle));
        let positions: Vec<[f32; 3]> = corners
            .flat_map(|x| [[x, 0.0, 0.0], [x, x / 8.0, 0.0], [x, 0.0, x / 8.0]])
            .collect();
        let triangles: Vec<[u32; 3]> = (0..40).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let mut world = World::<f32>::with_options(Options::paper());
        let body = world.add(&triangles, &positions).unwrap();
        assert!(world.tree_shape(body).unwrap().depth >= MOST_LEVELS);
        let mut recorder = Recorder::new(Vec::new());
        recorder.frame(0, &world, &[]);
        let motion = recorder.finish();
        let starts = &motion.bodies[0].starts;
        assert_eq!(starts.len(), MOST_LEVELS as usize);
        let parts: usize = starts.iter().map(Vec::len).sum();
        assert_eq!(motion.frames[0].made.len(), parts);
    }

    #[test]
    fn motions_of_one_page_share_it_and_each_has_room() {
        let budget = |motions| Recorder::one_of(Vec::new(), motions).budget;
        let shared = [0, 1, 4, 8, 1000].map(budget);
        assert_eq!(shared, [BUDGET, BUDGET, BUDGET / 4, BUDGET / 8, BUDGET / 8]);
    }

    #[test]
    fn of_very_many_pairs_only_the_triangles_are_kept() {
        let motion = record(BUDGET, &[MOST_PAIRS, MOST_PAIRS + 1]);
        assert!(matches!(&motion.frames[0].hits, Hits::Pairs(pairs) if pairs.len() == MOST_PAIRS));
        assert!(matches!(&motion.frames[1].hits, Hits::Triangles(red) if *red == [0]));
    }
}
