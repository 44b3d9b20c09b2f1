//! Refusals as `pliant.Error`: facts of the Rust error as attributes, advice in words of Python.
//!
//! A message of the Rust libraries says what is wrong and where, and names no keyword. Functions
//! `after_...` append what to do in Python. The class is in `_types.py`: there it is a few lines,
//! and can be pickled.

use pliant::{BodyId, ErrorKind};
use pliant_io::{Place, Reason};
use pyo3::prelude::*;
use pyo3::types::IntoPyDict;
use std::fmt::{Debug, Display};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, MutexGuard, TryLockError};

/// Result of a call.
pub(crate) type Result<T, E = Refused> = std::result::Result<T, E>;

/// A call that was refused, or an exception of Python's on its way through.
#[derive(Debug)]
pub(crate) enum Refused {
    /// A `pliant.Error` to be.
    Error {
        kind: String,
        message: String,
        facts: Vec<(&'static str, Fact)>,
    },
    /// An exception of a visitor, a signal handler, or an object that was to be an array.
    Python(PyErr),
}

/// A fact about a refusal.
#[derive(Debug, IntoPyObject)]
pub(crate) enum Fact {
    Number(i128),
    Length(f64),
    Position((f64, f64, f64)),
    Ends((u32, u32)),
    Edges(Vec<(u32, u32)>),
    Text(String),
}

/// Conversions to a fact of each sort.
macro_rules! facts {
    ($($type:ty, $value:ident => $fact:expr;)*) => {
        $(impl From<$type> for Fact {
            fn from($value: $type) -> Self {
                $fact
            }
        })*
    };
}

facts! {
    i128, number => Self::Number(number);
    usize, number => Self::Number(number as i128);
    u32, number => Self::Number(number.into());
    BodyId, body => Self::Number(body.0.into());
    f64, length => Self::Length(length);
    [f64; 3], position => Self::Position(position.into());
    [u32; 2], ends => Self::Ends(ends.into());
    Vec<[u32; 2]>, edges => Self::Edges(edges.into_iter().map(<(u32, u32)>::from).collect());
    String, text => Self::Text(text);
    &str, text => Self::Text(text.to_owned());
}

impl Refused {
    /// A refusal by these bindings; `pliant.Error` describes each `kind`.
    pub(crate) fn new(kind: &str, message: impl Into<String>) -> Self {
        Self::Error {
            kind: kind.to_owned(),
            message: message.into(),
            facts: Vec::new(),
        }
    }

    /// Adds a fact.
    pub(crate) fn with(mut self, name: &'static str, fact: impl Into<Fact>) -> Self {
        if let Self::Error { facts, .. } = &mut self {
            facts.push((name, fact.into()));
        }
        self
    }

    /// Puts a subject before the message.
    pub(crate) fn about(mut self, what: impl Display) -> Self {
        if let Self::Error { message, .. } = &mut self {
            *message = format!("{what}: {message}");
        }
        self
    }

    /// Appends advice, where there is some.
    pub(crate) fn advising(mut self, advice: Option<&str>) -> Self {
        if let (Self::Error { message, .. }, Some(advice)) = (&mut self, advice) {
            message.push_str("; ");
            message.push_str(advice);
        }
        self
    }

    /// Names the argument that a refused distance was given as.
    pub(crate) fn distance_is(self, argument: &str) -> Self {
        match &self {
            Self::Error { kind, .. } if kind == "BadDistance" => {
                let advice = format!("this is the argument {argument}");
                self.advising(Some(&advice))
            }
            _ => self,
        }
    }

    /// Names the body that an array was given for, or a new one.
    pub(crate) fn of_body(self, body: Option<BodyId>) -> Self {
        match body {
            Some(body) => self.about(body).with("body", body),
            None => self.about("new body"),
        }
    }
}

/// A refusal with a formatted message.
macro_rules! refused {
    ($kind:ident: $($message:tt)*) => {
        $crate::error::Refused::new(stringify!($kind), format!($($message)*))
    };
}
pub(crate) use refused;

/// Name of a variant, which `Debug` prints first.
fn variant(value: &impl Debug) -> String {
    let text = format!("{value:?}");
    let end = text.find(|c: char| !c.is_alphanumeric());
    text[..end.unwrap_or(text.len())].to_owned()
}

/// Adds the facts of some kinds of error. Kind and body are all there is to say of the others.
macro_rules! with_facts {
    ($refused:ident, $error:expr; $($kind:ident { $($fact:ident),* })*) => {
        match $error {
            $(ErrorKind::$kind { $($fact),* } => {
                $refused$(.with(stringify!($fact), $fact))*
            })*
            _ => $refused,
        }
    };
}

impl From<pliant::Error> for Refused {
    fn from(error: pliant::Error) -> Self {
        let mut refused = Self::new(&variant(&error.kind), error.to_string())
            .advising(after_calling(&error.kind));
        if let Some(body) = error.body {
            refused = refused.with("body", body);
        }
        if let ErrorKind::NotClosed { edges, count } = error.kind {
            // Of another kind edges are a number.
            return refused.with("some_edges", edges).with("count", count);
        }
        with_facts! { refused, error.kind;
            TooLarge { what, count, limit }
            VertexOutOfRange { triangle, vertex, vertices }
            WrongLength { what, expected, found }
            BadPosition { vertex, position }
            OutsideLooseBox { vertex, position }
            NeedsSubnormals { vertex }
            NotWritten { vertex }
            TooManyHits { limit }
            BadThickness { vertex, thickness }
            NoSuchHit { hit }
            NoSuchTriangle { triangle, triangles }
            EmptyTriangle { triangle }
            NoSuchVertex { vertex, vertices }
            NoSuchEdge { edge, edges }
            MissingEdge { ends }
            NotAnEdge { edge, ends }
            EmptyVertex { vertex }
            VertexInUse { vertex }
            NotACorner { triangle, vertex }
            BadPoint { point, position }
        }
    }
}

/// Advice about a call that the library refused.
pub(crate) fn after_calling(kind: &ErrorKind) -> Option<&'static str> {
    Some(match kind {
        ErrorKind::VertexOutOfRange {
            vertex, vertices, ..
        } if *vertex as usize == *vertices => "if the faces are counted from 1, give faces - 1",
        ErrorKind::OutsideLooseBox { .. } => "World.set_loose_box does either",
        ErrorKind::SameBody => "for that, give Selection.within(body) where a selection is taken",
        ErrorKind::TooManyHits { .. } => "this is at_most=, and visit_some(...) makes no list",
        ErrorKind::BadMargin { .. } => "this is the argument radius",
        ErrorKind::DifferentCounts { .. } => "start and end have one row for each pair",
        ErrorKind::EmptyTriangle { .. } => "Edit.set_triangle does that",
        ErrorKind::EmptyVertex { .. } => "Edit.place_vertex does that",
        ErrorKind::VertexInUse { .. } => "World.set_positions does that",
        ErrorKind::OutdatedEdit => "World.edit begins one",
        _ => return None,
    })
}

/// Advice about a file that `pliant.check` cannot read.
fn after_reading(error: &pliant_io::Error) -> Option<&'static str> {
    match error.reason() {
        Reason::NotFound if matches!(error.place(), Place::Part(..)) => {
            Some("the glTF file keeps data there: copy it along, to where that file is")
        }
        Reason::NotFound => {
            Some("it is taken from the current folder, os.getcwd(), or is a key of files=")
        }
        Reason::NoMatch => {
            Some("it is taken from the current folder, os.getcwd(), or is of keys of files=")
        }
        Reason::Pattern(_) => Some("in a pattern, write [[] for the [ of a name"),
        Reason::Io(_) => Some("see that you may read it and that its disk is there"),
        Reason::Malformed(_)
        | Reason::FewCorners { .. }
        | Reason::RepeatedCorners { .. }
        | Reason::VertexIndex { .. }
        | Reason::Coordinate { .. }
        | Reason::NoVertices
        | Reason::NoFaces
        | Reason::NoFrames => Some("mend it, or export it again"),
        Reason::Truncated(_) | Reason::Checksum { .. } => Some("copy it or export it again"),
        // Python has no say in how much memory a frame may take.
        Reason::TooMany { .. } | Reason::TooLarge { .. } => Some("split the mesh"),
        Reason::OutOfMemory => Some("split the mesh, or free some memory"),
        Reason::FacesDiffer { .. } | Reason::FaceCount { .. } | Reason::VertexCount { .. } => {
            Some("export all of them from one mesh")
        }
        Reason::NoBody { .. } => Some("choose one of these"),
        Reason::AfterError => Some("begin another pliant.check"),
        Reason::SeamsTooLarge { .. } => Some("split the mesh, or give weld=False"),
        Reason::SeamsTooDense | Reason::BadTolerance { .. } => Some("give another weld_tolerance="),
        Reason::BadRate { .. } => Some("give another fps="),
        Reason::ClipTooLong { .. } => Some("ask for fewer with fps="),
        Reason::MeshMoves { .. } => Some("write one frame of it to a file, and name that"),
        Reason::NoClip { .. } => Some("choose one of these with clip="),
        _ => None,
    }
}

/// Advice about a check that cannot begin or go on.
pub(crate) fn after_checking(error: &pliant_check::Error) -> Option<&'static str> {
    use pliant_check::Error;
    match error {
        Error::NoSources => Some("name files, as in pliant.check(\"cloth_*.obj\")"),
        Error::FrameCounts { .. } => {
            Some("export the same frames of each, or one frame of what stands still")
        }
        Error::Missing { .. } => Some("wait until it is written to its end, or export it again"),
        Error::NoSuchFrame { .. } | Error::NoSuchName { .. } => Some("choose one of these"),
        Error::AfterError { .. } => Some("begin another pliant.check"),
        Error::BadBaseline { .. } => Some(
            "name a file that `pliant check --format json` wrote of these bodies, without \
                 `--count` and `--first`",
        ),
        Error::PiecesChanged { by_name: true, .. } => {
            Some("name the whole file, without the # and what follows it")
        }
        Error::PiecesChanged { .. } => Some("check it as a whole, without split="),
        Error::NoGroups { .. } => Some("give split=\"components\" for its connected pieces"),
        Error::PiecesOfGroup { .. } => Some("name the whole file"),
        Error::NamedTwice { .. } => Some("leave out one of the two"),
        Error::NoClip => Some("leave out clip="),
        Error::EmptyGroup { .. } => Some("give each group a list of its bodies"),
        Error::Distance(_) => Some("give within= in the unit of the files"),
        Error::WithinItself => {
            Some("name two bodies or more and leave out itself=, or give rest= or labels=")
        }
        Error::BadLabels { .. } => {
            Some("save an integer for each triangle of the first frame, or each polygon")
        }
        Error::LabelsWith { .. } => Some("run two checks, one of them without labels="),
        Error::RestAlone => Some("give within="),
        Error::BadRest { .. } => {
            Some("name a frame, or a file with the mesh of the one body that is checked")
        }
        Error::RestChanged { .. } | Error::LabelsChanged { .. } => {
            Some("check the frames before it alone, with frames=")
        }
        Error::CrossingWithin => Some("run two checks, one with within= and one with crossing="),
        Error::SweptWithin => Some("run two checks, one with within= and one with swept="),
        Error::SweptOneFrame { .. } => {
            Some("name a sequence, choose more of it with frames=, or leave out swept=")
        }
        Error::SweptBaseline => Some("run two checks, one with baseline= and one with swept="),
        Error::TooManyPairs { .. }
        | Error::Endless { .. }
        | Error::TooManyImpacts { .. }
        | Error::EndlessImpacts { .. } => {
            Some("ask for one pair of each frame with first=True, without crossing=")
        }
        Error::OnePoint { .. } => Some("remove these triangles, and export the mesh again"),
        _ => None,
    }
}

impl From<pliant_io::Error> for Refused {
    fn from(error: pliant_io::Error) -> Self {
        let refused = Self::new("CannotRead", error.to_string())
            .advising(after_reading(&error))
            .with("file", error.file().display().to_string());
        // Displayed behind a file's name, a place begins with a comma.
        let place = error.place().to_string();
        match place.trim_start_matches(", ") {
            "" => refused,
            place => refused.with("place", place),
        }
    }
}

impl From<PyErr> for Refused {
    fn from(error: PyErr) -> Self {
        Self::Python(error)
    }
}

impl From<Refused> for PyErr {
    fn from(refused: Refused) -> Self {
        match refused {
            Refused::Python(error) => error,
            Refused::Error {
                kind,
                message,
                facts,
            } => Python::attach(|py| {
                raised(py, &kind, &message, facts).unwrap_or_else(|instead| instead)
            }),
        }
    }
}

fn raised(
    py: Python<'_>,
    kind: &str,
    message: &str,
    facts: Vec<(&'static str, Fact)>,
) -> PyResult<PyErr> {
    let named = facts.into_py_dict(py)?;
    let class = py.import("pliant._types")?.getattr("Error")?;
    let error = class.call((message, kind), Some(&named))?;
    Ok(PyErr::from_value(error))
}

/// Does `work` on the value of `mutex`, without the interpreter lock.
pub(crate) fn alone_with<S: Send, T: Send>(
    py: Python<'_>,
    mutex: &Mutex<S>,
    work: impl FnOnce(&mut S) -> Result<T> + Send,
) -> Result<T> {
    py.detach(|| caught(|| work(&mut *alone(mutex)?)))
}

/// Does `work`, and turns a panic, which is a bug, into an error like others.
///
/// The class that pyo3 has for panics is no `Exception`, and ends programs that meant to go on.
pub(crate) fn caught<T>(work: impl FnOnce() -> Result<T>) -> Result<T> {
    // State of the work is behind a lock, which a panic poisons, or gone.
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref().copied());
        let text = text.unwrap_or("the panic has no message");
        Err(refused!(Broken: "a panic, which is a bug of pliant; please report it: {text}"))
    })
}

/// Locks `mutex` for one call, or refuses if another call has it.
///
/// Waiting could last for ever: the other call may be this thread's own, with a visitor.
pub(crate) fn alone<S>(mutex: &Mutex<S>) -> Result<MutexGuard<'_, S>> {
    mutex.try_lock().map_err(|taken| match taken {
        TryLockError::WouldBlock => refused!(Busy:
            "in use by another thread, or by the visitor or the write_positions that asks; one \
             call at a time: give each thread its own, and let a visitor keep what it is shown \
             until the visit has ended"),
        TryLockError::Poisoned(_) => refused!(Broken:
            "an earlier call ended in a panic, which is a bug of pliant; please report it, and go \
             on with a new one"),
    })
}
