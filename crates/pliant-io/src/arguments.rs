//! An argument is a file, a pattern whose files are the frames, a body of a glTF file, or a mesh with a cache of its positions.
//!
//! ```text
//! shirt.obj            a file
//! shirt_*.obj          the files that match, in natural order
//! scene.glb#arm        the body of this name in a file that holds several
//! shirt.obj+walk.pc2   the mesh before the last `+`, the positions behind it
//! ```
//!
//! An existing file of exactly that name wins, so that `scan[1].obj` can be read without escapes.
//! Everything is made sure here that can be before a file is opened: it exists and is a regular
//! file (a pipe would make us wait, and can be read once only).

use std::path::Path;

use crate::error::{Error, Reason};
use crate::file::Found;
use crate::format::Format;
use crate::natural;
use crate::pattern::{is_pattern, matching};

/// What an argument names.
#[derive(Debug)]
pub(crate) enum Named {
    /// The frames of a body, in order; at least one file.
    Files(Vec<Found>),
    /// A body in a file of several.
    Part { file: Found, name: String },
    /// A mesh, and the positions of its vertices.
    Cache { mesh: Found, positions: Found },
}

/// What `argument` names.
pub(crate) fn named(argument: &str) -> Result<Named, Error> {
    if !Path::new(argument).exists() {
        if let Some((mesh, positions)) = mesh_and_positions(argument) {
            return Ok(Named::Cache {
                mesh: file(mesh)?,
                positions: file(positions)?,
            });
        }
        if let Some((path, name)) = argument.split_once('#')
            && let Ok(format) = Format::of(Path::new(path))
        {
            if format.holds_bodies() {
                return Ok(Named::Part {
                    file: file(path)?,
                    name: name.to_owned(),
                });
            }
            if Path::new(path).exists() {
                let reason = format!(
                    "holds one body, not one called {name:?}; leave out what begins with the #"
                );
                return Err(Error::new(path, Reason::Unsupported(reason)));
            }
        }
    }
    files(argument).map(Named::Files)
}

/// The two names in `shirt.obj+walk.pc2`.
pub(crate) fn mesh_and_positions(argument: &str) -> Option<(&str, &str)> {
    let (mesh, positions) = argument.rsplit_once('+')?;
    let is_cache = Format::of(Path::new(positions)).is_ok_and(Format::is_cache);
    (is_cache && !mesh.is_empty()).then_some((mesh, positions))
}

/// One file of exactly this name.
fn file(name: &str) -> Result<Found, Error> {
    let error = |reason: Reason| Error::new(name, reason);
    Found::find(name.into()).map_err(|reason| match reason {
        Reason::NotFound if is_pattern(name) => error(Reason::Unsupported(
            "no such file, and a pattern cannot stand here; name one file".into(),
        )),
        reason => error(reason),
    })
}

/// The files that `argument` names, in natural order; at least one.
fn files(argument: &str) -> Result<Vec<Found>, Error> {
    let error = |reason: Reason| Error::new(argument, reason);
    if Path::new(argument).metadata().is_ok() || !is_pattern(argument) {
        return Ok(vec![file(argument)?]);
    }
    let mut files = Vec::new();
    for path in matching(argument)? {
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
