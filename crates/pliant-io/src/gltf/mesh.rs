//! glTF mesh at rest: positions, triangles, joint weights and morph targets.
//!
//! The primitives of a mesh form one body, with their vertices one after another. Triangles, strips
//! and fans are evaluated; points and lines have no surface and are passed over. Morph targets keep
//! only the vertices that they move, so that memory grows with the data of the file.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use super::accessor::{Reader, Wanted, whole};
use crate::error::{Fault, Place, Reason};
use crate::memory::{Account, bytes_of};

/// A mesh at rest, without its triangles.
pub(super) struct Mesh {
    pub(super) rest: Vec<[f32; 3]>,
    /// Displacements of each morph target, in the order of vertices.
    pub(super) targets: Vec<Vec<Delta>>,
    /// Default weights of the morph targets, where neither a node nor an animation has any.
    pub(super) weights: Arc<[f64]>,
    /// Prefix sum over `influences`: those from `starts[v]` to `starts[v + 1]` belong to vertex v.
    ///
    /// Empty if a primitive has no joints.
    starts: Vec<u32>,
    influences: Vec<Influence>,
}

/// Most zero displacements in the morph targets of a file of `bytes` bytes.
///
/// Sixteen times as many as the file has room for, since primitives may share rows; and in no file
/// more than seconds of work.
fn most_that_stay(bytes: u64) -> u64 {
    let rows = bytes / size_of::<[f32; 3]>() as u64;
    rows.saturating_mul(16).saturating_add(1 << 24).min(1 << 28)
}

/// A displacement: a vertex that a morph target moves, and by how much.
pub(super) type Delta = (u32, [f32; 3]);

/// A joint that moves a vertex, and its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Influence {
    pub(super) joint: u16,
    pub(super) weight: f32,
}

/// Shares of a joint that differ by at most this much count as equal.
///
/// Covers some roundings of 32 bits, and of the four decimals that some programs show.
const NEARLY: f64 = 1e-5;

/// Representatives at one place with which a vertex is compared: the smallest ones.
///
/// There are usually a few vertices at one place; this limits the work where there are very many.
const MOST_COMPARED: usize = 64;

/// Primitive mode: triangles.
const TRIANGLES: u32 = 4;
/// Primitive mode: triangle strip.
const STRIP: u32 = 5;
/// Primitive mode: triangle fan.
const FAN: u32 = 6;

/// Attributes for joints: up to four sets of four.
const JOINTS: [&str; 4] = ["JOINTS_0", "JOINTS_1", "JOINTS_2", "JOINTS_3"];
/// Attributes for joint weights, one for each set.
const WEIGHTS: [&str; 4] = ["WEIGHTS_0", "WEIGHTS_1", "WEIGHTS_2", "WEIGHTS_3"];

impl Mesh {
    /// Reads a mesh and its triangles; None if it has no primitive with triangles.
    ///
    /// The triangles are needed only until every body of the mesh has its first frame.
    pub(super) fn read(
        reader: &mut Reader,
        number: usize,
    ) -> Result<Option<(Self, Vec<[u32; 3]>)>, Fault> {
        let at = |fault: Fault| fault.or_at(Place::Part("mesh", number));
        let malformed = |why: &str| at(Reason::Malformed(why.into()).into());
        let Some(entry) = reader.document.meshes.get_mut(number) else {
            return Err(malformed("there is no such mesh"));
        };
        let weights = std::mem::take(&mut entry.weights);
        reader.account.enter(bytes_of(&weights))?;
        let primitives = std::mem::take(&mut entry.primitives);
        let surfaces = || {
            primitives
                .iter()
                .filter(|primitive| (TRIANGLES..=FAN).contains(&primitive.mode))
        };
        if let Some(primitive) = primitives.iter().find(|primitive| primitive.mode > FAN) {
            let mode = primitive.mode;
            return Err(malformed(&format!(
                "a primitive has mode {mode}; glTF has modes 0 to {FAN}"
            )));
        }
        let mut mesh = Self {
            rest: Vec::new(),
            targets: Vec::new(),
            weights: weights.into(),
            starts: Vec::new(),
            influences: Vec::new(),
        };
        let targets = surfaces()
            .next()
            .map_or(0, |primitive| primitive.targets.len());
        if surfaces().any(|primitive| primitive.targets.len() != targets) {
            return Err(malformed(
                "its primitives have different numbers of morph targets",
            ));
        }
        let has_joints = surfaces().all(|primitive| primitive.attributes.contains_key(JOINTS[0]));
        mesh.targets.resize_with(targets, Vec::new);
        let mut triangles = Vec::new();
        for primitive in surfaces() {
            mesh.read_primitive(reader, primitive, has_joints, &mut triangles)
                .map_err(at)?;
        }
        if has_joints && !mesh.rest.is_empty() {
            let end = mesh.influences.len() as u32;
            reader.account.push(&mut mesh.starts, end, 0)?;
        }
        Ok(surfaces().next().is_some().then_some((mesh, triangles)))
    }

    fn read_primitive(
        &mut self,
        reader: &mut Reader,
        primitive: &super::document::Primitive,
        has_joints: bool,
        triangles: &mut Vec<[u32; 3]>,
    ) -> Result<(), Fault> {
        let begin = self.rest.len();
        let Some(&positions) = primitive.attributes.get("POSITION") else {
            return Err(Reason::Malformed("a primitive has no positions".into()).into());
        };
        let count = reader.count(positions)?;
        if (begin as u64).saturating_add(count) > u64::from(u32::MAX) {
            return Err(Reason::TooMany { what: "vertices" }.into());
        }
        let rest = &mut self.rest;
        reader.each_row(positions, Wanted::POSITIONS, |account, _, row| {
            Ok(account.push(rest, [row[0], row[1], row[2]].map(|x| x as f32), 0)?)
        })?;
        self.read_targets(reader, primitive, begin as u64, count)?;
        if has_joints {
            self.read_influences(reader, &primitive.attributes, count)?;
        }
        read_triangles(reader, primitive, begin as u32, count, triangles)
    }

    /// Reads the displacements of morph targets for `count` vertices, numbered from `begin`.
    ///
    /// Zero displacements take no memory, but time. So an accessor is read once for all targets
    /// that name it. Their number in a file is limited: a small file could otherwise keep a reader
    /// busy for hours.
    fn read_targets(
        &mut self,
        reader: &mut Reader,
        primitive: &super::document::Primitive,
        begin: u64,
        count: u64,
    ) -> Result<(), Fault> {
        // For each accessor read: the target that it was read into, and the range there.
        let mut known: BTreeMap<usize, (usize, Range<usize>)> = BTreeMap::new();
        for (number, attributes) in primitive.targets.iter().enumerate() {
            let Some(&deltas) = attributes.get("POSITION") else {
                continue;
            };
            if let Some((same, moved)) = known.get(&deltas) {
                for at in moved.clone() {
                    let delta = self.targets[*same][at];
                    reader.account.push(&mut self.targets[number], delta, 0)?;
                }
                continue;
            }
            reader.same_count(deltas, count, "morph target")?;
            let target = &mut self.targets[number];
            let first = target.len();
            let mut stay = 0;
            reader.each_row(deltas, Wanted::DELTAS, |account, vertex, row| {
                let delta = [row[0], row[1], row[2]].map(|x| x as f32);
                if delta == [0.0; 3] {
                    stay += 1;
                    return Ok(());
                }
                Ok(account.push(target, ((begin + vertex) as u32, delta), 0)?)
            })?;
            known.insert(deltas, (number, first..target.len()));
            reader.stay += stay;
            let most = most_that_stay(reader.buffers.bytes());
            if reader.stay > most {
                return Err(Reason::Malformed(format!(
                    "its morph targets hold more than {most} zero displacements, the most that \
                     are read; sparse accessors leave them out"
                ))
                .into());
            }
        }
        Ok(())
    }

    /// Reads the joints of the vertices of a primitive.
    ///
    /// Joints of all sets with a weight are kept, in ascending order: equal vertices are then equal
    /// whatever the order in the file.
    fn read_influences(
        &mut self,
        reader: &mut Reader,
        attributes: &BTreeMap<String, usize>,
        count: u64,
    ) -> Result<(), Fault> {
        if attributes.contains_key("JOINTS_4") {
            return Err(Reason::Unsupported(
                "more than 16 joints a vertex are not evaluated; export it with fewer".into(),
            )
            .into());
        }
        let mut of_vertices: Vec<[Influence; 4]> = Vec::new();
        let mut sets = 0;
        for (joints, weights) in JOINTS.iter().zip(WEIGHTS) {
            let Some(&joints) = attributes.get(*joints) else {
                break;
            };
            let Some(&weights) = attributes.get(weights) else {
                return Err(
                    Reason::Malformed("a primitive has joints without weights".into()).into(),
                );
            };
            reader.same_count(joints, count, "joints")?;
            reader.same_count(weights, count, "weights")?;
            let begin = of_vertices.len();
            reader.each_row(joints, Wanted::JOINTS, |account, _, row| {
                let mut four = [Influence {
                    joint: 0,
                    weight: 0.0,
                }; 4];
                for (influence, joint) in four.iter_mut().zip(row) {
                    influence.joint = whole(*joint) as u16;
                }
                Ok(account.push(&mut of_vertices, four, 0)?)
            })?;
            reader.each_row(weights, Wanted::WEIGHTS, |_, vertex, row| {
                let four = of_vertices.get_mut(begin + vertex as usize);
                for (influence, weight) in four.into_iter().flatten().zip(row) {
                    influence.weight = *weight as f32;
                }
                Ok(())
            })?;
            sets += 1;
        }
        let count = count as usize;
        for vertex in 0..count {
            let mut all = [Influence {
                joint: 0,
                weight: 0.0,
            }; 16];
            let mut some = 0;
            for set in 0..sets {
                for &influence in of_vertices.get(set * count + vertex).into_iter().flatten() {
                    if influence.weight != 0.0 {
                        all[some] = influence;
                        some += 1;
                    }
                }
            }
            if some == 0 {
                // A vertex without weights must be somewhere: it follows its first joint, as in
                // three.js.
                all[0] = Influence {
                    joint: of_vertices.get(vertex).map_or(0, |four| four[0].joint),
                    weight: 1.0,
                };
                some = 1;
            }
            all[..some]
                .sort_unstable_by_key(|influence| (influence.joint, influence.weight.to_bits()));
            let start = u32::try_from(self.influences.len()).map_err(|_| Reason::TooMany {
                what: "joints of vertices",
            })?;
            reader.account.push(&mut self.starts, start, 0)?;
            for &influence in &all[..some] {
                reader.account.push(&mut self.influences, influence, 0)?;
            }
        }
        reader.account.take_off(bytes_of(&of_vertices));
        Ok(())
    }

    /// Joints and weights of a vertex; none in a mesh without joints.
    pub(super) fn influences(&self, vertex: usize) -> &[Influence] {
        match self.starts.get(vertex..vertex + 2) {
            Some(&[start, end]) => &self.influences[start as usize..end as usize],
            _ => &[],
        }
    }

    /// Checks that the mesh has joints, all of them among the `joints` of a skin.
    pub(super) fn check_joints(&self, joints: usize) -> Result<(), Reason> {
        if self.starts.is_empty() {
            return Err(Reason::Malformed(
                "has a skin, but a primitive of its mesh has no joints".into(),
            ));
        }
        for vertex in 0..self.rest.len() {
            if let Some(bad) = self
                .influences(vertex)
                .iter()
                .find(|it| usize::from(it.joint) >= joints)
            {
                return Err(Reason::Malformed(format!(
                    "vertex {vertex} names joint {}, but the skin has {joints} joints",
                    bad.joint
                )));
            }
        }
        Ok(())
    }

    /// Whether joints have the same shares of two vertices, within [`NEARLY`].
    ///
    /// A share is a weight divided by the sum of weights; a joint that is not named has none.
    fn weigh_nearly_alike(&self, a: u32, b: u32) -> bool {
        let [a, b] = [a, b].map(|vertex| self.influences(vertex as usize));
        let whole = |all: &[Influence]| all.iter().map(|it| f64::from(it.weight)).sum::<f64>();
        let (whole_a, whole_b) = (whole(a), whole(b));
        let (mut a, mut b) = (a, b);
        // Both lists are in the order of joints.
        let next = |all: &[Influence]| all.first().map(|it| it.joint);
        while let Some(joint) = next(a).into_iter().chain(next(b)).min() {
            let part = taken(&mut a, joint) / whole_a - taken(&mut b, joint) / whole_b;
            // NaN where the weights cancel each other.
            if part.is_nan() || part.abs() > NEARLY {
                return false;
            }
        }
        true
    }

    /// Whether two vertices have equal joints and weights, to the bit.
    pub(super) fn weigh_alike(&self, a: u32, b: u32) -> bool {
        let [a, b] = [a, b].map(|vertex| self.influences(vertex as usize));
        a == b
    }

    /// Upper bound of the bytes that [`alike`](Self::alike) takes.
    pub(super) fn memory_of_alike(&self, skinned: bool) -> u64 {
        let vertices = self.rest.len() as u64;
        let moved = self.targets.iter().map(Vec::len).max().unwrap_or(0) as u64;
        let runs = if skinned {
            vertices * size_of::<EqualWeights>() as u64
        } else {
            0
        };
        12 * vertices + runs.max(32 * moved)
    }

    /// Weld key of each vertex: equal where vertices coincide at rest and move alike.
    ///
    /// Morph targets must move them alike to the bit, joints within [`NEARLY`]. Exporters that
    /// divide weights by their sum leave such differences on two sides of a seam. Takes O(n log n)
    /// per target.
    pub(super) fn alike(&self, skinned: bool) -> Vec<u64> {
        let mut class = self.moved_alike();
        if skinned && !self.starts.is_empty() {
            self.part_by_weights(&mut class);
        }
        class
    }

    /// Weld keys as in [`alike`](Self::alike), but without joints.
    fn moved_alike(&self) -> Vec<u64> {
        let bits = |place: [f32; 3]| place.map(|x| (x + 0.0).to_bits());
        let place = |vertex: u32| bits(self.rest[vertex as usize]);
        let mut vertices: Vec<u32> = (0..self.rest.len() as u32).collect();
        vertices.sort_unstable_by_key(|&vertex| place(vertex));
        let mut class = vec![0_u64; vertices.len()];
        let mut next = 0;
        for together in vertices.chunk_by(|&a, &b| place(a) == place(b)) {
            for &vertex in together {
                class[vertex as usize] = next;
            }
            next += 1;
        }
        drop(vertices);
        // Vertices of a class that a target moves alike leave it together.
        for target in &self.targets {
            let mut moved: Vec<(u64, [u32; 3], u32)> = target
                .iter()
                .map(|&(vertex, delta)| (class[vertex as usize], bits(delta), vertex))
                .collect();
            moved.sort_unstable();
            for together in moved.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
                for &(_, _, vertex) in together {
                    class[vertex as usize] = next;
                }
                next += 1;
            }
        }
        class
    }

    /// Splits each class by joint weights that are not nearly equal.
    ///
    /// Nearness is not transitive, so a rule decides. Vertices of bitwise equal weights stay
    /// together; the smallest represents them. In ascending order, each representative joins the
    /// first leader that it is near, or becomes a leader. So all vertices of a class are within
    /// [`NEARLY`] of their leader, and within twice that of each other.
    fn part_by_weights(&self, class: &mut [u64]) {
        let bits = |vertex: u32| {
            let influences = self.influences(vertex as usize).iter();
            influences.map(|it| (it.joint, it.weight.to_bits()))
        };
        let mut vertices: Vec<u32> = (0..class.len() as u32).collect();
        vertices.sort_unstable_by(|&a, &b| {
            (class[a as usize].cmp(&class[b as usize]))
                .then_with(|| bits(a).cmp(bits(b)))
                .then(a.cmp(&b))
        });
        let mut next = class.iter().max().map_or(0, |last| last + 1);
        let mut runs: Vec<EqualWeights> = Vec::with_capacity(vertices.len());
        let mut leaders: Vec<(u32, u64)> = Vec::with_capacity(MOST_COMPARED);
        let mut rest = &vertices[..];
        while let Some(&first) = rest.first() {
            let own = class[first as usize];
            let is_own = |vertex: &&u32| class[**vertex as usize] == own;
            let (together, others) = rest.split_at(rest.iter().take_while(is_own).count());
            rest = others;
            runs.clear();
            let mut begin = 0;
            for run in together.chunk_by(|&a, &b| bits(a).eq(bits(b))) {
                let end = begin + run.len() as u32;
                runs.push((run[0], begin, end));
                begin = end;
            }
            runs.sort_unstable();
            leaders.clear();
            for &(vertex, begin, end) in &runs {
                let near = |&&(leader, _): &&(u32, u64)| self.weigh_nearly_alike(leader, vertex);
                let number = if let Some(&(_, number)) = leaders.iter().find(near) {
                    number
                } else {
                    if leaders.len() < MOST_COMPARED {
                        leaders.push((vertex, next));
                    }
                    next += 1;
                    next - 1
                };
                for &vertex in &together[begin as usize..end as usize] {
                    class[vertex as usize] = number;
                }
            }
        }
    }
}

/// Vertices of bitwise equal weights: the smallest, and their range.
type EqualWeights = (u32, u32, u32);

/// Removes a joint from the front of a sorted list; returns its total weight.
fn taken(all: &mut &[Influence], joint: u16) -> f64 {
    let mut weight = 0.0;
    while let [first, rest @ ..] = all
        && first.joint == joint
    {
        weight += f64::from(first.weight);
        *all = rest;
    }
    weight
}

impl Reader {
    fn same_count(&self, accessor: usize, count: u64, what: &str) -> Result<(), Fault> {
        let found = self.count(accessor)?;
        if found == count {
            return Ok(());
        }
        let reason = format!("has {found} {what} rows for {count} positions");
        Err(Reason::Malformed(reason).at(Place::Part("accessor", accessor)))
    }
}

/// Appends the triangles of a primitive, whose `count` vertices are numbered from `begin`.
fn read_triangles(
    reader: &mut Reader,
    primitive: &super::document::Primitive,
    begin: u32,
    count: u64,
    triangles: &mut Vec<[u32; 3]>,
) -> Result<(), Fault> {
    let mode = primitive.mode;
    // The two corners with which the next one makes a triangle, and the number of corners so far.
    let (mut first, mut last, mut met) = (0, 0, 0_u64);
    let mut corner = |account: &mut Account, index: f64| -> Result<(), Fault> {
        if index >= count as f64 {
            let last = count as i64 - 1;
            let (face, index) = (triangles.len() as u64, index as i64);
            return Err(Reason::VertexIndex {
                face,
                index,
                first: 0,
                last,
            }
            .into());
        }
        let corner = begin + whole(index) as u32;
        match (mode, met) {
            (_, 0) => first = corner,
            (TRIANGLES, _) if met % 3 == 0 => first = corner,
            (TRIANGLES, _) if met % 3 == 1 => last = corner,
            (_, 1) => last = corner,
            _ => {
                // Every other triangle of a strip is reversed.
                let turned = mode == STRIP && met % 2 == 1;
                let triangle = if turned {
                    [first, corner, last]
                } else {
                    [first, last, corner]
                };
                account.push(triangles, triangle, 0)?;
                if mode == STRIP {
                    first = last;
                }
                last = corner;
            }
        }
        met += 1;
        Ok(())
    };
    match primitive.indices {
        Some(indices) => {
            let place = Place::Part("accessor", indices);
            reader.each_row(indices, Wanted::INDICES, |account, _, row| {
                corner(account, row[0]).map_err(|fault| fault.or_at(place.clone()))
            })?;
        }
        None => {
            for index in 0..count {
                corner(&mut reader.account, index as f64)?;
            }
        }
    }
    let wrong = if mode == TRIANGLES {
        (met % 3 != 0).then_some("which is no multiple of 3")
    } else {
        (met == 1 || met == 2).then_some("but its first triangle needs 3")
    };
    if let Some(wrong) = wrong {
        let reason = format!("a primitive of mode {mode} has {met} corners, {wrong}");
        return Err(Reason::Malformed(reason).into());
    }
    if triangles.len() > u32::MAX as usize {
        return Err(Reason::TooMany { what: "triangles" }.into());
    }
    Ok(())
}
