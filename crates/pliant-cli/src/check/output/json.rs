//! Output of a check as one JSON object.
//!
//! ```json
//! {
//!   "format": 1,
//!   "bodies": [
//!     {"name": "a.ply", "box": [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]], "vertices": 8, "triangles": 12}
//!   ],
//!   "frames": [
//!     {
//!       "frame": 0,
//!       "count": 1,
//!       "kinds": {"crossing": 1, "overlapping": 0, "touching": 0},
//!       "pairs": [[0, 3, 0, 9]]
//!     }
//!   ]
//! }
//! ```
//!
//! All numbers count from 0. A pair is body, triangle, body, triangle: the smaller (body, triangle)
//! first, and pairs are sorted. Pairs of triangles that share a vertex are counted apart, as
//! `adjacent`. If a frame cannot be checked, the object ends with `error`.
//!
//! | member | meaning |
//! |---|---|
//! | `bodies` | each body: [`Entry`], or with `split` [`PieceEntry`] |
//! | `sources` | files, or bodies of glTF files, where bodies are pieces or groups: [`Entry`] |
//! | `split`, `ignore`, `baseline`, `within`, `rest` | what was asked, if it was |
//! | `crossing`, `swept`, `solid` | what was asked, if it was |
//! | `skip_degenerate`, `ignore_adjacent` | what was asked, if it was |
//! | `groups` | numbers of bodies by name of the group, if it was asked |
//! | `labels` | files of labels by name of the body, if there were any |
//! | `frames` | [`FrameEntry`] each; with `swept` an [`IntervalEntry`] between two |
//! | `places` | places over all frames: [`LifeEntry`]; absent with `--count` and `--first` |
//! | `places_left_out` | number of places not in the list, which has the thousand largest |

use super::form::Form;
use super::tally::Tally;
use crate::check::arguments::{Arguments, Split};
use crate::check::names::Names;
use pliant_check::{
    Adjacent, Baseline, Check, CrossingEdges, FirstImpact, Found, Group, Impact, Interval, Kinds,
    LabelFile, Life, Nested, Place, Rest,
};
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
    ignore_adjacent: bool,
    within: Option<f64>,
    rest: Option<Rest>,
    labels: Vec<LabelFile>,
    crossing: bool,
    swept: bool,
    solid: bool,
    has_frames: bool,
    /// Bodies that were not closed in the frame before.
    not_closed: Vec<u32>,
    lists_places: bool,
}

/// A body, or the source of bodies.
#[derive(Serialize)]
struct Entry<'a> {
    name: &'a str,
    #[serde(flatten)]
    mesh: MeshEntry<'a>,
}

/// A body whose mesh is not that of the frame before.
///
/// From here on its triangles are numbered as in this mesh.
#[derive(Serialize)]
struct ChangedEntry<'a> {
    body: u32,
    #[serde(flatten)]
    mesh: MeshEntry<'a>,
}

/// Size of a source's mesh in the present frame.
#[derive(Serialize)]
struct MeshEntry<'a> {
    /// Smallest and largest coordinates in the first frame that is checked.
    #[serde(rename = "box", skip_serializing_if = "Option::is_none")]
    around: Option<[[f64; 3]; 2]>,
    vertices: usize,
    triangles: usize,
    /// Polygon of each triangle, where polygons were made into fans.
    #[serde(skip_serializing_if = "Option::is_none")]
    faces: Option<&'a [u32]>,
    /// Number of vertices that were welded away.
    #[serde(skip_serializing_if = "is_zero")]
    welded: usize,
}

impl<'a> MeshEntry<'a> {
    /// Size of the present mesh, without its box.
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

/// A body that is a piece or a group of a source.
///
/// With `--split`, and where arguments name groups of an OBJ file. Then `"triangle_numbers":
/// "source"` says that triangles of pairs are numbered as in the source.
#[derive(Serialize)]
struct PieceEntry<'a> {
    name: &'a str,
    /// Smallest and largest coordinates in the first frame that is checked.
    #[serde(rename = "box")]
    around: [[f64; 3]; 2],
    /// Number of vertices of the piece.
    vertices: usize,
    /// Number of triangles of the piece.
    triangles: usize,
    /// Number of its source.
    source: usize,
    /// The lowest of its triangles.
    first_triangle: usize,
}

/// A frame and its pairs.
#[derive(Serialize)]
struct FrameEntry<'a> {
    frame: usize,
    /// Bodies with a new mesh.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    changed: Vec<ChangedEntry<'a>>,
    /// Number of pairs; with `--first` 0 or 1.
    count: usize,
    /// Number of pairs of each kind: `crossing`, `overlapping`, `touching`.
    ///
    /// Triangles of `crossing` pairs go through each other, and would after every small enough
    /// move. Pairs that lie in one plane with an area in common are `overlapping`. All others are
    /// `touching`, along a cut for example. Absent without pairs, with `--first` and with
    /// `--within`.
    #[serde(skip_serializing_if = "Option::is_none")]
    kinds: Option<serde_json::Value>,
    /// `false` with `--first`: the list was not meant to be complete.
    #[serde(skip_serializing_if = "Option::is_none")]
    complete: Option<bool>,
    /// `null` where no pair is that close; absent where no distance was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    distance: Option<serde_json::Value>,
    /// Number of pairs left out because they intersect in the frame or the file of `--baseline`.
    /// Absent where `--first` stopped at a new pair.
    #[serde(skip_serializing_if = "Option::is_none")]
    left_out: Option<usize>,
    /// With `--crossing`, number of pairs left out because their places only touch.
    #[serde(skip_serializing_if = "Option::is_none")]
    only_touching: Option<usize>,
    /// Number of pairs with a triangle without area: pairs in `count`, or with `"skip_degenerate":
    /// true` pairs left out.
    #[serde(skip_serializing_if = "is_zero")]
    degenerate: usize,
    /// Absent with `--count`. With `--within` and without `--rest` only triangles of different
    /// bodies; with `--first` the nearest pair alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pairs: Option<&'a [[u32; 4]]>,
    /// Number of pairs of triangles that share a vertex and meet beyond what they share. Absent
    /// where they are not asked for: between different files, with `--within`, with
    /// `--ignore-adjacent`, and where `--first` found another pair.
    #[serde(skip_serializing_if = "Option::is_none")]
    adjacent: Option<usize>,
    #[serde(flatten)]
    of_adjacent: Option<AdjacentEntry<'a>>,
    /// Edges that cross triangles: body of the edges, body of the triangles, number of different
    /// edges, number of pairs of an edge and a triangle.
    ///
    /// The open edge meets the open triangle, and not in its plane. An edge between two bodies of a
    /// file is of both. `ignore` leaves bodies out, and nothing else does. Absent with `--first`
    /// and `--within`.
    #[serde(skip_serializing_if = "Option::is_none")]
    crossing_edges: Option<Vec<(u32, u32, usize, usize)>>,
    /// Components that lie inside bodies: body, component, body around it. Components are numbered
    /// in the order of their lowest triangles. Absent with one body.
    #[serde(skip_serializing_if = "Option::is_none")]
    inside: Option<Vec<[u32; 3]>>,
    /// Bodies that are not closed, so that nothing is said to lie inside them. Absent where they
    /// are as in the frame before, and in the first frame if there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    not_closed: Option<&'a [u32]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    places: Option<Vec<PlaceEntry>>,
}

/// More about pairs that share a vertex, where there are any or some were left out.
#[derive(Serialize)]
struct AdjacentEntry<'a> {
    /// As `pairs`; absent with `--count`.
    #[serde(skip_serializing_if = "Option::is_none")]
    adjacent_pairs: Option<&'a [[u32; 4]]>,
    /// As `kinds`. A triangle that is there twice is `overlapping`. Absent without such pairs.
    #[serde(skip_serializing_if = "Option::is_none")]
    adjacent_kinds: Option<serde_json::Value>,
    /// Number of triangles that stand twice: an earlier one has the same three vertices.
    #[serde(skip_serializing_if = "is_zero")]
    twice: usize,
    /// Number of pairs left out by `--baseline`, as `left_out`.
    #[serde(skip_serializing_if = "Option::is_none")]
    adjacent_left_out: Option<usize>,
    /// With `--crossing`, number of pairs left out because they only touch.
    #[serde(skip_serializing_if = "Option::is_none")]
    adjacent_only_touching: Option<usize>,
    /// As `degenerate`.
    #[serde(skip_serializing_if = "is_zero")]
    adjacent_degenerate: usize,
}

impl<'a> AdjacentEntry<'a> {
    fn of(adjacent: &'a Adjacent, count_only: bool) -> Self {
        Self {
            adjacent_pairs: (!count_only).then_some(&adjacent.pairs),
            adjacent_kinds: (adjacent.count > 0).then(|| kinds(adjacent.kinds)),
            twice: adjacent.twice,
            adjacent_left_out: adjacent.left_out,
            adjacent_only_touching: adjacent.only_touching,
            adjacent_degenerate: adjacent.degenerate,
        }
    }
}

fn kinds(kinds: Kinds) -> serde_json::Value {
    json!({
        "crossing": kinds.crossing,
        "overlapping": kinds.overlapping,
        "touching": kinds.touching,
    })
}

/// Contacts on the way from a frame to the next, with `--swept`.
///
/// ```json
/// {
///   "frame": 0,
///   "until": 1,
///   "count": 1,
///   "at_start": 0,
///   "first": {"time": 0.5, "kind": "vertex_triangle", "pair": [0, 7, 1, 3]},
///   "vertex_triangle": [[0, 7, 1, 3, 0.49999904632568359, 0.5]],
///   "edge_edge": []
/// }
/// ```
///
/// Vertices are numbered as in the file. In an edge, and of two edges, the smaller stands first;
/// lists are sorted. A contact ends in two times from 0, in the frame, to 1, in the next. At the
/// first time the elements are apart, at the second they have met. Where a mesh changes, nothing is
/// searched: `count`, `at_start` and `first` are `null`.
#[derive(Serialize)]
struct IntervalEntry<'a> {
    frame: usize,
    until: usize,
    /// Bodies whose mesh is another one in the next frame.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    changed: &'a [u32],
    /// Number of contacts between elements that are apart in the frame.
    count: Option<usize>,
    /// `false` with `--first`.
    #[serde(skip_serializing_if = "Option::is_none")]
    complete: Option<bool>,
    /// Number of other contacts, which are there in the frame already.
    at_start: Option<usize>,
    /// The contact that comes first, or `null`.
    first: Option<FirstEntry>,
    /// Body, vertex, body, triangle and two times. Absent with `--count`; with `--first` at most
    /// the first contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    vertex_triangle: Option<Vec<(u32, u32, u32, u32, f64, f64)>>,
    /// Body, vertex, vertex, body, vertex, vertex and two times. Absent or shortened as
    /// `vertex_triangle`.
    #[serde(skip_serializing_if = "Option::is_none")]
    edge_edge: Option<Vec<(u32, u32, u32, u32, u32, u32, f64, f64)>>,
}

/// The contact that is the first, and the second of its times.
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

/// A place in a frame: pairs that hang together through neighbouring triangles.
///
/// Places are sorted by their number of pairs, most first. With `--count` and `--first` there are
/// none.
#[derive(Serialize)]
struct PlaceEntry {
    /// Equal from frame to frame, as long as the place lives.
    number: usize,
    /// Number of pairs, those that share a vertex too.
    count: usize,
    /// With `--solid`: how far the deepest vertex of the place is inside the other body. It is
    /// linked with the place by vertices inside; 0 if there is none. Absent within one file, and
    /// where none is closed.
    #[serde(skip_serializing_if = "Option::is_none")]
    depth: Option<f64>,
    #[serde(flatten)]
    location: Location,
}

/// A place over all frames, located in the frame that has most of its pairs.
#[derive(Serialize)]
struct LifeEntry {
    /// The number of the place in every frame.
    number: usize,
    /// The first and the last frame of the place.
    frames: [usize; 2],
    /// The most pairs that it has in a frame.
    most_pairs: usize,
    /// The frame that has them.
    most_in: usize,
    /// Its depth there, as in the frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    depth: Option<f64>,
    #[serde(flatten)]
    location: Location,
}

/// Location of a place in one frame.
#[derive(Serialize)]
struct Location {
    /// Smallest and largest coordinates of its triangles.
    #[serde(rename = "box")]
    around: [[f64; 3]; 2],
    /// The first of its pairs in order.
    first_pair: [u32; 4],
    bodies: Vec<BodyEntry>,
}

/// Triangles of one body in a place.
#[derive(Serialize)]
struct BodyEntry {
    body: u32,
    /// Number of triangles.
    triangles: usize,
    /// The lowest of their numbers.
    first_triangle: u32,
}

impl Location {
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
            depth: place.depth,
            location: Location::of(place),
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
            depth: life.worst.depth,
            location: Location::of(&life.worst),
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
            ignore_adjacent: arguments.ignore_adjacent,
            within: arguments.within,
            rest: arguments.rest.clone(),
            labels: arguments.labels.clone(),
            crossing: arguments.crossing,
            swept: arguments.swept,
            solid: arguments.solid,
            has_frames: false,
            not_closed: Vec::new(),
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
        if self.ignore_adjacent {
            write!(out, r#","ignore_adjacent":true"#)?;
        }
        if let Some(within) = self.within {
            write!(out, r#","within":{}"#, json!(within))?;
        }
        match &self.rest {
            None => {}
            Some(Rest::Frame(frame)) => write!(out, r#","rest":{frame}"#)?,
            Some(Rest::File(file)) => {
                write!(out, r#","rest":{}"#, json!(file.to_string_lossy()))?;
            }
        }
        if !self.labels.is_empty() {
            let labels = self.labels.iter();
            let labels = labels.map(|it| (it.body.clone(), json!(it.file.to_string_lossy())));
            let labels: serde_json::Map<_, _> = labels.collect();
            write!(out, r#","labels":{}"#, json!(labels))?;
        }
        if self.crossing {
            write!(out, r#","crossing":true"#)?;
        }
        if self.swept {
            write!(out, r#","swept":true"#)?;
        }
        if self.solid {
            write!(out, r#","solid":true"#)?;
        }
        write!(out, r#","frames":["#)
    }

    fn says_inside(&self) -> bool {
        true
    }

    fn frame(&mut self, out: &mut dyn Write, check: &Check, found: &Found) -> io::Result<()> {
        let changed = found.changed.iter().filter_map(|&body| {
            let source = &check.sources()[check.source_of(body)?];
            let mesh = MeshEntry::of(source);
            Some(ChangedEntry { body, mesh })
        });
        let places = found.places.as_ref().filter(|_| !self.count_only);
        let adjacent = found.adjacent.as_ref();
        let open = found.inside.as_ref().map_or(&[][..], |inside| &inside.open);
        let not_closed = self.not_closed != open;
        if not_closed {
            self.not_closed = open.to_vec();
        }
        let entry = FrameEntry {
            frame: found.frame,
            changed: changed.collect(),
            count: found.count,
            kinds: found.kinds.filter(|_| found.count > 0).map(kinds),
            complete: (!found.complete).then_some(false),
            distance: self.within.map(|_| json!(found.distance)),
            left_out: found.left_out,
            only_touching: found.only_touching,
            degenerate: found.degenerate,
            pairs: (!self.count_only).then_some(&found.pairs),
            adjacent: adjacent.map(|adjacent| adjacent.count),
            crossing_edges: found.crossing_edges.as_ref().map(|counts| {
                let row = |it: &CrossingEdges| (it.edge_body, it.triangle_body, it.edges, it.pairs);
                counts.iter().map(row).collect()
            }),
            of_adjacent: adjacent.map(|it| AdjacentEntry::of(it, self.count_only)),
            inside: found.inside.as_ref().map(|inside| {
                let row = |it: &Nested| [it.body, it.component, it.inside];
                inside.all.iter().map(row).collect()
            }),
            not_closed: not_closed.then_some(open),
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
