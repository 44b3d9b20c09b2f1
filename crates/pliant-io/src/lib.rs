//! Readers and writers of deforming triangle-mesh sequences, streamed one frame at a time.
//!
//! Every *argument* names one **body**: a file, or a pattern such as `cloth_*.obj`. The files of a
//! pattern are its frames, in natural order (`frame2` before `frame10`). [`open`] reads the first
//! frame and the data shared by all frames: triangles, faces, number of frames.
//! [`Body::next_frame`] then returns one frame after another; [`Body::skip`] passes over some. Only
//! the current frame is in memory, so a sequence larger than memory is read with the memory of one
//! frame.
//!
//! - A glTF file holds several bodies: [`open_all`] opens them, `scene.glb#arm` names one.
//! - An OBJ file is one body, `scan.obj#arm` a group of it. [`Body::groups`] maps triangles to
//!   groups.
//! - A cache of positions is named beside its mesh: `shirt.obj+walk.pc2`.
//! - [`evaluated()`] opens a body whose frames the calling program evaluates.
//! - [`Files`] in memory are read like files on disk.
//! - [`Writer`] writes.
//!
//! ```
//! # let folder = format!("pliant-io-front-page-{}", std::process::id());
//! # let folder = std::env::temp_dir().join(folder);
//! # std::fs::create_dir_all(&folder)?;
//! # let faces = "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 4 3 2 1\n";
//! # for (name, top) in [("tent_9.obj", 1), ("tent_10.obj", 2)] {
//! #     let corners = format!("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 {top}\n");
//! #     std::fs::write(folder.join(name), corners + faces)?;
//! # }
//! # let argument = folder.join("tent_*.obj").display().to_string();
//! use pliant_io::{OpenOptions, Positions};
//!
//! // "tent_*.obj": first tent_9.obj, then tent_10.obj.
//! let mut tent = pliant_io::open(&argument, &OpenOptions::default())?;
//! assert_eq!((tent.frame_count(), tent.vertex_count()), (2, 5));
//!
//! // Four sides, and the square below as a fan of two.
//! assert_eq!(tent.triangles().len(), 6);
//! assert_eq!(tent.faces(), Some(&[0, 1, 2, 3, 4, 4][..]));
//!
//! let mut top = Vec::new();
//! while let Some(positions) = tent.next_frame()? {
//!     if let Positions::F64(positions) = positions {
//!         top.push(positions[4][2]);
//!     }
//! }
//! assert_eq!(top, [1.0, 2.0]);
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Formats that are read
//!
//! | ending | content of one file | precision |
//! |---|---|---|
//! | `.obj` | one frame: `v`, and the `v` indices of `f`; groups: `o`, `g` | f64 |
//! | `.ply` | one frame: ASCII or binary; polygons or `tristrips` | as declared |
//! | `.stl` | one frame: text or binary; groups: solids of text | f32 |
//! | `.npz` | all frames: `vertices` (T, n, 3) or (n, 3), `faces` (m, 3) | as the array |
//! | `.npy` | positions of all frames, (T, n, 3) or (n, 3), for a mesh | as the array |
//! | `.pc2`, `.mdd` | positions of all frames, for a mesh | f32 |
//! | `.glb`, `.gltf`, `.vrm` | bodies and animations | f32 |
//!
//! - **Precision**: the f64 nearest to the text in OBJ. PLY declares `float` (f32) or `double`
//!   (f64). Arrays of float32 and float64 are read as they are, arrays of other types in the
//!   precision that holds them.
//! - **PLY**: binary files may have either byte order. `tristrips` are read where the file has no
//!   polygons.
//! - **STL**: the length tells text and binary apart. Bytes behind the triangles of a binary file
//!   are passed over.
//! - **Positions alone** (`.pc2`, `.mdd`, `.npy`) move a mesh of one frame in any other format.
//! - **Animations**: [`OpenOptions::clip`] is evaluated at [`OpenOptions::fps`].
//!
//! # How files are read
//!
//! - **Polygons become fans** around their first corner, with triangles numbered in file order.
//!   [`Body::faces`] maps each triangle to its polygon. If the fan of a concave polygon would be
//!   wrong in the first frame, it becomes as many other triangles between the same corners
//!   ([`Body::outlines`]). Polygons that cross themselves stay fans; [`Body::notes`] reports them,
//!   and polygons that are far from flat.
//! - **Seams are welded.** Files split a vertex where texture coordinates or normals differ; STL
//!   splits all. Vertices at both ends of boundary edges become one in every frame in which they
//!   coincide bit for bit. [`Body::parted_seams`] lists vertices that were one in the first frame
//!   and are apart in the current one. [`Body::welded`] counts the vertices welded away;
//!   [`OpenOptions::weld`] turns welding off.
//! - **Seams in glTF** are decided once. Vertices must coincide at rest, and morph targets must
//!   move them alike to the bit. The weight of each joint may differ by at most 1e-5 of the sum.
//!   The smallest vertex represents all; [`Body::notes`] counts vertices that were not alike to the
//!   bit.
//! - **Groups of an OBJ file** are named after their object (`o`), their group (`g`), or both:
//!   `object/group`. A name is the rest of its line. Faces without either belong to the group
//!   `default`. Equal names are one group. An argument `scan.obj#arm` means this group and all
//!   below it (`arm/hand`), in every file of a pattern. The first file defines the groups.
//! - **Groups of an STL file** are the solids of its text.
//! - **glTF**: the default scene is read, or all nodes where the file has no scene. Each node whose
//!   mesh has triangles, strips or fans is a body; points and lines have no surface. Evaluated are
//!   nested nodes, skins, morph targets, sparse accessors, and step, linear and cubic-spline
//!   interpolation. Computed in double precision, rounded to f32. Frames are at 0, 1/fps, 2/fps,
//!   ... and the clip's end; a file without animations has one frame, at rest. Bytes are read from
//!   the file, from files beside it and from data URIs.
//! - **glTF extensions**: `KHR_mesh_quantization` is evaluated, and `KHR_animation_pointer` where
//!   it moves nodes or morph targets. Animated properties that belong to no body, such as materials
//!   or other scenes, are noted. Views compressed by meshoptimizer are decoded, by either of its
//!   extensions, where the file has no uncompressed fallback. Draco is refused, as is any other
//!   required extension that would change shapes.
//! - **The frames of a body agree**: same faces, same number of vertices, and no later frame of a
//!   higher precision than the first. After [`Body::let_mesh_change`] a file may have another mesh.
//! - **Files are not trusted.** Every coordinate is finite and at most `f32::MAX` in magnitude, and
//!   every index is in range. Otherwise there is an [`Error`]: one line that names the file, the
//!   place in it and the fault. No count in a header reserves memory: memory grows with
//!   the data that arrives, up to [`OpenOptions::max_memory`]. A file that changes while it is
//!   read, or between frames, is refused. Pipes and devices are refused and never waited for.
//!   Nothing is memory-mapped.
//!
//! # Map
//!
//! | file | idea |
//! |---|---|
//! | `arguments.rs`, `pattern.rs`, `natural.rs` | the files that an argument names, in order |
//! | `series.rs` | a pattern that the shell expanded |
//! | `options.rs`, `body.rs` | how bodies are read: the streaming loop over the files of a body |
//! | `files.rs` | names of files on disk or in memory |
//! | `file.rs` | a file must stay as it was found |
//! | `source.rs` | the trait of readers |
//! | `format.rs` | file endings and their readers: the one place to add a format |
//! | `frame.rs`, `positions.rs`, `polygons.rs` | data of a frame: recorded once, then compared |
//! | `groups.rs` | names of the triangles of an OBJ or STL file |
//! | `integers.rs` | numbers of the triangles from an NPY file |
//! | `obj.rs`, `ply/`, `stl.rs`, `npz/`, `cache.rs`, `gltf/` | one format each |
//! | `moved_mesh.rs` | the mesh that the positions of a cache move |
//! | `evaluated.rs` | bodies that the calling program evaluates |
//! | `write/` | one format each, and files that appear when they are complete |
//! | `boundary.rs`, `classes.rs` | boundary edges; union-find of vertices |
//! | `weld.rs`, `near.rs` | joining boundary edges that coincide, or nearly |
//! | `triangulate.rs` | triangulation of polygons |
//! | `memory.rs`, `size.rs` | memory account with a limit; bytes as people read them |
//! | `text.rs` | lines and numbers of text formats |
//! | `error.rs`, `note.rs`, `shown.rs` | errors; remarks that are no errors; names for people |

mod arguments;
mod body;
mod boundary;
mod cache;
mod classes;
mod error;
mod evaluated;
mod file;
mod files;
mod format;
mod frame;
mod gltf;
mod groups;
mod integers;
mod memory;
mod moved_mesh;
mod natural;
mod near;
mod note;
mod npz;
mod obj;
mod options;
mod pattern;
mod ply;
mod polygons;
mod positions;
mod series;
mod shown;
mod size;
mod source;
mod stl;
mod text;
mod triangulate;
mod weld;
mod write;

pub use arguments::{files, group_argument};
pub use body::{Body, open, open_all};
pub use error::{Error, Place, Reason};
pub use evaluated::{Evaluated, evaluated};
pub use files::Files;
pub use groups::Groups;
pub use integers::integers;
pub use near::NearSeams;
pub use note::Note;
pub use options::OpenOptions;
pub use positions::{Positions, Precision};
pub use series::looks_like_a_series;
pub use shown::{shown, shown_within};
pub use weld::PartedSeams;
pub use write::{Shape, StagedFile, WriteOptions, Writer, remove_staged_files};
