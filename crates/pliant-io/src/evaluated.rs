//! Bodies that a program evaluates by itself, frame by frame, from a file that nothing here reads.
//!
//! What comes is checked as that of a reader is: it is no more trusted.

use std::path::Path;
use std::sync::Arc;

use crate::body::Body;
use crate::error::{Error, Fault, Place, Reason};
use crate::file::Found;
use crate::frame::{Announced, Complete, Frame};
use crate::options::OpenOptions;
use crate::positions::Precision;
use crate::source::FrameSource;

/// The frames of a body, evaluated when they are asked for.
pub trait Evaluated: Send {
    /// How many there are.
    fn frame_count(&self) -> usize;

    /// How many corners each polygon has, and the corners of all of them, one polygon after the other.
    fn polygons(&self) -> (&[u32], &[u32]);

    /// Puts the positions of a frame into an empty list.
    ///
    /// # Errors
    ///
    /// Why there are none, in one line.
    fn positions(&mut self, frame: usize, list: &mut Vec<[f64; 3]>) -> Result<(), String>;
}

/// A body of `file` that is called `name`, and `argument` with all others that this names; its first frame is evaluated.
///
/// # Errors
///
/// There is no such file, or the first frame is none: as [`open`](crate::open).
pub fn evaluated(
    file: &Path,
    argument: &str,
    name: &str,
    frames: Box<dyn Evaluated>,
    options: &OpenOptions,
) -> Result<Body, Error> {
    let found = Found::find(file.to_owned()).map_err(|reason| Error::new(file, reason))?;
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

struct Source {
    frames: Box<dyn Evaluated>,
    next: usize,
    /// Reused.
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
            let mut left = corners;
            for &count in counts {
                let Some((polygon, others)) = left.split_at_checked(count as usize) else {
                    let why = "has fewer corners than its polygons need".to_owned();
                    return Err(Reason::Malformed(why).into());
                };
                left = others;
                let taken = frame.face(polygon, || place.clone());
                taken.map_err(|reason| reason.at(place.clone()))?;
            }
            if !left.is_empty() {
                let why = "has more corners than its polygons need".to_owned();
                return Err(Reason::Malformed(why).into());
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
