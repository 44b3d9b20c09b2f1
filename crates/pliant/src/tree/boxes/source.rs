//! Sources of boxes over vertices: the shape of a body, or shapes and a distance to grow by.
//!
//! A box over some vertices is the smallest that holds them in the sense of its source. That is:
//! where they are now, grown by a distance, or at both ends of a motion. The update relies on two
//! rules that hold for every source:
//!
//! - The box over some vertices holds the box over any subset.
//! - It is the union of boxes over parts, bit for bit. So boxes of inner nodes may be merged from
//!   their children's.
//!
//! Growing keeps both, because rounding is monotonic.

use crate::geometry::{Aabb, Bounds, Capsule, Real, Shape};
use crate::ids::TreeVertex;
use crate::kernels::extent::{self, Extent, TWELVE};
use crate::kernels::{Coordinate, Simd};

/// Version of a source: two sources of one body with equal versions give equal boxes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Version {
    /// Version of the shape.
    shape: u64,
    /// Version of the second shape, where boxes hold one as well; 0 is before every version.
    second: u64,
    /// Bits of the distance by which boxes are grown.
    grown_by: u32,
}

impl Version {
    /// Returns the distance by which boxes are grown.
    pub(crate) fn grown_by(self) -> f32 {
        f32::from_bits(self.grown_by)
    }
}

/// Vertices that one box is over.
#[derive(Clone, Copy)]
pub(crate) enum Over<'v> {
    /// A run of vertices, from the first to the end, and some others; at least one vertex.
    Run([usize; 2], &'v [TreeVertex]),
    /// Twelve vertices: as many as most leaves have.
    Twelve(&'v [TreeVertex; TWELVE]),
    /// Corners of a triangle.
    Triangle(&'v [TreeVertex; 3]),
}

/// Source of boxes: gives the box over any vertices of a body.
pub(crate) trait BoxSource: Sync {
    /// The caller's scalar.
    type Scalar: Coordinate;

    /// Returns the current shape of the body.
    fn shape(&self) -> &Shape<'_, Self::Scalar>;

    /// Returns the version, which decides whether boxes are valid.
    fn version(&self) -> Version;

    /// Returns the box over some vertices.
    fn over<I: Simd>(&self, i: I, vertices: Over) -> Extent<I>;

    /// Returns a capsule round `count` vertices, in the sense in which a box is over them.
    fn capsule(&self, count: usize, vertex: &dyn Fn(usize) -> TreeVertex) -> Capsule;

    /// Returns the box over some vertices, one after the other: the reference for
    /// [`over`](Self::over).
    fn plainly(&self, vertices: impl Iterator<Item = TreeVertex> + Clone) -> Aabb;
}

impl<S: Coordinate> BoxSource for Shape<'_, S> {
    type Scalar = S;

    #[inline(always)]
    fn shape(&self) -> &Shape<'_, S> {
        self
    }

    fn version(&self) -> Version {
        Version {
            shape: self.version,
            ..Version::default()
        }
    }

    #[inline(always)]
    fn over<I: Simd>(&self, i: I, vertices: Over) -> Extent<I> {
        match vertices {
            Over::Run([start, end], others) => extent::of_points(i, self, start..end, others),
            Over::Twelve(vertices) => extent::of_twelve(i, self, vertices),
            Over::Triangle(&corners) => extent::of_corners(i, self, corners),
        }
    }

    fn capsule(&self, count: usize, vertex: &dyn Fn(usize) -> TreeVertex) -> Capsule {
        Capsule::around(count, &|which| relative(self, vertex(which)), 0.0)
    }

    fn plainly(&self, vertices: impl Iterator<Item = TreeVertex> + Clone) -> Aabb {
        let mut bounds = Bounds::EMPTY;
        vertices.for_each(|vertex| bounds.include(self.positions.get(vertex)));
        bounds.to_box(self.origin)
    }
}

/// Source of grown boxes: over a shape and the end of a motion, if there is one.
///
/// Boxes are grown by a distance on every side, and a little more where that is not exact.
#[derive(Clone, Copy)]
pub(crate) struct Grown<'s, S> {
    pub(crate) from: Shape<'s, S>,
    pub(crate) to: Option<Shape<'s, S>>,
    /// At least 0, and finite.
    pub(crate) distance: f32,
}

impl<S: Coordinate> BoxSource for Grown<'_, S> {
    type Scalar = S;

    #[inline(always)]
    fn shape(&self) -> &Shape<'_, S> {
        &self.from
    }

    fn version(&self) -> Version {
        Version {
            second: self.to.map_or(0, |to| to.version),
            grown_by: self.distance.to_bits(),
            ..self.from.version()
        }
    }

    #[inline(always)]
    fn over<I: Simd>(&self, i: I, vertices: Over) -> Extent<I> {
        let mut both = self.from.over(i, vertices);
        if let Some(to) = &self.to {
            both = extent::union(both, to.over(i, vertices));
        }
        extent::grown(i, both, self.distance)
    }

    fn capsule(&self, count: usize, vertex: &dyn Fn(usize) -> TreeVertex) -> Capsule {
        let from = |which| relative(&self.from, vertex(which));
        let Some(to) = &self.to else {
            return Capsule::around(count, &from, self.distance);
        };
        let of_both = |which| match usize::checked_sub(which, count) {
            Some(which) => relative(to, vertex(which)),
            None => from(which),
        };
        Capsule::around(2 * count, &of_both, self.distance)
    }

    fn plainly(&self, vertices: impl Iterator<Item = TreeVertex> + Clone) -> Aabb {
        let mut both = self.from.plainly(vertices.clone());
        if let Some(to) = &self.to {
            both = both.union(&to.plainly(vertices));
        }
        both.grown(self.distance)
    }
}

/// Position of a vertex relative to the origin, rounded to the nearest `f64`.
fn relative<S: Coordinate>(shape: &Shape<'_, S>, vertex: TreeVertex) -> [f64; 3] {
    let p = shape.positions.get(vertex).map(Real::to_f64);
    [0, 1, 2].map(|axis| p[axis] - shape.origin[axis])
}

/// Source of a set of boxes of one body: its shape, or grown boxes over its shape and motion.
///
/// Whoever makes boxes matches on it once a batch, with `of_source`.
#[derive(Clone, Copy)]
pub(crate) enum Source<'s, S> {
    Shape(Shape<'s, S>),
    Grown(Grown<'s, S>),
}

/// Compiles an expression for every source.
macro_rules! of_source {
    ($source:expr, $it:ident => $body:expr) => {
        match $source {
            $crate::tree::Source::Shape($it) => $body,
            $crate::tree::Source::Grown($it) => $body,
        }
    };
}
pub(crate) use of_source;

impl<'s, S: Coordinate> Source<'s, S> {
    /// Chooses the source. Grown boxes hold the end of a motion, if there is one.
    pub(crate) fn new(from: Shape<'s, S>, to: Option<Shape<'s, S>>, grows_by: Option<f32>) -> Self {
        let grown = |distance| Grown { from, to, distance };
        grows_by.map_or(Self::Shape(from), |distance| Self::Grown(grown(distance)))
    }

    /// Returns the current shape of the body.
    #[inline]
    pub(crate) fn shape(&self) -> &Shape<'s, S> {
        match self {
            Self::Shape(shape) => shape,
            Self::Grown(grown) => &grown.from,
        }
    }

    /// Returns the shape at the end of a motion, if boxes hold it too.
    #[inline]
    pub(crate) fn end(&self) -> Option<&Shape<'s, S>> {
        match self {
            Self::Shape(_) => None,
            Self::Grown(grown) => grown.to.as_ref(),
        }
    }

    /// Returns the version, which decides whether boxes are valid.
    pub(crate) fn version(&self) -> Version {
        of_source!(self, source => source.version())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Points;
    use crate::kernels::{Instructions, dispatch};

    /// Checks that all kernels of a source give what it means.
    fn check(source: &impl BoxSource) {
        let vertices = |numbers: &[u32]| -> Vec<TreeVertex> {
            numbers.iter().copied().map(TreeVertex).collect()
        };
        let twelve = [3, 1, 4, 15, 9, 2, 6, 5, 35, 8, 39, 7].map(TreeVertex);
        for instructions in Instructions::all() {
            dispatch!(instructions, i => {
                for (run, others) in [
                    (4..9, &[][..]),
                    (0..40, &[]),
                    (2..2, &[1]),
                    (5..6, &[0, 8]),
                    (0..3, &[7, 5, 9, 11, 30]),
                ] {
                    let others = vertices(others);
                    let run_of = (run.start..run.end).map(|vertex| TreeVertex(vertex as u32));
                    let expected = source.plainly(run_of.chain(others.iter().copied()));
                    let found = source.over(i, Over::Run([run.start, run.end], &others));
                    assert_eq!(extent::to_box(found), expected);
                }
                let found = extent::to_box(source.over(i, Over::Twelve(&twelve)));
                assert_eq!(found, source.plainly(twelve.into_iter()));
                let corners = [7, 2, 2].map(TreeVertex);
                let found = extent::to_box(source.over(i, Over::Triangle(&corners)));
                assert_eq!(found, source.plainly(corners.into_iter()));
            });
        }
    }

    fn check_all<S: Coordinate>(of: fn(f64) -> S, origin: [f64; 4]) {
        let shape_at = |phase: f64| {
            let wave =
                move |at: usize| [0.3, 1.7, 2.9].map(|x| of((x * at as f64 + phase).sin() * 4.0));
            Points::of((0..40).map(wave))
        };
        let [from, to] = [shape_at(0.0), shape_at(0.8)];
        let shape = |positions, version| Shape {
            positions,
            triangles: &[],
            origin,
            version,
        };
        let (from, to) = (shape(&from, 3), shape(&to, 7));
        check(&from);
        for distance in [0.0, 0.1, 1e6] {
            let grown = |to| Grown { from, to, distance };
            let (still, swept) = (grown(None), grown(Some(to)));
            check(&still);
            check(&swept);
            // A box holds what it is grown from, by the distance at least.
            let vertices = || (0..9).map(TreeVertex);
            let inner = from.plainly(vertices()).union(&to.plainly(vertices()));
            let outer = swept.plainly(vertices());
            for axis in 0..3 {
                let below = f64::from(inner.lo[axis]) - f64::from(outer.lo[axis]);
                let above = f64::from(outer.hi[axis]) - f64::from(inner.hi[axis]);
                assert!(below.min(above) >= f64::from(distance));
            }
            // Versions tell them apart, unless boxes are grown by nothing.
            assert_ne!(from.version(), swept.version());
            assert_ne!(still.version(), swept.version());
            assert_eq!(from.version() == still.version(), distance == 0.0);
        }
    }

    #[test]
    fn every_source_gives_the_boxes_that_it_means() {
        check_all(|x| x as f32, [0.0; 4]);
        check_all(|x| x, [0.3, -9.0, 1e5, 0.0]);
    }
}
