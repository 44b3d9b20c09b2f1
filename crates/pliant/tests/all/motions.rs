//! First contacts of hard motions, against an oracle in big integers with another formulation.
//!
//! Thousands of motions are compared here, and ten million by the first command. The second times
//! the slowest.
//!
//! ```sh
//! cargo test --release -p pliant --test all motions::ten -- --ignored --nocapture
//! cargo test --release -p pliant --test all motions::slowest -- --ignored --nocapture
//! ```

use pliant::{edge_edge_impacts, vertex_triangle_impacts};
use pliant_oracle::{Elements, MotionClass, Moving, Random, first_contact, motion_fits_f32};
use std::cmp::Ordering;
use std::thread;
use std::time::{Duration, Instant};

/// Widths of intervals that are asked for in turn; a repeated one is asked for more often.
const WIDTHS: [f64; 8] = [1e-6, 1e-6, 1e-6, 1e-6, 0.0, 1.0, 1e-12, 1e-300];

fn impact(elements: Elements, [start, end]: &Moving, width: f64) -> Option<[f64; 2]> {
    let impacts = match elements {
        Elements::VertexTriangle => vertex_triangle_impacts(&[*start], &[*end], width),
        Elements::EdgeEdge => edge_edge_impacts(&[*start], &[*end], width),
    };
    impacts.unwrap()[0]
}

/// Counters and times of the motions compared in one class.
#[derive(Clone, Copy, Default)]
struct Tally {
    motions: u64,
    meeting: u64,
    at_start: u64,
    as_f32: u64,
    slowest: Duration,
    all: Duration,
}

/// Compares the next `count` motions of a class.
fn compare(class: MotionClass, seed: u64, count: u64) -> Tally {
    let mut random = Random::new(seed);
    let mut tally = Tally::default();
    for index in 0..count {
        let (elements, motion) = class.motion(&mut random);
        let width = WIDTHS[index as usize % WIDTHS.len()];
        let begun = Instant::now();
        let found = impact(elements, &motion, width);
        let taken = begun.elapsed();
        tally.slowest = tally.slowest.max(taken);
        tally.all += taken;
        let exact = first_contact(elements, &motion);
        let what = || format!("{class:?} {elements:?} {motion:?} width {width}: {found:?}");
        assert_eq!(found.is_some(), exact.is_some(), "{}", what());
        tally.motions += 1;
        if motion_fits_f32(&motion) {
            tally.as_f32 += 1;
            let [start, end] = motion.map(|corners| corners.map(|p| p.map(|x| x as f32)));
            let single = match elements {
                Elements::VertexTriangle => vertex_triangle_impacts(&[start], &[end], width),
                Elements::EdgeEdge => edge_edge_impacts(&[start], &[end], width),
            };
            assert_eq!(single.unwrap()[0], found, "{}", what());
        }
        let (Some([low, high]), Some(exact)) = (found, exact) else {
            continue;
        };
        tally.meeting += 1;
        if [low, high] == [0.0; 2] {
            tally.at_start += 1;
            assert_eq!(exact.compare(0.0), Ordering::Equal, "{}", what());
            continue;
        }
        assert_eq!(exact.compare(low), Ordering::Greater, "{}", what());
        assert_ne!(exact.compare(high), Ordering::Greater, "{}", what());
        assert!(high - low <= width || high == low.next_up(), "{}", what());
        assert!((0.0..=1.0).contains(&low) && high <= 1.0, "{}", what());
    }
    tally
}

fn compare_all(seed: u64, count: u64) {
    let mut total = Tally::default();
    for class in MotionClass::ALL {
        let tally = thread::scope(|scope| {
            let threads =
                [seed, seed + 1].map(|seed| scope.spawn(move || compare(class, seed, count / 2)));
            threads.map(|thread| thread.join().unwrap())
        });
        let [a, b] = tally;
        println!(
            "{class:?}: {} motions, {} meet, {} of them at the start, {} in f32 too; \
             {:?} each, the slowest {:?}",
            a.motions + b.motions,
            a.meeting + b.meeting,
            a.at_start + b.at_start,
            a.as_f32 + b.as_f32,
            (a.all + b.all) / (a.motions + b.motions) as u32,
            a.slowest.max(b.slowest),
        );
        for tally in [a, b] {
            total.motions += tally.motions;
            total.meeting += tally.meeting;
            total.as_f32 += tally.as_f32;
        }
    }
    println!(
        "all: {} motions, {} meet, {} in f32 too: no difference",
        total.motions, total.meeting, total.as_f32
    );
    assert!(total.meeting > total.motions / 10 && total.meeting < total.motions * 9 / 10);
}

#[test]
fn impacts_are_those_of_the_oracle() {
    compare_all(11, 400);
}

#[test]
#[ignore = "ten million motions: half an hour"]
fn ten_million() {
    let classes = MotionClass::ALL.len() as u64;
    compare_all(101, 10_000_000 / classes + 1);
}

/// Times of the slowest and the hundredth slowest of 100,000 motions of every class.
///
/// Each is the least of three, which other work on the machine hardly disturbs.
#[test]
#[ignore = "times: minutes, on a quiet machine"]
fn slowest() {
    for class in MotionClass::ALL {
        let mut random = Random::new(7);
        let mut times: Vec<Duration> = (0..100_000)
            .map(|_| {
                let (elements, motion) = class.motion(&mut random);
                let tries = [(); 3].map(|()| {
                    let begun = Instant::now();
                    std::hint::black_box(impact(elements, &motion, WIDTHS[0]));
                    begun.elapsed()
                });
                tries.into_iter().min().unwrap()
            })
            .collect();
        times.sort_unstable();
        let [slowest, hundredth] = [1, 100].map(|rank| times[times.len() - rank]);
        println!("{class:?}: the slowest {slowest:?}, the hundredth slowest {hundredth:?}");
        assert!(slowest < Duration::from_secs(1), "{class:?}");
    }
}
