//! Bodies of answers: a source as a whole, a connected piece of it, or a group of it.
//!
//! Pieces and groups are names for triangles: in the world each source stays one body. Its pairs
//! with itself include the pairs between its pieces. So a source of 100,000 pieces takes no more
//! memory or time than one of one piece. Triangles keep their source's numbers, and pairs that
//! share a vertex are left out across bodies too. If only some groups of a source are asked for,
//! its other triangles are of no body.

use crate::error::Error;
use crate::opened::Opened;
use crate::pieces::{NONE, Piece, Pieces};
use crate::row::Row;
use crate::settings::Split;
use pliant_io::{Body as Source, Groups};
use std::collections::BTreeMap;
use std::ops::Range;

/// Facts about a body of an answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BodyFacts {
    /// Name: the source's, and for a piece or group `#` and the piece's number, from 1, or the
    /// group's name.
    pub name: String,
    /// Number of the source.
    pub source: usize,
    /// Number of vertices; of a piece or a group, the vertices of its triangles.
    pub vertices: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Lowest triangle, as numbered in the source.
    pub first_triangle: usize,
}

/// Bodies that one source is split into.
#[derive(Debug)]
struct Parts {
    pieces: Pieces,
    /// Names of groups; `None` for connected pieces, which have numbers.
    names: Option<Vec<String>>,
    /// Whether arguments name groups of the source.
    by_name: bool,
}

/// Bodies of all sources, numbered consecutively.
#[derive(Debug)]
pub(crate) struct Bodies {
    /// Parts of each source that is not one body as a whole.
    parts: BTreeMap<usize, Parts>,
    /// First body of each source, and at the end the number of bodies: a prefix sum.
    starts: Vec<u32>,
}

impl Parts {
    /// Splits a source; `None` if it is one body. `named` are the groups that take part.
    fn of(source: &Source, named: &[String], split: Option<Split>) -> Result<Option<Self>, Error> {
        let parts = match (split, named) {
            (None, []) => None,
            (Some(Split::Components), []) => Some(Self {
                pieces: Pieces::of(source.triangles(), source.vertex_count()),
                names: None,
                by_name: false,
            }),
            (Some(Split::Components), [name, ..]) => {
                let name = format!("{}#{name}", source.name());
                return Err(Error::PiecesOfGroup { name });
            }
            // A source of one group has its triangles only, but groups are numbered as in the file.
            (Some(Split::Groups), []) if source.is_part() => None,
            (Some(Split::Groups), []) => {
                let groups = source.groups()?;
                (!groups.names.is_empty()).then(|| Self::groups(source, groups, false))
            }
            (None | Some(Split::Groups), _) => {
                let groups = some_of(source, source.groups()?, named, split.is_some())?;
                Some(Self::groups(source, groups, true))
            }
        };
        Ok(parts)
    }

    fn groups(source: &Source, groups: Groups, by_name: bool) -> Self {
        let Groups {
            names,
            of_triangles,
            ..
        } = groups;
        Self {
            pieces: Pieces::named(
                of_triangles,
                names.len(),
                source.triangles(),
                source.vertex_count(),
            ),
            names: Some(names),
            by_name,
        }
    }

    fn name(&self, piece: usize) -> String {
        match &self.names {
            None => (piece + 1).to_string(),
            Some(names) => names[piece].clone(),
        }
    }
}

/// Restricts `groups` to the named ones. `each`: every group is a body; otherwise every name is.
///
/// Other triangles are of no group.
fn some_of(
    source: &Source,
    mut groups: Groups,
    named: &[String],
    each: bool,
) -> Result<Groups, Error> {
    // Position in `named` of the name that selects each group.
    let mut by = vec![NONE; groups.names.len()];
    for (name, place) in named.iter().zip(0..) {
        for group in groups.called(name)? {
            let by = &mut by[group as usize];
            if *by != NONE {
                return Err(Error::NamedTwice {
                    file: source.name().to_owned(),
                    names: [&named[*by as usize], name].map(Clone::clone),
                    group: groups.names[group as usize].clone(),
                });
            }
            *by = place;
        }
    }
    if each {
        let mut count = 0..;
        for place in by.iter_mut().filter(|place| **place != NONE) {
            *place = count.next().unwrap_or(NONE);
        }
        let mut places = by.iter();
        groups.names.retain(|_| places.next() != Some(&NONE));
    } else {
        groups.names = named.to_vec();
    }
    for group in &mut groups.of_triangles {
        *group = by[*group as usize];
    }
    Ok(groups)
}

impl Bodies {
    pub(crate) fn of(
        Opened { sources, named }: &Opened,
        split: Option<Split>,
    ) -> Result<Self, Error> {
        let mut parts = BTreeMap::new();
        let mut starts = vec![0];
        let mut count = 0;
        for (number, source) in sources.iter().enumerate() {
            let named = named.get(&number).map_or(&[][..], |named| named);
            let into = Parts::of(source, named, split)?;
            count += into.as_ref().map_or(1, |it| it.pieces.all.len() as u32);
            starts.push(count);
            parts.extend(into.map(|into| (number, into)));
        }
        if split == Some(Split::Groups) && parts.is_empty() {
            // No error beside sources that are split: this source is then one body.
            let why = |source: &Source| Some((source.name().to_owned(), source.why_no_groups()?));
            if let Some((source_name, why)) = sources.iter().find_map(why) {
                return Err(Error::NoGroups { source_name, why });
            }
        }
        Ok(Self { parts, starts })
    }

    pub(crate) fn count(&self) -> u32 {
        self.starts.last().copied().unwrap_or(0)
    }

    /// Whether a source is split, or takes part only by some groups.
    pub(crate) fn is_split(&self, source: usize) -> bool {
        self.parts.contains_key(&source)
    }

    /// Whether a source takes part only by the groups that arguments name.
    pub(crate) fn is_by_name(&self, source: usize) -> bool {
        self.parts.get(&source).is_some_and(|parts| parts.by_name)
    }

    /// Whether any source is split.
    pub(crate) fn are_split(&self) -> bool {
        !self.parts.is_empty()
    }

    /// Numbers of the bodies of a source.
    pub(crate) fn of_source(&self, source: usize) -> Range<u32> {
        self.starts[source]..self.starts[source + 1]
    }

    pub(crate) fn source_of(&self, body: u32) -> usize {
        self.starts.partition_point(|&start| start <= body) - 1
    }

    /// Body of a triangle of a source; `None` if its group was not asked for.
    pub(crate) fn of_triangle(&self, source: u32, triangle: u32) -> Option<u32> {
        let start = self.starts[source as usize];
        let Some(Parts { pieces, .. }) = self.parts.get(&(source as usize)) else {
            return Some(start);
        };
        let piece = pieces.of_triangles[triangle as usize];
        (piece != NONE).then(|| start + piece)
    }

    /// Converts a pair of sources into a pair of bodies, the smaller first. `None` if a triangle is
    /// of no body.
    pub(crate) fn row(&self, [source_a, a, source_b, b]: Row) -> Option<Row> {
        let one = (self.of_triangle(source_a, a)?, a);
        let other = (self.of_triangle(source_b, b)?, b);
        let ((body_a, a), (body_b, b)) = (one.min(other), one.max(other));
        Some([body_a, a, body_b, b])
    }

    /// Bodies of a source by the text behind the `#`: the piece of this number, or the groups of
    /// this name.
    pub(crate) fn called(&self, source: usize, name: &str) -> Vec<u32> {
        let Some(Parts { pieces, names, .. }) = self.parts.get(&source) else {
            return Vec::new();
        };
        let of_source = self.of_source(source);
        match names {
            None => {
                let number = name.parse().ok().filter(|&number| number > 0);
                let number = number.filter(|&number: &usize| number <= pieces.all.len());
                let body = number.and_then(|number| of_source.clone().nth(number - 1));
                body.into_iter().collect()
            }
            Some(names) => {
                let named = of_source.zip(names);
                let meant = named.filter(|(_, known)| Groups::is_meant(known, name));
                meant.map(|(body, _)| body).collect()
            }
        }
    }

    pub(crate) fn facts(&self, sources: &[Source], body: u32) -> BodyFacts {
        let number = self.source_of(body);
        let source = &sources[number];
        let Some(parts) = self.parts.get(&number) else {
            return BodyFacts {
                name: source.name().to_owned(),
                source: number,
                vertices: source.vertex_count(),
                triangles: source.triangles().len(),
                first_triangle: 0,
            };
        };
        let piece = (body - self.starts[number]) as usize;
        let Piece {
            vertices,
            triangles,
            first_triangle,
        } = parts.pieces.all[piece];
        BodyFacts {
            name: format!("{}#{}", source.name(), parts.name(piece)),
            source: number,
            vertices: vertices as usize,
            triangles: triangles as usize,
            first_triangle: first_triangle as usize,
        }
    }
}
