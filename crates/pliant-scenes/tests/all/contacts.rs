//! Figures for which the scenes are calibrated: first contact, and number of contacts.

use crate::count::{pairs, pairs_within_bodies};
use pliant_scenes::Scene;

fn scene(name: &str, triangles: Option<usize>) -> Scene {
    Scene::new(name, triangles, Scene::DEFAULT_SEED).unwrap()
}

fn counts<const N: usize>(scene: &Scene, steps: [u32; N]) -> [usize; N] {
    steps.map(|step| pairs(scene, step))
}

#[test]
fn spheres_meet_as_in_the_paper() {
    let spheres = scene("spheres", None);
    let found = counts(&spheres, [1, 50, 59, 60, 100, 150, 200]);
    assert_eq!(found, [0, 0, 0, 30, 492, 894, 3_742]);
}

#[test]
fn spheres_of_every_size_meet_at_the_same_step() {
    // The coarsest meshes cut the bumps off a little.
    for size in [1_280, 5_120, 8_192, 16_384, 32_768, 65_536] {
        let spheres = scene("spheres", Some(size));
        let [before, at] = counts(&spheres, [59, 61]);
        assert!(before == 0 && at > 0, "{size}: {before} pairs, then {at}");
    }
}

#[test]
fn the_crowd_always_touches() {
    let crowd = scene("crowd", None);
    for step in (1..=200).step_by(49) {
        let found = pairs(&crowd, step);
        assert!((2_000..=2_650).contains(&found), "step {step}: {found}");
    }
}

#[test]
fn arms_always_touch() {
    let arms = scene("arms", None);
    for step in (1..=200).step_by(49) {
        let found = pairs(&arms, step);
        assert!((900..=2_000).contains(&found), "step {step}: {found}");
    }
}

#[test]
fn arms_do_not_run_through_their_own_body() {
    let arms = scene("arms", None);
    for step in [1, 70, 140, 200] {
        assert_eq!(pairs_within_bodies(&arms, step), 0, "step {step}");
    }
}

#[test]
fn bodies_gather_from_far() {
    let gather = scene("gather", None);
    let found = counts(&gather, [1, 100, 134, 135, 150, 175, 200]);
    assert_eq!(found, [0, 0, 0, 5, 100, 5_096, 19_110]);
}

#[test]
fn many_bodies_gather_as_densely_as_few() {
    let pairs_per_body = |bodies: usize| {
        let gather = Scene::gather(bodies, 80, Scene::DEFAULT_SEED).unwrap();
        assert_eq!(pairs(&gather, 1), 0, "{bodies} bodies touch at the start");
        pairs(&gather, 200) as f64 / bodies as f64
    };
    let (few, many) = (pairs_per_body(100), pairs_per_body(1_000));
    // Bodies at the rim have fewer neighbours; in the limit of large numbers there is no rim.
    assert!(
        many > few && many < 2.0 * few,
        "{few} and {many} pairs a body"
    );
}

#[test]
fn the_cloth_folds_onto_itself() {
    let cloth = scene("cloth", None);
    let found = counts(&cloth, [1, 10, 25, 26, 30, 35, 40, 45, 50]);
    assert_eq!(found, [0, 0, 0, 22, 246, 1_873, 4_486, 7_974, 10_393]);
}
