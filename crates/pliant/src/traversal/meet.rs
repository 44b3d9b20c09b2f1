//! Leaves that overlap: which of their triangles intersect.
//!
//! A leaf is one block of up to eight triangles, or several. Pairs of blocks are compared, all boxes of one with all of the
//! other; pairs of triangles whose boxes overlap are candidates, and are decided some thousands at a time.

use super::Side;
use super::expand::LATER_LANES;
use crate::geometry::Scalar;
use crate::kernels::{Level, bits::Batch, overlap_mask};
use crate::mesh::Mesh;
use crate::narrow_phase::{self, Undecided};
use crate::pairs::{BlockPair, Candidate, LeafPair};
use crate::statistics::Statistics;
use crate::tree::{Leaves, Neighbours};
use fearless_simd::{Simd, dispatch};

/// Pairs of blocks compared before their candidates are decided: at most 64 candidates each.
const BLOCKS_AT_ONCE: usize = 64;

/// Buffers of one job, kept from query to query, and what it found.
#[derive(Debug, Default)]
pub(super) struct Meet {
    candidates: Batch<Candidate>,
    undecided: Undecided,
    /// Pairs that intersect, in tree order.
    pub(super) hits: Batch<Candidate>,
    /// The same as the caller numbers triangles.
    pub(super) named: Vec<[u32; 2]>,
    pub(super) statistics: Statistics,
}

/// Where in the pairs of leaves: a pair, a block of its first leaf, a block of its second.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) pair: usize,
    a: u32,
    b: u32,
}

/// Pairs of blocks of pairs of leaves, from a place on, up to `most` of them; returns the place where it stopped. Where leaves are
/// single triangles without blocks, these are numbered instead.
pub(super) fn block_pairs<const ITSELF: bool>(
    [a, b]: [&Leaves; 2],
    pairs: &[LeafPair],
    mut place: Place,
    most: usize,
    blocks: &mut Vec<BlockPair>,
) -> Place {
    blocks.clear();
    while blocks.len() < most && place.pair < pairs.len() {
        let [leaf_a, leaf_b] = pairs[place.pair];
        if !a.have_boxes() {
            blocks.push([a.triangles(leaf_a).start, b.triangles(leaf_b).start]);
            place.pair += 1;
            continue;
        }
        let (of_a, of_b) = (a.blocks_of(leaf_a), b.blocks_of(leaf_b));
        let pair = [of_a.start + place.a, of_b.start + place.b];
        // Within one leaf, each pair of blocks once.
        if !ITSELF || leaf_a != leaf_b || pair[0] <= pair[1] {
            blocks.push(pair);
        }
        place.b += 1;
        if of_b.start + place.b == of_b.end {
            (place.a, place.b) = (place.a + 1, 0);
        }
        if of_a.start + place.a == of_a.end {
            place = Place {
                pair: place.pair + 1,
                a: 0,
                b: 0,
            };
        }
    }
    place
}

impl Meet {
    /// Forgets what it found.
    pub(super) fn clear(&mut self) {
        self.hits.clear();
        self.named.clear();
        self.statistics = Statistics::default();
    }

    /// Finds what intersects among pairs of blocks.
    pub(super) fn meet<const N: usize, S: Scalar, const ITSELF: bool>(
        &mut self,
        level: Level,
        [side_a, side_b]: [&Side<'_, N, S>; 2],
        pairs: &[BlockPair],
    ) {
        let leaves = [&side_a.tree.leaves, &side_b.tree.leaves];
        for pairs in pairs.chunks(BLOCKS_AT_ONCE) {
            self.candidates.clear();
            if leaves[0].have_boxes() {
                let found = &mut self.candidates;
                match side_a.tree.neighbours() {
                    Some(neighbours) if ITSELF => {
                        dispatch!(level, i => of_itself(i, leaves[0], side_a.mesh, neighbours, pairs, found));
                    }
                    _ => dispatch!(level, i => of_two(i, leaves, pairs, found)),
                }
            } else {
                // One triangle a leaf: its box is the leaf's, which overlaps. With itself it shares its vertices.
                for &[a, b] in pairs {
                    if !ITSELF || !side_a.mesh.share_a_vertex(a, b) {
                        self.candidates.push([a, b]);
                    }
                }
            }
            narrow_phase::decide(
                level,
                &mut self.candidates,
                [&side_a.shape, &side_b.shape],
                &mut self.undecided,
                &mut self.hits,
                &mut self.statistics,
            );
        }
    }
}

/// The pairs of triangles of pairs of blocks of two bodies whose boxes overlap.
#[inline(always)]
fn of_two<I: Simd>(i: I, [a, b]: [&Leaves; 2], pairs: &[BlockPair], found: &mut Batch<Candidate>) {
    let (blocks_a, blocks_b) = (a.blocks(), b.blocks());
    let (firsts_a, firsts_b) = (a.firsts(), b.firsts());
    for &[block_a, block_b] in pairs {
        let first_a = firsts_a[block_a as usize];
        let first_b = firsts_b[block_b as usize];
        let room = found.room();
        let overlaps = overlap_mask(i, &blocks_a[block_a as usize], &blocks_b[block_b as usize]);
        room.push_bits(overlaps, |bit| [first_a + bit / 8, first_b + bit % 8]);
    }
}

/// The pairs of triangles of pairs of blocks of one body whose boxes overlap, and which share no vertex.
#[inline(always)]
fn of_itself<I: Simd>(
    i: I,
    leaves: &Leaves,
    mesh: &Mesh,
    neighbours: &Neighbours,
    pairs: &[BlockPair],
    found: &mut Batch<Candidate>,
) {
    let (blocks, firsts) = (leaves.blocks(), leaves.firsts());
    for &[block_a, block_b] in pairs {
        let first_a = firsts[block_a as usize];
        let first_b = firsts[block_b as usize];
        let pair = |bit: u32| [first_a + bit / 8, first_b + bit % 8];
        let room = found.room();
        let mut overlaps = overlap_mask(i, &blocks[block_a as usize], &blocks[block_b as usize]);
        if block_a == block_b {
            // Within one block, each pair of triangles once, and none with itself.
            overlaps &= LATER_LANES;
        }
        match neighbours.shared(i, block_a, block_b) {
            Some(shared) => {
                // Mostly none is left.
                if overlaps & !shared != 0 {
                    room.push_bits(overlaps & !shared, pair);
                }
            }
            None => room.push_bits_if(overlaps, pair, |[a, b]| !mesh.share_a_vertex(a, b)),
        }
    }
}
