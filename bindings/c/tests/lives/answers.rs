//! Questions with one answer, and what is made of pairs, by C and by Rust.

use crate::{close, column, numbers, timed};
use pliant::{
    BodyId, CloseTriangles, ClosestFeatures, Curves, FeaturePairs, Impact, InContact, Pair, Scalar,
    Segments, Selection, World,
};
use pliant_c::*;
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

/// Number of features in C.
fn number(of: ClosestFeatures) -> u8 {
    match of {
        ClosestFeatures::VertexVertex => 0,
        ClosestFeatures::VertexEdge => 1,
        ClosestFeatures::VertexFace => 2,
        ClosestFeatures::EdgeEdge => 3,
    }
}

/// The answer that a function writes.
fn told<T>(ask: impl FnOnce(*mut T) -> i32) -> T {
    let mut out = MaybeUninit::uninit();
    assert_eq!(ask(out.as_mut_ptr()), 0);
    // SAFETY: the call has succeeded, so it has written.
    unsafe { out.assume_init() }
}

/// All answers of both worlds.
pub(crate) fn compare<S: Scalar>(c: *mut PliantWorld, rust: &mut World<S>, of: Selection) {
    let query = PliantQuery {
        of: numbers(of),
        ..PliantQuery::ALL
    };
    let query = &raw const query;
    // SAFETY: the world and all arguments are there.
    let hits: PliantHits =
        told(|out| unsafe { pliant_world_first_impact(c, query, 1e-6, out, null_mut()) });
    match rust.first_impact(of, 1e-6).unwrap() {
        None => assert_eq!(hits.count, 0),
        Some(impact) => {
            let (pair, low, high, kind): ([u32; 4], f64, f64, u8) = match impact {
                Impact::VertexTriangle(it) => (it.pair.into(), it.low, it.high, 2),
                Impact::EdgeEdge(it) => (it.pair.into(), it.low, it.high, 3),
            };
            assert_eq!(timed(&hits), [format!("{pair:?} {low:?} {high:?}")]);
            assert_eq!(column(hits.kinds, 1, 1), [kind]);
        }
    }
    // SAFETY: the world and all arguments are there.
    let step: f64 =
        told(|out| unsafe { pliant_world_collision_free_step(c, query, 0.125, out, null_mut()) });
    assert_eq!(step, rust.collision_free_step(of, 0.125).unwrap());
    // SAFETY: the world and all arguments are there.
    let step: PliantFreeStep =
        told(|out| unsafe { pliant_world_free_step(c, query, 0.0, out, null_mut()) });
    let expected = rust.free_step(of, 0.0).unwrap();
    let (begins, pair) = match expected.begins_in_contact {
        None => (0, [u32::MAX; 4]),
        Some(InContact::Triangles(pair)) => (1, pair.into()),
        Some(InContact::VertexTriangle(pair)) => (2, pair.into()),
        Some(InContact::EdgeEdge(pair)) => (3, pair.into()),
    };
    assert_eq!(
        (step.t, step.begins_in_contact, step.pair),
        (expected.t, begins, pair)
    );
    assert_eq!(step.moves, u8::from(expected.moves));
    // SAFETY: the world and all arguments are there.
    let clearance: PliantClearance =
        told(|out| unsafe { pliant_world_clearance(c, query, 0.5, out, null_mut()) });
    let expected = rust.clearance(of, 0.5).unwrap();
    let bodies: Vec<u32> = expected.keys().map(|it| it.0).collect();
    assert_eq!(column(clearance.bodies, clearance.body_count, 1), bodies);
    let starts = column(clearance.starts, clearance.body_count + 1, 1);
    let all = column(clearance.clearance, starts[bodies.len()], 1);
    for (of_body, range) in expected.values().zip(starts.windows(2)) {
        assert_eq!(all[range[0]..range[1]], of_body[..]);
    }
    contacts(c, rust, (of, query));
    curves(c, rust, of);
}

fn contacts<S: Scalar>(
    c: *mut PliantWorld,
    rust: &mut World<S>,
    (of, query): (Selection, *const PliantQuery),
) {
    // SAFETY: the world and all arguments are there.
    let told: PliantFeaturePairs =
        told(|out| unsafe { pliant_world_feature_pairs(c, query, 0.25, out, null_mut()) });
    let vertices = rust
        .close_vertex_triangle_pairs(of, 0.25)
        .all()
        .unwrap()
        .to_vec();
    let edges = rust.close_edge_edge_pairs(of, 0.25).all().unwrap().to_vec();
    let mut expected = FeaturePairs::new();
    expected.update(rust, &vertices, &edges).unwrap();
    let all = expected.all();
    let kinds: Vec<u8> = all.iter().map(|it| number(it.features)).collect();
    assert_eq!(column(told.kinds, told.count, 1), kinds);
    let bodies: Vec<u32> = all
        .iter()
        .flat_map(|it| it.bodies.map(|body| body.0))
        .collect();
    assert_eq!(column(told.bodies, told.count, 2), bodies);
    let numbers: Vec<u32> = all.iter().flat_map(|it| it.numbers).collect();
    assert_eq!(column(told.numbers, told.count, 2), numbers);
    let vertices: Vec<u32> = all.iter().flat_map(|it| it.vertices).collect();
    assert_eq!(column(told.vertices, told.count, 4), vertices);
    let weights: Vec<f64> = all.iter().flat_map(|it| it.weights).collect();
    assert_eq!(column(told.weights, told.count, 4), weights);
    let distances: Vec<f64> = all.iter().map(|it| it.distance).collect();
    assert_eq!(column(told.distances, told.count, 1), distances);
    let directions: Vec<f64> = all
        .iter()
        .flat_map(|it| it.direction.unwrap_or_default())
        .collect();
    assert_eq!(column(told.directions, told.count, 3), directions);
    let multiplicities: Vec<u32> = all.iter().map(|it| it.multiplicity).collect();
    assert_eq!(column(told.multiplicities, told.count, 1), multiplicities);
}

/// Segments and curves of all that intersects, and of neighbours that meet.
fn curves<S: Scalar>(c: *mut PliantWorld, rust: &mut World<S>, of: Selection) {
    let mut all: Vec<Pair> = rust.intersections(of).all().unwrap().to_vec();
    all.extend(
        rust.adjacent_intersections(of)
            .all()
            .unwrap()
            .iter()
            .map(|it| it.pair),
    );
    let rows: Vec<[u32; 4]> = all.iter().map(|&it| it.into()).collect();
    let (start, count) = (rows.as_ptr().cast(), rows.len());
    // SAFETY: the world and all arguments are there.
    let (segments, curves): (PliantSegments, PliantCurves) = unsafe {
        (
            told(|out| pliant_world_segments(c, start, count, out, null_mut())),
            told(|out| pliant_world_curves(c, start, count, 1, out, null_mut())),
        )
    };
    let mut expected = Segments::new();
    expected.update(rust, &all).unwrap();
    for told in [segments, curves.segments] {
        let offsets = column(told.offsets, told.count + 1, 1);
        let ends = offsets[count] as usize;
        let points: Vec<f64> = expected.ends().iter().flat_map(|it| it.point).collect();
        assert_eq!(column(told.points, ends, 3), points);
        let on: Vec<u8> = expected
            .ends()
            .iter()
            .flat_map(|it| it.on.map(u8::from))
            .collect();
        assert_eq!(column(told.on, ends, 2), on);
        let bits = |all: Vec<f64>| all.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        let of = |end: &pliant::End| end.parameter.map(|t| t.unwrap_or(f64::NAN));
        let parameters = expected.ends().iter().flat_map(of).collect();
        assert_eq!(bits(column(told.parameters, ends, 2)), bits(parameters));
        let (normals, flat) = (column(told.normals, count, 6), column(told.flat, count, 1));
        for (place, segment) in expected.iter().enumerate() {
            assert_eq!(
                offsets[place + 1] - offsets[place],
                segment.ends.len() as u64
            );
            assert_eq!(normals[6 * place..][..6], *segment.normals.as_flattened());
            assert_eq!(flat[place], u8::from(segment.is_flat));
        }
    }
    let mut expected = Curves::new();
    expected.update(rust, &all).unwrap();
    let offsets = column(curves.offsets, curves.count + 1, 1);
    let steps = offsets[curves.count] as usize;
    let all = [
        column(curves.steps, steps, 1),
        column(curves.reversed, steps, 1)
            .into_iter()
            .map(u64::from)
            .collect(),
        column(curves.swapped, steps, 1)
            .into_iter()
            .map(u64::from)
            .collect(),
    ];
    let (lengths, closed) = (
        column(curves.lengths, curves.count, 1),
        column(curves.closed, curves.count, 1),
    );
    let (ends, areas) = (
        column(curves.ends, curves.count, 2),
        column(curves.areas, curves.count, 2),
    );
    assert_eq!(curves.count, expected.len());
    for (place, curve) in expected.iter().enumerate() {
        let range = offsets[place] as usize..offsets[place + 1] as usize;
        let told: Vec<[u64; 3]> = range
            .map(|step| [all[0][step], all[1][step], all[2][step]])
            .collect();
        let step = |it: &pliant::Step| {
            [
                it.segment as u64,
                u64::from(it.is_reversed),
                u64::from(it.is_swapped),
            ]
        };
        assert_eq!(told, curve.steps().iter().map(step).collect::<Vec<_>>());
        assert_eq!(lengths[place], curve.length());
        assert_eq!(closed[place], u8::from(curve.is_closed()));
        let of = curve
            .ends()
            .map_or([255; 2], |ends| ends.map(|end| end as u8));
        assert_eq!(ends[2 * place..][..2], of);
        let of = curve
            .enclosed_areas(rust)
            .unwrap()
            .map(|it| it.unwrap_or(f64::NAN).to_bits());
        assert_eq!(
            [areas[2 * place].to_bits(), areas[2 * place + 1].to_bits()],
            of
        );
    }
    let touching: Vec<u64> = expected.touching().iter().map(|&it| it as u64).collect();
    assert_eq!(column(curves.touching, curves.touching_count, 1), touching);
}

/// Distances of two bodies.
pub(crate) fn compare_bodies<S: Scalar>(
    c: *mut PliantWorld,
    rust: &mut World<S>,
    a: BodyId,
    b: BodyId,
) {
    for cut_off in [0.5, f64::INFINITY] {
        let query = null();
        // SAFETY: the world and all arguments are there.
        let (distance, nearest): (PliantHits, PliantHits) = unsafe {
            (
                told(|out| pliant_world_distance(c, a.0, b.0, cut_off, query, out, null_mut())),
                told(|out| pliant_world_nearest_body(c, a.0, cut_off, query, out, null_mut())),
            )
        };
        // Of several that are the closest either world gives some.
        let check = |told: &PliantHits, expected: Option<CloseTriangles>| {
            assert_eq!(close(6)(told).len(), usize::from(expected.is_some()));
            if let Some(expected) = expected {
                let distance = column(told.distances, 1, 1)[0];
                assert!((distance - expected.distance).abs() <= 1e-8 * expected.distance);
                let body = expected.pair.body_a.0;
                assert_eq!(column(told.pairs, 1, 4)[0], body);
                assert_eq!(column(told.points, 1, 6).len(), 6);
            }
        };
        check(&distance, rust.distance(a, b, cut_off).unwrap());
        check(&nearest, rust.nearest_body(a, cut_off).unwrap());
    }
}
