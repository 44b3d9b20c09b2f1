//! `pliant formats`: prints which files are read, as which surface, and what to export instead.

use crate::outcome::Outcome;
use crate::terminal::print_all;
use clap::Args;

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {}

const EXAMPLES: &str = "\
Examples:
  pliant formats
  pliant formats | less";

const TEXT: &str = "\
A surface is its triangles, where the positions of a frame put them. Inside and outside, normals,
materials and colours play no part.

Read
  .obj            one frame. v, and the v indices of f. 64 bits. One body; --split groups makes each
                  group one, 'scan.obj#arm' names one (see below). usemtl: no part of this
  .ply            one frame. Text or binary; vertex x y z, face vertex_indices, else tristrips. As
                  many bits as declared
  .stl            one frame. Text or binary. Corners that are equal to the bit along edges are one
                  vertex. Solids of text are groups
  .npz            all frames. vertices (T, n, 3) or (n, 3), faces (m, 3); also called verts, v, f;
                  float16 to float64 or whole numbers. An array in Fortran order is held in memory
                  as a whole. A note says what is unusual
  .glb, .gltf     (and .vrm) the default scene, or all nodes where there is none. Each node with a
                  mesh is a body: nodes, skins, morph targets, sparse and quantised accessors,
                  meshopt, one animation (--clip, --fps; KHR_animation_pointer too). Not Draco,
                  instancing: export without
  mesh+.pc2, .mdd the mesh of one file (its first frame), moved by a cache of positions:
                  'shirt.obj+walk.pc2'
  mesh+.npy       the mesh of one file, moved by an array (T, n, 3) or (n, 3)
  'name_*.obj'    files in natural order are frames of one body. Its mesh may change from file to
                  file: each frame is checked as it is, with seams and polygons of its own, and a
                  line says where the mesh changes

As which surface
  polygons        a fan of triangles round the first corner where that is right, as of every convex
                  polygon; otherwise cut inside, at its own corners. A polygon that crosses itself
                  stays a fan, and one of two corners is a segment; a note says so
  seams           files split vertices where texture coordinates or normals differ. Boundary edges
                  that coincide to the bit are joined, in each frame where they coincide (--no-weld
                  keeps them apart); with --weld TOL also edges that nearly do. Where a seam of the
                  first frame is open in a later one, a note says so. In glTF joints and morph
                  targets decide for all frames
  groups          of an STL file of text, each solid. Of an OBJ file, what o and g name: after
                  `o shirt`, shirt; after `g collar` in it, shirt/collar; after `g collar` where no
                  o stands, collar. A name is the rest of its line: g a b is one name. A line g
                  without a name, or g default, ends the group. Faces that nothing names: default.
                  Equal names are one group. scan.obj#shirt means shirt/collar too. Triangles that
                  share a vertex of the file are left out across groups, whether --split groups or
                  arguments name them. With --split components no group can be named: scan.obj#1 is
                  then a piece
  degenerate      a triangle without area is the segment or point that it is (--skip-degenerate
                  leaves such pairs out)
  not applied     subdivision, modifiers, displacement: export what they make

Not read
  .usd, .usda, .usdc, .usdz
                  the Python package reads it (pip install 'pliant[usd]'); or as below
  .fbx, .abc, .blend, .ma, .mb, .max, .dae, .3ds, .c4d, .hip, .step, .iges
                  export glTF (.glb) with its animation; or a mesh and its point cache (.obj and
                  .pc2 or .mdd); or one file per frame";

/// Prints the list of formats.
pub(crate) fn print(_: &Arguments) -> anyhow::Result<Outcome> {
    print_all(&format!("{TEXT}\n"))?;
    Ok(Outcome::Clear)
}
