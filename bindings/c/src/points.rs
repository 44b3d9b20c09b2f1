//! Coordinates of the caller, wherever they lie: rows, columns of Eigen, interleaved with others.
//!
//! Idea: the corners of pairs come as one array each. Where they are pairs of rows in a row, as
//! `[[[f64; 3]; 4]]` has them, they are read where they lie. Else some thousands are copied at a
//! time.

use crate::arrays::{countable, read};
use crate::status::{BAD_SCALAR, DIFFERENT_COUNTS, Refused, WOULD_ROUND};
use pliant::Scalar;
use std::borrow::Cow;
use std::ffi::c_void;

/// `pliant_scalar`: the type of coordinates.
pub type PliantScalar = i32;

pub(crate) const F32: PliantScalar = 0;
pub(crate) const F64: PliantScalar = 1;

/// `pliant_points`: where the coordinates of points lie.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantPoints {
    /// Address of the first coordinate of the first point.
    pub data: *const c_void,
    /// Number of points.
    pub count: usize,
    /// Bytes from a point to the next; 0 with a column of 0 if all lie behind each other.
    pub row: isize,
    /// Bytes from a coordinate of a point to the next.
    pub column: isize,
    /// Type of the coordinates.
    pub scalar: PliantScalar,
}

impl PliantPoints {
    /// Strides in bytes: of rows and of columns.
    fn strides(&self, size: usize) -> [isize; 2] {
        match [self.row, self.column] {
            [0, 0] => [3 * size as isize, size as isize],
            strides => strides,
        }
    }

    /// The point of a number, of numbers of this type.
    ///
    /// # Safety
    ///
    /// Its coordinates may be read, and are of type `S`.
    unsafe fn get<S: Scalar>(&self, point: usize) -> [S; 3] {
        let [row, column] = self.strides(size_of::<S>());
        let start = (self.data.cast::<u8>()).wrapping_offset(row.wrapping_mul(point as isize));
        [0, 1, 2].map(|axis| {
            let at = start.wrapping_offset(column.wrapping_mul(axis)).cast::<S>();
            // SAFETY: the caller of the library says that coordinates lie there.
            unsafe { at.read_unaligned() }
        })
    }
}

/// A number type of coordinates.
pub(crate) trait Number: Scalar {
    const SCALAR: PliantScalar;
    /// A number of single precision, widened if need be.
    fn widened(number: f32) -> Self;
    /// The nearest number to one of double precision.
    fn nearest(number: f64) -> Self;
}

impl Number for f32 {
    const SCALAR: PliantScalar = F32;
    fn widened(number: f32) -> Self {
        number
    }
    fn nearest(number: f64) -> Self {
        number as Self
    }
}

impl Number for f64 {
    const SCALAR: PliantScalar = F64;
    fn widened(number: f32) -> Self {
        number.into()
    }
    fn nearest(number: f64) -> Self {
        number
    }
}

/// A corner of a box in this precision, unless that would round it.
pub(crate) fn exactly<S: Number>(corner: [f64; 3]) -> Result<[S; 3], Refused> {
    let near = corner.map(S::nearest);
    // A number that no position may be is refused as such.
    let is_kept = |axis: usize| {
        let x = corner[axis];
        near[axis].to_f64() == x || x.is_nan() || x.abs() > f64::from(f32::MAX)
    };
    if (0..3).all(is_kept) {
        return Ok(near);
    }
    let words = "a corner of double precision would be rounded; round it as is right for you";
    let mut refused = Refused::new(WOULD_ROUND, words);
    refused.0.position = corner;
    Err(refused)
}

/// Positions of a body's vertices, as [`points`].
///
/// # Safety
///
/// `all` may be read as it says.
pub(crate) unsafe fn positions<S: Number>(
    all: &PliantPoints,
) -> Result<Cow<'_, [[S; 3]]>, Refused> {
    // SAFETY: as above.
    unsafe { points(all, "positions") }
}

/// Points as a world of this precision takes them, by the name of the argument: where they lie, if
/// they lie so, else copied. Single precision is widened; double would be rounded, and is refused.
///
/// # Safety
///
/// `points` may be read as it says.
pub(crate) unsafe fn points<'p, S: Number>(
    points: &'p PliantPoints,
    name: &str,
) -> Result<Cow<'p, [[S; 3]]>, Refused> {
    if points.data.is_null() && points.count > 0 {
        return Err(Refused::null(&format!("{name}.data")));
    }
    countable(points.count, &format!("{name}.count"))?;
    match points.scalar {
        F32 | F64 if points.scalar == S::SCALAR => {
            let (rows, size) = (points.data.cast::<[S; 3]>(), size_of::<S>());
            let lie_so = points.strides(size) == [3 * size as isize, size as isize];
            let fits = points.count <= isize::MAX as usize / (3 * size);
            if lie_so && fits && rows.is_aligned() && !rows.is_null() {
                // SAFETY: the rows may be read, lie behind each other, and are aligned.
                let rows = unsafe { std::slice::from_raw_parts(rows, points.count) };
                return Ok(Cow::Borrowed(rows));
            }
            // SAFETY: the points are there, and of this type.
            let get = |point| unsafe { points.get::<S>(point) };
            Ok(Cow::Owned((0..points.count).map(get).collect()))
        }
        F32 => {
            // SAFETY: the points are there, and of single precision.
            let get = |point| unsafe { points.get::<f32>(point) }.map(S::widened);
            Ok(Cow::Owned((0..points.count).map(get).collect()))
        }
        F64 => Err(Refused::new(
            WOULD_ROUND,
            format_args!(
                "{name} of double precision would be rounded; make the world of PLIANT_F64"
            ),
        )),
        other => Err(Refused::new(
            BAD_SCALAR,
            format_args!("{name}.scalar is {other}; give PLIANT_F32 or PLIANT_F64"),
        )),
    }
}

/// Corners of pairs, `C` of each, all of one type and count.
pub(crate) struct Corners<const C: usize> {
    points: [PliantPoints; C],
    count: usize,
    scalar: PliantScalar,
}

/// Pairs that are looked at before answers are written: they, and copies, stay in the cache.
const AT_ONCE: usize = 1024;

impl<const C: usize> Corners<C> {
    /// Corners as the caller gives them, by the name of the argument.
    ///
    /// # Safety
    ///
    /// `points` is NULL, or points to as many arrays, which may be read as they say.
    pub(crate) unsafe fn new(points: *const PliantPoints, name: &str) -> Result<Self, Refused> {
        let points = points.cast::<[PliantPoints; C]>();
        // SAFETY: it is NULL, or there are C arrays.
        let Some(points) = (unsafe { read(points) }) else {
            return Err(Refused::null(name));
        };
        let PliantPoints { count, scalar, .. } = points[0];
        for (corner, of) in points.iter().enumerate() {
            if ![F32, F64].contains(&of.scalar) || of.scalar != scalar {
                return Err(Refused::new(
                    BAD_SCALAR,
                    format_args!(
                        "{name}[{corner}].scalar is {}; give PLIANT_F32 or PLIANT_F64, one for all",
                        of.scalar
                    ),
                ));
            }
            if of.count != count {
                return Err(Refused::new(
                    DIFFERENT_COUNTS,
                    format_args!(
                        "{name}[{corner}] has {} points, and {name}[0] {count}; give one for each \
                         pair",
                        of.count
                    ),
                ));
            }
            if of.data.is_null() && count > 0 {
                return Err(Refused::null(&format!("{name}[{corner}].data")));
            }
        }
        Ok(Self {
            points,
            count,
            scalar,
        })
    }

    pub(crate) fn count(&self) -> usize {
        self.count
    }

    pub(crate) fn scalar(&self) -> PliantScalar {
        self.scalar
    }

    /// All pairs where they lie, if they lie as an array of Rust does.
    fn in_place<S: Scalar>(&self) -> Option<&[[[S; 3]; C]]> {
        let size = size_of::<S>();
        let all = self.points[0].data.cast::<[[S; 3]; C]>();
        let row = (3 * C * size) as isize;
        let lie_so = (0..C).all(|corner| {
            let of = &self.points[corner];
            let expected = all.cast::<u8>().wrapping_add(3 * size * corner);
            of.data.cast() == expected && of.strides(size) == [row, size as isize]
        });
        let fits = self.count <= isize::MAX as usize / (3 * C * size);
        if !lie_so || !fits || !all.is_aligned() || all.is_null() {
            return None;
        }
        // SAFETY: the coordinates of all pairs may be read, and lie behind each other. They are
        // aligned, and their bytes are not more than there may be.
        Some(unsafe { std::slice::from_raw_parts(all, self.count) })
    }
}

/// Shows pairs of numbers of type `S` to `each`, some at a time: the first pair's number, and the
/// pairs of every list of corners. All lists have one count and this type.
pub(crate) fn some_at_a_time<S: Scalar, const C: usize, const L: usize>(
    lists: [&Corners<C>; L],
    mut each: impl FnMut(usize, [&[[[S; 3]; C]]; L]) -> Result<(), Refused>,
) -> Result<(), Refused> {
    let count = lists[0].count;
    let in_place = lists.map(|list| list.in_place::<S>());
    let mut copies: [Vec<[[S; 3]; C]>; L] = [(); L].map(|()| Vec::new());
    let mut first = 0;
    while first < count {
        let end = count.min(first + AT_ONCE);
        if in_place.iter().all(Option::is_some) {
            let some = in_place.map(|all| &all.unwrap_or_default()[first..end]);
            each(first, some)?;
            first = end;
            continue;
        }
        for (copy, list) in copies.iter_mut().zip(lists) {
            copy.clear();
            copy.extend((first..end).map(|pair| {
                // SAFETY: the pair is there, and its numbers are of this type.
                std::array::from_fn(|corner| unsafe { list.points[corner].get::<S>(pair) })
            }));
        }
        each(first, copies.each_ref().map(Vec::as_slice))?;
        first = end;
    }
    Ok(())
}

/// An array that is written, if the caller wants it: a row of `R` items for each pair.
pub(crate) struct Written<T, const R: usize> {
    data: *mut T,
}

impl<T: Copy, const R: usize> Written<T, R> {
    /// An array of the caller, or NULL.
    ///
    /// # Safety
    ///
    /// It is NULL, or has a row for each pair that is set.
    pub(crate) unsafe fn new(data: *mut T) -> Self {
        Self { data }
    }

    /// Sets the row of a pair.
    pub(crate) fn set(&self, pair: usize, row: [T; R]) {
        if !self.data.is_null() {
            let at = self.data.wrapping_add(pair * R).cast::<[T; R]>();
            // SAFETY: there is a row for each pair.
            unsafe { at.write_unaligned(row) };
        }
    }
}
