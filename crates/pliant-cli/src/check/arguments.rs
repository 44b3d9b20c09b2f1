//! Arguments of `pliant check`.

use super::list_arguments::Many;
use super::names::{self, Names};
use crate::frames::Frames;
use crate::report::PictureOptions;
use crate::tree_options::threads;
use crate::{rate, size};
use clap::{Args, ValueEnum, ValueHint};
use pliant_check::{Baseline, Group, LabelFile, Rest};
use std::num::NonZeroUsize;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a flag of the program"
)]
pub(crate) struct Arguments {
    /// One body each: a mesh (.obj, .ply, .stl), a sequence (.npz), or a mesh with its positions
    /// (mesh.obj+walk.pc2, .mdd, .npy). A quoted pattern ('cloth_*.obj'): its files in natural
    /// order are the frames of one body. A glTF file (.glb, .gltf, .vrm): each of its bodies, or
    /// one (scene.glb#arm). One group of an OBJ file, or one solid of an STL file (scan.obj#arm),
    /// also of a pattern
    #[arg(
        value_name = "BODY",
        required_unless_present = "files_from",
        value_hint = ValueHint::FilePath
    )]
    pub(super) bodies: Vec<String>,
    /// Check each body against itself too; one body alone always is
    #[arg(long = "self")]
    pub(super) itself: bool,
    /// Report triangles of different bodies that are at most D apart, instead of those that
    /// intersect. D is in the unit of the files; triangles that intersect are 0 apart. One body,
    /// and --self, need --rest or --labels: in one body, neighbours always are that close
    #[arg(
        long,
        value_name = "D",
        allow_negative_numbers = true,
        value_parser = distance,
        conflicts_with = "png"
    )]
    pub(super) within: Option<f64>,
    /// With --within, leave out triangles of one file that are at most D apart in a rest shape.
    /// That is the shape in this frame, from 0, or in a file of the mesh
    #[arg(
        long,
        value_name = "FRAME|FILE",
        allow_negative_numbers = true,
        value_parser = names::rest,
        value_hint = ValueHint::FilePath,
        requires = "within"
    )]
    pub(super) rest: Option<Rest>,
    /// Leave out triangles of a body whose labels are equal or neighbours: parts such as upper and
    /// lower arm. FILE is a NumPy array of integers, one for each triangle or each polygon. Labels
    /// with a vertex in common are neighbours; a negative one leaves nothing out. For each body
    /// again; not with --crossing or --swept
    #[arg(
        long,
        value_name = "BODY=FILE.npy",
        value_parser = names::labels,
        conflicts_with_all = ["crossing", "swept"]
    )]
    pub(super) labels: Vec<LabelFile>,
    /// Leave out places where surfaces only touch, as along a cut. There no triangles cross, and no
    /// surface passes through another, not even exactly at edges and vertices. Where it is not
    /// clear what a side is, a place stays. Not with --within
    #[arg(long, conflicts_with = "within")]
    pub(super) crossing: bool,
    /// Take closed bodies for solids: a body that lies inside another, and meets none of its
    /// triangles, makes the exit code 1 too. Places have a depth: how far the deepest vertex is
    /// inside; --report colours them by it. What lies inside is said in any case
    #[arg(long)]
    pub(super) solid: bool,
    /// Leave out triangles of one body that share a vertex and meet beyond it. They go through each
    /// other elsewhere, lie folded onto each other, or are one triangle twice. They are counted
    /// apart, wherever a body is checked against itself, or groups of one file against each other
    #[arg(long)]
    pub(super) ignore_adjacent: bool,
    /// Only these frames: 100..200 are 100 to 199; 100.. and ..200 are open; 100 is one;
    /// 100..200:10 is every tenth. With --swept, each way then leads ten frames on
    #[arg(
        long,
        value_name = "A..B:STEP",
        default_value = "..",
        allow_negative_numbers = true
    )]
    pub(super) frames: Frames,
    /// Also find what meets on the way from each frame to the next, and when first: a vertex and a
    /// triangle, or two edges. Every corner moves on a straight line. Takes many times as long as
    /// the frames alone. Not with --within, --baseline, --hits, --format lines or github
    #[arg(long)]
    pub(super) swept: bool,
    /// Print only how many pairs, not which
    #[arg(long)]
    pub(super) count: bool,
    /// Stop at the first pair of each frame. With --within, that is the nearest pair. With --swept,
    /// stop also at the first to meet on the way to the next frame
    #[arg(long)]
    pub(super) first: bool,
    /// Make every connected piece of a file a body (FILE#1, FILE#2, ...), or every group of an OBJ
    /// file and solid of an STL file (FILE#NAME). Bodies come in the order of their lowest
    /// triangle, and triangles keep their numbers. Triangles that share a vertex of the file are
    /// left out
    #[arg(long, value_enum, value_name = "INTO")]
    pub(super) split: Option<Split>,
    /// Give several bodies a name, for --ignore. Each is named by its name, or by its number, from
    /// 0. A glTF file stands for all its bodies
    #[arg(long = "group", value_name = "NAME=BODY,BODY", value_parser = names::group)]
    pub(super) groups: Vec<Group>,
    /// Leave out pairs of two bodies, or of two groups. A,A leaves out pairs within the group A,
    /// also of each of its bodies with itself
    #[arg(long, value_name = "A,B", value_parser = names::two)]
    pub(super) ignore: Vec<Names>,
    /// Report only new pairs: leave out pairs that intersect in this frame, from 0, or in any frame
    /// of an earlier check. FILE is the output of that check with --format json
    #[arg(
        long,
        value_name = "FRAME|FILE",
        allow_negative_numbers = true,
        value_parser = names::baseline,
        value_hint = ValueHint::FilePath
    )]
    pub(super) baseline: Option<Baseline>,
    /// Leave out pairs with a triangle that has no area
    #[arg(long)]
    pub(super) skip_degenerate: bool,
    /// Keep vertices apart where boundary edges coincide; seams are then intersections
    #[arg(long)]
    pub(super) no_weld: bool,
    /// Also join boundary edges that are at most TOL times the diagonal of their body apart, in
    /// each frame: 1e-6
    #[arg(
        long,
        value_name = "TOL",
        default_value = "0",
        allow_negative_numbers = true,
        conflicts_with = "no_weld"
    )]
    pub(super) weld: f64,
    /// The most memory that a frame may take, also while seams are found: 4GiB, 512MiB, 1G, bytes.
    /// A list of pairs may take as much again. A frame that says it is larger is refused before it
    /// is read. With --files-from, the most of all jobs together
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = size::parse)]
    pub(super) max_memory: u64,
    /// The animation of glTF files, by name; the first if none is named
    #[arg(long, value_name = "NAME")]
    pub(super) clip: Option<String>,
    /// Frames a second at which animations of glTF files are evaluated
    #[arg(
        long,
        value_name = "N",
        default_value = "30",
        allow_negative_numbers = true,
        value_parser = rate::parse
    )]
    pub(super) fps: f64,
    /// How many threads share the work, at most; all: one for each core. No number changes an
    /// answer, and work that is small takes fewer
    #[arg(long, value_name = "T", default_value = "all", value_parser = threads)]
    pub(super) threads: NonZeroUsize,
    /// A table by frame, one JSON object, annotations for GitHub Actions, or a line for each pair:
    /// FRAME BODY TRIANGLE BODY TRIANGLE. jsonl, a JSON object for each check, and parquet are for
    /// --files-from
    #[arg(long, value_enum, default_value_t = Format::Table)]
    pub(super) format: Format,
    /// Write the triangles that intersect for ParaView, as .vtp or .vtu, and the curves in which
    /// they meet as lines. Each of several frames has a file, and a .pvd lists them all
    #[arg(long, value_name = "FILE")]
    pub(super) hits: Option<PathBuf>,
    /// Print nothing on standard output; the exit code says whether anything was found
    #[arg(short, long)]
    pub(super) quiet: bool,
    #[command(flatten)]
    pub(super) pictures: PictureOptions,
    #[command(flatten)]
    pub(super) many: Many,
}

const EXAMPLES: &str = "\
Examples:
  pliant check shirt.ply body.ply hair.ply --ignore hair.ply,body.ply
  pliant check a.ply b.ply c.ply --group soft=a.ply,c.ply --ignore soft,soft
  pliant check a,1.ply b.ply c.ply --ignore 0,2      by number: one has a comma
  pliant check teeth.ply --split components          which pieces meet?
  pliant check teeth.ply --split components --ignore 'teeth.ply#1,teeth.ply#2'
  pliant check scan.obj --split groups               which objects meet?
  pliant check 'scan.obj#arm' 'scan.obj#sleeve'      two of them
  pliant check scene.glb --ignore 'scene.glb#arm,scene.glb#sleeve'
  pliant check fox.glb --clip Run --baseline 0       what frame 0 does not have
  pliant check new.ply --baseline old.json           what an older check had not
  pliant check part.stl --weld 1e-6                  corners nearly coincide
  pliant check left.ply right.ply --crossing         not what only touches
  pliant check part.stl --ignore-adjacent            only what shares no vertex
  pliant check box.stl part.stl --solid              nothing inside either
  pliant check walk.npz --report walk.html           a page: in motion, hits red
  pliant check walk.npz --png worst.png --frame 50   its largest place
  pliant check a.ply --png a.png --view top --size 800x600
  pliant check walk.npz --frames 100..200:10         every tenth of these
  pliant check walk.npz --hits hits.vtp              hits_00.vtp, ... (ParaView)
  pliant check shirt.ply skin.ply --within 0.002     nothing closer than 2 mm?
  pliant check cloth.npz --within 0.002 --rest 0     nothing closer to itself?
  pliant check walk.npz --labels walk.npz=parts.npy  not at the joints
  pliant check shirt.npz skin.npz --swept            nothing jumps through?
  pliant check walk.npz --swept --report walk.html   with the moments of contact
  pliant check walk.npz --quiet && echo clean
  pliant check --files-from list.txt --out rows.jsonl     a check a line
  pliant check --files-from list.txt --out 0.jsonl --shard 0/2 --resume

With --swept, elements count that meet on the way, except those that meet in the frame already. \
An element that two bodies share is of both. \
The way leads from a frame to the next: where a mesh changes between them, nothing is looked for, \
and a note says so.
Exit code 0: nothing intersects, is at most D apart, or meets on the way. 1: something does; \
with --solid also if something lies inside a body. \
2: it could not be checked; standard error says why.
Memory: at most 3.5 times two frames (positions and triangles) and 12 MB, however many frames \
there are. 7.5 times two frames where the mesh changes from file to file, and 11 times with \
--swept. Five frames of positions more with --rest. With --labels 40 bytes a triangle, for parts \
of many triangles each, and at most 320. Beside it the pairs of one frame, where they are listed, \
left out or written, and their places: up to 60 bytes a vertex that is hit. With --crossing 32 \
bytes a pair and 200 a triangle near one. Of glTF bodies that move, \
the rest positions, joints, deltas and keys.
Too much? Check fewer bodies at once, or use --count or --first. \
--max-memory refuses larger frames before they are read.";

/// Parts of a file that become bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Split {
    Components,
    Groups,
}

/// Output formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    Table,
    Json,
    Github,
    Lines,
    Jsonl,
    Parquet,
}

/// Parses a distance: at least 0 and finite.
fn distance(text: &str) -> Result<f64, String> {
    let distance = text.parse().ok();
    distance
        .filter(|distance: &f64| *distance >= 0.0 && distance.is_finite())
        .ok_or_else(|| "write a distance in the unit of the files, at least 0: 0.002".to_owned())
}
