//! Content of a report.

use crate::chart::Chart;
use crate::frames::Motion;

/// A report: everything on one page.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The command that was run.
    pub asked: String,
    /// Summary of the results, in a sentence or two.
    pub found: String,
    /// Facts about the whole page: names and values.
    pub facts: Vec<(String, String)>,
    /// Plays, one after the other. On a page with several, the reader chooses.
    pub plays: Vec<Play>,
    /// Motions that plays show; several plays may show the same.
    pub motions: Vec<Motion>,
}

/// A motion with its facts and charts: of one method, or of several on the same motion.
#[derive(Clone, Debug)]
pub struct Play {
    /// Name of the play.
    pub name: String,
    /// Name of its steps: `step` or `frame`.
    pub along: String,
    /// Distance within which triangles are pairs; `None` if pairs are intersections.
    pub within: Option<f64>,
    /// Facts: names and values.
    pub facts: Vec<(String, String)>,
    /// Notes for the reader.
    pub notes: Vec<String>,
    /// Index of the motion in [`Report::motions`]; `None` if bodies are not shown.
    pub motion: Option<usize>,
    /// Charts of measurements.
    pub charts: Vec<Chart>,
}

impl Report {
    /// Creates an empty report about a command.
    pub fn new(asked: &str) -> Self {
        Self {
            asked: asked.to_owned(),
            ..Self::default()
        }
    }

    /// Adds a play that shows a motion of its own.
    pub fn add(&mut self, mut play: Play, motion: Motion) {
        play.motion = Some(self.motions.len());
        self.motions.push(motion);
        self.plays.push(play);
    }
}

impl Play {
    /// Creates a play without content.
    pub fn new(name: &str, along: &str) -> Self {
        Self {
            name: name.to_owned(),
            along: along.to_owned(),
            within: None,
            facts: Vec::new(),
            notes: Vec::new(),
            motion: None,
            charts: Vec::new(),
        }
    }
}
