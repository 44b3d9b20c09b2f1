//! A second kind of query in the middle of a step leaves the first kind's boxes valid.
//!
//! Every two values of two choices are tried together; if tests are thorough, all combinations.

use crate::common::{combinations, covering, covers_every_pair, is_thorough};
use pliant::{Degree, Options, Scalar, Selection, Update, World};
use std::num::{NonZeroU32, NonZeroUsize};

/// A wavy sheet.
fn sheet<S>(height: f64, phase: f64, of: fn(f64) -> S) -> (Vec<[u32; 3]>, Vec<[S; 3]>) {
    let side = 9;
    let corner = |x: u32, y: u32| y * side + x;
    let squares = (0..side - 1).flat_map(|y| (0..side - 1).map(move |x| (x, y)));
    let triangles = squares.flat_map(|(x, y)| {
        let [a, b] = [corner(x, y), corner(x + 1, y)];
        let [c, d] = [corner(x, y + 1), corner(x + 1, y + 1)];
        [[a, b, c], [b, d, c]]
    });
    let vertices = (0..side).flat_map(|y| (0..side).map(move |x| [x, y].map(f64::from)));
    let wave = |[x, y]: [f64; 2]| height + (0.7 * x + phase).sin() + 0.5 * (0.9 * y - phase).cos();
    let positions = vertices.map(|[x, y]| [x, y, wave([x, y])].map(of));
    (triangles.collect(), positions.collect())
}

fn check<S: Scalar>(options: Options, of: fn(f64) -> S) {
    let bodies = |phase| [sheet(0.0, phase, of), sheet(0.4, 2.0 * phase, of)];
    let mut ids = Vec::new();
    let mut new = || {
        let mut world = World::<S>::with_options(options);
        let added = bodies(0.0).map(|(triangles, at)| world.add(&triangles, &at).unwrap());
        ids = added.to_vec();
        world
    };
    let (mut both, mut one) = (new(), new());
    for (step, phase) in [0.3, 0.6, 0.6, 1.2].into_iter().enumerate() {
        for (&body, (_, positions)) in ids.iter().zip(bodies(phase)) {
            for world in [&mut both, &mut one] {
                world.set_positions(body, &positions).unwrap();
            }
        }
        // Half a query; then others are asked in the middle of it, twice with other sets of boxes.
        for world in [&mut both, &mut one] {
            let first = world.intersections(Selection::World).first();
            assert!(first.unwrap().is_some());
        }
        let of = Selection::Everything;
        for distance in [0.0, 0.25] {
            for _ in 0..2 {
                let close = both.close_triangle_pairs(of, distance).all().unwrap().len();
                assert!(close > 0);
                let near = both.edge_edge_candidates(of, distance).all().unwrap().len();
                assert!(near > 0);
            }
        }
        // As many boxes are made as in a world where nobody else asked, and the same hits are
        // found.
        let found = both.intersections(of).all().unwrap().to_vec();
        assert!(!found.is_empty());
        assert_eq!(found, one.intersections(of).all().unwrap());
        assert_eq!(both.statistics(), one.statistics(), "step {step}");
        both.validate().unwrap();
        one.validate().unwrap();
    }
}

/// How many values each choice has: update, leaf size, threads, degree with precision.
const CHOICES: [usize; 4] = [3, 4, 2, 3];

#[test]
fn a_second_kind_has_boxes_of_its_own() {
    let every_two = if is_thorough() {
        combinations(&CHOICES)
    } else {
        covering(&CHOICES)
    };
    assert!(covers_every_pair(&CHOICES, &every_two));
    for values in every_two {
        let mut options = Options::default();
        options.update = [Update::BottomUp, Update::TopDown, Update::HYBRID][values[0]];
        options.leaf_size = NonZeroU32::new([1, 3, 8, 11][values[1]]).unwrap();
        options.threads = NonZeroUsize::new([1, 3][values[2]]).unwrap();
        options.degree = [Degree::Two, Degree::Eight, Degree::Eight][values[3]];
        if values[3] < 2 {
            check::<f32>(options, |x| x as f32);
        } else {
            check::<f64>(options, |x| x);
        }
    }
}
