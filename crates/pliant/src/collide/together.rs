//! Many pairs of bodies at once, on several threads, for queries that want all hits.
//!
//! Idea: level by level over all pairs of bodies together. Bodies are prepared, then tasks descend
//! all trees (`traversal::Round`) until they need stale boxes, which are refitted, and so on.
//! Leaves follow, and neighbours in bodies that meet themselves. So threads wait for each other a
//! few times in a query, not a few times in every pair of bodies. Invariant: boxes, hits and
//! counters are the same as if pairs were processed one by one (`step`).

use super::body_pairs::BodyPair;
use super::step::{SAYS_NOTHING, Step};
use crate::bodies::{Bodies, Body, Work};
use crate::geometry::Origin;
use crate::held::held;
use crate::ids::{NodeId, Place};
use crate::kernels::Coordinate;
use crate::queries::Needs;
use crate::statistics::Statistics;
use crate::threads::{Exchange, Executor, Grain, PerThread};
use crate::traversal::{Item, Pairs, Piece, Round, Scratch, Tasks, View, Views};
use crate::update::{DirtySet, DirtySets, Partner, Refit, Refitted};
use pliant_exact::DEBUG;
use std::iter;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

/// Pairs of leaves that are tested before tasks go on. A task stops at twice as many, which bounds
/// memory.
const MANY_LEAVES: usize = 1 << 15;
/// Least work that is worth rounds, in nanoseconds. With less, two threads took longer by rounds
/// than one thread pair by pair.
const LEAST_WORK: u64 = 30_000;
/// Most pairs of bodies at once, for each thread: the next round still finds them in a cache.
const PAIRS_A_THREAD: usize = 1 << 12;
/// Most pairs of bodies whose triangles are counted, to see what a query is worth.
const SAMPLE: usize = 1024;
/// Bodies whose trees a job looks up.
const BODIES: usize = 64;
/// Leaves in a run that is tested with its neighbours: the least piece that threads share.
const RUN: u32 = 64;

/// Buffers, kept from query to query, and the amount of work of the last query.
#[derive(Debug, Default)]
pub(crate) struct Together {
    /// Partners of each body, by its place; none if the body takes no part.
    partners: Vec<Option<Partner>>,
    /// Trees of all bodies that take part, each a part of a body, sorted by the places of these.
    trees: Vec<(Place, usize)>,
    /// Number of the first tree of each body, by its place; the first behind them at the end.
    first_trees: Vec<u32>,
    /// Bodies that are to be prepared or refitted, by their places, and how much that is.
    concerned: Vec<(Place, usize)>,
    pairs: Vec<Pair>,
    items: Items,
    /// Stale wide nodes that were reached, by tree. `reached` holds leaves likewise.
    stale: DirtySets,
    reached: DirtySets,
    /// Counters by pair of bodies: pairs of nodes, and candidates.
    looked_at: Vec<[AtomicU64; 2]>,
    helpers: PerThread<RefitBuffers>,
    /// Triangles of all pairs of bodies of the query so far.
    triangles: usize,
    /// Estimated time of the last query a triangle, in 1,024ths of a nanosecond.
    rate: Option<u64>,
    /// Estimated time of the present pairs on one thread, in nanoseconds.
    work: u64,
}

/// Two trees, or one twice.
#[derive(Clone, Copy, Debug)]
struct Pair {
    trees: [u32; 2],
    /// Number of their pair of bodies.
    of: u32,
}

/// Items of the present round (`now`) and of later rounds.
#[derive(Debug, Default)]
struct Items {
    nodes: Vec<Item>,
    leaves: Vec<Item>,
    now: Vec<Item>,
}

/// Buffers and counters of one thread that refits boxes.
#[derive(Debug, Default)]
struct RefitBuffers {
    scratch: Scratch,
    statistics: Statistics,
}

/// Action on a body and its place.
type EachBody<'e, S> = &'e (dyn Fn(&mut Step, Place, &mut Body<S>) -> ControlFlow<()> + Sync);

impl Together {
    /// A query begins.
    pub(crate) fn begin(&mut self) {
        self.triangles = 0;
    }

    /// Whether pairs of bodies are worth several threads, judged by their triangles and by what
    /// these took in the last query.
    pub(crate) fn pays_for_threads<S: Coordinate>(
        &mut self,
        executor: Executor,
        bodies: &Bodies<S>,
        pairs: &[BodyPair],
    ) -> bool {
        if !executor.are_many() {
            return false;
        }
        // Some of many pairs stand for all.
        let every = pairs.len().div_ceil(SAMPLE).max(1);
        let places = pairs.iter().step_by(every).flatten();
        let counts = places.map(|&place| bodies.at(place).triangle_count());
        let triangles = every * counts.sum::<usize>();
        self.triangles += triangles;
        let a_triangle = Grain::TRIANGLES.time(1);
        let rate = self.rate.unwrap_or(1024 * a_triangle);
        self.work = (triangles as u64).saturating_mul(rate) / 1024;
        self.work >= LEAST_WORK && executor.pays(self.work)
    }

    /// Estimates the time of the query from its counters, for the next query.
    pub(crate) fn note_cost(&mut self, needs: &Needs, statistics: &Statistics) {
        // Nanoseconds each: rough, fitted to queries of two spheres, a cloth and a crowd.
        let boxes = statistics.boxes_bottom_up + statistics.boxes_top_down;
        let a_node_pair = if needs.triangles() { 8 } else { 30 };
        let work = a_node_pair * statistics.node_pairs
            + 6 * (boxes + statistics.triangle_boxes)
            + 12 * statistics.candidate_pairs
            + 20 * statistics.pairs;
        let triangles = std::mem::take(&mut self.triangles) as u64;
        self.rate = (1024 * work).checked_div(triangles).or(self.rate);
    }

    /// Processes all pairs of bodies. Breaks if it is interrupted, or there are too many hits.
    pub(crate) fn meet<S: Coordinate>(
        &mut self,
        step: &mut Step,
        bodies: &mut Bodies<S>,
        pairs: &[BodyPair],
        tasks: &mut dyn Tasks<S>,
    ) -> ControlFlow<()> {
        let at_once = PAIRS_A_THREAD * step.refit.executor.count();
        pairs.chunks(at_once).try_for_each(|some| {
            let mut work = self.work / pairs.len() as u64 * some.len() as u64;
            if step.needs.triangles() && some.iter().all(|[a, b]| a == b) {
                // Most of it is in neighbours, which have a round of their own.
                work /= 4;
            }
            self.meet_some(step, bodies, (some, work), tasks)
        })
    }

    /// Processes some pairs of bodies, which take about `work` nanoseconds.
    fn meet_some<S: Coordinate>(
        &mut self,
        step: &mut Step,
        bodies: &mut Bodies<S>,
        (pairs, mut work): (&[BodyPair], u64),
        tasks: &mut dyn Tasks<S>,
    ) -> ControlFlow<()> {
        step.statistics.body_pairs += pairs.len() as u64;
        self.make_ready(step, bodies, pairs)?;
        self.list_pairs(step, bodies, pairs);
        let count = step.refit.executor.count();
        tasks.begin(count);
        tasks.use_all(count);
        while !self.items.nodes.is_empty() {
            std::mem::swap(&mut self.items.nodes, &mut self.items.now);
            self.round(step, bodies, tasks, work)?;
            work = Grain::NODE_PAIRS.time(self.items.nodes.len());
            self.refit_stale(step, bodies)?;
            let leaves = self.items.leaves.len();
            if self.items.nodes.is_empty() || leaves >= MANY_LEAVES {
                self.refit_leaves(step, bodies)?;
                std::mem::swap(&mut self.items.leaves, &mut self.items.now);
                self.round(step, bodies, tasks, Grain::LEAF_PAIRS.time(leaves))?;
            }
        }
        self.list_neighbours(&step.needs);
        let neighbours = Grain::NEIGHBOURS.time(RUN as usize * self.items.now.len());
        self.round(step, bodies, tasks, neighbours)?;
        let looked_at = self.looked_at.iter_mut();
        step.statistics.node_pairs += looked_at.map(|[pairs, _]| *pairs.get_mut()).sum::<u64>();
        if step.needs.triangles() {
            self.tell_bodies(bodies, pairs);
        }
        ControlFlow::Continue(())
    }

    /// Brings all bodies into tree order and refits the upper levels of their trees.
    fn make_ready<S: Coordinate>(
        &mut self,
        step: &mut Step,
        bodies: &mut Bodies<S>,
        pairs: &[BodyPair],
    ) -> ControlFlow<()> {
        let Self {
            partners,
            trees,
            first_trees,
            concerned,
            stale,
            reached,
            ..
        } = self;
        partners.clear();
        for &[a, b] in pairs {
            let partner = if a == b {
                Partner::Itself
            } else {
                Partner::Another
            };
            for place in [a, b] {
                let end = partners.len().max(place.index() + 1);
                partners.resize(end, None);
                partners[place.index()] = Some(partner);
            }
        }
        concerned.clear();
        let places = (0..).map(Place).zip(&*partners);
        let places = places.filter_map(|(place, partner)| partner.map(|_| (place, 0)));
        concerned.extend(places);
        // Many bodies are in no cache, so that threads look them up together.
        let chunks = concerned.chunks_mut(BODIES);
        let mut jobs: Vec<_> = chunks.map(|bodies| (bodies, Vec::new())).collect();
        let nanoseconds = Grain::BODIES.time(BODIES * jobs.len());
        let executor = step.refit.executor;
        executor.run(&mut jobs, nanoseconds, |_, (concerned, trees)| {
            for (place, triangles) in &mut **concerned {
                let body = bodies.at(*place);
                *triangles = body.triangle_count();
                trees.extend(body.trees().enumerate().map(|(part, tree)| {
                    ((*place, part), [tree.wide_nodes.len(), tree.leaves.len()])
                }));
            }
        });
        trees.clear();
        first_trees.clear();
        // An interrupted query leaves them as they are.
        stale.clear();
        reached.clear();
        for &((place, part), [wide_nodes, leaves]) in jobs.iter().flat_map(|(_, trees)| trees) {
            let before = first_trees.len().max(place.index() + 1);
            first_trees.resize(before, trees.len() as u32);
            trees.push((place, part));
            stale.push(wide_nodes);
            reached.push(leaves);
        }
        first_trees.push(trees.len() as u32);
        for helper in self.helpers.iter_mut() {
            // A caller's question that panicked leaves them as they are.
            helper.scratch.begin(true);
            helper.statistics = Statistics::default();
        }
        let (concerned, helpers) = (&self.concerned, &mut self.helpers);
        each_body(
            step,
            bodies,
            helpers,
            (concerned, Grain::TRIANGLES),
            &|step, place, body| match partners[place.index()] {
                Some(partner) => step.prepare(body, partner),
                None => ControlFlow::Continue(()),
            },
        )
    }

    /// Lists all pairs of trees, and the pairs of their roots.
    fn list_pairs<S: Coordinate>(&mut self, step: &Step, bodies: &Bodies<S>, pairs: &[BodyPair]) {
        let Self {
            trees,
            first_trees,
            pairs: listed,
            items,
            looked_at,
            ..
        } = self;
        listed.clear();
        looked_at.clear();
        looked_at.resize_with(pairs.len(), Default::default);
        for list in [&mut items.nodes, &mut items.leaves, &mut items.now] {
            list.clear();
        }
        let trees_of = |place: Place| {
            let [first, end] = [place.index(), place.index() + 1];
            first_trees[first] as usize..first_trees[end] as usize
        };
        let do_overlap = |both: [usize; 2]| {
            let mut do_overlap = false;
            let both = both.map(|tree| trees[tree]);
            show_trees(bodies, (&step.needs, step.origin), both, &mut |pair| {
                do_overlap = pair.do_overlap();
            });
            do_overlap
        };
        for (of, &[a, b]) in (0..).zip(pairs) {
            let (of_a, of_b) = (trees_of(a), trees_of(b));
            let are_several = of_a.len() + of_b.len() > 2;
            for tree_a in of_a {
                // In one body, every two trees once, and each with itself.
                let others = if a == b {
                    tree_a..of_b.end
                } else {
                    of_b.clone()
                };
                for tree_b in others {
                    let both = [tree_a, tree_b];
                    if tree_a == tree_b || !are_several || do_overlap(both) {
                        let pair = listed.len() as u32;
                        let trees = both.map(|tree| tree as u32);
                        listed.push(Pair { trees, of });
                        let piece = Piece::Nodes([NodeId::ROOT; 2]);
                        items.nodes.push(Item { pair, piece });
                    }
                }
            }
        }
    }

    /// Lists runs of leaves of bodies that meet themselves, where the descent left out neighbours.
    fn list_neighbours(&mut self, needs: &Needs) {
        for (number, &Pair { trees: [a, b], .. }) in (0..).zip(&self.pairs) {
            if a == b && needs.triangles() {
                // A word of 64 leaves is a run.
                let runs = 0..self.reached.words(a as usize) as u32;
                self.items.now.extend(runs.map(|run| Item {
                    pair: number,
                    piece: Piece::Neighbours([run, run + 1].map(|run| run * RUN)),
                }));
            }
        }
    }

    /// Runs a round over the items in `now`, which takes about `nanoseconds`, and takes its results
    /// over.
    fn round<S: Coordinate>(
        &mut self,
        step: &mut Step,
        bodies: &Bodies<S>,
        tasks: &mut dyn Tasks<S>,
        nanoseconds: u64,
    ) -> ControlFlow<()> {
        let items = &mut self.items;
        if items.now.is_empty() {
            return ControlFlow::Continue(());
        }
        let executor = step.refit.executor;
        let used = executor.threads_for(nanoseconds);
        let shares = items.now.chunks(items.now.len().div_ceil(used));
        for (number, share) in (0..used).zip(shares.chain(iter::repeat(&[][..]))) {
            let todo = &mut tasks.one(number).share.todo;
            todo.clear();
            todo.extend_from_slice(share);
        }
        items.now.clear();
        let (trees, pairs) = (&self.trees, &self.pairs);
        let lookup = &Lookup {
            bodies,
            needs: step.needs,
            origin: step.origin,
            trees,
            pairs,
            looked_at: &self.looked_at,
        };
        let exchange = &Exchange::new(executor, used);
        let round = Round {
            needs: step.needs,
            instructions: step.refit.instructions,
            interrupt: executor.interrupt,
            exchange,
            pairs: lookup,
            stale: &self.stale,
            reached: &self.reached,
        };
        tasks.run(executor, used, &|task, work| task.run_round(&round, work));
        if executor.is_interrupted() {
            return ControlFlow::Break(());
        }
        items.nodes.append(&mut exchange.rest());
        for number in 0..used {
            let share = &mut tasks.one(number).share;
            items.nodes.append(&mut share.waiting);
            items.leaves.append(&mut share.leaves);
        }
        tasks.show(used, step.statistics)
    }

    /// Refits the stale wide nodes that tasks have noted.
    fn refit_stale<S: Coordinate>(
        &mut self,
        step: &mut Step,
        bodies: &mut Bodies<S>,
    ) -> ControlFlow<()> {
        self.refit(step, bodies, |it| &it.stale, &|step, one, stale| {
            let lists = &mut step.scratch.wide_nodes;
            step.refit.reached(one, stale, lists, step.statistics);
        })
    }

    /// Refits the boxes of the triangles in leaves that were reached.
    fn refit_leaves<S: Coordinate>(
        &mut self,
        step: &mut Step,
        bodies: &mut Bodies<S>,
    ) -> ControlFlow<()> {
        self.refit(step, bodies, |it| &it.reached, &|step, one, reached| {
            step.refit.reached_leaves(one, reached, step.statistics);
        })
    }

    /// Refits the boxes that were reached, in all trees.
    fn refit<S: Coordinate>(
        &mut self,
        step: &mut Step,
        bodies: &mut Bodies<S>,
        sets: fn(&Self) -> &DirtySets,
        make: MakeBoxes<S>,
    ) -> ControlFlow<()> {
        let mut concerned = std::mem::take(&mut self.concerned);
        concerned.clear();
        for (tree, &(place, _)) in self.trees.iter().enumerate() {
            let count = sets(self).count(tree);
            match concerned.last_mut() {
                _ if count == 0 => {}
                Some((last, sum)) if *last == place => *sum += count,
                _ => concerned.push((place, count)),
            }
        }
        let mut helpers = std::mem::take(&mut self.helpers);
        let (trees, first_trees, sets) = (&self.trees, &self.first_trees, sets(self));
        let done = each_body(
            step,
            bodies,
            &mut helpers,
            (&concerned, Grain::LEAVES),
            &|step, place, body| {
                for tree in first_trees[place.index()]..first_trees[place.index() + 1] {
                    let mut set = std::mem::take(&mut step.scratch.reached[0]);
                    sets.take(tree as usize, &mut set);
                    if !set.is_empty() {
                        let (_, part) = trees[tree as usize];
                        let mut side = body.side(&step.needs, step.origin, part);
                        make(step, &mut side.refitted(), &mut set);
                    }
                    step.scratch.reached[0] = set;
                }
                ControlFlow::Continue(())
            },
        );
        (self.concerned, self.helpers) = (concerned, helpers);
        done
    }

    /// Passes counters to bodies, which measure the decay of their trees by them.
    fn tell_bodies<S: Coordinate>(&mut self, bodies: &mut Bodies<S>, pairs: &[BodyPair]) {
        for (&[a, b], looked_at) in pairs.iter().zip(&mut self.looked_at) {
            let [node_pairs, candidates] = looked_at.each_mut().map(|count| *count.get_mut());
            if node_pairs < SAYS_NOTHING {
                continue;
            }
            if a == b {
                let body = bodies.at_mut(a);
                let triangles = body.mesh().topology().live_count();
                body.note_work(Work::of_one(node_pairs, candidates, triangles));
            } else {
                for place in [a, b] {
                    let body = bodies.at_mut(place);
                    body.note_work(Work::of_two(node_pairs, candidates));
                }
            }
        }
    }
}

/// Pairs of trees by their numbers, for tasks.
struct Lookup<'q, S> {
    bodies: &'q Bodies<S>,
    needs: Needs,
    origin: Origin,
    trees: &'q [(Place, usize)],
    pairs: &'q [Pair],
    looked_at: &'q [[AtomicU64; 2]],
}

impl<S: Coordinate> Pairs<S> for Lookup<'_, S> {
    fn show(&self, pair: u32, see: &mut dyn FnMut(Views<S>, [u32; 2])) {
        let numbers = self.pairs[pair as usize].trees;
        let trees = numbers.map(|tree| self.trees[tree as usize]);
        let queried = (&self.needs, self.origin);
        show_trees(self.bodies, queried, trees, &mut |pair| see(pair, numbers));
    }

    fn count(&self, pair: u32, looked_at: [u64; 2]) {
        let of = self.pairs[pair as usize].of;
        for (sum, count) in self.looked_at[of as usize].iter().zip(looked_at) {
            sum.fetch_add(count, Ordering::Relaxed);
        }
    }
}

/// Shows the views of two trees, or of one with itself. Their bodies were made ready.
fn show_trees<S: Coordinate>(
    bodies: &Bodies<S>,
    (needs, origin): (&Needs, Origin),
    [a, b]: [(Place, usize); 2],
    see: &mut dyn FnMut(Views<S>),
) {
    let read = |(place, part): (Place, usize)| bodies.at(place).read(needs, origin, part);
    let Some((read_a, boxes)) = read(a) else {
        if DEBUG {
            unreachable!("a tree has no boxes");
        }
        return;
    };
    let first = View {
        read: &read_a,
        boxes,
    };
    if a == b {
        see(Views::one(first));
    } else if let Some((read_b, boxes)) = read(b) {
        let read = &read_b;
        see(Views::two([first, View { read, boxes }]));
    }
}

/// Refits boxes of a tree, which were reached.
type MakeBoxes<'e, S> = &'e (dyn Fn(&mut Step, &mut Refitted<S>, &mut DirtySet) + Sync);

/// Runs an action on some bodies, given by their places and by how much it is, in items of a grain.
fn each_body<S: Coordinate>(
    step: &mut Step,
    bodies: &mut Bodies<S>,
    helpers: &mut PerThread<RefitBuffers>,
    (concerned, grain): (&[(Place, usize)], Grain),
    do_one: EachBody<S>,
) -> ControlFlow<()> {
    let executor = step.refit.executor;
    helpers.for_threads(executor.count());
    let (needs, refit, origin) = (step.needs, step.refit, step.origin);
    let helping = &*helpers;
    let all = bodies.some_mut(concerned.iter().map(|&(place, _)| place));
    let mut jobs: Vec<_> = concerned.iter().zip(all).collect();
    let items = concerned.iter().map(|&(_, items)| items).sum();
    let nanoseconds = grain.time(items) + Grain::BODIES.time(jobs.len());
    let items = |&(&(_, items), _): &(&(Place, usize), &mut Body<S>)| items;
    executor.run_uneven(&mut jobs, items, nanoseconds, |(of, body), executor| {
        // Not locked while the job is done: a lent pool may have threads of one number.
        let mut own = std::mem::take(&mut *helping.own());
        let RefitBuffers {
            scratch,
            statistics,
        } = &mut own;
        let mut step = Step {
            needs,
            refit: Refit { executor, ..refit },
            origin,
            scratch,
            statistics,
        };
        let _ = do_one(&mut step, of.0, body);
        let kept = &mut *helping.own();
        kept.statistics += own.statistics;
        kept.scratch = own.scratch;
    });
    for helper in helpers.iter_mut() {
        *step.statistics += std::mem::take(&mut helper.statistics);
    }
    if executor.is_interrupted() {
        return ControlFlow::Break(());
    }
    ControlFlow::Continue(())
}

held!(Together: partners[], trees[], first_trees[], concerned[], pairs[], items, stale, reached,
    looked_at[]; |it| it.helpers.held_by(|helper| helper.scratch.held()));

held!(Items: nodes[], leaves[], now[]);
