//! A world whose precision the first body fixes: float32 or float64.

use crate::arrays::{Coordinates, CopiedCoordinates};
use crate::columns::{Kept, Resources};
use crate::copies::Room;
use crate::error::{Refused, Result, alone, alone_with, refused};
use pliant::{BodyId, Error, ErrorKind, Options};
use pliant_check::{AnyWorld, NotTaken, double, single, with_world};
use pliant_io::{Positions, Precision};
use pyo3::Python;
use std::sync::{Arc, Mutex, MutexGuard};

/// Corners of an empty triangle number.
const EMPTY: [u32; 3] = [u32::MAX; 3];

/// The lower and the upper corner of a box.
pub(crate) type Corners = ([f64; 3], [f64; 3]);

/// State of a world, shared with the queries made from it, for one call at a time.
#[derive(Clone)]
pub(crate) struct Shared(Arc<Mutex<State>>);

impl Shared {
    pub(crate) fn new(state: State) -> Self {
        Self(Arc::new(Mutex::new(state)))
    }

    /// Does `work` on the state, without the interpreter lock.
    pub(crate) fn with<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut State) -> Result<T> + Send,
    ) -> Result<T> {
        alone_with(py, &self.0, work)
    }

    /// Locks the state for one call, or refuses if another call has it.
    pub(crate) fn alone(&self) -> Result<MutexGuard<'_, State>> {
        alone(&self.0)
    }
}

/// A world, and whether its precision is fixed.
pub(crate) struct State {
    /// The world; of any precision while it never had a body, for answers are then the same.
    pub(crate) world: AnyWorld,
    options: Options,
    precision_is_fixed: bool,
    /// Buffer for float32 positions, widened.
    widened: Vec<[f64; 3]>,
    /// Buffer for copies of float32 shapes that bodies are given.
    narrow: Room<f32>,
    /// Buffer for copies of float64 shapes.
    wide: Room<f64>,
    /// Hits in job order.
    kept: Kept,
}

impl State {
    pub(crate) fn new(options: Options) -> Self {
        Self {
            world: AnyWorld::new(Precision::F64, options),
            options,
            precision_is_fixed: false,
            widened: Vec::new(),
            narrow: Room::default(),
            wide: Room::default(),
            kept: Kept::default(),
        }
    }

    pub(crate) fn options(&self) -> &Options {
        &self.options
    }

    /// The world, and what its answers are listed with.
    pub(crate) fn lend(&mut self) -> (&mut AnyWorld, Resources<'_>) {
        let resources = Resources {
            threads: self.options.threads.get(),
            kept: &mut self.kept,
        };
        (&mut self.world, resources)
    }

    /// Copies the world.
    pub(crate) fn another(&self) -> Self {
        Self {
            world: self.world.clone(),
            precision_is_fixed: self.precision_is_fixed,
            ..Self::new(self.options)
        }
    }

    /// Bytes of the buffers beside the world. The caller has the interpreter lock.
    pub(crate) fn room(&self, py: Python<'_>) -> usize {
        let widened = self.widened.capacity() * size_of::<[f64; 3]>();
        widened + self.narrow.held(py) + self.wide.held(py) + self.kept.bytes()
    }

    /// The precision, once it is fixed.
    pub(crate) fn precision(&self) -> Option<Precision> {
        self.precision_is_fixed.then(|| self.world.precision())
    }

    /// Fixes the precision of a world that never had a body.
    pub(crate) fn fix_precision(&mut self, precision: Precision) {
        if !self.precision_is_fixed {
            self.precision_is_fixed = true;
            self.world = AnyWorld::new(precision, self.options);
        }
    }

    /// Adds a body. The first fixes the precision of the world.
    pub(crate) fn add(
        &mut self,
        triangles: &[[u32; 3]],
        positions: Positions<'_>,
    ) -> Result<BodyId> {
        if !self.precision_is_fixed {
            let mut fixed = Self::new(self.options);
            fixed.fix_precision(precision_of(positions));
            let body = fixed.add(triangles, positions)?;
            *self = fixed;
            return Ok(body);
        }
        Ok(self.world.add(triangles, positions, &mut self.widened)?)
    }

    /// Gives a body another mesh and its shape.
    pub(crate) fn set_mesh(
        &mut self,
        body: BodyId,
        triangles: &[[u32; 3]],
        positions: Positions<'_>,
    ) -> Result<()> {
        let widened = &mut self.widened;
        let taken = self.world.set_mesh(body, triangles, positions, widened);
        taken.map_err(|not_taken| of_body(body, not_taken))
    }

    /// Adds a body that has empty triangle and vertex numbers.
    ///
    /// They are filled with copies of others first, which an edit then removes.
    pub(crate) fn add_with_empty(
        &mut self,
        triangles: &[[u32; 3]],
        positions: Positions<'_>,
    ) -> Result<BodyId> {
        let is_live = |corners: &&[u32; 3]| **corners != EMPTY;
        let Some(&some) = triangles.iter().find(is_live) else {
            return self.add(triangles, positions);
        };
        let is_nan = |row: &[f64; 3]| row.iter().any(|x| x.is_nan());
        let mut rows = double(positions, &mut Vec::new()).to_vec();
        let place = rows.get(some[0] as usize).copied().unwrap_or_default();
        let empty = numbers_of(&rows, is_nan);
        for &vertex in &empty {
            rows[vertex as usize] = place;
        }
        let gone = numbers_of(triangles, |corners| !is_live(&corners));
        let filled = |corners: &[u32; 3]| if is_live(&corners) { *corners } else { some };
        let filled: Vec<[u32; 3]> = triangles.iter().map(filled).collect();
        // Widened float32 numbers are rounded back without loss.
        let narrow: Vec<[f32; 3]>;
        let rows = match positions {
            Positions::F32(_) => {
                narrow = rows.iter().map(|row| row.map(|x| x as f32)).collect();
                Positions::F32(&narrow)
            }
            Positions::F64(_) => Positions::F64(&rows),
        };
        let body = self.add(&filled, rows)?;
        with_world!(&mut self.world, world => {
            let mut edit = world.edit(body)?;
            edit.remove_triangles(&gone);
            for &vertex in &empty {
                edit.merge_vertices(some[0], vertex);
            }
            world.apply(&edit)?;
        });
        Ok(body)
    }

    /// Copies a new shape of a body, a row for each vertex, in the world's type.
    ///
    /// Float32 is widened on the way. The caller has the interpreter lock.
    pub(crate) fn copy<'py>(
        &mut self,
        body: BodyId,
        given: &Coordinates<'py>,
    ) -> Result<CopiedCoordinates<'py>> {
        let single = matches!(self.world, AnyWorld::F32(_));
        if single && matches!(given, Coordinates::F64(_)) {
            return Err(of_body(body, NotTaken::WouldBeRounded));
        }
        let expected = with_world!(&self.world, world => world.vertex_count(body))?;
        let found = given.len();
        if expected != found {
            let body = Some(body);
            let kind = ErrorKind::WrongLength {
                what: "positions",
                expected,
                found,
            };
            return Err(Error { body, kind }.into());
        }
        Ok(match given {
            Coordinates::F32(given) if single => CopiedCoordinates::F32(self.narrow.copy(given)?),
            Coordinates::F32(given) => CopiedCoordinates::F64(self.wide.copy(given)?),
            Coordinates::F64(given) => CopiedCoordinates::F64(self.wide.copy(given)?),
        })
    }

    /// Gives a body a new shape.
    pub(crate) fn set_positions(&mut self, body: BodyId, positions: Positions<'_>) -> Result<()> {
        let taken = self.world.set_positions(body, positions, &mut self.widened);
        taken.map_err(|not_taken| of_body(body, not_taken))
    }

    /// Gives bodies new shapes, all or none.
    pub(crate) fn set_positions_of(&mut self, shapes: &[(BodyId, Positions<'_>)]) -> Result<()> {
        match &mut self.world {
            AnyWorld::F32(world) => {
                let mut singles = Vec::with_capacity(shapes.len());
                for &(body, shape) in shapes {
                    let shape = single(shape).map_err(|not_taken| of_body(body, not_taken))?;
                    singles.push((body, shape));
                }
                world.set_positions_of(&singles)?;
            }
            AnyWorld::F64(world) => {
                let mut widened = vec![Vec::new(); shapes.len()];
                let doubles = shapes.iter().zip(&mut widened);
                let doubles = doubles.map(|(&(body, shape), wide)| (body, double(shape, wide)));
                world.set_positions_of(&doubles.collect::<Vec<_>>())?;
            }
        }
        Ok(())
    }

    /// Begins a motion of a body.
    pub(crate) fn set_motion(&mut self, body: BodyId, end: Positions<'_>) -> Result<()> {
        let taken = self.world.set_motion(body, end, &mut self.widened);
        taken.map_err(|not_taken| of_body(body, not_taken))
    }

    /// Gives a body a rest shape.
    pub(crate) fn set_rest_positions(&mut self, body: BodyId, rest: Positions<'_>) -> Result<()> {
        let taken = self.world.set_rest_positions(body, rest, &mut self.widened);
        taken.map_err(|not_taken| of_body(body, not_taken))
    }

    /// Gives a body a shape that a caller wrote into an array.
    pub(crate) fn write_positions(&mut self, body: BodyId, written: Positions<'_>) -> Result<()> {
        // Of another length now, the array leaves rows unwritten, which are refused.
        fn copy<T: Copy>(from: &[T], to: &mut [T]) {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
        }
        match &mut self.world {
            AnyWorld::F32(world) => {
                let written = single(written).map_err(|not_taken| of_body(body, not_taken))?;
                world.write_positions(body, |lent| copy(written, lent))?;
            }
            AnyWorld::F64(world) => {
                let written = double(written, &mut self.widened);
                world.write_positions(body, |lent| copy(written, lent))?;
            }
        }
        Ok(())
    }

    /// Gives a body a loose box, its corners rounded to the world's type.
    pub(crate) fn set_loose_box(
        &mut self,
        body: BodyId,
        corners: Option<Corners>,
    ) -> Result<(), Error> {
        match &mut self.world {
            AnyWorld::F32(world) => {
                let rounded = |corner: [f64; 3]| corner.map(|x| x as f32);
                let corners = corners.map(|(lo, hi)| (rounded(lo), rounded(hi)));
                world.set_loose_box(body, corners)
            }
            AnyWorld::F64(world) => world.set_loose_box(body, corners),
        }
    }

    /// Loose box of a body, widened.
    pub(crate) fn loose_box(&self, body: BodyId) -> Result<Option<Corners>, Error> {
        Ok(match &self.world {
            AnyWorld::F32(world) => {
                let wide = |corner: [f32; 3]| corner.map(f64::from);
                let corners = world.loose_box(body)?;
                corners.map(|(lo, hi)| (wide(lo), wide(hi)))
            }
            AnyWorld::F64(world) => world.loose_box(body)?,
        })
    }
}

/// Indices of the entries of a list that satisfy a predicate.
fn numbers_of<T>(list: &[T], is_so: impl Fn(&T) -> bool) -> Vec<u32> {
    let numbered = (0..).zip(list);
    numbered
        .filter_map(|(number, one)| is_so(one).then_some(number))
        .collect()
}

pub(crate) fn precision_of(positions: Positions<'_>) -> Precision {
    match positions {
        Positions::F32(_) => Precision::F32,
        Positions::F64(_) => Precision::F64,
    }
}

/// Refusal of positions that were given for a body.
///
/// The library names the body by itself where it is the one that refuses.
pub(crate) fn of_body(body: BodyId, not_taken: NotTaken) -> Refused {
    let is_named = matches!(not_taken, NotTaken::Refused(_));
    let refused = Refused::from(not_taken);
    if is_named {
        refused
    } else {
        refused.of_body(Some(body))
    }
}

impl From<NotTaken> for Refused {
    fn from(not_taken: NotTaken) -> Self {
        match not_taken {
            NotTaken::Refused(error) => error.into(),
            NotTaken::WouldBeRounded => would_be_rounded("positions"),
        }
    }
}

/// Refusal of an array of doubles in a world of float32.
pub(crate) fn would_be_rounded(what: &str) -> Refused {
    refused!(Precision:
        "{what} are float64 in a world of float32, which its first body made it; \
         rounding them may change answers: if that is meant, give \
         {what}.astype(numpy.float32), else begin the world with a body of float64")
}
