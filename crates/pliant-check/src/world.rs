//! A world of the precision that the sources have: f64 if any of them is.
//!
//! 32-bit positions in a 64-bit world are widened, which changes none.

use pliant::{BodyId, Error, Options, Pair};
use pliant_io::{Positions, Precision};
use std::ops::ControlFlow;

/// The world of a check, whose bodies are the sources, in their order; of the precision that the sources have.
#[derive(Clone, Copy)]
pub enum WorldOf<'a> {
    /// All sources are in single precision.
    F32(&'a pliant::World<f32>),
    /// At least one is in double precision.
    F64(&'a pliant::World<f64>),
}

pub(crate) enum World {
    F32(pliant::World<f32>),
    F64 {
        world: pliant::World<f64>,
        widened: Vec<[f64; 3]>,
    },
}

/// Does the same with a world of either precision.
macro_rules! either {
    ($world:expr, $it:ident => $work:expr) => {
        match $world {
            World::F32($it) => $work,
            World::F64 { world: $it, .. } => $work,
        }
    };
}

/// What a visitor says: go on, or stop.
pub(crate) type Flow = ControlFlow<()>;

impl World {
    pub(crate) fn new(precision: Precision, options: Options) -> Self {
        match precision {
            Precision::F32 => Self::F32(pliant::World::with_options(options)),
            Precision::F64 => Self::F64 {
                world: pliant::World::with_options(options),
                widened: Vec::new(),
            },
        }
    }

    pub(crate) fn get(&self) -> WorldOf<'_> {
        match self {
            Self::F32(world) => WorldOf::F32(world),
            Self::F64 { world, .. } => WorldOf::F64(world),
        }
    }

    pub(crate) fn add(
        &mut self,
        triangles: &[[u32; 3]],
        positions: Positions<'_>,
    ) -> Result<BodyId, Error> {
        match self {
            Self::F32(world) => world.add(triangles, narrow(positions)),
            Self::F64 { world, widened } => world.add(triangles, widen(positions, widened)),
        }
    }

    pub(crate) fn set_positions(
        &mut self,
        body: BodyId,
        positions: Positions<'_>,
    ) -> Result<(), Error> {
        match self {
            Self::F32(world) => world.set_positions(body, narrow(positions)),
            Self::F64 { world, widened } => world.set_positions(body, widen(positions, widened)),
        }
    }

    pub(crate) fn ignore(&mut self, a: BodyId, b: BodyId) -> Result<(), Error> {
        either!(self, world => world.ignore(a, b))
    }

    pub(crate) fn first(&mut self) -> Option<Pair> {
        either!(self, world => world.first_intersection())
    }

    pub(crate) fn first_of(&mut self, body: BodyId) -> Result<Option<[u32; 2]>, Error> {
        either!(self, world => world.first_self_intersection(body))
    }

    pub(crate) fn visit(&mut self, visit: impl FnMut(Pair) -> Flow) -> Flow {
        either!(self, world => world.visit_intersections(visit))
    }

    pub(crate) fn visit_of(
        &mut self,
        body: BodyId,
        visit: impl FnMut([u32; 2]) -> Flow,
    ) -> Result<Flow, Error> {
        either!(self, world => world.visit_self_intersections(body, visit))
    }
}

fn narrow(positions: Positions<'_>) -> &[[f32; 3]] {
    match positions {
        Positions::F32(positions) => positions,
        // Not reached: a world is f64 if any source is. Refused as the wrong length if it were.
        Positions::F64(_) => &[],
    }
}

fn widen<'a>(positions: Positions<'a>, widened: &'a mut Vec<[f64; 3]>) -> &'a [[f64; 3]] {
    match positions {
        Positions::F64(positions) => positions,
        Positions::F32(positions) => {
            widened.clear();
            widened.extend(positions.iter().map(|position| position.map(f64::from)));
            widened
        }
    }
}
