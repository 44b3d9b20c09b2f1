//! Self-collision: a strip of cloth is rolled up, until it meets itself.
//!
//! `cargo run -p pliant --example self_collision`

use pliant::{ContactKind, Selection, World};

/// Squares along the strip; each is two triangles.
const SQUARES: u32 = 60;

/// Shape of the strip as a roll with this many turns.
///
/// The radius does not grow, so from one turn on the strip meets itself.
fn roll(turns: f64) -> Vec<[f64; 3]> {
    let point = |row: u32, y: f64| {
        let along = f64::from(row) / f64::from(SQUARES);
        let (sine, cosine) = (std::f64::consts::TAU * turns * along).sin_cos();
        [cosine, y + 0.1 * along, sine]
    };
    (0..=SQUARES)
        .flat_map(|row| [point(row, 0.0), point(row, 1.0)])
        .collect()
}

fn main() -> Result<(), pliant::Error> {
    let triangles: Vec<[u32; 3]> = (0..SQUARES)
        .map(|row| 2 * row)
        .flat_map(|v| [[v, v + 1, v + 2], [v + 1, v + 3, v + 2]])
        .collect();
    let mut world = World::new();
    let strip = world.add(&triangles, &roll(0.5))?;
    for step in 5..=12 {
        let turns = 0.1 * f64::from(step);
        world.set_positions(strip, &roll(turns))?;
        // Triangles that share a vertex are left out: they always touch.
        let contacts = world.contacts(Selection::Within(strip)).all()?;
        let crossing = contacts
            .iter()
            .filter(|contact| contact.kind == ContactKind::Crossing)
            .count();
        let all = contacts.len();
        println!("{turns:.1} turns: {all:3} pairs of triangles meet, {crossing:3} of them cross");
    }
    Ok(())
}
