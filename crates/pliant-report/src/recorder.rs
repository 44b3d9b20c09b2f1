//! Recorder: watches a world frame by frame and keeps what a page can hold.
//!
//! For any number of frames and pairs, what is kept stays within [`BUDGET`]. When that is full,
//! every second kept frame is dropped, again and again. The first frame with a contact, the frame
//! with the most pairs and the last frame are always kept. Numbers of pairs are kept for all
//! frames. A moment between frames is kept with the frame before it, and the first moment too, if
//! there is room.

use crate::frames::{
    BodyRecord, Frame, Gap, GapShown, Hits, LineShown, Moment, Motion, Shape, Spot,
};
use crate::label::BodyLabel;
use crate::lines;
use pliant::{BodyId, Scalar, World};
use std::borrow::Cow;
use std::sync::{Arc, Weak};

/// Most bytes of frames on a page, before compression.
///
/// A coordinate is rounded to two bytes, and a pair takes eight. In memory a frame takes twice as
/// much.
pub(crate) const BUDGET: usize = 30 << 20;

/// Most pairs of a frame that are kept as pairs; of more, only the triangles are kept. Bounds the
/// page.
const MOST_PAIRS: usize = 100_000;

/// Most gaps of a frame that are kept, the nearest. Bounds the page.
const MOST_GAPS: usize = 5_000;

/// Most pairs of a frame whose curves are drawn. Bounds the page.
pub(crate) const MOST_LINES: usize = 20_000;

/// Most places of a frame that are kept, the largest. Bounds the page.
const MOST_SPOTS: usize = 40;

/// Most impacts between two frames that are kept, the earliest. Bounds the page.
const MOST_CONTACTS: usize = 1_000;

/// Most levels of a tree that are shown.
const MOST_LEVELS: u32 = 16;

/// A frame and the meshes of its bodies in it. Its triangles are numbered consecutively through
/// these.
#[derive(Clone)]
struct Kept {
    frame: Frame,
    meshes: Vec<Arc<BodyRecord>>,
}

/// Recorder of one motion for a report.
///
/// A body whose mesh changes has one more record from that frame on. A record is dropped with the
/// last frame that shows it.
pub struct Recorder {
    labels: Vec<BodyLabel>,
    /// Bodies of the first frame, each with its current mesh.
    known: Vec<(BodyId, Arc<BodyRecord>)>,
    /// Numbers of bodies, vertices and triangles.
    sizes: [usize; 3],
    /// Meshes in the order in which they came. Meshes that no kept frame has are gone.
    meshes: Vec<Weak<BodyRecord>>,
    budget: usize,
    numbers: Vec<u32>,
    pairs: Vec<u64>,
    /// Least and largest depth of places so far.
    depths: Option<[f64; 2]>,
    kept: Vec<Arc<Kept>>,
    /// Sum of the costs of `kept`, without meshes.
    cost: usize,
    /// Frames whose index is a multiple of this are kept.
    stride: usize,
    first_contact: Option<Arc<Kept>>,
    worst: Option<Arc<Kept>>,
    last: Option<Arc<Kept>>,
    /// The first moment, with the frame before it.
    first_moment: Option<[Arc<Kept>; 2]>,
    too_large: bool,
}

impl Recorder {
    /// Creates a recorder. `labels` are for the bodies in their order; a body without one is named
    /// by its number.
    pub fn new(labels: Vec<BodyLabel>) -> Self {
        Self::within(labels, BUDGET)
    }

    /// Creates a recorder for one of several motions on a page, which share its budget.
    ///
    /// At least a few frames of bodies of 20,000 triangles each fit.
    pub fn one_of(labels: Vec<BodyLabel>, motions: usize) -> Self {
        Self::within(labels, (BUDGET / motions.max(1)).max(BUDGET / 8))
    }

    fn within(labels: Vec<BodyLabel>, budget: usize) -> Self {
        Self {
            labels,
            known: Vec::new(),
            sizes: [0; 3],
            meshes: Vec::new(),
            budget,
            numbers: Vec::new(),
            pairs: Vec::new(),
            depths: None,
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

    /// Records a frame: its number, the world in it, and the pairs found: body, triangle, body,
    /// triangle.
    ///
    /// The bodies are the first frame's. Pairs of other bodies are counted and not drawn. The
    /// world's boxes are as the queries left them. O(n log n) for n vertices, triangles and pairs.
    pub fn frame<S: Scalar>(&mut self, number: u32, world: &World<S>, pairs: &[[u32; 4]]) {
        self.frame_with(number, world, pairs, &[], &[], &[]);
    }

    /// [`frame`](Self::frame) with places, gaps and depths. Lines are drawn where pairs meet.
    ///
    /// `spots` are the places of the pairs, most pairs first. `gaps` are the closest points of
    /// pairs that do not intersect, sorted by pair. `deep` are triangles of places with a depth,
    /// each a body and a triangle, with that depth.
    pub fn frame_with<S: Scalar>(
        &mut self,
        number: u32,
        world: &World<S>,
        pairs: &[[u32; 4]],
        spots: &[Spot],
        gaps: &[Gap],
        deep: &[([u32; 2], f64)],
    ) {
        let index = self.numbers.len();
        self.numbers.push(number);
        self.pairs.push(pairs.len() as u64);
        for depth in spots.iter().filter_map(|spot| spot.depth) {
            let [least, most] = self.depths.unwrap_or([depth; 2]);
            self.depths = Some([least.min(depth), most.max(depth)]);
        }
        if index == 0 {
            self.meet_bodies(world);
        }
        if self.too_large || !self.meet_meshes(world) {
            return;
        }
        let mut frame = self.look(index, world, pairs, gaps, deep);
        frame.spots = spots.iter().take(MOST_SPOTS).cloned().collect();
        frame.all_spots = spots.len();
        let kept = self.with_meshes(frame);
        let count = pairs.len() as u64;
        if count > 0 && self.first_contact.is_none() {
            self.first_contact = Some(kept.clone());
        }
        let most = |worst: &Arc<Kept>| self.pairs[worst.frame.index];
        if count > self.worst.as_ref().map_or(0, most) {
            self.worst = Some(kept.clone());
        }
        self.last = Some(kept.clone());
        self.keep(kept);
    }

    /// Records impacts on the way from the frame recorded last to another.
    ///
    /// The world is in that frame, and its bodies have motions to the other. The page shows the
    /// bodies at the time of an impact.
    pub fn moment<S: Scalar>(&mut self, world: &World<S>, moment: &Moment) {
        // If the frame is not drawn, its moment is not either.
        let Some(index) = self.numbers.len().checked_sub(1) else {
            return;
        };
        let last = self.last.clone();
        let Some(last) = last.filter(|last| last.frame.index == index) else {
            return;
        };
        let shape = |mesh: &Arc<BodyRecord>| {
            let end = world.end_positions(mesh.id).ok().flatten();
            let end = end.or_else(|| drawn_positions(world, mesh.id))?;
            Some(Shape::of(&end))
        };
        let contacts = moment.contacts.iter().take(MOST_CONTACTS);
        let frame = Frame {
            index,
            shapes: last.meshes.iter().map(shape).collect(),
            hits: Hits::Pairs(Vec::new()),
            near: Vec::new(),
            gaps: Vec::new(),
            lines: Vec::new(),
            deep: Vec::new(),
            // The boxes belong to the frame's shape, not to this one.
            made: vec![false; last.frame.made.len()],
            spots: Vec::new(),
            all_spots: 0,
            moment: Some(Moment {
                contacts: contacts.copied().collect(),
                ..*moment
            }),
        };
        // Besides the four frames that always have room.
        let has_room = self.cost_of_meshes() + 6 * frame.cost() <= self.budget;
        let kept = self.with_meshes(frame);
        if self.first_moment.is_none() && has_room {
            self.first_moment = Some([last, kept.clone()]);
        }
        self.keep(kept);
    }

    fn with_meshes(&self, frame: Frame) -> Arc<Kept> {
        let meshes = self.known.iter().map(|(_, mesh)| mesh.clone());
        Arc::new(Kept {
            frame,
            meshes: meshes.collect(),
        })
    }

    /// Size of the meshes on the page, in bytes.
    fn cost_of_meshes(&self) -> usize {
        let meshes = self.meshes.iter().filter_map(Weak::upgrade);
        meshes.map(|mesh| mesh.cost()).sum()
    }

    /// Keeps a frame, and drops what does not fit.
    fn keep(&mut self, kept: Arc<Kept>) {
        if kept.frame.index.is_multiple_of(self.stride) {
            self.cost += kept.frame.cost();
            self.kept.push(kept);
        }
        while self.cost + self.cost_of_meshes() > self.budget && self.kept.len() > 1 {
            self.stride *= 2;
            let stride = self.stride;
            self.kept.retain(|it| it.frame.index.is_multiple_of(stride));
            self.cost = self.kept.iter().map(|it| it.frame.cost()).sum();
        }
        self.meshes.retain(|mesh| mesh.strong_count() > 0);
    }

    /// Ends the recording and returns the motion.
    pub fn finish(self) -> Motion {
        let mut kept = self.kept;
        kept.extend(
            [self.first_contact, self.worst, self.last]
                .into_iter()
                .flatten(),
        );
        kept.extend(self.first_moment.into_iter().flatten());
        // A moment comes after its frame.
        let key = |it: &Arc<Kept>| (it.frame.index, it.frame.moment.is_some());
        kept.sort_by_key(key);
        kept.dedup_by_key(|it| key(it));
        // Numbers all triangles consecutively. A mesh that no shown frame has is left out.
        drop(self.known);
        let meshes: Vec<_> = self.meshes.iter().filter_map(Weak::upgrade).collect();
        let is_shown = |mesh: &&Arc<BodyRecord>| {
            kept.iter()
                .any(|it| it.meshes.iter().any(|own| Arc::ptr_eq(own, mesh)))
        };
        let meshes: Vec<_> = meshes.iter().filter(is_shown).cloned().collect();
        let frames = kept
            .into_iter()
            .map(|it| in_row(Arc::unwrap_or_clone(it), &meshes));
        let frames = frames.collect();
        Motion {
            sizes: self.sizes,
            bodies: meshes.into_iter().map(Arc::unwrap_or_clone).collect(),
            numbers: self.numbers,
            pairs: self.pairs,
            depths: self.depths,
            frames,
            too_large: self.too_large,
        }
    }

    /// Takes the bodies of the first frame, their triangles and trees.
    fn meet_bodies<S: Scalar>(&mut self, world: &World<S>) {
        let ids: Vec<BodyId> = world.bodies().collect();
        let sizes = ids
            .iter()
            .filter_map(|&id| Some((world.vertex_count(id).ok()?, world.triangle_count(id).ok()?)));
        let (vertices, triangles) =
            sizes.fold((0, 0), |sum, size| (sum.0 + size.0, sum.1 + size.1));
        self.sizes = [ids.len(), vertices, triangles];
        // The frames that are always kept must fit.
        self.too_large = COST_OF_TRIANGLE * triangles + 4 * 6 * vertices > self.budget;
        if self.too_large {
            return;
        }
        let labels = std::mem::take(&mut self.labels).into_iter();
        let unnamed = (0..).map(|number| BodyLabel {
            name: format!("body {number}"),
            ..BodyLabel::default()
        });
        let named = labels.map(Some).chain(std::iter::repeat(None)).zip(unnamed);
        let mut number = 0;
        for (id, (label, unnamed)) in ids.into_iter().zip(named) {
            let mut label = label.unwrap_or(unnamed);
            // Parts of another number of triangles would not match.
            let count = world.triangle_count(id).unwrap_or_default();
            label.parts = label
                .parts
                .filter(|parts| parts.of_triangles.len() == count);
            let parts = label.parts.as_ref().map_or(1, |parts| parts.names.len());
            let triangles = drawn_triangles(world, id).unwrap_or_default().into_owned();
            let record = record(world, id, number, label, triangles);
            number += parts as u32;
            self.take_mesh(record);
        }
    }

    fn take_mesh(&mut self, mesh: BodyRecord) {
        let mesh = Arc::new(mesh);
        self.meshes.push(Arc::downgrade(&mesh));
        match self.known.iter_mut().find(|(id, _)| *id == mesh.id) {
            Some((_, now)) => *now = mesh,
            None => self.known.push((mesh.id, mesh)),
        }
    }

    /// Takes meshes that have changed since the frame before. Returns whether they fit.
    fn meet_meshes<S: Scalar>(&mut self, world: &World<S>) -> bool {
        for place in 0..self.known.len() {
            let (id, now) = &self.known[place];
            let id = *id;
            let triangles = drawn_triangles(world, id);
            let (Some(triangles), Ok(vertices)) = (triangles, world.vertex_count(id)) else {
                // The body was removed.
                continue;
            };
            let is_mesh = |mesh: &BodyRecord| {
                mesh.id == id && mesh.vertices == vertices && mesh.triangles == *triangles
            };
            if is_mesh(now) {
                continue;
            }
            // A body may return to an earlier mesh.
            let mut earlier = self.meshes.iter().filter_map(Weak::upgrade);
            if let Some(earlier) = earlier.find(|mesh| is_mesh(mesh)) {
                self.known[place].1 = earlier;
                continue;
            }
            // Faces and parts are known for the first mesh only.
            let label = BodyLabel {
                name: now.label.name.clone(),
                ..BodyLabel::default()
            };
            let number = now.number;
            self.take_mesh(record(world, id, number, label, triangles.into_owned()));
        }
        // Four frames must fit with meshes other than the first frame's.
        let first = self.kept.first();
        let is_first = |mesh: &Arc<BodyRecord>| {
            first.is_none_or(|first| first.meshes.iter().any(|it| Arc::ptr_eq(it, mesh)))
        };
        let others = self.known.iter().map(|(_, mesh)| mesh);
        let others = others.filter(|mesh| !is_first(mesh));
        let cost = others.map(|mesh| mesh.cost() + 6 * mesh.vertices);
        4 * cost.sum::<usize>() <= self.budget
    }

    fn look<S: Scalar>(
        &self,
        index: usize,
        world: &World<S>,
        pairs: &[[u32; 4]],
        gaps: &[Gap],
        deep: &[([u32; 2], f64)],
    ) -> Frame {
        let mut firsts = Vec::with_capacity(self.known.len());
        let mut first = 0;
        for (_, mesh) in &self.known {
            firsts.push(first);
            first += mesh.triangles.len() as u32;
        }
        let global = |body: u32, triangle: u32| {
            let place = self.known.binary_search_by_key(&body, |(id, _)| id.0);
            let place = place.ok()?;
            let is_there = (triangle as usize) < self.known[place].1.triangles.len();
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
        let deep = deep
            .iter()
            .filter_map(|&([body, triangle], depth)| Some((global(body, triangle)?, depth)));
        let deep = deep.collect();
        let mut lines: Vec<LineShown> = Vec::new();
        if pairs.len() <= MOST_LINES {
            let met = lines::of_pairs(world, pairs).into_iter();
            lines.extend(met.filter_map(|(pair, ends)| {
                let triangles = global_pair(&pair)?;
                Some(LineShown::new(triangles, ends))
            }));
        }
        let (mut shapes, mut made) = (Vec::with_capacity(self.known.len()), Vec::new());
        for (id, body) in &self.known {
            let positions = drawn_positions(world, *id);
            let positions = positions.filter(|positions| positions.len() == body.vertices);
            let is_shown = positions.is_some();
            shapes.push(positions.map(|positions| Shape::of(&positions)));
            if !is_shown {
                made.resize(made.len() + body.parts_of_tree(), false);
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
            index,
            shapes,
            hits,
            near,
            gaps,
            lines,
            deep,
            made,
            spots: Vec::new(),
            all_spots: 0,
            moment: None,
        }
    }
}

/// Bytes of a triangle: its corners, and the tree's order. All levels together take about as much
/// again.
const COST_OF_TRIANGLE: usize = 20;

impl BodyRecord {
    /// Size on the page, in bytes, before compression.
    fn cost(&self) -> usize {
        COST_OF_TRIANGLE * self.triangles.len()
    }

    /// Number of parts in all levels of the tree.
    fn parts_of_tree(&self) -> usize {
        self.starts.iter().map(Vec::len).sum()
    }
}

/// Record of a body with its current mesh.
fn record<S: Scalar>(
    world: &World<S>,
    id: BodyId,
    number: u32,
    label: BodyLabel,
    triangles: Vec<[u32; 3]>,
) -> BodyRecord {
    let vertices = world.vertex_count(id).unwrap_or_default();
    let depth = world.tree_shape(id).map_or(0, |shape| shape.depth);
    let levels: Vec<Vec<u32>> = (0..=depth.min(MOST_LEVELS - 1))
        .map(|level| drawn_parts(world, id, level))
        .collect();
    BodyRecord::new(id, number, label, vertices, triangles, &levels)
}

/// Renumbers the triangles of a frame consecutively through `meshes`, which include its own.
fn in_row(kept: Kept, meshes: &[Arc<BodyRecord>]) -> Frame {
    let Kept {
        mut frame,
        meshes: own,
    } = kept;
    let place = |mesh: &Arc<BodyRecord>| own.iter().position(|it| Arc::ptr_eq(it, mesh));
    let places: Vec<Option<usize>> = meshes.iter().map(place).collect();
    // Start of each own mesh's triangles in its numbering, and then in the new one; start of its
    // boxes.
    let (mut starts, mut boxes) = (vec![0], vec![0]);
    for mesh in &own {
        starts.push(starts[starts.len() - 1] + mesh.triangles.len() as u32);
        boxes.push(boxes[boxes.len() - 1] + mesh.parts_of_tree());
    }
    let mut starts_in_row = vec![0; own.len()];
    let mut start = 0;
    for (mesh, place) in meshes.iter().zip(&places) {
        if let Some(place) = *place {
            starts_in_row[place] = start;
        }
        start += mesh.triangles.len() as u32;
    }
    let in_row = |triangle: &mut u32| {
        let mesh = starts.partition_point(|start| start <= triangle) - 1;
        *triangle = starts_in_row[mesh] + (*triangle - starts[mesh]);
    };
    match &mut frame.hits {
        Hits::Pairs(pairs) => {
            pairs.as_flattened_mut().iter_mut().for_each(in_row);
            pairs.sort_unstable();
        }
        Hits::Triangles(triangles) => {
            triangles.iter_mut().for_each(in_row);
            triangles.sort_unstable();
        }
    }
    frame.near.iter_mut().for_each(in_row);
    frame.near.sort_unstable();
    for gap in &mut frame.gaps {
        gap.triangles.iter_mut().for_each(in_row);
    }
    for line in &mut frame.lines {
        line.triangles.iter_mut().for_each(in_row);
    }
    frame.deep.iter_mut().for_each(|(it, _)| in_row(it));
    frame.deep.sort_unstable_by_key(|&(triangle, _)| triangle);
    let mut shapes = std::mem::take(&mut frame.shapes);
    let shapes = places.iter().map(|place| shapes[(*place)?].take());
    frame.shapes = shapes.collect();
    let made = std::mem::take(&mut frame.made);
    let made = meshes
        .iter()
        .zip(&places)
        .flat_map(|(mesh, place)| match *place {
            Some(place) => made[boxes[place]..boxes[place + 1]].to_vec(),
            None => vec![false; mesh.parts_of_tree()],
        });
    frame.made = made.collect();
    frame
}

/// Some vertex of a triangle that is not empty.
fn some_vertex(triangles: &[[u32; 3]]) -> u32 {
    let mut live = triangles.iter().filter(|corners| **corners != EMPTY);
    live.next().map_or(0, |corners| corners[0])
}

/// Corners of a triangle's number that an edit has left empty.
const EMPTY: [u32; 3] = [u32::MAX; 3];

/// Triangles of a body; an empty one is drawn as a point.
fn drawn_triangles<S: Scalar>(world: &World<S>, id: BodyId) -> Option<Cow<'_, [[u32; 3]]>> {
    let triangles = world.triangles(id).ok()?;
    if !triangles.contains(&EMPTY) {
        return Some(Cow::Borrowed(triangles));
    }
    let point = [some_vertex(triangles); 3];
    let drawn = |&corners: &[u32; 3]| if corners == EMPTY { point } else { corners };
    Some(triangles.iter().map(drawn).collect())
}

/// Positions of a body's vertices; an empty vertex is put on another.
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

/// Part of each triangle in a cut of the tree at a level; an empty triangle is in the first.
fn drawn_parts<S: Scalar>(world: &World<S>, id: BodyId, level: u32) -> Vec<u32> {
    let mut parts = world.tree_cut(id, level).unwrap_or_default();
    for part in parts.iter_mut().filter(|part| **part == u32::MAX) {
        *part = 0;
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Contact, Elements};
    use crate::label::Parts;
    use crate::report::{Play, Report};
    use pliant::Options;

    /// Bytes of all that is kept, except frames that are always kept.
    fn cost(recorder: &Recorder) -> usize {
        let frames: usize = recorder.kept.iter().map(|it| it.frame.cost()).sum();
        assert_eq!(recorder.cost, frames);
        frames + recorder.cost_of_meshes()
    }

    /// Records a moving triangle. A frame takes 18 bytes, and 38 for each pair, as a triangle meets
    /// itself along three lines. The body takes 20.
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
            assert!(cost(&recorder) <= budget || recorder.kept.len() == 1);
        }
        recorder.finish()
    }

    #[test]
    fn frames_are_thinned_evenly_and_those_that_matter_stay() {
        let mut counts = [0; 100];
        // The first contact, the most pairs, and as many again.
        (counts[37], counts[71], counts[83]) = (1, 2, 2);
        let all = 20 + 18 * 100 + 38 * 5;
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
        // Figures count all frames.
        assert_eq!(motion.pairs().len(), 100);
        assert_eq!(
            (motion.first_contact(), motion.worst()),
            (Some(37), Some((71, 2)))
        );
    }

    #[test]
    fn lines_are_where_triangles_meet() {
        let mut world = World::<f32>::new();
        let floor = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        let leaf = [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 1.0, 1.0]];
        let beside = floor.map(|[x, y, z]| [x + 1.0, y + 1.0, z]);
        for shape in [floor, leaf, beside] {
            world.add(&[[0, 1, 2]], &shape).unwrap();
        }
        let mut recorder = Recorder::new(Vec::new());
        recorder.frame(0, &world, &[[0, 0, 1, 0], [0, 0, 2, 0]]);
        let motion = recorder.finish();
        let lines = &motion.frames[0].lines;
        // Edge 1 of the floor and edge 0 of the leaf; then the three sides of a polygon.
        let first = LineShown {
            triangles: [0, 1],
            on: [4, 9],
            parts: [16_384, 32_768],
        };
        assert_eq!((lines[0], lines.len()), (first, 4));
        assert!(lines[1..].iter().all(|line| line.triangles == [0, 2]));
    }

    #[test]
    fn a_moment_goes_to_the_next_frame_and_comes_behind_its_own() {
        let shape = |z: f32| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
        let mut world = World::<f32>::new();
        let [still, moves] = [0.0, 2.0].map(|z| world.add(&[[0, 1, 2]], &shape(z)).unwrap());
        let mut recorder = Recorder::new(Vec::new());
        let contact = Contact {
            time: 0.25,
            elements: Elements::VertexTriangle([1, 2, 0, 0]),
        };
        let moment = Moment {
            until: 8,
            count: Some(MOST_CONTACTS + 1),
            contacts: vec![contact; MOST_CONTACTS + 1],
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
            .map(|it| (it.index, it.moment.is_some()))
            .collect();
        assert_eq!(places, [(0, false), (0, true), (1, false)]);
        assert!(motion.shown().eq([5, 8]) && motion.pairs() == [0, 0]);
        let frame = &motion.frames[1];
        let heights = |id: BodyId| {
            let place = motion.bodies.iter().position(|it| it.id == id).unwrap();
            frame.shapes[place].as_ref().unwrap().lower[2]
        };
        assert_eq!((heights(still), heights(moves)), (0.0, -6.0));
        let kept = frame.moment.as_ref().unwrap();
        assert_eq!(kept.count, Some(MOST_CONTACTS + 1));
        assert_eq!(kept.contacts, moment.contacts[..MOST_CONTACTS]);
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
                    count: Some(1),
                    contacts: Vec::new(),
                };
                if number > 4 {
                    recorder.moment(&world, &moment);
                }
                assert!(cost(&recorder) <= budget || recorder.kept.len() == 1);
            }
            let frames = recorder.finish().frames;
            // Each moment follows its frame.
            for (at, frame) in frames.iter().enumerate() {
                assert!(frame.moment.is_none() || frames[at - 1].index == frame.index);
            }
            let moments = frames.iter().filter(|it| it.moment.is_some());
            moments.map(|it| it.index).collect()
        };
        assert_eq!(moments(1 << 20), (5..64).collect::<Vec<_>>());
        // A moment costs 118 bytes.
        assert_eq!(moments(20 + 6 * 118), [5, 16, 32, 48]);
        assert_eq!(moments(20 + 6 * 118 - 1), [16, 32, 48]);
    }

    #[test]
    fn bodies_that_no_page_can_hold_are_not_drawn() {
        let motion = record(20 + 4 * 18 - 1, &[0, 1, 0]);
        assert!(motion.too_large && motion.shown().count() == 0);
        assert_eq!(
            (motion.first_contact(), motion.sizes()),
            (Some(1), [1, 3, 1])
        );
        let mut report = Report::new("large");
        report.add(Play::new("large", "frame"), motion);
        let note = "The bodies have 1 triangles, too many to be drawn in a page; all figures are \
            complete.";
        assert!(report.page().contains(note));
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
        // Removed bodies are not drawn.
        let shown = |frame: &Frame| frame.shapes.iter().map(Option::is_some).collect();
        let shown: Vec<Vec<bool>> = motion.frames.iter().map(shown).collect();
        assert_eq!(
            shown,
            [[true, true], [false, true], [false, false], [false, false]]
        );
        assert!(!motion.pack().is_empty() && motion.normalisation().radius > 0.0);
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
        // Back to the first mesh, then a mesh with as many triangles as the second, but others.
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
                vec![first, first, None, None],
                vec![first, None, third, None],
                vec![first, first, None, None],
                vec![first, None, None, fourth]
            ]
        );
        let pairs = |frame: &Frame| match &frame.hits {
            Hits::Pairs(pairs) => pairs.clone(),
            Hits::Triangles(_) => Vec::new(),
        };
        let pairs: Vec<_> = motion.frames.iter().map(pairs).collect();
        // The first mesh has no triangle 1.
        assert_eq!(pairs, [[[0, 1]], [[0, 3]], [[0, 1]], [[0, 5]]]);
        assert!(!motion.pack().is_empty());
    }

    #[test]
    fn of_meshes_without_end_those_of_all_the_way_are_kept() {
        let mut world = World::<f32>::new();
        let flat = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let [still, body] = [(); 2].map(|()| world.add(&[[0, 1, 2]], &flat).unwrap());
        let record = |world: &mut World<f32>, budget: usize, most: usize| {
            let mut recorder = Recorder::within(Vec::new(), budget);
            for frame in 0..50 {
                // Each frame has a mesh of its own, except two that keep the mesh of the frame
                // before.
                let triangles = most + frame - frame % 25 / 24;
                world
                    .set_mesh(body, &vec![[0, 1, 2]; triangles], &flat)
                    .unwrap();
                let pairs = match frame {
                    13 => vec![[0, 0, 1, 11]],
                    29 => vec![[0, 0, 1, 27], [0, 0, 1, 28]],
                    _ => Vec::new(),
                };
                recorder.frame(frame as u32, world, &pairs);
                let is_drawn = recorder.last.as_ref().unwrap().frame.index == frame;
                assert!(!is_drawn || cost(&recorder) <= budget || recorder.kept.len() == 1);
            }
            recorder.finish()
        };
        let motion = record(&mut world, 8000, 1);
        // The first contact, the most pairs and the last, among frames that are spaced evenly.
        let shown: Vec<u32> = motion.shown().collect();
        let even = (0..50).step_by(4).collect::<Vec<u32>>();
        assert!(even.iter().all(|frame| shown.contains(frame)));
        assert_eq!(shown.len(), even.len() + 3);
        assert!([13, 29, 49].iter().all(|frame| shown.contains(frame)));
        // Every mesh is in some shown frame, and every frame shows both bodies.
        assert_eq!(motion.bodies.iter().filter(|it| it.id == still).count(), 1);
        for (place, body) in motion.bodies.iter().enumerate() {
            let is_shown = |frame: &Frame| frame.shapes[place].is_some();
            assert!(
                motion.frames.iter().any(is_shown),
                "{}",
                body.triangles.len()
            );
        }
        for frame in &motion.frames {
            let shown = motion.bodies.iter().zip(&frame.shapes);
            let shown: Vec<_> = shown.filter(|(_, shape)| shape.is_some()).collect();
            let sizes: Vec<_> = shown.iter().map(|(it, _)| it.triangles.len()).collect();
            let number = frame.index;
            assert_eq!(sizes, [1, 1 + number - number % 25 / 24], "frame {number}");
            let start = |at: &BodyRecord| {
                let before = motion.bodies.iter().take_while(|it| !std::ptr::eq(*it, at));
                before.map(|it| it.triangles.len()).sum::<usize>() as u32
            };
            let pairs: &[[u32; 2]] = match number {
                13 => &[[0, start(shown[1].0) + 11]],
                29 => &[27, 28].map(|it| [0, start(shown[1].0) + it]),
                _ => &[],
            };
            assert!(
                matches!(&frame.hits, Hits::Pairs(kept) if kept == pairs),
                "frame {number}"
            );
        }
        let mut report = Report::new("tear");
        report.add(Play::new("tear", "step"), motion);
        let note = "The picture shows 16 of 50 steps, since a page has room for 30 MiB of them; \
            the first contact, the step with the most pairs and the last are among them.";
        assert!(report.page().contains(note));
        // Meshes of which no four would fit are counted and not drawn, without any other note.
        let motion = record(&mut world, 8000, 80);
        let shown: Vec<u32> = motion.shown().collect();
        assert!(
            shown.contains(&13) && shown.last() == Some(&19),
            "{shown:?}"
        );
        assert_eq!(motion.worst(), Some((29, 2)));
        let mut report = Report::new("tear");
        report.add(Play::new("tear", "step"), motion);
        let page = report.page();
        assert!(page.contains("; the first contact is among them. All figures are of all steps."));
    }

    #[test]
    fn parts_have_numbers_of_their_own() {
        let mut world = World::<f32>::new();
        let flat = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let [_, _, last] = [1, 3, 1].map(|n| world.add(&vec![[0, 1, 2]; n], &flat).unwrap());
        let label = |name: &str, parts: &[&str], of_triangles: &[u32]| BodyLabel {
            name: name.to_owned(),
            faces: None,
            parts: Some(Parts {
                names: parts.iter().map(|&part| part.to_owned()).collect(),
                of_triangles: of_triangles.to_vec(),
            }),
        };
        // The first has fewer triangles than its label; the second has one without a part.
        let labels = vec![
            label("a", &["1", "2"], &[0, 1]),
            label("b", &["1", "2"], &[1, 0, 2]),
        ];
        let mut recorder = Recorder::new(labels);
        recorder.frame(0, &world, &[]);
        // The label's parts belong to the first mesh.
        world.set_mesh(last, &[[2, 1, 0]], &flat).unwrap();
        recorder.frame(1, &world, &[]);
        let bodies = recorder.finish().bodies;
        let facts: Vec<_> = bodies
            .iter()
            .map(|it| (it.label.name.as_str(), it.number, it.label.parts.is_some()))
            .collect();
        let third = ("body 2", 3, false);
        assert_eq!(facts, [("a", 0, false), ("b", 1, true), third, third]);
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
        let expected = [[1, 2], [1, 3], [2, 4]];
        assert!(matches!(&motion.frames[0].hits, Hits::Pairs(pairs) if *pairs == expected));
    }

    #[test]
    fn the_deepest_levels_of_a_deep_tree_are_not_shown() {
        // Each triangle is half as far from the origin as the one before: every cut at the centre
        // takes one off.
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
