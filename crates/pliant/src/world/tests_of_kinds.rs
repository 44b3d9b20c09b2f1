//! Two kinds of queries on one world: each keeps its boxes, and neither knows the other.

use super::Selection;
use super::engine::{AnyEngine, Engine};
use super::query::{Ask, Request};
use crate::geometry::{Aabb, Bounds};
use crate::hits::Pair;
use crate::ids::BodyId;
use crate::kernels::Coordinate;
use crate::options::{Degree, Options, Update};
use crate::queries::grown::{Near, NearPair};
use crate::threads::Threads;
use std::num::{NonZeroU32, NonZeroUsize};

/// A wavy sheet of 2 x (side - 1)^2 triangles.
fn sheet<S>(side: u32, height: f64, phase: f64, of: fn(f64) -> S) -> (Vec<[u32; 3]>, Vec<[S; 3]>) {
    let corner = |x: u32, y: u32| y * side + x;
    let triangles = (0..side - 1).flat_map(|y| (0..side - 1).map(move |x| (x, y)));
    let triangles = triangles.flat_map(|(x, y)| {
        let [a, b] = [corner(x, y), corner(x + 1, y)];
        let [c, d] = [corner(x, y + 1), corner(x + 1, y + 1)];
        [[a, b, c], [b, d, c]]
    });
    let vertices = (0..side).flat_map(|y| (0..side).map(move |x| [x, y].map(f64::from)));
    let wave = |[x, y]: [f64; 2]| height + (0.7 * x + phase).sin() + 0.5 * (0.9 * y - phase).cos();
    let positions = vertices.map(|[x, y]| [x, y, wave([x, y])].map(of));
    (triangles.collect(), positions.collect())
}

/// What the second kind must find.
fn expected<S: Coordinate>(
    bodies: &[(Vec<[u32; 3]>, Vec<[S; 3]>)],
    distance: f32,
) -> Vec<NearPair> {
    let mut boxes: Vec<([u32; 2], Aabb)> = Vec::new();
    for (body, (triangles, positions)) in (0..).zip(bodies) {
        for (triangle, corners) in (0..).zip(triangles) {
            let mut bounds = Bounds::EMPTY;
            for vertex in corners {
                bounds.include(positions[*vertex as usize]);
            }
            // The origin is where these bodies are.
            boxes.push(([body, triangle], bounds.to_box([0.0; 4]).grown(distance)));
        }
    }
    let mut pairs = Vec::new();
    for (at, (a, box_a)) in boxes.iter().enumerate() {
        for (b, box_b) in &boxes[at + 1..] {
            if box_a.overlaps(box_b) {
                pairs.push(NearPair([a[0], a[1], b[0], b[1]]));
            }
        }
    }
    pairs
}

fn request(of: Selection) -> Request<'static> {
    Request::new(of)
}

fn pairs_of<const N: usize, S: Coordinate>(engine: &mut Engine<N, S>) -> Vec<Pair> {
    let all = Ask::<Pair>::all(engine, &request(Selection::Everything));
    all.unwrap().to_vec()
}

fn check<const N: usize, S: Coordinate>(options: Options, of: fn(f64) -> S) {
    let bodies = |phase| [sheet(9, 0.0, phase, of), sheet(9, 0.4, 2.0 * phase, of)];
    let new = || {
        let threads = Threads::private(options.threads);
        let mut engine = Engine::<N, S>::new(options, threads);
        for (triangles, positions) in bodies(0.0) {
            engine.add(&triangles, &positions).unwrap();
        }
        engine
    };
    let (mut both, mut one) = (new(), new());
    for (step, phase) in [0.3, 0.6, 0.6, 1.2].into_iter().enumerate() {
        let shapes = bodies(phase);
        for (body, (_, positions)) in (0..).zip(&shapes) {
            for engine in [&mut both, &mut one] {
                engine.set_positions(BodyId(body), positions).unwrap();
            }
        }
        // Half a query, in the middle of which the other kind is asked, twice with other boxes.
        for engine in [&mut both, &mut one] {
            let first = Ask::<Pair>::first(engine, &request(Selection::World));
            assert!(first.unwrap().is_some());
        }
        for distance in [0.0, 0.25] {
            for _ in 0..2 {
                let mut grown = std::mem::take(&mut both.grown);
                let kind = &Near::within(distance);
                let of = request(Selection::Everything);
                let found = grown.all(kind, &mut both.common, &of).unwrap();
                if S::BOXES_ARE_EXACT {
                    assert!(
                        found == expected(&shapes, distance),
                        "step {step}, {distance}"
                    );
                } else {
                    // Its boxes are relative to another origin: none is missing.
                    let exact = expected(&shapes, distance);
                    assert!(found.len() >= exact.len());
                }
                both.grown = grown;
            }
        }
        // What the first kind had made is valid still: it makes as many boxes as where nobody else asked, and finds the same.
        assert_eq!(pairs_of(&mut both), pairs_of(&mut one));
        assert_eq!(both.statistics(), one.statistics(), "step {step}");
        assert!(both.statistics().pairs > 0);
        both.validate().unwrap();
        one.validate().unwrap();
    }
}

#[test]
fn a_second_kind_has_boxes_of_its_own() {
    for update in [Update::BottomUp, Update::TopDown, Update::HYBRID] {
        for leaf_size in [1, 3, 8, 11] {
            for threads in [1, 3] {
                let options = |degree| Options {
                    degree,
                    update,
                    leaf_size: NonZeroU32::new(leaf_size).unwrap(),
                    threads: NonZeroUsize::new(threads).unwrap(),
                    ..Options::default()
                };
                check::<2, f32>(options(Degree::Two), |x| x as f32);
                check::<8, f32>(options(Degree::Eight), |x| x as f32);
                check::<8, f64>(options(Degree::Eight), |x| x);
            }
        }
    }
}
