//! Glob patterns for file names, matched as in shells.
//!
//! `*` and `?` match no leading dot and do not cross folders. `**` is any number of folders; links
//! to folders are not followed, so it ends. File names are bytes on most systems and need not be
//! text: `*` and `?` match invalid bytes like any character.

use std::path::{Component, Path, PathBuf};

use glob::{MatchOptions, Pattern};

use crate::error::{Error, Reason};
use crate::files::{Files, Kind, or_here};

const AS_IN_SHELLS: MatchOptions = MatchOptions {
    case_sensitive: true,
    require_literal_separator: true,
    require_literal_leading_dot: true,
};

/// One segment of a pattern: a name, a pattern for names, or `**`.
enum Segment {
    Literal(PathBuf),
    Names(Pattern),
    Folders,
}

/// Whether any character has a special meaning in patterns.
pub(crate) fn is_pattern(text: &str) -> bool {
    Pattern::escape(text) != text
}

/// Files, folders and everything else that matches a pattern, in no order.
pub(crate) fn matching(pattern: &str, files: &Files) -> Result<Vec<PathBuf>, Error> {
    let segments = segments(pattern)?;
    let mut found = Vec::new();
    walk(files, PathBuf::new(), &segments, &mut found)?;
    Ok(found)
}

/// Splits a pattern into its segments.
fn segments(pattern: &str) -> Result<Vec<Segment>, Error> {
    let mut segments: Vec<Segment> = Vec::new();
    for component in Path::new(pattern).components() {
        let text = component.as_os_str().to_str().unwrap_or_default();
        segments.push(match component {
            Component::Normal(_) if text == "**" => Segment::Folders,
            Component::Normal(_) if is_pattern(text) => {
                let bad = |bad: glob::PatternError| Error::new(pattern, Reason::Pattern(bad.msg));
                Segment::Names(Pattern::new(text).map_err(bad)?)
            }
            _ => Segment::Literal(component.as_os_str().into()),
        });
    }
    Ok(segments)
}

/// Appends to `found` everything below `folder` that matches the remaining segments.
fn walk(
    files: &Files,
    folder: PathBuf,
    segments: &[Segment],
    found: &mut Vec<PathBuf>,
) -> Result<(), Error> {
    let Some((segment, rest)) = segments.split_first() else {
        found.push(folder);
        return Ok(());
    };
    match segment {
        Segment::Literal(name) => {
            let path = folder.join(name);
            let is_there = if rest.is_empty() {
                files.kind_of_itself(&path).is_ok()
            } else {
                files.is_folder(&path)
            };
            if is_there {
                walk(files, path, rest, found)?;
            }
        }
        Segment::Names(pattern) => {
            for name in names(files, &folder)? {
                if pattern.matches_with(&name.to_string_lossy(), AS_IN_SHELLS) {
                    let path = folder.join(name);
                    if rest.is_empty() || files.is_folder(&path) {
                        walk(files, path, rest, found)?;
                    }
                }
            }
        }
        Segment::Folders => {
            // Without this segment, and with one folder more before it.
            walk(files, folder.clone(), rest, found)?;
            for name in names(files, &folder)? {
                let path = folder.join(&name);
                let is_hidden = name.to_string_lossy().starts_with('.');
                let kind = files.kind_of_itself(&path).ok();
                if kind == Some(Kind::Folder) && !is_hidden {
                    walk(files, path, segments, found)?;
                }
            }
        }
    }
    Ok(())
}

/// Names in a folder; the empty path is the current folder.
fn names(files: &Files, folder: &Path) -> Result<Vec<std::ffi::OsString>, Error> {
    let names = files.names(folder);
    names.map_err(|error| Error::new(or_here(folder), Reason::Io(error)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// Creates these files in a new folder; returns the names that the pattern matches there,
    /// sorted. In memory it matches the same.
    fn found(files: &[&str], pattern: &str) -> Vec<String> {
        let folder = tempfile::tempdir().unwrap();
        for file in files {
            let path = folder.path().join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        let within = folder.path().to_str().unwrap();
        let on_disk = format!("{}/{pattern}", Pattern::escape(within));
        let all = matching(&on_disk, &Files::default()).unwrap();
        let name = |path: &PathBuf| path.strip_prefix(within).unwrap().to_str().unwrap().into();
        let mut names: Vec<String> = all.iter().map(name).collect();
        names.sort();
        let memory = Files::in_memory(files.iter().map(|&file| (file, Vec::new()))).unwrap();
        let mut in_memory = matching(pattern, &memory).unwrap();
        in_memory.sort();
        assert!(
            in_memory
                .iter()
                .map(PathBuf::as_path)
                .eq(names.iter().map(Path::new))
        );
        names
    }

    #[test]
    fn patterns_are_read_as_in_shells() {
        let files = &[
            "a1.obj",
            "a2.obj",
            "b1.obj",
            ".a3.obj",
            "c/a4.obj",
            "c/d/a5.obj",
            ".e/a6.obj",
        ];
        assert_eq!(found(files, "a*.obj"), ["a1.obj", "a2.obj"]);
        assert_eq!(found(files, "?1.obj"), ["a1.obj", "b1.obj"]);
        assert_eq!(found(files, "[!a]1.obj"), ["b1.obj"]);
        assert_eq!(found(files, "*"), ["a1.obj", "a2.obj", "b1.obj", "c"]);
        assert_eq!(found(files, ".a*"), [".a3.obj"]);
        assert_eq!(found(files, "*/a*.obj"), ["c/a4.obj"]);
        assert_eq!(found(files, "c/*/a*.obj"), ["c/d/a5.obj"]);
        let all = ["a1.obj", "a2.obj", "c/a4.obj", "c/d/a5.obj"];
        assert_eq!(found(files, "**/a*.obj"), all);
        assert!(found(files, "nobody/*.obj").is_empty());
        assert!(found(files, "a1.obj/*").is_empty());
    }

    #[test]
    fn a_pattern_that_is_none_is_refused() {
        let error = matching("a[.obj", &Files::default())
            .unwrap_err()
            .to_string();
        assert!(error.contains("a[.obj"), "{error}");
    }

    /// Linux allows any bytes in a name; other systems refuse these.
    #[cfg(target_os = "linux")]
    #[test]
    fn names_that_are_no_text_are_names() {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt;
        let folder = tempfile::tempdir().unwrap();
        for name in [&b"a\xff.obj"[..], b"a1.obj", b".\xfe.obj", b"\xfd"] {
            fs::write(folder.path().join(OsStr::from_bytes(name)), "").unwrap();
        }
        let count = |pattern: &str| {
            let pattern = format!("{}/{pattern}", folder.path().display());
            matching(&pattern, &Files::default()).unwrap().len()
        };
        assert_eq!(count("a*.obj"), 2);
        assert_eq!(count("a?.obj"), 2);
        assert_eq!(count("a1*"), 1);
        assert_eq!(count("*"), 3);
        assert_eq!(count("**/*.obj"), 2);
    }

    #[cfg(unix)]
    #[test]
    fn links_in_a_circle_end() {
        let folder = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink(folder.path(), folder.path().join("again")).unwrap();
        fs::write(folder.path().join("a.obj"), "").unwrap();
        let pattern = format!("{}/**/*.obj", folder.path().display());
        assert_eq!(matching(&pattern, &Files::default()).unwrap().len(), 1);
    }
}
