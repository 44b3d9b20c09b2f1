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
use crate::files::{Files, Kind};
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

/// Parses `argument` and finds its files among `files`.
pub(crate) fn named(argument: &str, files: &Files) -> Result<Named, Error> {
    let named = |name: &str| name.to_owned();
    match read(argument, files) {
        Meant::Files => frames(argument, files).map(Named::Files),
        Meant::Cache { mesh, positions } => Ok(Named::Cache {
            mesh: file(mesh, files)?,
            positions: file(positions, files)?,
        }),
        Meant::Part { path, name, format } if format.holds_bodies() => Ok(Named::Body {
            file: file(path, files)?,
            name: named(name),
        }),
        Meant::Part { path, name, format } if format.holds_groups() => Ok(Named::Group {
            files: frames(path, files)?,
            name: named(name),
        }),
        Meant::Part { path, name, .. } => Err(Error::new(path, holds_one_body(name))),
    }
}

/// Finds the files that an argument names among `files`, in the order in which they are read.
///
/// Of a mesh and its positions both; files that a glTF file keeps data in are not among them.
///
/// # Errors
///
/// As [`open_all`](crate::open_all), of files that are not there. No file is opened.
pub fn files(argument: &str, files: &Files) -> Result<Vec<PathBuf>, Error> {
    let found = match named(argument, files)? {
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
/// use pliant_io::{Files, group_argument};
/// let files = Files::default();
/// assert_eq!(group_argument("walk_*.obj#arm", &files), Some(("walk_*.obj", "arm")));
/// assert_eq!(group_argument("scene.glb#arm", &files), None);
/// ```
pub fn group_argument<'a>(argument: &'a str, files: &Files) -> Option<(&'a str, &'a str)> {
    match read(argument, files) {
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
fn read<'a>(argument: &'a str, files: &Files) -> Meant<'a> {
    if files.exists(argument.as_ref()) {
        return Meant::Files;
    }
    let part = file_and_name(argument, files);
    let holds_it = part.is_some_and(|(path, ..)| files.is_file(path.as_ref()));
    if let Some((mesh, positions)) = cache(argument, files)
        && (files.is_file(positions.as_ref()) || !holds_it)
    {
        return Meant::Cache { mesh, positions };
    }
    match part {
        // For a missing file, its own message says most. A pattern may contain a `#`.
        Some((path, name, format))
            if format.holds_bodies()
                || files.exists(path.as_ref())
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
fn file_and_name<'a>(argument: &'a str, files: &Files) -> Option<(&'a str, &'a str, Format)> {
    let cut = |(at, _)| {
        let (path, name): (&str, &str) = (&argument[..at], &argument[at + 1..]);
        Some((path, name, Format::of(Path::new(path)).ok()?))
    };
    let cuts = || argument.match_indices('#').filter_map(cut);
    cuts()
        .find(|(path, ..)| files.is_file(path.as_ref()))
        .or_else(|| cuts().next())
}

/// Splits `shirt.obj+walk.pc2` into mesh and positions.
///
/// Folders may have a `+` in their names: a split into two existing files is preferred.
fn cache<'a>(argument: &'a str, files: &Files) -> Option<(&'a str, &'a str)> {
    let cut = |(at, _): (usize, &str)| as_cache(&argument[..at], &argument[at + 1..]);
    let is_file = |path: &str| files.is_file(path.as_ref());
    let are_files = |(mesh, positions): &(&str, &str)| is_file(mesh) && is_file(positions);
    let mut cuts = argument.match_indices('+').filter_map(cut);
    cuts.find(are_files)
        .or_else(|| mesh_and_positions(argument))
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
fn file(name: &str, files: &Files) -> Result<Found, Error> {
    let error = |reason: Reason| Error::new(name, reason);
    files.find(name.into()).map_err(|reason| match reason {
        Reason::NotFound if is_pattern(name) => error(Reason::Unsupported(
            "no such file, and a pattern cannot stand here; name one file".into(),
        )),
        reason => error(reason),
    })
}

/// Finds the files that `argument` names, in natural order; at least one.
fn frames(argument: &str, files: &Files) -> Result<Vec<Found>, Error> {
    if files.exists(argument.as_ref()) || !is_pattern(argument) {
        return Ok(vec![file(argument, files)?]);
    }
    let mut found = Vec::new();
    for path in matching(argument, files)? {
        match files.kind(&path) {
            // A pattern for files may match folders beside them.
            Ok(Kind::Folder) => {}
            Ok(Kind::File | Kind::Other) => {
                let file = files.find(path.clone());
                found.push(file.map_err(|reason| Error::new(path, reason))?);
            }
            Err(other) => return Err(Error::new(path, Reason::Io(other))),
        }
    }
    if found.is_empty() {
        return Err(Error::new(argument, Reason::NoMatch));
    }
    found.sort_by(|a, b| natural::compare(a.path(), b.path()));
    Ok(found)
}
