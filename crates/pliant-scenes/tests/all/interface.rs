//! Promises of the interface, checked for every scene.

use pliant_scenes::{Scene, SceneError};

fn small_scenes() -> impl Iterator<Item = Scene> {
    Scene::NAMES.into_iter().map(|name| {
        let size = if name == "cloth" { 800 } else { 320 };
        Scene::new(name, Some(size), 7).unwrap()
    })
}

fn positions(scene: &Scene, body: usize, step: u32) -> Vec<[f32; 3]> {
    let mut positions = Vec::new();
    scene.positions(body, step, &mut positions);
    positions
}

#[test]
fn scenes_are_shared_between_threads() {
    fn assert_shared<T: Send + Sync + 'static>() {}
    assert_shared::<Scene>();
    assert_shared::<SceneError>();
}

#[test]
fn defaults_are_those_of_the_front_page() {
    let shape = |name| {
        let scene = Scene::new(name, None, Scene::DEFAULT_SEED).unwrap();
        assert_eq!(scene.name(), name);
        (
            scene.body_count(),
            scene.triangles(0).len(),
            scene.vertex_count(0),
            scene.steps(),
        )
    };
    let expected = [
        (2, 20_480, 10_242, 200),
        (27, 5_120, 2_562, 200),
        (27, 5_120, 2_562, 200),
        (64, 1_280, 642, 200),
        (1, 79_202, 40_000, 50),
    ];
    assert_eq!(Scene::NAMES.map(shape), expected);
}

#[test]
fn every_vertex_moves_every_step_but_not_far() {
    for scene in small_scenes() {
        for body in 0..scene.body_count() {
            let mut before = positions(&scene, body, 1);
            for step in 2..=scene.steps() {
                let now = positions(&scene, body, step);
                for (p, q) in before.iter().zip(&now) {
                    let far = (0..3)
                        .map(|axis| (p[axis] - q[axis]).abs())
                        .fold(0.0, f32::max);
                    assert!(
                        far > 0.0 && far < 0.2,
                        "{} {step}: {p:?} to {q:?}",
                        scene.name()
                    );
                }
                before = now;
            }
        }
    }
}

#[test]
fn steps_outside_the_motion_are_its_ends() {
    for scene in small_scenes() {
        let last = scene.steps();
        assert_eq!(positions(&scene, 0, 0), positions(&scene, 0, 1));
        assert_eq!(positions(&scene, 0, u32::MAX), positions(&scene, 0, last));
        assert_ne!(positions(&scene, 0, last - 1), positions(&scene, 0, last));
    }
}

#[test]
fn a_buffer_is_used_again() {
    for scene in small_scenes() {
        let mut buffer = vec![[f32::NAN; 3]; 5_000];
        let place = (buffer.as_ptr(), buffer.capacity());
        scene.positions(0, 3, &mut buffer);
        assert_eq!(place, (buffer.as_ptr(), buffer.capacity()));
        assert_eq!(buffer, positions(&scene, 0, 3));
        buffer.fill([f32::NAN; 3]);
        scene.write_positions(0, 3, &mut buffer);
        assert_eq!(buffer, positions(&scene, 0, 3));
    }
}

#[test]
fn the_smallest_bodies_are_possible() {
    for name in Scene::NAMES {
        let smallest = if name == "cloth" { 2 } else { 4 };
        let scene = Scene::new(name, Some(smallest), 0).unwrap();
        assert!(
            positions(&scene, 0, 20)
                .as_flattened()
                .iter()
                .all(|x| x.is_finite())
        );
    }
}

#[test]
fn a_motion_is_the_same_for_every_size() {
    // Subdivision keeps the vertices of a solid, so the coarse body is a part of the fine one.
    for name in ["spheres", "crowd", "arms", "gather"] {
        let [coarse, fine] = [320, 5_120].map(|size| Scene::new(name, Some(size), 3).unwrap());
        for step in [1, 77, 200] {
            let (coarse, fine) = (positions(&coarse, 1, step), positions(&fine, 1, step));
            assert_eq!(coarse, fine[..coarse.len()], "{name} {step}");
        }
    }
}

#[test]
fn a_body_is_the_same_in_any_company() {
    let [few, many] = [10, 500].map(|bodies| Scene::gather(bodies, 80, 3).unwrap());
    assert_eq!((few.body_count(), many.body_count()), (10, 500));
    for step in [1, 50, 200] {
        assert_eq!(positions(&few, 9, step), positions(&many, 9, step));
    }
}

#[test]
fn impossible_scenes_say_what_is_possible() {
    let error = |name, triangles| {
        Scene::new(name, Some(triangles), 0)
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        error("cloth", 80_001),
        "a body of scene `cloth` cannot have 80001 triangles; \
         the nearest possible numbers are 80000 and 80802"
    );
    assert_eq!(
        error("arms", 3),
        "a body of scene `arms` cannot have 3 triangles; the smallest possible number is 4"
    );
    assert_eq!(
        error("crowd", usize::MAX),
        "a body of scene `crowd` cannot have 18446744073709551615 triangles; \
         the largest possible number is 20971520"
    );
    assert_eq!(
        error("sphere", 80),
        "no scene of this kind is called `sphere`; scenes whose meshes stay are spheres, crowd, \
         arms, gather, cloth; scenes whose meshes change are cut, tear, fuse, shuffle, remesh"
    );
    for asked in [0, Scene::MAX_BODIES + 1, usize::MAX] {
        let error = Scene::gather(asked, 80, 0).unwrap_err();
        assert_eq!(error, SceneError::ImpossibleBodyCount { asked });
    }
    assert!(Scene::gather(Scene::MAX_BODIES, 80, 0).is_ok());
}

#[test]
#[should_panic(expected = "there is no body 2 among 2")]
fn a_body_that_is_not_there() {
    Scene::new("spheres", Some(80), 0)
        .unwrap()
        .positions(2, 1, &mut Vec::new());
}

#[test]
#[should_panic(expected = "body 1 has 42 vertices")]
fn a_buffer_of_the_wrong_length() {
    Scene::new("spheres", Some(80), 0)
        .unwrap()
        .write_positions(1, 1, &mut [[0.0; 3]; 41]);
}
