//! What was found, to look at: `--report` and `--png` of the verbs that play or check something.
//!
//! Without them nothing here does anything: no pair is kept, no position is copied.

use crate::output::{self, MARK, Overwrite};
use crate::table::grouped;
use anyhow::bail;
use clap::Args;
use pliant::{Scalar, World};
use pliant_io::shown_within;
use pliant_report::picture::{self, Picture};
use pliant_report::{BodyLabel, Chart, Motion, Play, Recorder, Report, Series};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Where pictures go.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct PictureOptions {
    /// Write a page about what was found, one file that needs no network: the bodies in motion, what intersects in red
    #[arg(long, value_name = "FILE.html", value_parser = page_name)]
    report: Option<PathBuf>,
    /// Draw one frame as an image, what intersects in red, faintly so where it is hidden
    #[arg(long, value_name = "FILE.png", value_parser = image_name)]
    png: Option<PathBuf>,
    /// The frame, or the step, that --png draws; needed unless there is only one
    #[arg(long, value_name = "N", requires = "png", allow_negative_numbers = true, value_parser = frame::<u32>)]
    frame: Option<u32>,
    #[command(flatten)]
    pub(crate) over: Overwrite,
}

impl PictureOptions {
    /// Whether anything is to be drawn.
    pub(crate) fn any(&self) -> bool {
        self.report.is_some() || self.png.is_some()
    }
}

/// The number of a frame.
pub(crate) fn frame<N: FromStr>(text: &str) -> Result<N, String> {
    text.parse()
        .map_err(|_| "write the number of a frame, from 0".to_owned())
}

/// A name that is a page's: a mistyped argument must not cost somebody a mesh.
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

/// Writes a page.
pub(crate) fn write_page(path: &Path, report: &Report, over: Overwrite) -> anyhow::Result<()> {
    output::write(path, MARK, over, |out| {
        out.write_all(report.page().as_bytes())
    })
}

/// Looks at each frame, if anybody wants to see it.
pub(crate) struct Watcher {
    options: PictureOptions,
    recorder: Option<Recorder>,
}

impl Watcher {
    /// `numbers`: the frames there will be. `labels` are asked for if there is to be a page.
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
                "--frame {frame}: no such {along} is looked at; the first is {first}, the last {last}"
            ),
            None if options.png.is_some() && first != last => bail!(
                "--png draws one {along}: say which with --frame; the first is {first}, the last {last}"
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
        })
    }

    /// Whether the pairs of this frame are.
    pub(crate) fn looks_at(&self, number: u32) -> bool {
        self.recorder.is_some() || self.options.frame == Some(number)
    }

    /// Takes a frame: its pairs are body, triangle, body, triangle.
    pub(crate) fn frame<S: Scalar>(
        &mut self,
        number: u32,
        world: &World<S>,
        pairs: &[[u32; 4]],
    ) -> anyhow::Result<()> {
        if let Some(recorder) = &mut self.recorder {
            recorder.frame(number, world, pairs);
        }
        if let Some(path) = self
            .options
            .png
            .as_ref()
            .filter(|_| self.options.frame == Some(number))
        {
            let picture = Picture::of(world, pairs, picture::SIZE);
            output::write(path, MARK, self.options.over, |out| picture.write_png(out))?;
        }
        Ok(())
    }

    /// Writes the page, if there is to be one. `tell` adds what it knows about the play.
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
        report.found = found(&motion, along);
        let mut play = Play::new(name, along);
        play.facts = facts(&motion, along);
        tell(&motion, &mut play);
        play.charts.push(pairs_chart(&motion, along));
        report.add(play, motion);
        write_page(path, &report, self.options.over)
    }
}

/// The command, as it could be typed again.
pub(crate) fn asked() -> String {
    let words = std::env::args_os().skip(1).map(|word| {
        // Whole: it is to be typed again.
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

/// In a sentence or two.
fn found(motion: &Motion, along: &str) -> String {
    let all = motion.pairs().len();
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
                "Something intersects in {hit} of {} {along}s, first in {along} {first}. Most pairs: {}, in {along} {worst}.",
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

/// What every page has.
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

fn pairs_chart(motion: &Motion, along: &str) -> Chart {
    chart(
        &format!("intersecting pairs per {along}"),
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

/// A fact.
pub(crate) fn fact(name: &str, value: impl Into<String>) -> (String, String) {
    (name.to_owned(), value.into())
}
