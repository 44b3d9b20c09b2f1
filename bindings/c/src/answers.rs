//! Questions with one answer: distances of bodies, first impacts, free steps, clearance.

use crate::arrays::{give, start};
use crate::hits::{Columns, PliantHits, Row};
use crate::pairs::number_of;
use crate::questions::PliantQuery;
use crate::world::{calls, with_world};
use pliant::{BodyId, ClosestFeatures, EdgeEdgeImpact, Impact, InContact};

/// Answers that the caller reads, one for each function.
#[derive(Default)]
pub(crate) struct Answers {
    distance: Columns,
    nearest: Columns,
    impact: Columns,
    bodies: Vec<u32>,
    starts: Vec<usize>,
    clearance: Vec<f64>,
}

/// `pliant_free_step`: how far everything may go, and how that begins.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PliantFreeStep {
    /// Time from 0 to 1.
    pub t: f64,
    /// Body, element, body, element of the first pair that is in contact at the start.
    pub pair: [u32; 4],
    /// Kinds of the elements.
    pub begins_in_contact: u8,
    /// Whether any body has a motion.
    pub moves: u8,
}

/// `pliant_clearance`: how far each vertex may move.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantClearance {
    /// Number of bodies.
    pub body_count: usize,
    /// The bodies, ascending.
    pub bodies: *const u32,
    /// First vertex of each among the numbers, and one behind the last.
    pub starts: *const usize,
    /// A number for each vertex.
    pub clearance: *const f64,
}

calls! {
    fn pliant_world_distance(
        a: u32,
        b: u32,
        cut_off: f64,
        query: *const PliantQuery,
        hits: *mut PliantHits,
    ) |inside| {
        // SAFETY: as the header says.
        let until = unsafe { PliantQuery::interrupt_alone(query)? };
        let found = with_world!(&mut inside.world, world => {
            world.interruptible(&|| until.ends()).distance(BodyId(a), BodyId(b), cut_off)?
        });
        let view = told(&mut inside.views.of::<Answers>().distance, found.as_slice());
        // SAFETY: as the header says.
        unsafe { give(hits, view) };
        Ok(())
    }

    fn pliant_world_nearest_body(
        body: u32,
        cut_off: f64,
        query: *const PliantQuery,
        hits: *mut PliantHits,
    ) |inside| {
        // SAFETY: as the header says.
        let until = unsafe { PliantQuery::interrupt_alone(query)? };
        let found = with_world!(&mut inside.world, world => {
            world.interruptible(&|| until.ends()).nearest_body(BodyId(body), cut_off)?
        });
        let view = told(&mut inside.views.of::<Answers>().nearest, found.as_slice());
        // SAFETY: as the header says.
        unsafe { give(hits, view) };
        Ok(())
    }

    fn pliant_world_first_impact(
        query: *const PliantQuery,
        width: f64,
        hits: *mut PliantHits,
    ) |inside| {
        // SAFETY: as the header says.
        let (of, until) = unsafe { PliantQuery::of_one_answer(query)? };
        let found = with_world!(&mut inside.world, world => {
            world.interruptible(&|| until.ends()).first_impact(of, width)?
        });
        let list = &mut inside.views.of::<Answers>().impact;
        match found {
            None => list.take::<EdgeEdgeImpact>(&[]),
            Some(Impact::VertexTriangle(hit)) => {
                list.take(&[hit]);
                list.kinds.push(number_of(ClosestFeatures::VertexFace));
            }
            Some(Impact::EdgeEdge(hit)) => {
                list.take(&[hit]);
                list.kinds.push(number_of(ClosestFeatures::EdgeEdge));
            }
        }
        let view = list.view();
        // SAFETY: as the header says.
        unsafe { give(hits, view) };
        Ok(())
    }

    fn pliant_world_collision_free_step(
        query: *const PliantQuery,
        min_distance: f64,
        step: *mut f64,
    ) |inside| {
        // SAFETY: as the header says.
        let (of, until) = unsafe { PliantQuery::of_one_answer(query)? };
        let free = with_world!(&mut inside.world, world => {
            world.interruptible(&|| until.ends()).collision_free_step(of, min_distance)?
        });
        // SAFETY: as the header says.
        unsafe { give(step, free) };
        Ok(())
    }

    fn pliant_world_free_step(
        query: *const PliantQuery,
        min_distance: f64,
        step: *mut PliantFreeStep,
    ) |inside| {
        // SAFETY: as the header says.
        let (of, until) = unsafe { PliantQuery::of_one_answer(query)? };
        let free = with_world!(&mut inside.world, world => {
            world.interruptible(&|| until.ends()).free_step(of, min_distance)?
        });
        let (begins_in_contact, pair) = match free.begins_in_contact {
            None => (0, [u32::MAX; 4]),
            Some(InContact::Triangles(pair)) => (1, pair.into()),
            Some(InContact::VertexTriangle(pair)) => (2, pair.into()),
            Some(InContact::EdgeEdge(pair)) => (3, pair.into()),
        };
        let moves = u8::from(free.moves);
        // SAFETY: as the header says.
        unsafe { give(step, PliantFreeStep { t: free.t, pair, begins_in_contact, moves }) };
        Ok(())
    }

    fn pliant_world_clearance(
        query: *const PliantQuery,
        cut_off: f64,
        clearance: *mut PliantClearance,
    ) |inside| {
        // SAFETY: as the header says.
        let (of, until) = unsafe { PliantQuery::of_one_answer(query)? };
        let all = with_world!(&mut inside.world, world => {
            world.interruptible(&|| until.ends()).clearance(of, cut_off)?
        });
        let kept = inside.views.of::<Answers>();
        kept.bodies.clear();
        kept.clearance.clear();
        kept.starts.clear();
        kept.starts.push(0);
        for (body, of_vertices) in all {
            kept.bodies.push(body.0);
            kept.clearance.extend(of_vertices);
            kept.starts.push(kept.clearance.len());
        }
        let view = PliantClearance {
            body_count: kept.bodies.len(),
            bodies: start(&kept.bodies),
            starts: start(&kept.starts),
            clearance: start(&kept.clearance),
        };
        // SAFETY: as the header says.
        unsafe { give(clearance, view) };
        Ok(())
    }
}

/// The columns of no hit or one.
fn told<H: Row>(columns: &mut Columns, found: &[H]) -> PliantHits {
    columns.take(found);
    columns.view()
}
