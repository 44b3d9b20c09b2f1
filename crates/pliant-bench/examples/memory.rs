//! Memory in bytes a triangle that a library keeps for moving bodies, with all that a step needs.
//!
//! ```sh
//! # 20,480 and 1,310,720 triangles a body
//! cargo run --release -p pliant-bench --features peers --example memory
//! # any scene, any of its sizes
//! cargo run --release -p pliant-bench --features peers --example memory -- cloth:79202
//! ```
//!
//! A counting allocator reports the live heap of one thread: after building, and after four steps
//! of the scene with every query. The queries are all pairs, the first, and every body with itself.
//! So all that a step needs is counted at its largest: triangles, positions, trees, lists of a
//! query, and pairs. *Building* is the peak while all bodies are built.
//!
//! - pliant: lists of pairs count twice, once in the library and once in the bench's form.
//! - obvhs keeps trees alone. The triangles and positions that a query needs are its adaptor's, and
//!   counted.

use pliant_bench::decision::exact;
use pliant_bench::method::Method;
use pliant_bench::methods::{Obvhs, Ours, Parry};
use pliant_bench::motion::Motion;
use pliant_scenes::Scene;

const DEFAULT: [&str; 2] = ["spheres:20480", "spheres:1310720"];

fn main() {
    let mut wanted: Vec<String> = std::env::args().skip(1).collect();
    if wanted.is_empty() {
        wanted = DEFAULT.map(str::to_owned).to_vec();
    }
    println!(
        "bytes a triangle: live after four steps with every query, and the most while building\n"
    );
    println!(
        "{:<18} {:<22} {:>8} {:>10}",
        "scene", "method", "live", "building"
    );
    for scene in wanted {
        match motion_of(&scene) {
            Ok(motion) => measure_all(&scene, &motion),
            Err(what) => {
                eprintln!("{scene}: {what}; say SCENE:TRIANGLES, as in cloth:79202");
                std::process::exit(2);
            }
        }
    }
}

/// Four steps of a scene, from far apart to deep in each other.
fn motion_of(scene: &str) -> Result<Motion, String> {
    let (name, triangles) = scene.split_once(':').ok_or("no size")?;
    let triangles = triangles.parse().map_err(|_| "the size is not a number")?;
    let scene = Scene::new(name, Some(triangles), Scene::DEFAULT_SEED)
        .map_err(|error| error.to_string())?;
    let steps = scene.steps();
    Ok(Motion::of_scene(
        &scene,
        [steps / 4, steps / 2, steps, steps - 1],
    ))
}

fn measure_all(scene: &str, motion: &Motion) {
    let triangles: usize = motion.bodies.iter().map(|body| body.triangles.len()).sum();
    let methods: [fn() -> Box<dyn Method>; 4] = [
        || Box::new(Ours::<f32>::new("pliant", pliant::Options::default())),
        || Box::new(Parry::new(exact)),
        || Box::new(Obvhs::new(1, exact)),
        || Box::new(Obvhs::new(4, exact)),
    ];
    for make in methods {
        let mut method = make();
        let name = method.name();
        let name = name.split(':').next().unwrap_or_default();
        let [live, building] =
            measure(&mut *method, motion).map(|bytes| bytes as f64 / triangles as f64);
        println!("{scene:<18} {name:<22} {live:>8.1} {building:>10.1}");
    }
}

/// Live bytes after the steps, and the peak while building.
fn measure(method: &mut dyn Method, motion: &Motion) -> [u64; 2] {
    let meshes = motion.meshes();
    let built = allocation_counter::measure(|| method.build(&meshes));
    let stepped = allocation_counter::measure(|| {
        for frame in &motion.frames {
            let shapes: Vec<_> = frame.iter().map(|placed| placed.shape()).collect();
            method.step(&shapes);
            method.all_pairs();
            method.first_pair();
            method.self_pairs();
        }
    });
    let live = built.bytes_current + stepped.bytes_current;
    [u64::try_from(live).unwrap_or_default(), built.bytes_max]
}
