//! Kinds of contact: every configuration gives the kinds of the reference.
//!
//! They are asked for all together and one kind alone. After a cut the two sides lie on each other
//! without crossing.

use crate::common::{covering_configurations, widened, world_of};
use pliant::{Contact, ContactKind, Scalar, Selection, World, reference};
use pliant_scenes::Scene;
use std::collections::BTreeMap;
use std::ops::ControlFlow;

const KINDS: [ContactKind; 3] = [
    ContactKind::Touching,
    ContactKind::Overlapping,
    ContactKind::Crossing,
];

/// A plane square with this many squares on a side, each cut into two triangles.
fn grid(squares: u32, at: impl Fn(f32, f32) -> [f32; 3]) -> (Vec<[u32; 3]>, Vec<[f32; 3]>) {
    let across = squares + 1;
    let point = |i: u32| at((i % across) as f32, (i / across) as f32);
    let corners = |i: u32| {
        let low = i / squares * across + i % squares;
        let high = low + across;
        [[low, low + 1, high + 1], [low, high + 1, high]]
    };
    let triangles = (0..squares * squares).flat_map(corners).collect();
    (triangles, (0..across * across).map(point).collect())
}

/// Grids that lie on, stand on and go through each other, with places exactly at vertices and
/// edges.
fn grids() -> Vec<(Vec<[u32; 3]>, Vec<[f32; 3]>)> {
    let mut grids = vec![
        grid(5, |x, y| [x, y, 0.0]),
        grid(5, |x, y| [x, y, 0.0]),
        grid(4, |x, y| [x + 0.25, y + 0.5, 0.0]),
        grid(3, |x, y| [x + 1.0, 2.0, y]),
        grid(3, |x, y| [x + 1.0, 2.5, y - 1.0]),
        grid(3, |x, y| [x + 0.5, 1.25 + y / 4.0, y - 1.5]),
    ];
    // A surface folded over itself, and a triangle that is a segment.
    let (mut triangles, positions) = grid(6, |x, y| {
        let x = if x > 3.0 { 6.0 - x } else { x };
        [x - 4.0, y - 3.0, if y > 4.0 { x - 2.0 } else { 0.0 }]
    });
    triangles.push([0, 8, 16]);
    grids.push((triangles, positions));
    grids
}

/// All contacts of a world, by the reference.
fn expected<S: Scalar>(bodies: &[(Vec<[u32; 3]>, Vec<[S; 3]>)]) -> Vec<([u32; 4], ContactKind)> {
    let mut all = Vec::new();
    for (a, (triangles_a, positions_a)) in (0..).zip(bodies) {
        let itself = reference::self_contacts(triangles_a, positions_a).unwrap();
        all.extend(
            itself
                .into_iter()
                .map(|([i, j], kind)| ([a, i, a, j], kind)),
        );
        for (b, (triangles_b, positions_b)) in (0..).zip(bodies).skip(a as usize + 1) {
            let of_two =
                reference::contacts(triangles_a, positions_a, triangles_b, positions_b).unwrap();
            all.extend(
                of_two
                    .into_iter()
                    .map(|([i, j], kind)| ([a, i, b, j], kind)),
            );
        }
    }
    all.sort_unstable_by_key(|&(row, _)| row);
    all
}

fn rows(contacts: &[Contact]) -> Vec<([u32; 4], ContactKind)> {
    let row = |contact: &Contact| (contact.pair.into(), contact.kind);
    contacts.iter().map(row).collect()
}

/// Compares every way to ask with the expected contacts.
fn check<S: Scalar>(world: &mut World<S>, expected: &[([u32; 4], ContactKind)]) {
    let of = Selection::Everything;
    assert_eq!(rows(world.contacts(of).all().unwrap()), expected);
    assert_eq!(world.statistics().pairs, expected.len() as u64);
    let pairs = world.intersections(of).all().unwrap().iter();
    assert!(
        pairs
            .map(|&pair| <[u32; 4]>::from(pair))
            .eq(expected.iter().map(|it| it.0))
    );
    for kind in KINDS {
        let of_kind: Vec<_> = expected.iter().copied().filter(|it| it.1 == kind).collect();
        assert_eq!(rows(world.contacts(of).only(kind).all().unwrap()), of_kind);
        assert_eq!(world.statistics().pairs, of_kind.len() as u64);
        let first = world.contacts(of).only(kind).first().unwrap();
        assert_eq!(first.is_some(), !of_kind.is_empty());
        assert!(first.is_none_or(|first| of_kind.contains(&(first.pair.into(), first.kind))));
        let mut seen = Vec::new();
        let visited = world.contacts(of).only(kind).visit(|contact| {
            seen.push((contact.pair.into(), contact.kind));
            ControlFlow::<()>::Continue(())
        });
        assert!(visited.unwrap().is_continue());
        seen.sort_unstable();
        assert_eq!(seen, of_kind);
    }
    let refused = world.contacts(of).at_most(expected.len() - 1).all();
    assert!(refused.is_err());
}

/// Compares every tried configuration with the reference, on the same grids.
fn check_configurations<S: Scalar>(convert: fn(&[[f32; 3]]) -> Vec<[S; 3]>) {
    let grids = grids().into_iter();
    let grids: Vec<_> = grids.map(|(t, p)| (t, convert(&p))).collect();
    let truth = expected(&grids);
    for options in covering_configurations() {
        let bodies: Vec<_> = grids.iter().map(|(t, p)| (&t[..], p.clone())).collect();
        check(&mut world_of(options, &bodies).0, &truth);
    }
}

#[test]
fn every_configuration_gives_the_kinds_of_the_reference_f32() {
    check_configurations::<f32>(<[_]>::to_vec);
}

#[test]
fn every_configuration_gives_the_kinds_of_the_reference_f64() {
    check_configurations::<f64>(widened);
}

#[test]
fn both_precisions_have_the_same_kinds_and_many_of_each() {
    let singles = grids();
    let doubles: Vec<_> = singles
        .iter()
        .map(|(triangles, positions)| (triangles.clone(), widened(positions)))
        .collect();
    let truth = expected(&singles);
    assert_eq!(truth, expected(&doubles));
    let mut counts = BTreeMap::new();
    truth
        .iter()
        .for_each(|&(_, kind)| *counts.entry(kind).or_insert(0) += 1);
    println!("{counts:?}");
    assert!(KINDS.iter().all(|kind| counts[kind] >= 30), "{counts:?}");
}

#[test]
fn what_goes_through_general_positions_crosses() {
    let scene = Scene::new("spheres", Some(1280), Scene::DEFAULT_SEED).unwrap();
    let mut world = World::<f32>::new();
    for body in 0..scene.body_count() {
        let mut positions = Vec::new();
        scene.positions(body, 150, &mut positions);
        world.add(scene.triangles(body), &positions).unwrap();
    }
    let pairs = world.intersections(Selection::World).all().unwrap().len();
    let crossing = world.contacts(Selection::World).only(ContactKind::Crossing);
    assert_eq!(crossing.all().unwrap().len(), pairs);
    assert!(pairs > 0);
}

#[test]
fn two_sides_of_a_cut_do_not_cross() {
    // One surface as two bodies, cut along the zigzag of its edges. Triangles with a common edge
    // touch; none overlap or cross.
    let (triangles, positions) = grid(8, |x, y| [x, y, (x - 3.0) * (y - 4.0) / 8.0]);
    let (left, right): (Vec<_>, Vec<_>) = triangles.iter().partition(|it| it[0] % 9 < 4);
    let mut world = World::<f32>::new();
    for half in [left, right] {
        world.add(&half, &positions).unwrap();
    }
    let contacts = world.contacts(Selection::World).all().unwrap();
    assert!(contacts.len() >= 30);
    assert!(
        contacts
            .iter()
            .all(|contact| contact.kind == ContactKind::Touching)
    );
}
