//! Relation of two bodies' frames, and the test whether boxes of either can meet.
//!
//! A box test has two roles: one box is *held* while the children of the other node are tested
//! against it. Whatever depends on the held box alone is computed once for all of them.
//! [`Oriented`] is the test with two frames, [`Aligned`] with one; [`margin`] makes up for
//! rounding.

use super::centre_box::CentreBox;
use crate::motion::Pose;

/// 2 u: twice the unit roundoff of `f32`.
const ROUNDING: f64 = f32::EPSILON as f64;

/// Part of the margin due to one body, known when its tree has been refitted.
///
/// `pose` is given if the boxes are around positions in a frame of their own.
pub(super) fn slack(root: &CentreBox, levels: usize, pose: Option<&Pose>) -> f64 {
    let (radius, levels) = (f64::from(root.reach()), levels as f64);
    ROUNDING
        * match pose {
            Some(pose) => (16.0 + 2.0 * levels) * radius + largest(pose.translation),
            None => (2.0 + levels) * radius,
        }
}

/// Margin that enlarges the held box, so that rounding loses no pair; `apart` is the translation
/// from one frame to the other.
///
/// Intersection is decided on world positions W in f32. The boxes are around local positions L in
/// f32, and everything is computed with roundings. So the held box is enlarged by a margin, added
/// to its half extents once in either frame.
///
/// | symbol | meaning |
/// |---|---|
/// | u | 2^-24 |
/// | r | a bound on \|L\| on every axis |
/// | D | levels of the tree |
/// | \|t\| | size of a body's translation, on the axis where it is largest |
/// | d | size of the translation of T, the map between the frames, on that axis |
///
/// All bounds are on one axis and in first order.
///
/// - **Positions.** There is a real point p with L = p (1 + u) and W = (R p + t)(1 + u), roundings
///   meant as "by at most", see [`Rigid`](crate::motion::Rigid). So the place of L is at most
///   sqrt(3) u (|W| + r) from W in length, where |W| <= |t| + sqrt(3) r. If two triangles have a
///   common point in the world, take the points with the same weights in the two local triangles.
///   As one frame sees them, they are no farther apart than both these errors: u (4.8 r + 1.8 |t|)
///   for each body.
/// - **Boxes.** Making a box rounds its half extent by u r, and the faces of the boxes it is made
///   from by u r. A box misses what is below it by at most 2 D u r, and seen in the other frame by
///   sqrt(3) times that.
/// - **The test itself.** Entries of R and T are rounded once from f64. A centre takes three
///   products, three sums and a difference, the half extents three products and three sums.
///   Together at most u (22 r + 5 d), with r of both bodies together.
/// - **Double precision.** The rotation matrices are orthonormal only to 1e-14, and f64 rounds:
///   nothing beside u.
///
/// Together u ((27 + 3.5 D) r + 1.8 |t|) for each body and 5 u d for the pair. Where products
/// underflow, add a few times 2^-149. Rounded up:
///
/// ```text
/// margin = 2u ((16 + 2 D) r + |t|) of a  +  the same of b  +  6u d  +  2^-126
/// ```
///
/// For two unit spheres of 20,480 triangles near the origin this is 1.5e-5, a two-thousandth of a
/// triangle.
///
/// Where boxes are around the world positions themselves, two errors remain. Boxes cost 2 D u r; a
/// difference and two sums cost 3 u r. The margin is then 2u (2 + D) r of either body.
fn margin(slack: [f64; 2], apart: [f64; 3]) -> f32 {
    let margin = slack[0] + slack[1] + 3.0 * ROUNDING * largest(apart);
    (margin + f64::from(f32::MIN_POSITIVE)) as f32
}

fn largest(vector: [f64; 3]) -> f64 {
    vector.into_iter().map(f64::abs).fold(0.0, f64::max)
}

/// Box test between a body `a` and a body `b`.
pub(super) trait Relation {
    /// A box prepared for several tests against boxes of the other body.
    type Held<'a>
    where
        Self: 'a;

    /// Holds a box of `a`.
    fn hold_a(&self, bounds: &CentreBox) -> Self::Held<'_>;

    /// Holds a box of `b`.
    fn hold_b(&self, bounds: &CentreBox) -> Self::Held<'_>;

    /// Whether the held box may meet a box of the other body. Touching counts.
    fn meets(held: &Self::Held<'_>, other: &CentreBox) -> bool;
}

/// Test of two bodies with a common frame: three axes.
///
/// If both frames are the world, boxes are apart if |b.centre - a.centre|_k > a.half_k + b.half_k
/// on some axis k.
pub(super) struct Aligned {
    margin: f32,
}

impl Aligned {
    pub(super) fn new(slack: [f64; 2]) -> Self {
        Self {
            margin: margin(slack, [0.0; 3]),
        }
    }
}

impl Relation for Aligned {
    type Held<'a> = CentreBox;

    #[inline]
    fn hold_a(&self, bounds: &CentreBox) -> CentreBox {
        bounds.enlarged(self.margin)
    }

    #[inline]
    fn hold_b(&self, bounds: &CentreBox) -> CentreBox {
        bounds.enlarged(self.margin)
    }

    #[inline]
    fn meets(held: &CentreBox, other: &CentreBox) -> bool {
        overlap(held, other)
    }
}

/// Test of two bodies with different frames: six axes.
///
/// In world space the boxes of two bodies are oriented. Of the fifteen axes that could separate
/// them, van den Bergen tests the six face normals ("SAT lite"). A few more pairs pass, none is
/// lost. R is the rotation and T the whole map from the frame of `b` to the frame of `a`, computed
/// once for a pair. Boxes are apart if on some axis k
///
/// ```text
/// |T(b.centre) - a.centre|_k  >  a.half_k + (|R| b.half)_k
/// ```
///
/// or if the same holds with a and b exchanged.
pub(super) struct Oriented {
    to_a: Change,
    to_b: Change,
    margin: f32,
}

impl Oriented {
    pub(super) fn new(a: &Pose, b: &Pose, slack: [f64; 2]) -> Self {
        let (to_a, apart) = Change::between(b, a);
        let (to_b, apart_too) = Change::between(a, b);
        let farther = std::array::from_fn(|axis| apart[axis].abs().max(apart_too[axis].abs()));
        Self {
            to_a,
            to_b,
            margin: margin(slack, farther),
        }
    }

    #[inline]
    fn hold<'a>(&self, bounds: &CentreBox, there: &Change, back: &'a Change) -> HeldOriented<'a> {
        HeldOriented {
            seen: there.of(bounds).enlarged(self.margin),
            own: bounds.enlarged(self.margin),
            back,
        }
    }
}

/// A held box in both frames.
pub(super) struct HeldOriented<'a> {
    /// Box around it in the other frame.
    seen: CentreBox,
    own: CentreBox,
    /// Map from the other frame to its own.
    back: &'a Change,
}

impl Relation for Oriented {
    type Held<'a> = HeldOriented<'a>;

    #[inline]
    fn hold_a(&self, bounds: &CentreBox) -> HeldOriented<'_> {
        self.hold(bounds, &self.to_b, &self.to_a)
    }

    #[inline]
    fn hold_b(&self, bounds: &CentreBox) -> HeldOriented<'_> {
        self.hold(bounds, &self.to_a, &self.to_b)
    }

    #[inline]
    fn meets(held: &HeldOriented<'_>, other: &CentreBox) -> bool {
        overlap(&held.seen, other) && overlap(&held.own, &held.back.of(other))
    }
}

/// Whether two boxes overlap on three axes of one frame.
#[inline]
fn overlap(a: &CentreBox, b: &CentreBox) -> bool {
    let on = |axis: usize| (a.centre[axis] - b.centre[axis]).abs() <= a.half[axis] + b.half[axis];
    // No branch between the axes: it would be mispredicted more often than it saves.
    on(0) & on(1) & on(2)
}

/// Map from one frame to another.
struct Change {
    rotation: [[f32; 3]; 3],
    /// Absolute values of the rotation, by which half extents are multiplied.
    absolute: [[f32; 3]; 3],
    translation: [f32; 3],
}

impl Change {
    /// The map, and its translation before rounding.
    fn between(from: &Pose, to: &Pose) -> (Self, [f64; 3]) {
        // The inverse of a rotation is its transpose: the axes of `to` are the columns of its
        // matrix.
        let axis_of_to = |axis: usize| to.rotation.map(|row| row[axis]);
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let rotation: [[f32; 3]; 3] = std::array::from_fn(|i| {
            std::array::from_fn(|j| dot(axis_of_to(i), from.rotation.map(|row| row[j])) as f32)
        });
        let apart = std::array::from_fn(|axis| from.translation[axis] - to.translation[axis]);
        let translation: [f64; 3] = std::array::from_fn(|i| dot(axis_of_to(i), apart));
        let change = Self {
            rotation,
            absolute: rotation.map(|row| row.map(f32::abs)),
            translation: translation.map(|x| x as f32),
        };
        (change, translation)
    }

    /// Box in the new frame around a box of the old one.
    #[inline]
    fn of(&self, bounds: &CentreBox) -> CentreBox {
        let times = |row: &[f32; 3], x: &[f32; 3]| row[0] * x[0] + row[1] * x[1] + row[2] * x[2];
        CentreBox {
            centre: std::array::from_fn(|axis| {
                times(&self.rotation[axis], &bounds.centre) + self.translation[axis]
            }),
            half: std::array::from_fn(|axis| times(&self.absolute[axis], &bounds.half)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NO_SLACK: [f64; 2] = [0.0; 2];

    fn cube(centre: [f32; 3]) -> CentreBox {
        CentreBox {
            centre,
            half: [1.0; 3],
        }
    }

    /// A pose turned by an eighth about z: corners of a cube point along x and y, 1.414 far.
    fn turned(translation: [f64; 3]) -> Pose {
        let s = 0.5_f64.sqrt();
        Pose {
            rotation: [[s, -s, 0.0], [s, s, 0.0], [0.0, 0.0, 1.0]],
            translation,
        }
    }

    fn meet(a: &Pose, b: &Pose) -> bool {
        let relation = Oriented::new(a, b, NO_SLACK);
        let [x, y] = [cube([0.0; 3]); 2];
        let meets = Oriented::meets(&relation.hold_a(&x), &y);
        assert_eq!(Oriented::meets(&relation.hold_b(&y), &x), meets);
        let other_way = Oriented::new(b, a, NO_SLACK);
        assert_eq!(Oriented::meets(&other_way.hold_a(&y), &x), meets);
        meets
    }

    #[test]
    fn boxes_are_apart_on_an_axis_of_either() {
        let still = Pose::IDENTITY;
        // On x, an axis of the box that is not turned: 1 + 1.414.
        assert!(meet(&still, &turned([2.41, 0.0, 0.0])));
        assert!(!meet(&still, &turned([2.42, 0.0, 0.0])));
        // Along the diagonal, an axis of the turned box: 1.414 + 1, but on x only 1.7.
        assert!(meet(&still, &turned([1.70, 1.70, 0.0])));
        assert!(!meet(&still, &turned([1.71, 1.71, 0.0])));
    }

    #[test]
    fn turned_boxes_of_one_frame_are_boxes() {
        let pose = turned([1e3, -2e3, 5.0]);
        let relation = Oriented::new(&pose, &pose, NO_SLACK);
        let meets = |x| Oriented::meets(&relation.hold_a(&cube([0.0; 3])), &cube([x, 1.99, 0.0]));
        assert!(meets(1.99) && !meets(2.01));
    }

    #[test]
    fn the_margin_is_as_said() {
        let root = cube([0.0; 3]);
        let shifted = Pose {
            translation: [0.0, -10.0, 3.0],
            ..Pose::IDENTITY
        };
        let (local, world) = (slack(&root, 20, Some(&shifted)), slack(&root, 20, None));
        assert_eq!(local, ROUNDING * (56.0 + 10.0));
        assert_eq!(world, ROUNDING * 22.0);
        let relation = Oriented::new(&shifted, &Pose::IDENTITY, [local, local]);
        let expected = ROUNDING * (66.0 + 66.0 + 3.0 * 10.0);
        assert!((f64::from(relation.margin) - expected).abs() < 1e-12);
    }
}
