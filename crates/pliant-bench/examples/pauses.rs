//! Longest pauses: between two looks of a query for an interruption, and while thousands of bodies
//! are removed.
//!
//! ```sh
//! cargo run --release -p pliant-bench --example pauses    # seconds; a quiet machine
//! ```
//!
//! A query's figure is the best of several tries, since other work on the machine makes any of them
//! long. Whether queries look often enough is tested by counting work
//! (`looks_are_never_far_apart`). This example measures the same pauses as times.

use pliant::{Pair, Selection, World};
use pliant_bench::machine::this_machine;
use pliant_scenes::Scene;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// Measurements of each figure, the best of which counts.
const TRIES: usize = 5;

fn main() {
    let machine = this_machine();
    println!("{}, {} build\n", machine.processor, machine.profile);
    println!("longest between two looks, best of {TRIES} tries");
    let all = |world: &mut World<f32>, look: &(dyn Fn() -> bool + Sync)| {
        let found = world.intersections(Selection::Everything);
        found.interrupt_if(look).all().map(<[Pair]>::len)
    };
    for (name, world) in [
        ("a cloth with itself, first query", cloth()),
        ("490,000 hits in one place", bodies(2, 700, 0.0)),
        ("300 bodies in one place", bodies(300, 1, 0.001)),
    ] {
        let tries = (0..TRIES).map(|_| longest(world.clone(), all));
        println!("{name:<36} {:>8.2} ms", tries.fold(f64::INFINITY, f64::min));
    }
    println!("\nremoved one by one");
    for count in [20_000, 40_000] {
        for (order, newest_first) in [("oldest first", false), ("newest first", true)] {
            let taken = remove(count, newest_first);
            println!("{count} bodies, {order:<23} {taken:>8.2} ms");
        }
    }
}

/// Longest time between two looks, in milliseconds.
fn longest(
    mut world: World<f32>,
    ask: impl Fn(&mut World<f32>, &(dyn Fn() -> bool + Sync)) -> Result<usize, pliant::Error>,
) -> f64 {
    let start = Instant::now();
    let (last, longest) = (AtomicU64::new(0), AtomicU64::new(0));
    let look = || {
        let now = start.elapsed().as_nanos() as u64;
        let before = last.swap(now, Ordering::Relaxed);
        longest.fetch_max(now.saturating_sub(before), Ordering::Relaxed);
        false
    };
    ask(&mut world, &look).expect("nobody interrupts it");
    look();
    longest.into_inner() as f64 / 1e6
}

fn cloth() -> World<f32> {
    let scene = Scene::new("cloth", Some(79_202), Scene::DEFAULT_SEED).expect("there is one");
    let mut positions = Vec::new();
    scene.positions(0, 50, &mut positions);
    let mut world = World::new();
    let added = world.add(scene.triangles(0), &positions);
    added.expect("it is a mesh");
    world
}

/// `count` bodies of `triangles` triangles each, all nearly in one place.
fn bodies(count: u32, triangles: usize, step: f32) -> World<f32> {
    let mut world = World::new();
    for at in 0..count {
        let x = at as f32 * step;
        let corners = [[x, 0.0, 0.0], [x + 9.0, 0.0, 1.0], [x, 9.0, 0.0]];
        let added = world.add(&vec![[0, 1, 2]; triangles], &corners);
        added.expect("it is a mesh");
    }
    world
}

/// Time to remove all bodies, in milliseconds.
fn remove(count: u32, newest_first: bool) -> f64 {
    let mut world = World::<f32>::new();
    let mut ids = Vec::new();
    for at in 0..count {
        let [x, y] = [at % 200, at / 200].map(|at| at as f32);
        let corners = [[x, y, 0.0], [x + 0.5, y, 0.0], [x, y + 0.5, 0.0]];
        ids.push(world.add(&[[0, 1, 2]], &corners).expect("it is a mesh"));
    }
    let found = world.intersections(Selection::World).all();
    assert_eq!(found.expect("nobody interrupts it"), []);
    if newest_first {
        ids.reverse();
    }
    let start = Instant::now();
    for id in ids {
        world.remove(id).expect("it is there");
    }
    start.elapsed().as_secs_f64() * 1e3
}
