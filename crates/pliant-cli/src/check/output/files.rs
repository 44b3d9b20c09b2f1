//! Column of file names in the table, for sequences of one file per frame.
//!
//! There people look for the file, not for the frame number.

use pliant_check::Check;
use pliant_io::{Body, shown};
use std::path::PathBuf;

/// Widest column in characters. Longer names are not aligned.
const WIDEST: usize = 40;

/// File names of one source, without their common folder, which the body's line names.
pub(super) struct Files {
    source: usize,
    folder: PathBuf,
    header: String,
    width: usize,
}

impl Files {
    /// Takes the first source with a file for each frame, if there is one.
    pub(super) fn of(check: &Check) -> Option<Self> {
        let sources = check.sources();
        let mut in_files = (0..sources.len()).filter(|&source| is_in_files(&sources[source]));
        let source = in_files.next()?;
        let header = match in_files.next() {
            None => "file".to_owned(),
            Some(_) => format!("file of body {}", check.bodies_of(source).start),
        };
        let paths = || (0..check.frame_count()).filter_map(|f| sources[source].frame_file(f));
        let mut folder = paths().next()?.parent()?.to_owned();
        for path in paths() {
            while !path.starts_with(&folder) && folder.pop() {}
        }
        let mut files = Self {
            source,
            folder,
            header,
            width: 0,
        };
        let names = (0..check.frame_count()).map(|frame| files.name(check, frame).chars().count());
        let widest = names.max().unwrap_or_default();
        files.width = widest.min(WIDEST).max(files.header.len());
        Some(files)
    }

    /// Heading of the column.
    pub(super) fn header(&self) -> String {
        self.cell(&self.header)
    }

    /// Name of a frame's file.
    pub(super) fn frame(&self, check: &Check, frame: usize) -> String {
        self.cell(&self.name(check, frame))
    }

    /// Empty cell.
    pub(super) fn blank(&self) -> String {
        self.cell("")
    }

    fn cell(&self, text: &str) -> String {
        format!("  {text:<width$}", width = self.width)
    }

    fn name(&self, check: &Check, frame: usize) -> String {
        let path = check.sources()[self.source].frame_file(frame);
        let path = path.map(|path| path.strip_prefix(&self.folder).unwrap_or(path));
        path.map_or_else(String::new, shown)
    }
}

fn is_in_files(source: &Body) -> bool {
    source.frame_file(0) != source.frame_file(source.frame_count().saturating_sub(1))
}
