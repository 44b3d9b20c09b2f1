//! Arguments: the file, pattern, body, group or cache that a command-line argument names.
//!
//! ```text
//! shirt.obj            a file
//! shirt_*.obj          the files that match, in natural order
//! scene.glb#arm        the body of this name in a file that holds several
//! shirt_*.obj#collar   the group of this name in each of the files (OBJ or STL)
//! shirt.obj+walk.pc2   the mesh before the last `+`, the positions behind it
//! ```
//!
//! An existing file of exactly that name wins, so that `scan[1].obj` can be read without escapes.
//! Files must exist and be regular before any is opened: a pipe would block, and can be read only
//! once.

use std::path::{Path, PathBuf};

use crate::error::{Error, Reason};
use crate::file::Found;
use crate::format::Format;
use crate::groups::holds_one_body;
use crate::natural;
use crate::pattern::{is_pattern, matching};

/// The files that an argument names, found.
#[derive(Debug)]
pub(crate) enum Named {
    /// Frames of a body, in order; at least one file.
    Files(Vec<Found>),
    /// One body of a file that holds several.
    Body { file: Found, name: String },
    /// A group of the body whose frames are in these files.
    Group { files: Vec<Found>, name: String },
    /// A mesh, and the positions of its vertices.
    Cache { mesh: Found, positions: Found },
}

/// Parses `argument` and finds its files.
pub(crate) fn named(argument: &str) -> Result<Named, Error> {
    let named = |name: &str| name.to_owned();
    match read(argument) {
        Meant::Files => frames(argument).map(Named::Files),
        Meant::Cache { mesh, positions } => Ok(Named::Cache {
            mesh: file(mesh)?,
            positions: file(positions)?,
        }),
        Meant::Part { path, name, format } if format.holds_bodies() => Ok(Named::Body {
            file: file(path)?,
            name: named(name),
        }),
        Meant::Part { path, name, format } if format.holds_groups() => Ok(Named::Group {
            files: frames(path)?,
            name: named(name),
        }),
        Meant::Part { path, name, .. } => Err(Error::new(path, holds_one_body(name))),
    }
}

/// Finds the files that an argument names, in the order in which they are read.
///
/// Of a mesh and its positions both; files that a glTF file keeps data in are not among them.
///
/// # Errors
///
/// As [`open_all`](crate::open_all), of files that are not there. No file is opened.
pub fn files(argument: &str) -> Result<Vec<PathBuf>, Error> {
    let found = match named(argument)? {
        Named::Files(files) | Named::Group { files, .. } => files,
        Named::Body { file, .. } => vec![file],
        Named::Cache { mesh, positions } => vec![mesh, positions],
    };
    let path = |it: &Found| it.path().to_owned();
    Ok(found.iter().map(path).collect())
}

/// Splits an argument that names a group of an OBJ or STL file into file and group.
///
/// The file may be a pattern. None for any other argument. Arguments that name groups of one file
/// are best opened as one body, the file: triangles that share a vertex are then known to.
///
/// ```
/// assert_eq!(pliant_io::group_argument("walk_*.obj#arm"), Some(("walk_*.obj", "arm")));
/// assert_eq!(pliant_io::group_argument("scene.glb#arm"), None);
/// ```
pub fn group_argument(argument: &str) -> Option<(&str, &str)> {
    match read(argument) {
        Meant::Part { path, name, format } if format.holds_groups() => Some((path, name)),
        _ => None,
    }
}

/// The syntax of an argument.
enum Meant<'a> {
    Files,
    Part {
        path: &'a str,
        name: &'a str,
        format: Format,
    },
    Cache {
        mesh: &'a str,
        positions: &'a str,
    },
}

/// Parses an argument; looks at which files exist where the syntax is ambiguous.
fn read(argument: &str) -> Meant<'_> {
    if Path::new(argument).exists() {
        return Meant::Files;
    }
    let part = file_and_name(argument);
    let holds_it = part.is_some_and(|(path, ..)| is_file(path));
    if let Some((mesh, positions)) = cache(argument)
        && (is_file(positions) || !holds_it)
    {
        return Meant::Cache { mesh, positions };
    }
    match part {
        // For a missing file, its own message says most. A pattern may contain a `#`.
        Some((path, name, format))
            if format.holds_bodies()
                || Path::new(path).exists()
                || format.holds_groups() && is_pattern(path) =>
        {
            Meant::Part { path, name, format }
        }
        _ => Meant::Files,
    }
}

/// Splits `scene.glb#arm` into file, name of the part, and format of the file.
///
/// Folders and bodies may have a `#` in their names. Of the places to split, the first where there
/// is a file wins.
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

/// Splits `shirt.obj+walk.pc2` into mesh and positions.
///
/// Folders may have a `+` in their names: a split into two existing files is preferred.
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

/// Splits `shirt.obj+walk.pc2` at its last `+` into mesh and positions.
pub(crate) fn mesh_and_positions(argument: &str) -> Option<(&str, &str)> {
    let (mesh, positions) = argument.rsplit_once('+')?;
    as_cache(mesh, positions)
}

/// Returns mesh and positions if the positions have the ending of a cache and the mesh has a name.
fn as_cache<'a>(mesh: &'a str, positions: &'a str) -> Option<(&'a str, &'a str)> {
    let is_cache = Format::of(Path::new(positions)).is_ok_and(Format::is_cache);
    (is_cache && !mesh.is_empty()).then_some((mesh, positions))
}

/// Finds one file of exactly this name.
fn file(name: &str) -> Result<Found, Error> {
    let error = |reason: Reason| Error::new(name, reason);
    Found::find(name.into()).map_err(|reason| match reason {
        Reason::NotFound if is_pattern(name) => error(Reason::Unsupported(
            "no such file, and a pattern cannot stand here; name one file".into(),
        )),
        reason => error(reason),
    })
}

/// Finds the files that `argument` names, in natural order; at least one.
fn frames(argument: &str) -> Result<Vec<Found>, Error> {
    let error = |reason: Reason| Error::new(argument, reason);
    if Path::new(argument).metadata().is_ok() || !is_pattern(argument) {
        return Ok(vec![file(argument)?]);
    }
    let mut files = Vec::new();
    for path in matching(argument)? {
        match path.metadata() {
            // A pattern for files may match folders beside them.
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
