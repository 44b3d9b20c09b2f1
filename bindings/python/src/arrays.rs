//! numpy arrays of callers.
//!
//! Positions are (n, 3) float32 or float64, faces (m, 3) of any integer type, in any layout. Numpy
//! copies them once, to where nobody else can write (`copies.rs`). Integers are checked on the way
//! to uint32. No value is ever changed: what would be rounded is refused, and so is a masked array
//! that hides a value.

use crate::answers::Any;
use crate::copies::{self, Copied};
use crate::error::{Refused, Result, refused};
use numpy::{
    Element, PyArray2, PyArrayDescrMethods, PyReadonlyArray2, PyUntypedArray,
    PyUntypedArrayMethods, dtype,
};
use pliant_check::double;
use pliant_io::{Positions, shown_within};
use pyo3::basic::CompareOp;
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyEllipsis, PyList, PySlice, PyTuple};

/// Positions of a caller, which anybody may write to: to be copied.
pub(crate) enum Coordinates<'py> {
    F32(Bound<'py, PyArray2<f32>>),
    F64(Bound<'py, PyArray2<f64>>),
}

/// Copied positions.
pub(crate) enum CopiedCoordinates<'py> {
    F32(Copied<'py, f32>),
    F64(Copied<'py, f64>),
}

/// Copied triangles.
pub(crate) enum CopiedFaces<'py> {
    AsGiven(Copied<'py, u32>),
    Converted(Vec<[u32; 3]>),
}

impl<'py> Coordinates<'py> {
    /// Reads an (n, 3) array of float32 or float64, or an object that numpy converts to one.
    pub(crate) fn read(given: &Any<'py>) -> Result<Self> {
        Self::of_array(&as_array(given, "positions", "n")?, "positions")
    }

    /// Reads an (n, 3) array, called `what` in messages.
    pub(crate) fn of_array(array: &Bound<'py, PyUntypedArray>, what: &str) -> Result<Self> {
        let dtype = array.dtype();
        match (dtype.kind(), dtype.itemsize()) {
            (b'f', 4) => typed(array).map(Self::F32),
            (b'f', 8) => typed(array).map(Self::F64),
            (kind, _) => {
                let hint = if matches!(kind, b'i' | b'u') && what == "positions" {
                    "; or were faces and positions exchanged?"
                } else {
                    ""
                };
                Err(refused!(BadArray:
                    "{what} are of type {dtype}; they must be float32 or float64: use \
                     {what}.astype(numpy.float64){hint}"))
            }
        }
    }

    /// Number of positions.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::F32(array) => array.shape()[0],
            Self::F64(array) => array.shape()[0],
        }
    }
}

impl<'py> CopiedCoordinates<'py> {
    /// Copies an (n, 3) array of float32 or float64, or an object that numpy converts to one.
    pub(crate) fn of(given: &Any<'py>) -> Result<Self> {
        Self::anew(Coordinates::read(given)?)
    }

    /// Copies them into an array of their own.
    pub(crate) fn anew(given: Coordinates<'py>) -> Result<Self> {
        Ok(match given {
            Coordinates::F32(array) => Self::F32(copies::anew(&array)?),
            Coordinates::F64(array) => Self::F64(copies::anew(&array)?),
        })
    }

    /// Positions as the Rust libraries have them.
    pub(crate) fn get(&self) -> Result<Positions<'_>> {
        Ok(match self {
            Self::F32(copied) => Positions::F32(copied.rows()?),
            Self::F64(copied) => Positions::F64(copied.rows()?),
        })
    }
}

impl<'py> CopiedFaces<'py> {
    /// Copies an (m, 3) array of integers: corners of triangles, below `vertices`.
    pub(crate) fn of(given: &Any<'py>, vertices: usize) -> Result<Self> {
        let array = as_array(given, "faces", "m")?;
        let dtype = array.dtype();
        let converted = match (dtype.kind(), dtype.itemsize()) {
            (b'u', 4) => return copies::anew(&typed(&array)?).map(Self::AsGiven),
            (b'u', 1) => convert::<u8>(&array, vertices),
            (b'u', 2) => convert::<u16>(&array, vertices),
            (b'u', 8) => convert::<u64>(&array, vertices),
            (b'i', 1) => convert::<i8>(&array, vertices),
            (b'i', 2) => convert::<i16>(&array, vertices),
            (b'i', 4) => convert::<i32>(&array, vertices),
            (b'i', 8) => convert::<i64>(&array, vertices),
            _ => Err(refused!(BadArray:
                "faces are of type {dtype}; they must be integers, the numbers of their vertices; \
                 were faces and positions exchanged?")),
        };
        converted.map(Self::Converted)
    }

    /// Triangles as the Rust library has them.
    pub(crate) fn get(&self) -> Result<&[[u32; 3]]> {
        match self {
            Self::AsGiven(copied) => copied.rows(),
            Self::Converted(triangles) => Ok(triangles),
        }
    }
}

/// Copies points (k, 3) of float32 or float64.
pub(crate) fn points<'py>(given: &Any<'py>) -> Result<CopiedCoordinates<'py>> {
    let array = as_array(given, "points", "k")?;
    CopiedCoordinates::anew(Coordinates::of_array(&array, "points")?)
}

/// Shapes of a body, frame after frame: an array (frames, n, 3), which anybody may write to.
pub(crate) fn frames<'py>(given: &Any<'py>) -> Result<Bound<'py, PyUntypedArray>> {
    refuse_masks(given, "positions")?;
    let array = as_numpy(given, "positions")?;
    if let [_, _, 3] = array.shape() {
        return Ok(array);
    }
    let shape = array.getattr("shape")?;
    let hint = match array.shape() {
        [_, 3] => ": one frame; give positions[None], or set_positions",
        _ => "",
    };
    Err(refused!(BadArray:
        "positions have shape {shape}; they must be (frames, n, 3){hint}"))
}

/// Copied mesh.
pub(crate) struct CopiedMesh<'py> {
    faces: CopiedFaces<'py>,
    positions: CopiedCoordinates<'py>,
}

impl<'py> CopiedMesh<'py> {
    /// Copies the arrays of a mesh; `about` says of a refusal which mesh it is about.
    pub(crate) fn of(
        faces: &Any<'py>,
        positions: &Any<'py>,
        about: impl Fn(Refused) -> Refused,
    ) -> Result<Self> {
        let positions = CopiedCoordinates::of(positions).map_err(&about)?;
        let vertices = positions.get()?.len();
        let faces = CopiedFaces::of(faces, vertices).map_err(&about)?;
        Ok(Self { faces, positions })
    }

    /// Mesh as the Rust library has it.
    pub(crate) fn get(&self) -> Result<(&[[u32; 3]], Positions<'_>)> {
        Ok((self.faces.get()?, self.positions.get()?))
    }
}

/// Faces and vertices of a mesh object.
///
/// trimesh has `faces`, Open3D `triangles`, both `vertices`. `faces` is looked for first, because
/// `triangles` of trimesh are coordinates.
pub(crate) fn parts_of_mesh<'py>(mesh: &Any<'py>) -> Result<[Bound<'py, PyAny>; 2]> {
    let py = mesh.py();
    let faces = match mesh.getattr_opt(intern!(py, "faces"))? {
        None => mesh.getattr_opt(intern!(py, "triangles"))?,
        faces => faces,
    };
    match (faces, mesh.getattr_opt(intern!(py, "vertices"))?) {
        (Some(faces), Some(vertices)) => Ok([faces, vertices]),
        _ => Err(refused!(BadArray:
            "{} has no .faces (or .triangles) and .vertices; give a mesh that has, or the arrays \
             themselves", mesh.get_type())),
    }
}

/// Copies an (n,) array of integers from 0 to 2^32 - 1.
///
/// `name` and `what` say in messages what the numbers are.
pub(crate) fn numbers(given: &Any<'_>, [name, what]: [&str; 2]) -> Result<Vec<u32>> {
    let py = given.py();
    refuse_masks(given, name)?;
    let array = as_numpy(given, name)?;
    let dtype = array.dtype();
    let bad = |have: String| {
        refused!(BadArray:
            "{name} {have}; they must be integers from 0 to 4294967295, {what}")
    };
    // numpy takes an empty list for floating-point numbers.
    if array.shape() == [0] {
        return Ok(Vec::new());
    }
    if array.ndim() != 1 || !matches!(dtype.kind(), b'u' | b'i') {
        let dimensions = array.ndim();
        let have = format!("have {dimensions} dimensions and are of type {dtype}");
        return Err(bad(have));
    }
    let rows: Vec<i128> = array.call_method0(intern!(py, "tolist"))?.extract()?;
    let number = |&number: &i128| u32::try_from(number).map_err(|_| bad(format!("hold {number}")));
    rows.iter().map(number).collect()
}

/// Copies an (n,) array of floating-point numbers, or of integers.
///
/// `name` and `what` say in messages what the numbers are.
pub(crate) fn floats(given: &Any<'_>, [name, what]: [&str; 2]) -> Result<Vec<f64>> {
    refuse_masks(given, name)?;
    let array = as_numpy(given, name)?;
    let dtype = array.dtype();
    if array.ndim() != 1 || !matches!(dtype.kind(), b'f' | b'u' | b'i') {
        let dimensions = array.ndim();
        return Err(refused!(BadArray:
            "{name} has {dimensions} dimensions and is of type {dtype}; it must hold \
             numbers, {what}"));
    }
    Ok(array
        .call_method0(intern!(given.py(), "tolist"))?
        .extract()?)
}

/// Copies edges (k, 2) of any integer type: the two vertices of each.
pub(crate) fn edges_of(edges: &Any<'_>) -> Result<Vec<[u32; 2]>> {
    twos(
        edges,
        ["edges", "vertices", "the numbers of their vertices"],
    )
}

/// Copies neighbouring labels (k, 2) of any integer type.
pub(crate) fn neighbours_of(pairs: &Any<'_>) -> Result<Vec<[u32; 2]>> {
    twos(pairs, ["neighbours", "labels", "two labels each"])
}

/// Copies rows of two numbers of any integer type.
fn twos(given: &Any<'_>, [name, of, what]: [&str; 3]) -> Result<Vec<[u32; 2]>> {
    let array = as_numpy(given, name)?;
    let shape = array.shape();
    if !matches!(shape, [_, 2] | [0]) {
        return Err(refused!(BadArray:
            "{name} have shape {shape:?}; they must be (k, 2), two {of} a row"));
    }
    let flat = array.call_method1(intern!(given.py(), "reshape"), (-1,))?;
    let all = numbers(&flat, [name, what])?;
    Ok(all.as_chunks().0.to_vec())
}

/// Copies edges (k, 2) and points (k,), of any integer type, as the triangles that they are.
///
/// An edge has its second end twice, a point its vertex three times. Vertices are below `vertices`.
pub(crate) fn edges_and_points(
    [edges, points]: [Option<&Any<'_>>; 2],
    vertices: usize,
) -> Result<Vec<[u32; 3]>> {
    let mut triangles = Vec::new();
    if let Some(edges) = edges {
        triangles.extend(edges_of(edges)?.into_iter().map(|[a, b]| [a, b, b]));
    }
    let edge_count = triangles.len();
    if let Some(points) = points {
        let points = numbers(points, ["points", "the numbers of their vertices"])?;
        triangles.extend(points.into_iter().map(|vertex| [vertex; 3]));
    }
    for (row, corners) in triangles.iter().enumerate() {
        if let Some(vertex) = corners.iter().find(|&&vertex| vertex as usize >= vertices) {
            let (name, row) = match row.checked_sub(edge_count) {
                None => ("edges", row),
                Some(row) => ("points", row),
            };
            return Err(refused!(BadArray:
                "row {row} of {name} names vertex {vertex}, but there are {vertices} positions \
                 (counted from 0)"));
        }
    }
    Ok(triangles)
}

/// Copies a (k, C, 3) array of float32 or float64: the corners of each pair.
pub(crate) fn corners_of_pairs<const C: usize>(given: &Any<'_>) -> Result<Vec<[[f64; 3]; C]>> {
    let py = given.py();
    refuse_masks(given, "corners")?;
    let array = as_numpy(given, "corners")?;
    let shape = array.getattr(intern!(py, "shape"))?;
    if !matches!(shape.extract::<Vec<usize>>()?[..], [_, corners, 3] if corners == C) {
        return Err(refused!(BadArray:
            "corners have shape {shape}; it must be (k, {C}, 3): {C} corners of each pair"));
    }
    let rows = array.call_method1(intern!(py, "reshape"), (-1, 3))?;
    let rows = rows.cast_into::<PyUntypedArray>().map_err(PyErr::from)?;
    let copied = CopiedCoordinates::anew(Coordinates::of_array(&rows, "corners")?)?;
    let mut wide = Vec::new();
    let rows = double(copied.get()?, &mut wide);
    let (pairs, _) = rows.as_chunks::<C>();
    Ok(pairs.to_vec())
}

/// Copies one position, an array (3,) of float32 or float64, as an array of one row.
pub(crate) fn position<'py>(given: &Any<'py>) -> Result<CopiedCoordinates<'py>> {
    refuse_masks(given, "position")?;
    let array = as_numpy(given, "position")?;
    let shape = array.getattr("shape")?;
    if array.shape() != [3] {
        return Err(refused!(BadArray: "position has shape {shape}; it must be (3,)"));
    }
    let row = array.call_method1(intern!(array.py(), "reshape"), (1, 3))?;
    CopiedCoordinates::of(&row)
}

/// Number of a vertex, a triangle or a level, or a mask of 32 bits.
#[derive(Clone, Copy)]
pub(crate) struct Number(pub(crate) u32);

impl<'py> FromPyObject<'_, 'py> for Number {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let number = given.extract().map(Self);
        number.map_err(|error| expected(given, error, "an integer from 0 to 4294967295"))
    }
}

/// Corners of one triangle.
#[derive(Clone, Copy)]
pub(crate) struct Triangle(pub(crate) [u32; 3]);

impl<'py> FromPyObject<'_, 'py> for Triangle {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let corners = given.extract().map(Self);
        corners.map_err(|error| expected(given, error, "three vertex numbers, 0 to 4294967295"))
    }
}

/// Lower and upper corner of a box, rounded to float64.
#[derive(Clone, Copy)]
pub(crate) struct BoxCorners(pub(crate) ([f64; 3], [f64; 3]));

impl<'py> FromPyObject<'_, 'py> for BoxCorners {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let corners = given.extract().map(Self);
        let wanted = "a tuple (lower, upper), three numbers each, or None";
        corners.map_err(|error| expected(given, error, wanted))
    }
}

/// Exception of the same class that says what was expected; pyo3 adds the name of the argument.
pub(crate) fn expected(given: Borrowed<'_, '_, PyAny>, error: PyErr, wanted: &str) -> PyErr {
    let py = given.py();
    let Ok(given) = given.repr() else {
        return error;
    };
    let given = given.to_string();
    let text = format!("{} is not {wanted}", shown_within(&given, 60));
    if error.is_instance_of::<PyOverflowError>(py) {
        PyOverflowError::new_err(text)
    } else if error.is_instance_of::<PyTypeError>(py) {
        PyTypeError::new_err(text)
    } else if error.is_instance_of::<PyValueError>(py) {
        PyValueError::new_err(text)
    } else {
        error
    }
}

/// An array of rows of three, without a mask.
fn as_array<'py>(given: &Any<'py>, what: &str, rows: &str) -> Result<Bound<'py, PyUntypedArray>> {
    refuse_masks(given, what)?;
    let array = as_numpy(given, what)?;
    if array.ndim() == 2 && array.shape()[1] == 3 {
        return Ok(array);
    }
    let shape = array.getattr("shape")?;
    let hint = if rows == "m" {
        about_faces(&array)?.to_owned()
    } else {
        match array.shape() {
            [_, 2] => ": two coordinates; pliant needs three".to_owned(),
            [count] if count % 3 == 0 => format!(": flat; give {what}.reshape(-1, 3)"),
            _ => about_rows(&array).to_owned(),
        }
    };
    Err(refused!(BadArray: "{what} have shape {shape}; it must be ({rows}, 3){hint}"))
}

/// Hint about an array of a wrong shape, whatever its rows are.
fn about_rows(array: &Bound<'_, PyUntypedArray>) -> &'static str {
    match array.shape() {
        [_, _, 3] => ": give one frame at a time",
        [3, _] => ": transposed?",
        _ => "",
    }
}

/// Hint about an array that is not one of triangles.
fn about_faces(array: &Bound<'_, PyUntypedArray>) -> PyResult<&'static str> {
    let py = array.py();
    // In VTK, and so in PyVista, a cell begins with how many corners it has.
    let are_all_three = |counts: Bound<'_, PyAny>| {
        let are_three = counts.rich_compare(3, CompareOp::Eq)?;
        are_three.call_method0("all")?.is_truthy()
    };
    Ok(match *array.shape() {
        [rows, 4] if rows > 0 && are_all_three(array.get_item((PyEllipsis::get(py), 0))?)? => {
            ": these are cells of VTK, [3, a, b, c]; give faces[:, 1:]"
        }
        [3, _] => about_rows(array),
        [_, 4] => {
            ": cut quads into two triangles each; of tetrahedra give the surface, the triangles \
             that only one of them has"
        }
        [_, 2] => ": of edges give each as the triangle [i, j, j]",
        [count]
            if count > 0
                && count % 4 == 0
                && are_all_three(array.get_item(PySlice::new(py, 0, count as isize, 4))?)? =>
        {
            ": these are cells of VTK, [3, a, b, c, 3, ...]; give faces.reshape(-1, 4)[:, 1:]"
        }
        [count] if count % 3 == 0 => ": flat; give faces.reshape(-1, 3)",
        _ => about_rows(array),
    })
}

/// Array that numpy makes of an object, one that has only `__dlpack__` included.
fn as_numpy<'py>(given: &Any<'py>, what: &str) -> Result<Bound<'py, PyUntypedArray>> {
    let py = given.py();
    if let Ok(array) = given.cast::<PyUntypedArray>() {
        return Ok(array.clone());
    }
    refuse_devices(given, what)?;
    let numpy = py.import(intern!(py, "numpy"))?;
    let array = numpy.call_method1(intern!(py, "asarray"), (given,))?;
    let array = array.cast_into::<PyUntypedArray>().map_err(PyErr::from)?;
    // Of an object that numpy cannot read it makes an array of that one object.
    let is_one_object = array.ndim() == 0 && array.dtype().kind() == b'O';
    if !is_one_object || !given.hasattr(intern!(py, "__dlpack__"))? {
        return Ok(array);
    }
    let array = numpy.call_method1(intern!(py, "from_dlpack"), (given,));
    let array = array.map_err(|error| {
        refused!(BadArray:
        "{what} cannot be read by numpy.from_dlpack ({error}); give them in the memory of the \
         processor")
    })?;
    Ok(array.cast_into().map_err(PyErr::from)?)
}

/// Kinds of devices, by DLPack, with arrays in the memory of the processor: the processor itself,
/// and memory of CUDA and ROCm that it sees.
const READ_HERE: [i32; 4] = [1, 3, 11, 13];

/// Refuses an array on another device, which some libraries would copy without a word.
fn refuse_devices(given: &Any<'_>, what: &str) -> Result<()> {
    let name = intern!(given.py(), "__dlpack_device__");
    let Some(device) = given.getattr_opt(name)? else {
        return Ok(());
    };
    match device
        .call0()
        .and_then(|device| device.extract::<(i32, i32)>())
    {
        Ok((kind, number)) if !READ_HERE.contains(&kind) => Err(refused!(BadArray:
            "{what} are on another device (kind {kind} of DLPack, number {number}); pliant reads \
             the memory of the processor: copy them there, as {what}.cpu() does in torch")),
        _ => Ok(()),
    }
}

/// An array of the caller as numpy has it, without a copy where numpy needs none.
#[pyfunction(name = "_as_array")]
pub(crate) fn of_caller<'py>(given: &Any<'py>, what: &str) -> Result<Bound<'py, PyUntypedArray>> {
    refuse_masks(given, what)?;
    as_numpy(given, what)
}

/// Refuses a masked array that hides any number, and a list of such arrays.
///
/// A hidden number is in memory all the same, and would be read.
pub(crate) fn refuse_masks(given: &Any<'_>, what: &str) -> Result<()> {
    let py = given.py();
    let is_masked = |item: &Any<'_>| -> PyResult<bool> {
        // Masked arrays are arrays of another class than numpy's own.
        let of_another_class =
            |array: &Bound<'_, PyUntypedArray>| !array.is_exact_instance_of::<PyUntypedArray>();
        if !item.cast::<PyUntypedArray>().is_ok_and(of_another_class) {
            return Ok(false);
        }
        let masks = py.import("numpy.ma")?;
        masks.call_method1("is_masked", (item,))?.extract()
    };
    let found = if let Ok(list) = given.cast::<PyList>() {
        any(list.iter(), is_masked)?
    } else if let Ok(tuple) = given.cast::<PyTuple>() {
        any(tuple.iter(), is_masked)?
    } else {
        is_masked(given)?
    };
    if !found {
        return Ok(());
    }
    Err(refused!(BadArray:
        "{what} are masked in places, and what is masked is no number; give an array without a \
         mask: {what}.filled(...), or only what is not masked"))
}

/// Copies rows of K numbers, as somebody gives them; refuses what is no array (k, K) of uint32.
pub(crate) fn rows_of<const K: usize>(
    given: &Any<'_>,
    name: &str,
    whose: &str,
) -> Result<Vec<[u32; K]>> {
    refuse_masks(given, name)?;
    // Numpy copies, whatever strides and alignment are; then nobody else writes to it.
    let copied = || {
        let array = given.cast::<PyArray2<u32>>().ok()?;
        let copy = array.call_method1("copy", ("C",)).ok()?;
        let copy: PyReadonlyArray2<'_, u32> = copy.extract().ok()?;
        let has_width = copy.shape()[1] == K;
        let rows = copy.as_slice().ok()?.as_chunks::<K>().0.to_vec();
        has_width.then_some(rows)
    };
    copied().ok_or_else(|| {
        let have = match given.getattr("shape").and_then(|shape| shape.str()) {
            Ok(shape) => format!("an array of shape {shape}"),
            Err(_) => given.get_type().to_string(),
        };
        refused!(BadArray: "{name} are {have}; they must be (k, {K}) uint32, as {whose} them")
    })
}

fn any<'py>(
    mut items: impl Iterator<Item = Bound<'py, PyAny>>,
    is: impl Fn(&Any<'py>) -> PyResult<bool>,
) -> PyResult<bool> {
    items.try_fold(false, |found, item| Ok(found || is(&item)?))
}

/// The array itself, in whatever layout; one of another byte order is copied.
fn typed<'py, T: Element>(array: &Bound<'py, PyUntypedArray>) -> Result<Bound<'py, PyArray2<T>>> {
    if let Ok(array) = array.cast::<PyArray2<T>>() {
        return Ok(array.clone());
    }
    let numpy = array.py().import("numpy")?;
    let required = numpy.call_method1("require", (array, dtype::<T>(array.py())))?;
    Ok(required.cast_into().map_err(PyErr::from)?)
}

/// Converts integers of another type to uint32.
///
/// The first that cannot be a vertex is refused, as the library refuses one out of range.
fn convert<T: Element + Copy + Into<i128>>(
    array: &Bound<'_, PyUntypedArray>,
    vertices: usize,
) -> Result<Vec<[u32; 3]>> {
    let copied = copies::anew(&typed::<T>(array)?)?;
    let rows = copied.rows()?;
    let mut triangles = Vec::with_capacity(rows.len());
    for (triangle, corners) in rows.iter().enumerate() {
        let mut converted = [0; 3];
        for (corner, &vertex) in converted.iter_mut().zip(corners) {
            *corner = u32::try_from(vertex.into()).map_err(|_| {
                let vertex: i128 = vertex.into();
                let refused = refused!(VertexOutOfRange:
                    "triangle {triangle} names vertex {vertex}, but there are {vertices} vertices \
                     (counted from 0)");
                refused
                    .with("triangle", triangle)
                    .with("vertex", vertex)
                    .with("vertices", vertices)
            })?;
        }
        triangles.push(converted);
    }
    Ok(triangles)
}
