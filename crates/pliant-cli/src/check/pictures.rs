//! Pages and pictures of a check: the pairs that it reports, in the world as the check left it.
//!
//! In a picture the bodies are the sources, and triangles have their own numbers. A page also tells
//! pieces and groups of a source apart. Both show groups that were not asked for.

use super::adjacent::AdjacentTally;
use super::arguments::{Arguments, Split};
use super::moments;
use super::names::{at_rest, labelled};
use crate::advice;
use crate::report::{Watcher, fact};
use crate::table::{grouped, short};
use pliant_check::{AnyWorld, Baseline, Check, Found, Interval, Place, Row, with_world};
use pliant_io::shown;
use pliant_report::{BodyLabel, Gap, Parts};
use std::collections::HashMap;

/// Note on a page about contacts between frames.
const BETWEEN_FRAMES: &str = "\
Between two frames every corner moves on a straight line. Where something meets on the way, and \
not in the frame already, the picture has a frame more. It lists what meets, the earliest first, \
and shows the bodies at the contact that is chosen, with the triangles there in red, and the \
vertex (as a cross), the edges or the triangle that meet drawn over everything.";

/// Note on a page about depths.
const DEPTHS: &str = "\
The colour of a place is its depth: how far the deepest vertex there is inside the other body, and \
0 if none is. What intersects and has no depth is red, as within one file, or where no body is \
closed.";

/// Page and picture of one check.
pub(super) struct Pictures {
    watcher: Watcher,
    way: Way,
    adjacent: AdjacentTally,
}

/// Totals over all intervals between frames.
#[derive(Default)]
struct Way {
    looked_at: usize,
    meeting: usize,
    skipped: usize,
    /// Frames of the first interval with a contact, and the time of that contact.
    first: Option<([usize; 2], f64)>,
}

impl Way {
    fn take(&mut self, interval: &Interval) {
        if !interval.changed.is_empty() {
            self.skipped += 1;
            return;
        }
        self.looked_at += 1;
        self.meeting += usize::from(interval.count > 0);
        if let (None, Some(first)) = (self.first, &interval.first) {
            self.first = Some(([interval.frame, interval.until], first.time()));
        }
    }

    /// Summary in a sentence.
    fn found(&self) -> String {
        let [meeting, all] = [self.meeting, self.looked_at].map(|n| grouped(n as u64));
        match self.first {
            None => "On the way from frame to frame nothing meets.".to_owned(),
            Some(([frame, until], time)) => format!(
                "On the way from a frame to the next something meets in {meeting} of {all}, \
                 first after {} of the way from frame {frame} to {until}.",
                short(time)
            ),
        }
    }
}

impl Pictures {
    pub(super) fn new(arguments: &Arguments, check: &Check) -> anyhow::Result<Self> {
        let numbers = check.frames().map(|frame| frame as u32);
        Watcher::new(&arguments.pictures, || labels(check), "frame", numbers).map(|watcher| Self {
            watcher: watcher.within(arguments.within),
            way: Way::default(),
            adjacent: AdjacentTally::default(),
        })
    }

    /// Whether all pairs of this frame are needed.
    pub(super) fn looks_at(&self, frame: usize) -> bool {
        self.watcher.looks_at(frame as u32)
    }

    /// Records the frame that was checked last.
    pub(super) fn frame(&mut self, check: &Check, found: &Found) -> anyhow::Result<()> {
        let number = found.frame as u32;
        self.adjacent.count(found);
        if !self.watcher.looks_at(number) {
            return Ok(());
        }
        let pairs: Vec<Row> = found
            .all_pairs()
            .iter()
            .map(|&row| of_sources(check, row))
            .collect();
        let gap = |gap: &pliant_check::Gap| {
            let [a, b] = gap.points;
            let pair = of_sources(check, gap.pair);
            // If the triangles change places, so do their points.
            let is_same =
                check.source_of(gap.pair[0]) == Some(pair[0] as usize) && gap.pair[1] == pair[1];
            Gap {
                pair,
                distance: gap.distance,
                points: if is_same { [a, b] } else { [b, a] },
            }
        };
        let mut gaps: Vec<Gap> = found.gaps.iter().map(gap).collect();
        gaps.sort_unstable_by_key(|gap| gap.pair);
        let places = found.places.as_deref().unwrap_or_default();
        let deep = deep(check, places, &pairs);
        // With one body, nobody needs to be told its name.
        let name = |body| match check.body(body) {
            Some(body) if check.body_count() > 1 => shown(body.name),
            _ => String::new(),
        };
        let watcher = &mut self.watcher;
        // A first pair has no place.
        match &found.places {
            Some(_) => {
                with_world!(check.world(), world => {
                    watcher.frame_with(number, world, &pairs, (places, &deep), &gaps, name)
                })
            }
            None => with_world!(check.world(), world => watcher.frame(number, world, &pairs)),
        }
    }

    /// Whether contacts between frames are shown.
    pub(super) fn shows_moments(&self) -> bool {
        self.watcher.has_page()
    }

    /// Records contacts on the way from the frame that was checked last.
    pub(super) fn interval(&mut self, check: &Check, interval: &Interval) {
        if !self.shows_moments() {
            return;
        }
        self.way.take(interval);
        if let Some(moment) = moments::moment(interval) {
            with_world!(check.world(), world => self.watcher.moment(world, &moment));
        }
    }

    /// Writes the page, also of a check that ended early.
    pub(super) fn end(
        self,
        arguments: &Arguments,
        check: &Check,
        checked: &anyhow::Result<()>,
    ) -> anyhow::Result<()> {
        let Self {
            mut watcher,
            way,
            adjacent,
        } = self;
        if arguments.swept {
            watcher.also_found(way.found());
        }
        watcher.finish("check", "frame", |motion, play| {
            if arguments.swept {
                play.facts
                    .push(fact("ways with contacts", way.meeting.to_string()));
                play.notes.push(BETWEEN_FRAMES.to_owned());
                if way.skipped > 0 {
                    play.notes.push(format!(
                        "Where a mesh changes between two frames nothing was looked for: \
                         {} of them.",
                        way.skipped
                    ));
                }
            }
            if motion.depths().is_some() {
                play.notes.push(DEPTHS.to_owned());
            }
            let precision = match check.world() {
                AnyWorld::F32(_) => "f32",
                AnyWorld::F64(_) => "f64",
            };
            play.facts.extend([
                fact("query", asked(arguments, check)),
                fact("precision", precision),
            ]);
            let is_split = (0..check.sources().len()).any(|source| check.is_split(source));
            let bodies = match arguments.split {
                None if !is_split => None,
                Some(Split::Components) => Some("pieces"),
                None | Some(Split::Groups) => Some("groups"),
            };
            if let Some(bodies) = bodies {
                play.facts
                    .push(fact(bodies, check.body_count().to_string()));
            }
            if let Some(adjacent) = adjacent.said() {
                play.notes.push(format!("{adjacent}."));
            }
            if arguments.ignore_adjacent {
                play.notes
                    .push("Triangles that share a vertex are left out.".to_owned());
            }
            match &arguments.baseline {
                None => {}
                Some(Baseline::Frame(frame)) => play.notes.push(format!(
                    "Pairs that intersect in frame {frame} are left out."
                )),
                Some(Baseline::File(file)) => play.notes.push(format!(
                    "Pairs that intersect in {} are left out.",
                    shown(file)
                )),
            }
            if let Some(rest) = &arguments.rest {
                play.notes.push(format!("Left out are {}.", at_rest(rest)));
            }
            if let Some(labelled) = labelled(&arguments.labels) {
                play.notes.push(format!("Left out are {labelled}."));
            }
            if arguments.crossing {
                play.notes
                    .push("Places where surfaces only touch are left out.".to_owned());
            }
            if arguments.skip_degenerate {
                play.notes
                    .push("Pairs with a triangle without area are left out.".to_owned());
            }
            for [a, b] in &arguments.ignore {
                play.notes.push(format!(
                    "Pairs of {} and {} are left out.",
                    shown(a),
                    shown(b)
                ));
            }
            if let Err(error) = checked {
                let why = advice::with_advice(error);
                play.notes.push(format!("The check ended early: {why}."));
            }
        })
    }
}

/// Names of the sources on the page, and of the pieces or groups of each.
fn labels(check: &Check) -> Vec<BodyLabel> {
    let sources = check.sources().iter().enumerate();
    let label = sources.map(|(number, source)| BodyLabel {
        name: shown(source.name()),
        faces: source.faces().map(<[u32]>::to_vec),
        parts: check.is_split(number).then(|| parts(check, number)),
    });
    label.collect()
}

fn parts(check: &Check, number: usize) -> Parts {
    let source = &check.sources()[number];
    let bodies = check.bodies_of(number);
    let names = bodies.clone().filter_map(|body| check.body(body));
    let names = names.map(|body| {
        let behind = body.name.strip_prefix(source.name()).unwrap_or(&body.name);
        shown(behind.strip_prefix('#').unwrap_or(behind))
    });
    let none = bodies.len() as u32;
    let part = |triangle| {
        let body = check.body_of(number, triangle);
        body.map_or(none, |body| body - bodies.start)
    };
    Parts {
        names: names.collect(),
        of_triangles: (0..source.triangles().len()).map(part).collect(),
    }
}

/// Triangles of pairs of sources in places with a depth, each with that depth.
fn deep(check: &Check, places: &[Place], pairs: &[Row]) -> Vec<([u32; 2], f64)> {
    let depths = places.iter().filter_map(|it| Some((it.number, it.depth?)));
    let depths: HashMap<usize, f64> = depths.collect();
    if depths.is_empty() {
        return Vec::new();
    }
    let vertices = check.vertices_of_places().iter();
    let vertices = vertices.filter_map(|(vertex, place)| Some((*vertex, *depths.get(place)?)));
    let of_vertices: HashMap<[u32; 2], f64> = vertices.collect();
    let triangles = pairs.iter().flat_map(|&[a, b, c, d]| [[a, b], [c, d]]);
    let mut triangles: Vec<[u32; 2]> = triangles.collect();
    triangles.sort_unstable();
    triangles.dedup();
    let deep = triangles.into_iter().filter_map(|[source, triangle]| {
        let [vertex, ..] = check.sources()[source as usize].triangles()[triangle as usize];
        Some(([source, triangle], *of_vertices.get(&[source, vertex])?))
    });
    deep.collect()
}

/// Renumbers a pair of bodies as a pair of sources, the smaller first.
pub(super) fn of_sources(check: &Check, [body_a, a, body_b, b]: Row) -> Row {
    let source = |body| check.source_of(body).unwrap_or_default() as u32;
    let (one, other) = ((source(body_a), a), (source(body_b), b));
    let ((source_a, a), (source_b, b)) = (one.min(other), one.max(other));
    [source_a, a, source_b, b]
}

fn asked(arguments: &Arguments, check: &Check) -> &'static str {
    let in_pieces = arguments.split == Some(Split::Components);
    let (one, each) = if in_pieces {
        (
            "the piece with itself",
            "the pieces with each other, and each with itself",
        )
    } else {
        (
            "the body with itself",
            "the bodies with each other, and each with itself",
        )
    };
    match (arguments.first, check.body_count(), arguments.itself) {
        (true, ..) => "the first pair of each frame",
        (_, 1, _) => one,
        (_, _, true) => each,
        _ if in_pieces => "the pieces with each other",
        _ => "the bodies with each other",
    }
}
