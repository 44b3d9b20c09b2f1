//! Engine of a world behind a trait, compiled once for `f32` and once for `f64`.
//!
//! [`World`](super::World) holds a state behind this trait, so that all that takes long to compile
//! is compiled in this crate and not in a user's. Short work it does itself, with the state. The
//! library is thus as fast as it was compiled, whatever the user's crate is compiled with. A user's
//! closure crosses as `dyn`, a list of hits at a time. `benchmarks/compile_cost.py` measures all
//! this.

use super::kept::AskAll;
use super::state::{State, about};
use crate::bodies::{Body, NodeBox, validate};
use crate::collide::{Ask, Common, OfKind, Request, check, in_common, others_by_gap};
use crate::edit::{Edit, Edited};
use crate::error::{Error, ErrorKind};
use crate::held::{self, Held};
use crate::ids::BodyId;
use crate::kernels::Coordinate;
use crate::points::{
    ClosestPoint, Nearest, Winding, check_points, find_nearest, find_nearest_of_all, measure,
    windings,
};
use crate::queries::{CloseTriangles, Impact, NearestPair, Pair};
use crate::selection::Selection;
use crate::threads::{Interrupt, Question};
use std::convert::Infallible;

/// State and its verbs. [`World`](super::World) says what each method means.
pub(crate) trait Verbs<S: Coordinate>: AskAll {
    fn state(&self) -> &State<S>;
    fn state_mut(&mut self) -> &mut State<S>;
    fn copy(&self) -> Box<dyn Verbs<S>>;
    fn add(&mut self, triangles: &[[u32; 3]], positions: &[[S; 3]]) -> Result<BodyId, Error>;
    fn set_positions(&mut self, id: BodyId, positions: &[[S; 3]]) -> Result<(), Error>;
    fn set_positions_of(&mut self, shapes: &[(BodyId, &[[S; 3]])]) -> Result<(), Error>;
    fn set_mesh(
        &mut self,
        id: BodyId,
        triangles: &[[u32; 3]],
        positions: &[[S; 3]],
    ) -> Result<(), Error>;
    fn apply(&mut self, edit: &Edit<S>) -> Result<Edited, Error>;
    fn rebuild(&mut self, id: BodyId) -> Result<(), Error>;
    fn set_motion(&mut self, id: BodyId, end: &[[S; 3]]) -> Result<(), Error>;
    fn finish_motion(&mut self);
    fn advance_motion(&mut self, t: f64) -> Result<(), Error>;
    fn number_edges(&mut self, id: BodyId, edges: &[[u32; 2]]) -> Result<bool, Error>;
    fn set_edges(&mut self, id: BodyId, edges: &[[u32; 2]]) -> Result<(), Error>;
    fn tree_boxes(&self, id: BodyId, level: u32) -> Result<Vec<NodeBox<S>>, Error>;
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
    fn windings(
        &mut self,
        body: BodyId,
        points: &[[S; 3]],
        question: Option<Question>,
    ) -> Result<Vec<Winding>, Error>;
    fn closest_points(
        &mut self,
        points: &[[S; 3]],
        of: Option<BodyId>,
        cut_off: f64,
        question: Option<Question>,
    ) -> Result<Vec<Option<ClosestPoint>>, Error>;
    fn memory_usage(&self) -> usize;
    fn validate(&self) -> Result<(), String>;
}

impl<S: Coordinate> Verbs<S> for State<S> {
    fn state(&self) -> &State<S> {
        self
    }

    fn state_mut(&mut self) -> &mut State<S> {
        self
    }

    fn copy(&self) -> Box<dyn Verbs<S>> {
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
        // The copy counts its bodies as if all had been added just now.
        for _ in bodies.in_order() {
            copy.common.note_movement();
        }
        Box::new(copy)
    }

    fn add(&mut self, triangles: &[[u32; 3]], positions: &[[S; 3]]) -> Result<BodyId, Error> {
        let refused = |kind| Error { body: None, kind };
        let common = &mut self.common;
        let id = common.bodies.next_id().map_err(refused)?;
        validate(triangles, positions).map_err(refused)?;
        let body = Body::new(id, triangles, positions, &common.options);
        common.bodies.push(body);
        common.note_movement();
        Ok(id)
    }

    fn set_positions(&mut self, id: BodyId, positions: &[[S; 3]]) -> Result<(), Error> {
        self.move_body(id, positions)
    }

    fn set_positions_of(&mut self, shapes: &[(BodyId, &[[S; 3]])]) -> Result<(), Error> {
        self.move_bodies(shapes)
    }

    fn set_mesh(
        &mut self,
        id: BodyId,
        triangles: &[[u32; 3]],
        positions: &[[S; 3]],
    ) -> Result<(), Error> {
        let mesh = self.body(id)?.mesh();
        let is_same = mesh.vertex_count() == positions.len() && mesh.triangles() == triangles;
        if is_same && !mesh.has_empty_numbers() {
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

    fn number_edges(&mut self, id: BodyId, edges: &[[u32; 2]]) -> Result<bool, Error> {
        Ok(self.common.bodies.get_mut(id)?.number_edges(edges))
    }

    fn set_edges(&mut self, id: BodyId, edges: &[[u32; 2]]) -> Result<(), Error> {
        let body = self.common.bodies.get_mut(id)?;
        body.set_edges(edges).map_err(about(id))
    }

    fn tree_boxes(&self, id: BodyId, level: u32) -> Result<Vec<NodeBox<S>>, Error> {
        let origin = self.common.origin.point;
        Ok(self.body(id)?.tree_boxes(level, origin))
    }

    fn distance(
        &mut self,
        of: [BodyId; 2],
        cut_off: f64,
        question: Option<Question>,
    ) -> Result<Option<CloseTriangles>, Error> {
        check(cut_off)?;
        let request = Request {
            question,
            within: cut_off,
            ..Request::new(Selection::Between(of[0], of[1]))
        };
        if Ask::<Pair>::first(self, &request)?.is_some() {
            let triangles = self.witnesses.get(of);
            return Ok(triangles.and_then(|it| in_common(&self.common, of, it)));
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
        check(cut_off)?;
        let mut statistics = self.common.done_early;
        let (mut nearest, mut within) = (Ok(None), cut_off);
        // Kept for the next question, so that replays allocate nothing.
        let mut others = std::mem::take(&mut self.distances.others);
        let listed = others_by_gap(&mut self.common, id, &mut others);
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
            .kinds
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
        self.kinds.impacts.free_step(&mut self.common, &request)
    }

    fn windings(
        &mut self,
        body: BodyId,
        points: &[[S; 3]],
        question: Option<Question>,
    ) -> Result<Vec<Winding>, Error> {
        check_points(points)?;
        let interrupt = Interrupt::new(question);
        self.common.statistics = std::mem::take(&mut self.common.done_early);
        windings(&mut self.common, body, points, &interrupt)
    }

    fn closest_points(
        &mut self,
        points: &[[S; 3]],
        of: Option<BodyId>,
        cut_off: f64,
        question: Option<Question>,
    ) -> Result<Vec<Option<ClosestPoint>>, Error> {
        check(cut_off)?;
        check_points(points)?;
        let interrupt = Interrupt::new(question);
        let common = &mut self.common;
        common.statistics = std::mem::take(&mut common.done_early);
        let mut nearest = vec![Nearest::within(cut_off); points.len()];
        match of {
            Some(body) => {
                self.hints.give(body, &mut nearest);
                find_nearest(common, body, points, &mut nearest, &interrupt)?;
                self.hints.take(body, &nearest);
            }
            None => find_nearest_of_all(common, points, &mut nearest, &interrupt)?,
        }
        let how = (common.instructions, common.executor(&interrupt));
        let measured = measure(how, points, &nearest, cut_off);
        common.end(&interrupt)?;
        Ok(measured)
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
            + self.kinds.held()
            + self.witnesses.held()
            + self.distances.held()
            + self.hints.held()
            + held::list(&self.lent)
    }

    fn validate(&self) -> Result<(), String> {
        let Common {
            options,
            bodies,
            origin,
            ..
        } = &self.common;
        for body in bodies.all() {
            body.validate(options, origin.point)
                .map_err(|what| format!("{}: {what}", body.id()))?;
        }
        Ok(())
    }
}
