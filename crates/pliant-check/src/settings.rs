//! Settings of a [`Check`](crate::Check): the question that it answers.

use pliant::Options;
use std::path::PathBuf;

/// Settings of a check. The default finds all pairs between different bodies, in all frames.
#[derive(Clone, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a choice of its own")]
pub struct Settings {
    /// Checks each body against itself too. A single body always is.
    pub itself: bool,
    /// Finds pairs of different bodies at most this far apart, instead of intersecting pairs.
    ///
    /// In units of the positions. An intersecting pair is at distance 0. Neighbours in a body
    /// always are close. So of one body alone, and with [`itself`](Self::itself), a distance needs
    /// a [rest shape](Self::rest), or [labels](Self::labels) of all sources.
    pub within: Option<f64>,
    /// Rest shape of every source, for [`within`](Self::within): triangles of one source that are
    /// at most that far apart in it are left out.
    pub rest: Option<Rest>,
    /// Labels of the triangles of sources: pairs of equal labels are left out, and of labels that
    /// have a vertex in common. See [`World::set_labels`](pliant::World::set_labels).
    ///
    /// Not with [`crossing`](Self::crossing), whose places need all pairs, nor with
    /// [`swept`](Self::swept), which finds no pairs of triangles.
    pub labels: Vec<LabelFile>,
    /// Leaves out all pairs of places where surfaces only touch.
    ///
    /// Each surface then stays on one closed side of the other: along a cut, or where parts lie on
    /// each other. Kept are places where surfaces cross, or pass through each other at edges and
    /// vertices. Of pairs that share a vertex, those that only touch are left out.
    ///
    /// A place is also kept where sides are not clear:
    ///
    /// - at a triangle without area
    /// - at an edge of more than two triangles
    /// - at a sheet folded onto itself
    ///
    /// Places are formed of all pairs of bodies that may meet, including pairs that are left out
    /// for another reason. Not with [`within`](Self::within).
    pub crossing: bool,
    /// Leaves out pairs of one source that share a vertex and meet beyond it:
    /// [`Found::adjacent`](crate::Found).
    ///
    /// Otherwise they are found wherever a source meets itself, as one body or between its groups
    /// or pieces, but not with [`within`](Self::within).
    pub ignore_adjacent: bool,
    /// Also counts the edges that cross triangles, whatever pairs are left out:
    /// [`Found::crossing_edges`](crate::Found). Not with [`within`](Self::within).
    pub crossing_edges: bool,
    /// Lists the closest points of each pair within the distance, in [`Found::gaps`](crate::Found).
    ///
    /// Only where pairs of [`within`](Self::within) are listed. A pair then takes 88 bytes of
    /// [`max_list`](Self::max_list).
    pub closest_points: bool,
    /// Also finds impacts on the way from each checked frame to the next.
    ///
    /// [`Check::next_interval`](crate::Check::next_interval) returns them. Needs at least two
    /// frames. Not with [`within`](Self::within), nor with [`baseline`](Self::baseline), whose
    /// pairs are pairs of triangles.
    pub swept: bool,
    /// Also finds components of bodies that lie inside other bodies, which no pair tells:
    /// [`Found::inside`](crate::Found). Bodies that are not closed have no inside.
    pub inside: bool,
    /// Takes closed bodies for solids: says how deep each of [`places`](Self::places) is, in
    /// [`Place::depth`](crate::Place).
    pub solid: bool,
    /// Finds at most one pair in each frame: with [`within`](Self::within), the nearest.
    ///
    /// Between two frames, the first impact.
    pub first: bool,
    /// Keeps pairs in a list; otherwise they are only counted.
    pub listed: bool,
    /// Memory limit of a list of pairs, in bytes. The pairs of a [`baseline`](Self::baseline), or
    /// its file, may take as much again.
    ///
    /// A pair takes 16 bytes. With [`crossing`](Self::crossing) it takes 32, listed or not. An
    /// impact between two frames takes 40.
    pub max_list: u64,
    /// How sources are split into bodies. `None`: each source is a body.
    pub split: Option<Split>,
    /// Names for several bodies each, to be used in [`ignore`](Self::ignore).
    pub groups: Vec<Group>,
    /// Pairs of names whose bodies are not tested against each other.
    ///
    /// No body of the one name meets any of the other. A name paired with itself means that none of
    /// its bodies meets another of them, or itself.
    ///
    /// A name is one of:
    ///
    /// - a group of [`groups`](Self::groups)
    /// - a glTF file of several sources: all its bodies
    /// - a source: all bodies that it is split into
    /// - a body
    /// - an object of an OBJ file: all its groups that are bodies
    /// - the number of a body
    pub ignore: Vec<[String; 2]>,
    /// Known pairs, which are left out in every frame in which both bodies have the baseline's
    /// meshes.
    pub baseline: Option<Baseline>,
    /// Leaves out pairs with a triangle that has no area.
    ///
    /// Between two frames, leaves out triangles without area in both frames. Vertices and edges of
    /// such triangles only are left out too.
    pub skip_degenerate: bool,
    /// Joins the pairs of a frame into places, tracked over frames:
    /// [`Found::places`](crate::Found).
    ///
    /// Frames in which only the first pair is asked for have no places. Tracking passes over them.
    pub places: bool,
    /// Selection of frames; `None` for all. Other frames are skipped, and not read where the format
    /// allows.
    pub frames: Option<Frames>,
    /// Options of the world. No option changes an answer.
    pub options: Options,
}

/// How a source is split into bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Split {
    /// Connected components: triangles that share a vertex, after welding, are of one piece.
    ///
    /// Pieces of `shirt.ply` are `shirt.ply#1`, `shirt.ply#2`, … in the order of their lowest
    /// triangle.
    Components,
    /// Groups of OBJ files, as [`pliant_io::Body::groups`] names them.
    ///
    /// Groups of `shirt.obj` are `shirt.obj#collar`, … in the order of their lowest triangle. A
    /// source that names none is one body.
    Groups,
}

/// Rest shape of sources.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Rest {
    /// Their shapes in this frame.
    Frame(usize),
    /// First frame of a file that has the mesh of the only source.
    File(PathBuf),
}

/// Labels of the triangles of a source, in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LabelFile {
    /// Name of the source, or the number of a body that is one.
    pub body: String,
    /// NumPy file (`.npy`) of integers, shape (m,): a label for each triangle of the first frame,
    /// or for each polygon of the file. A triangle with a negative one is left out of nothing.
    pub file: PathBuf,
}

/// Known pairs, which are left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Baseline {
    /// Intersecting pairs of this frame.
    Frame(usize),
    /// Pairs of any frame of an earlier check, as `pliant check --format json` wrote them.
    ///
    /// Bodies must have the same names and the same numbers of triangles as in the file.
    File(PathBuf),
}

/// A name for several bodies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Group {
    /// Name of the group; not the name of a body.
    pub name: String,
    /// Names of files, sources or bodies, or numbers of bodies.
    pub bodies: Vec<String>,
}

/// An arithmetic sequence of frame numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frames {
    /// First frame.
    pub start: usize,
    /// Difference between one frame and the next.
    pub step: usize,
    /// Number of frames; `usize::MAX` for all from `start` on.
    pub count: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            itself: false,
            within: None,
            rest: None,
            labels: Vec::new(),
            swept: false,
            crossing: false,
            ignore_adjacent: false,
            crossing_edges: false,
            closest_points: false,
            inside: false,
            solid: false,
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
