//! Arguments opened as sources, and the groups of a source that are asked for.
//!
//! Arguments that name groups of one OBJ file, `scan.obj#arm` and `scan.obj#leg`, are one source.
//! It is the whole file, of which only these groups take part. So seams are welded, and triangles
//! that share a vertex are left out, across its groups. The source has the position of the first
//! such argument, and its spelling of the file's name.

use crate::error::Error;
use pliant_io::{Body as Source, Files, group_argument};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};

/// Sources, and the groups that are asked of each.
pub(crate) struct Opened {
    pub(crate) sources: Vec<Source>,
    /// Names of the groups that take part, by source. A source without an entry takes part as a
    /// whole.
    pub(crate) named: BTreeMap<usize, Vec<String>>,
}

impl Opened {
    /// Sources that take part as a whole.
    pub(crate) fn whole(sources: Vec<Source>) -> Self {
        Self {
            sources,
            named: BTreeMap::new(),
        }
    }

    /// Opens the files that `arguments` name among `among`.
    pub(crate) fn of(
        arguments: &[String],
        among: &Files,
        mut open: impl FnMut(&String) -> Result<Vec<Source>, pliant_io::Error>,
    ) -> Result<Self, Error> {
        let mut opened = Self::whole(Vec::new());
        // Sources of the files whose groups are named.
        let mut files: BTreeMap<PathBuf, usize> = BTreeMap::new();
        for argument in arguments {
            let Some((file, name)) = group_argument(argument, among) else {
                opened.sources.extend(open(argument)?);
                continue;
            };
            let path = among.one_spelling(Path::new(file));
            let source = match files.entry(path) {
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
