//! Watches a world frame by frame and keeps what a page can hold.
//!
//! However many frames come, and however many triangles meet, what is kept stays within [`BUDGET`]: when it is full, every
//! second frame that is kept is let go, again and again. The first frame with a contact, the one with the most pairs and the
//! last are kept whatever happens. Numbers (pairs in each frame) are kept for all frames.

use crate::frames::{BodyRecord, Frame, Hits, Motion, Shape};
use pliant::{BodyId, Scalar, World};

/// The most bytes of frames that go into a page, before they are compressed: positions rounded to two bytes, pairs as eight.
/// In memory a frame takes twice as much.
const BUDGET: usize = 30 << 20;

/// Above this number of pairs in a frame, only which triangles are red is kept, not with whom each meets.
const MOST_PAIRS: usize = 100_000;

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
            too_large: false,
        }
    }

    /// Takes a frame: its number, the world in it, and the pairs found: body, triangle, body, triangle. The bodies are those of
    /// the first frame; pairs of others are counted and not drawn. The world's boxes are as the queries left them.
    pub fn frame<S: Scalar>(&mut self, number: u32, world: &World<S>, pairs: &[[u32; 4]]) {
        let place = self.numbers.len();
        self.numbers.push(number);
        self.pairs.push(pairs.len() as u64);
        if place == 0 {
            self.meet_bodies(world);
        }
        if self.too_large {
            return;
        }
        let frame = self.look(place, world, pairs);
        let count = pairs.len();
        if count > 0 && self.first_contact.is_none() {
            self.first_contact = Some(frame.clone());
        }
        let most = |worst: &Frame| self.pairs[worst.place];
        if count as u64 > self.worst.as_ref().map_or(0, most) {
            self.worst = Some(frame.clone());
        }
        if place.is_multiple_of(self.stride) {
            self.cost += frame.cost();
            self.kept.push(frame.clone());
        }
        self.last = Some(frame);
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
            [self.first_contact, self.worst, self.last]
                .into_iter()
                .flatten(),
        );
        frames.sort_by_key(|frame| frame.place);
        frames.dedup_by_key(|frame| frame.place);
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
        let mut labels = std::mem::take(&mut self.labels).into_iter();
        for (number, id) in ids.into_iter().enumerate() {
            let label = labels.next().unwrap_or_else(|| BodyLabel {
                name: format!("body {number}"),
                faces: None,
            });
            let vertices = world.vertex_count(id).unwrap_or_default();
            let triangles = world.triangles(id).unwrap_or_default().to_vec();
            let depth = world.tree_shape(id).map_or(0, |shape| shape.depth);
            let levels: Vec<Vec<u32>> = (0..=depth.min(MOST_LEVELS - 1))
                .map(|level| world.tree_cut(id, level).unwrap_or_default())
                .collect();
            self.bodies
                .push(BodyRecord::new(id, label, vertices, triangles, &levels));
        }
    }

    fn look<S: Scalar>(&self, place: usize, world: &World<S>, pairs: &[[u32; 4]]) -> Frame {
        let mut firsts = Vec::with_capacity(self.bodies.len());
        let mut first = 0;
        for body in &self.bodies {
            firsts.push(first);
            first += body.triangles.len() as u32;
        }
        let global = |body: u32, triangle: u32| {
            let place = self
                .bodies
                .binary_search_by_key(&body, |known| known.id.0)
                .ok()?;
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
        let (mut shapes, mut made) = (Vec::with_capacity(self.bodies.len()), Vec::new());
        for body in &self.bodies {
            let mut shape = Shape::of(&world.positions(body.id).unwrap_or_default());
            // Whatever became of the body: as many as there were.
            shape.inside.resize(body.vertices, [0.0; 3]);
            shapes.push(shape);
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
            made,
        }
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
        assert_eq!(record(all, &counts).shown().len(), 100);
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
    fn bodies_that_no_page_can_hold_are_not_drawn() {
        let motion = record(20 + 4 * 18 - 1, &[0, 1, 0]);
        assert!(motion.too_large && motion.shown().len() == 0);
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
        // As many vertices as there were, whatever became of the bodies.
        assert_eq!(motion.frames.len(), 4);
        for frame in &motion.frames {
            let vertices: Vec<usize> = frame.shapes.iter().map(|it| it.inside.len()).collect();
            assert_eq!(vertices, [3, 3]);
        }
        assert!(!motion.pack().is_empty() && motion.view().radius > 0.0);
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
