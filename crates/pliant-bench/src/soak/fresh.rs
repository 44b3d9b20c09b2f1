//! The comparison: every answer of the world that lives against that of a world that was never anything else, and a few of
//! them against the reference, which has no tree.

use super::edits::EMPTY;
use super::{AllClose, FAR_APART, FAR_BUT_CLOSE, Met, SIDE, Soak, Wrong, rows};
use pliant::{
    BodyId, Degree, EdgeEdge, Impact, Options, Pair, Partition, Scalar, Selection, Update,
    VertexTriangleImpact, World, reference,
};
use std::num::NonZeroU32;

impl<S: Scalar> Soak<S> {
    pub(super) fn compare_with_a_fresh_world(&mut self) -> Result<(), Wrong> {
        if let Err(what) = self.world.validate() {
            return self.wrong(what);
        }
        let options = self.other_options();
        let mut fresh = World::with_options(options);
        for body in &self.known {
            let mesh = self.mesh(body);
            // Numbers that are empty were never anything but points there.
            let is_there = |it: &&[u32; 3]| **it != EMPTY;
            let [point, ..] = mesh.iter().find(is_there).copied().unwrap_or_default();
            let filled = mesh
                .iter()
                .map(|&it| if it == EMPTY { [point; 3] } else { it });
            let added = fresh.add(&filled.collect::<Vec<_>>(), &body.positions);
            let id = self.good("add to a fresh world", added)?;
            let empty = (0..).zip(mesh).filter(|(_, it)| **it == EMPTY);
            let empty: Vec<u32> = empty.map(|(number, _)| number).collect();
            let edit = fresh.edit(id);
            let mut edit = self.good("edit of a fresh world", edit)?;
            edit.remove_triangles(&empty);
            let applied = fresh.apply(&edit);
            self.good("apply in a fresh world", applied)?;
            let set = fresh.set_filter(id, body.membership, body.mask);
            self.good("set_filter of a fresh world", set)?;
            if let Some(end) = &body.end {
                let set = fresh.set_motion(id, end);
                self.good("set_motion of a fresh world", set)?;
            }
        }
        for &(a, b) in &self.ignored {
            let ignored = fresh.ignore(self.fresh_id(a), self.fresh_id(b));
            self.good("ignore of a fresh world", ignored)?;
        }
        self.compare_between(&mut fresh)?;
        self.compare_within(&mut fresh)?;
        self.compare_two_bodies(&mut fresh)?;
        self.compare_near(&mut fresh)?;
        // It takes as long as all the rest.
        if self.random.one_in(3) {
            self.compare_close(&mut fresh)?;
        }
        self.compare_met(&mut fresh)?;
        self.compare_distances(&mut fresh)?;
        self.tally.compared += 1;
        Ok(())
    }

    /// The world's own configuration, or another: no option changes an answer.
    fn other_options(&mut self) -> Options {
        let mut options = *self.world.options();
        if self.random.one_in(2) {
            options.degree = [Degree::Two, Degree::Four, Degree::Eight][self.random.index(3)];
            options.partition = [
                Partition::Centre,
                Partition::Mean,
                Partition::Balanced,
                Partition::Connectivity,
            ][self.random.index(4)];
            options.leaf_size = NonZeroU32::MIN.saturating_add(self.random.below(12));
            options.update =
                [Update::BottomUp, Update::TopDown, Update::HYBRID][self.random.index(3)];
        }
        options
    }

    /// The id in a fresh world: there, bodies are numbered in order.
    fn fresh_id(&self, id: BodyId) -> BodyId {
        BodyId(self.known.partition_point(|body| body.id < id) as u32)
    }

    fn compare_between(&mut self, fresh: &mut World<S>) -> Result<(), Wrong> {
        let known_id = |id: BodyId| self.known[id.0 as usize].id;
        let expected = fresh.intersections(Selection::World).all();
        let expected: Vec<Pair> = self
            .good("pairs of a fresh world", expected)?
            .iter()
            .map(|pair| Pair {
                body_a: known_id(pair.body_a),
                body_b: known_id(pair.body_b),
                ..*pair
            })
            .collect();
        let first = self.world.intersections(Selection::World).first();
        let first = self.good("first pair", first)?;
        if !is_one_of(first, &expected) {
            return self.wrong(format!("first pair {first:?} of {} pairs", expected.len()));
        }
        // Twice: a query changes nothing that the next one could notice.
        for _ in 0..2 {
            let found = self.world.intersections(Selection::World).all();
            let found = found.unwrap_or_default();
            if found != expected {
                let found = found.len();
                return self.wrong(format!(
                    "{found} pairs, a fresh world has {}",
                    expected.len()
                ));
            }
        }
        self.tally.pairs += expected.len() as u64;
        Ok(())
    }

    fn compare_within(&mut self, fresh: &mut World<S>) -> Result<(), Wrong> {
        for place in 0..self.known.len() {
            let id = self.known[place].id;
            let fresh_id = BodyId(place as u32);
            let expected = fresh.intersections(Selection::Within(fresh_id)).all();
            let expected: Vec<Pair> = self
                .good("self pairs of a fresh world", expected)?
                .iter()
                .map(|pair| Pair {
                    body_a: id,
                    body_b: id,
                    ..*pair
                })
                .collect();
            let first = self.world.intersections(Selection::Within(id)).first();
            let first = self.good("first self pair", first)?;
            if !is_one_of(first, &expected) {
                return self.wrong(format!(
                    "first pair {first:?} of {id} with itself, which has {}",
                    expected.len()
                ));
            }
            if self.world.intersections(Selection::Within(id)).all().ok() != Some(&expected[..]) {
                return self.wrong(format!(
                    "{id} with itself: a fresh world has {} pairs",
                    expected.len()
                ));
            }
            self.tally.pairs += expected.len() as u64;
        }
        Ok(())
    }

    /// What is near, on the way too.
    fn compare_near(&mut self, fresh: &mut World<S>) -> Result<(), Wrong> {
        let radius = [0.0, 0.01, FAR_APART][self.random.index(3)];
        let expected = self.good("what is near in a fresh world", rows(fresh, radius))?;
        let found = rows(&mut self.world, radius);
        let found = self.good("what is near", found)?;
        let [found_vertices, found_edges] = found;
        let [mut vertices, edges] = expected;
        for [a, _, b, _] in &mut vertices {
            (*a, *b) = (self.known[*a as usize].id.0, self.known[*b as usize].id.0);
        }
        let pair = |&[body_a, edge_a, body_b, edge_b]: &[u32; 4]| {
            let [body_a, body_b] = [body_a, body_b].map(BodyId);
            EdgeEdge {
                body_a,
                edge_a,
                body_b,
                edge_b,
            }
        };
        let expected = self.by_ends(fresh, true, edges.iter().map(|it| (pair(it), ())));
        let found = self.by_ends(
            &self.world,
            false,
            found_edges.iter().map(|it| (pair(it), ())),
        );
        let are_same = found
            .iter()
            .map(|it| it.0)
            .eq(expected.iter().map(|it| it.0));
        if found_vertices != vertices || !are_same {
            let counts = [
                found_vertices.len(),
                vertices.len(),
                found.len(),
                expected.len(),
            ];
            return self.wrong(format!("found and expected within {radius}: {counts:?}"));
        }
        self.tally.near += (found.len() + vertices.len()) as u64;
        Ok(())
    }

    /// What is close, with all figures.
    fn compare_close(&mut self, fresh: &mut World<S>) -> Result<(), Wrong> {
        let distance = [0.0, FAR_BUT_CLOSE / 4.0, FAR_BUT_CLOSE][self.random.index(3)];
        let expected = AllClose::of(fresh, distance);
        let mut expected = self.good("what is close in a fresh world", expected)?;
        let known_id = |id: &mut BodyId| *id = self.known[id.0 as usize].id;
        for close in &mut expected.vertex_triangle {
            known_id(&mut close.pair.vertex_body);
            known_id(&mut close.pair.triangle_body);
        }
        for close in &mut expected.triangles {
            known_id(&mut close.pair.body_a);
            known_id(&mut close.pair.body_b);
        }
        let found = AllClose::of(&mut self.world, distance);
        let found = self.good("what is close", found)?;
        let edges = |all: &AllClose| -> Vec<_> {
            let edges = all.edge_edge.iter();
            edges.map(|&close| (close.pair, close)).collect()
        };
        let expected_edges = self.by_ends(fresh, true, edges(&expected).into_iter());
        let found_edges = self.by_ends(&self.world, false, edges(&found).into_iter());
        let are_same_edges = found_edges.len() == expected_edges.len()
            && found_edges
                .iter()
                .zip(&expected_edges)
                .all(|(found, expected)| {
                    // Which of two edges of one body comes first is up to their numbers, and to that what is rounded how.
                    let slack = expected.2.distance * f64::powi(0.5, 29);
                    let is_near = (found.2.distance - expected.2.distance).abs() <= slack;
                    let (mut one, other) = (found.2, expected.2);
                    one.pair = other.pair;
                    found.0 == expected.0
                        && if found.1 == expected.1 {
                            one == other
                        } else {
                            is_near
                        }
                });
        let is_same = found.vertex_triangle == expected.vertex_triangle
            && found.triangles == expected.triangles
            && are_same_edges;
        if !is_same {
            let counts = [found.counts(), expected.counts()];
            return self.wrong(format!(
                "found and expected at most {distance} apart: {counts:?}, or figures differ"
            ));
        }
        self.tally.close += found.counts().iter().sum::<usize>() as u64;
        Ok(())
    }

    /// What meets on the way, with its times, what meets first, and how far everything may go.
    fn compare_met(&mut self, fresh: &mut World<S>) -> Result<(), Wrong> {
        let width = [0.0, 1e-6, 1.0][self.random.index(3)];
        let distance = [0.0, FAR_BUT_CLOSE / 8.0][self.random.index(2)];
        let expected = Met::of(fresh, width, distance);
        let mut expected = self.good("what meets in a fresh world", expected)?;
        let known_id = |id: &mut BodyId| *id = self.known[id.0 as usize].id;
        let name_vertex = |impact: &mut VertexTriangleImpact| {
            known_id(&mut impact.pair.vertex_body);
            known_id(&mut impact.pair.triangle_body);
        };
        expected.vertex_triangle.iter_mut().for_each(name_vertex);
        let found = Met::of(&mut self.world, width, distance);
        let found = self.good("what meets", found)?;
        let edges = |all: &Met| -> Vec<_> {
            let edges = all.edge_edge.iter();
            edges.map(|it| (it.pair, [it.low, it.high])).collect()
        };
        let expected_edges = self.by_ends(fresh, true, edges(&expected).into_iter());
        let found_edges = self.by_ends(&self.world, false, edges(&found).into_iter());
        let timed = |it: &(_, bool, [f64; 2])| (it.0, it.2);
        // Of several edges that meet first it is the lowest, by numbers that edits give.
        let first = |met: &Met| match met.first {
            Some(Impact::VertexTriangle(impact)) => Some((0, impact.low, impact.high)),
            Some(Impact::EdgeEdge(impact)) => Some((1, impact.low, impact.high)),
            None => None,
        };
        let is_same = found.vertex_triangle == expected.vertex_triangle
            && found_edges
                .iter()
                .map(timed)
                .eq(expected_edges.iter().map(timed))
            && first(&found) == first(&expected)
            && found.step == expected.step;
        if !is_same {
            return self.wrong(format!(
                "found and expected on the way, {distance} apart: {}, {}",
                found.summary(),
                expected.summary()
            ));
        }
        self.tally.met += (found.vertex_triangle.len() + found.edge_edge.len()) as u64;
        Ok(())
    }

    /// Pairs of edges by their bodies and ends, in order, as the world that lives calls them; and whether the edges changed places for
    /// that. `is_fresh`: whether they are of the world that was never anything else.
    fn by_ends<T>(
        &self,
        world: &World<S>,
        is_fresh: bool,
        pairs: impl Iterator<Item = (EdgeEdge, T)>,
    ) -> Vec<([(BodyId, [u32; 2]); 2], bool, T)> {
        let named = |body: BodyId, edge: u32| {
            let ends = world
                .edges(body)
                .map_or([0; 2], |edges| edges[edge as usize]);
            let body = if is_fresh {
                self.known[body.0 as usize].id
            } else {
                body
            };
            (body, ends)
        };
        let pairs = pairs.map(|(pair, more)| {
            let a = named(pair.body_a, pair.edge_a);
            let b = named(pair.body_b, pair.edge_b);
            ([a.min(b), a.max(b)], a > b, more)
        });
        let mut pairs: Vec<_> = pairs.collect();
        pairs.sort_by_key(|pair| pair.0);
        pairs
    }

    /// How far some bodies are apart, and one from all others.
    fn compare_distances(&mut self, fresh: &mut World<S>) -> Result<(), Wrong> {
        for _ in 0..4 {
            let cut_off = [f64::INFINITY, SIDE / 4.0][self.random.index(2)];
            let [a, b] = [(); 2].map(|()| self.known[self.random.index(self.known.len())].id);
            let [fresh_a, fresh_b] = [a, b].map(|id| self.fresh_id(id));
            let (found, expected) = if a == b {
                let found = self.world.nearest_body(a, cut_off);
                (found, fresh.nearest_body(fresh_a, cut_off))
            } else {
                let found = self.world.distance(a, b, cut_off);
                (found, fresh.distance(fresh_a, fresh_b, cut_off))
            };
            let both = [
                self.good("a distance", found)?,
                self.good("a distance in a fresh world", expected)?,
            ];
            // None is beyond the cut-off, which is no number below 0.
            let [found, expected] = both.map(|it| it.map_or(-1.0, |close| close.distance));
            // Of several triangles that are nearer or further by no more than 2^-30, it is some.
            if (found - expected).abs() > expected.abs() * f64::powi(0.5, 29) {
                return self.wrong(format!(
                    "{a} and {b} are {found} apart, in a fresh world {expected}"
                ));
            }
            self.tally.distances += 1;
        }
        Ok(())
    }

    /// Two bodies that meet if any do, whatever filters say: also against the reference.
    fn compare_two_bodies(&mut self, fresh: &mut World<S>) -> Result<(), Wrong> {
        let pairs = self.world.intersections(Selection::World).all();
        let pairs = pairs.unwrap_or_default();
        let two = if pairs.is_empty() {
            [0, 1].map(|place| self.known[place].id)
        } else {
            let Pair { body_a, body_b, .. } = pairs[self.random.index(pairs.len())];
            // Either may be named first.
            if self.random.one_in(2) {
                [body_a, body_b]
            } else {
                [body_b, body_a]
            }
        };
        let [a, b] = two.map(|id| self.fresh_id(id));
        let bodies = [a, b].map(|id| &self.known[id.0 as usize]);
        let meshes = bodies.map(|body| {
            let mesh = self.mesh(body).iter().copied();
            mesh.filter(|it| *it != EMPTY).collect::<Vec<_>>()
        });
        let [triangles_a, triangles_b] = meshes.each_ref().map(|it| &it[..]);
        let numbers = bodies.map(|body| {
            let numbers = (0..).zip(self.mesh(body));
            let numbers = numbers.filter(|(_, it)| **it != EMPTY);
            numbers.map(|(number, _)| number).collect::<Vec<u32>>()
        });
        let [numbers_a, numbers_b] = numbers.each_ref().map(|it| &it[..]);
        let named = |pairs: Vec<[u32; 2]>, others: &[u32]| -> Vec<[u32; 2]> {
            let pairs = pairs.into_iter();
            let named = pairs.map(|[a, b]| [numbers_a[a as usize], others[b as usize]]);
            named.collect()
        };
        let [positions_a, positions_b] = bodies.map(|body| &body.positions[..]);
        let truth =
            reference::intersection_pairs(triangles_a, positions_a, triangles_b, positions_b);
        let truth_itself = reference::self_intersection_pairs(triangles_a, positions_a);
        let (truth, truth_itself) = (
            named(self.good("reference", truth)?, numbers_b),
            named(self.good("reference", truth_itself)?, numbers_a),
        );
        let [id_a, id_b] = two;
        let ours = triangles(&mut self.world, Selection::Between(id_a, id_b))
            == Some(truth.clone())
            && triangles(&mut self.world, Selection::Within(id_a)) == Some(truth_itself.clone())
            && triangles(fresh, Selection::Between(a, b)) == Some(truth.clone());
        if !ours {
            return self.wrong(format!(
                "{id_a} and {id_b}: the reference has {} pairs, and {} within the first",
                truth.len(),
                truth_itself.len()
            ));
        }
        Ok(())
    }
}

/// All pairs, without their bodies.
fn triangles<S: Scalar>(world: &mut World<S>, of: Selection) -> Option<Vec<[u32; 2]>> {
    let pairs = world.intersections(of).all().ok()?;
    Some(pairs.iter().map(Pair::triangles).collect())
}

fn is_one_of<T: PartialEq>(first: Option<T>, all: &[T]) -> bool {
    first.map_or(all.is_empty(), |pair| all.contains(&pair))
}
