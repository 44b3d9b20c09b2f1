//! Groups of triangles by name: `o` and `g` of an OBJ file, and the solids of an STL text.
//!
//! ```text
//! f ...           default            nothing was named yet
//! o shirt         shirt              an object begins, and no group of it
//! g collar        shirt/collar       a group of the object
//! g               shirt              none again; `g default` and `g shirt` say the same
//! g left cuff     shirt/left cuff    a name is the rest of its line, with one blank between words
//! o               default            no object
//! ```
//!
//! - Groups of equal names in two objects stay two. An exporter that writes `o`, or `g`, or both
//!   alike gives the names that it wrote.
//! - Equal full names are one group, however often they come back.
//! - A name stands for its group and all groups below it: `shirt` also for `shirt/collar`.
//! - A name that is not UTF-8 is read as Latin-1, so that different names stay different.
//! - Every solid is a group of its own. Without a name, or with the name of an earlier one, it gets
//!   its number: `solid 2`, `lid (solid 3)`.
//!
//! Groups are found by reading the file a second time, on request, so that other callers pay
//! nothing. A name is kept when its first face arrives: groups without faces do not exist. Memory
//! is counted before it is taken.

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::Arc;

use crate::error::{Error, Reason, listed};
use crate::memory::Account;
use crate::shown::shown;

/// Name of the group of faces that no `o` and no `g` names.
const DEFAULT: &str = "default";

/// Rough size in bytes of a map entry, beside the bytes of its name.
const ENTRY: u64 = 96;

/// Groups of an OBJ or STL file: names, and the group of each triangle.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Groups {
    file: Arc<Path>,
    /// Names of the groups, all different, in the order of their lowest triangles.
    ///
    /// Empty where the file names no group.
    pub names: Vec<String>,
    /// For each triangle the number of its group; empty where the file names none.
    pub of_triangles: Vec<u32>,
}

impl Groups {
    /// The groups of a file that names none.
    pub(crate) fn none(file: Arc<Path>) -> Self {
        Self {
            file,
            names: Vec::new(),
            of_triangles: Vec::new(),
        }
    }

    /// Whether the name `by` also stands for the group `name`: equal, or an object that it is
    /// below.
    ///
    /// ```
    /// use pliant_io::Groups;
    /// assert!(Groups::is_meant("shirt/collar", "shirt") && Groups::is_meant("shirt", "shirt"));
    /// assert!(!Groups::is_meant("shirts", "shirt") && !Groups::is_meant("shirt", "shirt/collar"));
    /// ```
    pub fn is_meant(name: &str, by: &str) -> bool {
        let rest = name.strip_prefix(by);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
    }

    /// Numbers of the groups that `name` stands for, ascending. Takes O(number of groups).
    ///
    /// # Errors
    ///
    /// [`Reason::NoBody`], which lists the names there are, or [`Reason::Unsupported`] where the
    /// file names none.
    pub fn called(&self, name: &str) -> Result<Vec<u32>, Error> {
        let numbered = self.names.iter().zip(0..);
        let meant = numbered.filter(|(known, _)| Self::is_meant(known, name));
        let meant: Vec<u32> = meant.map(|(_, number)| number).collect();
        if !meant.is_empty() {
            return Ok(meant);
        }
        let reason = if self.names.is_empty() {
            holds_one_body(name)
        } else {
            Reason::NoBody {
                name: name.to_owned(),
                names: listed(self.names.iter().map(String::as_str)),
            }
        };
        Err(Error::new(&*self.file, reason))
    }
}

/// The error for a named part of a file that is one body.
pub(crate) fn holds_one_body(name: &str) -> Reason {
    let name = shown(name);
    Reason::Unsupported(format!(
        "holds one body, not one called \"{name}\"; leave out what begins with the #"
    ))
}

/// State of the second reading: names and faces in the order of the file.
pub(crate) struct Naming {
    account: Account,
    object: Standing,
    group: String,
    /// Number of the current full name, object and group; None until a face needs it.
    number: Option<u32>,
    /// Numbers of objects by name.
    objects: HashMap<Arc<str>, u32>,
    /// Numbers of full names. The key is the number of the object, as four characters, and the name
    /// of the group.
    numbers: HashMap<Arc<str>, u32>,
    /// Full names by their number: the name of the object, and the key in `numbers`.
    called: Vec<(Arc<str>, Arc<str>)>,
    /// Names of solids.
    solids: HashSet<String>,
    are_named: bool,
    /// Reused buffer.
    key: String,
    /// Runs of faces of one name: number of the first face, and number of the name.
    runs: Vec<(u32, u32)>,
    faces: u32,
}

/// The current object.
#[derive(Default)]
struct Standing {
    name: Arc<str>,
    /// None until a face needs it.
    number: Option<u32>,
}

/// A number as four characters: a prefix of fixed length.
fn characters(number: u32) -> impl Iterator<Item = char> {
    let digits = number.to_be_bytes().into_iter();
    digits.map(char::from)
}

impl Naming {
    /// `account`: bytes already held, and the limit.
    pub(crate) fn new(account: Account) -> Self {
        Self {
            account,
            object: Standing::default(),
            group: String::new(),
            number: None,
            objects: HashMap::new(),
            numbers: HashMap::new(),
            called: Vec::new(),
            solids: HashSet::new(),
            are_named: false,
            key: String::new(),
            runs: Vec::new(),
            faces: 0,
        }
    }

    /// Begins an object; an empty name ends one.
    pub(crate) fn object(&mut self, name: String) {
        self.object = Standing {
            name: name.into(),
            number: None,
        };
        self.group.clear();
        self.number = None;
    }

    /// Begins a group of the object; an empty name ends one.
    pub(crate) fn group(&mut self, mut name: String) {
        if name == DEFAULT || *name == *self.object.name {
            name.clear();
        }
        self.group = name;
        self.number = None;
    }

    /// Begins a solid, with a name that no earlier one has.
    pub(crate) fn solid(&mut self, name: String, number: u32) -> Result<(), Reason> {
        let is_named = !name.is_empty();
        let mut own = if is_named {
            name
        } else {
            format!("solid {number}")
        };
        while !self.solids.insert(own.clone()) {
            own = format!("{own} (solid {number})");
        }
        self.account.enter(own.len() as u64 + ENTRY)?;
        self.are_named |= is_named;
        self.group = own;
        self.number = None;
        Ok(())
    }

    /// Appends a face with the current name.
    pub(crate) fn face(&mut self) -> Result<(), Reason> {
        let number = match self.number {
            Some(number) => number,
            None => self.number()?,
        };
        if self.runs.last().is_none_or(|&(_, last)| last != number) {
            let run = (self.faces, number);
            self.account.push(&mut self.runs, run, 0)?;
        }
        let more = self.faces.checked_add(1);
        self.faces = more.ok_or(Reason::TooMany { what: "faces" })?;
        Ok(())
    }

    /// Number of the current full name; a new one if the name is new.
    fn number(&mut self) -> Result<u32, Reason> {
        let object = match self.object.number {
            Some(number) => number,
            None => self.number_of_object()?,
        };
        self.key.clear();
        self.key.extend(characters(object));
        self.key.push_str(&self.group);
        let number = if let Some(&known) = self.numbers.get(&*self.key) {
            known
        } else {
            self.account.enter(self.key.len() as u64 + ENTRY)?;
            let (number, key) = (self.called.len() as u32, Arc::<str>::from(&*self.key));
            let called = (self.object.name.clone(), key.clone());
            self.account.push(&mut self.called, called, 0)?;
            self.numbers.insert(key, number);
            number
        };
        self.number = Some(number);
        Ok(number)
    }

    /// Number of the current object; objects of one name share it.
    fn number_of_object(&mut self) -> Result<u32, Reason> {
        let Self {
            object, objects, ..
        } = self;
        if let Some((name, _)) = objects.get_key_value(&*object.name) {
            object.name = name.clone();
        } else {
            self.account.enter(object.name.len() as u64 + ENTRY)?;
            let number = objects.len() as u32;
            objects.insert(object.name.clone(), number);
        }
        let number = objects[&*object.name];
        object.number = Some(number);
        Ok(number)
    }

    /// Ends the reading: groups of a body of `triangles` triangles.
    ///
    /// `polygons`: see [`Body::faces`](crate::Body::faces).
    pub(crate) fn end(
        self,
        file: Arc<Path>,
        polygons: Option<&[u32]>,
        triangles: usize,
    ) -> Result<Groups, Reason> {
        let Self {
            mut account,
            called,
            runs,
            faces,
            numbers: by_key,
            objects,
            solids,
            are_named,
            ..
        } = self;
        let solids_are = solids.len();
        drop((by_key, objects, solids));
        let last = polygons.map_or(triangles.checked_sub(1), |it| {
            it.last().map(|&p| p as usize)
        });
        if last != (faces as usize).checked_sub(1) {
            return Err(Reason::Changed);
        }
        let mut names: Vec<String> = Vec::new();
        for (object, key) in called {
            let behind = key.char_indices().nth(4).map_or(key.len(), |(at, _)| at);
            let group = &key[behind..];
            // Before the name is made: one long object name may belong to very many groups.
            account.enter(2 * (object.len() + group.len()) as u64 + ENTRY)?;
            names.push(match (&*object, group) {
                ("", "") => DEFAULT.to_owned(),
                (name, "") | ("", name) => name.to_owned(),
                (object, group) => format!("{object}/{group}"),
            });
        }
        // Different keys may give equal full names, though few do.
        let mut known: HashMap<&str, u32> = HashMap::with_capacity(names.len());
        let (mut numbers, mut is_new) = (Vec::new(), Vec::new());
        for name in &names {
            let next = known.len() as u32;
            let number = *known.entry(name).or_insert(next);
            account.push(&mut numbers, number, 0)?;
            account.push(&mut is_new, number == next, 0)?;
        }
        let mut is_new = is_new.into_iter();
        names.retain(|_| is_new.next() == Some(true));
        let is_one_solid = solids_are == 1 && !are_named;
        if names == [DEFAULT] || is_one_solid {
            return Ok(Groups::none(file));
        }
        account.enter(triangles as u64 * size_of::<u32>() as u64)?;
        let mut of_triangles = Vec::new();
        let reserved = of_triangles.try_reserve_exact(triangles);
        reserved.map_err(|_| Reason::OutOfMemory)?;
        let (mut runs, mut number) = (runs.into_iter().peekable(), 0);
        for triangle in 0..triangles {
            let face = polygons.map_or(triangle as u32, |polygons| polygons[triangle]);
            while let Some((_, next)) = runs.next_if(|&(first, _)| first <= face) {
                number = numbers[next as usize];
            }
            of_triangles.push(number);
        }
        Ok(Groups {
            file,
            names,
            of_triangles,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Fault;
    use crate::{obj, stl};

    fn groups_within(limit: u64, text: impl AsRef<[u8]>) -> Result<Groups, Fault> {
        let mut naming = Naming::new(Account::new(limit));
        obj::name_faces(text.as_ref(), &mut naming)?;
        let faces = naming.faces as usize;
        Ok(naming.end(Path::new("a.obj").into(), None, faces)?)
    }

    /// The group name of each face.
    fn named(text: impl AsRef<[u8]>) -> Vec<String> {
        let Groups {
            names,
            of_triangles,
            ..
        } = groups_within(1 << 20, text).unwrap();
        assert!(
            of_triangles
                .iter()
                .all(|&group| (group as usize) < names.len())
        );
        let first = |number: u32| of_triangles.iter().position(|&group| group == number);
        let firsts: Vec<_> = (0..names.len() as u32).map(first).collect();
        assert!(firsts.is_sorted() && firsts.iter().all(Option::is_some));
        let name = |&group: &u32| names[group as usize].clone();
        of_triangles.iter().map(name).collect()
    }

    #[test]
    fn a_group_has_the_name_of_its_object_and_its_own() {
        let text = "f 1 2 3\no shirt\nf 1 2 3\ng collar\nf 1 2 3\ng\nf 1 2 3\n\
            g left cuff\nf 1 2 3\no trousers\nf 1 2 3\ng collar\nf 1 2 3\n\
            g default\nf 1 2 3\ng trousers\nf 1 2 3\no\nf 1 2 3\n\
            g collar\nf 1 2 3\no shirt\nf 1 2 3\n";
        let names = [
            "default",
            "shirt",
            "shirt/collar",
            "shirt",
            "shirt/left cuff",
            "trousers",
            "trousers/collar",
            "trousers",
            "trousers",
            "default",
            "collar",
            "shirt",
        ];
        assert_eq!(named(text), names);
    }

    /// Texts as exporters write them.
    #[test]
    fn names_are_those_that_were_written() {
        for (text, names) in [
            // Blender: objects; objects with groups for materials.
            (
                "o Cube\ns 0\nusemtl A\nf 1 2 3\no Ball\nf 1 2 3",
                &["Cube", "Ball"][..],
            ),
            (
                "o Cube\ng Cube_A\nf 1 2 3\ng Cube_B\nf 1 2 3",
                &["Cube/Cube_A", "Cube/Cube_B"],
            ),
            // Maya: a group of vertices first.
            (
                "g default\nv 0 0 0\ns 1\ng pSphere1\nf 1 2 3\ng default\ng pCube1\nf 1 2 3",
                &["pSphere1", "pCube1"],
            ),
            // 3ds Max: object and group of one name.
            (
                "o Box001\ng Box001\nf 1 2 3\no Box002\ng Box002\nf 1 2 3",
                &["Box001", "Box002"],
            ),
            // SketchUp: several names in a line.
            (
                "g Mesh1 Seat Model\nf 1 2 3\ng Mesh2 Seat Model\nf 1 2 3",
                &["Mesh1 Seat Model", "Mesh2 Seat Model"],
            ),
            ("g 1\nf 1 2 3\ng 2\nfo 1 2 3", &["1", "2"]),
            (
                "o  a\t b  \r\nf 1 2 3\r\ng c \\\n  d\r\nf 1 2 3",
                &["a b", "a b/c d"],
            ),
            (
                "o Cube #2 # copy\nf 1 2 3\no Cube #3\nf 1 2 3",
                &["Cube #2 # copy", "Cube #3"],
            ),
            ("# o no\nog no\no yes\nf 1 2 3", &["yes"]),
        ] {
            assert_eq!(named(text), names, "{text}");
        }
    }

    #[test]
    fn solids_are_groups_of_their_own() {
        let facet =
            "facet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
        let named = |text: &str| {
            let mut naming = Naming::new(Account::new(1 << 20));
            stl::name_faces(text.as_bytes(), text.len() as u64, &mut naming).unwrap();
            let faces = naming.faces as usize;
            let groups = naming.end(Path::new("a.stl").into(), None, faces);
            let Groups {
                names,
                of_triangles,
                ..
            } = groups.unwrap();
            let name = |&group: &u32| names[group as usize].clone();
            of_triangles.iter().map(name).collect::<Vec<_>>()
        };
        for (solids, names) in [
            (&["a", "left  cuff", "b"][..], &["a", "left cuff", "b"][..]),
            (&["", "", ""], &["solid 1", "solid 2", "solid 3"]),
            (&["a", "a", ""], &["a", "a (solid 2)", "solid 3"]),
            (&["solid 2", ""], &["solid 2", "solid 2 (solid 2)"]),
            (&["default", "a"], &["default", "a"]),
            (&["a"], &["a"]),
            (&[""], &[]),
        ] {
            for end in ["endsolid", "END SOLID", "end solid x"] {
                let solid = |name: &&str| format!("SOLID {name}\n{facet}{end}\n");
                let text: String = solids.iter().map(solid).collect();
                assert_eq!(named(&text), names, "{text}");
            }
        }
        // Solids of two triangles each, the first of none.
        let text =
            format!("solid x\nendsolid\nsolid a\n{facet}{facet}endsolid\nsolid b\n{facet}{facet}");
        assert_eq!(named(&text), ["a", "a", "b", "b"]);
    }

    #[test]
    fn names_that_are_no_text_stay_different() {
        let text = b"o \xe4\nf 1 2 3\no \xf6\nf 1 2 3\no \xc3\xa4\nf 1 2 3\n";
        assert_eq!(named(text), ["ä", "ö", "ä"]);
    }

    #[test]
    fn where_nothing_is_named_there_are_no_groups() {
        for text in [
            "f 1 2 3\nf 1 2 3",
            "o\ng\nf 1 2 3\ng default\nf 1 2 3\no later",
            "",
        ] {
            if !text.is_empty() {
                assert_eq!(named(text), [""; 0], "{text}");
            }
        }
        let none = Groups::none(Path::new("a.obj").into());
        let refused = none.called("arm").unwrap_err().to_string();
        assert_eq!(
            refused,
            "a.obj: holds one body, not one called \"arm\"; leave out what begins with the #"
        );
    }

    #[test]
    fn a_name_stands_for_what_is_below_it() {
        let text = "o arm\nf 1 2 3\no legs\nf 1 2 3\ng left\nf 1 2 3\no arm\ng hand\nf 1 2 3\n";
        let groups = groups_within(1 << 20, text).unwrap();
        assert_eq!(groups.names, ["arm", "legs", "legs/left", "arm/hand"]);
        for (name, meant) in [("arm", &[0, 3][..]), ("arm/hand", &[3]), ("legs", &[1, 2])] {
            assert_eq!(groups.called(name).unwrap(), meant);
        }
        for name in ["", "leg", "arm/", "hand", "left"] {
            let refused = groups.called(name).unwrap_err().to_string();
            let words = format!("has no body \"{name}\"; it has: arm, legs, legs/left, arm/hand");
            assert!(refused.contains(&words), "{refused}");
        }
    }

    #[test]
    fn triangles_have_the_group_of_their_polygon() {
        let mut naming = Naming::new(Account::new(1 << 20));
        let text = "o a\nf 1 2 3 4 5\ng b\nf 1 2 3\nf 1 2 3 4\no a\nf 1 2 3\n";
        obj::name_faces(text.as_bytes(), &mut naming).unwrap();
        let polygons = [0, 0, 0, 1, 2, 2, 3];
        let file: Arc<Path> = Path::new("a.obj").into();
        let groups = naming.end(file.clone(), Some(&polygons), 7).unwrap();
        assert_eq!(groups.of_triangles, [0, 0, 0, 1, 1, 1, 0]);
        // Numbers of faces that differ from the first reading.
        for (polygons, count) in [(Some(&polygons[..5]), 5), (None, 3), (None, 0)] {
            let mut naming = Naming::new(Account::new(1 << 20));
            obj::name_faces(text.as_bytes(), &mut naming).unwrap();
            let ended = naming.end(file.clone(), polygons, count);
            assert!(matches!(ended, Err(Reason::Changed)), "{ended:?}");
        }
    }

    #[test]
    fn names_are_counted_and_what_has_no_faces_is_none() {
        // A million groups without faces.
        let empty = "g a\ng b\n".repeat(500_000) + "f 1 2 3\n";
        assert_eq!(groups_within(1 << 10, empty).unwrap().names, ["b"]);
        // Very many groups of one face each.
        let group = |n: u32| format!("g {n}\nf 1 2 3\n");
        let many = (0..10_000).map(group).collect::<Vec<_>>().concat();
        assert_eq!(groups_within(8 << 20, &many).unwrap().names.len(), 10_000);
        let refused = groups_within(1 << 20, &many).unwrap_err();
        assert!(
            matches!(refused.reason, Reason::TooLarge { .. }),
            "{refused:?}"
        );
        // An object with a long name, which each of its groups would repeat.
        let long = format!("o {}\n", "x".repeat(1 << 20));
        let refused = groups_within(1 << 26, long + &many).unwrap_err();
        assert!(
            matches!(refused.reason, Reason::TooLarge { .. }),
            "{refused:?}"
        );
    }
}
