//! Sides: inside, outside or on a closed surface, and the rule that says so.

use super::winding::Winding;

/// Rule by which a winding number says inside or outside.
///
/// How often a closed surface winds round a point is an integer. It is 1 inside a body whose
/// triangles are turned outward, 2 where it overlaps itself, -1 where it is turned inside out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum InsideRule {
    /// Inside is where the winding number is not 0.
    #[default]
    NonZero,
    /// Inside is where the winding number is above 0.
    Positive,
    /// Inside is where a ray crosses the surface an odd number of times, whichever way triangles
    /// are turned. Of a body that overlaps itself, that is not inside which it covers twice.
    Parity,
}

/// Which side of a closed surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// Outside.
    #[default]
    Outside,
    /// On the surface: in one of its triangles.
    On,
    /// Inside.
    Inside,
}

/// Side of a point, and how often the surface winds round it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Located {
    /// Which side.
    pub side: Side,
    /// Winding number; 0 on the surface. With [`Parity`](InsideRule::Parity) 1 inside, 0 elsewhere.
    pub winding: i32,
}

impl Winding {
    /// The side that a rule says.
    pub(crate) fn located(self, rule: InsideRule) -> Located {
        if self.is_on {
            let side = Side::On;
            return Located { side, winding: 0 };
        }
        let winding = match rule {
            InsideRule::Parity => (self.crossings % 2) as i32,
            InsideRule::NonZero | InsideRule::Positive => self.number,
        };
        let side = match rule {
            InsideRule::Positive if winding < 0 => Side::Outside,
            _ if winding == 0 => Side::Outside,
            _ => Side::Inside,
        };
        Located { side, winding }
    }
}
