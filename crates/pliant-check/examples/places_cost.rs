//! Measures the time that finding places adds to a check.
//!
//! Prints the median of many rounds, each with and without places. So other load of the machine
//! affects both.
//!
//! `cargo run --release -p pliant-check --example places_cost -- BODY...`, each body by itself.

use pliant_check::{Check, Settings};
use pliant_io::OpenOptions;
use std::time::{Duration, Instant};

const ROUNDS: usize = 41;

/// Checks all frames of a body with itself: number of pairs, number of places, and time.
///
/// The time includes reading.
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
        let (mut ratios, mut times, mut counts) = (Vec::new(), Vec::new(), (0, 0));
        for round in 0..ROUNDS {
            let mut took = [Duration::ZERO; 2];
            // Alternate which one is first.
            for with in [round % 2 == 0, round % 2 == 1] {
                let (pairs, places, time) = check(&body, with)?;
                took[usize::from(with)] = time;
                counts = (pairs, counts.1.max(places));
            }
            let [without, with] = took.map(|took| took.as_secs_f64());
            ratios.push(with / without);
            times.push(without);
        }
        ratios.sort_by(f64::total_cmp);
        times.sort_by(f64::total_cmp);
        println!(
            "{body}: {} pairs, {} places; {:.2} ms without, {:+.1} % with places",
            counts.0,
            counts.1,
            1e3 * times[ROUNDS / 2],
            100.0 * (ratios[ROUNDS / 2] - 1.0)
        );
    }
    Ok(())
}
