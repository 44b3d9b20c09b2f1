//! Time to build a body: `World::add` with default options beside parry3d's `TriMesh`, at equal
//! size.
//!
//! ```sh
//! # up to 1.3 million triangles
//! cargo run --release -p pliant-bench --features peers --example building
//! # any scene, any of its sizes; some gigabytes
//! cargo run --release -p pliant-bench --features peers --example building -- cloth:10008338
//! ```
//!
//! The two take turns, so that a machine that is slow for a while is slow for both. The ratio is
//! taken round by round, then its median. The whole public call is timed, but no freeing.
//!
//! - pliant: the check of the input, the tree, and copies of triangles and positions.
//! - parry3d: the tree. Vectors that it keeps are made before the clock starts.

use parry3d::math::Vector;
use parry3d::shape::{TriMesh, TriMeshFlags};
use pliant::World;
use pliant_bench::machine::this_machine;
use pliant_scenes::Scene;
use std::time::Instant;

/// Scenes and triangles a body. The first body is built.
const DEFAULT: [&str; 4] = [
    "spheres:20480",
    "cloth:79202",
    "spheres:327680",
    "spheres:1310720",
];

fn main() {
    let machine = this_machine();
    println!("{}, {} build", machine.processor, machine.profile);
    println!(
        "median and fastest of the rounds, milliseconds; \
         ratio: parry3d / pliant, its median and range\n"
    );
    println!(
        "{:<18} {:>6}   {:>10} {:>10}   {:>10} {:>10}   {:>6}",
        "mesh", "rounds", "pliant", "fastest", "parry3d", "fastest", "ratio"
    );
    let mut wanted: Vec<String> = std::env::args().skip(1).collect();
    if wanted.is_empty() {
        wanted = DEFAULT.map(str::to_owned).to_vec();
    }
    for mesh in wanted {
        match body_of(&mesh) {
            Ok((triangles, positions)) => compare(&mesh, &triangles, &positions),
            Err(what) => {
                eprintln!("{mesh}: {what}; say SCENE:TRIANGLES, as in cloth:79202");
                std::process::exit(2);
            }
        }
    }
}

/// First body of a scene, in its first shape.
fn body_of(mesh: &str) -> Result<(Vec<[u32; 3]>, Vec<[f32; 3]>), String> {
    let (name, triangles) = mesh.split_once(':').ok_or("no size")?;
    let triangles = triangles.parse().map_err(|_| "the size is not a number")?;
    let scene = Scene::new(name, Some(triangles), Scene::DEFAULT_SEED)
        .map_err(|error| error.to_string())?;
    let mut positions = Vec::new();
    scene.positions(0, 1, &mut positions);
    Ok((scene.triangles(0).to_vec(), positions))
}

fn compare(mesh: &str, triangles: &[[u32; 3]], positions: &[[f32; 3]]) {
    let rounds = (10_000_000 / triangles.len()).clamp(5, 41);
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    for round in 0..rounds {
        for turn in 0..2 {
            if (round + turn) % 2 == 0 {
                ours.push(pliant(triangles, positions));
            } else {
                theirs.push(parry(triangles, positions));
            }
        }
    }
    let ratios: Vec<f64> = theirs.iter().zip(&ours).map(|(t, o)| t / o).collect();
    let [ours, theirs, ratios] = [ours, theirs, ratios].map(sorted);
    let middle = rounds / 2;
    println!(
        "{mesh:<18} {rounds:>6}   {:>10.3} {:>10.3}   {:>10.3} {:>10.3}   {:>6.2} ({:.2} to {:.2})",
        ours[middle],
        ours[0],
        theirs[middle],
        theirs[0],
        ratios[middle],
        ratios[0],
        ratios[rounds - 1]
    );
}

fn pliant(triangles: &[[u32; 3]], positions: &[[f32; 3]]) -> f64 {
    let mut world = World::new();
    let start = Instant::now();
    let body = world.add(triangles, positions);
    let time = start.elapsed();
    body.expect("a scene's bodies are good");
    time.as_secs_f64() * 1e3
}

fn parry(triangles: &[[u32; 3]], positions: &[[f32; 3]]) -> f64 {
    let triangles = triangles.to_vec();
    let vertices = positions.iter().map(|&p| Vector::from(p)).collect();
    let start = Instant::now();
    let mesh = TriMesh::with_flags(vertices, triangles, TriMeshFlags::DEFORMABLE);
    let time = start.elapsed();
    mesh.expect("a scene's bodies have triangles");
    time.as_secs_f64() * 1e3
}

fn sorted(mut times: Vec<f64>) -> Vec<f64> {
    times.sort_by(f64::total_cmp);
    times
}
