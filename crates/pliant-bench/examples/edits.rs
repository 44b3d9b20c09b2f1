//! Cost of edits: a cut of some hundred triangles in a large body, beside building anew and obvhs.
//!
//! ```sh
//! cargo run --release -p pliant-bench --features peers --example edits
//! ```
//!
//! An edit costs the call of `apply`, and the extra time of the next query over the same query
//! before. A triangle that is cut becomes three: it gets other corners, and two are added. The step
//! after ten thousand edits is measured too.

use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;
use pliant::{BodyId, Edit, Selection, World};
use pliant_scenes::Scene;
use std::time::{Duration, Instant};

/// Triangles of the large bodies.
const LARGE: usize = 1_310_720;
/// Number of triangles cut at once: with two new ones for each, about a hundred.
const CUT: usize = 34;
/// Number of repetitions.
const ROUNDS: usize = 41;

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn query(world: &mut World<f32>, of: Selection) -> f64 {
    let start = Instant::now();
    world.intersections(of).all().expect("the bodies are there");
    milliseconds(start)
}

/// The two spheres of the scene, half in each other.
fn spheres(triangles: usize) -> (World<f32>, Vec<BodyId>, Vec<Vec<[f32; 3]>>) {
    let scene = Scene::new("spheres", Some(triangles), Scene::DEFAULT_SEED);
    let scene = scene.expect("a size of the scene's");
    let mut world = World::new();
    let (mut ids, mut shapes) = (Vec::new(), Vec::new());
    for body in 0..2 {
        let mut shape = Vec::new();
        scene.positions(body, 150, &mut shape);
        let added = world.add(scene.triangles(body), &shape);
        ids.push(added.expect("a scene's bodies are good"));
        shapes.push(shape);
    }
    (world, ids, shapes)
}

/// Cuts a triangle into three, with a new vertex in its middle.
fn cut(edit: &mut Edit<f32>, triangle: u32, corners: [u32; 3], shape: &mut Vec<[f32; 3]>) {
    let at = corners.map(|vertex| shape[vertex as usize]);
    let middle = std::array::from_fn(|axis| (at[0][axis] + at[1][axis] + at[2][axis]) / 3.0);
    let new = edit.add_vertex(middle);
    shape.push(middle);
    let [a, b, c] = corners;
    edit.set_triangle(triangle, [a, b, new]);
    edit.add_triangles(&[[b, c, new], [c, a, new]]);
}

fn aabb(shape: &[[f32; 3]], corners: [u32; 3]) -> Aabb {
    let at = corners.map(|vertex| shape[vertex as usize]);
    let of = |pick: fn(f32, f32) -> f32| -> [f32; 3] {
        std::array::from_fn(|axis| pick(pick(at[0][axis], at[1][axis]), at[2][axis]))
    };
    Aabb::new(of(f32::min).into(), of(f32::max).into())
}

fn cuts_in_a_large_body() {
    for (of, name) in [
        (Selection::World, "two spheres"),
        (Selection::Within(BodyId(0)), "a sphere with itself"),
    ] {
        let (mut world, ids, mut shapes) = spheres(LARGE);
        let triangles = world.triangles(ids[0]).expect("it is there").to_vec();
        query(&mut world, of);
        let (mut edits, mut queries, mut firsts) = (Vec::new(), Vec::new(), Vec::new());
        for round in 0..=ROUNDS {
            let before = median((0..5).map(|_| query(&mut world, of)).collect());
            let first = round * (LARGE / (ROUNDS + 1));
            let mut edit = world.edit(ids[0]).expect("it is there");
            for triangle in first..first + CUT {
                cut(
                    &mut edit,
                    triangle as u32,
                    triangles[triangle],
                    &mut shapes[0],
                );
            }
            let start = Instant::now();
            world.apply(&edit).expect("a good edit");
            let edited = milliseconds(start);
            let more = query(&mut world, of) - before;
            if round == 0 {
                firsts = vec![edited, more];
            } else {
                edits.push(edited);
                queries.push(more.max(0.0));
            }
        }
        let both = edits.iter().zip(&queries).map(|(a, b)| a + b).collect();
        let (both, edits, queries) = (median(both), median(edits), median(queries));
        println!(
            "{name}: a cut {edits:.3} ms, the next query {queries:.3} ms more, both {both:.3} ms"
        );
        println!(
            "  the first edit of a body {:.1} ms, its query {:.1} ms more",
            firsts[0], firsts[1]
        );
        let start = Instant::now();
        world.rebuild(ids[0]).expect("it is there");
        let built = milliseconds(start);
        let asked = query(&mut world, of) - median((0..5).map(|_| query(&mut world, of)).collect());
        println!(
            "  building anew {built:.1} ms, its query {asked:.1} ms more: {:.0} times",
            (built + asked) / both
        );
    }
}

fn cuts_in_obvhs() {
    let (world, ids, mut shapes) = spheres(LARGE);
    let mut triangles = world.triangles(ids[0]).expect("it is there").to_vec();
    let shape = &mut shapes[0];
    let boxes: Vec<Aabb> = triangles
        .iter()
        .map(|&corners| aabb(shape, corners))
        .collect();
    let recipe = BvhBuildParams {
        max_prims_per_leaf: 1,
        pre_split: false,
        ..BvhBuildParams::medium_build()
    };
    let mut tree = build_bvh2(&boxes, recipe, &mut Duration::default());
    tree.init_parents_if_uninit();
    tree.init_primitives_to_nodes_if_uninit();
    let mut times = Vec::new();
    for round in 0..ROUNDS {
        let first = round * (LARGE / (ROUNDS + 1));
        let start = Instant::now();
        for triangle in first..first + CUT {
            let [a, b, c] = triangles[triangle];
            let at = [a, b, c].map(|vertex| shape[vertex as usize]);
            let new = shape.len() as u32;
            shape.push(std::array::from_fn(|axis| {
                (at[0][axis] + at[1][axis] + at[2][axis]) / 3.0
            }));
            triangles[triangle] = [a, b, new];
            let node = tree.primitives_to_nodes[triangle] as usize;
            tree.resize_node(node, aabb(shape, [a, b, new]));
            for corners in [[b, c, new], [c, a, new]] {
                tree.insert_primitive(aabb(shape, corners), triangles.len() as u32);
                triangles.push(corners);
            }
        }
        times.push(milliseconds(start));
    }
    println!(
        "obvhs: the same cut, insertion alone {:.3} ms",
        median(times)
    );
}

fn after_ten_thousand() {
    let (mut world, ids, mut shapes) = spheres(81_920);
    let of = Selection::Everything;
    query(&mut world, of);
    let mut random = 1_u64;
    let start = Instant::now();
    for _ in 0..10_000 {
        let all = world.triangles(ids[0]).expect("it is there");
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        let triangle = (random >> 33) as usize % all.len();
        let corners = all[triangle];
        let mut edit = world.edit(ids[0]).expect("it is there");
        cut(&mut edit, triangle as u32, corners, &mut shapes[0]);
        world.apply(&edit).expect("a good edit");
    }
    let edited = milliseconds(start);
    let step = |world: &mut World<f32>| {
        let times = (0..ROUNDS).map(|_| {
            let start = Instant::now();
            for (&id, shape) in ids.iter().zip(&shapes) {
                world.set_positions(id, shape).expect("a good shape");
            }
            query(world, of);
            milliseconds(start)
        });
        median(times.collect())
    };
    let after = step(&mut world);
    let nodes = world.statistics().node_pairs;
    world.rebuild(ids[0]).expect("it is there");
    query(&mut world, of);
    let fresh = step(&mut world);
    let fresh_nodes = world.statistics().node_pairs;
    println!(
        "10,000 edits {:.3} ms each, trees built anew on the way included",
        edited / 1e4
    );
    println!(
        "the step after them {after:.3} ms, with a fresh tree {fresh:.3} ms: {:.2} times; \
         pairs of nodes {:.2} times",
        after / fresh,
        nodes as f64 / fresh_nodes as f64
    );
}

fn main() {
    cuts_in_a_large_body();
    cuts_in_obvhs();
    after_ten_thousand();
}
