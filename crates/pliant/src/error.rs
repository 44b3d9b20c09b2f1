//! Errors: refused calls, with the body, triangle or vertex, the reason, and what to do.

use crate::ids::BodyId;
use std::fmt;

/// Refused call; the world is as it was before.
#[derive(Clone, Debug, PartialEq)]
pub struct Error {
    /// Body that the call was about; `None` for a body that was to be added, and for a query that
    /// failed as a whole.
    pub body: Option<BodyId>,
    /// Reason for the refusal.
    pub kind: ErrorKind,
}

/// Reason for which a call was refused.
///
/// Triangles and vertices are numbered as the caller numbers them. Messages say what is wrong and
/// what to do, in one line.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// A body would have no triangle; it needs at least one.
    NoTriangles,
    /// A body has more triangles, or more vertices, than 32-bit numbers can keep apart.
    TooLarge {
        /// `"triangles"` or `"vertices"`.
        what: &'static str,
        /// How many were given.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
    /// All 2^32 ids of this world were given away.
    TooManyBodies,
    /// A triangle names a vertex that the body does not have.
    VertexOutOfRange {
        /// The triangle.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// The vertices the body has.
        vertices: usize,
    },
    /// The number of positions, groups or thicknesses is not the number of vertices of the body. Or
    /// the number of labels is not that of triangles.
    WrongLength {
        /// `"positions"`, `"rest positions"`, `"groups"`, `"thicknesses"` or `"labels"`.
        what: &'static str,
        /// Vertices of the body, or triangles.
        expected: usize,
        /// How many were given.
        found: usize,
    },
    /// A coordinate is NaN, infinite, or larger than `f32::MAX` in magnitude.
    BadPosition {
        /// The vertex.
        vertex: usize,
        /// Its position.
        position: [f64; 3],
    },
    /// A coordinate is not zero, but the calling thread would take it for zero.
    ///
    /// The thread has flush-to-zero or denormals-are-zero set, and the coordinate is below 2^-126
    /// (`f32`) or 2^-969 (`f64`) in magnitude.
    NeedsSubnormals {
        /// The vertex.
        vertex: usize,
    },
    /// [`write_positions`](crate::World::write_positions) left a vertex unwritten, or wrote NaN.
    NotWritten {
        /// The first such vertex.
        vertex: usize,
    },
    /// A vertex is outside the loose box that was promised to hold every pose.
    OutsideLooseBox {
        /// The vertex.
        vertex: usize,
        /// Its position.
        position: [f64; 3],
    },
    /// A loose box has a corner that is not in range, or a lower corner above its upper one.
    BadLooseBox,
    /// No body of this world has this id: it was removed, or it belongs to another world.
    NoSuchBody,
    /// One body was given twice where two different ones are needed.
    ///
    /// [`Within`](crate::Selection::Within) asks about a body with itself.
    SameBody,
    /// A list would have more hits than [`at_most`](crate::Query::at_most) allows.
    TooManyHits {
        /// How many are allowed.
        limit: usize,
    },
    /// [`interrupt_if`](crate::Query::interrupt_if) or
    /// [`interruptible`](crate::World::interruptible) ended the call.
    Interrupted,
    /// A margin is negative, infinite or NaN.
    BadMargin {
        /// The margin.
        radius: f64,
    },
    /// A distance that is asked about is negative, infinite or NaN.
    BadDistance {
        /// The distance.
        distance: f64,
    },
    /// A hit of a list names a vertex, an edge or a triangle that its body does not have.
    NoSuchHit {
        /// Place of the hit in the list.
        hit: usize,
    },
    /// The thickness of a vertex is negative, infinite or NaN.
    BadThickness {
        /// The vertex.
        vertex: usize,
        /// Its thickness.
        thickness: f64,
    },
    /// Corners are given for different numbers of pairs at the start and at the end of motions.
    DifferentCounts {
        /// Pairs at the start.
        start: usize,
        /// Pairs at the end.
        end: usize,
    },
    /// A coordinate of a single pair is NaN, infinite, or larger than `f32::MAX` in magnitude. Or
    /// this thread takes it for zero, because it flushes subnormal numbers.
    BadCorner {
        /// The pair, counted from 0.
        pair: usize,
        /// Its corner, from 0 to 3, or of two triangles from 0 to 5.
        corner: usize,
        /// Its position.
        position: [f64; 3],
    },
    /// The width of time intervals is negative, infinite or NaN.
    BadWidth {
        /// The width.
        width: f64,
    },
    /// A time within a step is not from 0 to 1.
    BadTime {
        /// The time.
        time: f64,
    },
    /// An edit names a triangle that the body does not have.
    NoSuchTriangle {
        /// The triangle.
        triangle: u32,
        /// How many numbers of triangles there are.
        triangles: usize,
    },
    /// An edit names a triangle that was taken out.
    EmptyTriangle {
        /// The triangle.
        triangle: u32,
    },
    /// An edit names a vertex that the body does not have.
    NoSuchVertex {
        /// The vertex.
        vertex: u32,
        /// How many numbers of vertices there are.
        vertices: usize,
    },
    /// A list names an edge that the body does not have.
    NoSuchEdge {
        /// The edge.
        edge: u32,
        /// How many edges there are.
        edges: usize,
    },
    /// Edges that are given to a body lack one that its mesh has.
    MissingEdge {
        /// Its two vertices.
        ends: [u32; 2],
    },
    /// Edges that are given to a body have one that its mesh has not, or have it twice.
    NotAnEdge {
        /// The row.
        edge: u32,
        /// Its two vertices.
        ends: [u32; 2],
    },
    /// Edges are given to a body whose mesh was edited: their numbers follow the edits.
    EditedMesh,
    /// An edit names a vertex that is gone, because no triangle used it any more.
    EmptyVertex {
        /// The vertex.
        vertex: u32,
    },
    /// An edit places a vertex that is not empty.
    VertexInUse {
        /// The vertex.
        vertex: u32,
    },
    /// An edit splits a vertex for a triangle that does not have it for a corner.
    NotACorner {
        /// The triangle.
        triangle: u32,
        /// The vertex that was to be split.
        vertex: u32,
    },
    /// A body has no inside, because its surface is not [closed](crate::World::watertight).
    NotClosed {
        /// Some of the edges at which it is not, each by its two vertices.
        edges: Vec<[u32; 2]>,
        /// How many there are.
        count: usize,
    },
    /// A coordinate of a point is NaN, infinite, or larger than `f32::MAX` in magnitude. Or this
    /// thread takes it for zero, because it flushes subnormal numbers.
    BadPoint {
        /// The point, counted from 0.
        point: usize,
        /// Where it is.
        position: [f64; 3],
    },
    /// The mesh was changed since [`World::edit`](crate::World::edit) began this edit, or another
    /// world began it.
    OutdatedEdit,
}

impl ErrorKind {
    /// Makes the error of a query that failed as a whole.
    pub(crate) fn of_query(self) -> Error {
        Error {
            body: None,
            kind: self,
        }
    }
}

impl std::error::Error for Error {}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.body {
            Some(body) => write!(f, "{body}: {}", self.kind),
            None => write!(f, "{}", self.kind),
        }
    }
}

impl fmt::Display for ErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoTriangles => write!(f, "no triangles; a body needs at least one"),
            Self::TooLarge { what, count, limit } => {
                write!(
                    f,
                    "{count} {what}; a body may have at most {limit}; split the mesh"
                )
            }
            Self::TooManyBodies => write!(
                f,
                "this world has used up its 2^32 ids of bodies; go on with a new world"
            ),
            Self::VertexOutOfRange {
                triangle,
                vertex,
                vertices,
            } => {
                write!(
                    f,
                    "triangle {triangle} names vertex {vertex}, but there are {vertices} vertices \
                     (counted from 0); give it corners that are there"
                )
            }
            Self::WrongLength {
                what,
                expected,
                found,
            } => {
                let (all, each) = match *what {
                    "labels" => ("triangles", "triangle"),
                    _ => ("vertices", "vertex"),
                };
                write!(
                    f,
                    "{found} {what} for {expected} {all}; give one for each {each}, empty ones \
                     included"
                )
            }
            Self::BadPosition { vertex, position } => write!(
                f,
                "vertex {vertex} is at {position:?}; coordinates must be finite and at most {:e} \
                 in magnitude",
                f32::MAX
            ),
            Self::NeedsSubnormals { vertex } => write!(
                f,
                "vertex {vertex} has a coordinate that this thread takes for zero, because it \
                 flushes subnormal numbers; switch flush-to-zero and denormals-are-zero off, or \
                 make the coordinate zero"
            ),
            Self::NotWritten { vertex } => {
                write!(
                    f,
                    "vertex {vertex} was not written, or written as NaN; fill every row of the \
                     buffer"
                )
            }
            Self::OutsideLooseBox { vertex, position } => {
                write!(
                    f,
                    "vertex {vertex} is at {position:?}, outside the body's loose box; enlarge or \
                     remove the box"
                )
            }
            Self::BadLooseBox => write!(
                f,
                "the corners of the loose box are out of range or exchanged; give finite ones of \
                 at most {:e} in magnitude, the lower one not above the upper one on any axis",
                f32::MAX
            ),
            Self::NoSuchBody => write!(
                f,
                "not in this world; it was removed, or belongs to another world; bodies() lists \
                 all that are there"
            ),
            Self::SameBody => write!(
                f,
                "given twice, where two different bodies are needed; give another, or ask about \
                 the body with itself"
            ),
            _ => self.about_a_question(f),
        }
    }
}

impl ErrorKind {
    /// Message of a refused question, of a motion or of single pairs.
    fn about_a_question(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooManyHits { limit } => write!(
                f,
                "more hits than the {limit} that were allowed; allow more, or visit them"
            ),
            Self::Interrupted => write!(
                f,
                "interrupted, as the caller wished; the world stays usable, ask again"
            ),
            Self::BadMargin { radius } => write!(
                f,
                "the radius is {radius}; give a finite number that is at least 0"
            ),
            Self::BadDistance { distance } => write!(
                f,
                "the distance is {distance}; give a finite number that is at least 0"
            ),
            Self::NoSuchHit { hit } => write!(
                f,
                "hit {hit} of the list names an element that the body does not have; ask for the \
                 list again after the mesh has changed"
            ),
            Self::BadThickness { vertex, thickness } => write!(
                f,
                "the thickness of vertex {vertex} is {thickness}; give a finite number that is at \
                 least 0"
            ),
            Self::DifferentCounts { start, end } => write!(
                f,
                "{start} pairs at the start and {end} at the end of the motion; give the same \
                 pairs at both"
            ),
            Self::BadCorner {
                pair,
                corner,
                position,
            } => bad_position(f, format_args!("corner {corner} of pair {pair}"), position),
            Self::BadPoint { point, position } => {
                bad_position(f, format_args!("point {point}"), position)
            }
            Self::NotClosed { edges, count } => {
                let named: Vec<String> = edges.iter().map(|[a, b]| format!("{a}-{b}")).collect();
                write!(
                    f,
                    "has no inside, for its surface is not closed at {count} edges, such as {}; \
                     watertight() lists all; close holes, weld seams, turn neighbours alike",
                    named.join(", ")
                )
            }
            Self::BadWidth { width } => write!(
                f,
                "the width of time intervals is {width}; give a finite number that is at least 0"
            ),
            Self::BadTime { time } => {
                write!(
                    f,
                    "the time is {time}; give the part of the step, from 0 to 1"
                )
            }
            _ => self.about_an_edit(f),
        }
    }

    /// Message of a refused edit.
    fn about_an_edit(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchTriangle {
                triangle,
                triangles,
            } => write!(
                f,
                "triangle {triangle} is named, but there are {triangles} triangles (counted \
                 from 0); name one that is there"
            ),
            Self::EmptyTriangle { triangle } => write!(
                f,
                "triangle {triangle} is named, which was taken out; give it corners to use \
                 its number again"
            ),
            Self::NoSuchVertex { vertex, vertices } => write!(
                f,
                "vertex {vertex} is named, but there are {vertices} vertices (counted from \
                 0); name one that is there"
            ),
            Self::MissingEdge { ends: [a, b] } => write!(
                f,
                "the edges lack the one from vertex {a} to vertex {b}; give every edge of the mesh"
            ),
            Self::NotAnEdge { edge, ends: [a, b] } => write!(
                f,
                "edge {edge}, from vertex {a} to vertex {b}, is no edge of a triangle, or stands \
                 there before; give every edge of the mesh once"
            ),
            Self::EditedMesh => write!(
                f,
                "the mesh was edited, and its edges keep their numbers; give edges before that, or \
                 set another mesh"
            ),
            Self::NoSuchEdge { edge, edges } => write!(
                f,
                "the list names edge {edge}, but there are {edges} edges (counted from 0); ask \
                 again, for the mesh was changed"
            ),
            Self::EmptyVertex { vertex } => write!(
                f,
                "vertex {vertex} is named, which is empty, for no triangle has it any more; \
                 place it to use its number again"
            ),
            Self::VertexInUse { vertex } => write!(
                f,
                "the edit places vertex {vertex}, which is not empty; set the positions to move it"
            ),
            Self::NotACorner { triangle, vertex } => write!(
                f,
                "vertex {vertex} is to be split, but is no corner of triangle {triangle}; give \
                 triangles that have it for a corner"
            ),
            Self::OutdatedEdit => write!(
                f,
                "the mesh was changed since this edit was begun, or it was begun in another world; \
                 begin another"
            ),
            _ => Ok(()),
        }
    }
}

/// Message about a point that is no vertex: its coordinates are out of range, or else this thread
/// takes one for zero.
fn bad_position(
    f: &mut fmt::Formatter<'_>,
    what: fmt::Arguments<'_>,
    position: &[f64; 3],
) -> fmt::Result {
    if position.iter().all(|x| x.abs() <= f64::from(f32::MAX)) {
        return write!(
            f,
            "{what} is at {position:?}, of which this thread takes a coordinate for zero, because \
             it flushes subnormal numbers; switch flush-to-zero and denormals-are-zero off, or \
             make the coordinate zero"
        );
    }
    write!(
        f,
        "{what} is at {position:?}; coordinates must be finite and at most {:e} in magnitude",
        f32::MAX
    )
}
