//! A world whose precision the first body fixes: float32 or float64.
//!
//! 32-bit positions in a 64-bit world are widened, which changes none. 64-bit positions in a 32-bit world would have to be
//! rounded, and are refused.

use crate::error::Refused;
use pliant::{BodyId, Options, World};
use pliant_io::{Positions, Precision};

/// A world of either precision.
pub(crate) enum Either {
    F32(World<f32>),
    F64(World<f64>),
}

/// Does the same to a world of either precision.
macro_rules! with_world {
    ($either:expr, $world:ident => $work:expr) => {
        match $either {
            $crate::state::Either::F32($world) => $work,
            $crate::state::Either::F64($world) => $work,
        }
    };
}
pub(crate) use with_world;

/// A world, and whether its precision is fixed.
pub(crate) struct State {
    /// Of any precision while it never had a body; questions then have the same answers.
    pub(crate) world: Either,
    options: Options,
    precision_is_fixed: bool,
    /// 32-bit positions, widened.
    widened: Vec<[f64; 3]>,
}

impl State {
    pub(crate) fn new(options: Options) -> Self {
        Self {
            world: Either::F64(World::with_options(options)),
            options,
            precision_is_fixed: false,
            widened: Vec::new(),
        }
    }

    /// The precision, once it is fixed.
    pub(crate) fn precision(&self) -> Option<Precision> {
        self.precision_is_fixed.then_some(match self.world {
            Either::F32(_) => Precision::F32,
            Either::F64(_) => Precision::F64,
        })
    }

    /// Fixes the precision of a world that never had a body.
    pub(crate) fn fix_precision(&mut self, precision: Precision) {
        if !self.precision_is_fixed {
            self.precision_is_fixed = true;
            self.world = match precision {
                Precision::F32 => Either::F32(World::with_options(self.options)),
                Precision::F64 => Either::F64(World::with_options(self.options)),
            };
        }
    }

    /// Adds a body. If it is the first, its precision becomes that of the world.
    pub(crate) fn add(
        &mut self,
        triangles: &[[u32; 3]],
        positions: Positions<'_>,
    ) -> Result<BodyId, Refused> {
        if !self.precision_is_fixed {
            let mut fixed = Self::new(self.options);
            fixed.fix_precision(precision_of(positions));
            let body = fixed.add(triangles, positions)?;
            *self = fixed;
            return Ok(body);
        }
        Ok(match &mut self.world {
            Either::F32(world) => world.add(triangles, narrow(positions, None)?)?,
            Either::F64(world) => world.add(triangles, widen(positions, &mut self.widened))?,
        })
    }

    /// Gives a body a new shape.
    pub(crate) fn set_positions(
        &mut self,
        body: BodyId,
        positions: Positions<'_>,
    ) -> Result<(), Refused> {
        match &mut self.world {
            Either::F32(world) => world.set_positions(body, narrow(positions, Some(body))?)?,
            Either::F64(world) => world.set_positions(body, widen(positions, &mut self.widened))?,
        }
        Ok(())
    }

    /// Gives a body the shape that somebody wrote, or did not.
    pub(crate) fn write_positions(
        &mut self,
        body: BodyId,
        written: Positions<'_>,
    ) -> Result<(), Refused> {
        // Should the buffer be of another length now, what is not written is said to be.
        fn copy<T: Copy>(from: &[T], to: &mut [T]) {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
        }
        match &mut self.world {
            Either::F32(world) => {
                let written = narrow(written, Some(body))?;
                world.write_positions(body, |lent| copy(written, lent))?;
            }
            Either::F64(world) => {
                let written = widen(written, &mut self.widened);
                world.write_positions(body, |lent| copy(written, lent))?;
            }
        }
        Ok(())
    }

    /// Gives a body a loose box, its corners rounded to the world's type.
    pub(crate) fn set_loose_box(
        &mut self,
        body: BodyId,
        corners: Option<([f64; 3], [f64; 3])>,
    ) -> Result<(), pliant::Error> {
        match &mut self.world {
            Either::F32(world) => {
                let rounded = |corner: [f64; 3]| corner.map(|x| x as f32);
                let corners = corners.map(|(lo, hi)| (rounded(lo), rounded(hi)));
                world.set_loose_box(body, corners)
            }
            Either::F64(world) => world.set_loose_box(body, corners),
        }
    }
}

pub(crate) fn precision_of(positions: Positions<'_>) -> Precision {
    match positions {
        Positions::F32(_) => Precision::F32,
        Positions::F64(_) => Precision::F64,
    }
}

/// 64-bit positions, as they are or widened into `buffer`.
pub(crate) fn widen<'a>(positions: Positions<'a>, buffer: &'a mut Vec<[f64; 3]>) -> &'a [[f64; 3]] {
    match positions {
        Positions::F64(positions) => positions,
        Positions::F32(positions) => {
            buffer.clear();
            buffer.extend(positions.iter().map(|position| position.map(f64::from)));
            buffer
        }
    }
}

/// 32-bit positions; others are refused.
fn narrow(positions: Positions<'_>, body: Option<BodyId>) -> Result<&[[f32; 3]], Refused> {
    match positions {
        Positions::F32(positions) => Ok(positions),
        Positions::F64(_) => Err(Refused::new(
            "Precision",
            "positions are float64 in a world of float32, which its first body made it; rounding them may change answers: if \
             that is meant, give positions.astype(numpy.float32), else begin the world with a body of float64",
        )
        .of_body(body)),
    }
}
