//! Time of a scene whose meshes change, by edits, shapes and query, step by step; for profilers.
//!
//! ```sh
//! # every tenth step, and sums
//! cargo run --release -p pliant-bench --example changing -- remesh
//! # the same shapes without edits
//! cargo run --release -p pliant-bench --example changing -- tear without
//! # with trees that mend themselves
//! cargo run --release -p pliant-bench --example changing -- shuffle mended
//! # with fresh trees, which are built between steps
//! cargo run --release -p pliant-bench --example changing -- shuffle fresh
//! # instructions of all steps, without building between them: free of noise
//! valgrind --tool=callgrind --toggle-collect='changing::one_step' PROGRAM
//! ```

use pliant::{BodyId, Options, Selection, World};
use pliant_bench::methods::add_step;
use pliant_scenes::{ChangingScene, Event};
use std::time::Instant;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "tear".to_owned());
    let scene = ChangingScene::new(&name, None, ChangingScene::DEFAULT_SEED);
    let mut scene = scene.expect("one of the scenes whose meshes change");
    let how = arguments.next();
    if how.as_deref() == Some("without") {
        scene = scene.without_events();
    }
    let mut options = Options::default();
    options.mending = how.as_deref() == Some("mended");
    let mut world = World::<f32>::with_options(options);
    let bodies = 0..scene.body_count();
    let ids: Vec<BodyId> = bodies
        .clone()
        .map(|body| {
            let added = world.add(scene.triangles(body), &scene.first_positions(body));
            added.expect("a scene's bodies are good")
        })
        .collect();
    let mut sums = [0.0; 3];
    // Trees are mended when shapes are set.
    let mut longest_shapes: f64 = 0.0;
    let mut steps = Vec::new();
    let mut shapes = vec![Vec::new(); ids.len()];
    println!("  step    edits   shapes    query    pairs node pairs candidates  quality");
    for step in 1..=scene.steps() {
        for (body, shape) in shapes.iter_mut().enumerate() {
            scene.positions(body, step, shape);
        }
        let (times, pairs) = one_step(&mut world, &ids, scene.events(step), &shapes);
        if how.as_deref() == Some("fresh") {
            for &id in &ids {
                let _ = world.rebuild(id);
            }
            // Tables of neighbours are part of building.
            let _ = world.intersections(Selection::Everything).prepare();
        }
        for (sum, time) in sums.iter_mut().zip(times) {
            *sum += time;
        }
        longest_shapes = longest_shapes.max(times[1]);
        steps.push((times.iter().sum::<f64>(), step));
        if step % 10 == 0 {
            let [edits, shapes, query] = times;
            let work = world.statistics();
            let (nodes, candidates) = (work.node_pairs, work.candidate_pairs);
            let quality = world.tree_quality(ids[0]).expect("it is there");
            println!(
                "{step:6} {edits:8.3} {shapes:8.3} {query:8.3} \
                 {pairs:8} {nodes:10} {candidates:10} {quality:8.2}"
            );
        }
    }
    let [edits, shapes, query] = sums.map(|sum| sum / f64::from(scene.steps()));
    println!("  mean {edits:8.3} {shapes:8.3} {query:8.3} ms");
    steps.sort_by(|a, b| b.0.total_cmp(&a.0));
    println!("a step {:.3} ms on the median", steps[steps.len() / 2].0);
    let longest = steps.iter().take(5);
    let longest: Vec<String> = longest
        .map(|(time, step)| format!("{time:.3} ms at step {step}"))
        .collect();
    println!("the longest: {}", longest.join(", "));
    println!("the longest that shapes took, mending included: {longest_shapes:.3} ms");
}

/// Times of edits, shapes and the query, and the number of pairs.
///
/// A function of its own, so that instructions can be counted inside it.
#[inline(never)]
fn one_step(
    world: &mut World<f32>,
    ids: &[BodyId],
    events: &[Event],
    shapes: &[Vec<[f32; 3]>],
) -> ([f64; 3], usize) {
    let start = Instant::now();
    for event in events {
        match event {
            Event::Edit { body, changes } => {
                let mut edit = world.edit(ids[*body]).expect("it is there");
                changes
                    .iter()
                    .for_each(|it| add_step(&mut edit, it, &shapes[*body]));
                world.apply(&edit).expect("a scene's events are good");
            }
            Event::Fuse { kept, gone } => {
                world.fuse(ids[*kept], ids[*gone]).expect("both are there");
            }
        }
    }
    let edited = Instant::now();
    for (&id, shape) in ids.iter().zip(shapes).filter(|(_, it)| !it.is_empty()) {
        world
            .set_positions(id, shape)
            .expect("a scene's shapes are good");
    }
    let set = Instant::now();
    let pairs = world.intersections(Selection::Everything).all();
    let pairs = pairs.expect("the whole world is there").len();
    let asked = Instant::now();
    let times = [edited - start, set - edited, asked - set];
    (times.map(|time| time.as_secs_f64() * 1e3), pairs)
}
