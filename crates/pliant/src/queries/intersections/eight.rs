//! Triangle-triangle test of eight candidates at a time, by signs of which single precision is
//! certain.
//!
//! 1. Plane signs, six a pair. If one triangle lies on one side of the other's plane: **no**. That
//!    is most.
//! 2. Line signs, two a pair, where none of the six is zero ([`by_lines`]): **yes** or **no**.
//! 3. Exact signs (`pliant_exact`) one by one, where a sign is not certain.
//!
//! Source: Guigue and Devillers 2003, who need two line signs instead of up to nine. The tests
//! compare it with the exact decision on every kind of pair, for every instruction set.

use super::{Candidate, LeafTest};
use crate::geometry::Shape;
use crate::held::held;
use crate::ids::TreeVertex;
use crate::kernels::{Buffer, Coordinate, Simd, TrianglePairs, dispatch, signs};
use crate::statistics::Statistics;
use pliant_exact::intersect;

/// Candidates that are not known to be apart.
#[derive(Debug, Default)]
pub(crate) struct Undecided {
    /// Candidates whose plane signs are all known, for step 2.
    crossing: Buffer<Crossing>,
    /// Candidates that are left to exact signs.
    uncertain: Buffer<Candidate>,
}

/// Two triangles that cross each other's planes.
#[derive(Clone, Copy, Debug, Default)]
struct Crossing {
    candidate: Candidate,
    /// Bits 0 to 2: corners of A above the plane of B. Bits 3 to 5: corners of B above the plane of
    /// A.
    above: u8,
}

/// Decides candidates, and appends pairs that intersect to `hits`, in an order that depends on the
/// candidates alone.
///
/// Returns how many of these, the first ones, are known to cross, by signs that are not zero.
pub(in crate::queries) fn decide<S: Coordinate>(
    leaves: &LeafTest<S>,
    candidates: &mut Buffer<Candidate>,
    undecided: &mut Undecided,
    hits: &mut Buffer<Candidate>,
    statistics: &mut Statistics,
) -> usize {
    let shapes = leaves.shapes;
    let count = candidates.len();
    statistics.candidate_pairs += count as u64;
    let hits_before = hits.len();
    undecided.crossing.clear();
    undecided.uncertain.clear();
    dispatch!(leaves.instructions, i => {
        for (eight, lanes) in candidates.eights().iter().zip(lanes_used(count)) {
            by_planes(i, eight, lanes, shapes, undecided);
        }
        let Undecided { crossing, uncertain } = undecided;
        let count = crossing.len();
        for (eight, lanes) in crossing.eights().iter().zip(lanes_used(count)) {
            by_lines(i, eight, lanes, shapes, uncertain, hits);
        }
    });
    let crossing = hits.len() - hits_before;
    let exact = &mut statistics.exact_decisions;
    for &[a, b] in undecided.uncertain.as_slice() {
        // One exact decision may take microseconds, and there may be thousands.
        if leaves.interrupt.is_set() {
            break;
        }
        if intersect(
            S::PRECISION,
            &shapes[0].corners(a),
            &shapes[1].corners(b),
            exact,
        ) {
            hits.push([a, b]);
        }
    }
    statistics.pairs += (hits.len() - hits_before) as u64;
    crossing
}

/// Masks of the lanes in use for `count` items: all eight, and in the last group the first few.
fn lanes_used(count: usize) -> impl Iterator<Item = u8> {
    (0..count)
        .step_by(8)
        .map(move |first| 0xff >> (8 - (count - first).min(8)))
}

/// Step 1: rejects pairs of which one triangle lies on one side of the other's plane.
#[inline(always)]
fn by_planes<I: Simd, S: Coordinate>(
    i: I,
    candidates: &[Candidate; 8],
    lanes: u8,
    shapes: [&Shape<S>; 2],
    Undecided {
        crossing,
        uncertain,
    }: &mut Undecided,
) {
    let mut corners = TrianglePairs {
        positions: [shapes[0].positions, shapes[1].positions],
        vertices: [[TreeVertex(0); 6]; 8],
    };
    for lane in 0..8 {
        let [a, b] = candidates[lane];
        let [a0, a1, a2] = shapes[0].triangles[a.index()];
        let [b0, b1, b2] = shapes[1].triangles[b.index()];
        corners.vertices[lane] = [a0, a1, a2, b0, b1, b2];
    }
    let room = crossing.room();
    let signs = signs::plane_signs(i, &corners);
    let [a0, a1, a2, b0, b1, b2] = signs.positive;
    let positive = u64::from_le_bytes([a0, a1, a2, b0, b1, b2, 0, 0]);
    let not_apart = !signs.apart & lanes;
    room.push_bits(u64::from(not_apart & signs.certain), |lane| {
        // Byte k of this factor is 0 or 1. The multiplier moves it to bit k of the product's
        // highest byte.
        let bits = positive >> (lane % 8) & 0x0101_0101_0101_0101;
        Crossing {
            candidate: candidates[lane as usize % 8],
            above: (bits.wrapping_mul(0x0102_0408_1020_4080) >> 56) as u8,
        }
    });
    keep(candidates, not_apart & !signs.certain, uncertain);
}

/// Appends the few of eight candidates that a mask names.
#[inline(always)]
fn keep(candidates: &[Candidate; 8], lanes: u8, kept: &mut Buffer<Candidate>) {
    if lanes != 0 {
        kept.room()
            .push_bits(u64::from(lanes), |lane| candidates[lane as usize % 8]);
    }
}

/// Corner that is alone on its side of a plane, by the mask of the corners above it. Never asked
/// for none or all.
const ALONE: [usize; 8] = [0, 0, 1, 2, 2, 1, 0, 0];

/// Bit `above` is set if the corner that is alone lies below.
const ALONE_IS_BELOW: u8 = 1 << 3 | 1 << 5 | 1 << 6;

/// Corners that are p1 q1 r1 p2 q2 r2, by [`Crossing::above`]. Numbers 0, 1 and 2 are A's, 3, 4 and
/// 5 are B's.
const IN_ORDER: [[u8; 6]; 64] = {
    let mut orders = [[0; 6]; 64];
    let mut above = 0;
    while above < 64 {
        let (above_a, above_b) = (above & 7, above >> 3);
        // The other triangle's lone corner must lie above. A triangle seen from its other side is
        // the same triangle.
        let turn_a = 1 + (ALONE_IS_BELOW >> above_b & 1) as usize;
        let turn_b = 1 + (ALONE_IS_BELOW >> above_a & 1) as usize;
        let mut corner = 0;
        while corner < 3 {
            orders[above][corner] = ((ALONE[above_a] + turn_a * corner) % 3) as u8;
            orders[above][3 + corner] = 3 + ((ALONE[above_b] + turn_b * corner) % 3) as u8;
            corner += 1;
        }
        above += 1;
    }
    orders
};

/// Step 2: decides pairs that cross each other's planes (Guigue and Devillers 2003).
///
/// If no plane sign is zero, each triangle has one corner alone on its side of the other's plane.
/// Both triangles then meet the line of the two planes in a segment. Let p1 and p2 be these
/// corners, and q and r the others in order. They are exchanged where p would lie below the plane
/// of the other triangle. The segments overlap if and only if neither `p1 q1 p2 q2` nor
/// `p1 r1 r2 p2` is positively oriented.
#[inline(always)]
fn by_lines<I: Simd, S: Coordinate>(
    i: I,
    crossing: &[Crossing; 8],
    lanes: u8,
    shapes: [&Shape<S>; 2],
    uncertain: &mut Buffer<Candidate>,
    hits: &mut Buffer<Candidate>,
) {
    let mut corners = TrianglePairs {
        positions: [shapes[0].positions, shapes[1].positions],
        vertices: [[TreeVertex(0); 6]; 8],
    };
    let mut candidates = [Candidate::default(); 8];
    for lane in 0..8 {
        let Crossing { candidate, above } = crossing[lane];
        candidates[lane] = candidate;
        let [a0, a1, a2] = shapes[0].triangles[candidate[0].index()];
        let [b0, b1, b2] = shapes[1].triangles[candidate[1].index()];
        let six = [a0, a1, a2, b0, b1, b2, a0, a0];
        let order = IN_ORDER[usize::from(above) % 64];
        for corner in 0..6 {
            corners.vertices[lane][corner] = six[usize::from(order[corner]) % 8];
        }
    }
    let room = hits.room();
    let signs = signs::line_signs(i, &corners);
    room.push_bits(u64::from(signs.both_negative & lanes), |lane| {
        candidates[lane as usize % 8]
    });
    let decided = signs.both_negative | signs.one_positive;
    keep(&candidates, !decided & lanes, uncertain);
}

held!(Undecided: crossing, uncertain);
