//! Points of the caller against a body: how often its surface winds round them, and where it is
//! nearest.
//!
//! - `packets`: points near each other, with their boxes in lanes.
//! - `reach`: packets, brought down a tree to triangles.
//! - `share`: a body brought up to date, and its trees shown to the points, on several threads.
//! - `winding`: winding numbers, by rays.
//! - `nearest`: the nearest triangle of each point; `candidates`: those that may be.
//! - `hints`: what was nearest the last time.
//! - `closest`: closest points, measured.
//! - `side`: inside, outside or on, as a rule says of a winding number.

mod candidates;
mod closest;
mod hints;
mod nearest;
mod packets;
mod reach;
mod share;
mod side;
mod winding;

pub(crate) use candidates::Nearest;
pub use closest::ClosestPoint;
pub(crate) use closest::measure;
pub(crate) use hints::Hints;
pub(crate) use nearest::{find_nearest, find_nearest_of_all};
pub use side::{InsideRule, Located, Side};
pub(crate) use winding::{Winding, windings};

use crate::error::{Error, ErrorKind};
use crate::geometry::Real;
use pliant_exact::denormals_are_kept;

/// Refuses points of which one is out of range, or too small for this thread.
pub(crate) fn check_points<S: Real>(points: &[[S; 3]]) -> Result<(), Error> {
    let keeps = denormals_are_kept();
    let is_good = |x: &S| x.is_in_range() && (keeps || !x.needs_subnormals());
    let is_bad = |point: &[S; 3]| !point.iter().all(is_good);
    match points.iter().position(is_bad) {
        Some(point) => {
            let position = points[point].map(S::to_f64);
            Err(ErrorKind::BadPoint { point, position }.of_query())
        }
        None => Ok(()),
    }
}
