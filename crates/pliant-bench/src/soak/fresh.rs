//! The comparison: every answer of the world that lives against that of a world that was never anything else, and a few of
//! them against the reference, which has no tree.

use super::{AllClose, FAR_APART, FAR_BUT_CLOSE, Met, SIDE, Soak, Wrong, rows};
use pliant::{
    BodyId, Degree, EdgeEdgeImpact, Impact, Options, Pair, Partition, Scalar, Selection, Update,
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
            let added = fresh.add(&self.surfaces[body.surface].triangles, &body.positions);
            let id = self.good("add to a fresh world", added)?;
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
        for (found, mut expected) in found.into_iter().zip(expected) {
            for [a, _, b, _] in &mut expected {
                (*a, *b) = (self.known[*a as usize].id.0, self.known[*b as usize].id.0);
            }
            if found != expected {
                let counts = [found.len(), expected.len()];
                return self.wrong(format!("found and expected within {radius}: {counts:?}"));
            }
            self.tally.near += found.len() as u64;
        }
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
        for close in &mut expected.edge_edge {
            known_id(&mut close.pair.body_a);
            known_id(&mut close.pair.body_b);
        }
        for close in &mut expected.triangles {
            known_id(&mut close.pair.body_a);
            known_id(&mut close.pair.body_b);
        }
        let found = AllClose::of(&mut self.world, distance);
        let found = self.good("what is close", found)?;
        if found != expected {
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
        let name_edges = |impact: &mut EdgeEdgeImpact| {
            known_id(&mut impact.pair.body_a);
            known_id(&mut impact.pair.body_b);
        };
        expected.vertex_triangle.iter_mut().for_each(name_vertex);
        expected.edge_edge.iter_mut().for_each(name_edges);
        match &mut expected.first {
            Some(Impact::VertexTriangle(impact)) => name_vertex(impact),
            Some(Impact::EdgeEdge(impact)) => name_edges(impact),
            None => {}
        }
        let found = Met::of(&mut self.world, width, distance);
        let found = self.good("what meets", found)?;
        if found != expected {
            return self.wrong(format!(
                "found and expected on the way, {distance} apart: {}, {}",
                found.summary(),
                expected.summary()
            ));
        }
        self.tally.met += (found.vertex_triangle.len() + found.edge_edge.len()) as u64;
        Ok(())
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
        let [triangles_a, triangles_b] =
            bodies.map(|body| &self.surfaces[body.surface].triangles[..]);
        let [positions_a, positions_b] = bodies.map(|body| &body.positions[..]);
        let truth =
            reference::intersection_pairs(triangles_a, positions_a, triangles_b, positions_b);
        let truth_itself = reference::self_intersection_pairs(triangles_a, positions_a);
        let (truth, truth_itself) = (
            self.good("reference", truth)?,
            self.good("reference", truth_itself)?,
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
