//! Files in a row are one body: the first frame fixes what holds for all, the others follow one by
//! one.

use std::fmt;
use std::path::Path;

use crate::arguments;
use crate::error::{Error, Fault, Place, Reason};
use crate::file::Found;
use crate::format::{Format, FrameSource};
use crate::frame::Frame;
use crate::positions::{Positions, Precision};
use crate::weld::Welding;

/// How to read a body.
///
/// ```
/// use pliant_io::OpenOptions;
/// let as_in_the_file = OpenOptions { weld: false, ..OpenOptions::default() };
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OpenOptions {
    /// Weld vertices where boundary edges coincide bit for bit in the first frame. Default: true;
    /// without, every seam of a file that splits vertices is a hit.
    pub weld: bool,
    /// The most bytes that a frame may take. Default: 4 GiB.
    ///
    /// Counted is all that is held at once: 12 or 24 per vertex, 12 per triangle, 4 more where there
    /// are polygons of more corners, and, unless [`weld`](Self::weld) is off, 24 per triangle and 8 per
    /// vertex while seams are found, of which at most 12 and 8 stay. A frame that announces more is
    /// refused before it is read; an OBJ file announces nothing, and is refused when so much of it has
    /// been read. Not counted: buffers, and the one line or polygon in hand (many MB only where a file
    /// has a line or polygon so long).
    pub max_memory: u64,
}

impl Default for OpenOptions {
    fn default() -> Self {
        Self {
            weld: true,
            max_memory: 4 << 30,
        }
    }
}

/// One body: connectivity known, frames still to come.
pub struct Body {
    name: String,
    files: Vec<FrameFile>,
    /// The frames of the file that is being read.
    source: Box<dyn FrameSource>,
    file: usize,
    frame: Frame,
    welding: Option<Welding>,
    /// Frames read, the first while opening; frames handed out.
    read: usize,
    handed_out: usize,
    failed: bool,
}

/// A file and the number of the body's frame that follows its last.
#[derive(Debug)]
struct FrameFile {
    found: Found,
    format: Format,
    end: usize,
}

impl FrameFile {
    /// Opens the file, which had so many `frames` when the body was opened.
    fn open(&self, frames: usize) -> Result<Box<dyn FrameSource>, Error> {
        let source = self.format.open(&self.found);
        let source = source.map_err(|fault| Error::new(self.path(), fault))?;
        if source.frame_count() != frames {
            return Err(Error::new(self.path(), Reason::Changed));
        }
        Ok(source)
    }

    fn path(&self) -> &Path {
        self.found.path()
    }
}

/// Opens the body that `argument` names: a file, or a pattern whose files are its frames. Reads its
/// first frame.
///
/// # Errors
///
/// Nothing found, no format known for the ending, or a first frame that cannot be read: [`Reason`]
/// lists what can be wrong.
pub fn open(argument: &str, options: &OpenOptions) -> Result<Body, Error> {
    let mut files = Vec::new();
    let mut end = 0_usize;
    for found in arguments::files(argument)? {
        let format = Format::of(found.path()).map_err(|reason| Error::new(found.path(), reason))?;
        let frames = format
            .frame_count(&found)
            .map_err(|fault| Error::new(found.path(), fault))?;
        end = end.saturating_add(frames);
        files.push(FrameFile { found, format, end });
    }
    let first = files
        .first()
        .ok_or_else(|| Error::new(argument, Reason::NoMatch))?;
    let path = first.path().to_owned();
    let in_first = |fault: Fault| Error::new(&path, fault);

    let mut source = first.open(first.end)?;
    let mut frame = Frame::new(options.max_memory, options.weld);
    let _complete = source.read(&mut frame).map_err(in_first)?;
    frame.becomes_first(path);
    let welding = frame.weld();
    Ok(Body {
        name: argument.to_owned(),
        files,
        source,
        file: 0,
        frame,
        welding,
        read: 1,
        handed_out: 0,
        failed: false,
    })
}

impl Body {
    /// The argument as given.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The triangles, in file order, polygons as fans; of welded vertices the smallest stands for
    /// all.
    pub fn triangles(&self) -> &[[u32; 3]] {
        match &self.welding {
            Some(welding) => &welding.triangles,
            None => self.frame.polygons().triangles(),
        }
    }

    /// For every triangle the polygon that it is part of; None where every polygon is a triangle.
    pub fn faces(&self) -> Option<&[u32]> {
        self.frame.polygons().faces()
    }

    /// How many vertices each frame has: those of the file, welded or not.
    pub fn vertex_count(&self) -> usize {
        self.frame.vertex_count()
    }

    /// How many vertices were welded away: no triangle uses them any more.
    pub fn welded(&self) -> usize {
        self.welding
            .as_ref()
            .map_or(0, |welding| welding.welded.len())
    }

    /// The type of the coordinates of all frames.
    pub fn precision(&self) -> Precision {
        self.frame.precision()
    }

    /// How many frames there are, at least one.
    pub fn frame_count(&self) -> usize {
        self.files.last().map_or(0, |file| file.end)
    }

    /// The file that a frame comes from; None if there is no such frame.
    pub fn frame_file(&self, frame: usize) -> Option<&Path> {
        let at = self.files.partition_point(|file| file.end <= frame);
        self.files.get(at).map(FrameFile::path)
    }

    /// The positions of the next frame, from frame 0 on; None after the last.
    ///
    /// They are valid until the next call, which reads over them.
    ///
    /// # Errors
    ///
    /// The frame cannot be read, does not agree with the first, or moves welded vertices apart. No
    /// frame follows: every later call is an error too.
    pub fn next_frame(&mut self) -> Result<Option<Positions<'_>>, Error> {
        if self.failed {
            let path = self.files[self.file].path();
            return Err(Error::new(path, Reason::AfterError));
        }
        if self.handed_out == self.frame_count() {
            return Ok(None);
        }
        if self.handed_out == self.read {
            // Set first, so that an error on any way out leaves it set.
            self.failed = true;
            self.advance()?;
            self.failed = false;
        }
        self.handed_out += 1;
        Ok(Some(self.frame.positions()))
    }

    /// The positions of the frame handed out last, and of frame 0 before any was; after an error they mean nothing.
    pub fn positions(&self) -> Positions<'_> {
        self.frame.positions()
    }

    /// Begins again: the next frame is frame 0. The files are opened again, and must be those that were found.
    ///
    /// # Errors
    ///
    /// The first file cannot be opened or is another one now, or an earlier frame could not be read. No frame follows.
    pub fn rewind(&mut self) -> Result<(), Error> {
        if self.failed {
            return Err(Error::new(self.files[self.file].path(), Reason::AfterError));
        }
        if self.read > 1 {
            self.failed = true;
            let first = &self.files[0];
            self.source = first.open(first.end)?;
            self.failed = false;
            (self.file, self.read) = (0, 0);
        }
        self.handed_out = 0;
        Ok(())
    }

    /// Reads the next frame over the last.
    fn advance(&mut self) -> Result<(), Error> {
        if self.read == self.files[self.file].end {
            self.file += 1;
            let file = &self.files[self.file];
            self.source = file.open(file.end - self.read)?;
        }
        let path = self.files[self.file].path();
        let _complete = self
            .source
            .read(&mut self.frame)
            .map_err(|fault| Error::new(path, fault))?;
        if let Some(welding) = &self.welding {
            let apart = welding.check(self.frame.positions());
            apart.map_err(|reason| Error::new(path, reason.at(self.place())))?;
        }
        self.read += 1;
        Ok(())
    }

    /// Where in its file the frame just read is.
    fn place(&self) -> Place {
        let begin = self
            .file
            .checked_sub(1)
            .map_or(0, |before| self.files[before].end);
        if self.files[self.file].end - begin == 1 {
            Place::File
        } else {
            Place::Frame((self.read - begin) as u64)
        }
    }
}

impl fmt::Debug for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Body")
            .field("name", &self.name)
            .field("vertices", &self.vertex_count())
            .field("triangles", &self.triangles().len())
            .field("welded", &self.welded())
            .field("precision", &self.precision())
            .field("frames", &self.frame_count())
            .finish_non_exhaustive()
    }
}
