//! Fuzzes points against a closed body that moves: winding numbers equal the oracle's, and no
//! triangle is nearer than the nearest.
//!
//! Bodies are boundaries of tetrahedra, which may share faces, overlap, be flat or turned inside
//! out. The body keeps its tree and its hints from shape to shape, and a new world has neither.
#![no_main]

use arbitrary::Arbitrary;
use pliant::{Degree, InsideRule, Options, Scalar, Side, World};
use pliant_fuzz::places::Grid;
use pliant_oracle::{compare_distance, winding_number};
use std::cmp::Ordering;

/// Limits: tetrahedra, vertices, points and shapes.
const TETRAHEDRA: usize = 6;
const VERTICES: usize = 12;
const POINTS: usize = 12;
const SHAPES: usize = 3;

#[derive(Arbitrary, Debug)]
struct Asked {
    grid: Grid,
    wide: bool,
    degree: u8,
    leaf_size: u8,
    tetrahedra: Vec<[u8; 4]>,
    /// Positions of vertices, one after the other.
    shapes: Vec<Vec<[i8; 3]>>,
    points: Vec<[i8; 3]>,
    /// The number of points that are asked about, if not all.
    few: Option<u8>,
    cut_off: i8,
}

libfuzzer_sys::fuzz_target!(|asked: Asked| {
    if asked.wide {
        check::<f64>(&asked, |x| x);
    } else {
        check::<f32>(&asked, |x| x as f32);
    }
});

fn check<S: Scalar>(asked: &Asked, convert: fn(f64) -> S) {
    let number = |it: u8| u32::from(it) % VERTICES as u32;
    let tetrahedra = asked.tetrahedra.iter().take(TETRAHEDRA);
    let faces = tetrahedra
        .map(|corners| corners.map(number))
        .filter(|it| (1..4).all(|k| !it[..k].contains(&it[k])))
        .flat_map(|[a, b, c, d]| [[a, c, b], [a, b, d], [b, c, d], [c, a, d]]);
    let triangles: Vec<[u32; 3]> = faces.collect();
    if triangles.is_empty() {
        return;
    }
    let place = |at: &[i8; 3]| at.map(|it| asked.grid.coordinate(it, asked.wide));
    let mut points: Vec<[f64; 3]> = asked.points.iter().take(POINTS).map(place).collect();
    let mut options = Options::default();
    options.degree = [Degree::Two, Degree::Four, Degree::Eight][usize::from(asked.degree % 3)];
    options.leaf_size = (u32::from(asked.leaf_size % 9) + 1)
        .try_into()
        .expect("at least 1");
    let mut world = World::with_options(options);
    let mut body = None;
    for shape in asked.shapes.iter().take(SHAPES) {
        let mut exact: Vec<[f64; 3]> = shape.iter().take(VERTICES).map(place).collect();
        exact.resize(VERTICES, [asked.grid.coordinate(1, asked.wide); 3]);
        let positions: Vec<[S; 3]> = exact.iter().map(|it| it.map(convert)).collect();
        match body {
            Some(body) => world.set_positions(body, &positions),
            None => world.add(&triangles, &positions).map(|it| body = Some(it)),
        }
        .expect("coordinates are in range");
        let body = body.expect("added");
        let surface: Vec<[[f64; 3]; 3]> = triangles
            .iter()
            .map(|corners| corners.map(|it| exact[it as usize]))
            .collect();
        let rows: Vec<[S; 3]> = points.iter().map(|it| it.map(convert)).collect();

        let mut another = World::new();
        let same = another
            .add(&triangles, &positions)
            .expect("as the other body");
        let found = world
            .points_inside(&rows, body, InsideRule::NonZero)
            .expect("closed");
        let closest = world
            .signed_closest_points(&rows, body, f64::INFINITY)
            .expect("closed");
        assert_eq!(
            closest,
            another
                .signed_closest_points(&rows, same, f64::INFINITY)
                .expect("closed")
                .into_iter()
                .map(|it| it.map(|it| pliant::ClosestPoint { body, ..it }))
                .collect::<Vec<_>>()
        );
        let cut_off = asked.grid.coordinate(asked.cut_off, asked.wide).abs();
        let near = world
            .closest_points(&rows, Some(body), cut_off)
            .expect("a good distance");
        for (place, &point) in points.iter().enumerate() {
            let winding = winding_number(point, &surface);
            let side = match winding {
                None => Side::On,
                Some(0) => Side::Outside,
                Some(_) => Side::Inside,
            };
            assert_eq!(found[place].side, side);
            assert_eq!(found[place].winding, winding.unwrap_or(0));

            let closest = closest[place].expect("nothing is further");
            let distance = closest.distance.abs();
            assert_eq!(closest.distance < 0.0, side == Side::Inside);
            assert_eq!(distance == 0.0, side == Side::On);
            let within = |triangle: &[[f64; 3]; 3], x: f64| compare_distance(&[point], triangle, x);
            let less = distance * (1.0 - f64::powi(0.5, 29)) - f64::from_bits(1);
            let more = distance * (1.0 + f64::powi(0.5, 29)) + f64::from_bits(1);
            let its = &surface[closest.triangle as usize];
            assert_ne!(within(its, more), Ordering::Greater);
            if less > 0.0 {
                let is_nearer = |it: &_| within(it, less) == Ordering::Less;
                assert!(!surface.iter().any(is_nearer));
            }
            let is_near = within(its, cut_off) != Ordering::Greater;
            assert_eq!(near[place].is_some(), is_near);
        }
        if let Some(few) = asked.few {
            points.truncate(usize::from(few));
        }
    }
}
