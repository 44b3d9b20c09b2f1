//! Packets: up to eight consecutive points near each other, which go down a tree together.
//!
//! Consecutive vertices of a mesh are mostly near each other. Their boxes then meet the same nodes,
//! and are compared with eight triangles at once. Points that are not are packets of their own.

use crate::geometry::{Aabb, Bounds};
use crate::kernels::{Coordinate, EightBoxes, at_most};
use std::ops::Range;

/// Boxes of some consecutive points, and the box round them all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Packet {
    /// First of the points.
    pub(super) first: u32,
    /// How many they are.
    pub(super) len: u32,
    pub(super) all: Aabb,
    pub(super) each: EightBoxes,
    /// How near to its box each meets triangles, if more than those that overlap it: squares.
    pub(super) limits: Option<[f32; 8]>,
}

impl Packet {
    /// Packet of no points, of which the first is to be this one.
    pub(super) fn from(first: usize) -> Self {
        Self {
            first: first as u32,
            len: 0,
            all: Aabb::EMPTY,
            each: EightBoxes::EMPTY,
            limits: None,
        }
    }

    /// Appends the box of the next point.
    #[inline]
    pub(super) fn push(&mut self, its_box: &Aabb) {
        self.each.set(self.len as usize, its_box);
        self.all = self.all.union(its_box);
        self.len += 1;
    }

    /// Appends the box of the next point, and the distance up to which it meets triangles.
    #[inline]
    pub(super) fn push_near(&mut self, its_box: &Aabb, limit: f64) {
        let limits = self.limits.get_or_insert([0.0; 8]);
        limits[self.len as usize] = at_most(limit * limit * (1.0 + 4.0 * f64::EPSILON));
        self.push(its_box);
        self.all = self.all.union(&its_box.grown((limit as f32).next_up()));
    }
}

/// How far apart points of one packet may be along an axis: a few triangles of a body with these
/// bounds.
pub(super) fn together<S: Coordinate>(bounds: &Bounds<S>, triangles: usize) -> f64 {
    let side = |axis: usize| bounds.hi[axis].to_f64() - bounds.lo[axis].to_f64();
    let longest = side(0).max(side(1)).max(side(2));
    longest * (64.0 / triangles as f64).sqrt()
}

/// Runs of up to eight consecutive points within a distance of each other along each axis.
pub(super) fn runs<S: Coordinate>(
    points: &[[S; 3]],
    within: f64,
) -> impl Iterator<Item = (Range<usize>, Bounds<S>)> {
    let mut start = 0;
    std::iter::from_fn(move || {
        let first = *points.get(start)?;
        let mut all = Bounds::at(first);
        let mut end = start + 1;
        while end < points.len() && end < start + 8 {
            let mut more = all;
            more.include(points[end]);
            let side = |axis: usize| more.hi[axis].to_f64() - more.lo[axis].to_f64();
            if !(0..3).all(|axis| side(axis) <= within) {
                break;
            }
            (all, end) = (more, end + 1);
        }
        let run = start..end;
        start = end;
        Some((run, all))
    })
}
