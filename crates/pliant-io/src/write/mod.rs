//! Writers: a mesh or a sequence as OBJ, PLY, STL, NPZ, or as PC2 or MDD beside a mesh.
//!
//! Files read back as the same triangles and the same positions, bit for bit. The exceptions are
//! 64-bit coordinates in a format of 32 bits, which [`Writer::rounded`] reports. Polygons stay
//! polygons where the format has them. Frames are written as they come. A file appears under its
//! name once it is complete, and never replaces another without permission.

mod cache;
mod coordinates;
mod npz;
mod obj;
mod ply;
mod shape;
mod staged;
mod stl;

use std::path::{Path, PathBuf};

use crate::arguments::mesh_and_positions;
use crate::error::{Error, Reason};
use crate::format::Format;
use crate::positions::Positions;
pub use shape::Shape;
pub use staged::{StagedFile, remove_staged_files};

/// Options for writing a body.
#[derive(Debug, Clone, PartialEq)]
pub struct WriteOptions {
    /// Whether to overwrite existing files. Default: false.
    pub force: bool,
    /// Frames per second, for formats that store the time of a frame (MDD). Default: 30.
    pub fps: f64,
}

impl Default for WriteOptions {
    fn default() -> Self {
        Self {
            force: false,
            fps: 30.0,
        }
    }
}

/// Writer of a body, frame by frame.
///
/// ```
/// # let folder = std::env::temp_dir().join(format!("pliant-io-writer-{}", std::process::id()));
/// # std::fs::create_dir_all(&folder)?;
/// # let out = folder.join("tent_%02d.ply").display().to_string();
/// use pliant_io::{Positions, Precision, Shape, WriteOptions, Writer};
///
/// let shape = Shape {
///     triangles: vec![[0, 1, 2]],
///     faces: None,
///     outlines: Default::default(),
///     vertex_count: 3,
///     frame_count: 2,
///     precision: Precision::F32,
/// };
/// // "tent_%02d.ply": tent_00.ply, tent_01.ply.
/// let mut writer = Writer::create(&out, shape, WriteOptions::default())?;
/// for height in [1.0, 2.0] {
///     writer.frame(Positions::F32(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, height]]))?;
/// }
/// assert_eq!(writer.finish()?.len(), 2);
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Writer {
    argument: String,
    shape: Shape,
    options: WriteOptions,
    to: To,
    done: usize,
    rounded: bool,
    written: Vec<PathBuf>,
}

/// Destination of the frames.
enum To {
    /// One file for each frame, or a single file.
    Meshes(Format, Vec<PathBuf>),
    Npz(Box<npz::Npz>),
    Cache(Box<Pair>),
}

/// A mesh, which is written with the first frame, and a cache of positions.
struct Pair {
    format: Format,
    mesh: PathBuf,
    staged: Option<StagedFile>,
    cache: cache::Cache,
}

/// Formats that can be written, as the end of a message.
const WRITABLE: &str = "a mesh (.obj, .ply, .stl); a sequence \
    (.npz, 'mesh.obj+positions.pc2' or .mdd, or one file per frame: 'name_%04d.obj')";

impl Writer {
    /// Prepares to write the body that `argument` names.
    ///
    /// The argument is a file, a name with `%04d` in place of the frame's number, or a mesh and a
    /// cache of its positions (`mesh.obj+positions.pc2`).
    ///
    /// # Errors
    ///
    /// - The format cannot be written, or cannot hold this many frames.
    /// - A file exists already, or its folder does not.
    /// - The parts of `shape` do not agree.
    pub fn create(argument: &str, shape: Shape, options: WriteOptions) -> Result<Self, Error> {
        let error = |reason: Reason| Error::new(argument, reason);
        shape.check().map_err(error)?;
        let to = if let Some((mesh, positions)) = mesh_and_positions(argument) {
            let format = Format::of(Path::new(mesh)).map_err(error)?;
            if !matches!(format, Format::Obj | Format::Ply) {
                let reason =
                    "the mesh beside positions is written as .obj or .ply, which keep its vertices";
                return Err(error(Reason::Unsupported(reason.into())));
            }
            let (mesh, positions) = (PathBuf::from(mesh), PathBuf::from(positions));
            for path in [&mesh, &positions] {
                staged::check(path, options.force)?;
            }
            let as_positions = Format::of(&positions).map_err(error)?;
            if as_positions == Format::Npy {
                let reason = "positions are read from .npy, and not written; \
                    write .npz, or positions as .pc2 or .mdd";
                return Err(error(Reason::Unsupported(reason.into())));
            }
            let big_endian = as_positions == Format::Mdd;
            To::Cache(Box::new(Pair {
                format,
                mesh,
                staged: None,
                cache: cache::Cache::create(&positions, big_endian, &shape, options.fps)?,
            }))
        } else {
            Self::single(argument, &shape, &options)?
        };
        Ok(Self {
            argument: argument.to_owned(),
            shape,
            options,
            to,
            done: 0,
            rounded: false,
            written: Vec::new(),
        })
    }

    /// Destination for an argument that names no mesh beside a cache.
    fn single(argument: &str, shape: &Shape, options: &WriteOptions) -> Result<To, Error> {
        let path = Path::new(argument);
        let unsupported = |reason: String| Error::new(path, Reason::Unsupported(reason));
        match Format::of(path) {
            Ok(format @ (Format::Obj | Format::Ply | Format::Stl)) => {
                let paths = match numbered(argument) {
                    Some(name) => (0..shape.frame_count)
                        .map(|frame| name(frame).into())
                        .collect(),
                    None if shape.frame_count == 1 => vec![path.to_owned()],
                    None => {
                        let frames = shape.frame_count;
                        return Err(Error::new(path, Reason::HoldsOneFrame { frames }));
                    }
                };
                for path in &paths {
                    staged::check(path, options.force)?;
                }
                Ok(To::Meshes(format, paths))
            }
            Ok(Format::Npz) => {
                staged::check(path, options.force)?;
                Ok(To::Npz(Box::new(npz::Npz::create(path, shape)?)))
            }
            Ok(Format::Pc2 | Format::Mdd | Format::Npy) => Err(unsupported(format!(
                "holds positions but no faces; \
                 name a mesh to write beside it: 'mesh.obj+{argument}'"
            ))),
            Ok(Format::Gltf) => Err(unsupported(format!(
                "glTF can be read but not written; these can: {WRITABLE}"
            ))),
            Err(_) | Ok(Format::Evaluated) => Err(unsupported(format!(
                "this kind of file cannot be written; these can: {WRITABLE}"
            ))),
        }
    }

    /// Writes the next frame.
    ///
    /// # Errors
    ///
    /// The disk is full, a file has been created meanwhile, or the frame does not match the shape.
    pub fn frame(&mut self, positions: Positions<'_>) -> Result<(), Error> {
        let Self { shape, options, .. } = self;
        if positions.len() != shape.vertex_count || self.done == shape.frame_count {
            return Err(Error::new(
                &self.argument,
                Reason::Malformed(format!(
                    "frame {} of {} vertices was to be written; {} frames of {} were announced",
                    self.done,
                    positions.len(),
                    shape.frame_count,
                    shape.vertex_count
                )),
            ));
        }
        match &mut self.to {
            To::Meshes(format, paths) => {
                let path = &paths[self.done];
                self.rounded |=
                    write_mesh(*format, path, shape, positions)?.commit(options.force)?;
                self.written.push(path.clone());
            }
            To::Npz(npz) => npz.frame(positions)?,
            To::Cache(pair) => {
                if pair.staged.is_none() {
                    pair.staged = Some(write_mesh(pair.format, &pair.mesh, shape, positions)?);
                }
                self.rounded |= pair.cache.frame(positions)?;
            }
        }
        self.done += 1;
        Ok(())
    }

    /// Whether a 64-bit coordinate was rounded so far, because its format has only 32 bits.
    pub fn rounded(&self) -> bool {
        self.rounded
    }

    /// Ends the writing and returns the files, which now all have their names.
    ///
    /// # Errors
    ///
    /// As [`frame`](Self::frame), or frames are missing.
    pub fn finish(mut self) -> Result<Vec<PathBuf>, Error> {
        let announced = self.shape.frame_count;
        if self.done != announced {
            let reason = format!("{announced} frames were announced, {} came", self.done);
            return Err(Error::new(&self.argument, Reason::Malformed(reason)));
        }
        let force = self.options.force;
        match self.to {
            To::Meshes(..) => {}
            To::Npz(npz) => {
                let staged = npz.finish(&self.shape)?;
                self.written.push(staged.path().to_owned());
                staged.commit(force)?;
            }
            To::Cache(pair) => {
                let Pair { staged, cache, .. } = *pair;
                let positions = cache.finish();
                for staged in staged.into_iter().chain([positions]) {
                    self.written.push(staged.path().to_owned());
                    staged.commit(force)?;
                }
            }
        }
        Ok(self.written)
    }
}

/// Writes one frame to a staged file.
fn write_mesh(
    format: Format,
    path: &Path,
    shape: &Shape,
    positions: Positions<'_>,
) -> Result<StagedFile, Error> {
    let mut staged = StagedFile::create(path)?;
    let written = match format {
        Format::Ply => ply::write(&mut staged, shape, positions),
        Format::Stl => stl::write(&mut staged, shape, positions),
        _ => obj::write(&mut staged, shape, positions),
    };
    match written {
        Ok(rounded) => {
            staged.rounded = rounded;
            Ok(staged)
        }
        Err(error) => Err(Error::new(path, Reason::Write(error))),
    }
}

/// Function that replaces `%d` or `%04d` in `argument` by a frame's number; None without one.
fn numbered(argument: &str) -> Option<impl Fn(usize) -> String + '_> {
    let (before, rest) = argument.split_once('%')?;
    let (width, after) = rest.split_once('d')?;
    if !width.bytes().all(|c| c.is_ascii_digit()) || width.len() > 3 {
        return None;
    }
    let (zeros, width) = (width.starts_with('0'), width.parse().unwrap_or(0));
    Some(move |frame: usize| {
        if zeros {
            format!("{before}{frame:0width$}{after}")
        } else {
            format!("{before}{frame:width$}{after}")
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_where_the_pattern_says() {
        let name = |pattern| numbered(pattern).map(|name| name(7));
        assert_eq!(name("a_%04d.obj").as_deref(), Some("a_0007.obj"));
        assert_eq!(name("a%d_b.obj").as_deref(), Some("a7_b.obj"));
        assert_eq!(name("%3d.ply").as_deref(), Some("  7.ply"));
        for none in ["a.obj", "100%.obj", "a%xd.obj", "a%9999d.obj"] {
            assert_eq!(name(none), None, "{none}");
        }
    }
}
