//! `pliant.check`: files checked frame by frame, as an iterator of frames.
//!
//! The loop is `pliant_check`, as in the program. Frames hold what `pliant check --format json`
//! writes.

use crate::answers::{Any, Rows, counted, named};
use crate::error::{Refused, Result, after_checking, alone, alone_with, caught, refused};
use crate::options::{Threads, with_threads};
use crate::signals::interruptible;
use crate::usd::{self, Raised};
use numpy::{IntoPyArray, PyArray1};
use pliant_check::{
    Baseline, BodyFacts, BodyThere, Check as Running, Counts, Error, FirstImpact, Found, Frames,
    Group, Interval, Kinds, LabelFile, Life, Nested, Place, Rest, Settings, Split,
};
use pliant_io::{Files, OpenOptions, shown};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::{PyDict, PyRange, PyRangeMethods, PyTuple};
use std::collections::BTreeMap;
use std::ffi::CString;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// Check of files that is under way: an iterator of its frames, made by pliant.check.
///
/// Each Frame is read and checked when it is asked for. An exception that a signal handler raises
/// in the main thread, as after Ctrl-C, ends a search early. The same frame is then the next one.
/// Seams that part, or do not quite close, are a UserWarning after the last frame.
///
/// Going on raises pliant.Error: CannotRead, TooLarge, BadPosition, Busy.
#[pyclass(frozen, module = "pliant")]
pub(crate) struct Check {
    running: Mutex<Running>,
    /// A frame that was checked and not handed out, because its interval was interrupted.
    waiting: Mutex<Option<Checked>>,
    /// Bodies of the check, a tuple of Body: one for each path, piece or group, in order.
    #[pyo3(get)]
    bodies: Py<PyTuple>,
    /// Number of frames in the files, an int.
    #[pyo3(get)]
    frame_count: usize,
    is_warned: AtomicBool,
    raised: Raised,
    weld_tolerance: f64,
    /// Warning for the end, if nothing is found until then.
    unlike_sizes: Option<String>,
    has_found: AtomicBool,
    /// Whether a frame has the first pair alone.
    first: bool,
}

/// Name of a body or group, or the number of a body.
#[derive(FromPyObject, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Name {
    Number(usize),
    Path(PathBuf),
}

/// A body that has another mesh now.
struct Changed {
    body: BodyFacts,
    faces: Option<Vec<u32>>,
    welded: usize,
}

/// A frame, and the bodies that have another mesh in it.
type Checked = (Found, Vec<(u32, Changed)>);

impl Changed {
    fn of(check: &Running, number: u32) -> Option<Self> {
        let body = check.body(number)?;
        let source = &check.sources()[body.source];
        Some(Self {
            faces: source.faces().map(<[u32]>::to_vec),
            welded: source.welded(),
            body,
        })
    }
}

/// Baseline, whose pairs are left out, or rest shape: a frame or a file.
#[derive(FromPyObject)]
pub(crate) enum Known {
    Frame(i64),
    File(PathBuf),
}

impl Known {
    fn baseline(self) -> Result<Baseline> {
        match self {
            Self::Frame(frame) => from_zero("baseline", frame).map(Baseline::Frame),
            Self::File(file) => Ok(Baseline::File(file)),
        }
    }

    fn rest(self) -> Result<Rest> {
        match self {
            Self::Frame(frame) => from_zero("rest", frame).map(Rest::Frame),
            Self::File(file) => Ok(Rest::File(file)),
        }
    }
}

impl Name {
    fn into_text(self) -> Result<String> {
        match self {
            Self::Number(number) => Ok(number.to_string()),
            Self::Path(path) => path.into_os_string().into_string().map_err(|name| {
                let name = shown(&name);
                refused!(CannotRead: "{name}: the name is not UTF-8; rename the file")
            }),
        }
    }
}

/// Checks files frame by frame, as the program `pliant check` does: an iterator of Frame.
///
///     for frame in pliant.check("cloth_*.obj", "body.npz", itself=True):
///         print(frame.frame, frame.count, frame.pairs)
///
/// Each path is a body, or several:
///
/// - a mesh: .obj, .ply, .stl
/// - a sequence: .npz, or a pattern such as "cloth_*.obj" whose files are its frames
/// - a mesh with its positions: "mesh.obj+walk.pc2", .mdd or .npy
/// - glTF (.glb, .gltf, .vrm): each body of the file, or one, "scene.glb#arm"
/// - a group of an OBJ file, or a solid of an STL file, also of a pattern: "scan.obj#arm"
/// - USD (.usd, .usda, .usdc, .usdz), with pip install 'pliant[usd]': each mesh that is seen, or
///   those at or below a prim, "walk.usdc#/scene/shirt"
///
/// Returns a Check. Who is asked about:
///
/// - itself: also each body with itself; a body alone always is
/// - split: "components" makes each connected piece of a file a body, "cloth.ply#1", "cloth.ply#2",
///   ... by lowest triangle. "groups" makes each group (o, g) of an OBJ file or solid of an STL
///   file one, "scan.obj#arm". Triangles keep their numbers in the file, and those that share a
///   vertex of it are left out
/// - groups: names for several bodies, {"soft": ["shirt.ply", 2]}, for ignore. A body is named by
///   its path or its number. "scene.glb" stands for all its bodies, "scan.obj#arm" also for
///   "scan.obj#arm/hand"
/// - ignore: pairs of bodies or groups that do not meet, [("soft", "hair.ply")]. One name twice
///   means that none of its bodies meets another or itself
///
/// What is found:
///
/// - within: a distance of at least 0, in the unit of the files. Finds pairs of triangles of
///   different bodies at most that far apart; Frame.distance is the least. Not with crossing or
///   swept; one body alone, and itself, need rest or labels
/// - rest: a frame number, or a file with the mesh of the one body. With within, pairs of one file
///   are left out that are as close in this rest shape
/// - labels: files of labels by body, {"walk.npz": "parts.npy"}. Triangles of a body are left out
///   whose labels are equal, or have a vertex in common. A file is an array of integers, one for
///   each triangle or each polygon; a negative one leaves nothing out. Not with crossing or swept
/// - crossing: leaves out places where surfaces only touch, as along a cut. No triangles cross
///   there, and no surface passes through another, not even exactly at edges and vertices. Where
///   sides are unclear a place stays. Frame.only_touching counts the pairs. Not with within
/// - ignore_adjacent: leaves out triangles of one body that share a vertex and meet beyond it. They
///   go through each other elsewhere, are folded onto each other, or are one triangle twice.
///   Frame.adjacent counts them apart
/// - swept: also what meets on straight lines from each frame to the next: Frame.interval. A frame
///   comes when the next has been read. Not with within or baseline
/// - first: stops at the first pair of each frame, and of each interval
/// - baseline: a frame number, or a file that `pliant check --format json` wrote. Pairs that
///   intersect there are left out everywhere
/// - skip_degenerate: leaves out pairs with a triangle that has no area
/// - crossing_edges: also counts the edges that cross triangles: Frame.crossing_edges. Only ignore
///   leaves any out. Not with within or first
/// - places: joins the pairs of a frame into places with numbers that last: Frame.places,
///   Check.places. Not with first
/// - solid: takes closed bodies for solids: Place.depth. What lies inside a body, which no pair
///   tells, is said in any case: Frame.inside, Frame.not_closed
///
/// How files are read:
///
/// - weld: joins vertices where boundary edges coincide, in each frame; else seams are
///   intersections
/// - weld_tolerance: also joins boundary edges that are apart by at most this fraction of the
///   diagonal of their body
/// - frames: a range, such as range(100, 200); others are passed over, and not read where the
///   format allows it
/// - clip: name of the glTF animation; None is the first
/// - fps: frames a second at which glTF animations are evaluated
/// - files: bytes of files by name, {"scan.obj": bytes}; paths then name these and no others. USD
///   is not read so
/// - max_memory: limit of a frame that is read, and of a list of pairs, in bytes. None is 4 GiB for
///   a frame, and no limit of lists
/// - warn: gives remarks about files and bodies, as UserWarning
/// - threads: how many share the work of a frame, at most, or "all" for one a core; no number
///   changes an answer
///
/// Raises pliant.Error: CannotRead, BadOption, TooLarge, BadPosition. What is odd but no error,
/// such as numbered files that are given one by one, is a UserWarning.
#[pyfunction]
#[pyo3(
    signature = (
        *paths, itself=false, within=None, rest=None, labels=None, crossing=false,
        ignore_adjacent=false, swept=false, first=false, weld=true, weld_tolerance=0.0,
        split=None, groups=None, ignore=None, baseline=None, skip_degenerate=false,
        crossing_edges=false, places=false, solid=false, frames=None, clip=None, fps=30.0,
        files=None, max_memory=None, warn=true, threads=Threads::Count(1)
    ),
    text_signature = "(*paths, itself=False, within=None, rest=None, labels=None, crossing=False, \
        ignore_adjacent=False, swept=False, first=False, weld=True, weld_tolerance=0.0, \
        split=None, groups=None, ignore=None, baseline=None, skip_degenerate=False, \
        crossing_edges=False, places=False, solid=False, frames=None, clip=None, fps=30.0, \
        files=None, max_memory=None, warn=True, threads=1)"
)]
#[expect(
    clippy::too_many_arguments,
    clippy::fn_params_excessive_bools,
    reason = "each is a keyword with a default"
)]
pub(crate) fn check(
    py: Python<'_>,
    paths: Vec<PathBuf>,
    itself: bool,
    within: Option<f64>,
    rest: Option<Known>,
    labels: Option<BTreeMap<Name, PathBuf>>,
    crossing: bool,
    ignore_adjacent: bool,
    swept: bool,
    first: bool,
    weld: bool,
    weld_tolerance: f64,
    split: Option<&str>,
    groups: Option<BTreeMap<String, Vec<Name>>>,
    ignore: Option<Vec<(Name, Name)>>,
    baseline: Option<Known>,
    skip_degenerate: bool,
    crossing_edges: bool,
    places: bool,
    solid: bool,
    frames: Option<&Bound<'_, PyRange>>,
    clip: Option<String>,
    fps: f64,
    files: Option<BTreeMap<String, PyBackedBytes>>,
    max_memory: Option<u64>,
    warn: bool,
    threads: Threads,
) -> Result<Check> {
    let group = |(name, bodies): (String, Vec<Name>)| {
        let bodies = bodies.into_iter().map(Name::into_text);
        let bodies = bodies.collect::<Result<_>>()?;
        Ok(Group { name, bodies })
    };
    let two = |(a, b): (Name, Name)| Ok([a.into_text()?, b.into_text()?]);
    let of_body = |(body, file): (Name, PathBuf)| {
        let body = body.into_text()?;
        Ok(LabelFile { body, file })
    };
    let settings = Settings {
        itself,
        within,
        rest: rest.map(Known::rest).transpose()?,
        labels: (labels.into_iter().flatten().map(of_body)).collect::<Result<_>>()?,
        crossing,
        ignore_adjacent,
        swept,
        first,
        split: split.map(split_named).transpose()?,
        groups: (groups.into_iter().flatten().map(group)).collect::<Result<_>>()?,
        ignore: (ignore.into_iter().flatten().map(two)).collect::<Result<_>>()?,
        baseline: baseline.map(Known::baseline).transpose()?,
        skip_degenerate,
        crossing_edges,
        places,
        inside: true,
        solid,
        frames: frames.map(range_of_frames).transpose()?,
        options: with_threads(threads)?,
        max_list: max_memory.unwrap_or(u64::MAX),
        ..Settings::default()
    };
    let say = |text: &str| if warn { remark(py, text) } else { Ok(()) };
    let paths = paths.into_iter().map(|path| Name::Path(path).into_text());
    let paths = paths.collect::<Result<Vec<_>>>()?;
    if let Some(pattern) = pliant_io::looks_like_a_series(&paths) {
        let text = format!(
            "{} paths are {0} bodies; if they are frames of one body, give the pattern: \"{}\"",
            paths.len(),
            shown(&pattern)
        );
        say(&text)?;
    }
    if weld_tolerance != 0.0 && !weld {
        return Err(refused!(BadOption:
            "weld_tolerance joins more than weld does, and weld is False; give one of them"));
    }
    let default = OpenOptions::default();
    let is_on_disk = files.is_none();
    let reading = OpenOptions {
        weld,
        weld_tolerance,
        clip,
        fps,
        max_memory: max_memory.unwrap_or(default.max_memory),
        files: files.map(in_memory).transpose()?.unwrap_or_default(),
    };
    let raised = Raised::default();
    let open = |path: &String| {
        if is_on_disk && usd::is_usd(path) {
            usd::open(path, &reading, &raised)
        } else {
            pliant_io::open_all(path, &reading)
        }
    };
    let begin = || Ok(Running::open_each(&paths, &reading, &settings, open)?);
    let running = raised.rather(py.detach(|| caught(begin)))?;
    let unlike_sizes = running.unlike_sizes().map(|[(large, most), (small, least)]| {
        format!(
            "nothing was found, and the longest side of {} is {most:.3e}, that of {} {least:.3e}: \
             are they of one unit?",
            shown(large),
            shown(small)
        )
    });
    for source in running.sources() {
        for note in source.notes() {
            say(&format!("{}: {note}", shown(source.name())))?;
        }
    }
    if running.lacks_adjacent() {
        let text = "the baseline has no pairs that share a vertex, so all of these count as new; \
                    write it again, or leave them out with ignore_adjacent=True";
        say(text)?;
    }
    Ok(Check {
        bodies: facts(py, &running)?.unbind(),
        frame_count: running.frame_count(),
        is_warned: AtomicBool::new(!warn),
        running: Mutex::new(running),
        waiting: Mutex::new(None),
        raised,
        weld_tolerance,
        unlike_sizes,
        has_found: AtomicBool::new(false),
        first,
    })
}

#[pymethods]
impl Check {
    fn __iter__(this: PyRef<'_, Self>) -> PyRef<'_, Self> {
        this
    }

    fn __next__<'py>(&self, py: Python<'py>) -> Result<Option<Any<'py>>> {
        let next = |running: &mut Running| {
            let mut waiting = alone(&self.waiting)?;
            if waiting.is_none() {
                let found = interruptible(|question| running.next_frame_unless(Some(question)))?;
                *waiting = found.map(|found| {
                    let changed = found.changed.iter();
                    let mesh = |&body: &u32| Some((body, Changed::of(running, body)?));
                    let meshes = changed.filter_map(mesh).collect();
                    (found, meshes)
                });
            }
            if waiting.is_none() {
                return Ok(None);
            }
            let interval = interruptible(|question| running.next_interval_unless(Some(question)))?;
            Ok(waiting.take().map(|checked| (checked, interval)))
        };
        let found = alone_with(py, &self.running, next);
        let Some(found) = self.raised.rather(found)? else {
            self.warn_of_seams(py)?;
            return Ok(None);
        };
        let ((found, meshes), interval) = found;
        let has_met = interval.as_ref().is_some_and(|interval| interval.count > 0);
        if found.count_of_all() > 0 || has_met {
            self.has_found.store(true, Ordering::Relaxed);
        }
        let changed = PyDict::new(py);
        for (number, of) in meshes {
            let faces = of.faces.map(|faces| faces.into_pyarray(py));
            changed.set_item(number, fact(py, of.body, faces.as_ref(), of.welded)?)?;
        }
        let kinds_of = |kinds: Kinds| named!(py, "Kinds" of kinds: crossing, overlapping, touching);
        let kinds = found.kinds.map(kinds_of);
        let adjacent = found.adjacent.map(|it| -> PyResult<_> {
            named!(py, "Adjacent":
                count = it.count, pairs = Rows(it.pairs), kinds = kinds_of(it.kinds)?,
                twice = it.twice, left_out = it.left_out, only_touching = it.only_touching,
                degenerate = it.degenerate)
        });
        let crossing_edges = found.crossing_edges.map(|all| {
            let counts = all.iter().map(
                |it| named!(py, "CrossingEdges" of it: edge_body, triangle_body, edges, pairs),
            );
            tuple(py, counts)
        });
        let (inside, not_closed) = match found.inside {
            Some(inside) => {
                let row = |it: &Nested| (it.body, it.component, it.inside);
                let rows: Vec<_> = inside.all.iter().map(row).collect();
                (rows, inside.open)
            }
            None => Default::default(),
        };
        let places = found.places;
        let places = places.map(|places| tuple(py, places.iter().map(|it| place(py, it))));
        let interval = interval.map(|interval| way(py, interval));
        Ok(Some(named!(py, "Frame":
            frame = found.frame, count = found.count, distance = found.distance,
            kinds = kinds.transpose()?, complete = found.complete, left_out = found.left_out,
            only_touching = found.only_touching, degenerate = found.degenerate,
            changed = changed, pairs = Rows(found.pairs), adjacent = adjacent.transpose()?,
            crossing_edges = crossing_edges.transpose()?,
            places = places.transpose()?,
            inside = PyTuple::new(py, inside)?, not_closed = PyTuple::new(py, not_closed)?,
            interval = interval.transpose()?)?))
    }

    /// Checks the frames that are left and counts what they have, in a Counts; lists no pairs.
    ///
    ///     pliant.check("cloth_*.obj", "body.npz").counts().pairs
    ///
    /// Edges are counted with crossing_edges=True. Intervals of swept are not counted. After an
    /// exception, as after Ctrl-C, the frames counted before are lost. Raises as going on does.
    fn counts<'py>(&self, py: Python<'py>) -> Result<Any<'py>> {
        let count = |running: &mut Running| {
            let mut counts = Counts::default();
            if let Some((found, _)) = alone(&self.waiting)?.take() {
                counts.add(&found);
            }
            running.ask(self.first, false);
            let next = |running: &mut Running| {
                interruptible(|question| running.next_frame_unless(Some(question)))
            };
            let end = loop {
                match next(running) {
                    Ok(Some(found)) => counts.add(&found),
                    end => break end,
                }
            };
            // Who goes on after an interruption has lists again.
            running.ask(self.first, true);
            end.map(|_| counts)
        };
        let counts = alone_with(py, &self.running, count);
        let counts = self.raised.rather(counts)?;
        if counts.pairs > 0 || counts.adjacent > Some(0) {
            self.has_found.store(true, Ordering::Relaxed);
        }
        self.warn_of_seams(py)?;
        Ok(named!(py, "Counts" of counts:
            frames, pairs, crossing_edges, adjacent, touching, degenerate, inside)?)
    }

    /// Places of the frames so far, at most 1000 Life, most pairs in a frame first.
    #[getter]
    fn places<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyTuple>> {
        let (_, lives) = alone_with(py, &self.running, |running| Ok(running.places()))?;
        Ok(tuple(py, lives.iter().map(|it| life(py, it)))?)
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let bodies = counted(self.bodies.bind(py).len(), ["body", "bodies"]);
        let frames = counted(self.frame_count, ["frame", "frames"]);
        format!("<pliant.Check of {bodies}, {frames}>")
    }
}

fn in_memory(files: BTreeMap<String, PyBackedBytes>) -> Result<Files> {
    let file = |(name, bytes): (_, PyBackedBytes)| (name, bytes.to_vec());
    Ok(Files::in_memory(files.into_iter().map(file))?)
}

/// Gives a warning: a message that is no error.
fn remark(py: Python<'_>, text: &str) -> PyResult<()> {
    let text = CString::new(text).unwrap_or_default();
    PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)
}

impl Check {
    /// Warns once, after the last frame, of seams that part and pairs at seams not quite closed.
    fn warn_of_seams(&self, py: Python<'_>) -> Result<()> {
        if self.is_warned.swap(true, Ordering::Relaxed) {
            return Ok(());
        }
        let said = alone_with(py, &self.running, |running| {
            let sources = running.sources().iter().enumerate();
            let parted = sources.clone().filter_map(|(number, source)| {
                let parted = running.parted(number)?;
                let advice = match parted.tolerance() {
                    better if better > self.weld_tolerance => {
                        format!("; weld_tolerance={better:e} keeps together what parts by rounding")
                    }
                    _ => String::new(),
                };
                Some(format!("{}: {parted}{advice}", shown(source.name())))
            });
            let at_seams = sources.filter_map(|(number, source)| {
                let at_seams = running.at_seams(number)?;
                Some(format!(
                    "{}: {} of its {} pairs with itself in frame {} lie where boundary edges \
                     nearly coincide, up to {:.1e} of its size apart; if those are seams, \
                     weld_tolerance={:e} joins them",
                    shown(source.name()),
                    at_seams.pairs,
                    at_seams.of,
                    at_seams.frame,
                    at_seams.farthest,
                    at_seams.tolerance()
                ))
            });
            let sizes = self.unlike_sizes.clone();
            let sizes = sizes.filter(|_| !self.has_found.load(Ordering::Relaxed));
            Ok(at_seams.chain(parted).chain(sizes).collect::<Vec<_>>())
        })?;
        for text in said {
            remark(py, &text)?;
        }
        Ok(())
    }
}

fn split_named(name: &str) -> Result<Split> {
    match name {
        "components" => Ok(Split::Components),
        "groups" => Ok(Split::Groups),
        other => Err(refused!(BadOption:
            "split is {other:?}; it can be \"components\", \"groups\" or None")),
    }
}

fn from_zero(what: &str, frame: i64) -> Result<usize> {
    usize::try_from(frame)
        .map_err(|_| refused!(BadOption: "{what} is {frame}; frames are counted from 0"))
}

/// Frames of a range of Python.
fn range_of_frames(frames: &Bound<'_, PyRange>) -> Result<Frames> {
    let count = frames.len()?;
    let from_zero = [frames.start()?, frames.step()?].map(usize::try_from);
    let [Ok(start), Ok(step)] = from_zero else {
        return Err(refused!(BadOption:
            "{frames:?}: frames are counted from 0 and checked in order; give a range that rises"));
    };
    Ok(Frames { start, step, count })
}

/// Facts about the bodies before the first frame is checked.
fn facts<'py>(py: Python<'py>, check: &Running) -> PyResult<Bound<'py, PyTuple>> {
    let faces = check.sources().iter().map(|source| {
        let faces = source.faces();
        faces.map(|faces| faces.to_vec().into_pyarray(py))
    });
    let faces: Vec<_> = faces.collect();
    let facts = check.bodies().map(|body| {
        let welded = check.sources()[body.source].welded();
        let faces = faces[body.source].as_ref();
        fact(py, body, faces, welded)
    });
    tuple(py, facts)
}

/// Tuple of objects that are made one by one.
fn tuple<'py>(
    py: Python<'py>,
    made: impl Iterator<Item = PyResult<Any<'py>>>,
) -> PyResult<Bound<'py, PyTuple>> {
    PyTuple::new(py, made.collect::<PyResult<Vec<_>>>()?)
}

/// Facts about one body, a `Body` of Python.
fn fact<'py>(
    py: Python<'py>,
    body: BodyFacts,
    faces: Option<&Bound<'py, PyArray1<u32>>>,
    welded: usize,
) -> PyResult<Any<'py>> {
    named!(py, "Body":
        name = body.name, vertices = body.vertices, triangles = body.triangles, faces = faces,
        welded = welded, source = body.source, first_triangle = body.first_triangle)
}

/// Impacts on the way from a frame to the next, an `Interval` of Python.
fn way(py: Python<'_>, interval: Interval) -> PyResult<Any<'_>> {
    let first = interval.first.map(|first| {
        let (kind, pair) = match &first {
            FirstImpact::VertexTriangle(impact) => ("vertex_triangle", &impact.pair[..]),
            FirstImpact::EdgeEdge(impact) => ("edge_edge", &impact.pair[..]),
        };
        let pair = PyTuple::new(py, pair)?;
        named!(py, "FirstImpact": time = first.time(), kind = kind, pair = pair)
    });
    let vertices = interval.vertex_triangle.into_iter();
    let edges = interval.edge_edge.into_iter();
    let (vertices, of_vertices) = vertices.map(|it| (it.pair, [it.low, it.high])).unzip();
    let (edges, of_edges) = edges.map(|it| (it.pair, [it.low, it.high])).unzip();
    named!(py, "Interval":
        frame = interval.frame, until = interval.until,
        changed = PyTuple::new(py, interval.changed)?, count = interval.count,
        at_start = interval.at_start, first = first.transpose()?,
        vertex_triangle = Rows::<u32, 4>(vertices), vertex_triangle_times = Rows(of_vertices),
        edge_edge = Rows::<u32, 6>(edges), edge_edge_times = Rows(of_edges),
        complete = interval.complete)
}

/// A place of a frame.
fn place<'py>(py: Python<'py>, place: &Place) -> PyResult<Any<'py>> {
    let there = |it: &BodyThere| -> PyResult<_> {
        named!(py, "BodyThere" of it: body, triangles, first_triangle)
    };
    named!(py, "Place":
        number = place.number, count = place.count,
        first_pair = <(u32, u32, u32, u32)>::from(place.first_pair),
        bodies = tuple(py, place.bodies.iter().map(there))?,
        lower = <(f64, f64, f64)>::from(place.lower),
        upper = <(f64, f64, f64)>::from(place.upper), depth = place.depth)
}

/// A place, from its first frame to its last.
fn life<'py>(py: Python<'py>, life: &Life) -> PyResult<Any<'py>> {
    named!(py, "Life":
        first_frame = life.first_frame, last_frame = life.last_frame,
        worst_frame = life.worst_frame, worst = place(py, &life.worst)?)
}

impl From<Error> for Refused {
    fn from(error: Error) -> Self {
        let message = error.to_string();
        let advice = after_checking(&error);
        let refused = match error {
            Error::Read(error) => error.into(),
            Error::Refused {
                source_name,
                frame,
                error,
            } => Self::from(error)
                .about(match source_name.as_str() {
                    "" => format!("frame {frame}"),
                    name => format!("{}, frame {frame}", shown(name)),
                })
                .with("file", source_name)
                .with("frame", frame),
            Error::Missing {
                source_name, frame, ..
            }
            | Error::PiecesChanged {
                source_name, frame, ..
            } => Self::new("CannotRead", message)
                .with("file", source_name)
                .with("frame", frame),
            Error::FrameCounts { .. } | Error::AfterError { .. } => {
                Self::new("CannotRead", message)
            }
            Error::TooManyPairs { frame, most } | Error::Endless { frame, most } => {
                Self::new("TooLarge", message)
                    .with("what", "pairs")
                    .with("limit", most)
                    .with("frame", frame)
            }
            Error::OnePoint {
                source_name, count, ..
            } => Self::new("TooLarge", message)
                .with("file", source_name)
                .with("count", count),
            _ => Self::new("BadOption", message),
        };
        refused.advising(advice)
    }
}
