//! `f64` coordinates that `f32` boxes cannot hold, wherever the bodies are.
//!
//! Every box is the box of all that is below it, and no pair is lost. That a box holds its
//! triangles is tested against exact sums in `geometry`. Pairs alone would not show it: any
//! rounding that keeps order keeps overlapping boxes overlapping, rounding to nearest included.

use crate::common::{Lcg, TrianglesOf, covering_configurations, sheet};
use pliant::{Options, Scalar, Selection, World, reference};

/// A crumpled sheet whose coordinates use all 53 bits.
fn crumpled(side: u32, random: &mut Lcg) -> Vec<[f64; 3]> {
    let (_, flat) = sheet(side);
    let mut noise = || {
        let bits = u64::from(random.below(1 << 26)) << 26 | u64::from(random.below(1 << 26));
        bits as f64 * 2f64.powi(-53) - 0.25
    };
    flat.iter()
        .map(|p| p.map(|x| f64::from(x) + noise()))
        .collect()
}

/// Moves a point far from the origin, close to it, or to either end of the range.
fn placed(p: [f64; 3], frame: usize) -> [f64; 3] {
    match frame % 6 {
        0 => p,
        1 => [p[0] + 1e7 + 0.1, p[1] - 1e7 / 3.0, p[2] + 1e-3],
        2 => p.map(|x| x * 1e-40),
        3 => p.map(|x| x * 1e-310),
        4 => p.map(|x| x * 1e38),
        _ => [p[0] * 1e-320, p[1] * 1e30, p[2] + 1e15],
    }
}

fn check(options: Options, frames: &[[Vec<[f64; 3]>; 2]], truths: &[Vec<[u32; 2]>]) {
    let (triangles, _) = sheet(7);
    let mut world = World::with_options(options);
    let [a, b] = [0, 1].map(|body| world.add(&triangles, &frames[0][body]).unwrap());
    for (frame, truth) in frames.iter().zip(truths) {
        world.set_positions(a, &frame[0]).unwrap();
        world.set_positions(b, &frame[1]).unwrap();
        let found = world.triangles_of(Selection::Between(a, b));
        assert_eq!(&found, truth, "{options:?}");
        // Every box that claims to be valid is the box of its vertices and lies in its parent.
        world.validate().unwrap();
        world.intersections(Selection::World).prepare().unwrap();
        world.validate().unwrap();
    }
}

#[test]
fn worlds_whose_coordinates_f32_cannot_hold() {
    let (triangles, _) = sheet(7);
    let mut random = Lcg(31);
    let frames: Vec<[Vec<[f64; 3]>; 2]> = (0..12)
        .map(|frame| {
            [(); 2].map(|()| {
                let shape = crumpled(7, &mut random);
                shape.into_iter().map(|p| placed(p, frame)).collect()
            })
        })
        .collect();
    let cannot_hold = |p: &[f64; 3]| p.iter().any(|&x| (x as f32).to_f64() != x);
    assert!(frames.iter().flatten().flatten().all(cannot_hold));
    let truths: Vec<_> = frames
        .iter()
        .map(|[a, b]| reference::intersection_pairs(&triangles, a, &triangles, b).unwrap())
        .collect();
    assert!(truths.iter().filter(|truth| truth.len() > 20).count() > 8);
    for options in covering_configurations() {
        check(options, &frames, &truths);
    }
}

/// Triangles that touch in a coordinate between two `f32`, seen from origins of every size.
#[test]
fn touching_where_no_f32_is() {
    let triangles = [[0, 1, 2]];
    let mut random = Lcg(37);
    let mut world = World::<f64>::new();
    let start = [[0.0; 3]; 3];
    let [a, b, far] = [(); 3].map(|()| world.add(&triangles, &start).unwrap());
    for round in 0..3_000 {
        let size = 10f64.powi(random.below(70) as i32 - 40);
        let at = (f64::from(random.unit()) + 2f64.powi(-40)) * size;
        let height = f64::from(random.unit()) * size;
        // They meet in the plane x = at, or are apart by one unit in the last place.
        let gap = round % 2 == 1;
        let beyond = if gap { at.next_up() } else { at };
        let left = [
            [at, 0.0, 0.0],
            [at - size, 0.0, 0.0],
            [at - size, size, height],
        ];
        let right = [
            [beyond, 0.0, 0.0],
            [beyond + size, 0.0, 0.0],
            [beyond + size, size, -height],
        ];
        // A third body moves the origin that boxes are relative to.
        let away = [[1e3 * size, -7.3 * size, at]; 3];
        for (body, positions) in [(a, &left), (b, &right), (far, &away)] {
            world.set_positions(body, positions).unwrap();
        }
        let pairs = world.intersections(Selection::World).all().unwrap().len();
        assert_eq!(pairs, usize::from(!gap), "{left:?} {right:?}");
        world.validate().unwrap();
    }
}
