//! Segments and curves in columns, as bindings of other languages give them.

use super::{Curve, Curves, Segments};
use crate::error::Error;
use crate::world::{Scalar, World};

/// Segments in vectors, one for each array.
#[derive(Clone, Debug, Default)]
pub struct SegmentColumns {
    /// First end of each pair, and one behind the last.
    pub offsets: Vec<u64>,
    /// Point of each end.
    pub points: Vec<[f64; 3]>,
    /// Feature of either triangle that each end is on.
    pub on: Vec<[u8; 2]>,
    /// Parameter of each end on an edge of either triangle; else NaN.
    pub parameters: Vec<[f64; 2]>,
    /// Normals of both triangles of each pair.
    pub normals: Vec<[f64; 3]>,
    /// Whether the triangles of a pair lie in one plane.
    pub flat: Vec<bool>,
}

impl SegmentColumns {
    /// Writes them in columns.
    pub fn of(segments: &Segments) -> Self {
        let mut offsets = vec![0];
        let (mut normals, mut flat) = (Vec::new(), Vec::new());
        for segment in segments.iter() {
            offsets.push(offsets[offsets.len() - 1] + segment.ends.len() as u64);
            normals.extend(segment.normals);
            flat.push(segment.is_flat);
        }
        let ends = segments.ends().iter();
        Self {
            offsets,
            points: ends.clone().map(|end| end.point).collect(),
            on: ends.clone().map(|end| end.on.map(u8::from)).collect(),
            parameters: ends
                .map(|end| end.parameter.map(|t| t.unwrap_or(f64::NAN)))
                .collect(),
            normals,
            flat,
        }
    }
}

/// Curves in vectors, one for each array.
#[derive(Clone, Debug, Default)]
pub struct CurveColumns {
    /// Segments of all pairs.
    pub segments: SegmentColumns,
    /// First step of each curve, and one behind the last.
    pub offsets: Vec<u64>,
    /// Segment of each step.
    pub steps: Vec<u64>,
    /// Whether a step runs from its second end to its first.
    pub reversed: Vec<bool>,
    /// Whether the second triangle is on the first side.
    pub swapped: Vec<bool>,
    /// Length of each curve.
    pub length: Vec<f64>,
    /// Whether each curve is closed.
    pub closed: Vec<bool>,
    /// Number of the [`CurveEnd`](super::CurveEnd) of both ends; 255 if closed.
    pub ends: Vec<[u8; 2]>,
    /// Areas enclosed on both sides, if asked for; NaN for none.
    pub areas: Vec<[f64; 2]>,
    /// Pairs that meet in one point alone.
    pub touching: Vec<u64>,
}

impl CurveColumns {
    /// Writes them in columns.
    pub fn of(curves: &Curves) -> Self {
        let mut offsets = vec![0];
        for curve in curves.iter() {
            offsets.push(offsets[offsets.len() - 1] + curve.steps().len() as u64);
        }
        let steps = || curves.iter().flat_map(|curve| curve.steps());
        let ends = |curve: Curve<'_>| {
            let ends = curve.ends();
            ends.map_or([NO_END; 2], |ends| ends.map(|end| end as u8))
        };
        Self {
            segments: SegmentColumns::of(curves.segments()),
            offsets,
            steps: steps().map(|step| step.segment as u64).collect(),
            reversed: steps().map(|step| step.is_reversed).collect(),
            swapped: steps().map(|step| step.is_swapped).collect(),
            length: curves.iter().map(|curve| curve.length()).collect(),
            closed: curves.iter().map(|curve| curve.is_closed()).collect(),
            ends: curves.iter().map(ends).collect(),
            areas: Vec::new(),
            touching: curves.touching().iter().map(|&pair| pair as u64).collect(),
        }
    }

    /// Adds the areas that each curve encloses on both sides; NaN for none.
    ///
    /// # Errors
    ///
    /// The errors of [`Curve::enclosed_areas`].
    pub fn with_areas<S: Scalar>(
        mut self,
        curves: &Curves,
        world: &World<S>,
    ) -> Result<Self, Error> {
        for curve in curves.iter() {
            let areas = curve.enclosed_areas(world)?;
            self.areas.push(areas.map(|area| area.unwrap_or(f64::NAN)));
        }
        Ok(self)
    }
}

/// End of a closed curve, which has none.
const NO_END: u8 = 255;
