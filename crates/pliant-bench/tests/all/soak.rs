//! The soak in short; `cargo run --release -p pliant-bench --example soak` is the long one.

use pliant::{BroadPhase, Options};
use pliant_bench::soak::{Soak, Tally};

/// Parades, and the first of them, which are the world's youth.
const PARADES: usize = 9;
const EARLY: usize = 3;
/// Steps before each.
const STEPS: usize = 25;

/// The most heap at an early parade, the least at a later one, and what was done.
///
/// The heap at a parade goes up and down by some percent, for how far a list has grown depends on what came before. What is never
/// given back raises the least of them above all that was before.
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
    let (early, late) = heap.split_at(EARLY);
    let most = early.iter().copied().fold(0, i64::max);
    let least = late.iter().copied().fold(i64::MAX, i64::min);
    ([most, least], soak.tally())
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
    ];
    assert!(least.iter().all(|&count| count >= 5), "{tally:?}");
    assert!(tally.moved > 1000 && tally.pairs > 10_000, "{tally:?}");
}

#[test]
fn a_world_that_lives_long_answers_like_a_fresh_one_in_memory_that_stays_flat() {
    check(Soak::single(Options::default(), 1));
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
