//! What a page says.

use crate::chart::Chart;
use crate::frames::Motion;

/// Everything on one page.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// What was asked: the command.
    pub asked: String,
    /// What was found, in a sentence or two.
    pub found: String,
    /// Names and values that hold for the whole page.
    pub facts: Vec<(String, String)>,
    /// One after the other; a page with several lets its reader choose.
    pub plays: Vec<Play>,
    /// What plays show; several may show the same.
    pub motions: Vec<Motion>,
}

/// One motion, or some methods on one motion.
#[derive(Clone, Debug)]
pub struct Play {
    /// What it is called.
    pub name: String,
    /// What its steps are called: `step` or `frame`.
    pub along: String,
    /// How close triangles are that are pairs, if pairs are not those that intersect.
    pub within: Option<f64>,
    /// Names and values.
    pub facts: Vec<(String, String)>,
    /// What must be said about it.
    pub notes: Vec<String>,
    /// Bodies in motion, if they are shown: a place in the report's motions.
    pub motion: Option<usize>,
    /// What was measured.
    pub charts: Vec<Chart>,
}

impl Report {
    /// A page about a command.
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
    /// Nothing in it yet.
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
