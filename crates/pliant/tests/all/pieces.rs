//! Splitting into components, fusing, cutting and welding: no hit is lost, and numbers lead back.

use crate::common::{Lcg, sheet};
use pliant::{BodyId, ErrorKind, Labels, Pair, Selection, World};
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Sheets of these sizes one above the other, as one mesh with triangles and vertices shuffled.
fn sheets(random: &mut Lcg, sides: &[u32]) -> (Vec<[u32; 3]>, Vec<[f32; 3]>) {
    let (mut triangles, mut positions) = (Vec::new(), Vec::new());
    for (height, &side) in sides.iter().enumerate() {
        let (of_sheet, flat) = sheet(side);
        let first = positions.len() as u32;
        triangles.extend(of_sheet.iter().map(|it| it.map(|vertex| first + vertex)));
        let wave =
            |[x, y, _]: [f32; 3]| [x, y, 0.02 * height as f32 + 0.1 * (9.0 * x + 5.0 * y).sin()];
        let tilted = |[x, y, z]: [f32; 3]| [x, y, z + 0.3 * x * height as f32];
        positions.extend(flat.into_iter().map(wave).map(tilted));
    }
    for at in (1..triangles.len()).rev() {
        triangles.swap(at, random.below(at as u32 + 1) as usize);
    }
    (triangles, positions)
}

/// Pairs of triangles, by the numbers that they had in one body.
fn found(world: &mut World<f32>, number: impl Fn(BodyId, u32) -> u32) -> BTreeSet<[u32; 2]> {
    let pairs = world.intersections(Selection::Everything).all().unwrap();
    let named = |pair: &Pair| {
        let a = number(pair.body_a, pair.triangle_a);
        let b = number(pair.body_b, pair.triangle_b);
        [a.min(b), a.max(b)]
    };
    pairs.iter().map(named).collect()
}

#[test]
fn split_and_fused_again_it_finds_what_it_found() {
    let random = &mut Lcg(24);
    let (triangles, positions) = sheets(random, &[5, 9, 7, 3]);
    let mut world = World::<f32>::new();
    let other = world.add(&[[0, 1, 2]], &positions).unwrap();
    let body = world.add(&triangles, &positions).unwrap();
    world.ignore(body, other).unwrap();
    world.set_filter(body, 0b110, 0b111).unwrap();
    world.set_environment(body, 7).unwrap();
    let rest: Vec<[f32; 3]> = positions.iter().map(|&[x, y, z]| [z, x, y]).collect();
    world.set_rest_positions(body, Some(&rest)).unwrap();
    // Each is left out of nothing, so that what is found is found by pieces.
    let neighbours = &[[0, 1], [2, 3]][..];
    let labels = Labels {
        of_triangles: &vec![Labels::NONE; triangles.len()],
        neighbours: Some(neighbours),
    };
    world.set_labels(body, Some(labels)).unwrap();
    let groups: Vec<u32> = (0..positions.len() as u32).map(|it| it % 5).collect();
    world.set_vertex_groups(body, &groups).unwrap();
    let everywhere = Some(([-9.0; 3], [9.0; 3]));
    world.set_loose_box(body, everywhere).unwrap();
    let components = world.components(body).unwrap();
    assert_eq!(components.iter().max(), Some(&3));
    let before = found(&mut world, |_, triangle| triangle);
    assert!(before.len() > 15, "{}", before.len());

    let pieces = world.split(body).unwrap();
    assert_eq!(pieces.len(), 3);
    assert_eq!(world.bodies().len(), 5);
    // The largest component stays in the body: the sheet of side 9.
    let live = world.live_triangles(body).unwrap();
    let largest = components[live.iter().position(|&is| is).unwrap()];
    assert!(
        live.iter().eq(components
            .iter()
            .map(|it| *it == largest)
            .collect::<Vec<_>>()
            .iter())
    );
    assert_eq!(live.iter().filter(|&&is| is).count(), 2 * 8 * 8);
    assert!(pieces.is_sorted_by_key(|piece| piece.triangles[0]));
    for piece in &pieces {
        let component = components[piece.triangles[0] as usize];
        let of_it = (0..).zip(&components).filter(|(_, it)| **it == component);
        assert!(piece.triangles.iter().copied().eq(of_it.map(|(at, _)| at)));
        let corners = world.triangles(piece.body).unwrap().iter();
        let corners = corners.map(|it| it.map(|vertex| piece.vertices[vertex as usize]));
        let expected = piece.triangles.iter().map(|&it| triangles[it as usize]);
        assert!(corners.eq(expected));
        let at = piece.vertices.iter().map(|&it| positions[it as usize]);
        assert!(at.eq(world.positions(piece.body).unwrap()));
        let of_piece = piece.vertices.iter().map(|&it| groups[it as usize]);
        assert!(of_piece.eq(world.vertex_groups(piece.body).unwrap()));
        let of_piece = piece.vertices.iter().map(|&it| rest[it as usize]);
        let found = world.rest_positions(piece.body).unwrap().unwrap();
        assert!(of_piece.eq(found.iter().copied()));
        let labels = world.labels(piece.body).unwrap().unwrap();
        assert_eq!(labels.of_triangles.len(), piece.triangles.len());
        assert_eq!(labels.neighbours, Some(neighbours));
        assert_eq!(world.filter(piece.body), Ok((0b110, 0b111)));
        assert_eq!(world.environment(piece.body), Ok(7));
        assert_eq!(world.loose_box(piece.body), Ok(everywhere));
        assert!(world.ignored().contains(&[other, piece.body]));
        assert!(!world.ignored().contains(&[body, piece.body]));
    }
    let number = |id: BodyId, triangle: u32| {
        let piece = pieces.iter().find(|piece| piece.body == id);
        piece.map_or(triangle, |piece| piece.triangles[triangle as usize])
    };
    assert_eq!(found(&mut world, number), before);
    world.validate().unwrap();
    assert!(world.split(body).unwrap().is_empty());

    // Fused again, one by one: numbers follow through both calls.
    let mut names: Vec<u32> = (0..triangles.len() as u32).collect();
    for piece in &pieces {
        let fused = world.fuse(body, piece.body).unwrap();
        names.resize(world.triangle_count(body).unwrap(), u32::MAX);
        for (&new, &old) in fused.triangles.iter().zip(&piece.triangles) {
            names[new as usize] = old;
        }
        let at = world.positions(body).unwrap();
        let all = world.vertex_groups(body).unwrap();
        let rests = world.rest_positions(body).unwrap().unwrap();
        for (&new, &old) in fused.vertices.iter().zip(&piece.vertices) {
            assert_eq!(at[new as usize], positions[old as usize]);
            assert_eq!(all[new as usize], groups[old as usize]);
            assert_eq!(rests[new as usize], rest[old as usize]);
        }
        world.validate().unwrap();
    }
    assert_eq!(world.bodies().collect::<Vec<_>>(), [other, body]);
    assert_eq!(world.loose_box(body), Ok(everywhere));
    assert_eq!(
        found(&mut world, |_, triangle| names[triangle as usize]),
        before
    );
}

#[test]
fn a_body_that_ignores_itself_has_pieces_that_ignore_each_other() {
    let (triangles, positions) = sheets(&mut Lcg(3), &[4, 5, 6]);
    let mut world = World::<f32>::new();
    let body = world.add(&triangles, &positions).unwrap();
    world.ignore(body, body).unwrap();
    let pieces = world.split(body).unwrap();
    let all = [body, pieces[0].body, pieces[1].body];
    for a in all {
        for b in all {
            assert!(world.ignored().contains(&[a.min(b), a.max(b)]));
        }
    }
    assert!(found(&mut world, |_, it| it).is_empty());
}

#[test]
fn what_was_empty_comes_to_nothing() {
    let (triangles, positions) = sheet(4);
    let mut world = World::<f32>::new();
    let a = world.add(&triangles, &positions).unwrap();
    let b = world.add(&triangles, &positions).unwrap();
    let mut edit = world.edit(b).unwrap();
    let at_corner = |(_, it): &(u32, &[u32; 3])| it.contains(&0);
    let gone: Vec<u32> = (0..)
        .zip(&triangles)
        .filter(at_corner)
        .map(|(at, _)| at)
        .collect();
    edit.remove_triangles(&gone);
    world.apply(&edit).unwrap();
    let fused = world.fuse(a, b).unwrap();
    assert_eq!(fused.vertices[0], u32::MAX);
    for (triangle, &now) in (0..).zip(&fused.triangles) {
        assert_eq!(now == u32::MAX, gone.contains(&triangle));
    }
    assert!(world.live_vertices(a).unwrap().into_iter().all(|is| is));
    assert!(world.components(a).unwrap().iter().all(|&it| it < 2));
    let same = world.fuse(a, a).unwrap_err();
    assert_eq!((same.body, same.kind), (Some(a), ErrorKind::SameBody));
    assert_eq!(world.fuse(a, b).unwrap_err().kind, ErrorKind::NoSuchBody);
    assert_eq!(world.fuse(b, a).unwrap_err().kind, ErrorKind::NoSuchBody);
    assert_eq!(world.split(b).unwrap_err().kind, ErrorKind::NoSuchBody);
}

#[test]
fn what_was_cut_is_welded() {
    let (triangles, positions) = sheet(6);
    let mut world = World::<f32>::new();
    let body = world.add(&triangles, &positions).unwrap();
    // Cut along a line of vertices, and once off it: every vertex of the column splits.
    let is_left = |corners: &[u32; 3]| {
        let x = |vertex: &u32| positions[*vertex as usize][0];
        corners.iter().map(x).sum::<f32>() / 3.0 < 0.5
    };
    let column: Vec<u32> = (0..positions.len() as u32)
        .filter(|&vertex| {
            let has = |left: bool| {
                triangles
                    .iter()
                    .any(|it| it.contains(&vertex) && is_left(it) == left)
            };
            has(true) && has(false)
        })
        .collect();
    let mut edit = world.edit(body).unwrap();
    for &vertex in &column {
        let of_left = |(_, it): &(u32, &[u32; 3])| it.contains(&vertex) && is_left(it);
        let left: Vec<u32> = (0..)
            .zip(&triangles)
            .filter(of_left)
            .map(|(at, _)| at)
            .collect();
        edit.split_vertex(vertex, &left);
    }
    let edited = world.apply(&edit).unwrap();
    assert_eq!(edited.new_vertices.len(), column.len());
    assert_eq!(world.components(body).unwrap().iter().max(), Some(&1));
    assert!(
        !found(&mut world, |_, it| it).is_empty(),
        "the two sides touch"
    );

    // A little apart: welded at a tolerance equal to their distance.
    let mut apart = world.positions(body).unwrap();
    for &vertex in &edited.new_vertices {
        apart[vertex as usize][2] = 0.125;
    }
    world.set_positions(body, &apart).unwrap();
    assert_eq!(world.weld(body, 0.124).unwrap(), pliant::Edited::default());
    let welded = world.weld(body, 0.125).unwrap();
    assert_eq!(welded.removed_vertices, edited.new_vertices);
    assert_eq!(welded.changed_triangles, edited.changed_triangles);
    assert_eq!(world.triangles(body).unwrap(), triangles);
    assert!(world.components(body).unwrap().iter().all(|&it| it == 0));
    assert!(found(&mut world, |_, it| it).is_empty());
    world.validate().unwrap();
    for tolerance in [f64::NAN, f64::INFINITY, -0.1] {
        let refused = world.weld(body, tolerance).unwrap_err().kind;
        assert!(matches!(refused, ErrorKind::BadDistance { .. }));
    }
}

/// Two triangles of a square with sides `size`, whose common side is `off` apart.
fn nearly_joined(world: &mut World<f64>, off: [f64; 3], size: f64) -> pliant::BodyId {
    let [x, y, z] = off;
    let square = [
        [0.0; 3],
        [size, 0.0, 0.0],
        [size, size, 0.0],
        [x, y, z],
        [size + x, size + y, z],
        [0.0, size, 0.0],
    ];
    world.add(&[[0, 1, 2], [3, 4, 5]], &square).unwrap()
}

#[test]
fn the_tolerance_of_a_weld_is_exact_at_every_scale() {
    let mut world = World::<f64>::new();
    // Squares of these distances round to 0 or to the smallest number, which says nothing of them.
    let apart = nearly_joined(&mut world, [1.5e-162, 0.0, 0.0], 1e-160);
    assert_eq!(world.weld(apart, 0.0).unwrap(), pliant::Edited::default());
    assert_eq!(
        world.weld(apart, 1.4e-162).unwrap(),
        pliant::Edited::default()
    );
    let edited = world.weld(apart, 1.6e-162).unwrap();
    assert_eq!(edited.removed_vertices, [3, 4]);
    let u = f64::from_bits(1);
    for by in [
        u,
        1024.0 * u,
        2f64.powi(-500) * 2f64.powi(-30),
        2f64.powi(-60),
        1.0,
        2f64.powi(100),
    ] {
        let off = [2.0 * by, 3.0 * by, 6.0 * by];
        let body = nearly_joined(&mut world, off, 64.0 * by);
        let below = (7.0 * by).next_down();
        assert_eq!(
            world.weld(body, below).unwrap(),
            pliant::Edited::default(),
            "{by}"
        );
        let edited = world.weld(body, 7.0 * by).unwrap();
        assert_eq!(edited.removed_vertices, [3, 4], "{by}");
    }
}

/// An interrupted weld has changed nothing; if it is not interrupted, the question changes nothing.
#[test]
fn a_weld_can_be_interrupted() {
    let triangles: Vec<[u32; 3]> = (0..3_000)
        .map(|it| [3 * it, 3 * it + 1, 3 * it + 2])
        .collect();
    let positions = vec![[0.0_f32; 3]; 9_000];
    let mut world = World::<f32>::new();
    let body = world.add(&triangles, &positions).unwrap();
    let mut copy = world.clone();
    let expected = copy.weld(body, 0.0).unwrap();
    assert_eq!(expected.removed_vertices.len(), 8_997);
    let mut allowed = 0;
    loop {
        let looks = AtomicUsize::new(0);
        let question = || looks.fetch_add(1, Ordering::Relaxed) >= allowed;
        match world.interruptible(&question).weld(body, 0.0) {
            Ok(edited) => {
                assert_eq!(edited, expected);
                assert_eq!(
                    world.triangles(body).unwrap(),
                    copy.triangles(body).unwrap()
                );
                break;
            }
            Err(refused) => {
                assert_eq!((refused.body, refused.kind), (None, ErrorKind::Interrupted));
                assert_eq!(world.triangles(body).unwrap(), triangles);
            }
        }
        allowed += 1 + allowed / 8;
    }
    assert!(allowed > 100, "{allowed} looks are no test");
}
