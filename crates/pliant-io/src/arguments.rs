//! An argument is a file, or a pattern whose files are the frames.
//!
//! An existing file of exactly that name wins, so that `scan[1].obj` can be read without escapes.
//! Everything is made sure here that can be before a file is opened: it exists and is a regular
//! file (a pipe would make us wait, and can be read once only).

use std::io;
use std::path::Path;

use glob::{MatchOptions, Pattern};

use crate::error::{Error, Reason};
use crate::file::Found;
use crate::natural;

/// Patterns as shells read them: `*` does not match a leading dot, nor does it cross a folder.
const AS_IN_SHELLS: MatchOptions = MatchOptions {
    case_sensitive: true,
    require_literal_separator: true,
    require_literal_leading_dot: true,
};

/// The files that `argument` names, in natural order; at least one.
pub(crate) fn files(argument: &str) -> Result<Vec<Found>, Error> {
    let error = |reason: Reason| Error::new(argument, reason);
    let path = Path::new(argument);
    match path.metadata() {
        Ok(metadata) if metadata.is_file() => {
            return Ok(vec![Found::new(path.to_owned(), &metadata)]);
        }
        Ok(metadata) if metadata.is_dir() => return Err(error(Reason::Directory)),
        Ok(_) => return Err(error(Reason::NotAFile)),
        Err(_) if is_pattern(argument) => {}
        Err(absent) if absent.kind() == io::ErrorKind::NotFound => {
            return Err(error(Reason::NotFound));
        }
        Err(other) => return Err(error(other.into())),
    }
    let mut files = Vec::new();
    for path in
        glob::glob_with(argument, AS_IN_SHELLS).map_err(|bad| error(Reason::Pattern(bad.msg)))?
    {
        let path = path.map_err(|unreadable| {
            let folder = unreadable.path().to_owned();
            Error::new(folder, Reason::Io(unreadable.into()))
        })?;
        match path.metadata() {
            // A pattern for files may well match folders beside them.
            Ok(metadata) if metadata.is_dir() => {}
            Ok(metadata) if metadata.is_file() => files.push(Found::new(path, &metadata)),
            Ok(_) => return Err(Error::new(path, Reason::NotAFile)),
            Err(other) => return Err(Error::new(path, Reason::Io(other))),
        }
    }
    if files.is_empty() {
        return Err(error(Reason::NoMatch));
    }
    files.sort_by(|a, b| natural::compare(a.path(), b.path()));
    Ok(files)
}

/// Whether any character has a meaning in patterns.
fn is_pattern(argument: &str) -> bool {
    Pattern::escape(argument) != argument
}
