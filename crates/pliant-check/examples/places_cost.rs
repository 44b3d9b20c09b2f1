//! How much longer a check takes that finds places: the least time of some rounds with and without, in turns.
//!
//! `cargo run --release -p pliant-check --example places_cost -- BODY...`, each body by itself.

use pliant_check::{Check, Settings};
use pliant_io::OpenOptions;
use std::time::{Duration, Instant};

const ROUNDS: usize = 7;

/// All frames of a body with itself: pairs, places, and the time that the checks took, reading included.
fn check(body: &str, places: bool) -> Result<(usize, usize, Duration), pliant_check::Error> {
    let settings = Settings {
        places,
        listed: false,
        ..Settings::default()
    };
    let mut check = Check::open(&[body.to_owned()], &OpenOptions::default(), &settings)?;
    let (mut pairs, begun) = (0, Instant::now());
    while let Some(found) = check.next_frame()? {
        pairs += found.count;
    }
    Ok((pairs, check.places().0, begun.elapsed()))
}

fn main() -> Result<(), pliant_check::Error> {
    for body in std::env::args().skip(1) {
        let (mut least, mut counts) = ([Duration::MAX; 2], (0, 0));
        for _ in 0..ROUNDS {
            for with in [false, true] {
                let (pairs, places, took) = check(&body, with)?;
                least[usize::from(with)] = least[usize::from(with)].min(took);
                counts = (pairs, places);
            }
        }
        let [without, with] = least.map(|took| took.as_secs_f64() * 1e3);
        println!(
            "{body}: {} pairs, {} places; {without:.2} ms without, {with:.2} ms with places: {:+.1} %",
            counts.0,
            counts.1,
            100.0 * (with / without - 1.0)
        );
    }
    Ok(())
}
