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
use crate::held::{Held, held};
use crate::ids::{NodeId, Place};
use crate::kernels::Coordinate;
use crate::queries::Needs;
use crate::statistics::Statistics;
use crate::threads::{Exchange, Executor, Grain, PerThread, locked};
use crate::traversal::{
    Item, Pairs, Piece, Round, Scratch, Tasks, View, Views, Word, leaves_left_out,
};
use crate::update::{DirtySet, Partner, Refit, Refitted};
use std::iter;
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};

/// Pairs of leaves that are tested before tasks go on. A task stops at twice as many, which bounds
/// memory.
const MANY_LEAVES: usize = 1 << 15;
/// Leaves in a run that is tested with its neighbours: the least piece that threads share.
const RUN: usize = 64;

/// Buffers, kept from query to query, and the amount of work of the last query.
#[derive(Debug, Default)]
pub(crate) struct Together {
    /// Trees, each a part of a body, sorted by the places of the bodies.
    trees: Vec<(Place, usize)>,
    pairs: Vec<Pair>,
    items: Items,
    /// Stale wide nodes that were reached, by tree. `reached` holds leaves likewise.
    stale: Vec<Mutex<DirtySet>>,
    reached: Vec<Mutex<DirtySet>>,
    /// Counters by pair of bodies: pairs of nodes, and candidates.
    looked_at: Vec<[u64; 2]>,
    /// Partners of each body, by its place; none if the body takes no part.
    partners: Vec<Option<Partner>>,
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
type EachBody<'e, S> = &'e (dyn Fn(&mut Step, usize, &mut Body<S>) -> ControlFlow<()> + Sync);

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
        let places = pairs.as_flattened().iter();
        let counts = places.map(|&place| bodies.at(place).triangle_count());
        let triangles: usize = counts.sum();
        self.triangles += triangles;
        let a_triangle = Grain::TRIANGLES.time(1);
        let rate = self.rate.unwrap_or(1024 * a_triangle);
        self.work = (triangles as u64).saturating_mul(rate) / 1024;
        executor.pays(self.work)
    }

    /// Estimates the time of the query from its counters, for the next query.
    pub(crate) fn note_cost(&mut self, statistics: &Statistics) {
        // Nanoseconds each, as profiles had them: `benchmarks/NOTES.md`, "Where the time goes".
        let boxes = statistics.boxes_bottom_up + statistics.boxes_top_down;
        let work = 12 * statistics.node_pairs
            + 10 * (boxes + statistics.triangle_boxes)
            + 40 * statistics.candidate_pairs
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
        step.statistics.body_pairs += pairs.len() as u64;
        self.make_ready(step, bodies, pairs)?;
        self.list_pairs(step, bodies, pairs);
        let count = step.refit.executor.count();
        tasks.begin(count);
        tasks.use_all(count);
        let mut work = self.work;
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
        self.list_neighbours(step, bodies);
        let neighbours = Grain::LEAF_PAIRS.time(5 * RUN * self.items.now.len());
        self.round(step, bodies, tasks, neighbours)?;
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
            partners, trees, ..
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
        trees.clear();
        let (mut triangles, mut count) = (0, 0);
        for (place, body) in bodies.all().enumerate() {
            // All bodies, so that trees keep their numbers, and sets their lengths.
            trees.extend((0..body.part_count()).map(|part| (Place(place as u32), part)));
            if partners.get(place).copied().flatten().is_some() {
                triangles += body.triangle_count();
                count += 1;
            }
        }
        for sets in [&mut self.stale, &mut self.reached] {
            // An interrupted query leaves them as they are.
            sets.iter().for_each(|set| locked(set).clear());
            sets.resize_with(sets.len().max(trees.len()), Mutex::default);
        }
        for helper in self.helpers.iter_mut() {
            // A caller's question that panicked leaves them as they are.
            helper.scratch.begin(true);
            helper.statistics = Statistics::default();
        }
        let (partners, helpers) = (&self.partners, &mut self.helpers);
        let partner = |place: usize| partners.get(place).copied().flatten();
        let takes = Grain::TRIANGLES.time(triangles);
        each_body(
            step,
            bodies,
            helpers,
            (count, takes),
            &|step, place, body| match partner(place) {
                Some(partner) => step.prepare(body, partner),
                None => ControlFlow::Continue(()),
            },
        )
    }

    /// Lists all pairs of trees, and the pairs of their roots.
    fn list_pairs<S: Coordinate>(&mut self, step: &Step, bodies: &Bodies<S>, pairs: &[BodyPair]) {
        let Self {
            trees,
            pairs: listed,
            items,
            looked_at,
            ..
        } = self;
        listed.clear();
        looked_at.clear();
        looked_at.resize(pairs.len(), [0; 2]);
        for list in [&mut items.nodes, &mut items.leaves, &mut items.now] {
            list.clear();
        }
        let trees_of = |place: Place| {
            let first = trees.partition_point(|&(at, _)| at.index() < place.index());
            first..first + bodies.at(place).part_count()
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
    fn list_neighbours<S: Coordinate>(&mut self, step: &Step, bodies: &Bodies<S>) {
        for (number, pair) in (0..).zip(&self.pairs) {
            let tree = self.trees[pair.trees[0] as usize];
            if pair.trees[0] != pair.trees[1] {
                continue;
            }
            let mut leaves = 0;
            let count = &mut |pair: Views<S>| leaves = leaves_left_out(&step.needs, &pair);
            show_trees(bodies, (&step.needs, step.origin), [tree; 2], count);
            let runs = (0..leaves).step_by(RUN);
            self.items.now.extend(runs.map(|start| Item {
                pair: number,
                piece: Piece::Neighbours(
                    [start, (start + RUN).min(leaves)].map(|leaf| leaf as u32),
                ),
            }));
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
        };
        let exchange = &Exchange::new(executor, used);
        let round = Round {
            needs: step.needs,
            instructions: step.refit.instructions,
            interrupt: executor.interrupt,
            exchange,
            pairs: lookup,
        };
        tasks.run(executor, used, &|task, work| task.run_round(&round, work));
        if executor.is_interrupted() {
            return ControlFlow::Break(());
        }
        for number in 0..used {
            let share = &mut tasks.one(number).share;
            items.nodes.append(&mut share.waiting);
            items.leaves.append(&mut share.leaves);
            let both = [
                (&mut self.stale, &mut share.stale),
                (&mut self.reached, &mut share.reached),
            ];
            for (sets, words) in both {
                for Word { tree, number, bits } in words.drain(..) {
                    let set = sets[tree as usize].get_mut();
                    let set = set.unwrap_or_else(PoisonError::into_inner);
                    set.insert_bits(number as usize, bits);
                }
            }
            for (pair, looked_at) in share.looked_at.drain(..) {
                let sum = &mut self.looked_at[pairs[pair as usize].of as usize];
                for (sum, count) in sum.iter_mut().zip(looked_at) {
                    *sum += count;
                }
                step.statistics.node_pairs += looked_at[0];
            }
        }
        tasks.show(used, step.statistics)
    }

    /// Refits the stale wide nodes that tasks have noted.
    fn refit_stale<S: Coordinate>(
        &mut self,
        step: &mut Step,
        bodies: &mut Bodies<S>,
    ) -> ControlFlow<()> {
        let sets = (&self.trees[..], &self.stale[..]);
        refit(
            step,
            bodies,
            sets,
            &mut self.helpers,
            &|step, one, stale| {
                let lists = &mut step.scratch.wide_nodes;
                step.refit.reached(one, stale, lists, step.statistics);
            },
        )
    }

    /// Refits the boxes of the triangles in leaves that were reached.
    fn refit_leaves<S: Coordinate>(
        &mut self,
        step: &mut Step,
        bodies: &mut Bodies<S>,
    ) -> ControlFlow<()> {
        let sets = (&self.trees[..], &self.reached[..]);
        refit(
            step,
            bodies,
            sets,
            &mut self.helpers,
            &|step, one, reached| {
                step.refit.reached_leaves(one, reached, step.statistics);
            },
        )
    }

    /// Passes counters to bodies, which measure the decay of their trees by them.
    fn tell_bodies<S: Coordinate>(&self, bodies: &mut Bodies<S>, pairs: &[BodyPair]) {
        for (&[a, b], &[node_pairs, candidates]) in pairs.iter().zip(&self.looked_at) {
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
}

impl<S: Coordinate> Pairs<S> for Lookup<'_, S> {
    fn show(&self, pair: u32, see: &mut dyn FnMut(Views<S>, [u32; 2])) {
        let numbers = self.pairs[pair as usize].trees;
        let trees = numbers.map(|tree| self.trees[tree as usize]);
        let queried = (&self.needs, self.origin);
        show_trees(self.bodies, queried, trees, &mut |pair| see(pair, numbers));
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
        debug_assert!(false, "a tree has no boxes");
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

/// Refits the boxes that were reached, in all trees.
fn refit<S: Coordinate>(
    step: &mut Step,
    bodies: &mut Bodies<S>,
    (trees, sets): (&[(Place, usize)], &[Mutex<DirtySet>]),
    helpers: &mut PerThread<RefitBuffers>,
    make: MakeBoxes<S>,
) -> ControlFlow<()> {
    let of_trees = || trees.iter().zip(sets);
    let (mut count, mut reached) = (0, 0);
    for (_, set) in of_trees() {
        let set = locked(set);
        count += usize::from(!set.is_empty());
        reached += set.count();
    }
    if count == 0 {
        return ControlFlow::Continue(());
    }
    let takes = Grain::LEAVES.time(reached);
    each_body(
        step,
        bodies,
        helpers,
        (count, takes),
        &|step, place, body| {
            let first = trees.partition_point(|&(at, _)| at.index() < place);
            let own = of_trees().skip(first);
            for (&(_, part), set) in own.take_while(|&(&(at, _), _)| at.index() == place) {
                let set = &mut *locked(set);
                if !set.is_empty() {
                    let mut side = body.side(&step.needs, step.origin, part);
                    make(step, &mut side.refitted(), set);
                }
            }
            ControlFlow::Continue(())
        },
    )
}

/// Runs an action on every body. Many bodies are processed in parallel, each on one thread; few one
/// by one, with all threads. It concerns `count` bodies, and takes about `nanoseconds`.
fn each_body<S: Coordinate>(
    step: &mut Step,
    bodies: &mut Bodies<S>,
    helpers: &mut PerThread<RefitBuffers>,
    (count, nanoseconds): (usize, u64),
    do_one: EachBody<S>,
) -> ControlFlow<()> {
    let executor = step.refit.executor;
    let threads = executor.threads_for(nanoseconds);
    if threads > 1 && count >= threads {
        helpers.for_threads(executor.count());
        let (needs, refit, origin) = (step.needs, step.refit, step.origin);
        let helping = &*helpers;
        let mut jobs: Vec<_> = bodies.all_mut().enumerate().collect();
        executor.run(&mut jobs, nanoseconds, |_, (place, body)| {
            // Not locked while the job is done: a lent pool may have threads of one number.
            let mut own = std::mem::take(&mut *helping.own());
            let RefitBuffers {
                scratch,
                statistics,
            } = &mut own;
            let executor = executor.alone();
            let mut step = Step {
                needs,
                refit: Refit { executor, ..refit },
                origin,
                scratch,
                statistics,
            };
            let _ = do_one(&mut step, *place, body);
            let kept = &mut *helping.own();
            kept.statistics += own.statistics;
            kept.scratch = own.scratch;
        });
        for helper in helpers.iter_mut() {
            *step.statistics += std::mem::take(&mut helper.statistics);
        }
    } else {
        for (place, body) in bodies.all_mut().enumerate() {
            do_one(step, place, body)?;
        }
    }
    if executor.is_interrupted() {
        return ControlFlow::Break(());
    }
    ControlFlow::Continue(())
}

held!(Together: trees[], pairs[], items, looked_at[], partners[];
    |it| it.helpers.held_by(|helper| helper.scratch.held())
        + [&it.stale, &it.reached].into_iter().map(sets_held).sum::<usize>());

held!(Items: nodes[], leaves[], now[]);

fn sets_held(sets: &Vec<Mutex<DirtySet>>) -> usize {
    crate::held::list(sets) + sets.iter().map(|set| locked(set).held()).sum::<usize>()
}
