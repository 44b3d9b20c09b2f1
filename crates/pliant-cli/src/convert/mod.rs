//! `pliant convert`: writes a mesh or a sequence in another format.
//!
//! Frames are streamed, as in a check: one is in memory at a time. Vertices stay as they are in the
//! file; a group keeps the vertices that it uses. An STL file has no shared vertices, so its
//! corners are welded and each place is written once.

use crate::frames::Frames;
use crate::outcome::Outcome;
use crate::table::grouped;
use crate::terminal::{complain, note, print_all};
use crate::{rate, size};
use anyhow::{Context, bail};
use clap::Args;
use pliant_io::{Body, OpenOptions, Positions, Shape, WriteOptions, Writer, shown};
use std::collections::BTreeMap;

#[derive(Args, Debug)]
#[command(after_help = FORMATS)]
pub(crate) struct Arguments {
    /// The input, as for `pliant check`: a mesh, a sequence, a quoted pattern ('cloth_*.obj'), or a
    /// mesh with its positions (mesh.obj+walk.pc2). Or one body of a glTF file (scene.glb#arm), or
    /// one group of an OBJ file (scan.obj#arm)
    #[arg(value_name = "IN")]
    from: String,
    /// The output: a mesh (.obj, .ply, .stl), a sequence (.npz, mesh.obj+walk.pc2,
    /// mesh.obj+walk.mdd), or a mesh for each frame (cloth_%04d.obj)
    #[arg(value_name = "OUT")]
    to: String,
    /// Only these frames: 10..20 are 10 to 19; 10.. and ..20 are open; 10 is one; 10..20:3 is every
    /// third
    #[arg(
        long,
        value_name = "A..B:STEP",
        default_value = "..",
        allow_negative_numbers = true
    )]
    frames: Frames,
    /// The animation of a glTF file, by name; the first if none is named
    #[arg(long, value_name = "NAME")]
    clip: Option<String>,
    /// Frames a second, at which an animation of a glTF file is evaluated, and which an MDD file
    /// states
    #[arg(
        long,
        value_name = "N",
        default_value = "30",
        allow_negative_numbers = true,
        value_parser = rate::parse
    )]
    fps: f64,
    /// Write over files that are there
    #[arg(long)]
    force: bool,
    /// Print nothing on standard output
    #[arg(short, long)]
    quiet: bool,
    /// Keep the corners of an STL file apart
    #[arg(long)]
    no_weld: bool,
    /// Join boundary edges that are at most TOL times the diagonal of the body apart, and write
    /// each place once
    #[arg(
        long,
        value_name = "TOL",
        default_value = "0",
        allow_negative_numbers = true,
        conflicts_with = "no_weld"
    )]
    weld: f64,
    /// The most memory that a frame may take: 4GiB, 512MiB, 1G, bytes. A frame that says it is
    /// larger is refused before it is read
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = size::parse)]
    max_memory: u64,
}

const FORMATS: &str = "\
Examples:
  pliant convert 'cloth_*.obj' cloth.npz             many files into one
  pliant convert walk.npz 'walk_%04d.ply'            walk_0000.ply, ...
  pliant convert fox.glb fox.obj+fox.pc2 --clip Run  a mesh and its positions
  pliant convert walk.npz pose.stl --frames 12       one frame

A file appears under its name when it is whole; nothing is written over without --force.
glTF is read, not written.
STL, PC2 and MDD have 32-bit coordinates: others are rounded, and a note says so.";

/// Reads a body, writes its frames, and says how much was written.
pub(crate) fn convert(arguments: &Arguments) -> anyhow::Result<Outcome> {
    let is_stl = arguments.from.to_ascii_lowercase().ends_with(".stl");
    let mut body = pliant_io::open(
        &arguments.from,
        &OpenOptions {
            weld: (is_stl || arguments.weld != 0.0) && !arguments.no_weld,
            weld_tolerance: arguments.weld,
            max_memory: arguments.max_memory,
            clip: arguments.clip.clone(),
            fps: arguments.fps,
            ..OpenOptions::default()
        },
    )?;
    if arguments.clip.is_some() && body.clip().is_none() {
        let name = shown(body.name());
        bail!("{name}: has no animation; leave out `--clip`");
    }
    note(&body, arguments.quiet);
    let frames = arguments.frames.within(body.frame_count())?;
    let (vertices, triangles, outlines) = kept(&body);
    let shape = Shape {
        outlines,
        faces: body.faces().map(<[u32]>::to_vec),
        vertex_count: vertices.as_ref().map_or(body.vertex_count(), Vec::len),
        frame_count: frames.len(),
        precision: body.precision(),
        triangles,
    };
    let said = format!(
        "{} frame{}, {} vertices, {} triangles",
        grouped(shape.frame_count as u64),
        if shape.frame_count == 1 { "" } else { "s" },
        grouped(shape.vertex_count as u64),
        grouped(shape.triangles.len() as u64)
    );
    let options = WriteOptions {
        force: arguments.force,
        fps: arguments.fps,
    };
    let mut writer = Writer::create(&arguments.to, shape, options)?;
    let mut next = 0;
    let mut some = Picked::default();
    for frame in frames {
        body.skip(frame - next);
        next = frame + 1;
        let name = shown(body.name());
        let positions = body.next_frame()?;
        let positions = positions.with_context(|| {
            format!("{name}: frame {frame} is missing; wait until it is written, then try again")
        })?;
        writer.frame(match &vertices {
            None => positions,
            Some(vertices) => some.pick(positions, vertices),
        })?;
        if let Some(parted) = body.parted_seams() {
            let [a, b] = parted.vertices;
            bail!(
                "{name}: vertices {a} and {b} are one in frame 0 and {:.1e} of the body's size \
                 apart in frame {frame}; what is written has one mesh: use `--no-weld`, \
                 or `--weld` with more than that",
                parted.farthest
            );
        }
    }
    if writer.rounded() {
        let [to, from] = [&arguments.to, body.name()].map(shown);
        complain(&format!(
            "note: {to} has 32-bit coordinates, {from} has 64-bit ones: they were rounded"
        ));
    }
    writer.finish()?;
    if !arguments.quiet {
        print_all(&format!("{}: {said}\n", shown(&arguments.to)))?;
    }
    Ok(Outcome::Clear)
}

/// Vertices to write (`None`: all), and the triangles and outlines between them.
///
/// Leaves out vertices that were welded away, or that a group does not use.
fn kept(body: &Body) -> (Option<Vec<u32>>, Vec<[u32; 3]>, Outlines) {
    let (mut triangles, mut outlines) = (body.triangles().to_vec(), body.outlines());
    if body.welded() == 0 && !body.is_part() {
        return (None, triangles, outlines);
    }
    let mut number = vec![None; body.vertex_count()];
    let mut vertices = Vec::new();
    for corner in triangles.as_flattened_mut() {
        *corner = *number[*corner as usize].get_or_insert_with(|| {
            vertices.push(*corner);
            vertices.len() as u32 - 1
        });
    }
    // Corners of polygons are corners of triangles, so each has a number.
    for corner in outlines.values_mut().flatten() {
        *corner = number[*corner as usize].unwrap_or_default();
    }
    (Some(vertices), triangles, outlines)
}

/// Corners of polygons that did not become fans, by the number of the polygon.
type Outlines = BTreeMap<u32, Vec<u32>>;

/// Positions of the vertices to write, picked from all positions of a frame.
#[derive(Default)]
struct Picked {
    narrow: Vec<[f32; 3]>,
    wide: Vec<[f64; 3]>,
}

impl Picked {
    fn pick(&mut self, positions: Positions<'_>, vertices: &[u32]) -> Positions<'_> {
        match positions {
            Positions::F32(all) => {
                self.narrow.clear();
                self.narrow
                    .extend(vertices.iter().map(|&vertex| all[vertex as usize]));
                Positions::F32(&self.narrow)
            }
            Positions::F64(all) => {
                self.wide.clear();
                self.wide
                    .extend(vertices.iter().map(|&vertex| all[vertex as usize]));
                Positions::F64(&self.wide)
            }
        }
    }
}
