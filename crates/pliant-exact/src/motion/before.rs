//! Whether two moving elements surely do not meet before a time, without their own time being
//! found.
//!
//! This is for many elements that meet at one time, as where a surface is turned inside out through
//! a plane. To find the time of each and to compare it costs ten times as much. Here two signs at
//! the time are enough, which are exact (`Contact::surely_precedes`).

use super::{Contact, Later, Moving, Polygon, certain, differences, powers_of_all};

impl Contact {
    /// Whether two elements surely do not meet before this time, nor at it unless they `may_tie`.
    ///
    /// The time is at most `until`, which is a multiple of 2^-44. If not, they may meet at any
    /// time, or never. One of two proofs is enough; both compare signs at the time, exactly:
    ///
    /// - on an axis, all corners of the polygon are on one side at the start. At the time they are
    ///   on the same side, or at most at zero: they are affine;
    /// - the determinant has one root at most up to the time, and no other sign at the time than at
    ///   the start.
    ///
    /// That there is one root at most is proven in double precision (`certain`). Cost: some
    /// microseconds.
    pub fn surely_precedes(&self, moving: &Moving, until: f64, may_tie: bool) -> bool {
        let Self::Later(Later(time)) = self else {
            return may_tie;
        };
        let stays = |at_start: i8, at_time: i8| {
            at_start != 0 && (at_time == at_start || at_time == 0 && may_tie)
        };
        let rounded = certain::Polygon::new(moving);
        let is_apart = |axis: usize| {
            let [unit, _] = powers_of_all(moving.corners.as_flattened().iter().map(|it| &it[axis]));
            let corners = differences(moving, axis, unit);
            let side = corners[0].sign_at_zero();
            corners[..rounded.count]
                .iter()
                .all(|x| x.sign_at_zero() == side && stays(side, time.sign_of(x)))
        };
        let [about, _] = time.about();
        if (0..3).any(|axis| rounded.is_perhaps_apart(axis, about) && is_apart(axis)) {
            return true;
        }
        if !rounded.has_one_root_until(until) {
            return false;
        }
        let determinant = Polygon::new(moving).determinant();
        stays(determinant.sign_at_zero(), time.sign_of(&determinant))
    }

    /// Whether the time is at most this number, which is from 0 to 1; exact. Cost: about a
    /// microsecond.
    pub fn is_at_most(&self, time: f64) -> bool {
        match self {
            Self::AtStart => true,
            Self::Later(Later(root)) => root.is_at_most(time),
        }
    }
}
