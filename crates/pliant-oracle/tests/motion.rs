//! The oracle of motion on motions whose answer is obvious, and on changes that keep the answer.

use pliant_oracle::{
    Elements, MotionClass, Moving, Random, compare_first, first_contact, intersect, meet_until,
    motion_fits_f32,
};
use std::cmp::Ordering;

const VT: Elements = Elements::VertexTriangle;
const EE: Elements = Elements::EdgeEdge;

const FACE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

/// A moving vertex and a triangle at rest.
fn onto_face(from: [f64; 3], to: [f64; 3]) -> Moving {
    let [a, b, c] = FACE;
    [[from, a, b, c], [to, a, b, c]]
}

/// A moving edge, and the edge from the origin to (4, 0, 0) at rest.
fn onto_edge(from: [[f64; 3]; 2], to: [[f64; 3]; 2]) -> Moving {
    let [a, b, _] = FACE;
    [[from[0], from[1], a, b], [to[0], to[1], a, b]]
}

fn every(motion: &Moving, mut of: impl FnMut(f64) -> f64) -> Moving {
    motion.map(|corners| corners.map(|p| p.map(&mut of)))
}

/// Motion with its corners in another order.
fn in_order(motion: &Moving, order: [usize; 4]) -> Moving {
    motion.map(|corners| order.map(|i| corners[i]))
}

/// Orders of corners that keep the elements.
fn orders(elements: Elements) -> Vec<[usize; 4]> {
    match elements {
        VT => vec![
            [0, 2, 3, 1],
            [0, 3, 1, 2],
            [0, 1, 3, 2],
            [0, 3, 2, 1],
            [0, 2, 1, 3],
        ],
        EE => vec![[1, 0, 2, 3], [0, 1, 3, 2], [2, 3, 0, 1], [3, 2, 1, 0]],
    }
}

/// Asserts the time of the first contact, or its absence, for any order of corners and any size.
fn assert_first(elements: Elements, motion: &Moving, at: Option<f64>) {
    let mut same = vec![*motion];
    same.extend(
        orders(elements)
            .iter()
            .map(|&order| in_order(motion, order)),
    );
    for k in [-900, -60, 60] {
        let scaled = every(motion, |x| x * 2f64.powi(k));
        // Some sizes lose the smallest numbers.
        if every(&scaled, |x| x * 2f64.powi(-k)) == *motion {
            same.push(scaled);
        }
    }
    for motion in same {
        let first = first_contact(elements, &motion);
        assert_eq!(first.is_some(), at.is_some(), "{motion:?}");
        assert_eq!(
            meet_until(elements, &motion, 1.0),
            at.is_some(),
            "{motion:?}"
        );
        let backward = [motion[1], motion[0]];
        assert_eq!(
            meet_until(elements, &backward, 1.0),
            at.is_some(),
            "{motion:?}"
        );
        if let (Some(first), Some(at)) = (first, at) {
            assert_eq!(first.compare(at), Ordering::Equal, "{motion:?} {first:?}");
            assert!(meet_until(elements, &motion, at));
            assert!(at == 0.0 || !meet_until(elements, &motion, at.next_down()));
        }
    }
}

#[test]
fn a_vertex_onto_a_triangle_at_rest() {
    for (from, to, at) in [
        // Through the inside, or up to it, or from it.
        ([1.0, 1.0, 1.0], [1.0, 1.0, -1.0], Some(0.5)),
        ([1.0, 1.0, 1.0], [1.0, 1.0, 0.0], Some(1.0)),
        ([1.0, 1.0, 0.0], [1.0, 1.0, 3.0], Some(0.0)),
        ([1.0, 1.0, 1.0], [1.0, 1.0, 1e-300], None),
        ([5.0, 5.0, 2.0], [-3.0, -3.0, -2.0], Some(0.5)),
        // At a corner, along an edge, and beside them.
        ([0.0, 0.0, 1.0], [0.0, 0.0, -3.0], Some(0.25)),
        ([-1e-300, 0.0, 1.0], [-1e-300, 0.0, -3.0], None),
        ([2.0, 2.0, 1.0], [2.0, 2.0, -3.0], Some(0.25)),
        ([2.0, 2.0f64.next_up(), 1.0], [2.0, 2.0, -3.0], None),
        // In the plane: over a side, onto a corner, past a corner, inside all the time.
        ([-4.0, 1.0, 0.0], [4.0, 1.0, 0.0], Some(0.5)),
        ([-4.0, 4.0, 0.0], [4.0, 4.0, 0.0], Some(0.5)),
        (
            [-4.0, 4.0f64.next_up(), 0.0],
            [4.0, 4.0f64.next_up(), 0.0],
            None,
        ),
        ([-4.0, 5.0, 0.0], [4.0, 5.0, 0.0], None),
        ([-0.0, 1.0, 0.0], [-0.0, 1.0, 0.0], Some(0.0)),
        ([1.0, 1.0, 0.0], [2.0, 1.0, 0.0], Some(0.0)),
        // Along a side and in its line.
        ([-4.0, 0.0, 0.0], [4.0, 0.0, 0.0], Some(0.5)),
        ([-4.0, 0.0, 0.0], [0.0, 0.0, 0.0], Some(1.0)),
        ([-4.0, 0.0, 0.0], [-1e-300, 0.0, 0.0], None),
    ] {
        assert_first(VT, &onto_face(from, to), at);
    }
}

#[test]
fn an_edge_onto_an_edge_at_rest() {
    for (from, to, at) in [
        // Across, at an end of one, at an end of both, and past the ends.
        (
            [[1.0, -1.0, 1.0], [1.0, 1.0, 1.0]],
            [[1.0, -1.0, -1.0], [1.0, 1.0, -1.0]],
            Some(0.5),
        ),
        (
            [[1.0, 0.0, 1.0], [1.0, 1.0, 1.0]],
            [[1.0, 0.0, -3.0], [1.0, 1.0, -3.0]],
            Some(0.25),
        ),
        (
            [[0.0, 0.0, 1.0], [-1.0, -1.0, 1.0]],
            [[0.0, 0.0, 0.0], [-1.0, -1.0, 0.0]],
            Some(1.0),
        ),
        (
            [[1.0, 1e-300, 1.0], [1.0, 1.0, 1.0]],
            [[1.0, 1e-300, -3.0], [1.0, 1.0, -3.0]],
            None,
        ),
        (
            [[5.0, -1.0, 1.0], [5.0, 1.0, 1.0]],
            [[5.0, -1.0, -1.0], [5.0, 1.0, -1.0]],
            None,
        ),
        // Parallel: side by side, and ahead in the same line.
        (
            [[1.0, 1.0, 0.0], [9.0, 1.0, 0.0]],
            [[1.0, -1.0, 0.0], [9.0, -1.0, 0.0]],
            Some(0.5),
        ),
        (
            [[5.0, 1.0, 0.0], [9.0, 1.0, 0.0]],
            [[5.0, -1.0, 0.0], [9.0, -1.0, 0.0]],
            None,
        ),
        (
            [[5.0, 0.0, 0.0], [9.0, 0.0, 0.0]],
            [[3.0, 0.0, 0.0], [7.0, 0.0, 0.0]],
            Some(0.5),
        ),
        (
            [[-9.0, 0.0, 0.0], [-8.0, 0.0, 0.0]],
            [[23.0, 0.0, 0.0], [24.0, 0.0, 0.0]],
            Some(0.25),
        ),
        // Turns about its middle, which is in the line beyond the end. Its ends pass the line far
        // away.
        (
            [[5.0, -1.0, 0.0], [5.0, 1.0, 0.0]],
            [[5.0, 1.0, 0.0], [5.0, -1.0, 0.0]],
            None,
        ),
        // Points: across the edge, onto its end, along its line.
        ([[1.0, 1.0, 0.0]; 2], [[1.0, -1.0, 0.0]; 2], Some(0.5)),
        ([[6.0, 2.0, 2.0]; 2], [[4.0, 0.0, 0.0]; 2], Some(1.0)),
        ([[6.0, 0.0, 0.0]; 2], [[-2.0, 0.0, 0.0]; 2], Some(0.25)),
        ([[6.0, 0.0, 0.0]; 2], [[5.0, 0.0, 0.0]; 2], None),
    ] {
        assert_first(EE, &onto_edge(from, to), at);
    }
    // Two points.
    let points = |p: [f64; 3], q: [f64; 3]| [p, p, q, q];
    let motion = [
        points([0.0; 3], [2.0, 2.0, 2.0]),
        points([2.0; 3], [0.0, 0.0, 0.0]),
    ];
    assert_first(EE, &motion, Some(0.5));
    let motion = [
        points([0.0; 3], [2.0, 2.0, 3.0]),
        points([2.0; 3], [0.0, 0.0, 0.0]),
    ];
    assert_first(EE, &motion, None);
}

#[test]
fn triangles_that_are_less_for_a_moment() {
    // Half way all three corners are on the x axis, from 0 to 4. The vertex is above the axis
    // before and below it after.
    let folded = |height: f64, x: f64| -> Moving {
        let c = [2.0, height, 0.0];
        let p = [x, 0.0, height];
        let q = [x, 0.0, -height];
        let d = [2.0, -height, 0.0];
        let [a, b, _] = FACE;
        [[p, a, b, c], [q, a, b, d]]
    };
    assert_first(VT, &folded(1.0, 1.0), Some(0.5));
    assert_first(VT, &folded(1.0, 4.0), Some(0.5));
    assert_first(VT, &folded(1.0, 5.0), None);
    // The triangle shrinks to a point, where the vertex is at that time, or is not.
    let shrinking = |x: f64| -> Moving {
        let corners = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, -1.0, 0.0]];
        let [a, b, c] = corners;
        let [d, e, f] = corners.map(|p| p.map(|x| -x));
        [[[x, 0.0, 1.0], a, b, c], [[x, 0.0, -1.0], d, e, f]]
    };
    assert_first(VT, &shrinking(0.0), Some(0.5));
    assert_first(VT, &shrinking(1e-300), None);
    // A segment always, and the vertex crosses it.
    let segment = [[0.0; 3], [1.0; 3], [4.0; 3]];
    let [a, b, c] = segment;
    assert_first(
        VT,
        &[[[2.0, 2.0, 3.0], a, b, c], [[2.0, 2.0, 1.0], a, b, c]],
        Some(0.5),
    );
    assert_first(
        VT,
        &[[[5.0, 5.0, 6.0], a, b, c], [[5.0, 5.0, 4.0], a, b, c]],
        None,
    );
}

/// Three moving corners, and a vertex at the origin.
fn round_the_origin(start: [[f64; 3]; 3], end: [[f64; 3]; 3]) -> Moving {
    [start, end].map(|[a, b, c]| [[0.0; 3], a, b, c])
}

#[test]
fn a_double_root() {
    // With s = 2t - 1, the corners (s, 1, 0), (e - s, s - 1, 0) and (0, 0, 1) have the determinant
    // s^2 - e. The edge of the first two passes the origin between them.
    let motion = |e: f64| {
        round_the_origin(
            [[-1.0, 1.0, 0.0], [1.0 + e, -2.0, 0.0], [0.0, 0.0, 1.0]],
            [[1.0, 1.0, 0.0], [-1.0 + e, 0.0, 0.0], [0.0, 0.0, 1.0]],
        )
    };
    assert_first(VT, &motion(0.0), Some(0.5));
    for bits in [10, 20, 30, 40, 50] {
        let e = 2f64.powi(-bits);
        assert_first(VT, &motion(-e), None);
        assert_first(VT, &motion(e), Some(0.5 - 0.5 * 2f64.powi(-bits / 2)));
    }
}

#[test]
fn the_last_of_three_roots() {
    // A triangular matrix with the diagonal 4t - 1, 2t - 1 and 4t - 3. At the first two times the
    // corners are in one plane with the origin, but do not contain it. At the third a corner is
    // there.
    let motion = round_the_origin(
        [[-1.0, 1.0, 1.0], [0.0, -1.0, -1.0], [0.0, 0.0, -3.0]],
        [[3.0, 1.0, 1.0], [0.0, 1.0, -1.0], [0.0, 0.0, 1.0]],
    );
    assert_first(VT, &motion, Some(0.75));
    let motion = round_the_origin(
        [[-1.0, 1.0, 1.0], [0.0, -1.0, 1.0], [0.0, 0.0, -3.0]],
        [[3.0, 1.0, 1.0], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]],
    );
    assert_first(VT, &motion, Some(0.25));
}

#[test]
fn times_that_are_no_fractions_of_powers_of_two() {
    // In one line: a gap of 1 closes at a speed of 3.
    let third = onto_edge(
        [[5.0, 0.0, 0.0], [6.0, 0.0, 0.0]],
        [[2.0, 0.0, 0.0], [3.0, 0.0, 0.0]],
    );
    let first = first_contact(EE, &third).unwrap();
    assert_eq!(first.compare(1.0 / 3.0), Ordering::Greater);
    assert_eq!(first.compare((1.0f64 / 3.0).next_up()), Ordering::Less);
    // The corners (2t, 1, 0), (-1, -t, 0), (0, 0, 1) have the determinant 1 - 2t^2.
    let root = round_the_origin(
        [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        [[2.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [0.0, 0.0, 1.0]],
    );
    let first = first_contact(VT, &root).unwrap();
    let half = 0.5f64.sqrt();
    let around = [half.next_down(), half.next_up()].map(|t| first.compare(t));
    assert_eq!(around, [Ordering::Greater, Ordering::Less]);
    assert_ne!(first.compare(half), Ordering::Equal);
    assert_eq!(
        compare_first((EE, &third), (VT, &root)),
        Some(Ordering::Less)
    );
    assert_eq!(
        compare_first((VT, &root), (EE, &third)),
        Some(Ordering::Greater)
    );
    assert_eq!(
        compare_first((VT, &root), (VT, &root)),
        Some(Ordering::Equal)
    );
    let larger = every(&root, |x| 3.0 * x);
    assert_eq!(
        compare_first((VT, &root), (VT, &larger)),
        Some(Ordering::Equal)
    );
    // A third of the step with other elements.
    let third_by_vertex = onto_face([1.0, 1.0, 1.0], [1.0, 1.0, -2.0]);
    assert_eq!(
        compare_first((VT, &third_by_vertex), (EE, &third)),
        Some(Ordering::Equal)
    );
    let never = onto_face([1.0, 1.0, 1.0], [1.0, 1.0, 2.0]);
    assert_eq!(compare_first((VT, &never), (EE, &third)), None);
    assert_eq!(compare_first((EE, &third), (VT, &never)), None);
}

#[test]
fn at_the_end_at_every_size() {
    for exponent in -60..=60 {
        let to = |z: f64| {
            let motion = onto_face([1.0, 1.0, 1.0], [1.0, 1.0, z]);
            every(&motion, |x| x * 2f64.powi(exponent))
        };
        assert_first(VT, &to(0.0), Some(1.0));
        assert_first(VT, &to(1e-280), None);
        let first = first_contact(VT, &to(-f64::EPSILON)).unwrap();
        // 1 / (1 + epsilon) is a little more than 1 - epsilon.
        assert_eq!(first.compare(1.0 - f64::EPSILON), Ordering::Greater);
        assert_eq!(first.compare(1.0f64.next_down()), Ordering::Less);
        let edges = |z: f64| {
            let motion = onto_edge(
                [[1.0, -1.0, 7.0], [1.0, 1.0, 7.0]],
                [[2.0, -1.0, z], [2.0, 1.0, -z]],
            );
            every(&motion, |x| x * 2f64.powi(exponent))
        };
        assert_first(EE, &edges(0.0), Some(1.0));
        assert_first(EE, &edges(1.0), Some(1.0));
        let mut above = edges(1.0);
        above[1][0][2] = above[1][0][2].next_up();
        assert_first(EE, &above, None);
    }
}

#[test]
fn the_smallest_and_the_largest_numbers() {
    let (tiny, huge) = (5e-324, f64::from(f32::MAX));
    let meets = |motion: Moving| meet_until(VT, &motion, 1.0);
    let [a, b, c] = FACE.map(|p| p.map(|x| x * tiny));
    assert!(meets([
        [[tiny, tiny, tiny], a, b, c],
        [[tiny, tiny, -tiny], a, b, c]
    ]));
    assert!(!meets([
        [[tiny, tiny, tiny], a, b, c],
        [[tiny, tiny, tiny], a, b, c]
    ]));
    assert!(!meets([
        [[-tiny, 0.0, huge], a, b, c],
        [[-tiny, 0.0, -huge], a, b, c]
    ]));
    assert!(meets([
        [[0.0, 0.0, huge], a, b, c],
        [[0.0, 0.0, -huge], a, b, c]
    ]));
    let [a, b, c] = [[-huge, -huge, 0.0], [huge, -huge, 0.0], [0.0, huge, 0.0]];
    assert!(meets([
        [[0.0, 0.0, tiny], a, b, c],
        [[0.0, 0.0, 0.0], a, b, c]
    ]));
    assert!(!meets([
        [[0.0, 0.0, huge], a, b, c],
        [[0.0, 0.0, tiny], a, b, c]
    ]));
    let first = first_contact(
        VT,
        &[[[0.0, 0.0, huge], a, b, c], [[0.0, 0.0, -tiny], a, b, c]],
    );
    // Between the last number before the end, and the end.
    assert_eq!(
        first.unwrap().compare(1.0f64.next_down()),
        Ordering::Greater
    );
    let first = first_contact(
        VT,
        &[[[0.0, 0.0, tiny], a, b, c], [[0.0, 0.0, -huge], a, b, c]],
    );
    assert_eq!(first.as_ref().unwrap().compare(0.0), Ordering::Greater);
    assert_eq!(first.unwrap().compare(tiny), Ordering::Less);
}

/// Runs `run` with motions of all classes.
fn for_all(seed: u64, count: u32, mut run: impl FnMut(MotionClass, Elements, &Moving)) {
    for class in MotionClass::ALL {
        let mut random = Random::new(seed);
        for _ in 0..count {
            let (elements, motion) = class.motion(&mut random);
            run(class, elements, &motion);
        }
    }
}

/// Asserts that two motions first meet at the same time, or never.
fn assert_same(a: (Elements, &Moving), b: (Elements, &Moving)) {
    let answer = compare_first(a, b);
    let never = || !meet_until(a.0, a.1, 1.0) && !meet_until(b.0, b.1, 1.0);
    assert!(
        answer.map_or_else(never, Ordering::is_eq),
        "{answer:?}\n{a:?}\n{b:?}"
    );
}

#[test]
fn orders_mirrors_and_the_direction_of_time() {
    for_all(10, 60, |_, elements, motion| {
        for order in orders(elements) {
            assert_same((elements, motion), (elements, &in_order(motion, order)));
        }
        let mirrored = motion.map(|corners| corners.map(|[x, y, z]| [-y, x, z]));
        assert_same((elements, motion), (elements, &mirrored));
        let backward = [motion[1], motion[0]];
        let verdicts = [motion, &backward].map(|it| meet_until(elements, it, 1.0));
        assert_eq!(verdicts[0], verdicts[1], "{motion:?}");
    });
}

/// The sum, if it is exact.
fn exact_sum(x: f64, y: f64) -> Option<f64> {
    let sum = x + y;
    (sum - x == y && sum - y == x).then_some(sum)
}

#[test]
fn sizes_places_and_shears() {
    let mut moved = [0; 3];
    for_all(11, 100, |_, elements, motion| {
        for exponent in [-300, -1, 40] {
            let scaled = every(motion, |x| x * 2f64.powi(exponent));
            if every(&scaled, |x| x * 2f64.powi(-exponent)) == *motion {
                assert_same((elements, motion), (elements, &scaled));
                moved[0] += 1;
            }
        }
        let exact = |of: &mut dyn FnMut(usize, [f64; 3]) -> Option<[f64; 3]>| {
            let mut all_exact = true;
            let mut changed = *motion;
            for (end, corners) in changed.iter_mut().enumerate() {
                for p in corners {
                    match of(end, *p) {
                        Some(q) => *p = q,
                        None => all_exact = false,
                    }
                }
            }
            all_exact.then_some(changed)
        };
        // A translation for each end, the same for both elements.
        let by = [[1.0, -8.0, 3.0], [-64.0, 5.0, 0.5]];
        let moved_by = exact(&mut |end, p| {
            let [x, y, z] = [0, 1, 2].map(|axis| exact_sum(p[axis], by[end][axis]));
            Some([x?, y?, z?])
        });
        if let Some(changed) = moved_by {
            assert_same((elements, motion), (elements, &changed));
            moved[1] += 1;
        }
        let sheared =
            exact(&mut |_, [x, y, z]| Some([exact_sum(x, 2.0 * y)?, y, exact_sum(z, -y)?]));
        if let Some(changed) = sheared {
            assert_same((elements, motion), (elements, &changed));
            moved[2] += 1;
        }
    });
    println!("{moved:?}");
    assert!(moved.iter().all(|&count| count > 500), "{moved:?}");
}

/// Corners half way, if they are exact.
fn half_way(motion: &Moving) -> Option<[[f64; 3]; 4]> {
    let mut middle = motion[0];
    for (p, q) in middle.iter_mut().zip(motion[1]) {
        for axis in 0..3 {
            let sum = exact_sum(p[axis], q[axis])?;
            p[axis] = 0.5 * sum;
            if 2.0 * p[axis] != sum {
                return None;
            }
        }
    }
    Some(middle)
}

#[test]
fn a_step_is_its_halves() {
    let mut halved = [0; 2];
    for_all(12, 200, |_, elements, motion| {
        if let Some(middle) = half_way(motion) {
            let halves = [[motion[0], middle], [middle, motion[1]]];
            let [first, second] = halves.map(|half| meet_until(elements, &half, 1.0));
            assert_eq!(meet_until(elements, motion, 0.5), first, "{motion:?}");
            assert_eq!(
                meet_until(elements, motion, 1.0),
                first || second,
                "{motion:?}"
            );
            halved[usize::from(first || second)] += 1;
            if let (Some(whole), Some(half)) = (
                first_contact(elements, motion),
                first_contact(elements, &halves[0]),
            ) {
                // Half the time of the half.
                for t in [0.125, 0.25, 0.5, 0.75, 0.9] {
                    assert_eq!(whole.compare(0.5 * t), half.compare(t));
                }
            }
        }
    });
    println!("{halved:?}");
    assert!(halved.iter().all(|&count| count > 200), "{halved:?}");
}

#[test]
fn a_triangle_is_its_parts() {
    let mut parted = [0; 2];
    for_all(13, 200, |_, elements, motion| {
        let [Some(start), Some(end)] = [0, 1].map(|end| {
            // From the third corner to the fourth.
            let pair: Moving = [[motion[end][2]; 4], [motion[end][3]; 4]];
            half_way(&pair).map(|it| it[0])
        }) else {
            return;
        };
        let middle = [start, end];
        let part = |of: usize| -> Moving {
            let mut part = *motion;
            for end in 0..2 {
                part[end][of] = middle[end];
            }
            part
        };
        let [first, second] = [part(2), part(3)].map(|part| first_contact(elements, &part));
        let whole = first_contact(elements, motion);
        parted[usize::from(whole.is_some())] += 1;
        let least = match (first, second) {
            (Some(a), Some(b)) => Some(if a.compare_with(&b).is_lt() { a } else { b }),
            (a, b) => a.or(b),
        };
        let same = match (&whole, &least) {
            (Some(a), Some(b)) => a.compare_with(b).is_eq(),
            (a, b) => a.is_none() && b.is_none(),
        };
        assert!(same, "{elements:?} {motion:?} {whole:?} {least:?}");
    });
    println!("{parted:?}");
    assert!(parted.iter().all(|&count| count > 300), "{parted:?}");
}

#[test]
fn a_vertex_and_a_segment_either_way() {
    let mut count = [0; 2];
    for_all(14, 200, |_, _, motion| {
        let triangle = motion.map(|[p, a, b, _]| [p, a, b, b]);
        let edges = motion.map(|[p, a, b, _]| [p, p, a, b]);
        assert_same((VT, &triangle), (EE, &edges));
        count[usize::from(meet_until(VT, &triangle, 1.0))] += 1;
    });
    println!("{count:?}");
    assert!(count.iter().all(|&count| count > 200), "{count:?}");
}

/// Whether the elements meet at rest, as triangles.
fn at_rest(elements: Elements, [a, b, c, d]: [[f64; 3]; 4]) -> bool {
    match elements {
        VT => intersect(&[a; 3], &[b, c, d]),
        EE => intersect(&[a, b, b], &[c, d, d]),
    }
}

#[test]
fn at_exact_times_it_agrees_with_intersect() {
    let mut counts = [[0; 2]; 2];
    for_all(15, 200, |_, elements, motion| {
        let start = at_rest(elements, motion[0]);
        assert_eq!(meet_until(elements, motion, 0.0), start, "{motion:?}");
        counts[0][usize::from(start)] += 1;
        let first = first_contact(elements, motion);
        let seen = |t: f64, corners: [[f64; 3]; 4]| {
            let meet = at_rest(elements, corners);
            if meet {
                let first = first.as_ref().expect("there is contact");
                assert!(first.compare(t).is_le(), "{motion:?}");
            }
            if first.as_ref().is_some_and(|first| first.compare(t).is_eq()) {
                assert!(meet, "{motion:?} {t}");
            }
            meet
        };
        seen(1.0, motion[1]);
        // Quarters where they are exact.
        if let Some(middle) = half_way(motion) {
            counts[1][usize::from(seen(0.5, middle))] += 1;
            for (t, half) in [(0.25, [motion[0], middle]), (0.75, [middle, motion[1]])] {
                if let Some(quarter) = half_way(&half) {
                    counts[1][usize::from(seen(t, quarter))] += 1;
                }
            }
        }
        // Without motion the answer is as at the start.
        let still = [motion[0]; 2];
        assert_eq!(meet_until(elements, &still, 1.0), start);
    });
    println!("{counts:?}");
    assert!(
        counts.as_flattened().iter().all(|&count| count > 200),
        "{counts:?}"
    );
}

#[test]
fn later_is_never_less() {
    let times = [
        0.0,
        5e-324,
        1e-12,
        0.1,
        0.25,
        0.5f64.next_down(),
        0.5,
        0.9,
        1.0f64.next_down(),
        1.0,
    ];
    for_all(16, 40, |_, elements, motion| {
        let until = times.map(|t| meet_until(elements, motion, t));
        assert!(until.is_sorted(), "{motion:?}");
        let first = first_contact(elements, motion);
        for (t, met) in times.into_iter().zip(until) {
            let expected = first.as_ref().is_some_and(|first| first.compare(t).is_le());
            assert_eq!(met, expected, "{motion:?}");
        }
    });
}

#[test]
fn every_class_is_in_range_and_hard() {
    for class in MotionClass::ALL {
        let mut random = Random::new(1);
        let mut again = Random::new(1);
        let begin = std::time::Instant::now();
        let mut answers = [[0; 2]; 2];
        let mut as_f32 = [0; 2];
        let mut at_ends = [0; 2];
        for _ in 0..2000 {
            let (elements, motion) = class.motion(&mut random);
            assert_eq!(class.motion(&mut again), (elements, motion));
            let coordinates = motion.as_flattened().as_flattened();
            assert!(coordinates.iter().all(|x| x.abs() <= f64::from(f32::MAX)));
            let first = first_contact(elements, &motion);
            answers[usize::from(elements == EE)][usize::from(first.is_some())] += 1;
            as_f32[usize::from(motion_fits_f32(&motion))] += 1;
            for (end, t) in [0.0, 1.0].into_iter().enumerate() {
                at_ends[end] += u32::from(first.as_ref().is_some_and(|it| it.compare(t).is_eq()));
            }
        }
        println!(
            "{class:?} {answers:?} {as_f32:?} {at_ends:?} {:?}",
            begin.elapsed()
        );
        // Edges in one line mostly meet.
        let least = if class == MotionClass::Parallel {
            30
        } else {
            60
        };
        assert!(
            answers.as_flattened().iter().all(|&count| count >= least),
            "{class:?} {answers:?}"
        );
        assert!(as_f32[1] >= 900, "{class:?} {as_f32:?}");
        match class {
            MotionClass::TouchAtEnd => assert!(at_ends[1] > 600),
            MotionClass::TouchAtStart => assert!(at_ends[0] > 600),
            _ => {}
        }
    }
}

/// Prints the time for 100,000 motions of each class, and the slowest motion.
#[test]
#[ignore = "minutes; to be run with --release and --nocapture"]
fn a_hundred_thousand_of_each() {
    for class in MotionClass::ALL {
        let mut random = Random::new(20);
        let mut met = 0;
        let mut slowest = std::time::Duration::ZERO;
        let begin = std::time::Instant::now();
        for _ in 0..100_000 {
            let (elements, motion) = class.motion(&mut random);
            let begin = std::time::Instant::now();
            met += u32::from(meet_until(elements, &motion, 1.0));
            slowest = slowest.max(begin.elapsed());
        }
        let name = format!("{class:?}");
        println!(
            "{name:<16}{met:>8} meet{:>8.1} s{:>10.1?} the slowest",
            begin.elapsed().as_secs_f64(),
            slowest
        );
    }
}
