//! Short soak test. The long one is `cargo run --release -p pliant-bench --example soak`.

use pliant::{BroadPhase, Options};
use pliant_bench::soak::{Soak, Tally};

/// Number of parades, and of steps before each.
const PARADES: usize = 3;
const STEPS: usize = 12;

/// Heap at the second and at the last parade, and the counts of what was done.
fn play<S: pliant::Scalar>(mut soak: Soak<S>) -> ([i64; 2], Tally) {
    let mut now = 0;
    let heap = [0; PARADES].map(|_: i64| {
        let counted = allocation_counter::measure(|| {
            for _ in 0..STEPS {
                soak.step().unwrap();
            }
            soak.parade().unwrap();
        });
        now += counted.bytes_current;
        now
    });
    ([heap[1], heap[PARADES - 1]], soak.tally())
}

fn check<S: pliant::Scalar>(soak: Soak<S>) {
    let ([early, late], tally) = play(soak);
    assert!(
        late as f64 <= early as f64 * 1.01,
        "the heap grew from {early} to {late} bytes"
    );
    // Everything happened, and not rarely.
    assert_eq!(tally.steps as usize, PARADES * STEPS);
    let least = [
        tally.added - 600,
        tally.removed - 400,
        tally.refused,
        tally.compared - 3,
        tally.edited,
    ];
    assert!(least.iter().all(|&count| count >= 5), "{tally:?}");
    assert!(tally.moved > 1000 && tally.pairs > 10_000, "{tally:?}");
    assert!(tally.close > 10_000 && tally.distances >= 32, "{tally:?}");
    assert!(tally.met > 1_000, "{tally:?}");
}

#[test]
fn a_world_that_lives_long_answers_like_a_fresh_one_in_memory_that_stays_flat() {
    check(Soak::single(Options::default(), 1));
}

#[test]
fn a_world_of_double_precision_configured_like_the_paper_lives_long_too() {
    let mut options = Options::paper();
    options.broad_phase = BroadPhase::BruteForce;
    check(Soak::double(options, 2));
}

#[test]
fn the_seed_determines_everything() {
    let mut tallies = [3, 3, 4].map(|seed| {
        let mut soak = Soak::single(Options::default(), seed);
        for _ in 0..20 {
            soak.step().unwrap();
        }
        (soak.tally(), soak.size())
    });
    assert_eq!(tallies[0], tallies[1]);
    assert_ne!(tallies[1], tallies[2]);
    tallies[0].0.steps = 0;
    assert_ne!(
        tallies[0], tallies[1],
        "tallies are compared field by field"
    );
}
