//! Pages and pictures of what was found: `--report` and `--png` of the verbs `run` and `check`.
//!
//! Without these flags no pair is kept and no position is copied.

use crate::output::{self, MARK, Overwrite};
use crate::table::{grouped, short};
use anyhow::bail;
use clap::Args;
use pliant::{BodyId, Scalar, World};
use pliant_check::{Meshes, Place, Places};
use pliant_io::shown_within;
use pliant_report::picture::{self, Picture, Shot, View};
use pliant_report::{BodyLabel, Chart, Gap, Moment, Motion, Play, Recorder, Report, Series, Spot};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Flags for the page and the picture.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct PictureOptions {
    /// Write a page about what was found: one file that needs no network, with the bodies in motion
    /// and what intersects in red
    #[arg(long, value_name = "FILE.html", value_parser = page_name)]
    report: Option<PathBuf>,
    /// Draw one frame as an image: the place with the most pairs, and everything in an inset. What
    /// intersects is red, and faintly red where it is hidden
    #[arg(long, value_name = "FILE.png", value_parser = image_name)]
    png: Option<PathBuf>,
    /// The frame, or the step, that --png draws; needed unless there is only one
    #[arg(
        long,
        value_name = "N",
        requires = "png",
        allow_negative_numbers = true,
        value_parser = frame::<u32>
    )]
    frame: Option<u32>,
    /// The side from which --png looks, y up: corner (from the right, above and in front), front,
    /// back, left, right, top, bottom
    #[arg(long, value_name = "SIDE", requires = "png")]
    view: Option<View>,
    /// How large --png is, in pixels: 1280x960
    #[arg(long, value_name = "WxH", requires = "png", value_parser = size)]
    size: Option<[usize; 2]>,
    #[command(flatten)]
    pub(crate) over: Overwrite,
}

impl PictureOptions {
    /// Whether a page or a picture is asked for.
    pub(crate) fn any(&self) -> bool {
        self.report.is_some() || self.png.is_some()
    }
}

/// Parses the number of a frame.
pub(crate) fn frame<N: FromStr>(text: &str) -> Result<N, String> {
    text.parse()
        .map_err(|_| "write the number of a frame, from 0".to_owned())
}

/// Parses a picture's width and height in pixels.
fn size(text: &str) -> Result<[usize; 2], String> {
    let parts = text.split_once(['x', 'X']);
    let parsed =
        parts.and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    parsed
        .filter(|size: &[usize; 2]| size.iter().all(|length| (16..=8192).contains(length)))
        .ok_or_else(|| "write WIDTHxHEIGHT in pixels, each from 16 to 8192: 1280x960".to_owned())
}

/// Parses the file name of a page. Other endings are refused: a typing error must not cost a mesh.
pub(crate) fn page_name(name: &str) -> Result<PathBuf, String> {
    ends_in(name, &["html", "htm"])
}

fn image_name(name: &str) -> Result<PathBuf, String> {
    ends_in(name, &["png"])
}

fn ends_in(name: &str, endings: &[&str]) -> Result<PathBuf, String> {
    let path = PathBuf::from(name);
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    if ending.is_some_and(|ending| endings.contains(&ending.as_str())) {
        return Ok(path);
    }
    Err(format!(
        "give a name that ends in .{}, so that no other file is overwritten",
        endings[0]
    ))
}

/// Writes a page to a file.
pub(crate) fn write_page(path: &Path, report: &Report, over: Overwrite) -> anyhow::Result<()> {
    output::write(path, MARK, over, |out| {
        out.write_all(report.page().as_bytes())
    })
}

/// Records the frames that the page and the picture need; none if neither is asked for.
pub(crate) struct Watcher {
    options: PictureOptions,
    recorder: Option<Recorder>,
    /// The word for a frame: `frame` or `step`.
    along: String,
    /// Largest distance of pairs. `None`: pairs intersect.
    within: Option<f64>,
    /// A sentence about further findings.
    also: Option<String>,
    /// Finds the places of pairs where the caller has none.
    places: Places,
}

/// A world in its present frame, as meshes in which places are found.
struct Shown<'a, S: Scalar> {
    world: &'a World<S>,
    positions: Vec<Vec<[S; 3]>>,
}

impl<'a, S: Scalar> Shown<'a, S> {
    /// Copies the positions of bodies in `pairs` only.
    fn of(world: &'a World<S>, pairs: &[[u32; 4]]) -> Self {
        let mut hit: Vec<u32> = pairs.iter().flat_map(|&[a, _, b, _]| [a, b]).collect();
        hit.sort_unstable();
        hit.dedup();
        let mut positions = Vec::new();
        for body in hit {
            positions.resize(body as usize, Vec::new());
            positions.push(world.positions(BodyId(body)).unwrap_or_default());
        }
        Self { world, positions }
    }
}

impl<S: Scalar> Meshes for Shown<'_, S> {
    fn sizes(&self, body: u32) -> [usize; 2] {
        let triangles = self.world.triangle_count(BodyId(body)).unwrap_or_default();
        let vertices = self.positions.get(body as usize).map_or(0, Vec::len);
        [vertices, triangles]
    }

    fn corners(&self, body: u32, triangle: u32) -> [u32; 3] {
        let triangles = self.world.triangles(BodyId(body)).unwrap_or_default();
        triangles[triangle as usize]
    }

    fn position(&self, body: u32, vertex: u32) -> [f64; 3] {
        self.positions[body as usize][vertex as usize].map(S::to_f64)
    }
}

impl Watcher {
    /// Checks the flags and that files can be written. `numbers` are the numbers of all frames to
    /// come. `labels` is called if there is a page.
    pub(crate) fn new(
        options: &PictureOptions,
        labels: impl FnOnce() -> Vec<BodyLabel>,
        along: &str,
        numbers: impl Iterator<Item = u32> + Clone,
    ) -> anyhow::Result<Self> {
        let mut options = options.clone();
        let first = numbers.clone().next().unwrap_or_default();
        let is_there = |frame| numbers.clone().any(|number| number == frame);
        let is_missing = options.frame.is_some_and(|frame| !is_there(frame));
        let last = numbers.last().unwrap_or_default();
        match options.frame {
            Some(frame) if is_missing => bail!(
                "--frame {frame}: no such {along} is looked at; choose another: \
                 the first is {first}, the last {last}"
            ),
            None if options.png.is_some() && first != last => bail!(
                "--png draws one {along}: say which with --frame; \
                 the first is {first}, the last {last}"
            ),
            None if options.png.is_some() => options.frame = Some(first),
            _ => {}
        }
        for path in options.report.iter().chain(&options.png) {
            output::prepare(path, MARK, options.over)?;
        }
        Ok(Self {
            recorder: options.report.is_some().then(|| Recorder::new(labels())),
            options,
            along: along.to_owned(),
            within: None,
            also: None,
            places: Places::new(),
        })
    }

    /// Sets the largest distance of pairs. `None`: pairs intersect.
    pub(crate) fn within(mut self, within: Option<f64>) -> Self {
        self.within = within;
        self
    }

    /// Whether a page is written.
    pub(crate) fn has_page(&self) -> bool {
        self.recorder.is_some()
    }

    /// Adds a sentence about further findings.
    pub(crate) fn also_found(&mut self, sentence: String) {
        self.also = Some(sentence);
    }

    /// Records contacts between two frames. `world` is in the first, with a motion to the second.
    pub(crate) fn moment<S: Scalar>(&mut self, world: &World<S>, moment: &Moment) {
        if let Some(recorder) = &mut self.recorder {
            recorder.moment(world, moment);
        }
    }

    /// Whether the pairs of this frame are needed.
    pub(crate) fn looks_at(&self, number: u32) -> bool {
        self.recorder.is_some() || self.options.frame == Some(number)
    }

    /// Records a frame, and finds its places. Pairs are body, triangle, body, triangle.
    pub(crate) fn frame<S: Scalar>(
        &mut self,
        number: u32,
        world: &World<S>,
        pairs: &[[u32; 4]],
    ) -> anyhow::Result<()> {
        if !self.looks_at(number) {
            return Ok(());
        }
        let shown = Shown::of(world, pairs);
        self.places.begin();
        for &pair in pairs {
            self.places.take(&shown, pair, pair);
        }
        let places = self.places.end(&shown);
        self.frame_with(number, world, pairs, (&places, &[]), &[], |body| {
            format!("body {body}")
        })
    }

    /// Records a frame whose places are known, and the depths of triangles in them.
    ///
    /// `gaps` measures pairs that do not intersect, sorted by pair. `name` returns a body's name
    /// for the labels of places.
    pub(crate) fn frame_with<S: Scalar>(
        &mut self,
        number: u32,
        world: &World<S>,
        pairs: &[[u32; 4]],
        (places, deep): (&[Place], &[([u32; 2], f64)]),
        gaps: &[Gap],
        name: impl Fn(u32) -> String,
    ) -> anyhow::Result<()> {
        let spot = |place: &Place| Spot {
            number: place.number,
            count: place.count,
            lower: place.lower,
            upper: place.upper,
            depth: place.depth,
            label: label(place, &name),
        };
        let spots: Vec<Spot> = places.iter().map(spot).collect();
        if let Some(recorder) = &mut self.recorder {
            recorder.frame_with(number, world, pairs, &spots, gaps, deep);
        }
        if let Some(path) = self
            .options
            .png
            .as_ref()
            .filter(|_| self.options.frame == Some(number))
        {
            let shot = Shot {
                size: self.options.size.unwrap_or(picture::SIZE),
                view: self.options.view.unwrap_or_default(),
                spot: spots.first(),
                caption: caption(&self.along, number, pairs.len(), &spots),
            };
            let picture = Picture::shot(world, pairs, &shot);
            output::write(path, MARK, self.options.over, |out| picture.write_png(out))?;
        }
        Ok(())
    }

    /// Writes the page, if there is one. `tell` adds what it knows about the play.
    pub(crate) fn finish(
        self,
        name: &str,
        along: &str,
        tell: impl FnOnce(&Motion, &mut Play),
    ) -> anyhow::Result<()> {
        let (Some(recorder), Some(path)) = (self.recorder, &self.options.report) else {
            return Ok(());
        };
        let motion = recorder.finish();
        let mut report = Report::new(&asked());
        report.found = found(&motion, along, self.within);
        if let Some(also) = &self.also {
            report.found = format!("{} {also}", report.found);
        }
        let mut play = Play::new(name, along);
        play.within = self.within;
        play.facts = facts(&motion, along);
        tell(&motion, &mut play);
        play.charts.push(pairs_chart(&motion, along, self.within));
        report.add(play, motion);
        write_page(path, &report, self.options.over)
    }
}

/// Caption of a picture.
fn caption(along: &str, number: u32, pairs: usize, spots: &[Spot]) -> String {
    let pairs = match pairs {
        0 => "nothing intersects".to_owned(),
        pairs => counted(pairs as u64, "pair", "pairs"),
    };
    let places = match spots {
        [] | [_] => String::new(),
        [first, ..] => format!(
            " in {} places; here the largest, {}",
            grouped(spots.len() as u64),
            counted(first.count as u64, "pair", "pairs")
        ),
    };
    format!("{along} {number}: {pairs}{places}")
}

/// Names of the bodies of a place, and how long the curves there are.
fn label(place: &Place, name: impl Fn(u32) -> String) -> String {
    let mut parts = vec![whose(place, name)];
    if place.length > 0.0 {
        parts.push(format!("curves {} long", short(place.length)));
    }
    parts.retain(|part| !part.is_empty());
    parts.join(", ")
}

/// Names of the bodies of a place: the first two, and how many more.
fn whose(place: &Place, name: impl Fn(u32) -> String) -> String {
    let named = place.bodies.iter().take(2).map(|it| name(it.body));
    let named = named.collect::<Vec<_>>().join(", ");
    match place.bodies.len().saturating_sub(2) {
        0 => named,
        more => format!("{named} and {more} more"),
    }
}

/// The command line, quoted so that it can be typed again.
pub(crate) fn asked() -> String {
    let words = std::env::args_os().skip(1).map(|word| {
        // Not shortened: it is to be typed again.
        let word = shown_within(word, usize::MAX);
        let is_plain = |c: char| c.is_alphanumeric() || "-_./=:,+@%".contains(c);
        if !word.is_empty() && word.chars().all(is_plain) {
            word
        } else {
            format!("'{}'", word.replace('\'', r"'\''"))
        }
    });
    std::iter::once("pliant".to_owned())
        .chain(words)
        .collect::<Vec<_>>()
        .join(" ")
}

/// Summary of all frames in a sentence or two.
fn found(motion: &Motion, along: &str, within: Option<f64>) -> String {
    let all = motion.pairs().len();
    if let Some(within) = within {
        let close = format!("triangles that are at most {within} apart");
        return match (motion.first_contact(), motion.worst()) {
            (Some(first), Some((worst, most))) => {
                let hit = grouped(motion.frames_with_hits() as u64);
                let pairs = counted(most, "pair", "pairs");
                format!(
                    "There are {close} in {hit} of {} {along}s, first in {along} {first}. \
                     Most: {pairs}, in {along} {worst}.",
                    grouped(all as u64)
                )
            }
            _ => format!("There are no {close}."),
        };
    }
    match (motion.first_contact(), motion.worst()) {
        (Some(_), Some((worst, most))) if all == 1 => {
            format!(
                "{} in {along} {worst}.",
                counted(most, "intersecting pair", "intersecting pairs")
            )
        }
        (Some(first), Some((worst, most))) => {
            let hit = grouped(motion.frames_with_hits() as u64);
            format!(
                "Something intersects in {hit} of {} {along}s, first in {along} {first}. \
                 Most pairs: {}, in {along} {worst}.",
                grouped(all as u64),
                grouped(most),
            )
        }
        _ if all == 1 => format!("Nothing intersects in this one {along}."),
        _ => format!(
            "Nothing intersects in any of {} {along}s.",
            grouped(all as u64)
        ),
    }
}

/// Facts that every page shows.
fn facts(motion: &Motion, along: &str) -> Vec<(String, String)> {
    let none = || "none".to_owned();
    let [bodies, vertices, triangles] = motion.sizes().map(|size| grouped(size as u64));
    [
        ("bodies".to_owned(), bodies),
        ("triangles".to_owned(), triangles),
        ("vertices".to_owned(), vertices),
        (format!("{along}s"), grouped(motion.pairs().len() as u64)),
        (
            format!("{along}s with hits"),
            grouped(motion.frames_with_hits() as u64),
        ),
        (
            "first contact".to_owned(),
            motion
                .first_contact()
                .map_or_else(none, |number| format!("{along} {number}")),
        ),
        (
            "most pairs".to_owned(),
            motion.worst().map_or_else(none, |(number, most)| {
                format!("{} in {along} {number}", grouped(most))
            }),
        ),
    ]
    .to_vec()
}

fn pairs_chart(motion: &Motion, along: &str, within: Option<f64>) -> Chart {
    let which = within.map_or_else(
        || "intersecting pairs".to_owned(),
        |within| format!("pairs at most {within} apart"),
    );
    chart(
        &format!("{which} per {along}"),
        "pairs",
        along,
        motion.numbers(),
        [(
            "pairs".to_owned(),
            motion.pairs().iter().map(|&pairs| pairs as f64).collect(),
        )],
    )
}

pub(crate) fn chart(
    title: &str,
    unit: &str,
    along: &str,
    x: &[u32],
    lines: impl IntoIterator<Item = (String, Vec<f64>)>,
) -> Chart {
    let series = lines
        .into_iter()
        .map(|(name, values)| Series { name, values });
    Chart {
        title: title.to_owned(),
        unit: unit.to_owned(),
        along: along.to_owned(),
        x: x.to_vec(),
        series: series.collect(),
    }
}

pub(crate) fn counted(number: u64, one: &str, many: &str) -> String {
    format!(
        "{} {}",
        grouped(number),
        if number == 1 { one } else { many }
    )
}

/// A named fact on a page.
pub(crate) fn fact(name: &str, value: impl Into<String>) -> (String, String) {
    (name.to_owned(), value.into())
}
