//! Files that arguments name: the system's, or some in memory.
//!
//! Names, folders and patterns mean the same in both. In memory `/` parts folders, and one exists
//! where a file is in it. A `/` before all is passed over, and `..` goes back a folder. There are
//! no links, pipes or changes.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use crate::error::{Error, Reason};
use crate::file::{Bytes, Found};

/// Files that arguments name: by default the system's, or some in memory.
///
/// Clones share the bytes, which do not count towards
/// [`max_memory`](crate::OpenOptions::max_memory).
///
/// ```
/// use pliant_io::{Files, OpenOptions};
///
/// let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
/// let dropped = [1, 2].map(|frame| (format!("walk_{frame}.obj"), triangle.into()));
/// let options = OpenOptions {
///     files: Files::in_memory(dropped)?,
///     ..OpenOptions::default()
/// };
/// assert_eq!(pliant_io::open("walk_*.obj", &options)?.frame_count(), 2);
/// # Ok::<(), pliant_io::Error>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Files(Option<Arc<BTreeMap<PathBuf, Bytes>>>);

/// The kind of what has a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    File,
    Folder,
    Other,
}

impl From<fs::FileType> for Kind {
    fn from(kind: fs::FileType) -> Self {
        match kind {
            _ if kind.is_file() => Self::File,
            _ if kind.is_dir() => Self::Folder,
            _ => Self::Other,
        }
    }
}

impl Files {
    /// Files in memory, by name.
    ///
    /// # Errors
    ///
    /// Two names mean one file, as `a.obj` and `./a.obj` do.
    pub fn in_memory<N: Into<PathBuf>>(
        files: impl IntoIterator<Item = (N, Vec<u8>)>,
    ) -> Result<Self, Error> {
        let mut all = BTreeMap::new();
        for (name, bytes) in files {
            let name = name.into();
            if all.insert(plain(&name), Bytes::from(bytes)).is_some() {
                let why = "two files in memory have this name; give each a name of its own";
                return Err(Error::new(name, Reason::Unsupported(why.into())));
            }
        }
        Ok(Self(Some(Arc::new(all))))
    }

    /// A name that is equal for every spelling of a file, or of a pattern in a folder.
    pub fn one_spelling(&self, path: &Path) -> PathBuf {
        if self.0.is_some() || IS_SEALED {
            return plain(path);
        }
        let in_folder = || {
            let folder = or_here(path.parent()?);
            Some(folder.canonicalize().ok()?.join(path.file_name()?))
        };
        let found = path.canonicalize().ok().or_else(in_folder);
        found.unwrap_or_else(|| path.to_owned())
    }

    /// The kind of what has this name, at the end of all links; an error where nothing has it.
    pub(crate) fn kind(&self, path: &Path) -> io::Result<Kind> {
        match &self.0 {
            None => Ok(path.metadata()?.file_type().into()),
            Some(files) => in_memory(files, path).ok_or_else(|| io::ErrorKind::NotFound.into()),
        }
    }

    /// [`kind`](Self::kind), but of a link itself: it is neither file nor folder.
    pub(crate) fn kind_of_itself(&self, path: &Path) -> io::Result<Kind> {
        match &self.0 {
            None => Ok(path.symlink_metadata()?.file_type().into()),
            Some(_) => self.kind(path),
        }
    }

    pub(crate) fn is_folder(&self, path: &Path) -> bool {
        self.kind(path).is_ok_and(|kind| kind == Kind::Folder)
    }

    pub(crate) fn is_file(&self, path: &Path) -> bool {
        self.kind(path).is_ok_and(|kind| kind == Kind::File)
    }

    pub(crate) fn exists(&self, path: &Path) -> bool {
        self.kind(path).is_ok()
    }

    /// Names in a folder; the empty path is the current folder.
    pub(crate) fn names(&self, folder: &Path) -> io::Result<Vec<OsString>> {
        let Some(files) = &self.0 else {
            let folder = or_here(folder);
            return fs::read_dir(folder)?
                .map(|entry| Ok(entry?.file_name()))
                .collect();
        };
        let folder = plain(folder);
        let first = |path: &Path| Some(path.components().next()?.as_os_str().to_owned());
        let below = files.keys().filter_map(|path| {
            let rest = path.strip_prefix(&folder).ok()?;
            first(rest)
        });
        let mut names: Vec<OsString> = below.collect();
        names.dedup();
        Ok(names)
    }

    /// Finds a regular file.
    pub(crate) fn find(&self, path: PathBuf) -> Result<Found, Reason> {
        let Some(files) = &self.0 else {
            return Found::on_disk(path);
        };
        match in_memory(files, &path) {
            Some(Kind::File) => Ok(Found::in_memory(files[&plain(&path)].clone(), path)),
            Some(_) => Err(Reason::Directory),
            None => Err(Reason::NotFound),
        }
    }

    /// Finds a file that another one names, in the folder of that one or below.
    ///
    /// A folder from strangers may hold links to files that are no part of any shape.
    pub(crate) fn find_below(&self, folder: &Path, path: PathBuf) -> Result<Found, Reason> {
        if self.0.is_some() || IS_SEALED {
            return self.find(path);
        }
        let real = match path.canonicalize() {
            Err(absent) if absent.kind() == io::ErrorKind::NotFound => {
                return Err(Reason::NotFound);
            }
            real => real?,
        };
        if real.starts_with(or_here(folder).canonicalize()?) {
            return self.find(real);
        }
        Err(Reason::Unsupported(
            "a link leads out of the folder of the glTF file, and is not followed; \
             copy the file there, or export all as .glb"
                .into(),
        ))
    }
}

/// Whether the program sees nothing but the folders that it was given, and cannot ask where a link
/// leads.
const IS_SEALED: bool = cfg!(target_os = "wasi");

/// The kind of what has this name in memory.
fn in_memory(files: &BTreeMap<PathBuf, Bytes>, path: &Path) -> Option<Kind> {
    let asks_for_folder = path.to_string_lossy().ends_with('/');
    let path = plain(path);
    if files.contains_key(&path) {
        return (!asks_for_folder).then_some(Kind::File);
    }
    // Names are in order, and what is in a folder comes behind it.
    let first = files.range(path.clone()..).next();
    let is_in_it = |(file, _): &(&PathBuf, &Bytes)| file.starts_with(&path);
    (path.as_os_str().is_empty() || first.is_some_and(|it| is_in_it(&it))).then_some(Kind::Folder)
}

/// The path without what does not change it: `./a//b`, `/a/b` and `c/../a/b` are `a/b`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir | Component::RootDir => {}
            Component::ParentDir if plain.pop() => {}
            other => plain.push(other),
        }
    }
    plain
}

/// The folder, where the empty path is the current one.
pub(crate) fn or_here(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_memory_are_like_names_on_disk() {
        let names = ["b/c.obj", "./b.obj", "/b/d/e.obj", "b-1.obj"];
        let files = Files::in_memory(names.map(|name| (name, name.as_bytes().to_vec()))).unwrap();
        // On disk the same, in one folder.
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir_all(folder.path().join("b/d")).unwrap();
        for name in names {
            fs::write(folder.path().join(name.trim_start_matches('/')), "").unwrap();
        }
        let disk = |name: &str| Files::default().kind(&folder.path().join(name)).ok();
        for name in [
            "b/c.obj",
            "b.obj",
            "b.obj/",
            "b",
            "b/",
            "b/d/../c.obj",
            "b/c",
            "b/c.obj/d",
        ] {
            assert_eq!(files.kind(name.as_ref()).ok(), disk(name), "{name}");
        }
        for name in ["b/c.obj", "b.obj", "./b//d/e.obj", "b-1.obj", "b/../b.obj"] {
            assert!(files.is_file(name.as_ref()), "{name}");
            assert!(files.find(name.into()).is_ok(), "{name}");
        }
        for folder in ["", ".", "b", "b/", "b/d", "/"] {
            assert!(files.is_folder(folder.as_ref()), "{folder}");
            let found = files.find(folder.into());
            assert!(matches!(found, Err(Reason::Directory)), "{folder}");
        }
        for nothing in ["b/c", "b/c.obj/d", "a", "c.obj"] {
            assert!(!files.exists(nothing.as_ref()), "{nothing}");
            let found = files.find(nothing.into());
            assert!(matches!(found, Err(Reason::NotFound)), "{nothing}");
        }
        let sorted = |folder: &str| {
            let mut names = files.names(folder.as_ref()).unwrap();
            names.sort();
            names
        };
        assert_eq!(sorted(""), ["b", "b-1.obj", "b.obj"]);
        assert_eq!(sorted("./b"), ["c.obj", "d"]);
        let none = Files::in_memory::<PathBuf>([]).unwrap();
        assert!(!none.exists("a".as_ref()) && none.is_folder("".as_ref()));
        let twice = Files::in_memory(["a.obj", "./a.obj"].map(|name| (name, Vec::new())));
        let error = twice.unwrap_err().to_string();
        assert!(error.contains("./a.obj: two files"), "{error}");
        for spelling in ["./b/c.obj", "b/d/../c.obj"] {
            assert_eq!(files.one_spelling(spelling.as_ref()), Path::new("b/c.obj"));
        }
        assert!(Files::default() != files && files == files.clone());
    }
}
