//! Complete octree of fixed depth over the present box of a body.
//!
//! Its shape never changes; the contents of buckets and all boxes do. Nodes are numbered as in a
//! heap: the children of g are 8 g + 1 to 8 g + 8. Buckets come last, along a Morton curve, so a
//! triangle's bucket is found by arithmetic, without a descent. A bucket is a doubly linked list
//! through its triangles: one that stayed costs nothing, one that moved a few writes. Boxes of
//! empty nodes mean nothing; each node knows which of its children are not empty.

use crate::methods::aabb::Aabb;
use crate::methods::bodies::Bodies;
use crate::methods::triangle_box::triangle_box;

/// End of a list, or no bucket yet.
const NONE: u32 = u32::MAX;

#[derive(Debug)]
pub(super) struct Octree {
    /// Binary logarithm of the number of cells on a side.
    depth: u32,
    /// First bucket: all nodes before it have children.
    first_bucket: u32,
    boxes: Vec<Aabb>,
    /// Bit set of the children that are not empty, for each node with children.
    occupied: Vec<u8>,
    /// First triangle of each bucket.
    heads: Vec<u32>,
    /// Bucket and neighbours of each triangle.
    places: Vec<Place>,
}

#[derive(Clone, Copy, Debug)]
struct Place {
    bucket: u32,
    before: u32,
    after: u32,
}

impl Octree {
    pub(super) fn new(depth: u32, triangles: usize) -> Self {
        let buckets = 1_usize << (3 * depth);
        let first_bucket = (buckets - 1) / 7;
        Self {
            depth,
            first_bucket: first_bucket as u32,
            boxes: vec![Aabb::EMPTY; first_bucket + buckets],
            occupied: vec![0; first_bucket],
            heads: vec![NONE; buckets],
            places: vec![
                Place {
                    bucket: NONE,
                    before: NONE,
                    after: NONE,
                };
                triangles
            ],
        }
    }

    /// Puts every triangle into its bucket and makes every box anew. Returns the number of boxes
    /// made.
    pub(super) fn fill(&mut self, bodies: &Bodies, body: usize) -> u64 {
        let grid = Grid::over(&bodies.boxes[body], self.depth);
        self.occupied.fill(0);
        let mut made = self.places.len() as u64;
        let positions = &bodies.positions[body];
        for (triangle, &corners) in (0..).zip(&bodies.triangles[body]) {
            let bounds = triangle_box(corners, positions);
            let bucket = grid.bucket_of(corners.map(|vertex| &positions[vertex as usize]));
            if bucket != self.places[triangle as usize].bucket {
                self.put(triangle, bucket);
            }
            let node = self.first_bucket + bucket;
            let own = &mut self.boxes[node as usize];
            if occupy(&mut self.occupied, node) {
                made += 1;
                *own = bounds;
            } else {
                *own = own.merge(&bounds);
            }
        }
        for node in (0..self.first_bucket).rev() {
            if self.occupied[node as usize] == 0 {
                continue;
            }
            made += 1;
            let hull = self
                .children(node)
                .map(|child| &self.boxes[child as usize])
                .fold(Aabb::EMPTY, |hull, own| hull.merge(own));
            self.boxes[node as usize] = hull;
            if node > 0 {
                occupy(&mut self.occupied, node);
            }
        }
        made
    }

    /// Takes a triangle out of its bucket, if it has one, and puts it into another.
    fn put(&mut self, triangle: u32, bucket: u32) {
        let Place {
            bucket: old,
            before,
            after,
        } = self.places[triangle as usize];
        if old != NONE {
            if before == NONE {
                self.heads[old as usize] = after;
            } else {
                self.places[before as usize].after = after;
            }
            if after != NONE {
                self.places[after as usize].before = before;
            }
        }
        let head = std::mem::replace(&mut self.heads[bucket as usize], triangle);
        if head != NONE {
            self.places[head as usize].before = triangle;
        }
        self.places[triangle as usize] = Place {
            bucket,
            before: NONE,
            after: head,
        };
    }

    #[inline]
    pub(super) fn bounds(&self, node: u32) -> &Aabb {
        &self.boxes[node as usize]
    }

    #[inline]
    pub(super) fn is_bucket(&self, node: u32) -> bool {
        node >= self.first_bucket
    }

    /// Children of a node that are not empty.
    #[inline]
    pub(super) fn children(&self, node: u32) -> impl Iterator<Item = u32> + use<> {
        let mut left = self.occupied[node as usize];
        std::iter::from_fn(move || {
            (left != 0).then(|| {
                let child = left.trailing_zeros();
                left &= left - 1;
                8 * node + 1 + child
            })
        })
    }

    /// Triangles of a bucket, in no order.
    #[inline]
    pub(super) fn triangles(&self, bucket: u32) -> impl Iterator<Item = u32> {
        let head = self.heads[(bucket - self.first_bucket) as usize];
        let there = |triangle: u32| (triangle != NONE).then_some(triangle);
        std::iter::successors(there(head), move |&triangle| {
            there(self.places[triangle as usize].after)
        })
    }
}

/// Marks a node as not empty in its parent. Returns whether it was empty before.
#[inline]
fn occupy(occupied: &mut [u8], node: u32) -> bool {
    let bits = &mut occupied[((node - 1) / 8) as usize];
    let bit = 1 << ((node - 1) % 8);
    let news = *bits & bit == 0;
    *bits |= bit;
    news
}

/// Cells of the buckets: 2^depth on each side of a box.
struct Grid {
    lo: [f32; 3],
    cells_per_length: [f32; 3],
    last_cell: u32,
}

impl Grid {
    fn over(bounds: &Aabb, depth: u32) -> Self {
        let cells = 1_u32 << depth;
        Self {
            lo: bounds.lo,
            // A flat body has one cell on this axis: NaN becomes cell 0.
            cells_per_length: std::array::from_fn(|axis| {
                cells as f32 / (bounds.hi[axis] - bounds.lo[axis])
            }),
            last_cell: cells - 1,
        }
    }

    /// Number of the bucket with a triangle's centroid. Rounding may choose its neighbour; boxes
    /// stay right.
    #[inline]
    #[expect(clippy::cast_sign_loss, reason = "a cell below the first is the first")]
    fn bucket_of(&self, [a, b, c]: [&[f32; 3]; 3]) -> u32 {
        let cell = |axis: usize| {
            let centroid = (a[axis] + b[axis] + c[axis]) * (1.0 / 3.0);
            let cell = (centroid - self.lo[axis]) * self.cells_per_length[axis];
            (cell as u32).min(self.last_cell)
        };
        let spread = |cell: u32| SPREAD[(cell & 0x7f) as usize];
        spread(cell(0)) | spread(cell(1)) << 1 | spread(cell(2)) << 2
    }
}

/// Bits of a cell's coordinate, spread for the bucket's number; for up to seven levels.
static SPREAD: [u32; 128] = {
    let mut table = [0; 128];
    let mut cell = 0;
    while cell < table.len() {
        table[cell] = spread(cell as u32);
        cell += 1;
    }
    table
};

/// Inserts two zeros after each of up to eight bits.
const fn spread(bits: u32) -> u32 {
    let bits = (bits | bits << 8) & 0x0000_f00f;
    let bits = (bits | bits << 4) & 0x000c_30c3;
    (bits | bits << 2) & 0x0024_9249
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Motion, Placed};
    use pliant_scenes::Scene;

    #[test]
    fn bits_are_spread() {
        for bits in 0..256 {
            let expected = (0..8).fold(0, |sum, bit| sum | (bits >> bit & 1) << (3 * bit));
            assert_eq!(spread(bits), expected);
        }
    }

    /// Checks that every triangle is in one bucket, lists are whole, boxes tight, and emptiness
    /// known.
    fn check(octree: &Octree, bodies: &Bodies) {
        let count = bodies.triangles[0].len();
        let mut met = vec![0; count];
        let all = octree.boxes.len() as u32;
        let mut hulls = vec![Aabb::EMPTY; all as usize];
        for node in (0..all).rev() {
            let hull = if octree.is_bucket(node) {
                octree.triangles(node).fold(Aabb::EMPTY, |hull, triangle| {
                    met[triangle as usize] += 1;
                    let place = octree.places[triangle as usize];
                    assert_eq!(place.bucket, node - octree.first_bucket);
                    hull.merge(&bodies.triangle_box(0, triangle))
                })
            } else {
                (8 * node + 1..=8 * node + 8).fold(Aabb::EMPTY, |hull, child| {
                    hull.merge(&hulls[child as usize])
                })
            };
            hulls[node as usize] = hull;
            let empty = hull == Aabb::EMPTY;
            if node > 0 {
                let parent = (node - 1) / 8;
                assert_eq!(octree.children(parent).any(|child| child == node), !empty);
            }
            if !empty {
                assert_eq!(*octree.bounds(node), hull);
            }
        }
        assert!(met.iter().all(|&times| times == 1));
        assert_eq!(hulls[0], bodies.boxes[0]);
    }

    #[test]
    fn triangles_move_from_bucket_to_bucket() {
        let scene = Scene::new("crowd", Some(1_280), 3).unwrap();
        let motion = Motion::of_scene(&scene, [1, 2, 90, 3, 200]);
        let mut bodies = Bodies::build(&motion.meshes()[..1]);
        for depth in [1, 3, 5] {
            let mut octree = Octree::new(depth, 1_280);
            let mut moved = Vec::new();
            let mut before: Vec<u32> = vec![0; 1_280];
            for frame in &motion.frames {
                let shapes: Vec<_> = frame[..1].iter().map(Placed::shape).collect();
                bodies.take_over(&shapes);
                octree.fill(&bodies, 0);
                check(&octree, &bodies);
                let now: Vec<u32> = octree.places.iter().map(|place| place.bucket).collect();
                moved.push(before.iter().zip(&now).filter(|(a, b)| a != b).count());
                before = now;
            }
            // In a step few triangles change buckets, in a jump most.
            assert!(moved[1] < 1_280 / 2 && moved[2] > moved[1], "{moved:?}");
        }
    }

    #[test]
    fn a_flat_body_has_buckets() {
        let positions = [
            [0.0, 5.0, 0.0],
            [1.0, 5.0, 0.0],
            [0.0, 5.0, 1.0],
            [1.0, 5.0, 1.0],
        ];
        let grid = Grid::over(&Aabb::of(&positions), 3);
        assert_eq!(
            grid.bucket_of([&positions[3]; 3]),
            spread(7) | spread(7) << 2
        );
        assert_eq!(grid.bucket_of([&positions[0]; 3]), 0);
    }
}
