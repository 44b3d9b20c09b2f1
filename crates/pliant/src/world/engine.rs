//! A world behind its public face: the one place where the phases meet, and where the degree of the trees is a type.
//!
//! [`World`](super::World) holds an engine of which it knows neither the degree nor, in a user's code, anything generic: `Engine` is
//! compiled here, once for every degree and for `f32` and `f64`, and a user's crate holds only calls.

use super::asked::{Asked, Common};
use super::bodies::Bodies;
use super::body::{self, Body};
use super::body_pairs::BodyPairs;
use super::close::AskedClose;
use super::distance::{self, Distances};
use super::impacts::{AskedImpacts, OfKind};
use super::origin::FloatingOrigin;
use super::query::{Ask, Request};
use super::witness::{self, Witnesses};
use super::{BodyId, NodeBox, Selection, TreeShape};
use crate::close_pairs::{CloseEdgeEdge, CloseTriangles, CloseVertexTriangle};
use crate::contacts::Contact;
use crate::edit::{Edit, Edited};
use crate::error::{Error, ErrorKind};
use crate::geometry::Bounds;
use crate::held::{self, Held};
use crate::hits::{EdgeEdge, Pair, VertexTriangle};
use crate::impacts::{EdgeEdgeImpact, Impact, VertexTriangleImpact};
use crate::kernels::{Coordinate, Instructions};
use crate::options::Options;
use crate::queries::{
    Close, Contacts, EdgeEdgeCandidates, Impacts, Intersections, Kind, Margin, Measured,
    NearTriangles, NearestPair, Needs, Reach, VertexTriangleCandidates,
};
use crate::statistics::Statistics;
use crate::threads::{Executor, Interrupt, Question, Threads};
use crate::traversal::{Scratch, Visitor};
use crate::tree::Tree;
use std::convert::Infallible;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

/// An engine of any degree. What its methods do is said where [`World`](super::World) has them.
pub(crate) trait AnyEngine<S>:
    Ask<Pair>
    + Ask<Contact>
    + Ask<VertexTriangle>
    + Ask<EdgeEdge>
    + Ask<CloseVertexTriangle>
    + Ask<CloseEdgeEdge>
    + Ask<CloseTriangles>
    + Ask<VertexTriangleImpact>
    + Ask<EdgeEdgeImpact>
    + Send
    + Sync
{
    fn copy(&self) -> Box<dyn AnyEngine<S>>;
    fn options(&self) -> &Options;
    fn use_instructions(&mut self, instructions: Instructions);
    fn add(&mut self, triangles: &[[u32; 3]], positions: &[[S; 3]]) -> Result<BodyId, Error>;
    fn remove(&mut self, id: BodyId) -> Result<(), Error>;
    fn ids(&self) -> &[BodyId];
    fn next_id(&self) -> Option<u32>;
    fn skip_ids(&mut self, next: Option<u32>);
    fn set_positions(&mut self, id: BodyId, positions: &[[S; 3]]) -> Result<(), Error>;
    fn write_positions(
        &mut self,
        id: BodyId,
        write: &mut dyn FnMut(&mut [[S; 3]]),
    ) -> Result<(), Error>;
    fn set_mesh(
        &mut self,
        id: BodyId,
        triangles: &[[u32; 3]],
        positions: &[[S; 3]],
    ) -> Result<(), Error>;
    fn edit(&self, id: BodyId) -> Result<Edit<S>, Error>;
    fn apply(&mut self, edit: &Edit<S>) -> Result<Edited, Error>;
    fn live_triangles(&self, id: BodyId) -> Result<Vec<bool>, Error>;
    fn live_vertices(&self, id: BodyId) -> Result<Vec<bool>, Error>;
    fn tree_quality(&self, id: BodyId) -> Result<f64, Error>;
    fn mesh_revision(&self, id: BodyId) -> Result<u64, Error>;
    fn rebuild(&mut self, id: BodyId) -> Result<(), Error>;
    fn set_motion(&mut self, id: BodyId, end: &[[S; 3]]) -> Result<(), Error>;
    fn finish_motion(&mut self);
    fn advance_motion(&mut self, t: f64) -> Result<(), Error>;
    fn end_positions(&self, id: BodyId) -> Result<Option<Vec<[S; 3]>>, Error>;
    fn is_moving(&self, id: BodyId) -> Result<bool, Error>;
    fn set_vertex_groups(&mut self, id: BodyId, groups: &[u32]) -> Result<(), Error>;
    fn vertex_groups(&self, id: BodyId) -> Result<Vec<u32>, Error>;
    fn edges(&self, id: BodyId) -> Result<&[[u32; 2]], Error>;
    fn numbered_edges(&self, id: BodyId) -> Result<Option<&[[u32; 2]]>, Error>;
    fn number_edges(&mut self, id: BodyId, edges: &[[u32; 2]]) -> Result<bool, Error>;
    fn set_filter(&mut self, id: BodyId, membership: u32, mask: u32) -> Result<(), Error>;
    fn ignore(&mut self, a: BodyId, b: BodyId) -> Result<(), Error>;
    fn unignore(&mut self, a: BodyId, b: BodyId) -> Result<(), Error>;
    fn set_loose_box(&mut self, id: BodyId, corners: Option<([S; 3], [S; 3])>)
    -> Result<(), Error>;
    fn filter(&self, id: BodyId) -> Result<(u32, u32), Error>;
    fn ignored(&self) -> Vec<[BodyId; 2]>;
    fn loose_box(&self, id: BodyId) -> Result<Option<([S; 3], [S; 3])>, Error>;
    fn triangles(&self, id: BodyId) -> Result<&[[u32; 3]], Error>;
    fn vertex_count(&self, id: BodyId) -> Result<usize, Error>;
    fn positions(&self, id: BodyId) -> Result<Vec<[S; 3]>, Error>;
    fn tree_shape(&self, id: BodyId) -> Result<TreeShape, Error>;
    fn tree_cut(&self, id: BodyId, level: u32) -> Result<Vec<u32>, Error>;
    fn tree_boxes(&self, id: BodyId, level: u32) -> Result<Vec<NodeBox<S>>, Error>;
    fn vertex_order(&self, id: BodyId) -> Result<&[u32], Error>;
    fn distance(
        &mut self,
        of: [BodyId; 2],
        cut_off: f64,
        question: Option<Question>,
    ) -> Result<Option<CloseTriangles>, Error>;
    fn nearest_body(
        &mut self,
        id: BodyId,
        cut_off: f64,
        question: Option<Question>,
    ) -> Result<Option<CloseTriangles>, Error>;
    fn first_impact(
        &mut self,
        of: Selection,
        width: f64,
        question: Option<Question>,
    ) -> Result<Option<Impact>, Error>;
    fn collision_free_step(
        &mut self,
        of: Selection,
        min_distance: f64,
        question: Option<Question>,
    ) -> Result<f64, Error>;
    fn statistics(&self) -> &Statistics;
    fn memory_usage(&self) -> usize;
    fn validate(&self) -> Result<(), String>;
}

/// How many engines there were.
static ENGINES: AtomicU64 = AtomicU64::new(0);

/// An engine whose trees have degree `N`.
pub(super) struct Engine<S: Coordinate> {
    pub(super) common: Common<S>,
    intersections: Asked<Intersections<S>>,
    contacts: Asked<Contacts<S>>,
    vertex_triangle: Asked<VertexTriangleCandidates<S>>,
    edge_edge: Asked<EdgeEdgeCandidates<S>>,
    close_vertex_triangle: AskedClose<Close<VertexTriangleCandidates<S>>>,
    close_edge_edge: AskedClose<Close<EdgeEdgeCandidates<S>>>,
    close_triangles: AskedClose<NearTriangles<S>>,
    impacts: AskedImpacts<S>,
    witnesses: Witnesses,
    distances: Distances,
    /// A shape that is not a body's yet: what `write_positions` lends, where `advance_motion` goes.
    lent: Vec<[S; 3]>,
    /// Which world it is, among all of the process.
    number: u64,
}

/// An engine.
pub(super) fn engine<S: Coordinate>(options: Options, threads: Threads) -> Box<dyn AnyEngine<S>> {
    Box::new(Engine::new(options, threads))
}

/// A refusal of a call about a body.
fn about(body: BodyId) -> impl Fn(ErrorKind) -> Error {
    move |kind| Error {
        body: Some(body),
        kind,
    }
}

impl<S: Coordinate> Engine<S> {
    pub(super) fn new(options: Options, threads: Threads) -> Self {
        Self {
            common: Common {
                options,
                instructions: Instructions::widest(),
                threads,
                bodies: Bodies::default(),
                body_pairs: BodyPairs::new(options.broad_phase),
                origin: FloatingOrigin::default(),
                scratch: Scratch::default(),
                statistics: Statistics::default(),
                done_early: Statistics::default(),
            },
            intersections: Asked::default(),
            contacts: Asked::default(),
            vertex_triangle: Asked::default(),
            edge_edge: Asked::default(),
            close_vertex_triangle: AskedClose::default(),
            close_edge_edge: AskedClose::default(),
            close_triangles: AskedClose::default(),
            impacts: AskedImpacts::default(),
            witnesses: Witnesses::default(),
            distances: Distances::default(),
            lent: Vec::new(),
            number: ENGINES.fetch_add(1, Ordering::Relaxed),
        }
    }

    fn body(&self, id: BodyId) -> Result<&Body<S>, Error> {
        self.common.bodies.get(id)
    }

    /// Changes a body, with the threads that there are; or leaves it as it is and says which body it is about.
    fn change(
        &mut self,
        id: BodyId,
        change: impl FnOnce(&mut Body<S>, Instructions, Executor) -> Result<(), ErrorKind>,
    ) -> Result<(), Error> {
        let Common {
            instructions,
            threads,
            bodies,
            ..
        } = &mut self.common;
        let executor = Executor {
            threads: threads.here(),
            interrupt: &Interrupt::default(),
        };
        let body = bodies.get_mut(id)?;
        change(body, *instructions, executor).map_err(about(id))
    }

    /// A body is removed, or its triangles have a new order: what was found of them the last time is nothing any more.
    fn forget_answers(&mut self, id: BodyId) {
        self.witnesses.forget(id);
        self.distances.last.forget(id);
    }

    /// Validates a new shape of a body and takes it over.
    fn move_body(&mut self, id: BodyId, positions: &[[S; 3]]) -> Result<(), Error> {
        self.change(id, |body, instructions, executor| {
            body.set_positions(instructions, executor, positions)
        })?;
        self.common.note_movement();
        self.mend(id)
    }

    /// Ends the motion of every body that has one. The error is that of the first body whose motion cannot be ended.
    fn end_motions<E>(
        &mut self,
        mut end: impl FnMut(&mut Body<S>, Instructions, Executor) -> Result<(), E>,
    ) -> Result<(), (BodyId, E)> {
        let Common {
            options,
            instructions,
            threads,
            bodies,
            ..
        } = &mut self.common;
        let executor = Executor {
            threads: threads.here(),
            interrupt: &Interrupt::default(),
        };
        let mut ended = Ok(());
        for place in &bodies.places {
            let body = &mut bodies.list[place.index()];
            if !body.is_moving() {
                continue;
            }
            match end(body, *instructions, executor) {
                Ok(()) if options.mending && body.mend(options) => {
                    self.witnesses.forget(body.id);
                    self.distances.last.forget(body.id);
                }
                Ok(()) => {}
                Err(kind) => ended = ended.and(Err((body.id, kind))),
            }
        }
        self.common.note_movement();
        ended
    }

    /// A body has a new shape: its tree mends itself, if trees do.
    fn mend(&mut self, id: BodyId) -> Result<(), Error> {
        let options = self.common.options;
        if options.mending && self.common.bodies.get_mut(id)?.mend(&options) {
            self.forget_answers(id);
        }
        Ok(())
    }
}

impl<S: Coordinate> AnyEngine<S> for Engine<S> {
    fn copy(&self) -> Box<dyn AnyEngine<S>> {
        let Common {
            options,
            instructions,
            threads,
            bodies,
            ..
        } = &self.common;
        let mut copy = Self::new(*options, threads.another(options.threads));
        copy.common.instructions = *instructions;
        copy.common.bodies = bodies.copy();
        // As if all of them had been added just now.
        for _ in bodies.in_order() {
            copy.common.note_movement();
        }
        Box::new(copy)
    }

    fn options(&self) -> &Options {
        &self.common.options
    }

    fn use_instructions(&mut self, instructions: Instructions) {
        self.common.instructions = instructions;
    }

    fn add(&mut self, triangles: &[[u32; 3]], positions: &[[S; 3]]) -> Result<BodyId, Error> {
        let refused = |kind| Error { body: None, kind };
        let common = &mut self.common;
        let id = common.bodies.next_id().map_err(refused)?;
        body::validate(triangles, positions).map_err(refused)?;
        let body = Body::new(id, triangles, positions, &common.options);
        common.bodies.push(body);
        common.note_movement();
        Ok(id)
    }

    fn remove(&mut self, id: BodyId) -> Result<(), Error> {
        let common = &mut self.common;
        let rank = common.bodies.remove(id)?;
        common.body_pairs.remove(rank);
        self.forget_answers(id);
        Ok(())
    }

    fn ids(&self) -> &[BodyId] {
        &self.common.bodies.ids
    }

    fn next_id(&self) -> Option<u32> {
        self.common.bodies.next_id().ok().map(|id| id.0)
    }

    fn skip_ids(&mut self, next: Option<u32>) {
        self.common.bodies.skip_ids(next);
    }

    fn set_positions(&mut self, id: BodyId, positions: &[[S; 3]]) -> Result<(), Error> {
        self.move_body(id, positions)
    }

    fn write_positions(
        &mut self,
        id: BodyId,
        write: &mut dyn FnMut(&mut [[S; 3]]),
    ) -> Result<(), Error> {
        let vertices = self.vertex_count(id)?;
        let mut lent = std::mem::take(&mut self.lent);
        lent.clear();
        lent.resize(vertices, [S::NAN; 3]);
        write(&mut lent);
        let moved = self.move_body(id, &lent);
        self.lent = lent;
        moved.map_err(|mut refused| {
            if let ErrorKind::BadPosition { vertex, position } = refused.kind
                && position.iter().any(|x| x.is_nan())
            {
                refused.kind = ErrorKind::NotWritten { vertex };
            }
            refused
        })
    }

    fn set_mesh(
        &mut self,
        id: BodyId,
        triangles: &[[u32; 3]],
        positions: &[[S; 3]],
    ) -> Result<(), Error> {
        let body = self.body(id)?;
        let is_same =
            body.vertex_count() == positions.len() && body.topology.triangles() == triangles;
        if is_same && !body.has_empty_numbers() {
            return self.move_body(id, positions);
        }
        let options = self.common.options;
        self.change(id, |body, instructions, executor| {
            body.set_mesh(triangles, positions, &options, (instructions, executor))
        })?;
        self.common.note_movement();
        self.forget_answers(id);
        Ok(())
    }

    fn edit(&self, id: BodyId) -> Result<Edit<S>, Error> {
        Ok(self.body(id)?.begin_edit(self.number))
    }

    fn apply(&mut self, edit: &Edit<S>) -> Result<Edited, Error> {
        let id = edit.body();
        if edit.world != self.number {
            return Err(about(id)(ErrorKind::OutdatedEdit));
        }
        let options = self.common.options;
        let body = self.common.bodies.get_mut(id)?;
        let edited = body.apply(edit, &options).map_err(about(id))?;
        self.common.note_movement();
        self.forget_answers(id);
        Ok(edited)
    }

    fn live_triangles(&self, id: BodyId) -> Result<Vec<bool>, Error> {
        Ok(self.body(id)?.live_triangles())
    }

    fn live_vertices(&self, id: BodyId) -> Result<Vec<bool>, Error> {
        Ok(self.body(id)?.live_vertices())
    }

    fn tree_quality(&self, id: BodyId) -> Result<f64, Error> {
        Ok(self.body(id)?.decay.quality())
    }

    fn mesh_revision(&self, id: BodyId) -> Result<u64, Error> {
        Ok(self.body(id)?.revision)
    }

    fn rebuild(&mut self, id: BodyId) -> Result<(), Error> {
        let common = &mut self.common;
        common.bodies.get_mut(id)?.rebuild(&common.options);
        self.forget_answers(id);
        Ok(())
    }

    fn set_motion(&mut self, id: BodyId, end: &[[S; 3]]) -> Result<(), Error> {
        self.change(id, |body, instructions, executor| {
            body.set_motion(instructions, executor, end)
        })?;
        self.common.body_pairs.forget();
        Ok(())
    }

    fn finish_motion(&mut self) {
        let Ok(()) = self.end_motions::<Infallible>(|body, _, _| {
            body.finish_motion();
            Ok(())
        });
    }

    fn advance_motion(&mut self, t: f64) -> Result<(), Error> {
        if !(0.0..=1.0).contains(&t) {
            return Err(ErrorKind::BadTime { time: t }.of_query());
        }
        let mut shape = std::mem::take(&mut self.lent);
        let advanced = self.end_motions(|body, instructions, executor| {
            body.advance_motion(instructions, executor, t, &mut shape)
        });
        self.lent = shape;
        advanced.map_err(|(id, kind)| about(id)(kind))
    }

    fn end_positions(&self, id: BodyId) -> Result<Option<Vec<[S; 3]>>, Error> {
        let end = self.body(id)?.end_positions();
        Ok(end.map(std::borrow::Cow::into_owned))
    }

    fn is_moving(&self, id: BodyId) -> Result<bool, Error> {
        Ok(self.body(id)?.is_moving())
    }

    fn set_vertex_groups(&mut self, id: BodyId, groups: &[u32]) -> Result<(), Error> {
        let body = self.common.bodies.get_mut(id)?;
        body.set_groups(groups).map_err(about(id))
    }

    fn vertex_groups(&self, id: BodyId) -> Result<Vec<u32>, Error> {
        Ok(self.body(id)?.groups())
    }

    fn edges(&self, id: BodyId) -> Result<&[[u32; 2]], Error> {
        Ok(self.body(id)?.edges())
    }

    fn numbered_edges(&self, id: BodyId) -> Result<Option<&[[u32; 2]]>, Error> {
        Ok(self.body(id)?.numbered_edges())
    }

    fn number_edges(&mut self, id: BodyId, edges: &[[u32; 2]]) -> Result<bool, Error> {
        Ok(self.common.bodies.get_mut(id)?.number_edges(edges))
    }

    fn set_filter(&mut self, id: BodyId, membership: u32, mask: u32) -> Result<(), Error> {
        let body = self.common.bodies.get_mut(id)?;
        body.set_filter(membership, mask);
        self.common.body_pairs.forget();
        Ok(())
    }

    fn ignore(&mut self, a: BodyId, b: BodyId) -> Result<(), Error> {
        self.body(a)?;
        self.body(b)?;
        self.common.bodies.ignore(a, b);
        self.common.body_pairs.forget();
        Ok(())
    }

    fn unignore(&mut self, a: BodyId, b: BodyId) -> Result<(), Error> {
        self.body(a)?;
        self.body(b)?;
        self.common.bodies.meet_again(a, b);
        self.common.body_pairs.forget();
        Ok(())
    }

    fn set_loose_box(
        &mut self,
        id: BodyId,
        corners: Option<([S; 3], [S; 3])>,
    ) -> Result<(), Error> {
        let loose = corners.map(|(lo, hi)| Bounds { lo, hi });
        let body = self.common.bodies.get_mut(id)?;
        body.set_loose_box(loose).map_err(about(id))?;
        self.common.note_movement();
        Ok(())
    }

    fn filter(&self, id: BodyId) -> Result<(u32, u32), Error> {
        Ok(self.body(id)?.filter())
    }

    fn ignored(&self) -> Vec<[BodyId; 2]> {
        self.common.bodies.ignored()
    }

    fn loose_box(&self, id: BodyId) -> Result<Option<([S; 3], [S; 3])>, Error> {
        let loose = self.body(id)?.loose();
        Ok(loose.map(|Bounds { lo, hi }| (lo, hi)))
    }

    fn triangles(&self, id: BodyId) -> Result<&[[u32; 3]], Error> {
        Ok(self.body(id)?.topology.triangles())
    }

    fn vertex_count(&self, id: BodyId) -> Result<usize, Error> {
        Ok(self.body(id)?.vertex_count())
    }

    fn positions(&self, id: BodyId) -> Result<Vec<[S; 3]>, Error> {
        Ok(self.body(id)?.positions().into_owned())
    }

    fn tree_shape(&self, id: BodyId) -> Result<TreeShape, Error> {
        let trees = || Ok::<_, Error>(self.body(id)?.parts.all().map(|part| &part.tree));
        Ok(TreeShape {
            depth: trees()?.map(|tree| tree.depth).max().unwrap_or_default(),
            nodes: trees()?.map(Tree::node_count).sum(),
            leaves: trees()?.map(|tree| tree.leaves.len()).sum(),
        })
    }

    fn tree_cut(&self, id: BodyId, level: u32) -> Result<Vec<u32>, Error> {
        Ok(self.body(id)?.tree_cut(level))
    }

    fn tree_boxes(&self, id: BodyId, level: u32) -> Result<Vec<NodeBox<S>>, Error> {
        let origin = self.common.origin.point;
        Ok(self.body(id)?.tree_boxes(level, origin))
    }

    fn vertex_order(&self, id: BodyId) -> Result<&[u32], Error> {
        Ok(self.body(id)?.vertex_order())
    }

    fn distance(
        &mut self,
        of: [BodyId; 2],
        cut_off: f64,
        question: Option<Question>,
    ) -> Result<Option<CloseTriangles>, Error> {
        distance::check(cut_off)?;
        let request = Request {
            question,
            within: cut_off,
            ..Request::new(Selection::Between(of[0], of[1]))
        };
        if Ask::<Pair>::first(self, &request)?.is_some() {
            let triangles = self.witnesses.get(of);
            return Ok(triangles.and_then(|it| distance::in_common(&self.common, of, it)));
        }
        let interrupt = Interrupt::new(question);
        let common = &mut self.common;
        let found = self.distances.nearest(common, of, cut_off, &interrupt)?;
        common.end(&interrupt)?;
        Ok(found)
    }

    fn nearest_body(
        &mut self,
        id: BodyId,
        cut_off: f64,
        question: Option<Question>,
    ) -> Result<Option<CloseTriangles>, Error> {
        distance::check(cut_off)?;
        let mut statistics = self.common.done_early;
        let (mut nearest, mut within) = (Ok(None), cut_off);
        // Kept for the next question.
        let mut others = std::mem::take(&mut self.distances.others);
        let listed = distance::others_by_gap(&mut self.common, id, &mut others);
        for &(gap, other) in &others {
            if gap > NearestPair::within(within).limit() {
                break;
            }
            let found = self.distance([id, other], within, question);
            statistics += self.common.statistics;
            match found {
                Ok(Some(found)) if nearest == Ok(None) || found.distance < within => {
                    within = found.distance;
                    nearest = Ok(Some(found));
                }
                Ok(_) => {}
                Err(error) => {
                    nearest = Err(error);
                    break;
                }
            }
        }
        self.distances.others = others;
        listed?;
        self.common.statistics = statistics;
        nearest
    }

    fn first_impact(
        &mut self,
        of: Selection,
        width: f64,
        question: Option<Question>,
    ) -> Result<Option<Impact>, Error> {
        let request = Request {
            question,
            width,
            ..Request::new(of)
        };
        let grid = request.grid()?;
        let first = self
            .impacts
            .first_contact(&mut self.common, &request, OfKind::Both)?;
        Ok(first.map(|first| first.in_cell_of(grid)))
    }

    fn collision_free_step(
        &mut self,
        of: Selection,
        min_distance: f64,
        question: Option<Question>,
    ) -> Result<f64, Error> {
        let request = Request {
            within: min_distance,
            question,
            ..Request::new(of)
        };
        self.impacts.free_step(&mut self.common, &request)
    }

    fn statistics(&self) -> &Statistics {
        &self.common.statistics
    }

    fn memory_usage(&self) -> usize {
        let Common {
            bodies,
            body_pairs,
            scratch,
            ..
        } = &self.common;
        size_of::<Self>()
            + bodies.held()
            + body_pairs.held()
            + scratch.held()
            + self.intersections.held()
            + self.contacts.held()
            + self.vertex_triangle.held()
            + self.edge_edge.held()
            + self.close_vertex_triangle.held()
            + self.close_edge_edge.held()
            + self.close_triangles.held()
            + self.impacts.held()
            + self.witnesses.held()
            + self.distances.held()
            + held::list(&self.lent)
    }

    fn validate(&self) -> Result<(), String> {
        let Common {
            options,
            bodies,
            origin,
            ..
        } = &self.common;
        for body in &bodies.list {
            body.validate(options, origin.point)
                .map_err(|what| format!("{}: {what}", body.id))?;
        }
        Ok(())
    }
}

impl<S: Coordinate> Ask<Pair> for Engine<S> {
    fn all(&mut self, request: &Request) -> Result<&[Pair], Error> {
        let kind = &Intersections::default();
        self.intersections.all(kind, &mut self.common, request)
    }

    /// Begins with the last answer: see `witness`.
    fn first(&mut self, request: &Request) -> Result<Option<Pair>, Error> {
        let last = match request.of {
            Selection::World => self.witnesses.of_world[0],
            Selection::Everything => self.witnesses.of_world[1],
            Selection::Between(a, b) => Some([a, b]),
            Selection::Within(a) => Some([a; 2]),
        };
        if let Some(bodies) = last.filter(|&bodies| self.do_meet(bodies, request.of))
            && let Some(pair) = self.ask_witness(bodies, request)?
        {
            return Ok(Some(pair));
        }
        let found = first_seen(|visitor| Ask::<Pair>::visit(self, request, visitor))?;
        let bodies = found.map(|pair: Pair| [pair.body_a, pair.body_b]);
        match request.of {
            Selection::World => self.witnesses.of_world[0] = bodies,
            Selection::Everything => self.witnesses.of_world[1] = bodies,
            Selection::Between(..) | Selection::Within(_) => {}
        }
        if let (Some(bodies), Some(at)) = (bodies, self.intersections.tasks.broke_at.take()) {
            self.witnesses.keep(bodies, at);
        }
        Ok(found)
    }

    fn visit(&mut self, request: &Request, visitor: Visitor<Pair>) -> Result<(), Error> {
        let kind = &Intersections::default();
        self.intersections
            .visit(kind, &mut self.common, request, visitor)
    }

    fn prepare(&mut self, request: &Request) -> Result<(), Error> {
        self.common.prepare(Needs::TRIANGLES, request)
    }
}

/// Answers queries of a kind that is made of the request: all of them by this call, with the numbers to sort by where hits are more than those.
macro_rules! ask {
    ($hit:ty, $asked:ident.$all:ident($($numbers:expr)?), |$request:ident| $kind:expr) => {
        impl<S: Coordinate> Ask<$hit> for Engine<S> {
            fn all(&mut self, $request: &Request) -> Result<&[$hit], Error> {
                let kind = &$kind;
                self.$asked.$all(kind, &mut self.common, $request $(, $numbers)?)
            }

            fn first(&mut self, request: &Request) -> Result<Option<$hit>, Error> {
                first_seen(|visitor| Ask::<$hit>::visit(self, request, visitor))
            }

            fn visit(&mut self, $request: &Request, visitor: Visitor<$hit>) -> Result<(), Error> {
                let kind = &$kind;
                self.$asked.visit(kind, &mut self.common, $request, visitor)
            }

            fn prepare(&mut self, $request: &Request) -> Result<(), Error> {
                let needs = $kind.needs();
                self.common.prepare(needs, $request)
            }
        }
    };
}

/// The first hit that a visit shows.
fn first_seen<H: Copy>(
    visit: impl FnOnce(Visitor<H>) -> Result<(), Error>,
) -> Result<Option<H>, Error> {
    let mut found = None;
    visit(&mut |hits| {
        found = hits.first().copied();
        if found.is_some() {
            ControlFlow::Break(0)
        } else {
            ControlFlow::Continue(())
        }
    })?;
    Ok(found)
}

ask!(Contact, contacts.all_listed(), |request| Contacts::<S>::of(
    request.only
));
ask!(VertexTriangle, vertex_triangle.all(), |request| {
    VertexTriangleCandidates::<S>::within(request.margin()?)
});
ask!(EdgeEdge, edge_edge.all(), |request| {
    EdgeEdgeCandidates::<S>::within(request.margin()?)
});
ask!(
    CloseVertexTriangle,
    close_vertex_triangle.all(),
    |request| {
        let candidates = VertexTriangleCandidates::<S>::within;
        Measured(Close::within(request.distance()?, candidates))
    }
);
ask!(CloseEdgeEdge, close_edge_edge.all(), |request| {
    let candidates = EdgeEdgeCandidates::<S>::within;
    Measured(Close::within(request.distance()?, candidates))
});
ask!(CloseTriangles, close_triangles.all(), |request| {
    Measured(NearTriangles::<S>::within(request.distance()?))
});

/// Answers queries for impacts of one kind.
macro_rules! ask_impacts {
    ($hit:ident, $asked:ident, $candidates:ident, $of:expr) => {
        impl<S: Coordinate> Ask<$hit> for Engine<S> {
            fn all(&mut self, request: &Request) -> Result<&[$hit], Error> {
                let kind = Self::all_of(request, $candidates::within)?;
                self.impacts
                    .$asked
                    .all_listed(&kind, &mut self.common, request)
            }

            fn first(&mut self, request: &Request) -> Result<Option<$hit>, Error> {
                let grid = request.grid()?;
                let first = self.impacts.first_contact(&mut self.common, request, $of)?;
                Ok(first.and_then(|first| $hit::of(first.in_cell_of(grid))))
            }

            fn visit(&mut self, request: &Request, visitor: Visitor<$hit>) -> Result<(), Error> {
                let kind = Self::all_of(request, $candidates::within)?;
                self.impacts
                    .$asked
                    .visit(&kind, &mut self.common, request, visitor)
            }

            fn prepare(&mut self, request: &Request) -> Result<(), Error> {
                let kind = Self::all_of(request, $candidates::<S>::within)?;
                self.common.prepare(kind.needs(), request)
            }
        }
    };
}

ask_impacts!(
    VertexTriangleImpact,
    vertex_triangle,
    VertexTriangleCandidates,
    OfKind::VerticesAndTriangles
);
ask_impacts!(EdgeEdgeImpact, edge_edge, EdgeEdgeCandidates, OfKind::Edges);

impl<S: Coordinate> Engine<S> {
    /// All impacts of a kind of candidates.
    fn all_of<K>(request: &Request, within: impl Fn(Margin) -> K) -> Result<Impacts<K>, Error> {
        let candidates = within(Margin::new(0.0));
        Ok(Impacts::of(candidates, request.grid()?, Reach::End))
    }
}

/// The pair that answered the last question for a first pair.
impl<S: Coordinate> Engine<S> {
    /// Whether bodies that were there are there still, and meet in a query of these.
    fn do_meet(&self, [a, b]: [BodyId; 2], of: Selection) -> bool {
        let (Ok(body_a), Ok(body_b)) = (self.body(a), self.body(b)) else {
            return false;
        };
        match of {
            Selection::World | Selection::Everything => self.common.bodies.do_meet(body_a, body_b),
            Selection::Between(..) => a != b,
            Selection::Within(_) => true,
        }
    }

    /// A pair of these bodies at or near the last answer, if one intersects. What it does is counted in any case.
    fn ask_witness(
        &mut self,
        bodies: [BodyId; 2],
        request: &Request,
    ) -> Result<Option<Pair>, Error> {
        let Some(last) = self.witnesses.get(bodies) else {
            return Ok(None);
        };
        let interrupt = Interrupt::new(request.question);
        let mut statistics = self.common.done_early;
        let both = [self.body(bodies[0])?, self.body(bodies[1])?];
        let found = witness::near(both, last, &interrupt, &mut statistics);
        let pair = found.map(|found| witness::pair_of(both, found));
        if let Some(found) = found {
            self.common.statistics = statistics;
            self.common.done_early = Statistics::default();
            self.witnesses.keep(bodies, found);
        } else {
            self.common.done_early = statistics;
            self.common.end(&interrupt)?;
        }
        Ok(pair)
    }
}
