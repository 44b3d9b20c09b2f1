//! Changes of lists, against a model that gives every triangle that ever was a name of its own.

use crate::common::{Lcg, sheet};
use pliant::{
    AdjacentContact, BodyId, Changed, Changes, Contact, CrossingEdge, EdgeEdge, Pair, Selection,
    VertexTriangle, World,
};
use std::collections::{BTreeMap, BTreeSet};

/// Names of all triangles and vertices, by body and number; a name is never given twice.
#[derive(Default)]
struct Names {
    triangles: BTreeMap<(BodyId, u32), u64>,
    vertices: BTreeMap<(BodyId, u32), u64>,
    next: u64,
}

impl Names {
    fn add(&mut self, world: &World<f32>, body: BodyId) {
        let live = world.live_triangles(body).unwrap();
        for (number, _) in (0..).zip(live).filter(|&(_, is_live)| is_live) {
            self.triangles.insert((body, number), self.next);
            self.next += 1;
        }
        for number in 0..world.vertex_count(body).unwrap() as u32 {
            self.vertices.insert((body, number), self.next);
            self.next += 1;
        }
    }
}

/// Numbers that hits had by the names of their things, and that they have by [`Changes`].
#[derive(Default)]
struct Model {
    now: BTreeMap<[u64; 2], u64>,
    given: BTreeSet<u64>,
}

impl Model {
    /// Compares what changes say with what the names say.
    fn check(&mut self, listed: &[[u64; 2]], changed: &Changed) {
        let Changed {
            numbers,
            began,
            ended,
        } = *changed;
        assert_eq!(listed.len(), numbers.len());
        let mut now = BTreeMap::new();
        for (place, (&names, &number)) in listed.iter().zip(numbers).enumerate() {
            match self.now.get(&names) {
                Some(&before) => assert_eq!(number, before),
                None => assert!(self.given.insert(number), "{number} was given before"),
            }
            let is_new = !self.now.contains_key(&names);
            assert_eq!(began.binary_search(&place).is_ok(), is_new);
            now.insert(names, number);
        }
        let gone = self
            .now
            .iter()
            .filter(|(names, _)| !now.contains_key(*names));
        let gone: BTreeSet<u64> = gone.map(|(_, &number)| number).collect();
        assert!(ended.is_sorted_by_key(|ended| ended.things));
        let ended: BTreeSet<u64> = ended.iter().map(|ended| ended.number).collect();
        assert_eq!(gone, ended);
        self.now = now;
    }
}

/// Changes of four lists, each with its model.
#[derive(Default)]
struct Followed {
    pairs: (Changes<Pair>, Model),
    near: (Changes<VertexTriangle>, Model),
    contacts: (Changes<Contact>, Model),
    adjacent: (Changes<AdjacentContact>, Model),
}

/// Tells all changes of an edit.
macro_rules! tell {
    ($followed:expr, $method:ident($($argument:expr),*)) => {
        $followed.pairs.0.$method($($argument),*);
        $followed.near.0.$method($($argument),*);
        $followed.contacts.0.$method($($argument),*);
        $followed.adjacent.0.$method($($argument),*);
    };
}

/// A world whose bodies are edited, the names of what is in it, and what follows its lists.
struct Life {
    world: World<f32>,
    names: Names,
    followed: Followed,
    random: Lcg,
    /// Triangles that were removed since the last lists, and their corners.
    removed: Vec<(BodyId, u32, [u32; 3])>,
    edits: usize,
    again: usize,
    persisting: usize,
    /// Persisting pairs that share a vertex.
    adjacent: usize,
}

impl Life {
    fn move_all(&mut self) {
        for body in self.world.bodies().collect::<Vec<_>>() {
            let mut shape = self.world.positions(body).unwrap();
            for position in &mut shape {
                position[2] = 0.7 * position[2] + 0.2 * self.random.unit() - 0.1;
            }
            self.world.set_positions(body, &shape).unwrap();
        }
    }

    fn any(&mut self, bodies: &[BodyId]) -> BodyId {
        bodies[self.random.below(bodies.len() as u32) as usize]
    }

    fn edit_one(&mut self) {
        let bodies: Vec<BodyId> = self.world.bodies().collect();
        let body = self.any(&bodies);
        match self.random.below(6) {
            0 | 1 => self.remove_some(body),
            2 | 3 => {
                self.remove_some(body);
                self.use_numbers_again();
            }
            4 => self.split(body),
            _ => {
                let other = self.any(&bodies);
                if other != body {
                    self.fuse(body, other);
                }
            }
        }
    }

    fn remove_some(&mut self, body: BodyId) {
        let live = self.world.live_triangles(body).unwrap();
        let live = (0_u32..).zip(live).filter(|&(_, is_live)| is_live);
        let live: Vec<u32> = live.map(|(number, _)| number).collect();
        let mut some = live.clone();
        some.retain(|_| self.random.below(9) == 0);
        if some.is_empty() || some.len() == live.len() {
            return;
        }
        let corners = self.world.triangles(body).unwrap();
        let removed = some.iter();
        let removed = removed.map(|&number| (body, number, corners[number as usize]));
        self.removed = removed.collect();
        let mut edit = self.world.edit(body).unwrap();
        edit.remove_triangles(&some);
        let edited = self.world.apply(&edit).unwrap();
        for &number in &edited.removed_triangles {
            self.names.triangles.remove(&(body, number));
        }
        for &number in &edited.removed_vertices {
            self.names.vertices.remove(&(body, number));
        }
        tell!(self.followed, edited(body, &edited));
        self.edits += 1;
    }

    /// Puts another triangle, in the place of one that was just removed, under its number.
    fn use_numbers_again(&mut self) {
        for (body, empty, corners) in std::mem::take(&mut self.removed) {
            let mut edit = self.world.edit(body).unwrap();
            edit.set_triangle(empty, corners);
            // Corners may have gone with their last triangle.
            let Ok(edited) = self.world.apply(&edit) else {
                continue;
            };
            assert_eq!(edited.new_triangles, [empty]);
            let name = self.names.next;
            self.names.triangles.insert((body, empty), name);
            self.names.next += 1;
            tell!(self.followed, edited(body, &edited));
            self.edits += 1;
            self.again += 1;
        }
    }

    fn split(&mut self, body: BodyId) {
        let pieces = self.world.split(body).unwrap();
        for piece in &pieces {
            let Names {
                triangles,
                vertices,
                ..
            } = &mut self.names;
            for (names, old) in [(triangles, &piece.triangles), (vertices, &piece.vertices)] {
                for (new, &old) in (0..).zip(old) {
                    let name = names.remove(&(body, old)).unwrap();
                    names.insert((piece.body, new), name);
                }
            }
        }
        tell!(self.followed, split(body, &pieces));
        self.edits += pieces.len();
    }

    fn fuse(&mut self, kept: BodyId, gone: BodyId) {
        let fused = self.world.fuse(kept, gone).unwrap();
        let Names {
            triangles,
            vertices,
            ..
        } = &mut self.names;
        for (names, new) in [(triangles, &fused.triangles), (vertices, &fused.vertices)] {
            for (old, &new) in (0..).zip(new) {
                if let Some(name) = names.remove(&(gone, old)) {
                    names.insert((kept, new), name);
                }
            }
        }
        tell!(self.followed, fused(kept, gone, &fused));
        self.edits += 1;
    }

    /// Asks for all lists, and compares what changed.
    fn see(&mut self) {
        let (of, names) = (Selection::Everything, &self.names);
        let triangle = |body, number| names.triangles[&(body, number)];
        let named = |pair: &Pair| {
            let a = triangle(pair.body_a, pair.triangle_a);
            let b = triangle(pair.body_b, pair.triangle_b);
            [a.min(b), a.max(b)]
        };
        let Followed {
            pairs,
            near,
            contacts,
            adjacent,
        } = &mut self.followed;

        let listed = self.world.intersections(of).all().unwrap();
        let of_names: Vec<_> = listed.iter().map(named).collect();
        let changed = pairs.0.update(listed);
        self.persisting += listed.len() - changed.began.len();
        pairs.1.check(&of_names, &changed);

        // In any order.
        let mut listed = self.world.contacts(of).all().unwrap().to_vec();
        listed.reverse();
        let of_names: Vec<_> = listed.iter().map(|contact| named(&contact.pair)).collect();
        contacts.1.check(&of_names, &contacts.0.update(&listed));

        let listed = self.world.adjacent_intersections(of).all().unwrap();
        let of_names: Vec<_> = listed.iter().map(|contact| named(&contact.pair)).collect();
        let changed = adjacent.0.update(listed);
        self.adjacent += listed.len() - changed.began.len();
        adjacent.1.check(&of_names, &changed);

        let listed = self.world.vertex_triangle_candidates(of, 0.02).all();
        let listed = listed.unwrap();
        let named = |hit: &VertexTriangle| {
            let vertex = names.vertices[&(hit.vertex_body, hit.vertex)];
            [vertex, triangle(hit.triangle_body, hit.triangle)]
        };
        let of_names: Vec<_> = listed.iter().map(named).collect();
        near.1.check(&of_names, &near.0.update(listed));
    }
}

/// Two sheets through each other that are torn, filled, split and fused while they move.
#[test]
fn numbers_stay_through_lives_with_edits() {
    let (mut edits, mut again, mut persisting, mut adjacent) = (0, 0, 0, 0);
    for seed in 0..12 {
        let mut life = Life {
            world: World::new(),
            names: Names::default(),
            followed: Followed::default(),
            random: Lcg(seed),
            removed: Vec::new(),
            edits: 0,
            again: 0,
            persisting: 0,
            adjacent: 0,
        };
        let (triangles, mut flat) = sheet(9);
        // Neighbours that change places fold what is round them.
        flat.swap(44, 45);
        for _ in 0..2 {
            let body = life.world.add(&triangles, &flat).unwrap();
            life.names.add(&life.world, body);
        }
        for _ in 0..40 {
            life.move_all();
            life.edit_one();
            life.see();
        }
        edits += life.edits;
        again += life.again;
        persisting += life.persisting;
        adjacent += life.adjacent;
    }
    let is_much = edits > 100 && again > 100 && persisting > 1_000 && adjacent > 100;
    assert!(is_much, "{edits} {again} {persisting} {adjacent}");
}

#[test]
fn a_list_is_a_set_and_both_orders_of_a_pair_are_one() {
    let pair = |[body_a, triangle_a, body_b, triangle_b]: [u32; 4]| Pair {
        body_a: BodyId(body_a),
        triangle_a,
        body_b: BodyId(body_b),
        triangle_b,
    };
    let mut changes = Changes::new();
    let [a, b, c] = [[0, 5, 1, 2], [0, 5, 1, 3], [1, 0, 1, 9]].map(pair);
    let changed = changes.update(&[b, a, b]);
    assert_eq!(
        (changed.numbers, changed.began),
        (&[1, 0, 1][..], &[0, 1][..])
    );
    let swapped = pair([1, 2, 0, 5]);
    let changed = changes.update(&[swapped, c]);
    assert_eq!((changed.numbers, changed.began), (&[0, 2][..], &[1][..]));
    assert_eq!(changed.ended[0].number, 1);
    assert_eq!(changed.ended[0].things, [(BodyId(0), 5), (BodyId(1), 3)]);
    assert_eq!(changes.update(&[]).ended.len(), 2);
    assert_eq!(changes.update(&[a]).numbers, [3]);
}

/// Numbers of edges are renamed by the caller, who has the edges before and after.
#[test]
fn edges_are_followed_by_their_ends() {
    let body = BodyId(0);
    let hit = |edge_a, edge_b| EdgeEdge {
        body_a: body,
        edge_a,
        body_b: BodyId(1),
        edge_b,
    };
    let (before, after) = ([[0, 1], [1, 2]], [[0, 1], [2, 3]]);
    let mut changes = Changes::new();
    changes.update(&[hit(0, 7), hit(1, 7)]);
    changes.follow(|_, of, edge| {
        let place = edge as usize;
        let is_same = of != body || before.get(place) == after.get(place);
        is_same.then_some((of, edge))
    });
    let changed = changes.update(&[hit(0, 7), hit(1, 7)]);
    assert_eq!((changed.numbers, changed.began), (&[0, 2][..], &[1][..]));
    assert_eq!(changed.ended[0].number, 1);

    // An edge is no triangle, whatever its number.
    let crossing = |edge, triangle| CrossingEdge {
        edge_body: body,
        edge,
        triangle_body: body,
        triangle,
    };
    let mut changes = Changes::new();
    changes.update(&[crossing(1, 2)]);
    assert_eq!(changes.update(&[crossing(2, 1), crossing(1, 2)]).began, [0]);
}
