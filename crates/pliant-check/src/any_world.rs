//! A world of single or double precision, chosen at run time.
//!
//! The precision of a [`World`] is a type. Files and Python's arrays have theirs as a value. This
//! is the one place where the two meet. 32-bit positions in a 64-bit world are widened, which
//! changes none. 64-bit positions in a 32-bit world are refused, since they would be rounded.

use pliant::{BodyId, Error, Options, World};
use pliant_io::{Positions, Precision};

/// A world of either precision.
#[derive(Clone, Debug)]
pub enum AnyWorld {
    /// World of single precision.
    F32(World<f32>),
    /// World of double precision.
    F64(World<f64>),
}

/// Evaluates an expression with the [`World`] of an [`AnyWorld`].
///
/// Compiles it for either precision: `with_world!(any_world, world => world.bodies().len())`.
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
    /// Error of the library.
    Refused(Error),
    /// Positions of double precision in a world of single precision.
    WouldBeRounded,
}

impl From<Error> for NotTaken {
    fn from(error: Error) -> Self {
        Self::Refused(error)
    }
}

impl AnyWorld {
    /// Creates an empty world.
    pub fn new(precision: Precision, options: Options) -> Self {
        match precision {
            Precision::F32 => Self::F32(World::with_options(options)),
            Precision::F64 => Self::F64(World::with_options(options)),
        }
    }

    /// Precision of the world.
    pub fn precision(&self) -> Precision {
        match self {
            Self::F32(_) => Precision::F32,
            Self::F64(_) => Precision::F64,
        }
    }

    /// Calls [`World::add`]. `widened` is scratch memory.
    ///
    /// # Errors
    ///
    /// The library refuses, or positions would be rounded.
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

    /// Calls [`World::set_mesh`]. `widened` is scratch memory.
    ///
    /// # Errors
    ///
    /// The library refuses, or positions would be rounded.
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

    /// Calls [`World::set_positions`]. `widened` is scratch memory.
    ///
    /// # Errors
    ///
    /// The library refuses, or positions would be rounded.
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

    /// Calls [`World::set_rest_positions`] with positions. `widened` is scratch memory.
    ///
    /// # Errors
    ///
    /// The library refuses, or positions would be rounded.
    pub fn set_rest_positions(
        &mut self,
        body: BodyId,
        positions: Positions<'_>,
        widened: &mut Vec<[f64; 3]>,
    ) -> Result<(), NotTaken> {
        match self {
            Self::F32(world) => world.set_rest_positions(body, Some(single(positions)?))?,
            Self::F64(world) => {
                world.set_rest_positions(body, Some(double(positions, widened)))?;
            }
        }
        Ok(())
    }

    /// Calls [`World::set_motion`]. `widened` is scratch memory.
    ///
    /// # Errors
    ///
    /// The library refuses, or positions would be rounded.
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

/// Positions of single precision.
///
/// # Errors
///
/// [`NotTaken::WouldBeRounded`] if they are of double precision.
pub fn single(positions: Positions<'_>) -> Result<&[[f32; 3]], NotTaken> {
    match positions {
        Positions::F32(positions) => Ok(positions),
        Positions::F64(_) => Err(NotTaken::WouldBeRounded),
    }
}

/// Positions in double precision, widened into `widened` if necessary.
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
