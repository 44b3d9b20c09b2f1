//! Which bodies may meet: names, groups of names, and ignored pairs of names.
//!
//! Bodies to which the same names apply form a *class*. Whether two bodies meet depends on their
//! classes alone. So an ignored pair costs one entry, even if its names stand for thousands of
//! pieces of a file.

use crate::bodies::Bodies;
use crate::error::{Error, quoted};
use crate::settings::Group;
use pliant_io::Body as Source;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::ops::Range;

/// Pairs of bodies that do not meet, stored by class.
#[derive(Debug, Default)]
pub(crate) struct Filter {
    /// Class of each body; empty if all are of class 0.
    classes: Vec<u32>,
    /// Pairs of classes that do not meet, the smaller first.
    ignored: BTreeSet<[u32; 2]>,
}

impl Filter {
    /// Resolves the names in `ignore`. Refuses unknown names.
    pub(crate) fn new(names: &Names, ignore: &[[String; 2]]) -> Result<Self, Error> {
        if ignore.is_empty() {
            return Ok(Self::default());
        }
        let mut terms: Vec<&str> = ignore.as_flattened().iter().map(String::as_str).collect();
        terms.sort_unstable();
        terms.dedup();

        let mut classes = vec![0; names.bodies.count() as usize];
        // Terms that apply to the bodies of each class.
        let mut terms_of: Vec<Vec<&str>> = vec![Vec::new()];
        for term in terms {
            // A term splits each class into bodies to which it applies and others.
            let mut parted = BTreeMap::new();
            for body in names.all(term)? {
                let class = &mut classes[body as usize];
                *class = *parted.entry(*class).or_insert_with(|| {
                    let more = [&terms_of[*class as usize][..], &[term]].concat();
                    terms_of.push(more);
                    terms_of.len() as u32 - 1
                });
            }
        }
        let called = |term: &String| -> Vec<u32> {
            let is_called = |class: &u32| terms_of[*class as usize].contains(&term.as_str());
            (0..terms_of.len() as u32).filter(is_called).collect()
        };
        let mut ignored = BTreeSet::new();
        for [a, b] in ignore {
            let (of_a, of_b) = (called(a), called(b));
            ignored.extend(
                of_a.iter()
                    .flat_map(|&a| of_b.iter().map(move |&b| [a.min(b), a.max(b)])),
            );
        }
        Ok(Self { classes, ignored })
    }

    /// Whether two bodies, or a body and itself, may meet.
    pub(crate) fn meet(&self, a: u32, b: u32) -> bool {
        self.lets_all_meet() || self.classes_meet(self.class(a), self.class(b))
    }

    /// Whether no pair of bodies is ignored.
    pub(crate) fn lets_all_meet(&self) -> bool {
        self.ignored.is_empty()
    }

    /// Whether any body of one range may meet any of another.
    pub(crate) fn any_meet(&self, some: Range<u32>, others: Range<u32>) -> bool {
        if self.lets_all_meet() {
            return true;
        }
        let classes =
            |bodies: Range<u32>| -> BTreeSet<u32> { bodies.map(|body| self.class(body)).collect() };
        let others = classes(others);
        classes(some)
            .into_iter()
            .any(|a| others.iter().any(|&b| self.classes_meet(a, b)))
    }

    fn class(&self, body: u32) -> u32 {
        self.classes.get(body as usize).copied().unwrap_or(0)
    }

    fn classes_meet(&self, a: u32, b: u32) -> bool {
        !self.ignored.contains(&[a.min(b), a.max(b)])
    }
}

/// Part of a name behind its folder; `None` without a folder.
fn without_folder(name: &str) -> Option<&str> {
    // The name of a body behind the `#` may have a slash.
    let file = name.split('#').next().unwrap_or(name);
    let end_of_folder = file.rfind(std::path::is_separator)?;
    Some(&name[end_of_folder + 1..])
}

/// Resolver of names to bodies.
pub(crate) struct Names<'a> {
    pub(crate) sources: &'a [Source],
    pub(crate) bodies: &'a Bodies,
    groups: BTreeMap<&'a str, Vec<u32>>,
}

impl<'a> Names<'a> {
    pub(crate) fn new(
        sources: &'a [Source],
        bodies: &'a Bodies,
        groups: &'a [Group],
    ) -> Result<Self, Error> {
        let mut names = Self {
            sources,
            bodies,
            groups: BTreeMap::new(),
        };
        for Group { name, bodies } in groups {
            let bad = |why| Error::BadGroup {
                name: name.clone(),
                why,
            };
            if name.is_empty() {
                return Err(bad("its name is empty; give it one"));
            }
            if names.groups.contains_key(name.as_str()) {
                return Err(bad(
                    "a group of this name is there already; name all its bodies at once, or choose \
                     another name",
                ));
            }
            if name.bytes().all(|c| c.is_ascii_digit()) {
                return Err(bad(
                    "a number stands for the body of that number; choose another name",
                ));
            }
            if names.of_bodies(name).is_some() {
                return Err(bad("a body is called so; choose another name"));
            }
            if bodies.is_empty() {
                let name = name.clone();
                return Err(Error::EmptyGroup { name });
            }
            let mut members = Vec::new();
            for body in bodies {
                let of_name = names.of_bodies(body);
                members.extend(of_name.ok_or_else(|| names.unknown("body", body))?);
            }
            names.groups.insert(name, members);
        }
        Ok(names)
    }

    /// All bodies of a group, a file, a source or a body of this name.
    fn all(&self, name: &str) -> Result<Vec<u32>, Error> {
        match self.groups.get(name) {
            Some(members) => Ok(members.clone()),
            None => self
                .of_bodies(name)
                .ok_or_else(|| self.unknown("body or group", name)),
        }
    }

    /// Bodies that a name stands for, by the first rule that finds any; `None` if no rule does.
    ///
    /// 1. a source of this name, then an argument (a glTF file) of this name
    /// 2. a piece or groups of a source, named behind a `#`
    /// 3. the number of a body
    ///
    /// A file may be named without its folder, if no other file has the same name.
    pub(crate) fn of_bodies(&self, name: &str) -> Option<Vec<u32>> {
        let with = |is: &dyn Fn(&Source) -> bool| -> Vec<usize> {
            let places = 0..self.sources.len();
            places.filter(|&place| is(&self.sources[place])).collect()
        };
        let files_called = |name: &str, whole: fn(&Source) -> &str| {
            let sources = with(&|source| without_folder(whole(source)) == Some(name));
            let mut arguments = sources.iter().map(|&at| self.sources[at].argument());
            let first = arguments.next();
            let is_one = arguments.all(|argument| Some(argument) == first);
            if is_one { sources } else { Vec::new() }
        };
        let called = |name: &str| match with(&|source| source.name() == name) {
            none if none.is_empty() => files_called(name, Source::name),
            sources => sources,
        };
        let of_argument = |name: &str| match with(&|source| source.argument() == name) {
            none if none.is_empty() => files_called(name, Source::argument),
            sources => sources,
        };
        for sources in [called(name), of_argument(name)] {
            let whole = sources
                .into_iter()
                .flat_map(|source| self.bodies.of_source(source));
            let whole: Vec<u32> = whole.collect();
            if !whole.is_empty() {
                return Some(whole);
            }
        }
        for (at, _) in name.match_indices('#') {
            let parts = called(&name[..at])
                .into_iter()
                .flat_map(|source| self.bodies.called(source, &name[at + 1..]));
            let parts: Vec<u32> = parts.collect();
            if !parts.is_empty() {
                return Some(parts);
            }
        }
        let number = name.parse().ok()?;
        (number < self.bodies.count()).then(|| vec![number])
    }

    /// The one body that a name stands for; of several, the one with exactly this name.
    pub(crate) fn of_body(&self, name: &str) -> Option<u32> {
        let bodies = self.of_bodies(name)?;
        if let [body] = bodies[..] {
            return Some(body);
        }
        let is_called = |&body: &u32| self.bodies.facts(self.sources, body).name == name;
        let mut called = bodies.into_iter().filter(is_called);
        called.next().filter(|_| called.next().is_none())
    }

    pub(crate) fn unknown(&self, wanted: &'static str, name: &str) -> Error {
        /// Most names listed in a message, which has one line.
        const MOST: u32 = 20;
        let count = self.bodies.count();
        let mut there = "bodies: ".to_owned();
        for body in 0..count.min(MOST) {
            let separator = if body > 0 { ", " } else { "" };
            let name = self.bodies.facts(self.sources, body).name;
            let _ = write!(there, "{separator}{body} = {}", quoted(&name));
        }
        if count > MOST {
            let _ = write!(there, ", and {} more", count - MOST);
        }
        let groups = self.groups.len().saturating_sub(MOST as usize);
        for (number, group) in self.groups.keys().take(MOST as usize).enumerate() {
            let separator = if number > 0 { ", " } else { "; groups: " };
            let _ = write!(there, "{separator}{}", quoted(group));
        }
        if groups > 0 {
            let _ = write!(there, ", and {groups} more");
        }
        Error::NoSuchName {
            wanted,
            name: name.to_owned(),
            there,
        }
    }
}
