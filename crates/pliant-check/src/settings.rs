//! What is asked.

use pliant::Options;
use std::path::PathBuf;

/// What a check is asked; the default asks for all pairs of different bodies in all frames.
#[derive(Clone, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a choice of its own")]
pub struct Settings {
    /// Each body against itself too. One body alone always is.
    pub itself: bool,
    /// Pairs of different bodies that are at most so far apart, intersecting ones at distance 0, instead of those that intersect. Of
    /// one body neighbours always are that close: it cannot be asked of one alone, nor with [`itself`](Self::itself).
    pub within: Option<f64>,
    /// Only places in which surfaces cross, or pass through each other at edges and vertices: pairs of others, where they touch and each stays
    /// on one closed side of the other, are left out. Along a cut for example, or where parts lie on each other. A place in which it is
    /// not clear what a side is stays: with a triangle without area, an edge of more than two triangles, or a sheet folded onto itself. All
    /// pairs are looked at, those that are left out for another reason too. Not with [`within`](Self::within).
    pub crossing: bool,
    /// Where pairs of [`within`](Self::within) are listed, so are the points in which they are closest: [`Found::gaps`](crate::Found). A
    /// pair then takes 88 bytes of [`max_list`](Self::max_list).
    pub closest_points: bool,
    /// Besides what intersects in a frame, what meets on the way from it to the next that is checked:
    /// [`Check::next_interval`](crate::Check::next_interval). Of one frame alone it cannot be asked, nor with [`within`](Self::within) or
    /// [`baseline`](Self::baseline), whose pairs are pairs of triangles.
    pub swept: bool,
    /// No more than one pair in each frame; with [`within`](Self::within) the nearest. Of what meets on the way to
    /// the next, the first.
    pub first: bool,
    /// Pairs are kept in a list; if not, they are only counted.
    pub listed: bool,
    /// The most bytes that a list of pairs may take, and again the list of those of [`baseline`](Self::baseline); a pair
    /// takes 16, with [`crossing`](Self::crossing) 32 whether it is listed or not, and two elements that meet on the way to the next frame
    /// take 40.
    pub max_list: u64,
    /// What is a body, if not each source.
    pub split: Option<Split>,
    /// Names for several bodies, to be used in [`ignore`](Self::ignore).
    pub groups: Vec<Group>,
    /// Pairs of names that do not meet: no body of the one meets any of the other. Twice the same: none of these bodies meets
    /// another of them, or itself.
    ///
    /// A name is that of a group, of a glTF file of several sources (all bodies of it), of a source (all bodies that it is split
    /// into), of a body, of an object of an OBJ file (all groups of it that are bodies), or a body's number.
    pub ignore: Vec<[String; 2]>,
    /// Pairs that are left out in all frames, wherever both bodies have the mesh that they have there.
    pub baseline: Option<Baseline>,
    /// Pairs with a triangle that has no area are left out. Of what meets on the way to the next frame, triangles that have none in
    /// either frame are, and vertices and edges of such triangles only.
    pub skip_degenerate: bool,
    /// The pairs of a frame are joined into places, which have the same numbers from frame to frame: [`Found::places`](crate::Found).
    /// Not in frames of which only the first pair is asked for; such a frame is as if it had been passed over.
    pub places: bool,
    /// Which frames are checked; all if `None`. Others are passed over, and not read where the format allows it.
    pub frames: Option<Frames>,
    /// How the world works. No choice changes an answer.
    pub options: Options,
}

/// What a source is split into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Split {
    /// Connected pieces: triangles that share a vertex, after welding, are of one piece. Those of `shirt.ply` are
    /// `shirt.ply#1`, `shirt.ply#2`, … in the order of their lowest triangle.
    Components,
    /// Groups of OBJ files: those of `shirt.obj` are `shirt.obj#collar`, … in the order of their lowest triangle, as
    /// [`pliant_io::Body::groups`] names them. A source that names none is one body.
    Groups,
}

/// Pairs that are known, and left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Baseline {
    /// Those that intersect in this frame.
    Frame(usize),
    /// Those of any frame of an earlier check, as `pliant check --format json` wrote it. Its bodies are those of the same names, and
    /// have as many triangles.
    File(PathBuf),
}

/// A name for several bodies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// The name; not that of a body.
    pub name: String,
    /// Names of files, sources or bodies, or numbers of bodies.
    pub bodies: Vec<String>,
}

/// So many frames, from one on, each so many-th.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frames {
    /// The first.
    pub start: usize,
    /// From one to the next.
    pub step: usize,
    /// How many; `usize::MAX` for all that there are from there on.
    pub count: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            itself: false,
            within: None,
            swept: false,
            crossing: false,
            closest_points: false,
            first: false,
            listed: true,
            max_list: u64::MAX,
            split: None,
            groups: Vec::new(),
            ignore: Vec::new(),
            baseline: None,
            skip_degenerate: false,
            places: false,
            frames: None,
            options: Options::default(),
        }
    }
}
