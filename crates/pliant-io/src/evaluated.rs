//! Bodies whose frames the calling program evaluates, from a file that is not read here.
//!
//! The frames are checked like a reader's: they are trusted no more.

use std::path::Path;
use std::sync::Arc;

use crate::body::Body;
use crate::error::{Error, Fault, Place, Reason};
use crate::frame::{Announced, Complete, Frame};
use crate::options::OpenOptions;
use crate::positions::Precision;
use crate::source::FrameSource;

/// Frames of a body, evaluated by the calling program when they are asked for.
pub trait Evaluated: Send {
    /// Number of frames.
    fn frame_count(&self) -> usize;

    /// Number of corners of each polygon, and the corners of all polygons in a row.
    fn polygons(&self) -> (&[u32], &[u32]);

    /// Appends the positions of a frame to `list`, which is empty.
    ///
    /// # Errors
    ///
    /// One line that says why the frame has no positions.
    fn positions(&mut self, frame: usize, list: &mut Vec<[f64; 3]>) -> Result<(), String>;
}

/// Opens a body of `file` whose frames the calling program evaluates; evaluates the first.
///
/// `name` is the name of the body; `argument` is shared by all bodies that it names.
///
/// # Errors
///
/// The file does not exist, or the first frame is invalid: as [`open`](crate::open).
pub fn evaluated(
    file: &Path,
    argument: &str,
    name: &str,
    frames: Box<dyn Evaluated>,
    options: &OpenOptions,
) -> Result<Body, Error> {
    let found = options.files.find(file.to_owned());
    let found = found.map_err(|reason| Error::new(file, reason))?;
    let count = frames.frame_count();
    if count == 0 {
        return Err(Error::new(file, Reason::NoFrames));
    }
    let source = Source {
        frames,
        next: 0,
        list: Vec::new(),
    };
    let named = (Arc::from(argument), name.to_owned());
    Body::begin_evaluated(named, found, Box::new(source), options)
}

/// Source of evaluated frames.
struct Source {
    frames: Box<dyn Evaluated>,
    next: usize,
    /// Reused buffer of positions.
    list: Vec<[f64; 3]>,
}

impl FrameSource for Source {
    fn frame_count(&self) -> usize {
        self.frames.frame_count()
    }

    fn read(&mut self, frame: &mut Frame) -> Result<Complete, Fault> {
        let place = Place::Frame(self.next as u64);
        self.list.clear();
        let evaluated = self.frames.positions(self.next, &mut self.list);
        evaluated.map_err(|why| Reason::Unsupported(why).at(place.clone()))?;
        let (counts, corners) = self.frames.polygons();
        let announced = Announced {
            vertices: self.list.len() as u64,
            faces: if self.next == 0 {
                counts.len() as u64
            } else {
                0
            },
        };
        let begun = frame.begin(Precision::F64, announced);
        begun.map_err(|reason| reason.at(place.clone()))?;
        for &position in &self.list {
            let taken = frame.vertex(position);
            taken.map_err(|reason| reason.at(place.clone()))?;
        }
        if self.next == 0 {
            let differ = || {
                let needed: u64 = counts.iter().map(|&count| u64::from(count)).sum();
                let has = corners.len();
                let why = format!("lists {has} corners, but its polygons need {needed}");
                Fault::from(Reason::Malformed(why))
            };
            let mut left = corners;
            for &count in counts {
                let Some((polygon, others)) = left.split_at_checked(count as usize) else {
                    return Err(differ());
                };
                left = others;
                let taken = frame.face(polygon, || place.clone());
                taken.map_err(|reason| reason.at(place.clone()))?;
            }
            if !left.is_empty() {
                return Err(differ());
            }
        } else {
            frame.same_faces();
        }
        self.next += 1;
        frame.complete(0).map_err(|fault| fault.or_at(place))
    }

    fn skip(&mut self, frames: usize) -> Result<(), Fault> {
        self.next += frames;
        Ok(())
    }

    fn rewind(&mut self) -> Result<bool, Fault> {
        self.next = 0;
        Ok(true)
    }

    fn held(&self) -> u64 {
        let (counts, corners) = self.frames.polygons();
        (size_of_val(counts) + size_of_val(corners)) as u64
    }
}
