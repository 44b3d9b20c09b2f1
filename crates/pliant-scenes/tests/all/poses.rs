//! Promises of the interface about poses and local positions.

use pliant_scenes::{Pose, Scene};

/// The unit roundoff of f32: 2⁻²⁴.
const UNIT: f64 = 1.0 / 16_777_216.0;

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Pose, local and world positions of each body at some steps.
fn placed(scene: &Scene) -> impl Iterator<Item = (Pose, Vec<[f32; 3]>, Vec<[f32; 3]>)> {
    let steps = [1, 2, 99, scene.steps()];
    (0..scene.body_count()).flat_map(move |body| {
        steps.map(|step| {
            let (mut local, mut world) = (Vec::new(), Vec::new());
            scene.local_positions(body, step, &mut local);
            scene.positions(body, step, &mut world);
            (scene.pose(body, step).unwrap(), local, world)
        })
    })
}

#[test]
fn placing_local_positions_gives_the_world_but_for_two_roundings() {
    let mut worst: f64 = 0.0;
    for name in ["spheres", "crowd", "arms", "gather"] {
        let scene = Scene::new(name, Some(320), Scene::DEFAULT_SEED).unwrap();
        for (pose, local, world) in placed(&scene) {
            for (l, w) in local.iter().zip(&world) {
                let l = l.map(f64::from);
                for axis in 0..3 {
                    let w = f64::from(w[axis]);
                    let error = dot(pose.rotation[axis], l) + pose.translation[axis] - w;
                    let bound = UNIT * (dot(l, l).sqrt() + w.abs());
                    worst = worst.max(error.abs() / bound);
                }
            }
        }
    }
    // Near the bound, so that the bound is no idle promise.
    assert!((0.3..1.000_001).contains(&worst), "{worst}");
}

#[test]
fn rotations_are_rotations() {
    for name in ["spheres", "crowd", "arms", "gather"] {
        let scene = Scene::new(name, Some(80), 3).unwrap();
        for (Pose { rotation: r, .. }, _, _) in placed(&scene) {
            for i in 0..3 {
                for j in 0..3 {
                    let product = dot(r[i], r[j]) - f64::from(u8::from(i == j));
                    assert!(product.abs() < 1e-14, "{name}: {product:e}");
                }
            }
        }
    }
}

#[test]
fn what_deforms_in_the_world_has_no_pose() {
    let cloth = Scene::new("cloth", Some(800), 3).unwrap();
    assert_eq!(cloth.pose(0, 20), None);
    let (mut local, mut world) = (Vec::new(), Vec::new());
    cloth.local_positions(0, 20, &mut local);
    cloth.positions(0, 20, &mut world);
    assert_eq!(local, world);
}

#[test]
fn local_shapes_deform_but_do_not_travel() {
    let scene = Scene::new("spheres", Some(320), Scene::DEFAULT_SEED).unwrap();
    let mut before = Vec::new();
    for step in 1..=200 {
        let mut now = Vec::new();
        scene.local_positions(1, step, &mut now);
        assert_ne!(now, before);
        assert!(now.iter().all(|&p| {
            let square = dot(p.map(f64::from), p.map(f64::from));
            (0.4..2.2).contains(&square)
        }));
        before = now;
    }
}
