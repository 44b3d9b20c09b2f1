//! Statuses, errors as the caller gets them, and panics, which end here.

use pliant::{Error, ErrorKind};
use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// `pliant_status`: 0 is success.
pub type PliantStatus = i32;

/// Statuses, by their names in the header without `PLIANT_`.
macro_rules! statuses {
    ($($name:ident = $number:literal;)*) => {
        $(pub(crate) const $name: PliantStatus = $number;)*

        #[cfg(test)]
        const STATUSES: &[(&str, PliantStatus)] = &[$((stringify!($name), $name)),*];
    };
}

statuses! {
    OK = 0;
    NULL = 1;
    BAD_SCALAR = 2;
    PANIC = 3;
    OTHER = 4;
    BAD_INDEX = 5;
    BAD_OPTION = 6;
    WOULD_ROUND = 7;
    BUSY = 8;
    DIFFERENT_COUNTS = 10;
    BAD_CORNER = 11;
    BAD_WIDTH = 12;
    BAD_POINT = 13;
    NO_SUCH_BODY = 20;
    SAME_BODY = 21;
    NO_TRIANGLES = 22;
    TOO_LARGE = 23;
    TOO_MANY_BODIES = 24;
    VERTEX_OUT_OF_RANGE = 25;
    WRONG_LENGTH = 26;
    BAD_POSITION = 27;
    NEEDS_SUBNORMALS = 28;
    NOT_CLOSED = 29;
    TOO_MANY_HITS = 30;
    INTERRUPTED = 31;
    BAD_MARGIN = 32;
    BAD_DISTANCE = 33;
    BAD_TIME = 34;
    BAD_THICKNESS = 35;
    NO_SUCH_TRIANGLE = 40;
    EMPTY_TRIANGLE = 41;
    NO_SUCH_VERTEX = 42;
    EMPTY_VERTEX = 43;
    VERTEX_IN_USE = 44;
    NOT_A_CORNER = 45;
    NO_SUCH_EDGE = 46;
    MISSING_EDGE = 47;
    NOT_AN_EDGE = 48;
    EDITED_MESH = 49;
    OUTDATED_EDIT = 50;
    BAD_LOOSE_BOX = 51;
    OUTSIDE_LOOSE_BOX = 52;
    INVALID = 60;
}

/// Bytes of a message, the 0 at its end included.
const MESSAGE: usize = 256;

/// `pliant_error`: why a call was refused.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantError {
    /// Status that the call returned.
    pub status: PliantStatus,
    /// Body that the call was about; this and the next are `u32::MAX` where they do not apply.
    pub body: u32,
    /// Triangle of it.
    pub triangle: u32,
    /// Vertex of it, or the corner of a pair.
    pub vertex: u32,
    /// Number of the pair or point; this and the next are `u64::MAX` where they do not apply.
    pub pair: u64,
    /// Count that is refused.
    pub count: u64,
    /// Count that was expected, or is the most.
    pub limit: u64,
    /// Number that is refused, or NaN.
    pub number: f64,
    /// Position that is refused, or NaN.
    pub position: [f64; 3],
    /// One line of UTF-8 that ends with 0.
    pub message: [u8; MESSAGE],
}

/// A refused call.
pub(crate) struct Refused(pub(crate) Box<PliantError>);

impl Refused {
    pub(crate) fn new(status: PliantStatus, message: impl Display) -> Self {
        let mut text = message.to_string();
        while text.len() >= MESSAGE {
            text.pop();
        }
        let mut bytes = [0; MESSAGE];
        bytes[..text.len()].copy_from_slice(text.as_bytes());
        Self(Box::new(PliantError {
            status,
            body: u32::MAX,
            triangle: u32::MAX,
            vertex: u32::MAX,
            pair: u64::MAX,
            count: u64::MAX,
            limit: u64::MAX,
            number: f64::NAN,
            position: [f64::NAN; 3],
            message: bytes,
        }))
    }

    /// A pointer that is NULL, by its name in the header.
    pub(crate) fn null(name: &str) -> Self {
        Self::new(NULL, format_args!("{name} is NULL; give an address"))
    }

    /// Says which body it is about.
    pub(crate) fn of(mut self, body: u32) -> Self {
        self.0.body = body;
        self
    }
}

impl From<Error> for Refused {
    fn from(error: Error) -> Self {
        let message = error.to_string();
        let with = |status, add: &dyn Fn(&mut PliantError)| {
            let mut refused = Self::new(status, &message);
            refused.0.body = error.body.map_or(u32::MAX, |body| body.0);
            add(&mut refused.0);
            refused
        };
        let plain = |status| with(status, &|_| {});
        match error.kind {
            ErrorKind::DifferentCounts { start, end } => with(DIFFERENT_COUNTS, &|it| {
                (it.count, it.limit) = (end as u64, start as u64);
            }),
            ErrorKind::BadCorner {
                pair,
                corner,
                position,
            } => with(BAD_CORNER, &|it| {
                (it.pair, it.vertex, it.position) = (pair as u64, corner as u32, position);
            }),
            ErrorKind::BadPoint { point, position } => with(BAD_POINT, &|it| {
                (it.pair, it.position) = (point as u64, position);
            }),
            ErrorKind::BadWidth { width } => with(BAD_WIDTH, &|it| it.number = width),
            ErrorKind::NoSuchBody => plain(NO_SUCH_BODY),
            ErrorKind::SameBody => plain(SAME_BODY),
            ErrorKind::NoTriangles => plain(NO_TRIANGLES),
            ErrorKind::TooLarge { count, limit, .. } => with(TOO_LARGE, &|it| {
                (it.count, it.limit) = (count as u64, limit as u64);
            }),
            ErrorKind::TooManyBodies => plain(TOO_MANY_BODIES),
            ErrorKind::VertexOutOfRange {
                triangle,
                vertex,
                vertices,
            } => with(VERTEX_OUT_OF_RANGE, &|it| {
                (it.triangle, it.vertex) = (triangle as u32, vertex);
                it.limit = vertices as u64;
            }),
            ErrorKind::WrongLength {
                expected, found, ..
            } => with(WRONG_LENGTH, &|it| {
                (it.count, it.limit) = (found as u64, expected as u64);
            }),
            ErrorKind::BadPosition { vertex, position } => with(BAD_POSITION, &|it| {
                (it.vertex, it.position) = (vertex as u32, position);
            }),
            ErrorKind::NeedsSubnormals { vertex } => {
                with(NEEDS_SUBNORMALS, &|it| it.vertex = vertex as u32)
            }
            ErrorKind::NotClosed { count, .. } => with(NOT_CLOSED, &|it| it.count = count as u64),
            ErrorKind::TooManyHits { limit } => with(TOO_MANY_HITS, &|it| it.limit = limit as u64),
            ErrorKind::Interrupted => plain(INTERRUPTED),
            ErrorKind::BadMargin { radius } => with(BAD_MARGIN, &|it| it.number = radius),
            ErrorKind::BadDistance { distance } => with(BAD_DISTANCE, &|it| it.number = distance),
            ErrorKind::BadThickness { vertex, thickness } => with(BAD_THICKNESS, &|it| {
                (it.vertex, it.number) = (vertex as u32, thickness);
            }),
            ErrorKind::BadTime { time } => with(BAD_TIME, &|it| it.number = time),
            ErrorKind::OutsideLooseBox { vertex, position } => with(OUTSIDE_LOOSE_BOX, &|it| {
                (it.vertex, it.position) = (vertex as u32, position);
            }),
            ErrorKind::BadLooseBox => plain(BAD_LOOSE_BOX),
            kind => with(OTHER, &|it| it.mesh(&kind)),
        }
    }
}

impl PliantError {
    /// Says why an edit, pairs or edges of a mesh are refused.
    fn mesh(&mut self, kind: &ErrorKind) {
        self.status = match *kind {
            ErrorKind::NoSuchTriangle {
                triangle,
                triangles,
            } => {
                (self.triangle, self.limit) = (triangle, triangles as u64);
                NO_SUCH_TRIANGLE
            }
            ErrorKind::EmptyTriangle { triangle } => {
                self.triangle = triangle;
                EMPTY_TRIANGLE
            }
            ErrorKind::NoSuchVertex { vertex, vertices } => {
                (self.vertex, self.limit) = (vertex, vertices as u64);
                NO_SUCH_VERTEX
            }
            ErrorKind::EmptyVertex { vertex } => {
                self.vertex = vertex;
                EMPTY_VERTEX
            }
            ErrorKind::VertexInUse { vertex } => {
                self.vertex = vertex;
                VERTEX_IN_USE
            }
            ErrorKind::NotACorner { triangle, vertex } => {
                (self.triangle, self.vertex) = (triangle, vertex);
                NOT_A_CORNER
            }
            ErrorKind::NoSuchEdge { edge, edges } => {
                (self.count, self.limit) = (edge.into(), edges as u64);
                NO_SUCH_EDGE
            }
            ErrorKind::MissingEdge { ends } => {
                self.vertex = ends[0];
                MISSING_EDGE
            }
            ErrorKind::NotAnEdge { edge, ends } => {
                (self.count, self.vertex) = (edge.into(), ends[0]);
                NOT_AN_EDGE
            }
            ErrorKind::EditedMesh => EDITED_MESH,
            ErrorKind::OutdatedEdit => OUTDATED_EDIT,
            _ => OTHER,
        };
    }
}

/// Runs a call, and says in `error`, unless it is NULL, why it is refused. A panic is a refusal.
///
/// # Safety
///
/// `error` is NULL, or may be written.
pub(crate) unsafe fn call(
    error: *mut PliantError,
    work: impl FnOnce() -> Result<(), Refused>,
) -> PliantStatus {
    let done = catch_unwind(AssertUnwindSafe(work));
    let refused = match done {
        Ok(Ok(())) => return OK,
        Ok(Err(refused)) => refused,
        Err(payload) => {
            let said = payload.downcast_ref::<String>().map(String::as_str);
            let said = said.or_else(|| payload.downcast_ref::<&str>().copied());
            let said = said.unwrap_or("without a message");
            Refused::new(
                PANIC,
                format_args!("a fault of pliant: {said}; please report it"),
            )
        }
    };
    let status = refused.0.status;
    if !error.is_null() {
        // SAFETY: it is not NULL, so the caller lets it be written.
        unsafe { error.write_unaligned(*refused.0) };
    }
    status
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_has_every_status() {
        let header = include_str!("../include/pliant.h");
        let list = header
            .split("typedef int32_t pliant_status;")
            .nth(1)
            .unwrap();
        let list = list.split("};").next().unwrap().lines();
        let entries =
            list.filter_map(|line| line.trim().strip_prefix("PLIANT_")?.split_once(" = "));
        let number = |text: &str| text.split([',', ' ']).next().unwrap().parse().unwrap();
        let entries: Vec<(&str, PliantStatus)> =
            entries.map(|(name, rest)| (name, number(rest))).collect();
        assert_eq!(entries, STATUSES);
    }

    #[test]
    fn panics_end_here_and_messages_fit() {
        let mut error = *Refused::null("nothing").0;
        // SAFETY: the error may be written.
        let status = unsafe { call(&raw mut error, || panic!("{}", "ä".repeat(300))) };
        assert_eq!((status, error.status), (PANIC, PANIC));
        let end = error.message.iter().position(|&byte| byte == 0).unwrap();
        let said = std::str::from_utf8(&error.message[..end]).unwrap();
        assert!(
            said.starts_with("a fault of pliant: ää") && end > MESSAGE - 3,
            "{said}"
        );
    }
}
