//! Adjacent contacts: triangles of a body that have a vertex in common and meet beyond it.
//!
//! No tree is needed: the mesh says which triangles these are. Idea: if all triangles at a vertex
//! face one way along a direction, and go round it once, none hides another. Then no two of them
//! meet beyond what they share.
//!
//! 1. **Along an axis**: `kernels::count_stars`, for all vertices, eight triangles at a time.
//! 2. **From any direction**: `one_way`, for the vertices that are left.
//! 3. **Pairs**: decided exactly, if each vertex that they have in common is left.
//!
//! Source: the normals of regions, with a test of their outlines (Volino and Magnenat-Thalmann
//! 1994). Difference: of one vertex a winding number makes it a proof.

mod hit;
mod one_way;
mod sector;

use self::one_way::{Wing, is_seen_without_overlaps};
use self::sector::Sector;
use super::{ContactKind, CrossingEdge, LabelPairs, OwnEdges, Pair, Removed};
use crate::geometry::{Real, Shape};
use crate::held::{self, held};
use crate::ids::{BodyId, TreeTriangle, TreeVertex};
use crate::kernels::{
    CLOSED, Coordinate, Instructions, StarCounts, count_stars, mark_overlapping_stars,
};
use crate::mesh::{Order, Stars, opposite};
use crate::statistics::Statistics;
use crate::threads::{Executor, Grain, Interrupt, PerThread};
pub use hit::AdjacentContact;
use pliant_exact::{adjacent_contact, crossing_edges};
use std::ops::{ControlFlow, Range};

/// Vertices whose pairs are decided before hits are handed over.
const AT_ONCE: usize = 1024;
/// Most triangles of a star that are all compared with each other.
const MOST_BY_PAIRS: usize = 64;
/// Vertices of one job.
const OF_A_JOB: usize = Grain::STARS_LEFT.items;

/// A body, as the search for adjacent contacts reads it.
pub(crate) struct StarredBody<'q, S> {
    pub(crate) body: BodyId,
    /// Positions, and corners of triangles, both in tree order.
    pub(crate) shape: Shape<'q, S>,
    pub(crate) order: &'q Order,
    pub(crate) removed: Option<Removed<'q>>,
    /// Pairs that labels leave out, if there are labels.
    pub(crate) labels: Option<&'q LabelPairs>,
    pub(crate) mesh: &'q dyn OwnEdges,
    pub(crate) stars: &'q Stars,
    pub(crate) interrupt: &'q Interrupt<'q>,
}

/// Adjacent contact of two triangles, in tree order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TreeAdjacent {
    triangles: [TreeTriangle; 2],
    kind: ContactKind,
}

/// Sink of the hits of a body.
pub(crate) type AdjacentSink<'s, S> =
    &'s mut dyn FnMut(&StarredBody<S>, &[TreeAdjacent]) -> ControlFlow<()>;

/// Scratch memory of a search, kept from query to query. Vertices and triangles are in tree order.
#[derive(Debug, Default)]
pub(crate) struct AdjacentSearch {
    /// Counts at each vertex; [`UNDECIDED`] where the triangles are compared pair by pair.
    counts: Vec<StarCounts>,
    /// Vertices that are not known to be free of contacts, each with a triangle that has it.
    at_left: Vec<[u32; 2]>,
    found: PerThread<Vec<[u32; 2]>>,
    /// The vertices, with their places in that list.
    left: Vec<Left>,
    jobs: Vec<Job>,
}

/// A vertex that is not known to be free of contacts.
#[derive(Clone, Debug)]
struct Left {
    vertex: TreeVertex,
    /// Places of its triangles.
    star: Range<usize>,
    is_free: bool,
}

impl Left {
    /// Whether the pairs of its triangles are searched for, as there are many.
    fn is_large(&self) -> bool {
        self.star.len() > MOST_BY_PAIRS
    }
}

/// Scratch memory and results of one job.
#[derive(Debug, Default)]
struct Job {
    wings: Vec<Wing>,
    /// Boxes of directions of the triangles of a large star, in order.
    sectors: Vec<Sector>,
    hits: Vec<TreeAdjacent>,
    candidates: u64,
    exact: u64,
}

/// Mark of a vertex whose triangles are compared pair by pair.
const UNDECIDED: StarCounts = StarCounts::ALL;

const GO_ON: ControlFlow<()> = ControlFlow::Continue(());

impl AdjacentSearch {
    /// Passes all adjacent contacts of a body to `sink`, or of `only` one kind, until it breaks.
    ///
    /// They come in an order that depends on the body alone. Also breaks if interrupted.
    pub(crate) fn search<S: Coordinate>(
        &mut self,
        body: &StarredBody<S>,
        only: Option<ContactKind>,
        (instructions, executor): (Instructions, Executor),
        statistics: &mut Statistics,
        sink: AdjacentSink<S>,
    ) -> ControlFlow<()> {
        self.count_stars(body, instructions, executor);
        self.see_along_axes(body, instructions, executor);
        self.list_left(body, executor);
        self.see_from_anywhere(body, executor);
        for some in self.left.chunks(AT_ONCE) {
            let (jobs, counts, at_left) = (&mut self.jobs[..], &self.counts, &self.at_left);
            let parts = some.chunks(OF_A_JOB).zip(jobs);
            let decide = |(vertices, job): &mut (&[Left], &mut Job)| {
                job.clear();
                for left in vertices.iter().filter(|left| !left.is_large()) {
                    if executor.is_interrupted() {
                        return;
                    }
                    let star = &at_left[left.star.clone()];
                    let _ = job.decide(body, left.vertex, star, only, counts, &mut |_| GO_ON);
                }
            };
            executor.run_each(parts, Grain::STARS_LEFT, decide, |_| {});
            if executor.is_interrupted() {
                return ControlFlow::Break(());
            }
            for job in &mut self.jobs[..some.len().div_ceil(OF_A_JOB)] {
                job.hand_over(body, statistics, sink)?;
            }
            // The hits of a large star are handed over on the way.
            for left in some.iter().filter(|left| left.is_large()) {
                let (job, star) = (&mut self.jobs[0], &self.at_left[left.star.clone()]);
                job.clear();
                let counts = &self.counts;
                job.decide(body, left.vertex, star, only, counts, &mut |job| {
                    if executor.is_interrupted() {
                        return ControlFlow::Break(());
                    }
                    job.hand_over(body, statistics, sink)
                })?;
            }
        }
        ControlFlow::Continue(())
    }

    /// Counts at every vertex which way its triangles face.
    ///
    /// Vertices are numbered as triangles first use them. So a run of triangles has vertices of its
    /// own, which are a run too. What it counts at others' vertices is added in the end.
    fn count_stars<S: Coordinate>(
        &mut self,
        body: &StarredBody<S>,
        instructions: Instructions,
        executor: Executor,
    ) {
        self.counts.clear();
        self.counts
            .resize(body.order.used_vertices(), StarCounts::NONE);
        let triangles = body.shape.triangles;
        let nanoseconds = Grain::STARS.time(triangles.len());
        let whole = Run {
            first: 0,
            triangles,
            first_vertex: 0,
            own: &mut self.counts,
            others: Vec::new(),
        };
        let mut others = Vec::new();
        executor.run_cut(
            whole,
            nanoseconds,
            |whole| whole.cut(executor, nanoseconds),
            |run| run.count(body, instructions),
            |run| others.extend_from_slice(&run.others),
        );
        for (vertex, counts) in others {
            self.counts[vertex].add(counts);
        }
    }

    /// Marks the vertices whose stars may overlap along every axis.
    fn see_along_axes<S: Coordinate>(
        &mut self,
        body: &StarredBody<S>,
        instructions: Instructions,
        executor: Executor,
    ) {
        let vertices = body.order.vertex_order();
        let runs = self.counts.chunks_mut(Grain::STARS.items);
        let runs = (0..).step_by(Grain::STARS.items).zip(runs);
        let mark = |(first, counts): &mut (usize, &mut [StarCounts])| {
            let record = |place: usize| body.stars.of(vertices[*first + place]);
            mark_overlapping_stars(instructions, counts, record);
        };
        executor.run_each(runs, Grain::STARS, mark, |_| {});
    }

    /// Lists the vertices that are marked, with their triangles.
    fn list_left<S: Coordinate>(&mut self, body: &StarredBody<S>, executor: Executor) {
        self.at_left.clear();
        self.left.clear();
        // Orphans are marked as well, and have no triangle that is there.
        if !self.counts.contains(&UNDECIDED) {
            return;
        }
        self.found.for_threads(executor.count());
        let (counts, found) = (&self.counts, &self.found);
        let runs = body.shape.triangles.chunks(Grain::STARS.items);
        let runs = (0..).step_by(Grain::STARS.items).zip(runs);
        let list = |(first, run): &mut (u32, &[[TreeVertex; 3]])| {
            let mut list = found.own();
            for (triangle, corners) in (*first..).zip(*run) {
                let [a, b, c] = corners.map(|corner| counts[corner.index()] == UNDECIDED);
                if a | b | c && !body.is_gone(triangle) {
                    let marked = corners
                        .iter()
                        .zip([a, b, c])
                        .filter(|(_, is_marked)| *is_marked);
                    list.extend(marked.map(|(corner, _)| [corner.0, triangle]));
                }
            }
        };
        executor.run_each(runs, Grain::STARS, list, |_| {});
        for list in self.found.iter_mut() {
            self.at_left.append(list);
        }
        self.at_left.sort_unstable();
        // A triangle may have a vertex twice.
        self.at_left.dedup();
        let mut end = 0;
        for star in self.at_left.chunk_by(|one, other| one[0] == other[0]) {
            end += star.len();
            self.left.push(Left {
                vertex: TreeVertex(star[0][0]),
                star: end - star.len()..end,
                is_free: false,
            });
        }
    }

    /// Drops the vertices whose stars are seen without overlaps from some direction.
    fn see_from_anywhere<S: Coordinate>(&mut self, body: &StarredBody<S>, executor: Executor) {
        let jobs = self.left.len().div_ceil(OF_A_JOB);
        if self.jobs.len() < jobs {
            self.jobs.resize_with(jobs, Job::default);
        }
        let at_left = &self.at_left;
        let parts = self.left.chunks_mut(OF_A_JOB).zip(&mut self.jobs);
        let look = |(vertices, job): &mut (&mut [Left], &mut Job)| {
            for left in &mut **vertices {
                left.is_free = job.is_free(body, left.vertex, &at_left[left.star.clone()]);
            }
        };
        executor.run_each(parts, Grain::STARS_LEFT, look, |_| {});
        let counts = &mut self.counts;
        self.left.retain(|left| {
            if left.is_free {
                counts[left.vertex.index()] = StarCounts::NONE;
            }
            !left.is_free
        });
    }
}

/// A run of triangles, with the counts of the vertices that it uses first.
struct Run<'q> {
    first: usize,
    triangles: &'q [[TreeVertex; 3]],
    first_vertex: usize,
    own: &'q mut [StarCounts],
    /// Counts of earlier vertices.
    others: Vec<(usize, StarCounts)>,
}

impl Run<'_> {
    /// Cuts the run of all triangles into shorter ones.
    fn cut(self, executor: Executor, nanoseconds: u64) -> Vec<Self> {
        let runs = self.triangles.chunks(Grain::STARS.items);
        // The vertices that each uses end behind the largest.
        let mut ends: Vec<_> = runs.clone().map(|run| (run, 0)).collect();
        executor.run(&mut ends, nanoseconds / 8, |_, (run, end)| {
            let largest = run.as_flattened().iter().max();
            *end = largest.map_or(0, |vertex| vertex.index() + 1);
        });
        let (mut rest, mut first_vertex) = (self.own, 0);
        let runs = ends
            .into_iter()
            .enumerate()
            .map(|(number, (triangles, end))| {
                let new = end.max(first_vertex) - first_vertex;
                let (own, others) = std::mem::take(&mut rest).split_at_mut(new);
                rest = others;
                first_vertex += new;
                Run {
                    first: number * Grain::STARS.items,
                    triangles,
                    first_vertex: first_vertex - new,
                    own,
                    others: Vec::new(),
                }
            });
        runs.collect()
    }

    fn count<S: Coordinate>(&mut self, body: &StarredBody<S>, instructions: Instructions) {
        let positions = body.shape.positions;
        let (first, first_vertex) = (self.first, self.first_vertex);
        let (own, others) = (&mut *self.own, &mut self.others);
        count_stars(
            instructions,
            positions,
            self.triangles,
            |place, vertex, counted| {
                if body.is_gone((first + place) as u32) {
                    return;
                }
                match own.get_mut(vertex.index().wrapping_sub(first_vertex)) {
                    Some(own) => counted.add_to(own),
                    None => others.push((vertex.index(), counted.alone())),
                }
            },
        );
    }
}

impl Job {
    fn clear(&mut self) {
        self.hits.clear();
        (self.candidates, self.exact) = (0, 0);
    }

    /// Takes the triangles of a star, with their edges at the vertex.
    fn look_at<S: Coordinate>(
        &mut self,
        body: &StarredBody<S>,
        vertex: TreeVertex,
        star: &[[u32; 2]],
    ) {
        let at = body.position(vertex);
        self.wings.clear();
        self.wings.extend(star.iter().map(|&[_, triangle]| {
            let ends = opposite(body.corners(triangle), vertex);
            Wing::new(ends.map(|end| {
                let end = body.position(end);
                std::array::from_fn(|axis| end[axis] - at[axis])
            }))
        }));
    }

    /// Whether a vertex is certainly free of contacts.
    fn is_free<S: Coordinate>(
        &mut self,
        body: &StarredBody<S>,
        vertex: TreeVertex,
        star: &[[u32; 2]],
    ) -> bool {
        let record = body.stars.of(body.order.caller_vertex(vertex).0);
        if record == CLOSED {
            return false;
        }
        self.look_at(body, vertex, star);
        is_seen_without_overlaps(&self.wings, record >= CLOSED)
    }

    /// Decides the pairs of triangles at a vertex, unless another vertex that they have in common
    /// is free of contacts, or has a smaller number. Calls `row` behind each triangle.
    ///
    /// Pairs of a large star are found by sweep and prune over the directions of triangles.
    fn decide<S: Coordinate>(
        &mut self,
        body: &StarredBody<S>,
        vertex: TreeVertex,
        star: &[[u32; 2]],
        only: Option<ContactKind>,
        counts: &[StarCounts],
        row: &mut dyn FnMut(&mut Self) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.look_at(body, vertex, star);
        let decision = Decision {
            body,
            vertex,
            star,
            only,
            counts,
        };
        if star.len() <= MOST_BY_PAIRS {
            for place in 1..star.len() {
                for before in 0..place {
                    self.decide_pair(&decision, before, place);
                }
                row(self)?;
            }
            return ControlFlow::Continue(());
        }
        let sectors = self.wings.iter().enumerate();
        self.sectors.clear();
        self.sectors
            .extend(sectors.map(|(place, wing)| wing.sector(place)));
        self.sectors.sort_unstable_by(Sector::by_beginning);
        for place in 0..star.len() {
            let one = self.sectors[place];
            for other in place + 1..star.len() {
                let other = self.sectors[other];
                if !one.reaches(&other) {
                    break;
                }
                if one.overlaps(&other) {
                    self.decide_pair(&decision, one.place, other.place);
                }
            }
            row(self)?;
        }
        ControlFlow::Continue(())
    }

    /// Decides the pair of triangles at two places of a star.
    fn decide_pair<S: Coordinate>(&mut self, of: &Decision<S>, one: usize, other: usize) {
        let (body, vertex) = (of.body, of.vertex);
        let [a, b] = [one, other].map(|place| of.star[place][1]);
        let [of_a, of_b] = [a, b].map(|triangle| body.corners(triangle));
        let mut common = of_a.iter().filter(|corner| of_b.contains(corner));
        if common.any(|&corner| of.is_elsewhere(corner)) {
            return;
        }
        if let Some(labels) = body.labels
            && labels.leave_out(body.order, [a, b].map(TreeTriangle))
        {
            return;
        }
        self.candidates += 1;
        let is_apart = |one: usize, of_one: [TreeVertex; 3], other: usize, of_other| {
            let is_common = opposite(of_other, vertex).map(|end| of_one.contains(&end));
            self.wings[one].has_on_one_side(&self.wings[other], is_common)
        };
        if is_apart(one, of_a, other, of_b) || is_apart(other, of_b, one, of_a) {
            return;
        }
        let [at_a, at_b] = [of_a, of_b].map(|corners| corners.map(|it| body.position(it)));
        let numbers = [of_a, of_b].map(|corners| corners.map(|it| it.0));
        let kind = adjacent_contact(S::PRECISION, numbers, &at_a, &at_b, &mut self.exact);
        if let Some(kind) = kind.filter(|kind| of.only.is_none_or(|only| only == *kind)) {
            let triangles = [a, b].map(TreeTriangle);
            self.hits.push(TreeAdjacent { triangles, kind });
        }
    }

    /// Hands hits and counters over.
    fn hand_over<S: Coordinate>(
        &mut self,
        body: &StarredBody<S>,
        statistics: &mut Statistics,
        sink: AdjacentSink<S>,
    ) -> ControlFlow<()> {
        statistics.candidate_pairs += self.candidates;
        statistics.exact_decisions += self.exact;
        statistics.pairs += self.hits.len() as u64;
        let flow = sink(body, &self.hits);
        self.clear();
        flow
    }
}

/// A star whose pairs are decided.
struct Decision<'q, S> {
    body: &'q StarredBody<'q, S>,
    vertex: TreeVertex,
    star: &'q [[u32; 2]],
    only: Option<ContactKind>,
    counts: &'q [StarCounts],
}

impl<S> Decision<'_, S> {
    /// Whether pairs with this corner in common are decided at it, or need not be.
    fn is_elsewhere(&self, corner: TreeVertex) -> bool {
        corner != self.vertex && (corner < self.vertex || self.counts[corner.index()] != UNDECIDED)
    }
}

impl<S: Coordinate> StarredBody<'_, S> {
    fn corners(&self, triangle: u32) -> [TreeVertex; 3] {
        self.shape.triangles[triangle as usize]
    }

    /// Exact position of a vertex.
    fn position(&self, vertex: TreeVertex) -> [f64; 3] {
        self.shape.positions.get(vertex).map(Real::to_f64)
    }

    /// Whether a triangle was removed by an edit.
    fn is_gone(&self, triangle: u32) -> bool {
        let triangle = TreeTriangle(triangle);
        self.removed.is_some_and(|removed| removed.has(triangle))
    }

    /// A hit by the caller's numbers.
    pub(crate) fn to_caller(&self, hit: &TreeAdjacent) -> AdjacentContact {
        let [a, b] = hit.triangles.map(|it| self.order.caller_triangle(it).0);
        let pair = Pair {
            body_a: self.body,
            triangle_a: a.min(b),
            body_b: self.body,
            triangle_b: a.max(b),
        };
        AdjacentContact {
            pair,
            kind: hit.kind,
        }
    }

    /// Appends the edges of the two triangles of a hit that cross the other.
    pub(crate) fn cross(&self, hit: &TreeAdjacent, list: &mut Vec<CrossingEdge>) {
        let [a, b] = hit.triangles.map(|it| self.shape.corners(it));
        let crossing = crossing_edges(S::PRECISION, &a, &b);
        let stop = &|| self.interrupt.is_set();
        for (of, corner) in (0..6).map(|edge| (edge / 3, edge % 3)) {
            if crossing[of][corner]
                && let Some(edge) = self.mesh.own_edge(hit.triangles[of], corner, stop)
            {
                let other = self.order.caller_triangle(hit.triangles[1 - of]);
                list.push(CrossingEdge {
                    edge_body: self.body,
                    edge,
                    triangle_body: self.body,
                    triangle: other.0,
                });
            }
        }
    }
}

held!(Job: wings[], sectors[], hits[]);

held!(AdjacentSearch: counts[], at_left[], left[]; |search| {
    search.found.held_by(held::list) + held::lists(&search.jobs)
});

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Origin, Points};
    use crate::mesh::Topology;
    use crate::threads::{Interrupt, Threads};
    use pliant_oracle::Random;
    use std::num::NonZeroUsize;

    /// A mesh that is not asked for its edges.
    struct NoEdges;

    impl OwnEdges for NoEdges {
        fn own_edge(&self, _: TreeTriangle, _: usize, _: &dyn Fn() -> bool) -> Option<u32> {
            None
        }
    }

    /// Counts at vertices of another run must arrive there, each time.
    #[test]
    fn runs_count_together_what_one_counts() {
        let mut random = Random::new(4);
        let vertices = 4_000;
        let triangles: Vec<[u32; 3]> = (0..7 * Grain::STARS.items as u32)
            .map(|i| [0, 1, 2].map(|_| (i / 5 + random.below(300)) % vertices))
            .collect();
        let topology = Topology::new(&triangles, vertices as usize);
        let order = Order::new(&topology, (0..triangles.len() as u32).collect());
        let stars = Stars::new(&triangles, vertices as usize, &|| false).unwrap();
        let points: Vec<[f32; 3]> = (0..order.vertex_order().len())
            .map(|_| [0, 1, 2].map(|_| random.below(1 << 20) as f32))
            .collect();
        let positions = Points::of(points.into_iter());
        let body = StarredBody {
            body: BodyId(0),
            shape: Shape {
                positions: &positions,
                triangles: order.all_corners(),
                origin: Origin::default(),
                version: 1,
            },
            order: &order,
            removed: None,
            labels: None,
            mesh: &NoEdges,
            stars: &stars,
            interrupt: &Interrupt::default(),
        };
        let counts = [1, 16].map(|threads| {
            let threads = &Threads::private(NonZeroUsize::new(threads).unwrap());
            let interrupt = &Interrupt::default();
            let executor = Executor { threads, interrupt };
            let nanoseconds = Grain::STARS.time(triangles.len());
            assert_eq!(executor.pays(nanoseconds), executor.are_many());
            let mut search = AdjacentSearch::default();
            search.count_stars(&body, Instructions::widest(), executor);
            search.counts
        });
        assert_eq!(counts[0], counts[1]);
    }
}
