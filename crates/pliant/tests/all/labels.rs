//! Labels of triangles: what they leave out, through edits, splits and fusions, and at hubs.
//!
//! `candidates` and `edits` compare lists with the reference in random lives.

use crate::common::{Lcg, covering_configurations, sheet};
use pliant::reference::{self, Moving};
use pliant::{BodyId, ErrorKind, Labels, Pair, Selection, World};

/// Labels whose neighbours have a vertex in common.
fn of(of_triangles: &[u32]) -> Labels<'_> {
    Labels {
        of_triangles,
        neighbours: None,
    }
}

/// Triangles of one body that intersect.
fn hits(world: &mut World<f64>, body: BodyId) -> Vec<[u32; 2]> {
    let all = world.intersections(Selection::Within(body)).all().unwrap();
    all.iter().map(Pair::triangles).collect()
}

/// A crumpled sheet.
fn crumpled(side: u32) -> (Vec<[u32; 3]>, Vec<[f64; 3]>) {
    let random = &mut Lcg(8);
    let (triangles, flat) = sheet(side);
    let place = |_| [(); 3].map(|()| f64::from(random.unit()));
    (triangles, flat.into_iter().map(place).collect())
}

#[test]
fn every_configuration_leaves_the_same_pairs_out() {
    let (triangles, positions) = crumpled(12);
    // Stripes across, of three columns each: of eight triangles in a row, two rows of squares.
    let stripes: Vec<u32> = (0..triangles.len() as u32).map(|it| it / 22 / 3).collect();
    let body = Moving {
        labels: Some(of(&stripes)),
        ..Moving::at(&triangles, &positions)
    };
    let every = reference::self_intersection_pairs(&triangles, &positions).unwrap();
    let mut expected = every.clone();
    reference::leave_out(&body, &mut expected);
    assert!(every.len() > 2 * expected.len() && expected.len() > 100);
    for options in covering_configurations() {
        let world = &mut World::<f64>::with_options(options);
        let id = world.add(&triangles, &positions).unwrap();
        let itself = Selection::Within(id);
        assert_eq!(hits(world, id), every);
        // A witness of a pair that is left out from now on.
        let first = world.intersections(itself).first().unwrap().unwrap();
        let is_left_out = |pair: [u32; 2]| !expected.contains(&pair);
        world.set_labels(id, body.labels).unwrap();
        let next = world.intersections(itself).first().unwrap().unwrap();
        assert!(is_left_out(first.triangles()) || expected.contains(&first.triangles()));
        assert!(!is_left_out(next.triangles()));
        assert_eq!(hits(world, id), expected, "{options:?}");
        let copy = &mut world.clone();
        assert_eq!(hits(copy, id), expected);
        // Two bodies do not look at labels.
        let twin = copy.add(&triangles, &positions).unwrap();
        copy.set_labels(twin, body.labels).unwrap();
        let of_two = Selection::Between(id, twin);
        assert!(copy.intersections(of_two).all().unwrap().len() > every.len());
        world.set_labels(id, None).unwrap();
        assert_eq!(hits(world, id), every);
    }
}

#[test]
fn adjacent_contacts_are_left_out_and_crossing_edges_are_not() {
    let (triangles, positions) = crumpled(12);
    let stripes: Vec<u32> = (0..triangles.len() as u32).map(|it| it / 22 / 3).collect();
    let labels = Labels {
        of_triangles: &stripes,
        neighbours: Some(&[[1, 0]]),
    };
    let body = Moving {
        labels: Some(labels),
        ..Moving::at(&triangles, &positions)
    };
    let world = &mut World::<f64>::new();
    let id = world.add(&triangles, &positions).unwrap();
    let itself = Selection::Within(id);
    let ask = |world: &mut World<f64>| {
        let adjacent = world.adjacent_intersections(itself).all().unwrap().iter();
        let adjacent: Vec<_> = adjacent.map(|it| it.pair.triangles()).collect();
        let crossing = world.crossing_edges(itself).all().unwrap().to_vec();
        (adjacent, crossing)
    };
    let (mut expected, crossing) = ask(world);
    let before = expected.len();
    reference::leave_out(&body, &mut expected);
    assert!(
        before > 2 * expected.len() && expected.len() > 10,
        "{}",
        expected.len()
    );
    world.set_labels(id, Some(labels)).unwrap();
    assert_eq!(ask(world), (expected, crossing));
}

#[test]
fn a_witness_is_not_asked_of_what_is_left_out() {
    let world = &mut World::<f64>::new();
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let positions = [corners, corners].concat();
    let body = world.add(&[[0, 1, 2], [3, 4, 5]], &positions).unwrap();
    let itself = Selection::Within(body);
    assert!(world.intersections(itself).first().unwrap().is_some());
    world.set_labels(body, Some(of(&[7, 7]))).unwrap();
    assert!(world.intersections(itself).first().unwrap().is_none());
    assert!(
        world
            .intersections(Selection::Everything)
            .first()
            .unwrap()
            .is_none()
    );
    world.set_labels(body, Some(of(&[7, 8]))).unwrap();
    assert!(world.intersections(itself).first().unwrap().is_some());
}

/// Pairs that labels leave out, of vertices and triangles and of edges, in a row of triangles that
/// all are close.
#[test]
fn elements_have_the_labels_of_all_their_triangles() {
    let strip = [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4], [4, 5, 6]];
    let positions: Vec<[f64; 3]> = (0..7).map(|it| [0.0, 0.0, f64::from(it)]).collect();
    let world = &mut World::<f64>::new();
    let body = world.add(&strip, &positions).unwrap();
    let labels = [0, 0, 1, 2, Labels::NONE];
    world.set_labels(body, Some(of(&labels))).unwrap();
    let close = |world: &mut World<f64>| -> Vec<[u32; 2]> {
        let close = world.close_vertex_triangle_pairs(Selection::Within(body), 9.0);
        let close = close.all().unwrap().iter();
        close.map(|it| [it.pair.vertex, it.pair.triangle]).collect()
    };
    let pairs = close(world);
    // Vertex 2 has triangles of 0 and 1; both are next to 2, which triangle 3 is.
    assert!(!pairs.contains(&[2, 3]));
    // Vertex 1 is only of 0, and so is vertex 0. All labels but none are at vertex 3.
    assert!(!pairs.contains(&[0, 3]) && !pairs.contains(&[1, 2]));
    // What has a triangle without a label stays.
    assert!(pairs.contains(&[6, 0]) && pairs.contains(&[0, 4]) && pairs.contains(&[4, 0]));
    let given = Labels {
        of_triangles: &labels,
        neighbours: Some(&[[2, 1], [9, 9], [Labels::NONE, 0]]),
    };
    world.set_labels(body, Some(given)).unwrap();
    let pairs = close(world);
    assert!(pairs.contains(&[0, 3]) && pairs.contains(&[0, 4]) && pairs.contains(&[2, 3]));
    assert!(pairs.contains(&[1, 2]) && !pairs.contains(&[0, 1]));
}

/// More labels at a vertex than are listed as pairs: two fans, of which each triangle has its own.
#[test]
fn many_labels_at_one_vertex_are_neighbours() {
    for blades in [7, 8, 9, 70] {
        let fan = |apex: u32, first: u32| {
            (0..blades).map(move |it| [apex, first + 2 * it, first + 2 * it + 1])
        };
        let mut triangles: Vec<[u32; 3]> = fan(0, 2).collect();
        triangles.extend(fan(1, 2 + 2 * blades));
        let random = &mut Lcg(5);
        let place = |_| [(); 3].map(|()| f64::from(random.unit()));
        let positions: Vec<[f64; 3]> = (0..2 + 4 * blades).map(place).collect();
        // One label is in both.
        let mut labels: Vec<u32> = (0..2 * blades).map(|it| 3 * it).collect();
        labels[blades as usize] = 0;
        let world = &mut World::<f64>::new();
        let id = world.add(&triangles, &positions).unwrap();
        world.set_labels(id, Some(of(&labels))).unwrap();
        let body = Moving {
            labels: Some(of(&labels)),
            ..Moving::at(&triangles, &positions)
        };
        let mut expected = reference::self_intersection_pairs(&triangles, &positions).unwrap();
        let before = expected.len();
        reference::leave_out(&body, &mut expected);
        assert!(!expected.is_empty() && expected.len() < before);
        assert_eq!(hits(world, id), expected);
        let close = world
            .close_edge_edge_pairs(Selection::Within(id), 0.01)
            .all()
            .unwrap();
        let close: Vec<_> = close
            .iter()
            .map(|it| [it.pair.edge_a, it.pair.edge_b])
            .collect();
        assert_eq!(
            close,
            reference::self_close_edge_edge_pairs(&body, 0.01).unwrap()
        );
    }
}

#[test]
fn edits_keep_labels_and_give_new_triangles_none() {
    let world = &mut World::<f64>::new();
    let (triangles, positions) = crumpled(4);
    let id = world.add(&triangles, &positions).unwrap();
    let labels: Vec<u32> = (0..triangles.len() as u32).map(|it| it % 4).collect();
    world.set_labels(id, Some(of(&labels))).unwrap();
    let mut edit = world.edit(id).unwrap();
    edit.remove_triangles(&[2]);
    edit.split_vertex(triangles[0][1], &[0]);
    edit.add_triangles(&[[0, 1, 9]]);
    edit.set_triangle(2, [7, 8, 9]);
    world.apply(&edit).unwrap();
    let mut expected = labels;
    (expected[2], expected[0]) = (2, 0);
    expected.push(Labels::NONE);
    assert_eq!(world.labels(id).unwrap(), Some(of(&expected)));
    let mut edit = world.edit(id).unwrap();
    edit.remove_triangles(&[3]);
    world.apply(&edit).unwrap();
    let mut edit = world.edit(id).unwrap();
    edit.set_triangle(3, [7, 8, 9]);
    world.apply(&edit).unwrap();
    expected[3] = Labels::NONE;
    assert_eq!(world.labels(id).unwrap(), Some(of(&expected)));
    // Another mesh has none.
    world.set_mesh(id, &triangles[..4], &positions).unwrap();
    assert_eq!(world.labels(id), Ok(None));
    let wrong = world.set_labels(id, Some(of(&[1]))).unwrap_err();
    assert!(matches!(wrong.kind, ErrorKind::WrongLength { .. }) && wrong.body == Some(id));
}

#[test]
fn fused_bodies_keep_labels_that_say_their_neighbours_alike() {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let given = |of_triangles, neighbours| {
        Some(Labels {
            of_triangles,
            neighbours,
        })
    };
    let none = Labels::NONE;
    let (one, other) = (&[[1, 2]][..], &[[3, 4]][..]);
    let both = [[1, 2], [3, 4]];
    for (of_a, of_b, expected) in [
        (None, None, None),
        (given(&[1], None), None, given(&[1, none], None)),
        (None, given(&[3], Some(one)), given(&[none, 3], Some(one))),
        (given(&[1], None), given(&[3], None), given(&[1, 3], None)),
        (
            given(&[1], Some(one)),
            given(&[3], Some(other)),
            given(&[1, 3], Some(&both)),
        ),
        (
            given(&[1], Some(one)),
            given(&[3], None),
            given(&[1, none], Some(one)),
        ),
    ] {
        let world = &mut World::<f64>::new();
        let [a, b] = [of_a, of_b].map(|labels| {
            let id = world.add(&[[0, 1, 2]], &corners).unwrap();
            world.set_labels(id, labels).unwrap();
            id
        });
        world.fuse(a, b).unwrap();
        assert_eq!(world.labels(a), Ok(expected));
    }
}
