//! Changes of a list of hits from one step to the next: hits that began, persist, ended.
//!
//! Idea: one merge of two sorted lists. Invariant: a hit keeps its number while it is in every list
//! and its things are the same, whatever numbers an edit gives these. The caller holds the state,
//! so a world has no hidden history.

use crate::edit::Edited;
use crate::ids::BodyId;
use crate::queries::{
    AdjacentContact, CloseEdgeEdge, CloseTriangles, CloseVertexTriangle, Contact, CrossingEdge,
    EdgeEdge, EdgeEdgeImpact, Pair, VertexTriangle, VertexTriangleImpact,
};
use crate::world::{Fused, Piece};
use std::collections::BTreeMap;
use std::marker::PhantomData;

/// Kind of a thing that a hit names by its number in a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Thing {
    /// A triangle.
    Triangle,
    /// A vertex.
    Vertex,
    /// An edge, as [`World::edges`](crate::World::edges) numbers it.
    Edge,
}

/// Hit of a query: two things, each with a body and its number there. All hits are.
pub trait Listed {
    /// Kinds of the two things.
    const THINGS: [Thing; 2];

    /// The two things, in the order in which the hit names them.
    fn things(&self) -> [(BodyId, u32); 2];
}

macro_rules! listed {
    ($($hit:ty: [$a:ident, $b:ident] $(. $pair:ident)?;)*) => {
        $(impl Listed for $hit {
            const THINGS: [Thing; 2] = [Thing::$a, Thing::$b];

            #[inline]
            fn things(&self) -> [(BodyId, u32); 2] {
                let [body_a, a, body_b, b] = (*self) $(. $pair)? .into();
                [(BodyId(body_a), a), (BodyId(body_b), b)]
            }
        })*
    };
}

listed! {
    Pair: [Triangle, Triangle];
    Contact: [Triangle, Triangle] .pair;
    AdjacentContact: [Triangle, Triangle] .pair;
    CrossingEdge: [Edge, Triangle];
    VertexTriangle: [Vertex, Triangle];
    EdgeEdge: [Edge, Edge];
    CloseVertexTriangle: [Vertex, Triangle] .pair;
    CloseEdgeEdge: [Edge, Edge] .pair;
    CloseTriangles: [Triangle, Triangle] .pair;
    VertexTriangleImpact: [Vertex, Triangle] .pair;
    EdgeEdgeImpact: [Edge, Edge] .pair;
}

/// Two things of one hit as one number, in the order of lists. Of one kind, the lower comes first.
type Key = u128;

fn key(kinds: [Thing; 2], things: [(BodyId, u32); 2]) -> Key {
    let [mut a, mut b] = things.map(|(body, number)| u64::from(body.0) << 32 | u64::from(number));
    if kinds[0] == kinds[1] && a > b {
        std::mem::swap(&mut a, &mut b);
    }
    Key::from(a) << 64 | Key::from(b)
}

fn things(key: Key) -> [(BodyId, u32); 2] {
    let thing = |bits: u64| (BodyId((bits >> 32) as u32), bits as u32);
    [thing((key >> 64) as u64), thing(key as u64)]
}

/// Memory of the last list of hits, to which the next is compared.
///
/// It compares lists of one kind and of one question. Each hit has a number, from 0 on, which it
/// keeps while it persists and which is never used again. A list is a set: any order will do, and
/// the sorted one of [`Query::all`](crate::Query::all) is quickest.
///
/// ```
/// # use pliant::{BodyId, Changes, Pair};
/// # let (body_a, body_b) = (BodyId(0), BodyId(1));
/// # let pair = |triangle_a| Pair { body_a, triangle_a, body_b, triangle_b: 0 };
/// let mut changes = Changes::new();
/// changes.update(&[pair(3), pair(5)]);
/// let changed = changes.update(&[pair(4), pair(5)]);
/// assert_eq!(changed.numbers, [2, 1]); // the second persists
/// assert_eq!(changed.began, [0]);
/// assert_eq!(changed.ended[0].number, 0);
/// ```
///
/// Things keep their numbers when a mesh is edited, except where a number is used again. Tell it
/// of each edit between two lists: [`edited`](Self::edited), [`split`](Self::split),
/// [`fused`](Self::fused), or [`follow`](Self::follow) for numbers of edges and of your own.
///
/// Memory: some 100 bytes a hit of the longest list.
#[derive(Clone, Debug)]
pub struct Changes<H> {
    rows: RowChanges,
    kind: PhantomData<fn(&H)>,
}

/// [`Changes`] of rows, whose kinds of things are known when the program runs, for bindings.
#[derive(Clone, Debug)]
#[doc(hidden)]
pub struct RowChanges {
    kinds: [Thing; 2],
    memory: Memory,
}

/// Memory of hits of any kind.
#[derive(Clone, Debug, Default)]
struct Memory {
    /// Hits of the last list and their numbers, sorted unless things were renamed since.
    before: Vec<(Key, u64)>,
    /// Number of the next hit that begins.
    next: u64,
    /// Hits with things that are gone since the last list.
    gone: Vec<Ended>,
    /// Scratch: hits of the new list with their places in it, and then with their numbers.
    places: Vec<(Key, usize)>,
    now: Vec<(Key, u64)>,
    numbers: Vec<u64>,
    began: Vec<usize>,
    ended: Vec<Ended>,
}

/// Changes from the last list of hits to a new one. Hits of it that did not begin persist.
#[derive(Clone, Copy, Debug)]
pub struct Changed<'c> {
    /// Number of each hit, in the order of the new list.
    pub numbers: &'c [u64],
    /// Places in the new list of the hits that began, ascending.
    pub began: &'c [usize],
    /// Hits that ended, in the order of lists.
    pub ended: &'c [Ended],
}

/// A hit that ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Ended {
    /// Number that it had.
    pub number: u64,
    /// The two things, by the numbers that they had last. Of one kind, the lower comes first.
    pub things: [(BodyId, u32); 2],
}

impl<H: Listed> Default for Changes<H> {
    fn default() -> Self {
        Self {
            rows: RowChanges::new(H::THINGS),
            kind: PhantomData,
        }
    }
}

impl<H: Listed> Changes<H> {
    /// Memory of no hits: all of the first list begin.
    pub fn new() -> Self {
        Self::default()
    }

    /// Compares a list with the last one, and remembers it.
    ///
    /// A hit that is listed twice is one. Cost: O(n) for sorted lists, some nanoseconds a hit.
    pub fn update(&mut self, list: &[H]) -> Changed<'_> {
        self.rows.update(list.iter().map(Listed::things))
    }

    /// Notes an edit of a body between two lists: numbers that were removed or used again are other
    /// things.
    ///
    /// Hits with these end, though another under the same numbers may begin. Numbers of edges are
    /// not in an [`Edited`]: see [`follow`](Self::follow). Cost: O(n log n) for n hits.
    pub fn edited(&mut self, body: BodyId, edited: &Edited) {
        self.rows.edited(body, edited);
    }

    /// Notes that [`World::split`](crate::World::split) made pieces of a body. Numbers of edges are
    /// not in a [`Piece`]: hits with edges of these pieces end.
    pub fn split(&mut self, body: BodyId, pieces: &[Piece]) {
        self.rows.split(body, pieces);
    }

    /// Notes that [`World::fuse`](crate::World::fuse) put body `gone` into `kept`. Numbers of edges
    /// are not in a [`Fused`]: hits with edges of `gone` end.
    pub fn fused(&mut self, kept: BodyId, gone: BodyId, fused: &Fused) {
        self.rows.fused(kept, gone, fused);
    }

    /// Renames things between two lists: the numbers of a thing from now on, or none if it is
    /// gone. Hits with things that are gone end at the next list.
    ///
    /// ```
    /// # use pliant::{Changes, EdgeEdge, Thing};
    /// # let (mut changes, body) = (Changes::<EdgeEdge>::new(), pliant::BodyId(0));
    /// # let (before, after) = (vec![[0_u32, 1]], vec![[0_u32, 2]]);
    /// // Edges before and after an edit of a body, as `World::edges` gives them.
    /// changes.follow(|_, of, edge| {
    ///     let place = edge as usize;
    ///     let ends = before.get(place);
    ///     let is_same = of != body || ends.is_some() && ends == after.get(place);
    ///     is_same.then_some((of, edge))
    /// });
    /// ```
    ///
    /// Cost: two calls for each hit of the last list.
    pub fn follow(&mut self, new: impl FnMut(Thing, BodyId, u32) -> Option<(BodyId, u32)>) {
        self.rows.follow(new);
    }
}

impl RowChanges {
    /// Memory of no hits.
    pub fn new(kinds: [Thing; 2]) -> Self {
        Self {
            kinds,
            memory: Memory::default(),
        }
    }

    /// [`Changes::update`].
    pub fn update(&mut self, list: impl Iterator<Item = [(BodyId, u32); 2]>) -> Changed<'_> {
        let keys = list.map(|things| key(self.kinds, things));
        self.memory.places.clear();
        self.memory.places.extend(keys.zip(0..));
        self.memory.compare()
    }

    /// [`Changes::edited`].
    pub fn edited(&mut self, body: BodyId, edited: &Edited) {
        let is_other = |thing: Thing, number: u32| {
            let lists = match thing {
                Thing::Triangle => [&edited.new_triangles, &edited.removed_triangles],
                Thing::Vertex => [&edited.new_vertices, &edited.removed_vertices],
                Thing::Edge => return false,
            };
            lists.iter().any(|list| list.binary_search(&number).is_ok())
        };
        self.follow(|thing, of, number| {
            (of != body || !is_other(thing, number)).then_some((of, number))
        });
    }

    /// Notes an edit by the ends of a body's edges before and after it. An edge is the same if its
    /// number has the same two.
    pub fn edges_edited(&mut self, body: BodyId, before: &[[u32; 2]], after: &[[u32; 2]]) {
        self.follow(|thing, of, number| {
            let ends = before.get(number as usize);
            let is_same = ends.is_some() && ends == after.get(number as usize);
            (thing != Thing::Edge || of != body || is_same).then_some((of, number))
        });
    }

    /// [`Changes::split`].
    pub fn split(&mut self, body: BodyId, pieces: &[Piece]) {
        let triangles = new_numbers(pieces, |piece| &piece.triangles);
        let vertices = new_numbers(pieces, |piece| &piece.vertices);
        self.follow(|thing, of, number| {
            let places = match thing {
                Thing::Triangle => &triangles,
                Thing::Vertex => &vertices,
                Thing::Edge => return Some((of, number)),
            };
            let place = places.get(&number).filter(|_| of == body);
            Some(place.copied().unwrap_or((of, number)))
        });
    }

    /// [`Changes::fused`].
    pub fn fused(&mut self, kept: BodyId, gone: BodyId, fused: &Fused) {
        self.follow(|thing, of, number| {
            if of != gone {
                return Some((of, number));
            }
            let new = match thing {
                Thing::Triangle => &fused.triangles,
                Thing::Vertex => &fused.vertices,
                Thing::Edge => return None,
            };
            let new = *new.get(number as usize)?;
            (new != u32::MAX).then_some((kept, new))
        });
    }

    /// [`Changes::follow`].
    pub fn follow(&mut self, mut new: impl FnMut(Thing, BodyId, u32) -> Option<(BodyId, u32)>) {
        let Memory { before, gone, .. } = &mut self.memory;
        before.retain_mut(|(known, number)| {
            let [a, b] = things(*known);
            let [kind_a, kind_b] = self.kinds;
            let both = new(kind_a, a.0, a.1).zip(new(kind_b, b.0, b.1));
            match both {
                Some((a, b)) => *known = key(self.kinds, [a, b]),
                None => gone.push(Ended {
                    number: *number,
                    things: things(*known),
                }),
            }
            both.is_some()
        });
    }
}

impl Memory {
    /// Compares the new list, as `places` has it, with the last one, and remembers it.
    fn compare(&mut self) -> Changed<'_> {
        let Self {
            before,
            next,
            gone,
            places,
            now,
            numbers,
            began,
            ended,
        } = self;
        sort(places);
        sort(before);
        numbers.clear();
        numbers.resize(places.len(), 0);
        now.clear();
        began.clear();
        ended.clear();
        let end = |&(known, number): &(Key, u64)| Ended {
            number,
            things: things(known),
        };
        let mut old = before.iter().peekable();
        for &(hit, place) in &*places {
            while let Some(gone) = old.next_if(|(known, _)| *known < hit) {
                ended.push(end(gone));
            }
            let number = if let Some(&(last, number)) = now.last()
                && last == hit
            {
                number
            } else if let Some(&(_, number)) = old.next_if(|(known, _)| *known == hit) {
                now.push((hit, number));
                number
            } else {
                began.push(place);
                now.push((hit, *next));
                *next += 1;
                *next - 1
            };
            numbers[place] = number;
        }
        ended.extend(old.map(end));
        if !gone.is_empty() {
            ended.append(gone);
            ended.sort_unstable_by_key(|ended| (ended.things, ended.number));
        }
        sort(began);
        std::mem::swap(before, now);
        Changed {
            numbers,
            began,
            ended,
        }
    }
}

/// New body and number of each thing of some pieces, by its old number.
fn new_numbers(pieces: &[Piece], old: impl Fn(&Piece) -> &[u32]) -> BTreeMap<u32, (BodyId, u32)> {
    let mut all = BTreeMap::new();
    for piece in pieces {
        let places = old(piece).iter().copied().zip(0..);
        all.extend(places.map(|(number, place)| (number, (piece.body, place))));
    }
    all
}

/// Sorts a list that mostly is in order.
fn sort<T: Ord>(list: &mut [T]) {
    if !list.is_sorted() {
        list.sort_unstable();
    }
}
