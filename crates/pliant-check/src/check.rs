//! The loop of a check: reads the sources frame by frame and finds the pairs of each frame.

use crate::any_world::AnyWorld;
use crate::baseline::{self, Known};
use crate::bodies::{Bodies, BodyFacts};
use crate::elements::Owners;
use crate::error::Error;
use crate::filter::{Filter, Names};
use crate::found::{
    Adjacent, Closeness, CrossingEdges, Found, Gap, How, MOST_COUNTED, Stop, Taker,
};
use crate::interval::{ElementPair, Impact, ImpactTaker, Interval, WIDTH};
use crate::joined::Meshes;
use crate::labels;
use crate::lives::{Life, Lives};
use crate::one_point;
use crate::opened::Opened;
use crate::places::Places;
use crate::remarks::{AtSeams, Parted, Remarks, has_degenerate};
use crate::rest::RestShape;
use crate::row::Row;
use crate::sequence::{FIRST, MeshNumber, Sequence};
use crate::settings::{self, Frames, Rest, Settings};
use crate::solid::{self, PieceWorld};
use crate::touching::{BYTES_OF_TOUCHING, only_touch};
use crate::with_world;
use pliant::{ContactKind, ErrorKind, Query, Selection};
use pliant_io::{Body as Source, OpenOptions};
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::ops::{ControlFlow, Range};

/// The caller's stop callback.
type Question<'q> = &'q (dyn Fn() -> bool + Sync);

/// A check of mesh sequences, frame by frame. Each frame is read and checked on demand.
pub struct Check {
    sequence: Sequence,
    bodies: Bodies,
    filter: Filter,
    asked: Settings,
    /// Selection of the world's queries, once its bodies are there.
    of: Selection,
    /// World of pieces and groups, once it was asked what lies inside them.
    pieces: Option<PieceWorld>,
    /// Frames still to be checked.
    frames: Frames,
    baseline: Option<KnownPairs>,
    remarks: Remarks,
    places: Places,
    lives: Lives,
    /// Mesh numbers of the sources in the frame returned last.
    told: Vec<MeshNumber>,
    /// Owners of the elements of each source, computed on demand. `None` for a source that is one
    /// body. Computed for the triangles that the world had when `Sequence::given` was `owners_of`.
    owners: Vec<Option<Owners>>,
    owners_of: usize,
    /// Frame returned last, until its interval to the next frame was returned.
    from: Option<usize>,
    /// Frame and message of the error that ended the check.
    failed: Option<(usize, String)>,
}

/// Converts a pair of sources, which the world knows, into a pair of bodies. `None` if these bodies
/// are not to meet.
fn row_asked(bodies: &Bodies, filter: &Filter, itself: bool, of_sources: Row) -> Option<Row> {
    let row = bodies.row(of_sources)?;
    let [body_a, _, body_b, _] = row;
    let is_asked = (body_a != body_b || itself) && filter.meet(body_a, body_b);
    is_asked.then_some(row)
}

/// Adds the caller's stop callback, if any, to a query.
fn unless<'q, H: Copy>(stop: Option<Question<'q>>, query: Query<'q, H>) -> Query<'q, H> {
    match stop {
        Some(stop) => query.interrupt_if(stop),
        None => query,
    }
}

/// Ratio of sizes from which on two arguments may well be in different units.
const MOST_UNLIKE: f64 = 100.0;

/// Bounding box of points: lower and upper corner. Without points, +∞ and −∞.
fn around(points: impl IntoIterator<Item = [f64; 3]>) -> [[f64; 3]; 2] {
    let none = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    points.into_iter().fold(none, grown)
}

fn grown([lower, upper]: [[f64; 3]; 2], point: [f64; 3]) -> [[f64; 3]; 2] {
    [
        std::array::from_fn(|axis| lower[axis].min(point[axis])),
        std::array::from_fn(|axis| upper[axis].max(point[axis])),
    ]
}

/// Settings of the search in one frame.
#[derive(Clone, Copy)]
#[expect(clippy::struct_excessive_bools, reason = "each is a choice of its own")]
struct Wanted {
    first: bool,
    /// Whether places that only touch are left out.
    crossing: bool,
    listed: bool,
    places: bool,
}

/// Sources together with the map from their triangles to bodies.
struct SplitSources<'a>(&'a [Source], &'a Bodies);

impl Meshes for SplitSources<'_> {
    fn sizes(&self, source: u32) -> [usize; 2] {
        let source = &self.0[source as usize];
        [source.vertex_count(), source.triangles().len()]
    }

    fn corners(&self, source: u32, triangle: u32) -> [u32; 3] {
        self.0[source as usize].triangles()[triangle as usize]
    }

    fn position(&self, source: u32, vertex: u32) -> [f64; 3] {
        self.0[source as usize].positions().get(vertex)
    }

    fn body(&self, source: u32, triangle: u32) -> u32 {
        self.1.of_triangle(source, triangle).unwrap_or_default()
    }
}

/// Known pairs, which are left out, and the meshes for which they hold.
struct KnownPairs {
    frame: usize,
    /// `None` until the frame was checked.
    known: Option<Known>,
    /// Mesh numbers of the sources in that frame.
    meshes: Vec<MeshNumber>,
    /// Whether each source now has the mesh that it has in that frame.
    comparable: Vec<bool>,
}

impl KnownPairs {
    fn of(frame: usize, known: Option<Known>, sources: usize) -> Self {
        Self {
            frame,
            known,
            meshes: vec![FIRST; sources],
            comparable: vec![true; sources],
        }
    }

    /// Stores the pairs of the baseline's frame, in which the sources are now.
    fn take(&mut self, found: Found, sequence: &Sequence) {
        self.known = Some(Known {
            pairs: found.pairs,
            adjacent: found.adjacent.map(|adjacent| adjacent.pairs),
        });
        self.meshes.clone_from(&sequence.meshes);
    }

    /// Compares the meshes of the sources, in their frame, with the baseline's.
    fn compare(&mut self, sequence: &Sequence) {
        let meshes = self.meshes.iter().zip(&sequence.meshes);
        self.comparable = meshes.map(|(own, other)| own == other).collect();
    }
}

impl Check {
    /// Opens the files that `arguments` name, and prepares to check them.
    ///
    /// An argument is a source. A glTF file is one source for each of its bodies. Arguments that
    /// name groups of one OBJ file, `scan.obj#arm` and `scan.obj#leg`, are one source, and the
    /// groups are its bodies.
    ///
    /// # Errors
    ///
    /// A file cannot be read, a clip is asked for where no source has any, or [`new`](Self::new)
    /// refuses.
    pub fn open(
        arguments: &[String],
        reading: &OpenOptions,
        settings: &Settings,
    ) -> Result<Self, Error> {
        Self::open_each(arguments, reading, settings, |argument| {
            pliant_io::open_all(argument, reading)
        })
    }

    /// [`open`](Self::open) with a function of the caller that opens one argument.
    ///
    /// # Errors
    ///
    /// See [`open`](Self::open).
    pub fn open_each(
        arguments: &[String],
        reading: &OpenOptions,
        settings: &Settings,
        open: impl FnMut(&String) -> Result<Vec<Source>, pliant_io::Error>,
    ) -> Result<Self, Error> {
        let opened = Opened::of(arguments, &reading.files, open)?;
        let mut sources = opened.sources.iter();
        if reading.clip.is_some() && sources.all(|source| source.clip().is_none()) {
            return Err(Error::NoClip);
        }
        Self::of(opened, settings)
    }

    /// Prepares to check open sources. No frame may have been read from them.
    ///
    /// # Errors
    ///
    /// - There is no source, or frame counts differ and neither is 1.
    /// - The mesh of a first frame has too many point triangles at one place, or cannot be split as
    ///   asked.
    /// - The settings name a frame or a body that does not exist, contradict each other, or have a
    ///   bad distance.
    /// - The file of a baseline cannot be used.
    pub fn new(sources: Vec<Source>, settings: &Settings) -> Result<Self, Error> {
        Self::of(Opened::whole(sources), settings)
    }

    fn of(opened: Opened, settings: &Settings) -> Result<Self, Error> {
        let sources = &mut opened.sources.iter();
        sources.try_for_each(|source| one_point::check(source, 0))?;
        let bodies = Bodies::of(&opened, settings.split)?;
        let rest = match &settings.rest {
            Some(Rest::File(file)) => {
                Some(RestShape::read(file, &opened.sources, settings.max_list)?)
            }
            Some(Rest::Frame(_)) | None => None,
        };
        let mut sequence = Sequence::new(opened.sources, rest, settings.options)?;
        let names = Names::new(&sequence.sources, &bodies, &settings.groups)?;
        let filter = Filter::new(&names, &settings.ignore)?;
        let labels = labels::read(&settings.labels, &names, settings.max_list)?;
        let are_all_labelled = labels.iter().all(Option::is_some);
        sequence.label(labels);
        let last = sequence.frame_count - 1;
        let there = |what, frame| {
            let no_such = Error::NoSuchFrame { what, frame, last };
            (frame <= last).then_some(()).ok_or(no_such)
        };
        if let Some(Rest::Frame(frame)) = settings.rest {
            there("the rest shape", frame)?;
        }
        let baseline = match &settings.baseline {
            None => None,
            Some(settings::Baseline::Frame(frame)) => {
                there("the baseline", *frame)?;
                Some(KnownPairs::of(*frame, None, sequence.sources.len()))
            }
            Some(settings::Baseline::File(file)) => {
                let most = settings.max_list;
                let known = baseline::read(file, &sequence.sources, &bodies, most)?;
                Some(KnownPairs::of(0, Some(known), sequence.sources.len()))
            }
        };
        let all = Frames {
            start: 0,
            step: 1,
            count: usize::MAX,
        };
        let mut frames = settings.frames.unwrap_or(all);
        if frames.count == usize::MAX {
            there("the first to be checked", frames.start)?;
            frames.count = (last - frames.start) / frames.step.max(1) + 1;
        }
        if let Some(more) = frames.count.checked_sub(1) {
            let to_last = frames.step.saturating_mul(more);
            there(
                "the last to be checked",
                frames.start.saturating_add(to_last),
            )?;
        }
        let mut asked = settings.clone();
        asked.itself |= bodies.count() == 1;
        refuse_contradictions(&asked, frames.count, are_all_labelled)?;
        Ok(Self {
            asked,
            frames,
            baseline,
            remarks: Remarks::of(sequence.sources.len()),
            places: Places::new(),
            lives: Lives::new(),
            failed: None,
            pieces: None,
            of: Selection::World,
            told: sequence.meshes.clone(),
            owners: Vec::new(),
            owners_of: 0,
            from: None,
            sequence,
            bodies,
            filter,
        })
    }

    /// Sources in the order of the arguments and of the bodies of each, with the positions of the
    /// frame read last.
    pub fn sources(&self) -> &[Source] {
        &self.sequence.sources
    }

    /// The world in the frame checked last, as the queries left it. Empty before the first frame.
    pub fn world(&self) -> &AnyWorld {
        &self.sequence.world
    }

    /// Number of frames of the sources, checked or not.
    pub fn frame_count(&self) -> usize {
        self.sequence.frame_count
    }

    /// Numbers of the frames still to be checked.
    pub fn frames(&self) -> impl Iterator<Item = usize> + Clone + use<> {
        let Frames { start, step, count } = self.frames;
        (0..count).map(move |frame| start + frame * step)
    }

    /// Number of bodies in answers: sources, or the pieces or groups that they are split into.
    pub fn body_count(&self) -> usize {
        self.bodies.count() as usize
    }

    /// Whether a source is split into bodies, or takes part only by some groups. Then its bodies
    /// are named behind a `#`.
    pub fn is_split(&self, source: usize) -> bool {
        self.bodies.is_split(source)
    }

    /// Facts about all bodies, in the order of their numbers.
    pub fn bodies(&self) -> impl Iterator<Item = BodyFacts> {
        (0..self.bodies.count()).map(|body| self.bodies.facts(&self.sequence.sources, body))
    }

    /// Facts about one body; `None` if there is no such body.
    pub fn body(&self, body: u32) -> Option<BodyFacts> {
        (body < self.bodies.count()).then(|| self.bodies.facts(&self.sequence.sources, body))
    }

    /// Number of the source of a body; `None` if there is no such body.
    pub fn source_of(&self, body: u32) -> Option<usize> {
        (body < self.bodies.count()).then(|| self.bodies.source_of(body))
    }

    /// Number of the body of a source's triangle. `None` if its group was not asked for, or if it
    /// does not exist.
    pub fn body_of(&self, source: usize, triangle: usize) -> Option<u32> {
        let triangles = self.sequence.sources.get(source)?.triangles().len();
        let is_there = triangle < triangles;
        is_there.then(|| self.bodies.of_triangle(source as u32, triangle as u32))?
    }

    /// Numbers of the bodies of a source; empty if there is no such source.
    pub fn bodies_of(&self, source: usize) -> Range<u32> {
        if source < self.sequence.sources.len() {
            self.bodies.of_source(source)
        } else {
            0..0
        }
    }

    /// Pairs of a source with itself at seams that are nearly closed, in the frames so far. `None`
    /// where there are none.
    pub fn at_seams(&self, source: usize) -> Option<AtSeams> {
        self.remarks.at_seams(source)
    }

    /// Frames so far in which a seam of a source is open that is closed in its first frame. `None`
    /// where there are none.
    pub fn parted(&self, source: usize) -> Option<Parted> {
        self.remarks.parted(source)
    }

    /// Places of the frames so far, if [`Settings::places`] is set: their number, and the lives of
    /// the largest.
    ///
    /// Ordered by the most pairs in a frame, most first. Of more than a thousand places, the
    /// largest thousand.
    pub fn places(&self) -> (usize, Vec<Life>) {
        (self.lives.count(), self.lives.largest())
    }

    /// Source and vertex of all vertices of places in the frame checked last, and the number of the
    /// place, if [`Settings::places`] is set. No vertex is of two places.
    pub fn vertices_of_places(&self) -> &[([u32; 2], usize)] {
        self.places.vertices()
    }

    /// Whether bodies are checked against themselves.
    pub fn checks_itself(&self) -> bool {
        self.asked.itself
    }

    /// Changes [`Settings::first`] and [`Settings::listed`] for the frames still to be checked.
    pub fn ask(&mut self, first: bool, listed: bool) {
        (self.asked.first, self.asked.listed) = (first, listed);
    }

    /// Reads the first frame that is to be checked, without checking it.
    ///
    /// [`sources`](Self::sources) and the boxes are then of this frame.
    ///
    /// # Errors
    ///
    /// A file cannot be read. No frame follows.
    pub fn begin(&mut self) -> Result<(), Error> {
        let frame = self.frames.start;
        self.ending_at(frame, |check| check.sequence.read_to(frame))
    }

    /// Does `work` on a frame, unless an earlier call failed. Any error but an interruption ends
    /// the check.
    fn ending_at<T>(
        &mut self,
        frame: usize,
        work: impl FnOnce(&mut Self) -> Result<T, Error>,
    ) -> Result<T, Error> {
        if let Some((frame, error)) = self.failed.clone() {
            return Err(Error::AfterError { frame, error });
        }
        // Set first, so that a panic leaves it set.
        self.failed = Some((frame, "an earlier call panicked".to_owned()));
        let done = work(self);
        self.failed = match &done {
            // An interrupted search loses nothing: the frame stays read.
            Ok(_) | Err(Error::Interrupted { .. }) => None,
            Err(error) => Some((frame, error.to_string())),
        };
        done
    }

    /// Bounding box of a source in its current frame: lower and upper corner.
    ///
    /// Costs O(t) for t triangles. Without triangles, and for a source that does not exist, +∞ and
    /// −∞.
    pub fn box_of(&self, source: usize) -> [[f64; 3]; 2] {
        let Some(source) = self.sequence.sources.get(source) else {
            return around([]);
        };
        let corners = source.triangles().as_flattened().iter();
        around(corners.map(|&vertex| source.positions().get(vertex)))
    }

    /// Bounding boxes of all bodies in the current frame, in the order of their numbers.
    ///
    /// Costs O(t) for t triangles. Each box is a lower and an upper corner.
    pub fn boxes(&self) -> Vec<[[f64; 3]; 2]> {
        let mut boxes = Vec::with_capacity(self.body_count());
        for (number, source) in self.sequence.sources.iter().enumerate() {
            if !self.bodies.is_split(number) {
                boxes.push(self.box_of(number));
                continue;
            }
            let bodies = self.bodies.of_source(number);
            boxes.resize(bodies.end as usize, around([]));
            for (corners, triangle) in source.triangles().iter().zip(0..) {
                if let Some(body) = self.bodies.of_triangle(number as u32, triangle) {
                    let known = &mut boxes[body as usize];
                    for &vertex in corners {
                        *known = grown(*known, source.positions().get(vertex));
                    }
                }
            }
        }
        boxes
    }

    /// The arguments with the largest and the smallest bodies, and their longest sides, if they may
    /// be of different units.
    ///
    /// Bodies are measured by the longest side of their box, in the current frame. `None` where the
    /// sides differ by less than a factor of 100. Costs O(t) for t triangles.
    pub fn unlike_sizes(&self) -> Option<[(&str, f64); 2]> {
        let mut sides: BTreeMap<&str, f64> = BTreeMap::new();
        for (number, source) in self.sequence.sources.iter().enumerate() {
            let [lower, upper] = self.box_of(number);
            let longest = (0..3).map(|axis| upper[axis] - lower[axis]);
            let longest = longest.fold(0.0, f64::max);
            let known = sides.entry(source.argument()).or_default();
            *known = known.max(longest);
        }
        // A point has no size, and so no unit.
        let sides = || sides.iter().filter(|&(_, &side)| side > 0.0);
        let by_side = |a: &(&&str, &f64), b: &(&&str, &f64)| a.1.total_cmp(b.1);
        let two = [sides().max_by(by_side)?, sides().min_by(by_side)?];
        let [(large, &most), (small, &least)] = two;
        (most >= MOST_UNLIKE * least).then_some([(*large, most), (*small, least)])
    }

    /// Reads and checks the next frame; `None` after the last.
    ///
    /// The mesh of a source may change from file to file: [`Found::changed`]. Triangles are
    /// numbered as in the frame.
    ///
    /// # Errors
    ///
    /// A file cannot be read, or there are more pairs than may be listed or counted. No frame
    /// follows: every later call fails too.
    pub fn next_frame(&mut self) -> Result<Option<Found>, Error> {
        self.next_frame_unless(None)
    }

    /// [`next_frame`](Self::next_frame) with a callback that can stop it.
    ///
    /// `stop` is called again and again during the search, as [`pliant::Query::interrupt_if`]
    /// describes.
    ///
    /// # Errors
    ///
    /// See [`next_frame`](Self::next_frame). If `stop` returned true, [`Error::Interrupted`]: then
    /// the same frame can be asked for again.
    pub fn next_frame_unless(
        &mut self,
        stop: Option<&(dyn Fn() -> bool + Sync)>,
    ) -> Result<Option<Found>, Error> {
        self.ending_at(self.frames.start, |check| check.search_frame(stop))
    }

    fn search_frame(&mut self, stop: Option<Question>) -> Result<Option<Found>, Error> {
        if self.frames.count == 0 {
            return Ok(None);
        }
        self.from = None;
        if let Some(Rest::Frame(frame)) = self.asked.rest
            && !self.sequence.knows_rest()
        {
            self.go_to(frame)?;
            self.sequence.rest_in(frame)?;
        }
        if let Some(KnownPairs {
            frame, known: None, ..
        }) = self.baseline
        {
            let wanted = Wanted {
                first: false,
                crossing: false,
                listed: true,
                places: false,
            };
            let found = self.found_in(frame, wanted, stop)?;
            if let Some(baseline) = &mut self.baseline {
                baseline.take(found, &self.sequence);
            }
        }
        let frame = self.frames.start;
        let wanted = Wanted {
            first: self.asked.first,
            crossing: self.asked.crossing,
            listed: self.asked.listed,
            places: self.asked.places && !self.asked.first,
        };
        let mut found = self.found_in(frame, wanted, stop)?;
        let meshes = self.sequence.meshes.clone();
        let is_told = |&source: &usize| self.told[source] == meshes[source];
        let changed = (0..meshes.len()).filter(|source| !is_told(source));
        let changed: Vec<usize> = changed.collect();
        self.places.forget(&changed);
        if self.asked.inside && self.bodies.count() > 1 {
            let (bodies, pieces) = (
                (&self.bodies, &self.filter, self.asked.options),
                &mut self.pieces,
            );
            let inside = solid::inside(&mut self.sequence, bodies, pieces, stop);
            found.inside = Some(inside.map_err(|error| self.refused(frame, error))?);
        }
        if wanted.places {
            let mut places = self
                .places
                .end(&SplitSources(&self.sequence.sources, &self.bodies));
            if self.asked.solid {
                let both = (&self.places, &mut places[..]);
                let said = solid::say_depths(&mut self.sequence, both, stop);
                said.map_err(|error| self.refused(frame, error))?;
            }
            self.lives.take(frame, &places);
            found.places = Some(places);
        }
        let changed = changed.into_iter();
        found.changed = changed.map(|it| self.bodies.of_source(it).start).collect();
        self.told = meshes;
        self.remarks.end(frame, &self.sequence.sources);
        self.frames.start = frame.saturating_add(self.frames.step);
        self.frames.count -= 1;
        self.from = Some(frame);
        Ok(Some(found))
    }

    /// Finds impacts between the frame checked last and the next one, if [`Settings::swept`] is
    /// set.
    ///
    /// `None` before the first frame, after the last, and when this interval was returned already.
    /// An interval that is not asked for costs nothing.
    ///
    /// ```
    /// # let folder = format!("pliant-check-swept-{}", std::process::id());
    /// # let folder = std::env::temp_dir().join(folder);
    /// # std::fs::create_dir_all(&folder)?;
    /// # for (name, z) in [("leaf_0.obj", 2), ("leaf_1.obj", -2)] {
    /// #     let corners = format!("v 1 1 {z}\nv 2 1 {z}\nv 1 2 {z}\n");
    /// #     std::fs::write(folder.join(name), corners + "f 1 2 3\n")?;
    /// # }
    /// # std::fs::write(folder.join("floor.obj"), "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n")?;
    /// # let arguments = ["leaf_*.obj", "floor.obj"];
    /// # let arguments = arguments.map(|name| folder.join(name).display().to_string());
    /// use pliant_check::{Check, Settings};
    /// use pliant_io::OpenOptions;
    ///
    /// // "leaf_*.obj", which is above "floor.obj" in the first frame and below it in the second.
    /// let mut settings = Settings::default();
    /// settings.swept = true;
    /// let mut check = Check::open(&arguments, &OpenOptions::default(), &settings)?;
    /// while let Some(found) = check.next_frame()? {
    ///     assert_eq!(found.count, 0);
    ///     if let Some(interval) = check.next_interval()? {
    ///         // Its three corners meet the floor half way.
    ///         assert_eq!((interval.frame, interval.until, interval.count), (0, 1, 3));
    ///         assert_eq!(interval.first.map(|first| first.time()), Some(0.5));
    ///     }
    /// }
    /// # std::fs::remove_dir_all(&folder)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// The sources then have the positions of the next frame. The world stays in the frame checked
    /// last, with a motion to the next, unless a mesh changes. Its seams are closed where they are
    /// closed in both frames.
    ///
    /// # Errors
    ///
    /// See [`next_frame`](Self::next_frame).
    pub fn next_interval(&mut self) -> Result<Option<Interval>, Error> {
        self.next_interval_unless(None)
    }

    /// [`next_interval`](Self::next_interval) with a callback that can stop it.
    ///
    /// # Errors
    ///
    /// See [`next_interval`](Self::next_interval). If `stop` returned true, [`Error::Interrupted`]:
    /// then the same interval can be asked for again.
    pub fn next_interval_unless(
        &mut self,
        stop: Option<&(dyn Fn() -> bool + Sync)>,
    ) -> Result<Option<Interval>, Error> {
        self.ending_at(self.frames.start, |check| check.search_interval(stop))
    }

    fn search_interval(&mut self, stop: Option<Question>) -> Result<Option<Interval>, Error> {
        let wanted = self.asked.swept && self.frames.count > 0;
        let Some(frame) = self.from.filter(|_| wanted) else {
            return Ok(None);
        };
        let until = self.frames.start;
        let changed = self.sequence.move_to(until)?;
        let interval = if changed.is_empty() {
            self.find_impacts(frame, until, stop)?
        } else {
            let changed = changed.into_iter();
            let bodies = changed.flat_map(|source| self.bodies.of_source(source));
            Interval::none(frame, until, bodies.collect())
        };
        self.from = None;
        Ok(Some(interval))
    }

    /// Goes to a frame and finds its pairs.
    fn found_in(
        &mut self,
        frame: usize,
        wanted: Wanted,
        stop: Option<Question>,
    ) -> Result<Found, Error> {
        self.go_to(frame)?;
        self.find(frame, wanted, stop)
    }

    fn go_to(&mut self, frame: usize) -> Result<(), Error> {
        let begins = self.sequence.ids.is_empty();
        self.sequence.go_to(frame)?;
        let mut meshes = self.sequence.meshes.iter().enumerate();
        let changed = meshes.find(|&(source, &mesh)| mesh != FIRST && self.bodies.is_split(source));
        if let Some((source, _)) = changed {
            return Err(Error::PiecesChanged {
                source_name: self.sequence.sources[source].name().to_owned(),
                frame,
                by_name: self.bodies.is_by_name(source),
            });
        }
        if let Some(baseline) = &mut self.baseline {
            baseline.compare(&self.sequence);
        }
        if begins {
            self.part_sources()
                .map_err(|error| self.refused(frame, error))?;
        }
        Ok(())
    }

    /// Tells the world which pairs of sources, and which sources with themselves, never meet.
    ///
    /// So no time is spent on them.
    fn part_sources(&mut self) -> Result<(), pliant::Error> {
        let with_themselves = self.sources_with_themselves();
        let Sequence { world, ids, .. } = &mut self.sequence;
        if !with_themselves.is_empty() {
            self.of = Selection::Everything;
            for (source, &id) in ids.iter().enumerate() {
                if with_themselves.binary_search(&source).is_err() {
                    with_world!(world, world => world.ignore(id, id))?;
                }
            }
        }
        if self.filter.lets_all_meet() {
            // With very many sources, the loop below would ask about too many pairs.
            return Ok(());
        }
        for b in 0..ids.len() {
            for a in 0..b {
                let bodies = [a, b].map(|source| self.bodies.of_source(source));
                let [of_a, of_b] = bodies;
                if !self.filter.any_meet(of_a, of_b) {
                    with_world!(world, world => world.ignore(ids[a], ids[b]))?;
                }
            }
        }
        Ok(())
    }

    /// Finds the pairs of the frame that the world is in.
    fn find(
        &mut self,
        frame: usize,
        wanted: Wanted,
        stop: Option<Question>,
    ) -> Result<Found, Error> {
        let Wanted {
            first,
            crossing,
            listed,
            ..
        } = wanted;
        let baseline = self.baseline.take();
        let known = baseline.as_ref().and_then(|it| it.known.as_ref());
        let known_pairs = known.map(|known| &known.pairs[..]);
        let lists_gaps = self.asked.within.is_some() && self.asked.closest_points;
        let more = match crossing {
            true => BYTES_OF_TOUCHING,
            false if lists_gaps => size_of::<Gap>(),
            false => 0,
        };
        let most = self.asked.max_list / (size_of::<Row>() + more) as u64;
        let most = usize::try_from(most).unwrap_or(usize::MAX);
        let skip = self.asked.skip_degenerate;
        let mut taker = Taker::new(frame, first, listed, most, known_pairs)
            .skip_degenerate(skip)
            .list_gaps(lists_gaps)
            .count_kinds(!first && self.asked.within.is_none());
        self.remarks.begin(frame);
        self.places.begin();
        let comparable = baseline.as_ref().map(|it| &it.comparable[..]);
        let any_will_do = first && !crossing && self.asked.within.is_none();
        let visited = if any_will_do && known.is_none() && !skip && !self.bodies.are_split() {
            self.take_first(&mut taker, stop)
        } else {
            self.take_all(&mut taker, wanted, comparable.unwrap_or(&[]), stop)
        };
        let mut found = taker.end();
        let mut visited = visited;
        // Of a frame whose first pair is known no other is asked for.
        let is_asked = self.asks_adjacent() && !(first && found.count > 0);
        if is_asked && matches!(visited, Ok(ControlFlow::Continue(()))) {
            let known = known.map(|known| known.adjacent.as_deref().unwrap_or_default());
            let most = most.saturating_sub(found.pairs.len());
            let taker = Taker::new(frame, first, listed, most, known)
                .skip_degenerate(skip)
                .count_kinds(true);
            let comparable = comparable.unwrap_or(&[]);
            match self.take_adjacent(taker, wanted, comparable, stop) {
                Ok((adjacent, stopped)) => {
                    found.adjacent = Some(adjacent);
                    visited = Ok(stopped);
                }
                Err(error) => visited = Err(error),
            }
        }
        self.baseline = baseline;
        let counts_edges = self.asked.crossing_edges && self.asked.within.is_none();
        if counts_edges && !first && matches!(visited, Ok(ControlFlow::Continue(()))) {
            match self.count_crossing_edges(stop) {
                Ok(counts) => found.crossing_edges = Some(counts),
                Err(error) => visited = Err(error),
            }
        }
        match visited.map_err(|error| self.refused(frame, error))? {
            ControlFlow::Break(Stop::Full(most)) => Err(Error::TooManyPairs { frame, most }),
            ControlFlow::Break(Stop::Endless) => {
                let most = MOST_COUNTED;
                Err(Error::Endless { frame, most })
            }
            ControlFlow::Continue(()) | ControlFlow::Break(Stop::First) => Ok(found),
        }
    }

    /// Whether pairs that share a vertex are asked for: wherever a source meets itself.
    pub fn asks_adjacent(&self) -> bool {
        !self.asked.ignore_adjacent
            && self.asked.within.is_none()
            && !self.sources_with_themselves().is_empty()
    }

    /// Whether the baseline has no pairs that share a vertex, although they are asked for.
    ///
    /// All that are found count as new then.
    pub fn lacks_adjacent(&self) -> bool {
        let known = self.baseline.as_ref().and_then(|it| it.known.as_ref());
        self.asks_adjacent() && known.is_some_and(|known| known.adjacent.is_none())
    }

    /// Takes the pairs that share a vertex and meet beyond it.
    fn take_adjacent(
        &mut self,
        mut taker: Taker,
        wanted: Wanted,
        comparable: &[bool],
        question: Option<Question>,
    ) -> Result<(Adjacent, ControlFlow<Stop>), pliant::Error> {
        let Self {
            of,
            sequence,
            bodies,
            filter,
            places,
            asked: Settings { itself, .. },
            ..
        } = self;
        let Sequence { world, sources, .. } = sequence;
        let mut stop = ControlFlow::Continue(());
        let mut touching = 0;
        let mut twice = BTreeSet::new();
        let mut take = |of_sources: Row, kind: ContactKind| {
            let Some(row) = row_asked(bodies, filter, *itself, of_sources) else {
                return ControlFlow::Continue(());
            };
            if wanted.crossing && kind == ContactKind::Touching {
                touching += 1;
                return ControlFlow::Continue(());
            }
            let [source, a, _, b] = of_sources.map(|number| number as usize);
            let degenerate = has_degenerate(sources, of_sources);
            let before = taker.count();
            let is_comparable = comparable.get(source) == Some(&true);
            stop = taker.take(
                row,
                How::Intersecting(Some(kind)),
                degenerate,
                is_comparable,
            );
            if taker.count() > before {
                let triangles = sources[source].triangles();
                let sorted = |triangle: usize| {
                    let mut corners = triangles[triangle];
                    corners.sort_unstable();
                    corners
                };
                if sorted(a) == sorted(b) {
                    twice.insert([source, b]);
                }
                if wanted.places {
                    places.take(&SplitSources(sources, bodies), of_sources, row);
                }
            }
            stop.map_break(|_| ())
        };
        let _ = with_world!(world, world => {
            unless(question, world.adjacent_intersections(*of))
                .visit(|contact| take(contact.pair.into(), contact.kind))
        })?;
        if wanted.crossing {
            taker.leave_touching(touching);
        }
        Ok((taker.end_adjacent(twice.len()), stop))
    }

    /// Finds impacts between two frames. The world is in the first, with a motion to the second.
    fn find_impacts(
        &mut self,
        frame: usize,
        until: usize,
        stop: Option<Question>,
    ) -> Result<Interval, Error> {
        let Settings {
            first,
            listed,
            max_list,
            ..
        } = self.asked;
        let most = max_list / size_of::<Impact<6>>() as u64;
        let most = usize::try_from(most).unwrap_or(usize::MAX);
        let mut taker = ImpactTaker::new(frame, until, first, listed, most);
        let taken = self.take_impacts(&mut taker, stop);
        match taken.map_err(|error| self.refused(frame, error))? {
            ControlFlow::Break(Stop::Full(most)) => {
                return Err(Error::TooManyImpacts { frame, until, most });
            }
            ControlFlow::Break(_) => {
                let most = MOST_COUNTED;
                return Err(Error::EndlessImpacts { frame, until, most });
            }
            ControlFlow::Continue(()) => {}
        }
        let interval = taker.end(&self.sequence, |body| self.bodies.source_of(body));
        interval.map_err(|error| self.refused(frame, error))
    }

    /// Shows `taker` all impacts; only the first, if that is asked for and the world can find it
    /// alone.
    fn take_impacts(
        &mut self,
        taker: &mut ImpactTaker,
        question: Option<Question>,
    ) -> Result<ControlFlow<Stop>, pliant::Error> {
        let of = self.of;
        let is_all_asked = !self.bodies.are_split() && !self.asked.skip_degenerate;
        if self.asked.first && is_all_asked {
            let first = with_world!(&mut self.sequence.world, world => match question {
                Some(question) => world.interruptible(question).first_impact(of, WIDTH),
                None => world.first_impact(of, WIDTH),
            })?;
            match first {
                None => return Ok(ControlFlow::Continue(())),
                Some(first) if first.high() > 0.0 => {
                    return Ok(taker.take(first.into(), [first.low(), first.high()]));
                }
                // The world stops at contacts of the frame itself; impacts behind them need all.
                Some(_) => {}
            }
        }
        let given = self.sequence.given;
        if self.owners.is_empty() || self.owners_of != given || self.asked.skip_degenerate {
            self.owners = self.owners_now(self.asked.skip_degenerate)?;
            self.owners_of = given;
        }
        let Self {
            sequence,
            bodies,
            filter,
            owners,
            asked: Settings { itself, .. },
            ..
        } = self;
        let bodies_of = (0..owners.len()).map(|source| bodies.of_source(source).start);
        let bodies_of: Vec<u32> = bodies_of.collect();
        let is_asked = |&[a, b]: &[u32; 2]| (a != b || *itself) && filter.meet(a, b);
        let mut take = |pair: ElementPair, cell: [f64; 2]| {
            let (ElementPair::VertexTriangle([source_a, a, source_b, b])
            | ElementPair::EdgeEdge([source_a, a, source_b, b])) = pair;
            let of_element = |source: u32, of: &dyn Fn(&Owners) -> &[u32]| {
                let source = source as usize;
                let whole = || std::slice::from_ref(&bodies_of[source]);
                owners[source].as_ref().map_or_else(whole, of)
            };
            // An element between two bodies is of both. Of the pairs that may meet, the smallest
            // counts.
            let pair = if let ElementPair::VertexTriangle(_) = pair {
                let of_a = of_element(source_a, &|it| it.of_vertex(a));
                let of_b = of_element(source_b, &|it| it.of_triangle(b));
                let mut pairs = of_a.iter().flat_map(|&a| of_b.iter().map(move |&b| [a, b]));
                let row = pairs.find(is_asked);
                row.map(|[body_a, body_b]| ElementPair::VertexTriangle([body_a, a, body_b, b]))
            } else {
                let of_a = of_element(source_a, &|it| it.of_edge(a));
                let of_b = of_element(source_b, &|it| it.of_edge(b));
                let pairs = of_a.iter().flat_map(|&a| of_b.iter().map(move |&b| [a, b]));
                let rows = pairs.filter(is_asked).map(|[body_a, body_b]| {
                    let (one, other) = ((body_a, a), (body_b, b));
                    let ((body_a, a), (body_b, b)) = (one.min(other), one.max(other));
                    [body_a, a, body_b, b]
                });
                rows.min().map(ElementPair::EdgeEdge)
            };
            pair.map_or(ControlFlow::Continue(()), |pair| taker.take(pair, cell))
        };
        with_world!(&mut sequence.world, world => {
            let vertices = unless(question, world.vertex_triangle_impacts(of)).width(WIDTH);
            let taken = vertices.visit(|it| take(it.pair.into(), [it.low, it.high]))?;
            if taken.is_break() {
                return Ok(taken);
            }
            let edges = unless(question, world.edge_edge_impacts(of)).width(WIDTH);
            edges.visit(|it| take(it.pair.into(), [it.low, it.high]))
        })
    }

    /// Owners of the elements of all sources for the current motion; `None` for a source of one
    /// body.
    ///
    /// Without triangles that are degenerate in both frames, if `skip` is set.
    fn owners_now(&self, skip: bool) -> Result<Vec<Option<Owners>>, pliant::Error> {
        let Sequence {
            sources,
            world,
            ids,
            ..
        } = &self.sequence;
        let owners = sources.iter().zip(ids).enumerate();
        let owners = owners.map(|(number, (source, &id))| {
            if !skip && !self.bodies.is_split(number) {
                return Ok(None);
            }
            let body = |triangle| self.bodies.of_triangle(number as u32, triangle);
            with_world!(world, world => {
                let triangles = world.triangles(id)?;
                let start = if skip { world.positions(id)? } else { Vec::new() };
                let end = source.positions();
                let counts = |&triangle: &u32| {
                    let corners = triangles[triangle as usize];
                    let before = corners.map(|it| start[it as usize].map(f64::from));
                    !pliant::exact::is_degenerate(before)
                        || !pliant::exact::is_degenerate(corners.map(|it| end.get(it)))
                };
                let body = |triangle| body(triangle).filter(|_| !skip || counts(&triangle));
                let edges = world.edges(id)?;
                Ok(Some(Owners::of(triangles, source.vertex_count(), edges, body)))
            })
        });
        owners.collect()
    }

    /// Counts the edges that cross triangles, for every two bodies with any.
    fn count_crossing_edges(
        &mut self,
        question: Option<Question>,
    ) -> Result<Vec<CrossingEdges>, pliant::Error> {
        // With the bodies of its triangles where a source is split.
        let owners = self.owners_now(false)?;
        let Self {
            of,
            sequence,
            bodies,
            filter,
            asked: Settings { itself, .. },
            ..
        } = self;
        let is_asked = |a: u32, b: u32| (a != b || *itself) && filter.meet(a, b);
        let mut counts: BTreeMap<[u32; 2], CrossingEdges> = BTreeMap::new();
        let mut seen: HashSet<[u32; 3]> = HashSet::new();
        let mut count = |crossing: pliant::CrossingEdge| {
            let (source, other) = (crossing.edge_body.0, crossing.triangle_body.0);
            let whole = [bodies.of_source(source as usize).start];
            let of_edge = owners[source as usize].as_ref();
            let of_edge = of_edge.map_or(&whole[..], |owners| owners.of_edge(crossing.edge));
            let Some(triangle_body) = bodies.of_triangle(other, crossing.triangle) else {
                return;
            };
            for &edge_body in of_edge
                .iter()
                .filter(|&&body| is_asked(body, triangle_body))
            {
                let new = CrossingEdges::none(edge_body, triangle_body);
                let of_two = counts.entry([edge_body, triangle_body]).or_insert(new);
                of_two.pairs += 1;
                let is_new = seen.insert([edge_body, triangle_body, crossing.edge]);
                of_two.edges += usize::from(is_new);
            }
        };
        let _ = with_world!(&mut sequence.world, world => {
            unless(question, world.crossing_edges(*of)).visit(|crossing| {
                count(crossing);
                ControlFlow::<()>::Continue(())
            })
        })?;
        Ok(counts.into_values().collect())
    }

    /// Shows `taker` any one pair, by the world's faster query for the first.
    fn take_first(
        &mut self,
        taker: &mut Taker,
        stop: Option<Question>,
    ) -> Result<ControlFlow<Stop>, pliant::Error> {
        let of = self.of;
        let world = &mut self.sequence.world;
        let first = with_world!(world, world => {
            unless(stop, world.intersections(of)).first()
        })?;
        let sources = &mut self.sequence.sources;
        Ok(first.map_or(ControlFlow::Continue(()), |pair| {
            let row = pair.into();
            self.remarks.take(taker.frame(), sources, row);
            taker.take(
                row,
                How::Intersecting(None),
                has_degenerate(sources, row),
                false,
            )
        }))
    }

    /// Shows `taker` all pairs of bodies that meet, until it has enough.
    fn take_all(
        &mut self,
        taker: &mut Taker,
        wanted: Wanted,
        comparable: &[bool],
        question: Option<Question>,
    ) -> Result<ControlFlow<Stop>, pliant::Error> {
        let mut crossing = Vec::new();
        if wanted.crossing {
            match self.all_crossing(taker, question)? {
                ControlFlow::Continue(pairs) => crossing = pairs,
                ControlFlow::Break(stop) => return Ok(ControlFlow::Break(stop)),
            }
        }
        let Self {
            of,
            sequence,
            bodies,
            filter,
            remarks,
            places,
            asked: Settings { itself, within, .. },
            ..
        } = self;
        let counts_kinds = taker.counts_kinds();
        let mut stop = ControlFlow::Continue(());
        let Sequence { world, sources, .. } = sequence;
        let mut take = |of_sources: Row, how: How| {
            if let Some(row) = row_asked(bodies, filter, *itself, of_sources) {
                if !matches!(how, How::Close(_)) {
                    remarks.take(taker.frame(), sources, of_sources);
                }
                let [a, _, b, _] = of_sources.map(|number| number as usize);
                let comparable = [a, b].map(|source| comparable.get(source) == Some(&true));
                let degenerate = has_degenerate(sources, of_sources);
                let before = taker.count();
                stop = taker.take(row, how, degenerate, comparable == [true; 2]);
                if wanted.places && taker.count() > before {
                    places.take(&SplitSources(sources, bodies), of_sources, row);
                }
            }
            if stop.is_break() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        if wanted.crossing {
            for (of_sources, kind) in crossing {
                if take(of_sources, How::Intersecting(Some(kind))).is_break() {
                    break;
                }
            }
            return Ok(stop);
        }
        let _ = with_world!(world, world => match *within {
            None if counts_kinds => unless(question, world.contacts(*of))
                .visit(|contact| take(contact.pair.into(), How::Intersecting(Some(contact.kind)))),
            None => unless(question, world.intersections(*of))
                .visit(|pair| take(pair.into(), How::Intersecting(None))),
            Some(most) => unless(question, world.close_triangle_pairs(*of, most))
                .visit(|close| {
                    // The computed distance is off by up to a billionth. The library decides
                    // exactly that it is at most `most`.
                    let distance = close.distance.min(most);
                    let points = [close.point_a, close.point_b];
                    take(close.pair.into(), How::Close(Closeness { distance, points }))
                }),
        })?;
        Ok(stop)
    }

    /// All pairs, in terms of sources, in places that do not only touch. Tells `taker` how many
    /// others there are.
    fn all_crossing(
        &mut self,
        taker: &mut Taker,
        question: Option<Question>,
    ) -> Result<ControlFlow<Stop, Vec<(Row, ContactKind)>>, pliant::Error> {
        let Self {
            of,
            sequence,
            bodies,
            filter,
            asked: Settings { itself, .. },
            ..
        } = self;
        let Sequence { world, sources, .. } = sequence;
        let mut pairs: Vec<(Row, ContactKind)> = Vec::new();
        let visited = with_world!(world, world => unless(question, world.contacts(*of))
        .visit(|contact| {
            let of_sources = contact.pair.into();
            if row_asked(bodies, filter, *itself, of_sources).is_some() {
                if pairs.len() >= taker.most() || pairs.try_reserve(1).is_err() {
                    return ControlFlow::Break(());
                }
                pairs.push((of_sources, contact.kind));
            }
            ControlFlow::Continue(())
        }))?;
        if visited.is_break() {
            return Ok(ControlFlow::Break(Stop::Full(pairs.len())));
        }
        let only_touch = only_touch(&SplitSources(sources, bodies), &pairs);
        taker.leave_touching(only_touch.iter().filter(|&&it| it).count());
        let mut only_touch = only_touch.into_iter();
        pairs.retain(|_| only_touch.next() == Some(false));
        Ok(ControlFlow::Continue(pairs))
    }

    /// Sources that may have pairs with themselves: of one body, or between its pieces.
    fn sources_with_themselves(&self) -> Vec<usize> {
        let is_asked = |&source: &usize| {
            let of_source = self.bodies.of_source(source);
            (self.asked.itself || of_source.len() > 1)
                && self.filter.any_meet(of_source.clone(), of_source)
        };
        (0..self.sequence.sources.len()).filter(is_asked).collect()
    }

    fn refused(&self, frame: usize, error: pliant::Error) -> Error {
        if error.kind == ErrorKind::Interrupted {
            return Error::Interrupted { frame };
        }
        let sources = &self.sequence.sources;
        let source = error.body.and_then(|body| sources.get(body.0 as usize));
        Error::Refused {
            source_name: source.map_or_else(String::new, |source| source.name().to_owned()),
            frame,
            error,
        }
    }
}

/// Refuses settings that contradict each other, for a count of frames to be checked.
fn refuse_contradictions(
    asked: &Settings,
    frames: usize,
    are_all_labelled: bool,
) -> Result<(), Error> {
    match asked.within {
        Some(distance) if !(distance >= 0.0 && distance.is_finite()) => {
            return Err(Error::Distance(distance));
        }
        Some(_) if asked.itself && asked.rest.is_none() && !are_all_labelled => {
            return Err(Error::WithinItself);
        }
        Some(_) if asked.crossing => return Err(Error::CrossingWithin),
        None if asked.rest.is_some() => return Err(Error::RestAlone),
        _ => {}
    }
    if !asked.labels.is_empty() && (asked.crossing || asked.swept) {
        return Err(Error::LabelsWith { swept: asked.swept });
    }
    if asked.swept {
        match asked {
            _ if frames < 2 => {
                return Err(Error::SweptOneFrame { count: frames });
            }
            Settings {
                within: Some(_), ..
            } => return Err(Error::SweptWithin),
            Settings {
                baseline: Some(_), ..
            } => return Err(Error::SweptBaseline),
            _ => {}
        }
    }
    Ok(())
}
