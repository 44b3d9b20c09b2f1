//! Cost of the bindings: calls of the C functions over calls of Rust's, on the same pairs.
//!
//! Rows lie as Rust has them, columns as Eigen does; the aims are 1.05 and 1.3. Figures are medians
//! of rounds in turn.

use pliant::{Selection, World};
use pliant_c::{
    PliantFaces, PliantPoints, pliant_edge_edge_distances, pliant_edge_edge_impacts,
    pliant_triangle_contacts, pliant_vertex_triangle_distances, pliant_vertex_triangle_impacts,
    pliant_world_add, pliant_world_free, pliant_world_intersections, pliant_world_new,
};
use std::hint::black_box;
use std::ptr::{null, null_mut};
use std::time::Instant;

const PAIRS: usize = 100_000;
const ROUNDS: usize = 15;

/// Pairs of elements that are near each other, as a broad phase finds them.
fn pairs<const C: usize>(seed: u64) -> Vec<[[f64; 3]; C]> {
    let mut state = seed;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24)
    };
    let mut corner = || [random(), random(), random()];
    (0..PAIRS).map(|_| [(); C].map(|()| corner())).collect()
}

/// Corners as they lie in rows, or copied into columns.
fn points<const C: usize>(
    pairs: &[[[f64; 3]; C]],
    columns: Option<&mut Vec<f64>>,
) -> [PliantPoints; C] {
    let (count, size) = (pairs.len(), size_of::<f64>() as isize);
    let mut points = [PliantPoints {
        data: pairs.as_ptr().cast(),
        count,
        row: 3 * C as isize * size,
        column: size,
        scalar: 1,
    }; C];
    match columns {
        None => {
            for (corner, of) in points.iter_mut().enumerate() {
                of.data = (&raw const pairs[0][corner]).cast();
            }
        }
        Some(columns) => {
            columns.clear();
            for corner in 0..C {
                for axis in 0..3 {
                    columns.extend(pairs.iter().map(|pair| pair[corner][axis]));
                }
            }
            for (corner, of) in points.iter_mut().enumerate() {
                of.data = (&raw const columns[3 * corner * count]).cast();
                (of.row, of.column) = (size, count as isize * size);
            }
        }
    }
    points
}

/// Prints nanoseconds of a question that finds nothing: of Rust, and of C.
fn compare_calls() {
    const CALLS: usize = 20_000;
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mut rust = World::<f64>::new();
    let mut c = null_mut();
    let faces = [[0_u32, 1, 2]];
    // SAFETY: all arrays are there.
    unsafe {
        assert_eq!(pliant_world_new(null(), &raw mut c, null_mut()), 0);
        for x in [0.0, 5.0] {
            let corners = corners.map(|[_, y, z]| [x, y, z]);
            rust.add(&faces, &corners).expect("a body");
            let faces = PliantFaces {
                data: faces.as_ptr().cast(),
                count: 1,
                row: 0,
                column: 0,
                bytes: 4,
                is_signed: 0,
            };
            let points = PliantPoints {
                data: corners.as_ptr().cast(),
                count: 3,
                row: 0,
                column: 0,
                scalar: 1,
            };
            assert_eq!(
                pliant_world_add(c, faces, points, null_mut(), null_mut()),
                0
            );
        }
    }
    let mut times = [Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        let start = Instant::now();
        for _ in 0..CALLS {
            let found = rust.intersections(Selection::Everything).all();
            assert!(black_box(found.expect("an answer")).is_empty());
        }
        times[0].push(start.elapsed().as_secs_f64());
        let start = Instant::now();
        for _ in 0..CALLS {
            // SAFETY: the world is there, and nothing is to be written.
            let status = unsafe { pliant_world_intersections(c, null(), null_mut(), null_mut()) };
            assert_eq!(black_box(status), 0);
        }
        times[1].push(start.elapsed().as_secs_f64());
    }
    let [rust, of_c] = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2] * 1e9 / CALLS as f64
    });
    println!(
        "\na question that finds nothing: {rust:.0} ns in Rust, {:.0} ns more in C",
        of_c - rust
    );
    // SAFETY: it was made, and no call is inside.
    unsafe { pliant_world_free(c) };
}

/// Prints milliseconds of Rust's call, and the ratios of both calls of C.
fn compare(name: &str, mut calls: [&mut dyn FnMut(); 3]) {
    let mut times = [(); 3].map(|()| Vec::new());
    for _ in 0..ROUNDS {
        for (call, times) in calls.iter_mut().zip(&mut times) {
            let start = Instant::now();
            call();
            times.push(start.elapsed().as_secs_f64());
        }
    }
    let [rust, rows, columns] = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2]
    });
    let nanoseconds = rust * 1e9 / PAIRS as f64;
    println!(
        "{name:<28} {nanoseconds:>8.1} {:>8.3} {:>8.3}",
        rows / rust,
        columns / rust
    );
}

fn main() {
    println!("{PAIRS} pairs, {ROUNDS} rounds: nanoseconds a pair of Rust, and ratios of C\n");
    println!("{:<28} {:>8} {:>8} {:>8}", "", "Rust", "rows", "columns");
    let (start, end, triangles) = (pairs::<4>(1), pairs::<4>(2), pairs::<6>(3));
    let columns = &mut [(); 3].map(|()| Vec::new());
    let [of_start, of_end, of_triangles] = columns;
    let in_rows = (points(&start, None), points(&end, None));
    let in_columns = (points(&start, Some(of_start)), points(&end, Some(of_end)));
    let of_rows = points(&triangles, None);
    let of_columns = points(&triangles, Some(of_triangles));
    let (mut hit, mut low, mut high) = (vec![0_u8; PAIRS], vec![0.0; PAIRS], vec![0.0; PAIRS]);
    let [mut distance, mut direction, mut weights] =
        [1, 3, 4].map(|columns| vec![0.0; columns * PAIRS]);
    let mut features = vec![0_u8; PAIRS];
    let [hit, features] = [&mut hit, &mut features].map(Vec::as_mut_ptr);
    let [low, high] = [&mut low, &mut high].map(Vec::as_mut_ptr);
    let [distance, direction, weights] =
        [&mut distance, &mut direction, &mut weights].map(Vec::as_mut_ptr);

    macro_rules! impacts {
        ($rust:path, $c:ident) => {
            // SAFETY: all arrays are there, with a row for each pair.
            let c = |(start, end): &([PliantPoints; 4], [PliantPoints; 4])| unsafe {
                $c(
                    start.as_ptr(),
                    end.as_ptr(),
                    1e-6,
                    hit,
                    low,
                    high,
                    null_mut(),
                )
            };
            compare(
                stringify!($c),
                [
                    &mut || drop(black_box($rust(&start, &end, 1e-6))),
                    &mut || assert_eq!(c(&in_rows), 0),
                    &mut || assert_eq!(c(&in_columns), 0),
                ],
            );
        };
    }
    impacts!(
        pliant::vertex_triangle_impacts,
        pliant_vertex_triangle_impacts
    );
    impacts!(pliant::edge_edge_impacts, pliant_edge_edge_impacts);
    macro_rules! distances {
        ($rust:path, $c:ident) => {
            // SAFETY: all arrays are there, with rows for each pair.
            let c = |corners: &[PliantPoints; 4]| unsafe {
                $c(
                    corners.as_ptr(),
                    distance,
                    direction,
                    weights,
                    features,
                    null_mut(),
                )
            };
            compare(
                stringify!($c),
                [
                    &mut || drop(black_box($rust(&start))),
                    &mut || assert_eq!(c(&in_rows.0), 0),
                    &mut || assert_eq!(c(&in_columns.0), 0),
                ],
            );
        };
    }
    distances!(
        pliant::vertex_triangle_distances,
        pliant_vertex_triangle_distances
    );
    distances!(pliant::edge_edge_distances, pliant_edge_edge_distances);
    // SAFETY: all arrays are there, with a row for each pair.
    let c = |corners: &[PliantPoints; 6]| unsafe {
        pliant_triangle_contacts(corners.as_ptr(), hit, null_mut())
    };
    compare(
        "pliant_triangle_contacts",
        [
            &mut || drop(black_box(pliant::triangle_contacts(&triangles))),
            &mut || assert_eq!(c(&of_rows), 0),
            &mut || assert_eq!(c(&of_columns), 0),
        ],
    );
    compare_calls();
}
