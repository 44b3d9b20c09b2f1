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
use crate::shown::shown;

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
        let part = file_and_name(argument);
        let holds_it = part.is_some_and(|(path, ..)| is_file(path));
        if let Some((mesh, positions)) = cache(argument)
            && (is_file(positions) || !holds_it)
        {
            return Ok(Named::Cache {
                mesh: file(mesh)?,
                positions: file(positions)?,
            });
        }
        if let Some((path, name, format)) = part {
            if format.holds_bodies() {
                return Ok(Named::Part {
                    file: file(path)?,
                    name: name.to_owned(),
                });
            }
            if Path::new(path).exists() {
                let reason = format!(
                    "holds one body, not one called \"{}\"; leave out what begins with the #",
                    shown(name)
                );
                return Err(Error::new(path, Reason::Unsupported(reason)));
            }
        }
    }
    files(argument).map(Named::Files)
}

/// The file, its format, and the name of a body in `scene.glb#arm`. Folders and bodies may have a `#` in their names: of the places
/// where it may end, the first where there is a file is meant.
fn file_and_name(argument: &str) -> Option<(&str, &str, Format)> {
    let cut = |(at, _)| {
        let (path, name): (&str, &str) = (&argument[..at], &argument[at + 1..]);
        Some((path, name, Format::of(Path::new(path)).ok()?))
    };
    let cuts = || argument.match_indices('#').filter_map(cut);
    cuts()
        .find(|(path, ..)| is_file(path))
        .or_else(|| cuts().next())
}

/// The two names in `shirt.obj+walk.pc2`, if folders have a `+` in theirs too: those of two files, where there are such.
fn cache(argument: &str) -> Option<(&str, &str)> {
    let cut = |(at, _): (usize, &str)| as_cache(&argument[..at], &argument[at + 1..]);
    let are_files = |(mesh, positions): &(&str, &str)| is_file(mesh) && is_file(positions);
    let mut cuts = argument.match_indices('+').filter_map(cut);
    cuts.find(are_files)
        .or_else(|| mesh_and_positions(argument))
}

/// Whether there is a file of this name, and no folder.
fn is_file(path: &str) -> bool {
    Path::new(path).is_file()
}

/// The two names in `shirt.obj+walk.pc2`.
pub(crate) fn mesh_and_positions(argument: &str) -> Option<(&str, &str)> {
    let (mesh, positions) = argument.rsplit_once('+')?;
    as_cache(mesh, positions)
}

/// A mesh and positions, if the one may be a mesh and the other is called as positions are.
fn as_cache<'a>(mesh: &'a str, positions: &'a str) -> Option<(&'a str, &'a str)> {
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
