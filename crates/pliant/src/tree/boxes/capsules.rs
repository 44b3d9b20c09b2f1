//! Capsules beside the boxes of nodes and triangles, for a body of long thin triangles.
//!
//! Boxes of long thin triangles hold mostly air, whatever tree is over them. So a body that has
//! many has a capsule beside each box of few vertices. They are made with the boxes, and valid when
//! these are. Whether it has many is decided once, from its first shape; turning changes nothing.

use super::BoxSource;
use crate::geometry::{Capsule, Real, Shape};
use crate::held::held;
use crate::ids::{TreeVertex, WideNodeId};
use crate::kernels::{Coordinate, EightCapsules};
use crate::tree::{BLOCK_LANES, Tree};

/// Square of the longest edge over twice the area from which a triangle is long and thin.
const THIN: f64 = 16.0;
/// Part of all squares of longest edges that long thin triangles need to have.
const MANY: f64 = 0.1;
/// Most vertices of a node that has a capsule.
const MOST_VERTICES: usize = 512;

/// Capsules of the nodes of every wide node, and of the triangles of every block.
#[derive(Debug)]
pub(crate) struct Capsules {
    pub(crate) nodes: Vec<EightCapsules>,
    pub(crate) blocks: Vec<EightCapsules>,
}

impl Capsules {
    /// Allocates capsules for a tree whose triangles have this shape, if many of them are thin.
    pub(super) fn new<S: Coordinate>(tree: &Tree, shape: &Shape<S>) -> Option<Box<Self>> {
        has_many_thin(tree, shape).then(|| {
            Box::new(Self {
                nodes: vec![EightCapsules::EVERYTHING; tree.wide_nodes.len()],
                blocks: vec![EightCapsules::EVERYTHING; tree.leaves.block_count()],
            })
        })
    }
}

/// Whether long thin triangles make up much of the boxes.
fn has_many_thin<S: Coordinate>(tree: &Tree, shape: &Shape<S>) -> bool {
    let (mut all, mut thin) = (0.0, 0.0);
    for &corners in &shape.triangles[tree.triangles()] {
        let [p, q, r] = corners.map(|vertex| shape.positions.get(vertex).map(Real::to_f64));
        let way = |p: [f64; 3], q: [f64; 3]| [q[0] - p[0], q[1] - p[1], q[2] - p[2]];
        let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        let (a, b) = (way(p, q), way(p, r));
        let (aa, ab, bb) = (dot(a, a), dot(a, b), dot(b, b));
        let longest = aa.max(bb).max(aa - 2.0 * ab + bb);
        // Twice the area, squared, with rounding that does not matter here.
        let square = aa * bb - ab * ab;
        all += longest;
        if longest * longest > THIN * THIN * square {
            thin += longest;
        }
    }
    thin > MANY * all
}

/// Makes the capsules of the triangles of a block.
#[inline(never)]
pub(crate) fn make_of_block<B: BoxSource>(
    capsules: &mut EightCapsules,
    triangles: &[[TreeVertex; 3]],
    source: &B,
) {
    for (lane, corners) in triangles.iter().enumerate().take(BLOCK_LANES) {
        capsules.set(lane, &source.capsule(3, &|which| corners[which]));
    }
}

/// Makes the capsules of the nodes of a wide node.
#[inline(never)]
pub(crate) fn make_of_nodes<B: BoxSource>(
    capsules: &mut EightCapsules,
    tree: &Tree,
    wide_node: WideNodeId,
    source: &B,
) {
    let structure = tree.wide_node(wide_node);
    for lane in 0..structure.len() {
        let node = structure.first_node as usize + lane;
        capsules.set(lane, &capsule_of_node(tree, node, source));
    }
}

/// Capsule round the vertices below a node, unless they are many.
pub(crate) fn capsule_of_node<B: BoxSource>(tree: &Tree, node: usize, source: &B) -> Capsule {
    let (run, border) = tree.vertices.run_and_border(node);
    let count = run.len() + border.len();
    if count > MOST_VERTICES {
        return Capsule::EVERYTHING;
    }
    let vertex = |which: usize| match usize::checked_sub(which, border.len()) {
        Some(which) => TreeVertex((run.start + which) as u32),
        None => border[which],
    };
    source.capsule(count, &vertex)
}

held!(Capsules: nodes[], blocks[]);
