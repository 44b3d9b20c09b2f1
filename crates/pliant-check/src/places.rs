//! Places: hits that hang together, and which of them are the same from frame to frame.
//!
//! Two triangles of a mesh are *neighbours* if they share a vertex of it as it is checked, after welding, whatever bodies they are of.
//! Two pairs are of one place if a triangle of the one and a triangle of the other, of the same source, are equal or neighbours; and
//! so on from pair to pair. A place is then a set of vertices, those of its triangles, no two places of a frame share one, and a place
//! shares a triangle or a neighbour with one of another frame exactly if it shares a vertex with it. So pairs are joined by union-find
//! over vertices (`joined`), as they are found and in any order: three vertices of a triangle that is new, and one step a pair. It takes
//! four bytes a vertex and a triangle of sources that are hit, and about 60 bytes a vertex that is.
//!
//! **Numbers.** Places of a frame are ordered by their pairs, most first; of equally many, the one with the smaller first pair. In this
//! order each takes the lowest number, not yet taken in this frame, of the places that it shares a vertex with in the frame before. So
//! where places merge the lowest number goes on, and where one splits its largest part keeps the number. What finds none gets a new one,
//! new places in the order of their first pairs. A number that is not taken is never used again. The frame before is the one
//! looked at before, however many were passed over. A source whose mesh has changed since has no vertex in common with what it
//! was: places go on through sources that kept theirs only.

use crate::joined::{Joined, Meshes};
use crate::pieces::NONE;
use crate::row::Row;
use std::cmp::Reverse;
use std::collections::{BTreeSet, HashMap};

/// Hits that hang together.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// The same from frame to frame while the place lives; from 0.
    pub number: usize,
    /// How many pairs.
    pub count: usize,
    /// The smallest of them.
    pub first_pair: Row,
    /// Whose triangles intersect here, ascending.
    pub bodies: Vec<BodyThere>,
    /// The smallest coordinates of these triangles.
    pub lower: [f64; 3],
    /// The largest.
    pub upper: [f64; 3],
}

/// The triangles of a body in a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BodyThere {
    /// The body.
    pub body: u32,
    /// How many of its triangles intersect there.
    pub triangles: usize,
    /// The lowest of them.
    pub first_triangle: u32,
}

impl Place {
    /// The longest side of its box.
    pub fn size(&self) -> f64 {
        let side = |axis: usize| self.upper[axis] - self.lower[axis];
        side(0).max(side(1)).max(side(2))
    }

    /// The middle of its box.
    pub fn centre(&self) -> [f64; 3] {
        std::array::from_fn(|axis| f64::midpoint(self.lower[axis], self.upper[axis]))
    }
}

/// Finds places, frame by frame.
#[derive(Debug, Default)]
pub struct Places {
    hits: Joined,
    /// The pairs whose first triangle has this slot for its first corner: how many, and the smallest.
    pairs: Vec<(u32, Row)>,
    /// Source and vertex of the places of the frame before, and their number.
    before: Vec<([u32; 2], usize)>,
    next: usize,
}

impl Places {
    /// Nothing found yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Begins a frame, or begins it again: pairs since the last [`end`](Self::end) are forgotten.
    pub fn begin(&mut self) {
        self.hits.clear();
        self.pairs.clear();
    }

    /// Takes a pair of triangles of sources, and what it is in answers. Each pair of a frame is to be taken once; a triangle, or a
    /// vertex, that the meshes have not is ignored.
    pub fn take(&mut self, meshes: &impl Meshes, of_sources: Row, row: Row) {
        let slot = self.hits.join(meshes, of_sources);
        let slots = self.hits.vertices().len();
        self.pairs.resize(slots, (0, [NONE; 4]));
        let Some(slot) = slot else {
            return;
        };
        let (count, smallest) = &mut self.pairs[slot as usize];
        *count += 1;
        *smallest = row.min(*smallest);
    }

    /// The sources that have another mesh than in the frame before: what is known of their vertices is forgotten.
    pub fn forget(&mut self, changed: &[usize]) {
        if !changed.is_empty() {
            self.before
                .retain(|([source, _], _)| !changed.contains(&(*source as usize)));
        }
    }

    /// The places of the pairs that were taken, most pairs first; of equally many, the smaller first pair first.
    pub fn end(&mut self, meshes: &impl Meshes) -> Vec<Place> {
        // The smallest of a set leads it, so that its place is there before any other slot of it comes.
        let mut found: Vec<Place> = Vec::new();
        let mut place_of = vec![0_u32; self.pairs.len()];
        for slot in 0..self.pairs.len() {
            let leader = self.hits.leader(slot as u32) as usize;
            if leader == slot {
                place_of[slot] = found.len() as u32;
                found.push(Place {
                    number: usize::MAX,
                    count: 0,
                    first_pair: [NONE; 4],
                    bodies: Vec::new(),
                    lower: [f64::INFINITY; 3],
                    upper: [f64::NEG_INFINITY; 3],
                });
            } else {
                place_of[slot] = place_of[leader];
            }
            let place = &mut found[place_of[slot] as usize];
            let (count, smallest) = self.pairs[slot];
            place.count += count as usize;
            place.first_pair = place.first_pair.min(smallest);
            let [source, vertex] = self.hits.vertices()[slot];
            let position = meshes.position(source, vertex);
            for axis in 0..3 {
                place.lower[axis] = place.lower[axis].min(position[axis]);
                place.upper[axis] = place.upper[axis].max(position[axis]);
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

    /// Whose triangles are where.
    fn say_bodies(&self, meshes: &impl Meshes, place_of: &[u32], found: &mut [Place]) {
        // Which of its place's bodies the one of each is. Mostly they are few, but a hundred thousand pieces may meet in a place.
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

    /// Gives numbers to places, which are in `order`.
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
