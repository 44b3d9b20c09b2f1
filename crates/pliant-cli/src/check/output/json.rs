//! One JSON object.
//!
//! ```json
//! {"format":1,"bodies":[{"name":"a.ply","box":[[0.0,0.0,0.0],[1.0,1.0,1.0]],"vertices":8,"triangles":12}],
//!  "frames":[{"frame":0,"count":1,"kinds":{"crossing":1,"overlapping":0,"touching":0},"pairs":[[0,3,0,9]]}]}
//! ```
//!
//! All numbers count from 0; a pair is body, triangle, body, triangle, the smaller (body, triangle) first, sorted. `box` of a body has
//! its smallest and its largest coordinates in the first frame that is checked. `faces` of a
//! body (triangle to polygon) stands where its polygons were made into fans, `welded` where vertices were welded away. With
//! `--count` there are no `pairs`; with `--first`, `count` is 0 or 1 and `"complete": false` says that the list was not meant
//! to be complete. If a frame cannot be checked, the object ends with `"error"`.
//!
//! With `--split` a body is a piece or a group of a source: `"split": "components"` or `"groups"` says so, `"triangle_numbers":
//! "source"` that triangles of pairs are numbered as in the source, and `sources` has what bodies have otherwise: files, or the bodies
//! of glTF files. A body then has the number of its `source`, and its `first_triangle`; its `vertices` and `triangles` are those of the
//! piece. So it is, but for `split`, where arguments name groups of an OBJ file.
//!
//! `groups` (numbers of bodies by name) and `ignore` repeat what was asked. With `--baseline`, which is repeated too, a frame has
//! `left_out`: how many pairs were, because they intersect in that frame, or in the file; not where `--first` stopped at a new pair.
//! Where the mesh of a body is another one than in the frame before, the frame has `changed`: for each such body its number as `body`,
//! and what `bodies` says of the others; triangles are numbered as in that mesh until it changes again.
//!
//! `places` of a frame joins its pairs: those of one place hang together through neighbouring triangles. Most pairs first, each with its
//! `number`, the same from frame to frame while the place lives, how many pairs (`count`), the smallest and largest coordinates of its
//! triangles (`box`), its `first_pair`, and its `bodies`: the number of each, how many triangles of it and the lowest. Behind the frames
//! `places` has them all: the first and the last of its `frames`, its `most_pairs` and the frame `most_in`; then the rest is what it is
//! in that frame. Of more than a thousand those with the most pairs are there, and `places_left_out` says how many are not. With
//! `--count` and `--first` there are none.
//!
//! With `--within`, which is repeated, pairs are those of triangles of different bodies that are so close, and a frame has `distance`: that
//! of the nearest of its pairs, or `null` where it has none. With `--first` the nearest is the one pair.
//!
//! With `--swept`, which is repeated, the frames have between them what meets on the way from each to the next: all numbers count from 0, and
//! vertices are those of the file.
//!
//! ```json
//! {"frame":0,"until":1,"count":1,"at_start":0,"first":{"time":0.5,"kind":"vertex_triangle","pair":[0,7,1,3]},
//!  "vertex_triangle":[[0,7,1,3,0.49999904632568359,0.5]],"edge_edge":[]}
//! ```
//!
//! `until` is the frame that follows. `vertex_triangle` has body, vertex, body, triangle, `edge_edge` body, vertex, vertex, body, vertex, vertex, the
//! smaller first in an edge and of the two, sorted; behind them two times from 0, in the frame, to 1, in the next: up to the first they are
//! apart, at the second they have met. They are those that are apart in the frame, `count` is how many, and `first` (or `null`) the one of
//! them that meets first, `time` the second of its times; `at_start` is how many others meet in the frame already. With `--count` there are
//! no lists, with `--first` no more in them than the first, and `"complete": false`. Where the mesh of a body is another one in the next
//! frame nothing is looked for: `count`, `at_start` and `first` are `null`, and `changed` has the numbers of these bodies.
//!
//! `kinds` of a frame that has pairs, all of which were asked for, says how many are of each kind: of `crossing` pairs the triangles go through
//! each other, and would after every small enough move; `overlapping` ones lie in one plane with an area in common; the others are
//! `touching`, along a cut for example. With `--first` and `--within` it is not said.
//!
//! ```json
//! {"frame":0,"count":3,"kinds":{"crossing":2,"overlapping":0,"touching":1},"pairs":[[0,3,0,9],[0,4,0,9],[0,5,0,9]]}
//! ```
//!
//! With `--crossing`, which is repeated, `only_touching` of a frame says how many pairs are left out because their places only touch.
//!
//! `degenerate` says how many pairs have a triangle without area, where there are any: of those counted, or with
//! `"skip_degenerate": true` of those that were left out for it.

use super::form::Form;
use super::tally::Tally;
use crate::check::arguments::{Arguments, Split};
use crate::check::names::Names;
use pliant_check::{Baseline, Check, FirstImpact, Found, Group, Impact, Interval, Life, Place};
use pliant_io::Body as Source;
use serde::Serialize;
use serde_json::json;
use std::io::{self, Write};

#[expect(clippy::struct_excessive_bools, reason = "each is a choice of its own")]
pub(super) struct Json {
    count_only: bool,
    split: Option<Split>,
    groups: Vec<Group>,
    ignore: Vec<Names>,
    baseline: Option<Baseline>,
    skip_degenerate: bool,
    within: Option<f64>,
    crossing: bool,
    swept: bool,
    has_frames: bool,
    lists_places: bool,
}

#[derive(Serialize)]
struct Entry<'a> {
    name: &'a str,
    #[serde(flatten)]
    mesh: MeshEntry<'a>,
}

#[derive(Serialize)]
struct ChangedEntry<'a> {
    body: u32,
    #[serde(flatten)]
    mesh: MeshEntry<'a>,
}

#[derive(Serialize)]
struct MeshEntry<'a> {
    #[serde(rename = "box", skip_serializing_if = "Option::is_none")]
    around: Option<[[f64; 3]; 2]>,
    vertices: usize,
    triangles: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    faces: Option<&'a [u32]>,
    #[serde(skip_serializing_if = "is_zero")]
    welded: usize,
}

impl<'a> MeshEntry<'a> {
    /// The mesh that a source has now.
    fn of(source: &'a Source) -> Self {
        Self {
            around: None,
            vertices: source.vertex_count(),
            triangles: source.triangles().len(),
            faces: source.faces(),
            welded: source.welded(),
        }
    }
}

#[derive(Serialize)]
struct PieceEntry<'a> {
    name: &'a str,
    #[serde(rename = "box")]
    around: [[f64; 3]; 2],
    vertices: usize,
    triangles: usize,
    source: usize,
    first_triangle: usize,
}

#[derive(Serialize)]
struct FrameEntry<'a> {
    frame: usize,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    changed: Vec<ChangedEntry<'a>>,
    count: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    kinds: Option<serde_json::Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    complete: Option<bool>,
    /// `null` where nothing is as close as that; not there where no distance was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    distance: Option<serde_json::Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    left_out: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    only_touching: Option<usize>,
    #[serde(skip_serializing_if = "is_zero")]
    degenerate: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    pairs: Option<&'a [[u32; 4]]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    places: Option<Vec<PlaceEntry>>,
}

#[derive(Serialize)]
struct IntervalEntry<'a> {
    frame: usize,
    until: usize,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    changed: &'a [u32],
    count: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    complete: Option<bool>,
    at_start: Option<usize>,
    first: Option<FirstEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    vertex_triangle: Option<Vec<(u32, u32, u32, u32, f64, f64)>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    edge_edge: Option<Vec<(u32, u32, u32, u32, u32, u32, f64, f64)>>,
}

#[derive(Serialize)]
struct FirstEntry {
    time: f64,
    kind: &'static str,
    pair: Vec<u32>,
}

impl FirstEntry {
    fn of(first: &FirstImpact) -> Self {
        let (kind, pair) = match first {
            FirstImpact::VertexTriangle(impact) => ("vertex_triangle", &impact.pair[..]),
            FirstImpact::EdgeEdge(impact) => ("edge_edge", &impact.pair[..]),
        };
        Self {
            time: first.time(),
            kind,
            pair: pair.to_vec(),
        }
    }
}

#[derive(Serialize)]
struct PlaceEntry {
    number: usize,
    count: usize,
    #[serde(flatten)]
    lies: Lies,
}

#[derive(Serialize)]
struct LifeEntry {
    number: usize,
    frames: [usize; 2],
    most_pairs: usize,
    most_in: usize,
    #[serde(flatten)]
    lies: Lies,
}

/// Where a place is in a frame.
#[derive(Serialize)]
struct Lies {
    #[serde(rename = "box")]
    around: [[f64; 3]; 2],
    first_pair: [u32; 4],
    bodies: Vec<BodyEntry>,
}

#[derive(Serialize)]
struct BodyEntry {
    body: u32,
    triangles: usize,
    first_triangle: u32,
}

impl Lies {
    fn of(place: &Place) -> Self {
        let bodies = place.bodies.iter().map(|it| BodyEntry {
            body: it.body,
            triangles: it.triangles,
            first_triangle: it.first_triangle,
        });
        Self {
            around: [place.lower, place.upper],
            first_pair: place.first_pair,
            bodies: bodies.collect(),
        }
    }
}

impl PlaceEntry {
    fn of(place: &Place) -> Self {
        Self {
            number: place.number,
            count: place.count,
            lies: Lies::of(place),
        }
    }
}

impl LifeEntry {
    fn of(life: &Life) -> Self {
        Self {
            number: life.worst.number,
            frames: [life.first_frame, life.last_frame],
            most_pairs: life.worst.count,
            most_in: life.worst_frame,
            lies: Lies::of(&life.worst),
        }
    }
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "the signature is serde's"
)]
fn is_zero(number: &usize) -> bool {
    *number == 0
}

impl Json {
    pub(super) fn new(arguments: &Arguments) -> Self {
        Self {
            count_only: arguments.count,
            split: arguments.split,
            groups: arguments.groups.clone(),
            ignore: arguments.ignore.clone(),
            baseline: arguments.baseline.clone(),
            skip_degenerate: arguments.skip_degenerate,
            within: arguments.within,
            crossing: arguments.crossing,
            swept: arguments.swept,
            has_frames: false,
            lists_places: !arguments.count && !arguments.first,
        }
    }
}

impl Form for Json {
    fn head(&mut self, out: &mut dyn Write, check: &Check) -> io::Result<()> {
        let sources: Vec<_> = check
            .sources()
            .iter()
            .enumerate()
            .map(|(number, source)| {
                let mut mesh = MeshEntry::of(source);
                mesh.around = Some(check.box_of(number));
                let name = source.name();
                Entry { name, mesh }
            })
            .collect();
        write!(out, r#"{{"format":1,"bodies":"#)?;
        let is_split = |source| check.is_split(source);
        if self.split.is_some() || (0..sources.len()).any(is_split) {
            let boxes = check.boxes();
            for ((number, body), around) in check.bodies().enumerate().zip(boxes) {
                write!(out, "{}", if number > 0 { "," } else { "[" })?;
                let entry = PieceEntry {
                    name: &body.name,
                    around,
                    vertices: body.vertices,
                    triangles: body.triangles,
                    source: body.source,
                    first_triangle: body.first_triangle,
                };
                serde_json::to_writer(&mut *out, &entry)?;
            }
            write!(out, "]")?;
            match self.split {
                None => {}
                Some(Split::Components) => write!(out, r#","split":"components""#)?,
                Some(Split::Groups) => write!(out, r#","split":"groups""#)?,
            }
            write!(out, r#","triangle_numbers":"source","sources":"#)?;
        }
        serde_json::to_writer(&mut *out, &sources)?;
        if !self.groups.is_empty() {
            let groups = self.groups.iter();
            let groups = groups.map(|group| (group.name.clone(), json!(group.bodies)));
            let groups: serde_json::Map<_, _> = groups.collect();
            write!(out, r#","groups":{}"#, json!(groups))?;
        }
        if !self.ignore.is_empty() {
            write!(out, r#","ignore":{}"#, json!(self.ignore))?;
        }
        match &self.baseline {
            None => {}
            Some(Baseline::Frame(frame)) => write!(out, r#","baseline":{frame}"#)?,
            Some(Baseline::File(file)) => {
                write!(out, r#","baseline":{}"#, json!(file.to_string_lossy()))?;
            }
        }
        if self.skip_degenerate {
            write!(out, r#","skip_degenerate":true"#)?;
        }
        if let Some(within) = self.within {
            write!(out, r#","within":{}"#, json!(within))?;
        }
        if self.crossing {
            write!(out, r#","crossing":true"#)?;
        }
        if self.swept {
            write!(out, r#","swept":true"#)?;
        }
        write!(out, r#","frames":["#)
    }

    fn frame(&mut self, out: &mut dyn Write, check: &Check, found: &Found) -> io::Result<()> {
        let changed = found.changed.iter().filter_map(|&body| {
            let source = &check.sources()[check.source_of(body)?];
            let mesh = MeshEntry::of(source);
            Some(ChangedEntry { body, mesh })
        });
        let places = found.places.as_ref().filter(|_| !self.count_only);
        let entry = FrameEntry {
            frame: found.frame,
            changed: changed.collect(),
            count: found.count,
            kinds: found.kinds.filter(|_| found.count > 0).map(|kinds| {
                json!({
                    "crossing": kinds.crossing,
                    "overlapping": kinds.overlapping,
                    "touching": kinds.touching,
                })
            }),
            complete: (!found.complete).then_some(false),
            distance: self.within.map(|_| json!(found.distance)),
            left_out: found.left_out,
            only_touching: found.only_touching,
            degenerate: found.degenerate,
            pairs: (!self.count_only).then_some(&found.pairs),
            places: places.map(|places| places.iter().map(PlaceEntry::of).collect()),
        };
        let separator = if self.has_frames { "," } else { "" };
        self.has_frames = true;
        writeln!(out, "{separator}")?;
        Ok(serde_json::to_writer(out, &entry)?)
    }

    fn interval(&mut self, out: &mut dyn Write, _: &Check, interval: &Interval) -> io::Result<()> {
        let was_looked_at = interval.changed.is_empty();
        let is_listed = was_looked_at && !self.count_only;
        let vertices = |&Impact { pair, low, high }: &Impact<4>| {
            let [body_a, vertex, body_b, triangle] = pair;
            (body_a, vertex, body_b, triangle, low, high)
        };
        let edges = |&Impact { pair, low, high }: &Impact<6>| {
            let [body_a, a, b, body_b, c, d] = pair;
            (body_a, a, b, body_b, c, d, low, high)
        };
        let entry = IntervalEntry {
            frame: interval.frame,
            until: interval.until,
            changed: &interval.changed,
            count: was_looked_at.then_some(interval.count),
            complete: (!interval.complete).then_some(false),
            at_start: was_looked_at.then_some(interval.at_start),
            first: interval.first.as_ref().map(FirstEntry::of),
            vertex_triangle: is_listed
                .then(|| interval.vertex_triangle.iter().map(vertices).collect()),
            edge_edge: is_listed.then(|| interval.edge_edge.iter().map(edges).collect()),
        };
        writeln!(out, ",")?;
        Ok(serde_json::to_writer(out, &entry)?)
    }

    fn end(
        &mut self,
        out: &mut dyn Write,
        check: &Check,
        _: &Tally,
        error: Option<&anyhow::Error>,
    ) -> io::Result<()> {
        write!(out, "\n]")?;
        if self.lists_places {
            let (count, lives) = check.places();
            let entries: Vec<_> = lives.iter().map(LifeEntry::of).collect();
            write!(out, ",\"places\":")?;
            serde_json::to_writer(&mut *out, &entries)?;
            if count > lives.len() {
                write!(out, ",\"places_left_out\":{}", count - lives.len())?;
            }
        }
        match error {
            None => writeln!(out, "}}"),
            Some(error) => {
                let error = json!(format!("{error:#}"));
                writeln!(out, ",\"error\":{error}}}")
            }
        }
    }
}
