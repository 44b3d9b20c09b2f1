//! A refused edit changes nothing: numbers, edges, groups, shape, motion, and what is found.
//!
//! That holds whatever good steps the edit had before the bad one.

use crate::common::sheet;
use pliant::{BodyId, EdgeEdge, Edit, ErrorKind as Kind, Selection, World};

/// A body in which vertex 0 and its triangles are empty.
struct Edited {
    world: World<f32>,
    body: BodyId,
    vertices: usize,
    /// Numbers of triangles that exist, and one number that is empty.
    live: Vec<u32>,
    empty: u32,
}

/// Everything that a refused edit must leave as it was.
#[derive(Clone, Debug, PartialEq)]
struct State {
    triangles: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
    live_vertices: Vec<bool>,
    groups: Vec<u32>,
    /// Positions at the end of the motion, without vertex 0, which is empty.
    end: Vec<[f32; 3]>,
    revision: u64,
    near: Vec<EdgeEdge>,
}

impl Edited {
    fn new() -> Self {
        let (triangles, positions) = sheet(4);
        let mut world = World::new();
        let body = world.add(&triangles, &positions).unwrap();
        let at_0 = |&at: &u32| triangles[at as usize].contains(&0);
        let (gone, live): (Vec<u32>, Vec<u32>) = (0..triangles.len() as u32).partition(at_0);
        let mut edit = world.edit(body).unwrap();
        edit.remove_triangles(&gone);
        let edited = world.apply(&edit).unwrap();
        assert_eq!(edited.removed_triangles, gone);
        assert_eq!(edited.removed_vertices, [0]);
        let again = world.apply(&edit).unwrap_err().kind;
        assert_eq!(again, Kind::OutdatedEdit, "an edit is made once");
        let up = |&[x, y, z]: &[f32; 3]| [x, y, z + 1.0];
        let end: Vec<[f32; 3]> = positions.iter().map(up).collect();
        world.set_motion(body, &end).unwrap();
        let groups: Vec<u32> = (0..positions.len() as u32).map(|it| it % 3).collect();
        world.set_vertex_groups(body, &groups).unwrap();
        Self {
            world,
            body,
            vertices: positions.len(),
            live,
            empty: gone[0],
        }
    }

    fn state(&mut self) -> State {
        let (world, body) = (&mut self.world, self.body);
        let near = world.edge_edge_candidates(Selection::Everything, 0.2);
        let near = near.all().unwrap().to_vec();
        assert!(!near.is_empty());
        State {
            triangles: world.triangles(body).unwrap().to_vec(),
            edges: world.edges(body).unwrap().to_vec(),
            live_vertices: world.live_vertices(body).unwrap(),
            groups: world.vertex_groups(body).unwrap(),
            end: world.end_positions(body).unwrap().unwrap().split_off(1),
            revision: world.mesh_revision(body).unwrap(),
            near,
        }
    }

    /// Asserts that these steps are refused, alone and behind good ones, and that nothing changed.
    fn refuses(&mut self, expected: &Kind, steps: impl Fn(&mut Edit<f32>)) {
        let before = self.state();
        let first = self.live[0];
        let corners = before.triangles[first as usize];
        for good_first in [false, true] {
            let mut edit = self.world.edit(self.body).unwrap();
            if good_first {
                edit.set_triangle(first, corners);
                edit.merge_vertices(corners[0], corners[0]);
            }
            steps(&mut edit);
            let refused = self.world.apply(&edit).unwrap_err();
            assert_eq!(refused.body, Some(self.body), "{expected:?}");
            // Compared as text, since NaN does not equal itself.
            assert_eq!(format!("{:?}", refused.kind), format!("{expected:?}"));
            assert!(refused.to_string().len() > 20);
        }
        assert_eq!(self.state(), before, "{expected:?}");
        self.world.validate().unwrap();
    }
}

#[test]
fn triangles_that_are_not_there() {
    let mut edited = Edited::new();
    let triangles = edited.state().triangles.len();
    let (many, [some, other]) = (triangles as u32, [edited.live[0], edited.live[1]]);
    let empty = Kind::EmptyTriangle {
        triangle: edited.empty,
    };
    for triangle in [many, u32::MAX] {
        let none = Kind::NoSuchTriangle {
            triangle,
            triangles,
        };
        edited.refuses(&none, |edit| edit.remove_triangle(triangle));
        edited.refuses(&none, |edit| edit.set_triangle(triangle, [1, 2, 3]));
        edited.refuses(&none, |edit| {
            edit.split_vertex(1, &[triangle]);
        });
    }
    let gone = edited.empty;
    edited.refuses(&empty, |edit| edit.remove_triangle(gone));
    edited.refuses(&empty, |edit| {
        edit.split_vertex(1, &[gone]);
    });
    let twice = Kind::EmptyTriangle { triangle: some };
    edited.refuses(&twice, |edit| edit.remove_triangles(&[some, some]));
    let all = edited.live.clone();
    edited.refuses(&Kind::NoTriangles, |edit| edit.remove_triangles(&all));
    let corners = edited.state().triangles[other as usize];
    let vertex = (1..9).find(|vertex| !corners.contains(vertex)).unwrap();
    let no_corner = Kind::NotACorner {
        triangle: other,
        vertex,
    };
    edited.refuses(&no_corner, |edit| {
        edit.split_vertex(vertex, &[other]);
    });
}

#[test]
fn vertices_that_are_not_there() {
    let mut edited = Edited::new();
    let (vertices, triangles) = (edited.vertices, edited.state().triangles.len());
    let (new, some) = (vertices as u32, edited.live[1]);
    for vertex in [new, u32::MAX] {
        let none = Kind::NoSuchVertex { vertex, vertices };
        edited.refuses(&none, |edit| {
            edit.split_vertex(vertex, &[]);
        });
        edited.refuses(&none, |edit| edit.merge_vertices(1, vertex));
        edited.refuses(&none, |edit| edit.merge_vertices(vertex, 1));
        edited.refuses(&none, |edit| edit.place_vertex(vertex, [0.0; 3]));
        let out_of_range = |triangle| Kind::VertexOutOfRange {
            triangle,
            vertex,
            vertices,
        };
        edited.refuses(&out_of_range(some as usize), |edit| {
            edit.set_triangle(some, [1, 2, vertex]);
        });
        edited.refuses(&out_of_range(triangles), |edit| {
            edit.add_triangle([1, vertex, 2]);
        });
    }
    let empty = Kind::EmptyVertex { vertex: 0 };
    edited.refuses(&empty, |edit| {
        edit.split_vertex(0, &[]);
    });
    edited.refuses(&empty, |edit| edit.merge_vertices(0, 1));
    edited.refuses(&empty, |edit| edit.merge_vertices(1, 0));
    edited.refuses(&empty, |edit| edit.set_triangle(some, [0, 1, 2]));
    edited.refuses(&empty, |edit| {
        edit.add_triangle([1, 2, 0]);
    });
    let used = Kind::VertexInUse { vertex: 1 };
    edited.refuses(&used, |edit| edit.place_vertex(1, [0.0; 3]));
}

#[test]
fn places_where_no_vertex_can_be() {
    let mut edited = Edited::new();
    let vertices = edited.vertices;
    for bad in [f32::NAN, f32::INFINITY] {
        let at = [bad, 0.0, 0.0];
        let refused = |vertex| Kind::BadPosition {
            vertex,
            position: at.map(f64::from),
        };
        edited.refuses(&refused(0), |edit| edit.place_vertex(0, at));
        edited.refuses(&refused(vertices), |edit| {
            edit.add_vertex(at);
        });
    }
    let everywhere = Some(([-9.0; 3], [9.0; 3]));
    let Edited { world, body, .. } = &mut edited;
    let shape: Vec<[f32; 3]> = world.positions(*body).unwrap();
    world.set_loose_box(*body, everywhere).unwrap();
    assert_eq!(shape.len(), vertices);
    let at = [0.0, 0.0, 9.5];
    let outside = Kind::OutsideLooseBox {
        vertex: vertices,
        position: at.map(f64::from),
    };
    edited.refuses(&outside, |edit| {
        let added = edit.add_vertex(at);
        edit.add_triangle([1, 2, added]);
    });
}

#[test]
fn edits_of_another_mesh_or_of_nobody() {
    let (triangles, positions) = sheet(4);
    let mut world = World::<f32>::new();
    let body = world.add(&triangles, &positions).unwrap();
    let early = world.edit(body).unwrap();
    world.set_mesh(body, &triangles[1..], &positions).unwrap();
    let refused = world.apply(&early).unwrap_err().kind;
    assert_eq!(refused, Kind::OutdatedEdit);
    // Another tree of the same mesh is no reason to refuse an edit.
    let mut edit = world.edit(body).unwrap();
    edit.remove_triangle(0);
    world.rebuild(body).unwrap();
    world.apply(&edit).unwrap();
    let edit = world.edit(body).unwrap();
    world.remove(body).unwrap();
    for refused in [
        world.apply(&edit).unwrap_err(),
        world.edit(body).unwrap_err(),
    ] {
        assert_eq!((refused.body, refused.kind), (Some(body), Kind::NoSuchBody));
    }
}

/// An edit belongs to the world that began it, and to no other, its clones included.
#[test]
fn edits_of_another_world() {
    let (triangles, positions) = sheet(4);
    let new = || {
        let mut world = World::<f32>::new();
        let body = world.add(&triangles, &positions).unwrap();
        (world, body)
    };
    let ((world, body), (mut other, same)) = (new(), new());
    assert_eq!(body, same);
    let mut edit = world.edit(body).unwrap();
    edit.remove_triangle(0);
    for other in [&mut other, &mut world.clone()] {
        let before = other.triangles(body).unwrap().to_vec();
        let refused = other.apply(&edit).unwrap_err();
        assert_eq!(
            (refused.body, &refused.kind),
            (Some(body), &Kind::OutdatedEdit)
        );
        assert!(refused.to_string().contains("another world"), "{refused}");
        assert_eq!(other.triangles(body).unwrap(), before);
        let own = other.edit(body).unwrap();
        other.apply(&own).unwrap();
    }
    let mut world = world;
    assert_eq!(world.apply(&edit).unwrap().removed_triangles, [0]);
}

/// A step that names what an earlier step of the same edit has emptied is refused, or does what it
/// says.
#[test]
fn what_an_earlier_step_has_emptied() {
    let mut edited = Edited::new();
    let corners = edited.world.triangles(edited.body).unwrap()[edited.live[0] as usize];
    let ([kept, gone, other], some) = (corners, edited.live[0]);
    let empty = Kind::EmptyVertex { vertex: gone };
    let steps: [&dyn Fn(&mut Edit<f32>); 5] = [
        &|edit| edit.merge_vertices(other, gone),
        &|edit| edit.merge_vertices(gone, other),
        &|edit| {
            edit.split_vertex(gone, &[some]);
        },
        &|edit| edit.set_triangle(some, [kept, gone, other]),
        &|edit| {
            edit.add_triangle([kept, gone, other]);
        },
    ];
    for step in steps {
        edited.refuses(&empty, |edit| {
            edit.merge_vertices(kept, gone);
            step(edit);
        });
    }
    // A vertex that lost its last triangle is empty only at the end, and can get others until then.
    let used = Kind::VertexInUse { vertex: 1 };
    let triangles = edited.world.triangles(edited.body).unwrap().to_vec();
    let at_1 = (0..).zip(&triangles).filter(|(_, it)| it.contains(&1));
    let at_1: Vec<u32> = at_1.map(|(at, _)| at).collect();
    assert!(!at_1.is_empty() && at_1.len() < edited.live.len());
    edited.refuses(&used, |edit| {
        edit.remove_triangles(&at_1);
        edit.place_vertex(1, [0.0; 3]);
    });
    let twice = Kind::VertexInUse { vertex: gone };
    edited.refuses(&twice, |edit| {
        edit.merge_vertices(kept, gone);
        edit.place_vertex(gone, [0.0; 3]);
        edit.place_vertex(gone, [1.0; 3]);
    });
    let removed = Kind::EmptyTriangle { triangle: some };
    edited.refuses(&removed, |edit| {
        edit.remove_triangle(some);
        edit.split_vertex(kept, &[some]);
    });
    edited.refuses(&removed, |edit| {
        edit.remove_triangle(some);
        edit.remove_triangle(some);
    });
    let replaced = Kind::NotACorner {
        triangle: some,
        vertex: gone,
    };
    edited.refuses(&replaced, |edit| {
        edit.set_triangle(some, [kept, other, other]);
        edit.split_vertex(gone, &[some]);
    });
}

/// A vertex that was merged away and then placed is where it was placed, with or without a
/// triangle.
#[test]
fn a_vertex_is_placed_after_it_was_merged_away() {
    for with_triangle in [false, true] {
        let mut edited = Edited::new();
        let Edited {
            world, body, live, ..
        } = &mut edited;
        let body = *body;
        let [kept, gone, other] = world.triangles(body).unwrap()[live[0] as usize];
        let at = [0.25, 0.5, 4.0];
        let mut edit = world.edit(body).unwrap();
        edit.merge_vertices(kept, gone);
        edit.place_vertex(gone, at);
        if with_triangle {
            edit.add_triangle([kept, gone, other]);
        }
        let outcome = world.apply(&edit).unwrap();
        assert_eq!(
            (outcome.new_vertices, outcome.removed_vertices),
            (vec![gone], vec![])
        );
        assert!(world.live_vertices(body).unwrap()[gone as usize]);
        assert_eq!(world.positions(body).unwrap()[gone as usize], at);
        assert_eq!(world.vertex_groups(body).unwrap()[gone as usize], 0);
        world.validate().unwrap();
        // The next edit can use it, and it goes with its last triangle.
        let mut edit = world.edit(body).unwrap();
        let added = edit.add_triangle([kept, gone, other]);
        world.apply(&edit).unwrap();
        let mut edit = world.edit(body).unwrap();
        let first = added - u32::from(with_triangle);
        edit.remove_triangles(&(first..=added).collect::<Vec<_>>());
        assert_eq!(world.apply(&edit).unwrap().removed_vertices, [gone]);
        world.validate().unwrap();
        // Merged away, placed, and merged away: it is gone.
        let mut edit = world.edit(body).unwrap();
        edit.place_vertex(gone, at);
        edit.merge_vertices(kept, gone);
        let outcome = world.apply(&edit).unwrap();
        assert_eq!(
            (outcome.new_vertices, outcome.removed_vertices),
            (vec![], vec![])
        );
        assert!(!world.live_vertices(body).unwrap()[gone as usize]);
        // With a triangle in between that is removed again, it goes with the triangle.
        let mut edit = world.edit(body).unwrap();
        edit.merge_vertices(kept, other);
        edit.place_vertex(other, at);
        let added = edit.add_triangle([kept, other, kept]);
        edit.remove_triangle(added);
        assert_eq!(world.apply(&edit).unwrap().removed_vertices, [other]);
        world.validate().unwrap();
    }
}

/// A vertex inherits the group of the vertex that it was split from.
///
/// That holds whatever becomes of the other's number later.
#[test]
fn a_group_outlives_the_number_that_it_was_taken_from() {
    let mut edited = Edited::new();
    let Edited {
        world, body, live, ..
    } = &mut edited;
    let body = *body;
    let corners = world.triangles(body).unwrap()[live[0] as usize];
    let groups = world.vertex_groups(body).unwrap();
    let from = corners.into_iter().find(|&it| groups[it as usize] != 0);
    let from = from.expect("groups are three in turns");
    let kept = corners.into_iter().find(|&it| it != from).unwrap();
    let group = groups[from as usize];
    let mut edit = world.edit(body).unwrap();
    let split = edit.split_vertex(from, &[live[0]]);
    let again = edit.split_vertex(split, &[live[0]]);
    edit.merge_vertices(kept, from);
    edit.place_vertex(from, [0.5; 3]);
    let of_placed = edit.split_vertex(from, &[]);
    world.apply(&edit).unwrap();
    let groups = world.vertex_groups(body).unwrap();
    let found = [split, again, from, of_placed].map(|it| groups[it as usize]);
    assert_eq!(found, [group, group, 0, 0]);
    world.validate().unwrap();
}

/// A loose box does not have to hold vertices that an edit has emptied.
///
/// They count neither at the start of a motion nor at its end.
#[test]
fn a_loose_box_is_round_what_is_there() {
    let far = [9.0, 9.0, 9.0];
    let shape = [
        [0.0; 3],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        far,
        [7.0, 0.0, 0.0],
    ];
    let around = Some(([-1.0; 3], [2.0; 3]));
    let mut world = World::<f32>::new();
    let body = world.add(&[[0, 1, 2], [0, 1, 3]], &shape).unwrap();
    let outside = |world: &mut World<f32>| match world.set_loose_box(body, around) {
        Err(refused) => match refused.kind {
            Kind::OutsideLooseBox { vertex, position } => Some((vertex, position)),
            other => panic!("{other}"),
        },
        Ok(()) => None,
    };
    assert_eq!(outside(&mut world), Some((3, [9.0; 3])));
    let mut edit = world.edit(body).unwrap();
    edit.remove_triangle(1);
    world.apply(&edit).unwrap();
    // A vertex without a triangle that no edit has emptied exists, and its position counts.
    assert_eq!(outside(&mut world), Some((4, [7.0, 0.0, 0.0])));
    let mut edit = world.edit(body).unwrap();
    edit.merge_vertices(0, 4);
    world.apply(&edit).unwrap();
    let up = shape.map(|[x, y, z]| [x, y, z + 1.5]);
    world.set_motion(body, &up).unwrap();
    assert_eq!(outside(&mut world), None);
    world.set_loose_box(body, None).unwrap();
    let higher = shape.map(|[x, y, z]| [x, y, z + 2.5]);
    world.set_motion(body, &higher).unwrap();
    assert_eq!(outside(&mut world), Some((0, [0.0, 0.0, 2.5])));
    // Nor do they count at rest or in a clone.
    world.finish_motion();
    world.set_positions(body, &shape).unwrap();
    assert_eq!(outside(&mut world), None);
    assert_eq!(outside(&mut world.clone()), None);
    let mut edit = world.edit(body).unwrap();
    edit.place_vertex(3, [3.0; 3]);
    assert!(matches!(
        world.apply(&edit).unwrap_err().kind,
        Kind::OutsideLooseBox { vertex: 3, .. }
    ));
}

/// A vertex that goes and comes again within one edit is new; one that comes and goes never was.
#[test]
fn within_one_edit_numbers_go_and_come() {
    let mut edited = Edited::new();
    let Edited {
        world, body, live, ..
    } = &mut edited;
    let corners = world.triangles(*body).unwrap()[live[0] as usize];
    let mut edit = world.edit(*body).unwrap();
    edit.place_vertex(0, [0.5, 0.5, 2.0]);
    let new = edit.add_vertex([0.5, 0.5, 3.0]);
    let added = edit.add_triangle([0, corners[0], new]);
    edit.remove_triangle(added);
    let outcome = world.apply(&edit).unwrap();
    assert!(outcome.new_triangles.is_empty());
    assert!(outcome.removed_triangles.is_empty());
    assert!(!world.live_triangles(*body).unwrap()[added as usize]);
    world.validate().unwrap();

    // A vertex that comes, goes and comes again comes once.
    let before = world.vertex_count(*body).unwrap();
    world.set_vertex_groups(*body, &vec![7; before]).unwrap();
    let mut edit = world.edit(*body).unwrap();
    let new = edit.split_vertex(corners[0], &[live[0]]);
    edit.merge_vertices(corners[1], new);
    edit.place_vertex(new, [0.5, 0.5, 4.0]);
    let again = edit.add_triangle([corners[0], corners[1], new]);
    let outcome = world.apply(&edit).unwrap();
    assert_eq!(outcome.new_vertices, [new]);
    assert_eq!(outcome.new_triangles, [again]);
    assert_eq!(world.vertex_count(*body).unwrap(), before + 1);
    assert_eq!(world.positions(*body).unwrap()[before], [0.5, 0.5, 4.0]);
    assert_eq!(world.vertex_groups(*body).unwrap()[before], 0);
    world.validate().unwrap();
}
