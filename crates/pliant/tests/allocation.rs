//! Replaying the same steps on one thread allocates nothing in the library.

mod common;

use common::kinds::{Wanted, every_kind};
use pliant::{BroadPhase, Degree, HitRows, Labels, Options, Partition, Selection, World};
use pliant_scenes::Scene;

fn replay(scene: &Scene, options: Options, steps: &[u32]) {
    // All shapes are made in advance, so that only the library's allocations are counted.
    let shapes: Vec<Vec<Vec<[f32; 3]>>> = steps
        .iter()
        .map(|&step| {
            let shape = |body| {
                let mut positions = Vec::new();
                scene.positions(body, step, &mut positions);
                positions
            };
            (0..scene.body_count()).map(shape).collect()
        })
        .collect();
    let mut world = World::<f32>::with_options(options);
    let ids: Vec<_> = (0..scene.body_count())
        .map(|body| world.add(scene.triangles(body), &shapes[0][body]).unwrap())
        .collect();
    // The first is a thick body with a rest shape, and of several some are elsewhere.
    world
        .set_rest_positions(ids[0], Some(&shapes[0][0]))
        .unwrap();
    world.set_thickness(ids[0], 0.001).unwrap();
    let of_triangles = &vec![0; scene.triangles(0).len()];
    let neighbours = None;
    let labels = Labels {
        of_triangles,
        neighbours,
    };
    world.set_labels(ids[ids.len() - 1], Some(labels)).unwrap();
    for &id in ids.iter().skip(2 + ids.len() / 2) {
        world.set_environment(id, 1).unwrap();
    }
    let (mut unsorted, mut rows) = (Vec::new(), HitRows::new());
    let kinds = every_kind::<f32>();
    let questions = [
        (Selection::World, Wanted::First),
        (Selection::Within(ids[0]), Wanted::Visit),
        (Selection::Everything, Wanted::All),
    ];
    let mut pairs = 0;
    let mut play = || {
        for shapes in &shapes {
            for (&id, positions) in ids.iter().zip(shapes) {
                world.set_positions(id, positions).unwrap();
            }
            world
                .write_positions(ids[0], |buffer| buffer.copy_from_slice(&shapes[0]))
                .unwrap();
            world.intersections(Selection::World).prepare().unwrap();
            pairs += world.intersections(Selection::World).all().unwrap().len();
            world.set_motion(ids[0], &shapes[0]).unwrap();
            for kind in &kinds {
                for &(of, wanted) in &questions {
                    let shown = kind.show(&mut world, (of, 0.01), wanted, &mut |_| pairs += 1);
                    shown.unwrap();
                }
            }
            let nearest = world.nearest_body(ids[0], 1.0).unwrap();
            pairs += usize::from(nearest.is_some());
            if let [a, .., b] = ids[..] {
                let nearest = world.distance(a, b, f64::INFINITY).unwrap();
                pairs += usize::from(nearest.is_some());
            }
            let first = world.first_impact(Selection::Everything, 1e-6).unwrap();
            pairs += usize::from(first.is_some());
            for gap in [0.0, 0.001] {
                let step = world.collision_free_step(Selection::World, gap);
                world.set_motion(ids[0], &shapes[0]).unwrap();
                assert!((0.0..=1.0).contains(&step.unwrap()));
            }
            world.advance_motion(0.5).unwrap();
            let everything = world.edge_edge_candidates(Selection::Everything, 0.01);
            pairs += everything.all().unwrap().len();
            let everything = world.close_edge_edge_pairs(Selection::Everything, 0.01);
            everything.unsorted(&mut unsorted).unwrap();
            rows.update(&world, &unsorted).unwrap();
            pairs += rows.places().len();
            if let [a, b, ..] = ids[..] {
                let between = world.intersections(Selection::Between(a, b));
                pairs += between.all().unwrap().len();
            }
        }
    };
    let first = allocation_counter::measure(&mut play);
    let second = allocation_counter::measure(&mut play);
    assert!(first.count_total > 0, "the counter counts");
    assert_eq!(second.count_total, 0, "{} with {options:?}", scene.name());
    assert!(pairs > 0, "the steps are not idle");
}

#[test]
fn a_second_time_allocates_nothing() {
    let seed = Scene::DEFAULT_SEED;
    for degree in [Degree::Two, Degree::Eight] {
        for (partition, broad_phase) in [
            (Partition::Balanced, BroadPhase::Auto),
            (Partition::Centre, BroadPhase::SweepAndPrune),
            (Partition::Mean, BroadPhase::Tree),
        ] {
            let mut options = Options::default();
            (options.degree, options.partition, options.broad_phase) =
                (degree, partition, broad_phase);
            replay(
                &Scene::new("spheres", Some(1280), seed).unwrap(),
                options,
                &[20, 80, 140, 200],
            );
            replay(
                &Scene::new("crowd", Some(320), seed).unwrap(),
                options,
                &[1, 2, 3, 4, 5, 100],
            );
            replay(
                &Scene::new("cloth", Some(2888), seed).unwrap(),
                options,
                &[10, 40, 50],
            );
        }
    }
    replay(
        &Scene::gather(150, 80, seed).unwrap(),
        Options::default(),
        &[1, 50, 100, 150, 200],
    );
}
