//! Adjacent contacts: every configuration gives the contacts of the reference.
//!
//! Stars are crumpled, wound round their vertex more than once, folded flat, and of every size.
//! Meshes have triangles that are there twice, degenerate, or turned against each other.

use crate::common::{Lcg, covering_configurations, world_of};
use pliant::{
    AdjacentContact, ContactKind, ErrorKind, Options, Scalar, Selection, World, reference,
};
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;

type Mesh = (Vec<[u32; 3]>, Vec<[f64; 3]>);

/// Fan of `count` triangles at vertex 0, closed or open, with its outline at `at`.
fn fan(count: u32, is_closed: bool, apex: [f64; 3], at: impl FnMut(u32) -> [f64; 3]) -> Mesh {
    let ends = if is_closed { count } else { count + 1 };
    let triangles = (0..count).map(|i| [0, 1 + i, 1 + (i + 1) % ends]).collect();
    let positions = std::iter::once(apex).chain((0..ends).map(at)).collect();
    (triangles, positions)
}

/// Stars of one vertex: crumpled, or wound round it any number of times, on a lattice or not.
fn stars(random: &mut Lcg) -> Vec<Mesh> {
    let mut stars = Vec::new();
    for round in 0..400 {
        let (count, is_closed) = (2 + round / 2 % 9, round % 2 == 0);
        let apex = [0.0, 0.0, f64::from(random.below(3))];
        let lattice = 1 + random.below(6);
        stars.push(fan(count, is_closed, apex, |_| {
            [0, 1, 2].map(|_| f64::from(random.below(2 * lattice + 1)) - f64::from(lattice))
        }));
        // Whole turns meet themselves where the fan closes. Of open ones some only look so from
        // above, and some end exactly where they began.
        let turns = [0.3, 0.5, 0.9, 1.0, 1.1, 1.6, 2.0, 2.8][round as usize / 2 % 8];
        let turns = if is_closed {
            f64::round(turns + 0.2).max(1.0)
        } else {
            turns
        };
        let [height, tilt] = [0, 1].map(|_| f64::from(random.below(3)) / 4.0);
        let exact = round % 3 == 0;
        let first = f64::from(random.below(4)) / 4.0;
        stars.push(fan(count, is_closed, [0.0; 3], |i| {
            let part = f64::from(i) / f64::from(count);
            let angle = TAU * (turns * part + first);
            let [x, y] = [angle.cos(), angle.sin()];
            let point = [x, y + tilt * x, height * part + tilt * y];
            // Snapped to a lattice, and not.
            point.map(|x| if exact { (x * 8.0).round() / 8.0 } else { x })
        }));
    }
    stars
}

/// Meshes with many triangles at few vertices, on a small lattice.
fn heaps(random: &mut Lcg) -> Vec<Mesh> {
    let mut heaps = Vec::new();
    for round in 0..60 {
        let (vertices, size) = (4 + random.below(8), 2 + round % 4);
        let triangles = (0..5 + random.below(20))
            .map(|_| [0, 1, 2].map(|_| random.below(vertices)))
            .collect();
        let positions = (0..vertices)
            .map(|_| [0, 1, 2].map(|_| f64::from(random.below(size))))
            .collect();
        heaps.push((triangles, positions));
    }
    heaps
}

/// A sheet that is crumpled by this much, in lengths of an edge.
fn sheet(squares: u32, crumpled: f64, random: &mut Lcg) -> Mesh {
    let across = squares + 1;
    let corners = |i: u32| {
        let low = i / squares * across + i % squares;
        let high = low + across;
        [[low, low + 1, high + 1], [low, high + 1, high]]
    };
    let triangles = (0..squares * squares).flat_map(corners).collect();
    let mut noise = || crumpled * (f64::from(random.unit()) - 0.5);
    let positions = (0..across * across)
        .map(|i| [f64::from(i % across), f64::from(i / across), 0.0].map(|x| x + noise()))
        .collect();
    (triangles, positions)
}

type Row = ([u32; 2], ContactKind);

fn rows(contacts: &[AdjacentContact]) -> Vec<Row> {
    let row = |it: &AdjacentContact| (it.pair.triangles(), it.kind);
    contacts.iter().map(row).collect()
}

/// Compares every way to ask about one body with the reference.
fn check<S: Scalar>(world: &mut World<S>, of: Selection, expected: &[Row]) {
    let what = |world: &World<S>| {
        let Selection::Within(body) = of else {
            panic!("one body")
        };
        format!("{:?} {:?}", world.triangles(body), world.positions(body))
    };
    let found = rows(world.adjacent_intersections(of).all().unwrap());
    assert_eq!(found, expected, "{}", what(world));
    assert_eq!(world.statistics().pairs, expected.len() as u64);
    for kind in [
        ContactKind::Touching,
        ContactKind::Overlapping,
        ContactKind::Crossing,
    ] {
        let of_kind: Vec<_> = expected.iter().copied().filter(|it| it.1 == kind).collect();
        let query = world.adjacent_intersections(of).only(kind);
        assert_eq!(rows(query.all().unwrap()), of_kind);
        let first = world.adjacent_intersections(of).only(kind).first().unwrap();
        assert_eq!(first.is_some(), !of_kind.is_empty());
        assert!(first.is_none_or(|first| of_kind.contains(&rows(&[first])[0])));
        let mut seen = BTreeSet::new();
        let visited = world
            .adjacent_intersections(of)
            .only(kind)
            .visit(|contact| {
                assert!(seen.insert(contact.pair.triangles()));
                ControlFlow::<()>::Continue(())
            });
        assert!(visited.unwrap().is_continue());
        assert!(seen.iter().eq(of_kind.iter().map(|it| &it.0)));
    }
    if let Some(fewer) = expected.len().checked_sub(1) {
        assert!(
            world
                .adjacent_intersections(of)
                .at_most(fewer)
                .all()
                .is_err()
        );
    }
}

/// Compares meshes of one kind with the reference, each in one place and size.
fn check_meshes<S: Scalar>(meshes: &[Mesh], of: impl Fn(f64) -> S) {
    let mut world = World::<S>::new();
    let mut kinds = [0; 3];
    for (triangles, positions) in meshes {
        let positions: Vec<_> = positions.iter().map(|point| point.map(&of)).collect();
        let expected = reference::adjacent_contacts(triangles, &positions).unwrap();
        for (_, kind) in &expected {
            kinds[*kind as usize] += 1;
        }
        let body = world.add(triangles, &positions).unwrap();
        check(&mut world, Selection::Within(body), &expected);
        world.remove(body).unwrap();
    }
    assert!(kinds.iter().all(|&count| count > 10), "{kinds:?}");
}

#[test]
fn stars_of_every_form_are_those_of_the_reference() {
    let stars = stars(&mut Lcg(1));
    for exponent in [0, -70, -118, 60, 120] {
        let scale = 2_f64.powi(exponent);
        check_meshes(&stars, |x| (x * scale) as f32);
        check_meshes(&stars, |x| {
            x * scale + if exponent == 0 { 1e3 } else { 0.0 }
        });
    }
}

#[test]
fn heaps_of_triangles_are_those_of_the_reference() {
    let heaps = heaps(&mut Lcg(2));
    check_meshes(&heaps, |x| x as f32);
    check_meshes(&heaps, |x| 0.1 * x);
}

/// On several threads, in every configuration, and with more vertices than one job takes.
#[test]
fn every_configuration_gives_the_same_contacts() {
    let mut random = Lcg(3);
    let bodies: Vec<_> = [0.0, 0.5, 3.0]
        .map(|crumpled| sheet(20, crumpled, &mut random))
        .into_iter()
        .chain(heaps(&mut random))
        .collect();
    let expected = bodies
        .iter()
        .map(|(triangles, positions)| reference::adjacent_contacts(triangles, positions).unwrap());
    let expected: Vec<_> = expected.collect();
    assert!(expected[0].is_empty() && expected[2].len() > 100);
    let all: Vec<_> = bodies.iter().map(|(t, p)| (&t[..], p.clone())).collect();
    for (number, mut options) in covering_configurations().into_iter().enumerate() {
        options.threads = NonZeroUsize::new([1, 3][number % 2]).unwrap();
        let (mut world, ids) = world_of(options, &all);
        let found = world
            .adjacent_intersections(Selection::Everything)
            .all()
            .unwrap();
        let found: Vec<_> = found
            .iter()
            .map(|it| (it.pair.body_a, rows(&[*it])[0]))
            .collect();
        let of_all = ids.iter().zip(&expected);
        let of_all = of_all.flat_map(|(&id, rows)| rows.iter().map(move |&row| (id, row)));
        assert!(found.iter().copied().eq(of_all));
        for place in [0, 1, 2] {
            check(&mut world, Selection::Within(ids[place]), &expected[place]);
        }
        let ignored = ids[2];
        world.ignore(ignored, ignored).unwrap();
        let rest = world
            .adjacent_intersections(Selection::Everything)
            .all()
            .unwrap();
        assert_eq!(rest.len(), found.len() - expected[2].len());
        for of in [Selection::World, Selection::Between(ids[1], ids[2])] {
            assert!(world.adjacent_intersections(of).all().unwrap().is_empty());
        }
    }
}

/// A large sheet is cut into runs of triangles, whose vertices belong to one run or another.
#[test]
fn many_threads_count_as_one_does() {
    let mesh = sheet(150, 1.2, &mut Lcg(4));
    let lists = [1, 2, 5].map(|threads| {
        let mut options = Options::default();
        options.threads = NonZeroUsize::new(threads).unwrap();
        let mut world = World::<f64>::with_options(options);
        let body = world.add(&mesh.0, &mesh.1).unwrap();
        let found = world
            .adjacent_intersections(Selection::Within(body))
            .all()
            .unwrap();
        let found = rows(found);
        (found, *world.statistics())
    });
    assert!(lists[0].0.len() > 1_000);
    assert!(lists.iter().all(|it| *it == lists[0]));
    let (_, statistics) = &lists[0];
    // Most stars are free at a look.
    assert!(statistics.candidate_pairs < 15 * 22_500, "{statistics:?}");
}

/// Stars of many triangles that are no fan: two fans at one vertex, and triangles that go anywhere.
#[test]
fn large_stars_are_searched_and_not_gone_through() {
    // An hourglass.
    let half = |turned: f64, count: u32| {
        fan(count, true, [0.0; 3], move |i| {
            let angle = TAU * f64::from(i) / f64::from(count);
            [angle.cos(), angle.sin(), turned]
        })
    };
    let both = |count: u32, heights: [f64; 2]| -> Mesh {
        let [(mut triangles, mut positions), (more, at)] = heights.map(|z| half(z, count));
        let moved = |corner: u32| if corner == 0 { 0 } else { corner + count };
        triangles.extend(more.iter().map(|corners| corners.map(moved)));
        positions.extend(&at[1..]);
        (triangles, positions)
    };
    let mut world = World::<f64>::new();
    let (triangles, positions) = both(20_000, [1.0, -1.0]);
    let body = world.add(&triangles, &positions).unwrap();
    let of = Selection::Within(body);
    assert!(world.adjacent_intersections(of).all().unwrap().is_empty());
    let candidates = world.statistics().candidate_pairs;
    assert!(candidates < 400_000, "{candidates}");

    // In each other, and heaps of triangles with one vertex in common, some there twice.
    let mut random = Lcg(5);
    let mut stars = vec![both(50, [1.0, 1.0]), both(40, [1.0, 0.9])];
    for size in [3, 9, 1_000] {
        let (mut triangles, mut positions) = (Vec::new(), vec![[0.0; 3]]);
        for _ in 0..90 {
            let first = positions.len() as u32;
            triangles.push([0, first, first + 1]);
            let mut point =
                || [0, 1, 2].map(|_| f64::from(random.below(2 * size + 1)) - f64::from(size));
            positions.extend([point(), point()]);
        }
        triangles.extend_from_within(..5);
        stars.push((triangles, positions));
    }
    check_meshes(&stars, |x| x);
}

/// A triangle that is there very often: the list is refused before it fills the memory.
#[test]
fn very_many_contacts_at_one_vertex_are_refused() {
    let mut world = World::<f32>::new();
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let body = world.add(&vec![[0, 1, 2]; 100_000], &corners).unwrap();
    let of = Selection::Within(body);
    let refused = world.adjacent_intersections(of).at_most(1_000_000).all();
    assert!(matches!(
        refused.unwrap_err().kind,
        ErrorKind::TooManyHits { .. }
    ));
    let mut seen = 0;
    let stopped = world.adjacent_intersections(of).visit(|contact| {
        seen += 1;
        assert_eq!(contact.kind, ContactKind::Overlapping);
        if seen < 1_000_000 {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    });
    assert!(stopped.unwrap().is_break());
}

/// Fans of any number of triangles; what is no fan is decided pair by pair.
#[test]
fn large_fans_take_little_time() {
    for count in [15, 16, 20_000] {
        let mut world = World::<f64>::new();
        let (triangles, positions) = fan(count, true, [0.0; 3], |i| {
            let angle = TAU * f64::from(i) / f64::from(count);
            [angle.cos(), angle.sin(), 1.0 + 0.1 * (5.0 * angle).sin()]
        });
        let body = world.add(&triangles, &positions).unwrap();
        let of = Selection::Within(body);
        assert!(world.adjacent_intersections(of).all().unwrap().is_empty());
        assert_eq!(world.statistics().candidate_pairs, 0);
    }
}
