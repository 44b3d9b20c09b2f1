//! Where pairs of triangles meet, as segments and curves; and each contact of close elements once.

use crate::arrays::{give, list, start};
use crate::pairs::number_of;
use crate::questions::PliantQuery;
use crate::status::{BAD_OPTION, Refused};
use crate::world::{calls, with_world};
use pliant::{CurveColumns, Curves, FeaturePair, FeaturePairs, Pair, SegmentColumns, Segments};

/// Answers that the caller reads, one for each function.
#[derive(Default)]
pub(crate) struct Kept {
    found: Segments,
    segments: SegmentColumns,
    linked: Curves,
    curves: CurveColumns,
    contacts: FeaturePairs,
    columns: ContactColumns,
}

/// `pliant_segments`: where pairs of triangles meet.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantSegments {
    /// Number of pairs.
    pub count: usize,
    /// First end of each, and one behind the last.
    pub offsets: *const u64,
    /// Point of each end.
    pub points: *const f64,
    /// Features of both triangles that it is on.
    pub on: *const u8,
    /// Parameters on edges.
    pub parameters: *const f64,
    /// Normals of both triangles of a pair.
    pub normals: *const f64,
    /// Whether they lie in one plane.
    pub flat: *const u8,
}

impl PliantSegments {
    fn of(all: &SegmentColumns) -> Self {
        Self {
            count: all.flat.len(),
            offsets: start(&all.offsets),
            points: start(&all.points),
            on: start(&all.on),
            parameters: start(&all.parameters),
            normals: start(&all.normals),
            flat: start(&all.flat),
        }
    }
}

/// `pliant_curves`: curves in which pairs of triangles meet.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantCurves {
    /// Segments of all pairs.
    pub segments: PliantSegments,
    /// Number of curves.
    pub count: usize,
    /// First step of each, and one behind the last.
    pub offsets: *const u64,
    /// Segments of steps.
    pub steps: *const u64,
    /// Whether a step goes from the second end to the first.
    pub reversed: *const u8,
    /// Whether the second triangle is on the first side.
    pub swapped: *const u8,
    /// Lengths of curves.
    pub lengths: *const f64,
    /// Whether they are closed.
    pub closed: *const u8,
    /// Kinds of both ends.
    pub ends: *const u8,
    /// Areas enclosed on both sides.
    pub areas: *const f64,
    /// Number of pairs that touch.
    pub touching_count: usize,
    /// The pairs.
    pub touching: *const u64,
}

/// Contacts in columns.
#[derive(Default)]
struct ContactColumns {
    kinds: Vec<u8>,
    bodies: Vec<[u32; 2]>,
    numbers: Vec<[u32; 2]>,
    vertices: Vec<[u32; 4]>,
    weights: Vec<[f64; 4]>,
    distances: Vec<f64>,
    directions: Vec<[f64; 3]>,
    multiplicities: Vec<u32>,
}

/// `pliant_feature_pairs`: each contact of close elements once.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantFeaturePairs {
    /// Number of contacts.
    pub count: usize,
    /// Kinds of the two features.
    pub kinds: *const u8,
    /// Bodies of both.
    pub bodies: *const u32,
    /// Numbers of both.
    pub numbers: *const u32,
    /// Vertices of the first, then of the second.
    pub vertices: *const u32,
    /// Weights of these vertices.
    pub weights: *const f64,
    /// Distances.
    pub distances: *const f64,
    /// Directions from the second to the first.
    pub directions: *const f64,
    /// How many close pairs each stands for.
    pub multiplicities: *const u32,
}

impl ContactColumns {
    fn take(&mut self, all: &[FeaturePair]) {
        *self = Self {
            kinds: all.iter().map(|it| number_of(it.features)).collect(),
            bodies: all.iter().map(|it| it.bodies.map(|body| body.0)).collect(),
            numbers: all.iter().map(|it| it.numbers).collect(),
            vertices: all.iter().map(|it| it.vertices).collect(),
            weights: all.iter().map(|it| it.weights).collect(),
            distances: all.iter().map(|it| it.distance).collect(),
            directions: all
                .iter()
                .map(|it| it.direction.unwrap_or_default())
                .collect(),
            multiplicities: all.iter().map(|it| it.multiplicity).collect(),
        };
    }

    fn view(&self) -> PliantFeaturePairs {
        PliantFeaturePairs {
            count: self.kinds.len(),
            kinds: start(&self.kinds),
            bodies: start(&self.bodies),
            numbers: start(&self.numbers),
            vertices: start(&self.vertices),
            weights: start(&self.weights),
            distances: start(&self.distances),
            directions: start(&self.directions),
            multiplicities: start(&self.multiplicities),
        }
    }
}

/// Pairs of the caller's, as `pliant_hits.pairs` has them.
///
/// # Safety
///
/// They are NULL, or may be read.
unsafe fn pairs_of(pairs: *const u32, count: usize) -> Result<Vec<Pair>, Refused> {
    // SAFETY: as above.
    let rows = unsafe { list(pairs.cast::<[u32; 4]>(), count, "pairs")? };
    Ok(rows.into_iter().map(Pair::from).collect())
}

calls! {
    fn pliant_world_segments(
        pairs: *const u32,
        count: usize,
        segments: *mut PliantSegments,
    ) |inside| {
        // SAFETY: as the header says.
        let pairs = unsafe { pairs_of(pairs, count)? };
        let kept = inside.views.of::<Kept>();
        with_world!(&inside.world, world => kept.found.update(world, &pairs)?);
        kept.segments = SegmentColumns::of(&kept.found);
        // SAFETY: as the header says.
        unsafe { give(segments, PliantSegments::of(&kept.segments)) };
        Ok(())
    }

    fn pliant_world_curves(
        pairs: *const u32,
        count: usize,
        areas: u8,
        curves: *mut PliantCurves,
    ) |inside| {
        if areas > 1 {
            let words = format_args!("areas is {areas}; give 0 or 1");
            return Err(Refused::new(BAD_OPTION, words));
        }
        // SAFETY: as the header says.
        let pairs = unsafe { pairs_of(pairs, count)? };
        let kept = inside.views.of::<Kept>();
        let linked = &mut kept.linked;
        with_world!(&inside.world, world => {
            linked.update(world, &pairs)?;
            let columns = CurveColumns::of(linked);
            kept.curves = if areas == 1 { columns.with_areas(linked, world)? } else { columns };
        });
        let all = &kept.curves;
        let view = PliantCurves {
            segments: PliantSegments::of(&all.segments),
            count: all.closed.len(),
            offsets: start(&all.offsets),
            steps: start(&all.steps),
            reversed: start(&all.reversed),
            swapped: start(&all.swapped),
            lengths: start(&all.length),
            closed: start(&all.closed),
            ends: start(&all.ends),
            areas: start(&all.areas),
            touching_count: all.touching.len(),
            touching: start(&all.touching),
        };
        // SAFETY: as the header says.
        unsafe { give(curves, view) };
        Ok(())
    }

    fn pliant_world_feature_pairs(
        query: *const PliantQuery,
        distance: f64,
        pairs: *mut PliantFeaturePairs,
    ) |inside| {
        // SAFETY: as the header says.
        let (of, until) = unsafe { PliantQuery::of_one_answer(query)? };
        let kept = inside.views.of::<Kept>();
        with_world!(&mut inside.world, world => {
            kept.contacts.ask(world, (of, distance), Some(&|| until.ends()))?;
        });
        kept.columns.take(kept.contacts.all());
        // SAFETY: as the header says.
        unsafe { give(pairs, kept.columns.view()) };
        Ok(())
    }
}
