//! Closest points of bodies, and how deep bodies reach into others.

use crate::arrays::{give, start};
use crate::inside::with_points;
use crate::points::PliantPoints;
use crate::questions::PliantQuery;
use crate::world::{calls, with_world};
use pliant::{BodyId, ClosestPoint};

/// Answers that the caller reads, one for each function.
#[derive(Default)]
pub(crate) struct Kept {
    closest: Columns,
    with_signs: Columns,
    depths: Vec<f64>,
}

/// Closest points in columns.
#[derive(Default)]
struct Columns {
    found: Vec<u8>,
    bodies: Vec<u32>,
    triangles: Vec<u32>,
    distances: Vec<f64>,
    points: Vec<[f64; 3]>,
    features: Vec<u8>,
    weights: Vec<[f64; 3]>,
    directions: Vec<[f64; 3]>,
}

/// `pliant_closest`: the closest point of a body for each of some points.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantClosest {
    /// Number of points.
    pub count: usize,
    /// Whether there is one within the cut-off.
    pub found: *const u8,
    /// Bodies that have them.
    pub bodies: *const u32,
    /// Triangles that have them.
    pub triangles: *const u32,
    /// Distances.
    pub distances: *const f64,
    /// The closest points.
    pub points: *const f64,
    /// Features of the triangles.
    pub features: *const u8,
    /// Weights of the triangles' corners.
    pub weights: *const f64,
    /// Directions from the closest points.
    pub directions: *const f64,
}

/// `pliant_depth`: how deep a body reaches into another.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantDepth {
    /// Number of vertices.
    pub count: usize,
    /// Depth of each.
    pub of_vertices: *const f64,
    /// The deepest.
    pub vertex: u32,
    /// Its depth.
    pub at_least: f64,
    /// Upper bound for the whole surface.
    pub at_most: f64,
}

impl Columns {
    /// Takes answers, and shows them.
    fn told(&mut self, all: &[Option<ClosestPoint>]) -> PliantClosest {
        const NONE: [f64; 3] = [f64::NAN; 3];
        /// A column: what there is, or what stands for none.
        fn column<T: Copy>(
            all: &[Option<ClosestPoint>],
            none: T,
            of: impl Fn(&ClosestPoint) -> T,
        ) -> Vec<T> {
            let one = |it: &Option<ClosestPoint>| it.as_ref().map_or(none, &of);
            all.iter().map(one).collect()
        }
        *self = Self {
            found: column(all, 0, |_| 1),
            bodies: column(all, u32::MAX, |it| it.body.0),
            triangles: column(all, u32::MAX, |it| it.triangle),
            distances: column(all, f64::INFINITY, |it| it.distance),
            points: column(all, NONE, |it| it.point),
            features: column(all, u8::MAX, |it| it.feature.into()),
            weights: column(all, NONE, |it| it.barycentric),
            directions: column(all, NONE, |it| it.direction.unwrap_or_default()),
        };
        PliantClosest {
            count: all.len(),
            found: start(&self.found),
            bodies: start(&self.bodies),
            triangles: start(&self.triangles),
            distances: start(&self.distances),
            points: start(&self.points),
            features: start(&self.features),
            weights: start(&self.weights),
            directions: start(&self.directions),
        }
    }
}

calls! {
    fn pliant_world_closest_points(
        at: PliantPoints,
        body: u32,
        cut_off: f64,
        query: *const PliantQuery,
        closest: *mut PliantClosest,
    ) |inside| {
        let of = (body != u32::MAX).then_some(BodyId(body));
        // SAFETY: as the header says.
        let until = unsafe { PliantQuery::interrupt_alone(query)? };
        let found = with_world!(&mut inside.world, world => {
            with_points(world, &at, &until, |it, at| it.closest_points(at, of, cut_off))?
        });
        let view = inside.views.of::<Kept>().closest.told(&found);
        // SAFETY: as the header says.
        unsafe { give(closest, view) };
        Ok(())
    }

    fn pliant_world_signed_closest_points(
        at: PliantPoints,
        body: u32,
        cut_off: f64,
        query: *const PliantQuery,
        closest: *mut PliantClosest,
    ) |inside| {
        // SAFETY: as the header says.
        let until = unsafe { PliantQuery::interrupt_alone(query)? };
        let found = with_world!(&mut inside.world, world => {
            with_points(world, &at, &until, |it, at| {
                it.signed_closest_points(at, BodyId(body), cut_off)
            })?
        });
        let view = inside.views.of::<Kept>().with_signs.told(&found);
        // SAFETY: as the header says.
        unsafe { give(closest, view) };
        Ok(())
    }

    fn pliant_world_depth(
        a: u32,
        b: u32,
        query: *const PliantQuery,
        depth: *mut PliantDepth,
    ) |inside| {
        // SAFETY: as the header says.
        let until = unsafe { PliantQuery::interrupt_alone(query)? };
        let found = with_world!(&mut inside.world, world => {
            world.interruptible(&|| until.ends()).depth(BodyId(a), BodyId(b))?
        });
        let kept = &mut inside.views.of::<Kept>().depths;
        *kept = found.of_vertices;
        let view = PliantDepth {
            count: kept.len(),
            of_vertices: start(kept),
            vertex: found.vertex.unwrap_or(u32::MAX),
            at_least: found.at_least,
            at_most: found.at_most,
        };
        // SAFETY: as the header says.
        unsafe { give(depth, view) };
        Ok(())
    }
}
