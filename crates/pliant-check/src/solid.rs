//! Closed bodies as solids: which components lie inside others, and how deep places are.
//!
//! A source is one body of the world. Pieces and groups of sources, which are not, get a world of
//! their own for this, of the same triangles in double precision. A place is as deep as the
//! deepest vertex inside the other body that edges between vertices inside link with it.

use crate::any_world::AnyWorld;
use crate::bodies::Bodies;
use crate::filter::Filter;
use crate::places::{Place, Places};
use crate::sequence::Sequence;
use crate::union_find::{find, join};
use crate::with_world;
use pliant::{BodyId, Contained, Error, Options, Selection, Watertight, World};
use pliant_io::Body as Source;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};

/// Component of a body that lies inside another body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Nested {
    /// Body with the component.
    pub body: u32,
    /// The component, as [`pliant::World::components`] numbers it.
    pub component: u32,
    /// How many components the body has.
    pub components: u32,
    /// Body that it lies inside.
    pub inside: u32,
}

/// Components inside bodies in one frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Inside {
    /// All that lie inside a body, sorted.
    pub all: Vec<Nested>,
    /// Bodies that are not closed, so that nothing is said to lie inside them; ascending.
    pub open: Vec<u32>,
}

/// The caller's stop callback.
type Question<'q> = Option<&'q (dyn Fn() -> bool + Sync)>;

/// Stands for a callback that was not given.
const NEVER: fn() -> bool = || false;

/// World of pieces and groups.
pub(crate) struct PieceWorld {
    world: World<f64>,
    /// Body of the world for each body; empty if none of them is closed.
    ids: Vec<BodyId>,
    /// Source and vertices of each body.
    vertices: Vec<(usize, Vec<u32>)>,
    /// Bodies that are not closed.
    open: Vec<u32>,
}

impl PieceWorld {
    /// Makes the world of the bodies that sources are split into, whose meshes stay.
    fn new(sources: &[Source], bodies: &Bodies, options: Options) -> Result<Self, Error> {
        let mut world = World::with_options(options);
        let (mut ids, mut vertices, mut are_closed) = (Vec::new(), Vec::new(), Vec::new());
        let mut meshes = Vec::new();
        for (number, source) in sources.iter().enumerate() {
            let first = bodies.of_source(number).start;
            let mut triangles = vec![Vec::new(); bodies.of_source(number).len()];
            for (&corners, triangle) in source.triangles().iter().zip(0..) {
                if let Some(body) = bodies.of_triangle(number as u32, triangle) {
                    triangles[(body - first) as usize].push(corners);
                }
            }
            for triangles in triangles {
                are_closed.push(Watertight::of(&triangles).is_closed());
                meshes.push((number, triangles));
            }
        }
        // Nothing can lie inside what is open, and open bodies may be very many.
        if are_closed.contains(&true) {
            for (number, mut triangles) in meshes {
                let mut own: Vec<u32> = triangles.as_flattened().to_vec();
                own.sort_unstable();
                own.dedup();
                let place = |vertex: u32| own.partition_point(|&it| it < vertex) as u32;
                for corners in &mut triangles {
                    *corners = corners.map(place);
                }
                ids.push(world.add(&triangles, &positions_of(&sources[number], &own))?);
                vertices.push((number, own));
            }
        }
        let open = (0..).zip(&are_closed).filter(|(_, is)| !**is);
        Ok(Self {
            world,
            ids,
            vertices,
            open: open.map(|(body, _)| body).collect(),
        })
    }

    fn go_to(&mut self, sources: &[Source]) -> Result<(), Error> {
        for (&id, (source, own)) in self.ids.iter().zip(&self.vertices) {
            let positions = positions_of(&sources[*source], own);
            self.world.set_positions(id, &positions)?;
        }
        Ok(())
    }
}

fn positions_of(source: &Source, vertices: &[u32]) -> Vec<[f64; 3]> {
    let positions = source.positions();
    vertices
        .iter()
        .map(|&vertex| positions.get(vertex))
        .collect()
}

/// Finds what lies inside bodies that may meet, in the frame that the sequence is in.
pub(crate) fn inside(
    sequence: &mut Sequence,
    (bodies, filter, options): (&Bodies, &Filter, Options),
    pieces: &mut Option<PieceWorld>,
    stop: Question,
) -> Result<Inside, Error> {
    let number = |ids: &[BodyId], id: BodyId| ids.partition_point(|&it| it < id) as u32;
    let (all, open, ids) = if bodies.are_split() {
        let pieces = match pieces {
            Some(known) => {
                known.go_to(&sequence.sources)?;
                known
            }
            None => pieces.insert(PieceWorld::new(&sequence.sources, bodies, options)?),
        };
        let (all, _) = contained(&mut pieces.world, stop)?;
        (all, pieces.open.clone(), &pieces.ids)
    } else {
        let Sequence { world, ids, .. } = sequence;
        let (all, open) = with_world!(world, world => contained(world, stop))?;
        let open = open.into_iter().map(|id| number(ids, id));
        (all, open.collect(), &*ids)
    };
    let nested = all.into_iter().map(|(it, components)| Nested {
        body: number(ids, it.body),
        component: it.component,
        components,
        inside: number(ids, it.inside),
    });
    let all = nested
        .filter(|it| filter.meet(it.body, it.inside))
        .collect();
    Ok(Inside { all, open })
}

/// Components inside bodies, each with the number of components of its body; and open bodies.
type Contents = (Vec<(Contained, u32)>, Vec<BodyId>);

fn contained<S: pliant::Scalar>(world: &mut World<S>, stop: Question) -> Result<Contents, Error> {
    let found = world
        .interruptible(stop.unwrap_or(&NEVER))
        .contained(Selection::World)?;
    let mut counts: BTreeMap<BodyId, u32> = BTreeMap::new();
    let mut all = Vec::with_capacity(found.all.len());
    for it in found.all {
        let count = match counts.entry(it.body) {
            Entry::Occupied(known) => *known.get(),
            Entry::Vacant(new) => {
                let components = world.components(it.body)?;
                let last = components.into_iter().filter(|&it| it != u32::MAX).max();
                *new.insert(last.map_or(0, |last| last + 1))
            }
        };
        all.push((it, count));
    }
    Ok((all, found.open))
}

/// Says how deep each place of the frame is: places that [`Places`] has just ended.
///
/// Sources are solids; their pieces are not told apart. So a place within one source has no depth,
/// nor has one of sources that are open.
pub(crate) fn say_depths(
    sequence: &mut Sequence,
    (known, places): (&Places, &mut [Place]),
    stop: Question,
) -> Result<(), Error> {
    let Sequence {
        world,
        ids,
        sources,
        ..
    } = sequence;
    let mut vertices: BTreeMap<usize, Vec<[u32; 2]>> = BTreeMap::new();
    for &(vertex, number) in known.vertices() {
        vertices.entry(number).or_default().push(vertex);
    }
    let by_number: BTreeMap<usize, usize> = places
        .iter()
        .enumerate()
        .map(|(place, it)| (it.number, place))
        .collect();
    // Places by the two sources that meet there.
    let mut meet: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for (number, vertices) in &vertices {
        let there: BTreeSet<u32> = vertices.iter().map(|&[source, _]| source).collect();
        for &a in &there {
            let others = there.iter().filter(|&&b| b != a);
            others.for_each(|&b| meet.entry([a, b]).or_default().push(*number));
        }
    }
    for ([a, b], numbers) in meet {
        let [id_a, id_b] = [ids[a as usize], ids[b as usize]];
        let Some(depths) = depths(world, [id_a, id_b], stop)? else {
            continue;
        };
        let triangles = sources[a as usize].triangles();
        let mut parents: Vec<u32> = (0..depths.len() as u32).collect();
        let is_in = |vertex: u32| depths[vertex as usize] > 0.0;
        for &[p, q, r] in triangles {
            for [from, to] in [[p, q], [q, r], [r, p]] {
                if is_in(from) && is_in(to) {
                    join(&mut parents, from, to);
                }
            }
        }
        let mut deepest = vec![0.0_f64; depths.len()];
        for vertex in (0..depths.len() as u32).filter(|&it| is_in(it)) {
            let root = &mut deepest[find(&mut parents, vertex) as usize];
            *root = root.max(depths[vertex as usize]);
        }
        for number in numbers {
            let of_a = vertices[&number]
                .iter()
                .filter(|it| it[0] == a && is_in(it[1]));
            let depth = of_a.fold(0.0, |m: f64, it| {
                m.max(deepest[find(&mut parents, it[1]) as usize])
            });
            let known = &mut places[by_number[&number]].depth;
            *known = Some(known.map_or(depth, |known| known.max(depth)));
        }
    }
    Ok(())
}

/// Depths of the vertices of a body inside another; none if that is not closed.
fn depths(
    world: &mut AnyWorld,
    [a, b]: [BodyId; 2],
    stop: Question,
) -> Result<Option<Vec<f64>>, Error> {
    with_world!(world, world => {
        if !world.watertight(b)?.is_closed() {
            return Ok(None);
        }
        let depth = world.interruptible(stop.unwrap_or(&NEVER)).depth(a, b)?;
        Ok(Some(depth.of_vertices))
    })
}
