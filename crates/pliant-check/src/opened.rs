//! What arguments name, as sources; and which groups of a source are asked for.
//!
//! Arguments that name groups of one OBJ file, `scan.obj#arm` and `scan.obj#leg`, are one source, the whole file, of which only these
//! groups take part. So what is known of a mesh holds across its groups: seams are welded, and triangles that share a vertex are left
//! out. The source stands where the first of them does, and is called as that one calls the file.

use crate::error::Error;
use pliant_io::{Body as Source, group_argument};
use std::path::{Path, PathBuf};

/// Sources, and what is asked of each.
pub(crate) struct Opened {
    pub(crate) sources: Vec<Source>,
    /// For each the names of the groups that take part; none where all of it does.
    pub(crate) named: Vec<Vec<String>>,
}

impl Opened {
    /// Sources all of which take part.
    pub(crate) fn whole(sources: Vec<Source>) -> Self {
        let named = vec![Vec::new(); sources.len()];
        Self { sources, named }
    }

    /// Opens what `arguments` name.
    pub(crate) fn of(
        arguments: &[String],
        mut open: impl FnMut(&String) -> Result<Vec<Source>, pliant_io::Error>,
    ) -> Result<Self, Error> {
        let mut opened = Self::whole(Vec::new());
        // Files of which groups are named, with the numbers of their sources.
        let mut files: Vec<(PathBuf, usize)> = Vec::new();
        for argument in arguments {
            let Some((file, name)) = group_argument(argument) else {
                opened.sources.extend(open(argument)?);
                opened.named.resize(opened.sources.len(), Vec::new());
                continue;
            };
            let place = place(file);
            let source = if let Some((_, source)) = files.iter().find(|(known, _)| *known == place)
            {
                *source
            } else {
                files.push((place, opened.sources.len()));
                opened.sources.extend(open(&file.to_owned())?);
                opened.named.resize(opened.sources.len(), Vec::new());
                opened.sources.len() - 1
            };
            opened.named[source].push(name.to_owned());
        }
        Ok(opened)
    }
}

/// The same for every way to name a file, or a pattern in a folder.
fn place(file: &str) -> PathBuf {
    let path = Path::new(file);
    let in_folder = || {
        let folder = match path.parent()? {
            folder if folder.as_os_str().is_empty() => Path::new("."),
            folder => folder,
        };
        Some(folder.canonicalize().ok()?.join(path.file_name()?))
    };
    let found = path.canonicalize().ok().or_else(in_folder);
    found.unwrap_or_else(|| path.to_owned())
}
