//! Sequences of deforming meshes, read from files one frame at a time.
//!
//! Every *argument* names one **body**: a file, or a pattern such as `cloth_*.obj` whose files, in
//! natural order (`frame2` before `frame10`), are its frames. [`open`] reads what holds for the
//! whole body (triangles, faces, how many frames there are) and the first frame;
//! [`Body::next_frame`] then hands out one frame after another, [`Body::skip`] passes over some. Only
//! the frame handed out is in memory: a sequence larger than memory is read with the memory of one
//! frame. A glTF file holds several bodies: [`open_all`] opens them, `scene.glb#arm` names one. An OBJ file is one body,
//! `scan.obj#arm` a group of it, and [`Body::groups`] says which triangle is of which. A
//! cache of positions is named beside its mesh: `shirt.obj+walk.pc2`. [`evaluated`] takes a body that a program evaluates by
//! itself. [`Writer`] writes.
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
//! # What is read
//!
//! | ending | one file is | precision |
//! |---|---|---|
//! | `.obj` | one frame: `v`, and the `v` indices of `f`; groups: `o`, `g` | f64, the nearest to what is written |
//! | `.ply` | one frame: ASCII, binary of either byte order; polygons, or else `tristrips` | as declared: `float` f32, `double` f64 |
//! | `.stl` | one frame: text or binary, told apart by the length; what follows the triangles is passed over; groups: solids of text | f32 |
//! | `.npz` | all frames: `vertices` (T, n, 3) or (n, 3), `faces` (m, 3) | as the array: float32, float64; of others the one that holds them |
//! | `.pc2`, `.mdd` | positions of all frames, for a mesh of one frame in any other format | f32 |
//! | `.npy` | the same, (T, n, 3) or (n, 3) | as `.npz` |
//! | `.glb`, `.gltf`, `.vrm` | bodies, and animations of which [`OpenOptions::clip`] is evaluated at [`OpenOptions::fps`] | f32 |
//!
//! - **Polygons become fans** around their first corner, triangles numbered in file order;
//!   [`Body::faces`] then says which polygon each triangle is of. Where a fan would be wrong in the first frame, as of polygons
//!   that bend inward, they become as many other triangles between the same corners ([`Body::outlines`]). Polygons that cross
//!   themselves stay fans, and [`Body::notes`] says so, as of those that are far from flat.
//! - **Seams are welded**: files split a vertex where texture coordinates or normals differ, STL
//!   splits all. Vertices at the two ends of boundary edges that coincide bit for bit in a
//!   frame become one there; [`Body::parted_seams`] says which of the first are apart in a later one,
//!   [`Body::welded`] says how many went; [`OpenOptions::weld`] turns it off. In
//!   glTF they must coincide at rest, morph targets move them alike to the bit, and each joint hold them alike but for 1e-5 of
//!   the whole; the smallest vertex then stands for all, and [`Body::notes`] says how many were not alike to the bit.
//! - **Groups** are the solids of an STL file of text. Those of an OBJ file have the name of their object (`o`), of their group (`g`), or `object/group`; a name is the rest of
//!   its line. Faces without either are of the group `default`; the same name is the same group. `scan.obj#arm` is that group and
//!   all below it (`arm/hand`), of every file of a pattern; groups are those of the first file.
//! - **glTF**: the default scene, or all nodes where there is none; a body for each node whose mesh has triangles, strips or fans
//!   (points and lines have no surface); nodes in nodes, skins, morph targets, sparse accessors;
//!   steps, lines and cubic splines. Computed in double precision, rounded to f32. Frames at 0,
//!   1/fps, 2/fps, ... and the clip's end; without animations one, of the file as it rests. Bytes
//!   are read from the file, from files beside it and from data URIs. `KHR_mesh_quantization` is evaluated, and
//!   `KHR_animation_pointer` where it moves nodes or morph targets; what an animation moves that is no part of a body, as
//!   materials or other scenes, is noted. Views that meshoptimizer compressed are decoded, by
//!   either of its extensions, where nothing stands in for them. Draco files, and what else a file requires and would
//!   change shapes, are refused.
//! - **The frames of a body agree**: same faces, same number of vertices, no later frame of a
//!   higher precision than the first. Where [`Body::let_mesh_change`] allows it, a file may have another mesh, and stands for itself.
//! - **Files are not trusted.** Every coordinate is finite and at most `f32::MAX` in magnitude,
//!   every index in range, or there is an [`Error`]: one line that says which file, where in it,
//!   what is wrong and what to do. No count in a header reserves memory; memory grows with the data
//!   that arrives, up to [`OpenOptions::max_memory`]. A file that changes while it is read, or between
//!   frames, is refused; pipes and devices are, and never waited for. Nothing is mapped into memory.
//!
//! # Map
//!
//! | file | idea |
//! |---|---|
//! | `arguments.rs`, `natural.rs` | what an argument names; the order of its files |
//! | `series.rs` | a pattern that the shell expanded |
//! | `options.rs`, `body.rs` | how bodies are read; files in a row are one body: the streaming loop |
//! | `file.rs` | a file must stay as it was found |
//! | `source.rs` | what readers of sequences do |
//! | `format.rs` | which ending is which reader: the one place to add a format |
//! | `frame.rs`, `positions.rs`, `polygons.rs` | what readers fill, checked: recorded once, then compared |
//! | `groups.rs` | which triangles of an OBJ or STL file have which name |
//! | `obj.rs`, `ply/`, `stl.rs`, `npz/`, `cache.rs`, `gltf/` | one format each |
//! | `moved_mesh.rs` | the mesh that the positions of a cache move |
//! | `evaluated.rs` | bodies that a program evaluates by itself |
//! | `write/` | one format each, and files that appear when they are whole |
//! | `boundary.rs`, `classes.rs` | where a surface ends; which vertices are one |
//! | `weld.rs`, `near.rs` | boundary edges that coincide, or nearly |
//! | `triangulate.rs` | which triangles a polygon is |
//! | `memory.rs`, `size.rs` | nothing is allocated on a claim, nor beyond the limit; bytes as people read them |
//! | `text.rs` | lines and numbers of text formats |
//! | `error.rs`, `note.rs`, `shown.rs` | one type, one line; what is no error and worth saying; names as people are shown them |

mod arguments;
mod body;
mod boundary;
mod cache;
mod classes;
mod error;
mod evaluated;
mod file;
mod format;
mod frame;
mod gltf;
mod groups;
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

pub use arguments::group_argument;
pub use body::{Body, open, open_all};
pub use error::{Error, Place, Reason};
pub use evaluated::{Evaluated, evaluated};
pub use groups::Groups;
pub use near::NearSeams;
pub use note::Note;
pub use options::OpenOptions;
pub use positions::{Positions, Precision};
pub use series::looks_like_a_series;
pub use shown::{shown, shown_within};
pub use weld::PartedSeams;
pub use write::{Shape, StagedFile, WriteOptions, Writer, remove_staged_files};
