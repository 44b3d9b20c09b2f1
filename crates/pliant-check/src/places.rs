//! Places: connected regions of intersecting pairs, tracked from frame to frame.
//!
//! A place is a connected component of hits. Two triangles of a source are neighbours if they share
//! a vertex after welding, whatever their bodies. Two pairs are of one place if a triangle of one
//! equals or neighbours a triangle of the other. Union-find over vertices (`joined`) finds places,
//! from pairs in any order. Memory: as `joined`, and about 130 bytes for each vertex of a hit.

use crate::joined::{Joined, Meshes};
use crate::pieces::NONE;
use crate::row::Row;
use pliant_exact::{End, Precision, intersection};
use std::cmp::Reverse;
use std::collections::{BTreeSet, HashMap, HashSet};

/// A connected region of intersecting pairs in one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Number of the place, from 0; the same in every frame of its life.
    pub number: usize,
    /// Number of pairs, those that share a vertex too.
    pub count: usize,
    /// The smallest pair.
    pub first_pair: Row,
    /// Bodies whose triangles intersect here, ascending.
    pub bodies: Vec<BodyThere>,
    /// Lower corner of the box of all points in which pairs meet; of pairs that are only close, of
    /// their triangles.
    pub lower: [f64; 3],
    /// Upper corner.
    pub upper: [f64; 3],
    /// Length of the segments in which pairs meet, all together. Triangles of one plane have none,
    /// and several pairs in one segment, along an edge, have one.
    pub length: f64,
    /// Depth of the deepest vertex inside the other body that is linked with the place by vertices
    /// inside; 0 if there is none. `None` if [`solid`](crate::Settings::solid) is not set, within
    /// one source, and where no source is closed.
    pub depth: Option<f64>,
}

/// Triangles of one body in a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BodyThere {
    /// Number of the body.
    pub body: u32,
    /// Number of its triangles that intersect there.
    pub triangles: usize,
    /// The lowest of these triangles.
    pub first_triangle: u32,
}

impl Place {
    /// Longest side of the bounding box.
    pub fn size(&self) -> f64 {
        let side = |axis: usize| self.upper[axis] - self.lower[axis];
        side(0).max(side(1)).max(side(2))
    }

    /// Centre of the bounding box.
    pub fn centre(&self) -> [f64; 3] {
        std::array::from_fn(|axis| f64::midpoint(self.lower[axis], self.upper[axis]))
    }
}

/// Finder of places, frame by frame.
///
/// # Numbers
///
/// Places share a triangle or a neighbour exactly if they share a vertex. Places of one frame share
/// none. So vertices tell which places of two frames are the same:
///
/// 1. Places of a frame are ordered by their pairs, most first; of equally many, the smaller first
///    pair is first.
/// 2. In this order each takes the lowest free number of the places with which it shares a vertex
///    in the frame before.
/// 3. Places that find none get new numbers, in the order of their first pairs.
///
/// So the lowest number survives where places merge. Where a place splits, its largest part keeps
/// the number. A number that nobody takes is never used again.
///
/// The frame before is the one looked at before, however many were skipped. A source whose mesh has
/// changed since shares no vertex with its former self. Its places go on only through sources that
/// kept their meshes.
#[derive(Debug, Default)]
pub struct Places {
    hits: Joined,
    /// The pairs whose first triangle has this slot for its first corner.
    pairs: Vec<Pairs>,
    along_edges: AlongEdges,
    /// Source and vertex of all vertices of places in the frame before, and the number of the
    /// place.
    before: Vec<([u32; 2], usize)>,
    next: usize,
}

/// Some pairs of a place: how many, the smallest, the box of where they meet, and the length.
#[derive(Clone, Copy, Debug)]
struct Pairs {
    count: usize,
    smallest: Row,
    lower: [f64; 3],
    upper: [f64; 3],
    length: f64,
}

/// Segments along edges, by the bits of their ends: several pairs of a frame may have one.
type AlongEdges = HashSet<[[u64; 3]; 2]>;

fn is_along_an_edge(p: End, q: End) -> bool {
    (0..2).any(|side| (0..3).any(|edge| p.on[side].is_on(edge) && q.on[side].is_on(edge)))
}

fn bits(p: End, q: End) -> [[u64; 3]; 2] {
    let mut ends = [p, q].map(|end| end.point.map(|x| (x + 0.0).to_bits()));
    ends.sort_unstable();
    ends
}

impl Pairs {
    const NONE: Self = Self {
        count: 0,
        smallest: [NONE; 4],
        lower: [f64::INFINITY; 3],
        upper: [f64::NEG_INFINITY; 3],
        length: 0.0,
    };

    fn take(&mut self, row: Row, [a, b]: &[[[f64; 3]; 3]; 2], along_edges: &mut AlongEdges) {
        self.count += 1;
        self.smallest = row.min(self.smallest);
        let both = intersection(Precision::Double, a, b);
        let ends: Vec<End> = both.ends().collect();
        ends.iter().for_each(|end| self.hold(end.point));
        if let [p, q] = ends[..]
            && !both.is_flat()
            && (!is_along_an_edge(p, q) || along_edges.insert(bits(p, q)))
        {
            let squares = (0..3).map(|axis| (p.point[axis] - q.point[axis]).powi(2));
            self.length += squares.sum::<f64>().sqrt();
        }
        if ends.is_empty() {
            a.iter().chain(b).for_each(|&corner| self.hold(corner));
        }
    }

    fn hold(&mut self, point: [f64; 3]) {
        for axis in 0..3 {
            self.lower[axis] = self.lower[axis].min(point[axis]);
            self.upper[axis] = self.upper[axis].max(point[axis]);
        }
    }
}

impl Places {
    /// Without any pairs.
    pub fn new() -> Self {
        Self::default()
    }

    /// Begins a frame, or begins it again: forgets pairs since the last [`end`](Self::end).
    pub fn begin(&mut self) {
        self.hits.clear();
        self.pairs.clear();
        self.along_edges.clear();
    }

    /// Takes a pair of triangles of sources, and the same pair as it is in answers.
    ///
    /// Each pair of a frame is taken once. A triangle or a vertex that the meshes lack is ignored.
    /// Amortised O(log v) for v vertices of hits.
    pub fn take(&mut self, meshes: &impl Meshes, of_sources: Row, row: Row) {
        let slot = self.hits.join(meshes, of_sources);
        let slots = self.hits.vertices().len();
        self.pairs.resize(slots, Pairs::NONE);
        let Some(slot) = slot else {
            return;
        };
        let [source_a, a, source_b, b] = of_sources;
        let corners = [(source_a, a), (source_b, b)].map(|(source, triangle)| {
            let corners = meshes.corners(source, triangle);
            corners.map(|vertex| meshes.position(source, vertex))
        });
        self.pairs[slot as usize].take(row, &corners, &mut self.along_edges);
    }

    /// Source and vertex of all vertices of places in the frame ended last, and the number of the
    /// place.
    pub(crate) fn vertices(&self) -> &[([u32; 2], usize)] {
        &self.before
    }

    /// Forgets the vertices of sources whose mesh has changed since the frame before.
    pub fn forget(&mut self, changed: &[usize]) {
        if !changed.is_empty() {
            self.before
                .retain(|([source, _], _)| !changed.contains(&(*source as usize)));
        }
    }

    /// Places of the pairs taken, most pairs first; of equally many, the smaller first pair first.
    ///
    /// O(v log v) for v vertices of hits. Begins the next frame.
    pub fn end(&mut self, meshes: &impl Meshes) -> Vec<Place> {
        // The root is the smallest of its set, so its place exists before any other slot needs it.
        let mut found: Vec<Place> = Vec::new();
        let mut place_of = vec![0_u32; self.pairs.len()];
        for slot in 0..self.pairs.len() {
            let root = self.hits.root(slot as u32) as usize;
            if root == slot {
                place_of[slot] = found.len() as u32;
                let none = Pairs::NONE;
                found.push(Place {
                    number: usize::MAX,
                    count: none.count,
                    first_pair: none.smallest,
                    bodies: Vec::new(),
                    lower: none.lower,
                    upper: none.upper,
                    length: none.length,
                    depth: None,
                });
            } else {
                place_of[slot] = place_of[root];
            }
            let place = &mut found[place_of[slot] as usize];
            let pairs = &self.pairs[slot];
            place.count += pairs.count;
            place.first_pair = place.first_pair.min(pairs.smallest);
            place.length += pairs.length;
            for axis in 0..3 {
                place.lower[axis] = place.lower[axis].min(pairs.lower[axis]);
                place.upper[axis] = place.upper[axis].max(pairs.upper[axis]);
            }
        }
        self.say_bodies(meshes, &place_of, &mut found);
        let mut order: Vec<u32> = (0..found.len() as u32).collect();
        order.sort_unstable_by_key(|&place| {
            let place = &found[place as usize];
            (Reverse(place.count), place.first_pair)
        });
        self.number(&place_of, &order, &mut found);
        let vertices = self.hits.vertices().iter().zip(&place_of);
        self.before.clear();
        self.before
            .extend(vertices.map(|(&vertex, &place)| (vertex, found[place as usize].number)));
        self.begin();
        found.sort_unstable_by_key(|place| (Reverse(place.count), place.first_pair));
        found
    }

    /// Adds the triangles of each body to their places.
    fn say_bodies(&self, meshes: &impl Meshes, place_of: &[u32], found: &mut [Place]) {
        // Index of a body in its place's list. A list is mostly short, but may hold a hundred
        // thousand pieces.
        let mut known: HashMap<[u32; 2], usize> = HashMap::new();
        let mut last = ([NONE; 2], 0);
        for &[source, triangle] in self.hits.triangles() {
            let slot = self.hits.slot_of_triangle(source, triangle);
            let key = [place_of[slot as usize], meshes.body(source, triangle)];
            let bodies = &mut found[key[0] as usize].bodies;
            if key != last.0 {
                let which = known.entry(key).or_insert(bodies.len());
                last = (key, *which);
            }
            match bodies.get_mut(last.1) {
                Some(body) => {
                    body.triangles += 1;
                    body.first_triangle = body.first_triangle.min(triangle);
                }
                None => bodies.push(BodyThere {
                    body: key[1],
                    triangles: 1,
                    first_triangle: triangle,
                }),
            }
        }
        for place in found {
            place.bodies.sort_unstable_by_key(|there| there.body);
        }
    }

    /// Numbers the places of a frame. `order` has the largest first.
    fn number(&mut self, place_of: &[u32], order: &[u32], found: &mut [Place]) {
        let mut shared: Vec<(u32, usize)> = Vec::new();
        for &([source, vertex], number) in &self.before {
            if let Some(slot) = self.hits.slot(source, vertex) {
                let place = place_of[slot as usize];
                if shared.last() != Some(&(place, number)) {
                    shared.push((place, number));
                }
            }
        }
        shared.sort_unstable();
        shared.dedup();
        let mut taken = BTreeSet::new();
        for &place in order {
            let from = shared.partition_point(|&(other, _)| other < place);
            let own = shared[from..].iter().take_while(|&&(it, _)| it == place);
            let mut numbers = own.map(|&(_, number)| number);
            if let Some(number) = numbers.find(|number| !taken.contains(number)) {
                taken.insert(number);
                found[place as usize].number = number;
            }
        }
        let mut new: Vec<&mut Place> = found
            .iter_mut()
            .filter(|place| place.number == usize::MAX)
            .collect();
        new.sort_unstable_by_key(|place| place.first_pair);
        for place in new {
            place.number = self.next;
            self.next += 1;
        }
    }
}
