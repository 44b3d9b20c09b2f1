//! Lent thread pool: pliant works on the rayon threads that the application already has.
//!
//! `cargo run -p pliant --example lent_pool`

use pliant::{Options, Selection, World};
use std::error::Error;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    let pool = Arc::new(rayon::ThreadPoolBuilder::new().num_threads(2).build()?);
    let mut world = World::with_pool(Options::default(), pool.clone());

    let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 1.0_f32]];
    for number in 0..100 {
        let x = 0.3 * number as f32;
        world.add(&[[0, 1, 2]], &triangle.map(|[a, b, c]| [a + x, b, c]))?;
    }
    // The answer is the same for any number of threads.
    let pairs = world.intersections(Selection::World).all()?.len();
    println!(
        "{pairs} pairs, with the {} threads of the pool",
        pool.current_num_threads()
    );
    Ok(())
}
