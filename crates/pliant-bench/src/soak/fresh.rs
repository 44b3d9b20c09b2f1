//! Comparison of every answer with a world built fresh, and of a few with the reference, which has
//! no tree.

use super::edits::EMPTY;
use super::kinds::{Much, every_kind};
use super::{AllClose, FAR_APART, FAR_BUT_CLOSE, Met, Near, SIDE, Soak, Wrong};
use pliant::{
    BodyId, CloseEdgeEdge, Degree, EdgeEdge, EdgeEdgeImpact, Impact, Options, Pair, Partition,
    Scalar, Selection, Update, VertexTriangleImpact, World, reference,
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
            // Vertices of empty triangles were never more than points there.
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
            let set = fresh.set_environment(id, body.environment);
            self.good("set_environment of a fresh world", set)?;
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
        // Takes as long as all other comparisons.
        if self.random.one_in(3) {
            self.compare_close(&mut fresh)?;
        }
        self.compare_met(&mut fresh)?;
        self.compare_distances(&mut fresh)?;
        self.compare_with_a_copy()?;
        self.tally.compared += 1;
        Ok(())
    }

    /// Options of the fresh world: the same as the world's own, or others. No option changes an
    /// answer.
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

    /// Id of a body in a fresh world, which numbers bodies in order.
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

    /// Compares candidates, also along motions.
    fn compare_near(&mut self, fresh: &mut World<S>) -> Result<(), Wrong> {
        let radius = [0.0, 0.01, FAR_APART][self.random.index(3)];
        let expected = Near::of(fresh, radius);
        let mut expected = self.good("what is near in a fresh world", expected)?;
        for near in &mut expected.vertex_triangle {
            near.vertex_body = self.known_id(near.vertex_body);
            near.triangle_body = self.known_id(near.triangle_body);
        }
        let found = Near::of(&mut self.world, radius);
        let found = self.good("what is near", found)?;
        let edges = |near: &Near| near.edge_edge.iter().map(|&it| (it, ())).collect();
        let [found_edges, expected_edges] = self.by_ends([edges(&found), edges(&expected)], fresh);
        let pairs = |edges: &[Named<()>]| edges.iter().map(|it| it.ends).collect::<Vec<_>>();
        if found.vertex_triangle != expected.vertex_triangle
            || pairs(&found_edges) != pairs(&expected_edges)
            || !found.edge_edge.is_sorted()
        {
            let count = |near: &Near| [near.vertex_triangle.len(), near.edge_edge.len()];
            let counts = [&found, &expected].map(count);
            return self.wrong(format!("found and expected within {radius}: {counts:?}"));
        }
        self.tally.near += (found.vertex_triangle.len() + found.edge_edge.len()) as u64;
        Ok(())
    }

    /// Compares close pairs with all their figures.
    fn compare_close(&mut self, fresh: &mut World<S>) -> Result<(), Wrong> {
        let distance = [0.0, FAR_BUT_CLOSE / 4.0, FAR_BUT_CLOSE][self.random.index(3)];
        let expected = AllClose::of(fresh, distance);
        let mut expected = self.good("what is close in a fresh world", expected)?;
        for close in &mut expected.vertex_triangle {
            close.pair.vertex_body = self.known_id(close.pair.vertex_body);
            close.pair.triangle_body = self.known_id(close.pair.triangle_body);
        }
        for close in &mut expected.triangles {
            close.pair.body_a = self.known_id(close.pair.body_a);
            close.pair.body_b = self.known_id(close.pair.body_b);
        }
        let found = AllClose::of(&mut self.world, distance);
        let found = self.good("what is close", found)?;
        let edges = |all: &AllClose| all.edge_edge.iter().map(|&it| (it.pair, it)).collect();
        let [found_edges, expected_edges] = self.by_ends([edges(&found), edges(&expected)], fresh);
        // Which of two edges of one body comes first depends on their numbers, and on that how
        // figures are rounded.
        let is_same_edge = |(found, expected): (&Named<_>, &Named<_>)| {
            let (mut one, other): (CloseEdgeEdge, CloseEdgeEdge) = (found.more, expected.more);
            one.pair = other.pair;
            let slack = other.distance * f64::powi(0.5, 29);
            found.ends == expected.ends
                && if found.is_turned == expected.is_turned {
                    one == other
                } else {
                    (one.distance - other.distance).abs() <= slack
                }
        };
        let mut edges = found_edges.iter().zip(&expected_edges);
        let is_same = found.vertex_triangle == expected.vertex_triangle
            && found.triangles == expected.triangles
            && found_edges.len() == expected_edges.len()
            && edges.all(is_same_edge);
        if !is_same {
            let counts = [found.counts(), expected.counts()];
            return self.wrong(format!(
                "found and expected at most {distance} apart: {counts:?}, or figures differ"
            ));
        }
        self.tally.close += found.counts().iter().sum::<usize>() as u64;
        Ok(())
    }

    /// Compares impacts with their times, the first impact, and free steps.
    fn compare_met(&mut self, fresh: &mut World<S>) -> Result<(), Wrong> {
        let width = [0.0, 1e-6, 1.0][self.random.index(3)];
        let distance = [0.0, FAR_BUT_CLOSE / 8.0][self.random.index(2)];
        let expected = Met::of(fresh, width, distance);
        let mut expected = self.good("what meets in a fresh world", expected)?;
        let name_vertex = |impact: &mut VertexTriangleImpact| {
            impact.pair.vertex_body = self.known_id(impact.pair.vertex_body);
            impact.pair.triangle_body = self.known_id(impact.pair.triangle_body);
        };
        expected.vertex_triangle.iter_mut().for_each(name_vertex);
        if let Some(Impact::VertexTriangle(impact)) = &mut expected.first {
            name_vertex(impact);
        }
        let found = Met::of(&mut self.world, width, distance);
        let found = self.good("what meets", found)?;
        let timed = |it: &EdgeEdgeImpact| (it.pair, [it.low, it.high]);
        let edges = |met: &Met| met.edge_edge.iter().map(timed).collect();
        let edges = self.by_ends([edges(&found), edges(&expected)], fresh);
        let [found_edges, expected_edges] = edges.map(|edges| {
            edges
                .iter()
                .map(|it| (it.ends, it.more))
                .collect::<Vec<_>>()
        });
        let is_same_first = match (found.first, expected.first) {
            // Of several edges that meet first the lowest is reported, by numbers that edits
            // assign.
            (Some(Impact::EdgeEdge(found)), Some(Impact::EdgeEdge(expected))) => {
                [found.low, found.high] == [expected.low, expected.high]
            }
            (found, expected) => found == expected,
        };
        let is_same = found.vertex_triangle == expected.vertex_triangle
            && found_edges == expected_edges
            && is_same_first
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

    /// Compares all hits of one kind, each kind in its turn, with a copy of the world.
    ///
    /// All boxes of a copy are made anew; bodies and edges have the same names there.
    fn compare_with_a_copy(&mut self) -> Result<(), Wrong> {
        let kinds = every_kind::<S>();
        let kind = &kinds[self.tally.compared as usize % kinds.len()];
        let mut copy = self.world.clone();
        let [found, expected] = [&mut self.world, &mut copy]
            .map(|world| (kind.ask)(world, Selection::Everything, FAR_BUT_CLOSE, Much::All));
        let name = kind.name;
        let (found, expected) = (self.good(name, found)?, self.good(name, expected)?);
        if found != expected {
            return self.wrong(format!("{name}: {found:?}, a copy has {expected:?}"));
        }
        Ok(())
    }

    /// Id in the long-lived world of a body of a fresh one.
    fn known_id(&self, fresh_id: BodyId) -> BodyId {
        self.known[fresh_id.0 as usize].id
    }

    /// Names pairs of edges of both worlds by their ends, since edits number edges in another way.
    fn by_ends<T>(
        &self,
        [found, expected]: [Vec<(EdgeEdge, T)>; 2],
        fresh: &World<S>,
    ) -> [Vec<Named<T>>; 2] {
        let ends = |world: &World<S>, body: BodyId, edge: u32| {
            let edges = world.edges(body);
            edges.map_or([u32::MAX; 2], |edges| edges[edge as usize])
        };
        let of_found = |body, edge| (body, ends(&self.world, body, edge));
        let of_expected = |body, edge| (self.known_id(body), ends(fresh, body, edge));
        [named(found, of_found), named(expected, of_expected)]
    }

    /// Compares distances of bodies, and of one body from all others.
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
            // `None` is beyond the cut-off: here -1.
            let [found, expected] = both.map(|it| it.map_or(-1.0, |close| close.distance));
            // Of several triangles whose distances differ by at most 2^-30, any may be reported.
            if (found - expected).abs() > expected.abs() * f64::powi(0.5, 29) {
                return self.wrong(format!(
                    "{a} and {b} are {found} apart, in a fresh world {expected}"
                ));
            }
            self.tally.distances += 1;
        }
        Ok(())
    }

    /// Compares two bodies that meet, if any do, whatever filters say; also with the reference.
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
        let live = bodies.map(|body| -> (Vec<u32>, Vec<[u32; 3]>) {
            let mesh = (0..).zip(self.mesh(body).iter().copied());
            mesh.filter(|(_, it)| *it != EMPTY).unzip()
        });
        let [(numbers_a, triangles_a), (numbers_b, triangles_b)] = &live;
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

/// A pair of edges that are close or meet, with further data.
struct Named<T> {
    /// Their bodies and ends, the lower first.
    ends: [(BodyId, [u32; 2]); 2],
    /// Whether the other edge is first by its number.
    is_turned: bool,
    more: T,
}

/// Pairs with the ends that `ends` returns, in their order.
fn named<T>(
    pairs: Vec<(EdgeEdge, T)>,
    ends: impl Fn(BodyId, u32) -> (BodyId, [u32; 2]),
) -> Vec<Named<T>> {
    let pairs = pairs.into_iter().map(|(pair, more)| {
        let [a, b] = [
            ends(pair.body_a, pair.edge_a),
            ends(pair.body_b, pair.edge_b),
        ];
        let ends = [a.min(b), a.max(b)];
        Named {
            ends,
            is_turned: a > b,
            more,
        }
    });
    let mut pairs: Vec<_> = pairs.collect();
    pairs.sort_by_key(|pair| pair.ends);
    pairs
}

/// All pairs of triangles, without their bodies.
fn triangles<S: Scalar>(world: &mut World<S>, of: Selection) -> Option<Vec<[u32; 2]>> {
    let pairs = world.intersections(of).all().ok()?;
    Some(pairs.iter().map(Pair::triangles).collect())
}

fn is_one_of<T: PartialEq>(first: Option<T>, all: &[T]) -> bool {
    first.map_or(all.is_empty(), |pair| all.contains(&pair))
}
