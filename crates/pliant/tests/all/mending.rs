//! Trees that mend themselves change no answer and do less, and the decay that they report is
//! right.

use crate::common::{Lcg, every_configuration, is_thorough};
use pliant::{BodyId, Edit, Options, Pair, Partition, Selection, World};
use pliant_scenes::{Change, ChangingScene, Event};

/// A world that plays a scene.
struct Player {
    world: World<f32>,
    ids: Vec<BodyId>,
    /// Whether shapes are ends of motions.
    is_moved: bool,
}

impl Player {
    fn new(scene: &ChangingScene, options: Options) -> Self {
        let mut world = World::with_options(options);
        let bodies = 0..scene.body_count();
        let ids = bodies.map(|body| {
            let positions = scene.first_positions(body);
            world.add(scene.triangles(body), &positions).unwrap()
        });
        let ids = ids.collect();
        Self {
            world,
            ids,
            is_moved: false,
        }
    }

    fn step(&mut self, scene: &ChangingScene, step: u32) -> Vec<Pair> {
        let Self {
            world,
            ids,
            is_moved,
        } = self;
        let shape = |body: usize| {
            let mut positions = Vec::new();
            scene.positions(body, step, &mut positions);
            positions
        };
        for event in scene.events(step) {
            match event {
                Event::Edit { body, changes } => {
                    let mut edit = world.edit(ids[*body]).unwrap();
                    let at = shape(*body);
                    changes
                        .iter()
                        .for_each(|change| make(&mut edit, change, &at));
                    world.apply(&edit).unwrap();
                }
                Event::Fuse { kept, gone } => {
                    world.fuse(ids[*kept], ids[*gone]).unwrap();
                }
            }
        }
        for (body, &id) in ids.iter().enumerate() {
            let positions = shape(body);
            if positions.is_empty() {
                continue;
            }
            if *is_moved {
                world.set_motion(id, &positions).unwrap();
            } else {
                world.set_positions(id, &positions).unwrap();
            }
        }
        if *is_moved && step.is_multiple_of(2) {
            world.finish_motion();
        } else if *is_moved {
            world.advance_motion(1.0).unwrap();
        }
        let pairs = world.intersections(Selection::Everything).all();
        pairs.unwrap().to_vec()
    }
}

fn make(edit: &mut Edit<f32>, change: &Change, at: &[[f32; 3]]) {
    match change {
        Change::AddVertices(count) => {
            let first = edit.vertex_count();
            edit.add_vertices(&at[first..first + count]);
        }
        &Change::PlaceVertex(vertex) => edit.place_vertex(vertex, at[vertex as usize]),
        Change::SplitVertex { vertex, triangles } => {
            edit.split_vertex(*vertex, triangles);
        }
        &Change::MergeVertices { kept, gone } => edit.merge_vertices(kept, gone),
        Change::AddTriangles(triangles) => {
            edit.add_triangles(triangles);
        }
        &Change::SetTriangle { triangle, corners } => edit.set_triangle(triangle, corners),
        Change::RemoveTriangles(triangles) => edit.remove_triangles(triangles),
    }
}

fn scene(name: &str, size: usize) -> ChangingScene {
    ChangingScene::new(name, Some(size), ChangingScene::DEFAULT_SEED).unwrap()
}

/// Declares a module of tests, one for each scene, so that all cores have work to the end.
macro_rules! of_each_scene {
    ($check:ident) => {
        of_each_scene! { $check: cut tear fuse shuffle remesh }
    };
    ($check:ident: $($scene:ident)*) => {
        mod $check {
            $(#[test]
            fn $scene() {
                super::$check(stringify!($scene));
            })*

            #[test]
            fn every_scene_has_a_test() {
                assert_eq!(super::ChangingScene::NAMES, [$(stringify!($scene)),*]);
            }
        }
    };
}

of_each_scene!(mended_worlds_answer_like_others);

fn mended_worlds_answer_like_others(name: &str) {
    let all = every_configuration();
    let place = ChangingScene::NAMES.iter().position(|it| *it == name);
    let place = place.unwrap();
    let size = match name {
        "tear" => 2 * 30 * 30,
        "shuffle" => 8 * 1024,
        _ => 1280,
    };
    let scene = scene(name, size);
    let mut options = all[17 * place % all.len()];
    let mut plain = Player::new(&scene, options);
    options.mending = true;
    let mut mended = Player::new(&scene, options);
    let mut default = Options::default();
    default.mending = true;
    let mut default = Player::new(&scene, default);
    let mut exchanged = 0;
    let mut revision = 0;
    for step in 1..=scene.steps().min(220) {
        let expected = plain.step(&scene, step);
        assert_eq!(mended.step(&scene, step), expected, "{name}, {step}");
        assert_eq!(default.step(&scene, step), expected, "{name}, {step}");
        if step % 20 == 0 {
            mended.world.validate().unwrap();
            default.world.validate().unwrap();
        }
        let now = default.world.mesh_revision(default.ids[0]).unwrap();
        exchanged += u32::from(now != revision && scene.events(step).is_empty());
        revision = now;
    }
    assert!(name != "shuffle" || exchanged > 0);
}

/// A body gets other meshes while its tree is being built, with fewer triangles and with more
/// again.
#[test]
fn meshes_may_change_while_a_tree_is_built() {
    let scene = scene("shuffle", 20 * 1024);
    let mut options = Options::default();
    let mut plain = World::<f32>::with_options(options);
    options.mending = true;
    let mut mended = World::<f32>::with_options(options);
    let triangles = scene.triangles(0);
    let first = scene.first_positions(0);
    let id = plain.add(triangles, &first).unwrap();
    mended.add(triangles, &first).unwrap();
    let mut positions = Vec::new();
    for step in 1..=scene.steps() / if is_thorough() { 2 } else { 4 } {
        scene.positions(0, step, &mut positions);
        let count = triangles.len() - 7 * (step % 3) as usize;
        for world in [&mut plain, &mut mended] {
            world.set_positions(id, &positions).unwrap();
            world.set_mesh(id, &triangles[..count], &positions).unwrap();
        }
        let of = Selection::Everything;
        let expected = plain.intersections(of).all().unwrap();
        assert_eq!(mended.intersections(of).all().unwrap(), expected, "{step}");
        mended.validate().unwrap();
    }
}

/// Triangles and vertices come and go at every step, while trees are built and exchanged.
///
/// Edges keep their numbers. The environment variable `LIVES` sets the number of lives, which is
/// one by default; each has another configuration.
fn edits_go_on(partition: Partition, first_seed: u64) {
    let scene = scene("shuffle", 8 * 1024);
    let lives: usize = std::env::var("LIVES").map_or(1, |lives| lives.parse().unwrap());
    let mut exchanged = 0;
    for life in 0..lives {
        let of_kind = every_configuration().into_iter();
        let mut of_kind = of_kind.filter(|it| it.partition == partition).cycle();
        let mut options = of_kind.nth(life).unwrap();
        let mut random = Lcg(first_seed + 3 * life as u64);
        let mut plain = World::<f32>::with_options(options);
        options.mending = true;
        let mut mended = World::<f32>::with_options(options);
        let mut positions = scene.first_positions(0);
        let first_vertices = positions.len();
        let id = plain.add(scene.triangles(0), &positions).unwrap();
        mended.add(scene.triangles(0), &positions).unwrap();
        // New vertices are beside a vertex that was there at first.
        let mut beside: Vec<u32> = Vec::new();
        for step in 1..=60 {
            scene.positions(0, step, &mut positions);
            let at = |vertex: u32, all: &[[f32; 3]]| all[vertex as usize].map(|x| x + 0.003);
            for &vertex in &beside {
                positions.push(at(vertex, &positions));
            }
            let mut edits = [plain.edit(id).unwrap(), mended.edit(id).unwrap()];
            let triangles = plain.triangles(id).unwrap();
            let live = plain.live_triangles(id).unwrap();
            let mut named: Vec<u32> = Vec::new();
            for _ in 0..random.below(6) {
                let triangle = random.below(triangles.len() as u32);
                let [a, b, c] = triangles[triangle as usize];
                let of_it = |vertex: &u32| [a, b, c].contains(vertex);
                if !live[triangle as usize] || named.iter().any(of_it) {
                    continue;
                }
                // The effect of an edit on a triangle is not read back, so no later edit may touch
                // its corners.
                named.extend([a, b, c]);
                match random.below(4) {
                    0 => edits
                        .iter_mut()
                        .for_each(|edit| edit.remove_triangle(triangle)),
                    1 => edits
                        .iter_mut()
                        .for_each(|edit| edit.set_triangle(triangle, [b, a, a])),
                    2 => {
                        for edit in &mut edits {
                            let new = edit.split_vertex(a, &[triangle]);
                            edit.add_triangle([a, b, new]);
                        }
                        beside.push(a.min(first_vertices as u32 - 1));
                    }
                    _ => {
                        let beside_a = a.min(first_vertices as u32 - 1);
                        for edit in &mut edits {
                            let new = edit.add_vertex(at(beside_a, &positions));
                            edit.set_triangle(triangle, [a, b, new]);
                            edit.add_triangles(&[[b, c, new], [c, a, new]]);
                        }
                        beside.push(beside_a);
                    }
                }
            }
            positions.truncate(first_vertices);
            for &vertex in &beside {
                positions.push(at(vertex, &positions));
            }
            for (world, edit) in [&mut plain, &mut mended].into_iter().zip(&edits) {
                world.apply(edit).unwrap();
                world.set_positions(id, &positions).unwrap();
            }
            let of = Selection::Everything;
            let expected = plain.intersections(of).all().unwrap();
            assert_eq!(mended.intersections(of).all().unwrap(), expected, "{step}");
            if step % 4 == 0 {
                assert_eq!(plain.edges(id).unwrap(), mended.edges(id).unwrap());
                let expected = plain.edge_edge_candidates(of, 1e-3).all().unwrap();
                let found = mended.edge_edge_candidates(of, 1e-3).all().unwrap();
                assert_eq!(found, expected, "{partition:?}, {step}");
                let expected = plain.vertex_triangle_candidates(of, 1e-3).all().unwrap();
                let found = mended.vertex_triangle_candidates(of, 1e-3).all().unwrap();
                assert_eq!(found, expected, "{partition:?}, {step}");
                mended.validate().unwrap();
            }
        }
        // An edit counts once in either world; an exchange of trees counts too, and only one mends.
        let [plain, mended] = [plain, mended].map(|it| it.mesh_revision(id).unwrap());
        println!("{options:?}: trees were exchanged {} times", mended - plain);
        exchanged += mended - plain;
        assert!(mended > plain, "{partition:?}");
    }
    assert!(exchanged > 2 * lives as u64);
}

#[test]
fn edits_go_on_while_a_balanced_tree_is_built() {
    edits_go_on(Partition::Balanced, 0);
}

#[test]
fn edits_go_on_while_a_tree_cut_at_the_centre_is_built() {
    edits_go_on(Partition::Centre, 1);
}

#[test]
fn edits_go_on_while_a_tree_cut_at_the_mean_is_built() {
    edits_go_on(Partition::Mean, 2);
}

/// Pairs of nodes that a player's last query looked at.
fn node_pairs(player: &Player) -> u64 {
    player.world.statistics().node_pairs
}

/// A mended tree looks at fewer than twice the pairs of nodes of a fresh one.
///
/// Left alone, it would look at more than five times as many. On smaller scenes trees decay less.
#[test]
fn a_mended_tree_does_little_more_than_a_fresh_one() {
    let scene = scene("shuffle", 20 * 1024);
    let mut options = Options::default();
    let mut plain = Player::new(&scene, options);
    options.mending = true;
    let mut mended = Player::new(&scene, options);
    let mut fresh = Player::new(&scene, options);
    let every = if is_thorough() { 1 } else { 5 };
    let mut sums = [0; 3];
    for step in 1..=scene.steps() {
        mended.step(&scene, step);
        if step % every > 0 {
            // Work of the other worlds at a step does not depend on the steps before.
            continue;
        }
        plain.step(&scene, step);
        fresh.world.rebuild(fresh.ids[0]).unwrap();
        fresh.step(&scene, step);
        let work = [&plain, &mended, &fresh].map(node_pairs);
        for (sum, work) in sums.iter_mut().zip(work) {
            *sum += work;
        }
    }
    println!("pairs of nodes, plain, mended and fresh: {sums:?}");
    assert!(sums[0] > 5 * sums[2] && sums[1] < 2 * sums[2], "{sums:?}");
}

#[test]
fn a_mended_tree_does_the_same_where_shapes_are_ends_of_motions() {
    let scene = scene("shuffle", if is_thorough() { 20 } else { 8 } * 1024);
    let mut options = Options::default();
    options.mending = true;
    let mut mended = Player::new(&scene, options);
    let mut moved = Player::new(&scene, options);
    moved.is_moved = true;
    for step in 1..=scene.steps() {
        mended.step(&scene, step);
        moved.step(&scene, step);
        assert_eq!(node_pairs(&moved), node_pairs(&mended), "step {step}");
    }
}

of_each_scene!(decay_is_said_within_a_quarter_of_what_is_measured);

/// Reported decay against measured decay, on scenes at their own size.
///
/// On smaller ones candidates are most of the work.
fn decay_is_said_within_a_quarter_of_what_is_measured(name: &str) {
    let every = if is_thorough() { 20 } else { 60 };
    let scene = ChangingScene::new(name, None, ChangingScene::DEFAULT_SEED).unwrap();
    let mut plain = Player::new(&scene, Options::default());
    let mut fresh = Player::new(&scene, Options::default());
    for step in 1..=scene.steps() {
        let is_looked_at = step % every == 1;
        if !is_looked_at && scene.events(step).is_empty() {
            continue;
        }
        let pairs = plain.step(&scene, step);
        fresh.step(&scene, step);
        if !is_looked_at {
            continue;
        }
        for &id in &fresh.ids {
            // A body that another one took in does not exist any more.
            let _ = fresh.world.rebuild(id);
        }
        let found = fresh.world.intersections(Selection::Everything).all();
        assert_eq!(found.unwrap(), pairs);
        let measured = node_pairs(&plain) as f64 / node_pairs(&fresh) as f64;
        let ids = plain.ids.iter();
        let said = ids.filter_map(|&id| plain.world.tree_quality(id).ok());
        for said in said {
            println!("{name}, {step}: {measured:.2} times, said to be {said:.2}");
            assert!((said / measured - 1.0).abs() < 0.25);
        }
    }
}

/// Trees along the mesh are not mended, as they would come out the same.
#[test]
fn trees_along_the_mesh_are_left_alone() {
    let scene = scene("shuffle", 8 * 1024);
    let mut options = Options::default();
    options.partition = Partition::Connectivity;
    options.mending = true;
    let mut player = Player::new(&scene, options);
    for step in (1..=scene.steps()).step_by(10) {
        player.step(&scene, step);
    }
    assert_eq!(player.world.mesh_revision(player.ids[0]), Ok(0));
}
