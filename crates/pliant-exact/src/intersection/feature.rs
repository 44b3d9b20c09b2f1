//! Features of a triangle: its corners, its edges, its inside.

use crate::point::Sign;

/// The part of a triangle on which a point lies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// A corner, by its number.
    Corner(usize),
    /// Inside an edge, from the corner with its number to the next.
    Edge(usize),
    /// Inside the triangle.
    #[default]
    Inside,
}

/// As a number: 0 to 2 for a corner, 3 to 5 for an edge, 6 for the inside.
impl From<Feature> for u8 {
    fn from(on: Feature) -> Self {
        match on {
            Feature::Corner(corner) => corner as Self,
            Feature::Edge(edge) => 3 + edge as Self,
            Feature::Inside => 6,
        }
    }
}

impl Feature {
    /// Whether it is on an edge, its two corners included.
    pub fn is_on(self, edge: usize) -> bool {
        match self {
            Self::Corner(i) => i == edge || i == (edge + 1) % 3,
            Self::Edge(i) => i == edge,
            Self::Inside => false,
        }
    }
}

/// The feature of a triangle that a line goes through, by the sides of its edges on which the line
/// passes. None if it goes past.
pub(super) fn place(past: [Sign; 3]) -> Option<Feature> {
    let goes_through = past.iter().all(|&side| side >= 0) || past.iter().all(|&side| side <= 0);
    let on = match past.map(|side| side == 0) {
        [false, false, false] => Feature::Inside,
        [true, false, false] => Feature::Edge(0),
        [false, true, false] => Feature::Edge(1),
        [false, false, true] => Feature::Edge(2),
        [true, _, true] => Feature::Corner(0),
        [true, true, _] => Feature::Corner(1),
        [_, true, true] => Feature::Corner(2),
    };
    goes_through.then_some(on)
}
