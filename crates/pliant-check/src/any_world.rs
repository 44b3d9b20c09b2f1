//! A world of either precision: the one place where positions of files, or of Python, which have one precision or the other, meet
//! worlds, whose precision is a type.
//!
//! 32-bit positions in a 64-bit world are widened, which changes none. 64-bit positions in a 32-bit world would have to be rounded,
//! and are refused.

use pliant::{BodyId, Error, Options, World};
use pliant_io::{Positions, Precision};

/// A world of one precision or the other.
#[derive(Clone, Debug)]
pub enum AnyWorld {
    /// Of single precision.
    F32(World<f32>),
    /// Of double precision.
    F64(World<f64>),
}

/// Does the same with a world of either precision: `with_world!(any_world, world => world.bodies().len())`.
#[macro_export]
macro_rules! with_world {
    ($any_world:expr, $world:ident => $work:expr) => {
        match $any_world {
            $crate::AnyWorld::F32($world) => $work,
            $crate::AnyWorld::F64($world) => $work,
        }
    };
}

/// Why positions were not taken.
#[derive(Clone, Debug, PartialEq)]
pub enum NotTaken {
    /// The library refused them.
    Refused(Error),
    /// They are of double precision, and the world is of single precision.
    WouldBeRounded,
}

impl From<Error> for NotTaken {
    fn from(error: Error) -> Self {
        Self::Refused(error)
    }
}

impl AnyWorld {
    /// An empty world.
    pub fn new(precision: Precision, options: Options) -> Self {
        match precision {
            Precision::F32 => Self::F32(World::with_options(options)),
            Precision::F64 => Self::F64(World::with_options(options)),
        }
    }

    /// Its precision.
    pub fn precision(&self) -> Precision {
        match self {
            Self::F32(_) => Precision::F32,
            Self::F64(_) => Precision::F64,
        }
    }

    /// [`World::add`]. `widened` is scratch.
    ///
    /// # Errors
    ///
    /// Those of the library, or that positions would be rounded.
    pub fn add(
        &mut self,
        triangles: &[[u32; 3]],
        positions: Positions<'_>,
        widened: &mut Vec<[f64; 3]>,
    ) -> Result<BodyId, NotTaken> {
        Ok(match self {
            Self::F32(world) => world.add(triangles, single(positions)?)?,
            Self::F64(world) => world.add(triangles, double(positions, widened))?,
        })
    }

    /// [`World::set_mesh`]. `widened` is scratch.
    ///
    /// # Errors
    ///
    /// Those of the library, or that positions would be rounded.
    pub fn set_mesh(
        &mut self,
        body: BodyId,
        triangles: &[[u32; 3]],
        positions: Positions<'_>,
        widened: &mut Vec<[f64; 3]>,
    ) -> Result<(), NotTaken> {
        match self {
            Self::F32(world) => world.set_mesh(body, triangles, single(positions)?)?,
            Self::F64(world) => world.set_mesh(body, triangles, double(positions, widened))?,
        }
        Ok(())
    }

    /// [`World::set_positions`]. `widened` is scratch.
    ///
    /// # Errors
    ///
    /// Those of the library, or that positions would be rounded.
    pub fn set_positions(
        &mut self,
        body: BodyId,
        positions: Positions<'_>,
        widened: &mut Vec<[f64; 3]>,
    ) -> Result<(), NotTaken> {
        match self {
            Self::F32(world) => world.set_positions(body, single(positions)?)?,
            Self::F64(world) => world.set_positions(body, double(positions, widened))?,
        }
        Ok(())
    }

    /// [`World::set_motion`]. `widened` is scratch.
    ///
    /// # Errors
    ///
    /// Those of the library, or that positions would be rounded.
    pub fn set_motion(
        &mut self,
        body: BodyId,
        end: Positions<'_>,
        widened: &mut Vec<[f64; 3]>,
    ) -> Result<(), NotTaken> {
        match self {
            Self::F32(world) => world.set_motion(body, single(end)?)?,
            Self::F64(world) => world.set_motion(body, double(end, widened))?,
        }
        Ok(())
    }
}

/// Positions in single precision, if they are.
///
/// # Errors
///
/// They are not.
pub fn single(positions: Positions<'_>) -> Result<&[[f32; 3]], NotTaken> {
    match positions {
        Positions::F32(positions) => Ok(positions),
        Positions::F64(_) => Err(NotTaken::WouldBeRounded),
    }
}

/// Positions in double precision, as they are or widened.
pub fn double<'a>(positions: Positions<'a>, widened: &'a mut Vec<[f64; 3]>) -> &'a [[f64; 3]] {
    match positions {
        Positions::F64(positions) => positions,
        Positions::F32(positions) => {
            widened.clear();
            widened.extend(positions.iter().map(|position| position.map(f64::from)));
            widened
        }
    }
}
