//! What arguments name, as sources; and which groups of a source are asked for.
//!
//! Arguments that name groups of one OBJ file, `scan.obj#arm` and `scan.obj#leg`, are one source, the whole file, of which only these
//! groups take part. So what is known of a mesh holds across its groups: seams are welded, and triangles that share a vertex are left
//! out. The source stands where the first of them does, and is called as that one calls the file.

use crate::error::Error;
use pliant_io::{Body as Source, group_argument};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};

/// Sources, and what is asked of each.
pub(crate) struct Opened {
    pub(crate) sources: Vec<Source>,
    /// Of a source of which only some groups take part, their names.
    pub(crate) named: BTreeMap<usize, Vec<String>>,
}

impl Opened {
    /// Sources all of which take part.
    pub(crate) fn whole(sources: Vec<Source>) -> Self {
        Self {
            sources,
            named: BTreeMap::new(),
        }
    }

    /// Opens what `arguments` name.
    pub(crate) fn of(
        arguments: &[String],
        mut open: impl FnMut(&String) -> Result<Vec<Source>, pliant_io::Error>,
    ) -> Result<Self, Error> {
        let mut opened = Self::whole(Vec::new());
        // Files of which groups are named, with the numbers of their sources.
        let mut files: BTreeMap<PathBuf, usize> = BTreeMap::new();
        for argument in arguments {
            let Some((file, name)) = group_argument(argument) else {
                opened.sources.extend(open(argument)?);
                continue;
            };
            let place = place(file);
            let source = match files.entry(place) {
                Entry::Occupied(known) => *known.get(),
                Entry::Vacant(new) => {
                    let source = *new.insert(opened.sources.len());
                    opened.sources.extend(open(&file.to_owned())?);
                    source
                }
            };
            opened
                .named
                .entry(source)
                .or_default()
                .push(name.to_owned());
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
