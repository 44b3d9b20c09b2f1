//! Curves of intersection: where listed pairs of triangles meet, and how segments hang together.
//!
//! Idea: a pair meets in a point, a segment or a polygon. Each end has the name of the vertex, edge
//! or triangle of both meshes on which it lies. Segments with an end in common are linked by these
//! names alone. Invariant: no coordinate is compared, so rounding joins nothing and parts nothing.
//! Only positions, lengths and areas are rounded.

mod area;
mod columns;
mod linking;
mod segments;

pub use columns::{CurveColumns, SegmentColumns};
pub use linking::{Curve, CurveEnd, Curves, Step};
pub use segments::{Segment, Segments};
