//! Checks that refuse bad meshes, positions and loose boxes.

use crate::error::ErrorKind;
use crate::geometry::{Bounds, Real};
use crate::mesh;
use pliant_exact::denormals_are_kept;

/// Refuses triangles and positions of which no body can be made. O(n).
pub(crate) fn validate<S: Real>(
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
) -> Result<(), ErrorKind> {
    mesh::validate(triangles, positions.len())?;
    all(positions)
}

/// Refuses a list of another length than the body's.
pub(crate) fn length(what: &'static str, expected: usize, found: usize) -> Result<(), ErrorKind> {
    if found == expected {
        return Ok(());
    }
    Err(ErrorKind::WrongLength {
        what,
        expected,
        found,
    })
}

/// Refuses positions of which one is out of range, or too small for this thread.
pub(crate) fn all<S: Real>(positions: &[[S; 3]]) -> Result<(), ErrorKind> {
    if !positions.iter().all(|&position| is_in_range(position)) {
        return Err(out_of_range(positions));
    }
    none_is_lost(positions)
}

/// The error for the first position that is out of range. There is one.
pub(crate) fn out_of_range<S: Real>(positions: &[[S; 3]]) -> ErrorKind {
    let mut all = positions.iter();
    let vertex = all.position(|&position| !is_in_range(position));
    let vertex = vertex.unwrap_or_default();
    ErrorKind::BadPosition {
        vertex,
        position: positions[vertex].map(S::to_f64),
    }
}

/// Refuses coordinates that are too small for this thread, if it flushes subnormal numbers.
///
/// Where it does not, that takes two products.
pub(crate) fn none_is_lost<S: Real>(positions: &[[S; 3]]) -> Result<(), ErrorKind> {
    if denormals_are_kept() {
        return Ok(());
    }
    let is_lost = |position: &[S; 3]| position.iter().any(|x| x.needs_subnormals());
    match positions.iter().position(is_lost) {
        Some(vertex) => Err(ErrorKind::NeedsSubnormals { vertex }),
        None => Ok(()),
    }
}

/// Refuses positions outside a loose box. Positions of empty vertices do not matter.
pub(crate) fn all_inside<S: Real>(
    loose: &Bounds<S>,
    positions: &[[S; 3]],
    is_empty: impl Fn(u32) -> bool,
) -> Result<(), ErrorKind> {
    let mut all = (0..).zip(positions);
    let outside = all.find(|&(vertex, &position)| !loose.holds(position) && !is_empty(vertex));
    outside.map_or(Ok(()), |(vertex, position)| {
        Err(ErrorKind::OutsideLooseBox {
            vertex: vertex as usize,
            position: position.map(S::to_f64),
        })
    })
}

/// Refuses a bad position of one vertex.
pub(crate) fn one<S: Real>(
    vertex: usize,
    position: [S; 3],
    loose: Option<Bounds<S>>,
) -> Result<(), ErrorKind> {
    let at = || position.map(S::to_f64);
    if !is_in_range(position) {
        let position = at();
        return Err(ErrorKind::BadPosition { vertex, position });
    }
    if loose.is_some_and(|loose| !loose.holds(position)) {
        let position = at();
        return Err(ErrorKind::OutsideLooseBox { vertex, position });
    }
    none_is_lost(&[position]).map_err(|_| ErrorKind::NeedsSubnormals { vertex })
}

/// Refuses a loose box that is not a box.
pub(crate) fn is_box<S: Real>(loose: &Bounds<S>) -> Result<(), ErrorKind> {
    let is_box = is_in_range(loose.lo)
        && is_in_range(loose.hi)
        && loose.holds(loose.lo)
        && loose.holds(loose.hi);
    if is_box {
        Ok(())
    } else {
        Err(ErrorKind::BadLooseBox)
    }
}

#[inline]
fn is_in_range<S: Real>([x, y, z]: [S; 3]) -> bool {
    // No early exit: three comparisons without a branch.
    x.is_in_range() & y.is_in_range() & z.is_in_range()
}
