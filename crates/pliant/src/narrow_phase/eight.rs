//! Candidates eight at a time, by signs of which single precision is certain; the few others one by one.
//!
//! 1. The six plane signs of `triangles`. If one triangle lies on one side of the other's plane: **no**. That is most.
//! 2. If none of the six is zero, each triangle has one corner alone on its side of the other's plane, and both triangles meet
//!    the line of the two planes in a segment. Let p1 be that corner of one and p2 of the other, q and r the others in order,
//!    exchanged where p would lie below the plane of the other triangle. Then the segments overlap, and the answer is **yes**, if
//!    and only if neither p1 q1 p2 q2 nor p1 r1 r2 p2 is positively oriented (Guigue and Devillers 2003; two signs instead of
//!    up to nine).
//! 3. Where a sign is not certain, `triangles` decides on exact signs.
//!
//! The tests compare it with the exact decision on every kind of pair, at every level of instructions.

use super::intersect;
use crate::geometry::{Scalar, Shape};
use crate::kernels::bits::Batch;
use crate::kernels::{Corners, Level, signs};
use crate::pairs::Candidate;
use crate::statistics::Statistics;
use fearless_simd::{Simd, dispatch};

/// A candidate that is not known to be apart.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Undecided {
    candidate: Candidate,
    /// Bits 0 to 2: the corners of A above the plane of B; 3 to 5: those of B above the plane of A.
    above: u8,
    /// Whether these signs are certain.
    certain: bool,
}

/// Decides candidates, and appends those that intersect to `hits`, in the order of the candidates.
pub(crate) fn decide<S: Scalar>(
    level: Level,
    candidates: &mut Batch<Candidate>,
    shapes: [&Shape<S>; 2],
    undecided: &mut Batch<Undecided>,
    hits: &mut Vec<Candidate>,
    statistics: &mut Statistics,
) {
    let count = candidates.len();
    statistics.candidate_pairs += count as u64;
    let hits_before = hits.len();
    undecided.clear();
    dispatch!(level, i => {
        for (eight, number) in candidates.eights().iter().zip(lanes_used(count)) {
            by_planes(i, eight, number, shapes, undecided);
        }
        let count = undecided.len();
        for (eight, number) in undecided.eights().iter().zip(lanes_used(count)) {
            by_lines(i, eight, number, shapes, hits, statistics);
        }
    });
    statistics.pairs += (hits.len() - hits_before) as u64;
}

/// How many of each eight lanes are used by so many items: eight, and in the last the rest.
fn lanes_used(count: usize) -> impl Iterator<Item = usize> {
    (0..count)
        .step_by(8)
        .map(move |first| (count - first).min(8))
}

/// Leaves out the pairs of which one lies on one side of the other's plane.
#[inline(always)]
fn by_planes<I: Simd, S: Scalar>(
    i: I,
    candidates: &[Candidate; 8],
    lanes: usize,
    shapes: [&Shape<S>; 2],
    undecided: &mut Batch<Undecided>,
) {
    let mut corners = Corners {
        positions: [shapes[0].positions, shapes[1].positions],
        vertices: [[0; 6]; 8],
    };
    for lane in 0..8 {
        let [a, b] = candidates[lane];
        let [a0, a1, a2] = shapes[0].triangles[a as usize];
        let [b0, b1, b2] = shapes[1].triangles[b as usize];
        corners.vertices[lane] = [a0, a1, a2, b0, b1, b2];
    }
    let room = undecided.room();
    let signs = signs::plane_signs(i, &corners);
    let [a0, a1, a2, b0, b1, b2] = signs.positive;
    let positive = u64::from_le_bytes([a0, a1, a2, b0, b1, b2, 0, 0]);
    let not_apart = !signs.apart & (0xff >> (8 - lanes));
    room.push_bits(u64::from(not_apart), |lane| {
        // Byte k of the product's factor is 0 or 1; the multiplier moves it to bit k of the highest byte.
        let bits = positive >> (lane % 8) & 0x0101_0101_0101_0101;
        Undecided {
            candidate: candidates[lane as usize % 8],
            above: (bits.wrapping_mul(0x0102_0408_1020_4080) >> 56) as u8,
            certain: signs.certain >> (lane % 8) & 1 == 1,
        }
    });
}

/// By which of three corners lie above a plane (not none or all, which are never asked for): the order that puts the one first
/// that is alone on its side, seen from one side of the triangle and from the other.
const ALONE_FIRST: [[[u8; 3]; 8]; 2] = [
    [
        [0, 1, 2],
        [0, 1, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 0, 1],
        [1, 2, 0],
        [0, 1, 2],
        [0, 1, 2],
    ],
    [
        [0, 2, 1],
        [0, 2, 1],
        [1, 0, 2],
        [2, 1, 0],
        [2, 1, 0],
        [1, 0, 2],
        [0, 2, 1],
        [0, 2, 1],
    ],
];

/// Bit `above` is set if the corner that is alone lies below.
const ALONE_IS_BELOW: u8 = 1 << 3 | 1 << 5 | 1 << 6;

/// Decides pairs that cross each other's planes.
#[inline(always)]
fn by_lines<I: Simd, S: Scalar>(
    i: I,
    undecided: &[Undecided; 8],
    lanes: usize,
    shapes: [&Shape<S>; 2],
    hits: &mut Vec<Candidate>,
    statistics: &mut Statistics,
) {
    let mut corners = Corners {
        positions: [shapes[0].positions, shapes[1].positions],
        vertices: [[0; 6]; 8],
    };
    for lane in 0..8 {
        let Undecided {
            candidate: [a, b],
            above,
            ..
        } = undecided[lane];
        let (above_a, above_b) = (usize::from(above & 7), usize::from(above >> 3 & 7));
        // The corner of the other that is alone is to lie above; a triangle seen from its other side is the same triangle.
        let order_a = ALONE_FIRST[usize::from(ALONE_IS_BELOW >> above_b & 1)][above_a];
        let order_b = ALONE_FIRST[usize::from(ALONE_IS_BELOW >> above_a & 1)][above_b];
        let [a0, a1, a2] = shapes[0].triangles[a as usize];
        let [b0, b1, b2] = shapes[1].triangles[b as usize];
        let (a, b) = ([a0, a1, a2, 0], [b0, b1, b2, 0]);
        for corner in 0..3 {
            corners.vertices[lane][corner] = a[usize::from(order_a[corner] & 3)];
            corners.vertices[lane][3 + corner] = b[usize::from(order_b[corner] & 3)];
        }
    }
    let signs = signs::line_signs(i, &corners);
    for (lane, pair) in undecided.iter().enumerate().take(lanes) {
        let is = |mask: u8| pair.certain && mask >> lane & 1 == 1;
        let [a, b] = pair.candidate;
        if is(signs.both_negative)
            || !is(signs.one_positive)
                && intersect::<S>(&shapes[0].corners(a), &shapes[1].corners(b), statistics)
        {
            hits.push(pair.candidate);
        }
    }
}
