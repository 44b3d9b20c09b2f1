//! The oracle of motion, on motions whose answer can be seen.

use pliant_oracle::{Elements, Moving, first_contact, meet_until};

const FACE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

/// A vertex that moves, and a triangle that does not.
fn onto_face(from: [f64; 3], to: [f64; 3]) -> Moving {
    let [a, b, c] = FACE;
    [[from, a, b, c], [to, a, b, c]]
}

#[test]
fn a_vertex_onto_a_triangle_at_rest() {
    let vt = Elements::VertexTriangle;
    for (from, to, at) in [
        ([1.0, 1.0, 1.0], [1.0, 1.0, -1.0], Some(0.5)),
        ([1.0, 1.0, 1.0], [1.0, 1.0, 0.0], Some(1.0)),
        ([1.0, 1.0, 0.0], [1.0, 1.0, 3.0], Some(0.0)),
        ([1.0, 1.0, 1.0], [1.0, 1.0, 5e-324], None),
        ([0.0, 0.0, 1.0], [0.0, 0.0, -3.0], Some(0.25)),
        ([-5e-324, 0.0, 1.0], [-5e-324, 0.0, -3.0], None),
        ([-4.0, 1.0, 0.0], [4.0, 1.0, 0.0], Some(0.5)),
        ([-4.0, 4.0, 0.0], [4.0, 4.0, 0.0], Some(0.5)),
        ([-4.0, 5.0, 0.0], [4.0, 5.0, 0.0], None),
        ([-0.0, 1.0, 0.0], [-0.0, 1.0, 0.0], Some(0.0)),
    ] {
        let motion = onto_face(from, to);
        let first = first_contact(vt, &motion);
        assert_eq!(first.is_some(), at.is_some(), "{motion:?}");
        assert_eq!(meet_until(vt, &motion, 1.0), at.is_some(), "{motion:?}");
        if let (Some(first), Some(at)) = (first, at) {
            assert!(first.compare(at).is_eq(), "{motion:?}");
            assert!(meet_until(vt, &motion, at));
            assert!(at == 0.0 || !meet_until(vt, &motion, at.next_down()));
        }
    }
}

#[test]
fn classes_make_both_answers() {
    use pliant_oracle::{MotionClass, Random, motion_fits_f32};
    for class in MotionClass::ALL {
        let mut random = Random::new(1);
        let begin = std::time::Instant::now();
        let mut counts = [[0; 2]; 2];
        let (mut singles, mut ends) = (0, [0; 2]);
        for _ in 0..2000 {
            let (elements, motion) = class.motion(&mut random);
            let coordinates = motion.as_flattened().as_flattened();
            assert!(coordinates.iter().all(|x| x.abs() <= f64::from(f32::MAX)));
            let first = first_contact(elements, &motion);
            counts[usize::from(elements == Elements::EdgeEdge)][usize::from(first.is_some())] += 1;
            singles += u32::from(motion_fits_f32(&motion));
            if let Some(first) = first {
                ends[0] += u32::from(first.compare(0.0).is_eq());
                ends[1] += u32::from(first.compare(1.0).is_eq());
            }
        }
        println!(
            "{class:?} {counts:?} f32 {singles} at ends {ends:?} {:?}",
            begin.elapsed()
        );
    }
}
