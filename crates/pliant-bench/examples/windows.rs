//! Time of the library alone in the windows of the benchmark's scenes; for profilers, and while
//! working on it.
//!
//! ```sh
//! cargo run --release -p pliant-bench --example windows -- [NAME ...] [--rounds R]
//! ```
//!
//! Every step is played several times, all steps one round after the other. A figure is the mean of
//! each step's least time, over the steps of a window. Other work on the machine hardly disturbs
//! it.

use pliant::{BodyId, Curves, Degree, Scalar, Selection, World};
use pliant_bench::motion::Motion;
use pliant_scenes::Scene;
use std::time::Instant;

/// Name, scene, triangles a body, steps, and query.
type Window = (
    &'static str,
    &'static str,
    usize,
    std::ops::RangeInclusive<u32>,
    Ask,
);

#[derive(Clone, Copy)]
enum Ask {
    All,
    /// Intersections with the kind of each contact.
    Contacts,
    First,
    Itself,
    /// Candidates by boxes, with a margin in mean edge lengths; and close pairs, measured.
    Near(f64),
    Close(f64),
    /// Distance of two bodies.
    Distance,
    /// Impacts on the way to the next step; and only the first.
    Meet,
    Earliest,
    /// As itself, and then triangles that share a vertex and meet beyond it.
    Adjacent,
    /// Edges that cross triangles.
    Edges,
    /// Intersections, where they are, and the curves of these.
    Curves,
}

const WINDOWS: [Window; 32] = [
    ("easy", "spheres", 20_480, 1..=50, Ask::All),
    ("hard", "spheres", 20_480, 150..=200, Ask::All),
    ("deepest", "spheres", 20_480, 200..=200, Ask::All),
    ("first", "spheres", 20_480, 60..=200, Ask::First),
    ("crowd", "crowd", 5_120, 150..=200, Ask::All),
    ("flat", "cloth", 79_202, 1..=20, Ask::Itself),
    ("cloth", "cloth", 79_202, 35..=50, Ask::Itself),
    ("small", "spheres", 1_280, 1..=200, Ask::First),
    ("large", "spheres", 327_680, 190..=200, Ask::All),
    ("largest", "spheres", 1_310_720, 196..=200, Ask::All),
    ("near", "cloth", 79_202, 43..=45, Ask::Near(0.1)),
    ("close", "cloth", 79_202, 43..=45, Ask::Close(0.1)),
    ("wide", "cloth", 79_202, 43..=45, Ask::Near(0.5)),
    ("closer", "cloth", 79_202, 43..=45, Ask::Close(0.5)),
    ("deepnear", "spheres", 20_480, 178..=180, Ask::Near(0.5)),
    ("deeper", "spheres", 20_480, 178..=180, Ask::Close(0.5)),
    ("apart", "spheres", 20_480, 1..=50, Ask::Distance),
    ("meet", "cloth", 79_202, 43..=45, Ask::Meet),
    ("meeting", "crowd", 5_120, 118..=120, Ask::Meet),
    ("earliest", "cloth", 79_202, 43..=45, Ask::Earliest),
    ("earlier", "spheres", 20_480, 118..=120, Ask::Earliest),
    ("contacts", "spheres", 20_480, 200..=200, Ask::Contacts),
    ("double", "cloth", 79_202, 43..=45, Ask::Itself),
    ("sphere", "spheres", 20_480, 100..=105, Ask::Itself),
    ("star", "spheres", 20_480, 100..=105, Ask::Adjacent),
    ("flatstar", "cloth", 79_202, 1..=20, Ask::Adjacent),
    ("foldstar", "cloth", 79_202, 35..=50, Ask::Adjacent),
    ("doubstar", "cloth", 79_202, 43..=45, Ask::Adjacent),
    ("edges", "spheres", 20_480, 200..=200, Ask::Edges),
    ("curves", "spheres", 20_480, 200..=200, Ask::Curves),
    ("two", "spheres", 20_480, 200..=200, Ask::All),
    ("four", "spheres", 20_480, 200..=200, Ask::All),
];

/// Degree of the trees in a window.
fn degree(window: &str) -> Degree {
    match window {
        "two" => Degree::Two,
        "four" => Degree::Four,
        _ => Degree::Eight,
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let rounds = arguments
        .iter()
        .position(|argument| argument == "--rounds")
        .map_or(20, |at| {
            arguments[at + 1].parse().expect("a number of rounds")
        });
    let named: Vec<&str> = arguments
        .iter()
        .map(String::as_str)
        .take_while(|argument| *argument != "--rounds")
        .collect();
    for window in WINDOWS {
        if named.is_empty() || named.contains(&window.0) {
            if matches!(window.0, "double" | "doubstar") {
                play::<f64>(window, rounds);
            } else {
                play::<f32>(window, rounds);
            }
        }
    }
}

/// Options by the environment variables THREADS, and LEVEL of the hybrid update.
fn options(degree: Degree) -> pliant::Options {
    let mut options = pliant::Options::default();
    options.degree = degree;
    if let Ok(threads) = std::env::var("THREADS") {
        options.threads = threads.parse().expect("a number of threads");
    }
    if let Ok(level) = std::env::var("LEVEL") {
        let level = level.parse().expect("a level of the tree");
        options.update = pliant::Update::Hybrid {
            level: Some(level),
            levels_at_once: std::num::NonZeroU32::MIN,
        };
    }
    options
}

/// Positions of a body in a step, and at the end of its motion.
struct Placed<S> {
    world: Vec<[S; 3]>,
    end: Option<Vec<[S; 3]>>,
}

fn in_scalar<S: From<f32>>(positions: &[[f32; 3]]) -> Vec<[S; 3]> {
    positions.iter().map(|it| it.map(S::from)).collect()
}

fn play<S: Scalar + From<f32>>((name, scene, triangles, steps, ask): Window, rounds: u32) {
    let scene = Scene::new(scene, Some(triangles), Scene::DEFAULT_SEED).expect("a scene");
    let mut motion = Motion::of_scene(&scene, steps);
    if matches!(ask, Ask::Meet | Ask::Earliest) {
        motion = motion.on_the_way(&scene, 1.0);
    }
    // Margins are in mean edge lengths.
    let ask = match ask {
        Ask::Near(lengths) => Ask::Near(lengths * motion.mean_side()),
        Ask::Close(lengths) => Ask::Close(lengths * motion.mean_side()),
        other => other,
    };
    let mut world = World::<S>::with_options(options(degree(name)));
    let bodies: Vec<BodyId> = motion
        .bodies
        .iter()
        .map(|body| {
            world
                .add(&body.triangles, &in_scalar(&body.first.world))
                .expect("good bodies")
        })
        .collect();
    let placed = |body: &pliant_bench::motion::Placed| Placed {
        world: in_scalar(&body.world),
        end: body.end.as_deref().map(in_scalar),
    };
    let frames = motion.frames.iter();
    let frames: Vec<Vec<Placed<S>>> = frames
        .map(|frame| frame.iter().map(placed).collect())
        .collect();
    let mut least = vec![[f64::INFINITY; 2]; frames.len()];
    let mut work = pliant::Statistics::default();
    let mut found = 0;
    let mut curves = Curves::new();
    for _ in 0..rounds {
        work = pliant::Statistics::default();
        found = 0;
        for (frame, least) in frames.iter().zip(&mut least) {
            let (moved, all, pairs) = one_step(&mut world, &bodies, frame, ask, &mut curves);
            *least = [least[0].min(moved), least[1].min(all)];
            found += pairs;
            work += *world.statistics();
        }
    }
    let steps = least.len() as f64;
    let mean = |which: usize| 1e3 * least.iter().map(|times| times[which]).sum::<f64>() / steps;
    println!(
        "{name:8} {:8.4} ms a step, of it {:.4} in set_positions; {:.0} pairs",
        mean(1),
        mean(0),
        found as f64 / steps
    );
    println!("         a step: {work:?} / {steps}");
}

/// Seconds to set positions and to get the answer, and the number of pairs.
///
/// A function of its own, so that instructions can be counted inside it.
#[inline(never)]
fn one_step<S: Scalar>(
    world: &mut World<S>,
    bodies: &[BodyId],
    frame: &[Placed<S>],
    ask: Ask,
    curves: &mut Curves,
) -> (f64, f64, usize) {
    let start = Instant::now();
    for (&body, placed) in bodies.iter().zip(frame) {
        world
            .set_positions(body, &placed.world)
            .expect("good shapes");
        if let Some(end) = &placed.end {
            world.set_motion(body, end).expect("good shapes");
        }
    }
    let moved = start.elapsed().as_secs_f64();
    let found = match ask {
        Ask::All => all(world, Selection::World),
        Ask::Contacts => {
            let contacts = world.contacts(Selection::World).all();
            contacts.expect("the world is there").len()
        }
        Ask::First => {
            let first = world.intersections(Selection::World).first();
            usize::from(first.expect("the world is there").is_some())
        }
        Ask::Itself => bodies
            .iter()
            .map(|&body| all(world, Selection::Within(body)))
            .sum(),
        Ask::Near(distance) => {
            let (of, radius) = (Selection::Everything, distance / 2.0);
            let near = world.vertex_triangle_candidates(of, radius).all();
            let found = near.expect("the world is there").len();
            let near = world.edge_edge_candidates(of, radius).all();
            found + near.expect("the world is there").len()
        }
        Ask::Close(distance) => {
            let of = Selection::Everything;
            let close = world.close_vertex_triangle_pairs(of, distance).all();
            let found = close.expect("the world is there").len();
            let close = world.close_edge_edge_pairs(of, distance).all();
            found + close.expect("the world is there").len()
        }
        Ask::Distance => {
            let nearest = world.distance(bodies[0], bodies[1], f64::INFINITY);
            usize::from(nearest.expect("both are there").is_some())
        }
        Ask::Meet => {
            let of = Selection::Everything;
            let met = world.vertex_triangle_impacts(of).all();
            let found = met.expect("the world is there").len();
            let met = world.edge_edge_impacts(of).all();
            found + met.expect("the world is there").len()
        }
        Ask::Adjacent => bodies
            .iter()
            .map(|&body| {
                let of = Selection::Within(body);
                let pairs = all(world, of);
                let contacts = world.adjacent_intersections(of).all();
                pairs + contacts.expect("the world is there").len()
            })
            .sum(),
        Ask::Edges => {
            let edges = world.crossing_edges(Selection::World).all();
            edges.expect("the world is there").len()
        }
        Ask::Curves => {
            let pairs = world.intersections(Selection::World).all();
            let pairs = pairs.expect("the world is there").to_vec();
            curves.update(world, &pairs).expect("all are there");
            assert!(curves.iter().all(|curve| curve.is_closed()));
            pairs.len()
        }
        Ask::Earliest => {
            let first = world.first_impact(Selection::Everything, 1e-6);
            usize::from(first.expect("the world is there").is_some())
        }
    };
    (moved, start.elapsed().as_secs_f64(), found)
}

fn all<S: Scalar>(world: &mut World<S>, of: Selection) -> usize {
    world
        .intersections(of)
        .all()
        .expect("the bodies are there")
        .len()
}
