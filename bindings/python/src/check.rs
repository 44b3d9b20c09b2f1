//! Files, frame by frame: what `pliant check --format json` says, as an iterator of frames.
//!
//! Streamed like there: in memory are the frame being read and the world's. Frame counts are equal, or 1: such a body stands
//! still while others move.

use crate::arrays;
use crate::error::{Fact, Refused, alone_with, named_tuple};
use crate::options::with_threads;
use crate::state::{State, with_world};
use crate::world::row;
use numpy::IntoPyArray;
use pliant::BodyId;
use pliant_io::{Body, OpenOptions, Precision};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyRange, PyRangeMethods, PyTuple};
use std::ffi::{CString, OsString};
use std::path::PathBuf;
use std::sync::Mutex;

/// A check of files that is under way: an iterator of its frames, each read and checked when it is asked for.
#[pyclass(frozen, module = "pliant")]
pub(crate) struct Check {
    running: Mutex<Running>,
    /// One for each path: name, vertices, triangles, faces, welded.
    #[pyo3(get)]
    bodies: Py<PyTuple>,
    /// How many frames there are in the files.
    #[pyo3(get)]
    frame_count: usize,
}

/// Bodies being read, and the world that they are in.
struct Running {
    bodies: Vec<Body>,
    ids: Vec<BodyId>,
    state: State,
    /// The frame read next.
    next: usize,
    wanted: Wanted,
    itself: bool,
    first: bool,
}

/// Which frames are checked: from one on, each so many-th, so many.
#[derive(Clone, Copy)]
struct Wanted {
    start: usize,
    step: usize,
    left: usize,
}

/// The facts of one frame.
struct Frame {
    number: usize,
    pairs: Vec<[u32; 4]>,
    complete: bool,
}

/// Checks files as the program `pliant check` does: each path is a body, a mesh (.obj, .ply), a sequence (.npz), or a pattern
/// such as "cloth_*.obj" whose files are its frames. Returns an iterator of frames, each read and checked when it is asked
/// for.
///
///   itself    check each body against itself too; one body alone always is
///   first     stop at the first pair of each frame
///   weld      weld vertices where boundary edges coincide in frame 0; else seams are intersections
///   frames    a range: only these frames; those before are read, not checked
///   threads   how many share the work of a frame; no number changes an answer
#[pyfunction]
#[pyo3(signature = (*paths, itself=false, first=false, weld=true, frames=None, threads=1))]
pub(crate) fn check(
    py: Python<'_>,
    paths: Vec<PathBuf>,
    itself: bool,
    first: bool,
    weld: bool,
    frames: Option<&Bound<'_, PyRange>>,
    threads: i64,
) -> Result<Check, Refused> {
    let options = with_threads(threads)?;
    let paths = paths.into_iter().map(|path| {
        let odd = |path: OsString| {
            Refused::new(
                "CannotRead",
                format!("{}: the name is not UTF-8; rename the file", path.display()),
            )
        };
        path.into_os_string().into_string().map_err(odd)
    });
    let paths: Vec<_> = paths.collect::<Result<_, _>>()?;
    if let Some(pattern) = pliant_io::looks_like_a_series(&paths) {
        let text = format!(
            "{} paths are {0} bodies; if they are frames of one body, give the pattern: {pattern:?}",
            paths.len()
        );
        let text = CString::new(text).unwrap_or_default();
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
    }
    let reading = OpenOptions {
        weld,
        ..OpenOptions::default()
    };
    let bodies = py.detach(|| {
        let opened = paths.iter().map(|path| pliant_io::open(path, &reading));
        opened.collect::<Result<Vec<_>, _>>()
    })?;
    let frame_count = common_frame_count(&bodies)?;
    let wanted = Wanted::of(frames, frame_count)?;

    let facts = bodies.iter().map(|body| facts_of(py, body));
    let facts = PyTuple::new(py, facts.collect::<PyResult<Vec<_>>>()?)?;
    let precision = bodies.iter().map(Body::precision).max();
    let mut state = State::new(options);
    state.fix_precision(precision.unwrap_or(Precision::F64));
    Ok(Check {
        running: Mutex::new(Running {
            itself: itself || bodies.len() == 1,
            bodies,
            ids: Vec::new(),
            state,
            next: 0,
            wanted,
            first,
        }),
        bodies: facts.unbind(),
        frame_count,
    })
}

#[pymethods]
impl Check {
    fn __iter__(this: PyRef<'_, Self>) -> PyRef<'_, Self> {
        this
    }

    fn __next__<'py>(&self, py: Python<'py>) -> Result<Option<Bound<'py, PyAny>>, Refused> {
        let Some(frame) = alone_with(py, &self.running, Running::next_wanted)? else {
            return Ok(None);
        };
        let fields = PyDict::new(py);
        fields.set_item("frame", frame.number)?;
        fields.set_item("count", frame.pairs.len())?;
        fields.set_item("complete", frame.complete)?;
        fields.set_item("pairs", arrays::rows_of(py, frame.pairs)?)?;
        Ok(Some(named_tuple(py, "Frame", &fields)?))
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let bodies = self.bodies.bind(py).len();
        let bodies = format!("{bodies} {}", if bodies == 1 { "body" } else { "bodies" });
        let frames = self.frame_count;
        let frames = format!("{frames} {}", if frames == 1 { "frame" } else { "frames" });
        format!("<pliant.Check of {bodies}, {frames}>")
    }
}

impl Running {
    /// Reads up to the next frame wanted, and checks it.
    fn next_wanted(&mut self) -> Result<Option<Frame>, Refused> {
        if self.wanted.left == 0 {
            return Ok(None);
        }
        loop {
            let number = self.next;
            let wanted = number == self.wanted.start;
            self.read(number, wanted)?;
            self.next += 1;
            if wanted {
                self.wanted.start += self.wanted.step;
                self.wanted.left -= 1;
                return self.find_pairs(number).map(Some);
            }
        }
    }

    /// Reads a frame of every body that moves, and gives it to the world if it is wanted there. Frame 0 makes the bodies.
    fn read(&mut self, frame: usize, wanted: bool) -> Result<(), Refused> {
        for place in 0..self.bodies.len() {
            let body = &mut self.bodies[place];
            let makes = self.ids.len() == place;
            if !makes && body.frame_count() == 1 {
                continue;
            }
            let name = body.name().to_owned();
            let triangles = if makes {
                body.triangles().to_vec()
            } else {
                Vec::new()
            };
            let missing =
                || Refused::new("CannotRead", format!("{name}: frame {frame} is missing"));
            let positions = body.next_frame()?.ok_or_else(missing)?;
            let taken = if makes {
                self.state
                    .add(&triangles, positions)
                    .map(|id| self.ids.push(id))
            } else if wanted {
                self.state.set_positions(self.ids[place], positions)
            } else {
                Ok(())
            };
            taken.map_err(|refused| {
                refused
                    .about(format!("{name}, frame {frame}"))
                    .with("file", Fact::Text(name))
                    .with("frame", frame)
            })?;
        }
        Ok(())
    }

    /// (body, triangle, body, triangle), sorted; at most one of them if only the first is asked for.
    fn find_pairs(&mut self, number: usize) -> Result<Frame, Refused> {
        let mut pairs: Vec<[u32; 4]> = Vec::new();
        with_world!(&mut self.state.world, world => {
            if self.first {
                pairs.extend(world.first_intersection().map(row));
            } else {
                pairs.extend(world.intersection_pairs().iter().copied().map(row));
            }
            for &body in self.ids.iter().filter(|_| self.itself) {
                let of_body = |[a, b]: [u32; 2]| [body.0, a, body.0, b];
                if !self.first {
                    pairs.extend(world.self_intersection_pairs(body)?.iter().copied().map(of_body));
                } else if pairs.is_empty() {
                    pairs.extend(world.first_self_intersection(body)?.map(of_body));
                }
            }
        });
        pairs.sort_unstable();
        Ok(Frame {
            number,
            pairs,
            complete: !self.first,
        })
    }
}

impl Wanted {
    /// What a range of Python's says; all frames if there is none.
    fn of(frames: Option<&Bound<'_, PyRange>>, count: usize) -> Result<Self, Refused> {
        let Some(frames) = frames else {
            return Ok(Self {
                start: 0,
                step: 1,
                left: count,
            });
        };
        let left = frames.len()?;
        let bad = |why| Err(Refused::new("BadOption", format!("{frames:?}: {why}")));
        let from_zero = [frames.start()?, frames.step()?].map(usize::try_from);
        let [Ok(start), Ok(step)] = from_zero else {
            return bad(
                "frames are counted from 0 and checked in order; give a range that rises"
                    .to_owned(),
            );
        };
        if left > 0 && start + (left - 1) * step >= count {
            return bad(format!("the frames of these files are 0 to {}", count - 1));
        }
        Ok(Self { start, step, left })
    }
}

/// How many frames all bodies have that have more than one.
fn common_frame_count(bodies: &[Body]) -> Result<usize, Refused> {
    let Some(longest) = bodies.iter().max_by_key(|body| body.frame_count()) else {
        return Err(Refused::new(
            "BadOption",
            "no path was given; each is a body",
        ));
    };
    let frames = longest.frame_count();
    match bodies
        .iter()
        .find(|body| ![1, frames].contains(&body.frame_count()))
    {
        None => Ok(frames),
        Some(odd) => Err(Refused::new(
            "CannotRead",
            format!(
                "frame counts must be equal or 1: {} has {frames} frames, {} has {}",
                longest.name(),
                odd.name(),
                odd.frame_count()
            ),
        )),
    }
}

/// What is known of a body before its first frame is checked.
fn facts_of<'py>(py: Python<'py>, body: &Body) -> PyResult<Bound<'py, PyAny>> {
    let fields = PyDict::new(py);
    fields.set_item("name", body.name())?;
    fields.set_item("vertices", body.vertex_count())?;
    fields.set_item("triangles", body.triangles().len())?;
    fields.set_item(
        "faces",
        body.faces().map(|faces| faces.to_vec().into_pyarray(py)),
    )?;
    fields.set_item("welded", body.welded())?;
    named_tuple(py, "Body", &fields)
}
