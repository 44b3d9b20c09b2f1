//! Bodies: a row of files whose first frame fixes the mesh, streamed frame by frame.
//!
//! Each frame has the seams that close in it; a later frame keeps its seams only while they differ
//! from the first frame's. After [`Body::let_mesh_change`] a file may have another mesh than the
//! first. Its seams and polygons then come from its own first frame. So a frame depends only on its
//! file and on the first frame of the body, whichever frames were read before. Two meshes are held
//! at most: the mesh of the first file, with which every other is compared, and the current one.

use std::collections::BTreeMap;
use std::fmt;
use std::hash::{BuildHasher as _, RandomState};
use std::io::BufReader;
use std::path::Path;
use std::sync::Arc;

use crate::arguments::{self, Named};
use crate::error::{Error, Fault, Place, Reason};
use crate::file::Found;
use crate::files::Files;
use crate::format::Format;
use crate::frame::{Complete, Frame};
use crate::groups::{Groups, Naming};
use crate::memory::bytes_of;
use crate::near::{self, NearSeams};
use crate::note::Note;
use crate::options::OpenOptions;
use crate::positions::{Positions, Precision};
use crate::source::FrameSource;
use crate::weld::{PartedSeams, Seams, Welding};
use crate::{cache, gltf, obj, stl};

/// A body: its mesh is known, and its frames are read one after another.
pub struct Body {
    argument: Arc<str>,
    name: String,
    files: Vec<FrameFile>,
    /// Reader of the current file, whose number is `file`.
    source: Box<dyn FrameSource>,
    file: usize,
    first: Mesh,
    /// Mesh of the current file, if it differs from the first.
    other: Option<Box<Mesh>>,
    /// Random hash of `other`, 0 without one; and the keys of that hash, different in every body.
    mesh_number: u64,
    numbering: RandomState,
    /// File that the mesh is from, where it is not the file of the frames.
    mesh_file: Option<Box<Found>>,
    /// Triangles of the group, where the body is a group of its file.
    group: Option<Box<GroupMesh>>,
    mesh_may_change: bool,
    options: Arc<OpenOptions>,
    /// Number of the frame that the source reads next, and of the frame to hand out next.
    read: usize,
    handed_out: usize,
    failed: bool,
}

/// Triangles of a group of the file.
struct GroupMesh {
    /// Their numbers in the mesh, ascending.
    numbers: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    /// Polygon of each triangle, renumbered without gaps.
    faces: Option<Vec<u32>>,
}

/// A frame buffer and the mesh that its first frame fixed.
struct Mesh {
    frame: Frame,
    /// Seams of the first frame of the mesh.
    seams: Seams,
    /// Seams of the frame read last, where they differ from the first frame's.
    now: Option<Box<Seams>>,
    notes: Vec<Note>,
}

impl Mesh {
    /// Reads the first frame of a mesh into an empty frame.
    fn read(
        source: &mut dyn FrameSource,
        mut frame: Frame,
        file: Arc<Path>,
        tolerance: f64,
    ) -> Result<Self, Fault> {
        let _complete = source.read(&mut frame)?;
        let mut notes = frame.shape_polygons()?;
        frame.becomes_first(file);
        let seams = frame.seams(tolerance, || source.alike())?;
        let welding = seams.welding.as_ref();
        let loose = welding.map_or(0, |it| it.loose(|a, b| source.moves_alike(a, b)));
        if loose > 0 {
            notes.push(Note::SeamsByWeights { count: loose });
        }
        notes.extend(source.notes());
        if let Some(near) = welding.and_then(|it| it.near.as_ref()) {
            notes.push(Note::NearSeams {
                count: near.count(),
                farthest: near.farthest(),
            });
        }
        Ok(Self {
            frame,
            seams,
            now: None,
            notes,
        })
    }

    /// Finds the seams of a later frame, which was just read.
    fn find_seams(&mut self, tolerance: f64) -> Result<(), Reason> {
        // Seams that differ from the first frame's mostly stay the same for a while.
        let positions = self.frame.positions();
        if tolerance == 0.0 && self.now.as_ref().is_some_and(|now| now.hold(positions)) {
            return Ok(());
        }
        if let Some(before) = self.now.take() {
            self.frame.take_off(before.bytes());
        }
        self.now = self
            .frame
            .other_seams(&self.seams, tolerance)?
            .map(Box::new);
        Ok(())
    }

    fn seams(&self) -> &Seams {
        self.now.as_deref().unwrap_or(&self.seams)
    }

    fn triangles(&self) -> &[[u32; 3]] {
        self.seams().triangles(self.frame.polygons().triangles())
    }
}

/// Placeholder source of a body of one frame: replaces the real one to free its memory.
struct AllRead {
    clip: Option<Arc<str>>,
}

impl FrameSource for AllRead {
    fn frame_count(&self) -> usize {
        1
    }

    fn read(&mut self, _: &mut Frame) -> Result<Complete, Fault> {
        Err(Reason::NoFrames.into()) // not called: no frame is left
    }

    fn skip(&mut self, _: usize) -> Result<(), Fault> {
        Ok(())
    }

    fn clip(&self) -> Option<&Arc<str>> {
        self.clip.as_ref()
    }
}

/// A file, and the number of frames up to its end: the body's frame number behind its last.
#[derive(Debug)]
struct FrameFile {
    found: Found,
    format: Format,
    end: usize,
}

impl FrameFile {
    /// Opens the file; an error if its number of frames is not `frames`, as found before.
    fn open(&self, frames: usize, options: &OpenOptions) -> Result<Box<dyn FrameSource>, Error> {
        let source = self.format.open(&self.found, options);
        let source = source.map_err(|fault| Error::new(self.path(), fault))?;
        if source.frame_count() != frames {
            return Err(Error::new(self.path(), Reason::Changed));
        }
        Ok(source)
    }

    fn path(&self) -> &Path {
        self.found.path()
    }
}

/// Opens the body that `argument` names, and reads its first frame.
///
/// The argument is one of:
///
/// - a file;
/// - a pattern whose files are the frames of the body;
/// - a body or group of a file: `scene.glb#arm`, `scan.obj#arm`;
/// - a mesh and a cache of its positions: `shirt.obj+walk.pc2`.
///
/// # Errors
///
/// [`Reason`] lists them. Among them:
///
/// - nothing is found, or the ending belongs to no known format;
/// - the file holds several bodies, which [`open_all`] opens;
/// - the first frame cannot be read.
pub fn open(argument: &str, options: &OpenOptions) -> Result<Body, Error> {
    let mut bodies = open_all(argument, options)?;
    match bodies.pop() {
        Some(body) if bodies.is_empty() => Ok(body),
        last => {
            bodies.extend(last);
            // A body's own name follows the argument and a `#`.
            let own_name = |body: &Body| body.name.get(argument.len() + 1..).map(str::to_owned);
            let names: Vec<_> = bodies.iter().filter_map(own_name).collect();
            Err(Error::new(argument, gltf::many_bodies(&names, argument)))
        }
    }
}

/// Opens all bodies that `argument` names, and reads the first frame of each.
///
/// A glTF file may hold several, in the order of its nodes. Any other argument names one.
///
/// # Errors
///
/// As [`open`], except that several bodies are no error.
pub fn open_all(argument: &str, options: &OpenOptions) -> Result<Vec<Body>, Error> {
    let tolerance = options.weld_tolerance;
    if tolerance != 0.0 && !near::TOLERANCES.contains(&tolerance) {
        return Err(Error::new(argument, Reason::BadTolerance { tolerance }));
    }
    let asked = Asked {
        argument: argument.into(),
        options: Arc::new(options.clone()),
    };
    match arguments::named(argument, &options.files)? {
        Named::Files(mut files) if files.len() == 1 => {
            let found = files.swap_remove(0);
            match format_of(&found)? {
                Format::Gltf => asked.open_scene(&found, None),
                _ => asked.open_files(vec![found]).map(|body| vec![body]),
            }
        }
        Named::Files(files) => asked.open_files(files).map(|body| vec![body]),
        Named::Body { file, name } => asked.open_scene(&file, Some(&name)),
        Named::Group { files, name } => Ok(vec![asked.open_files(files)?.only(&name)?]),
        Named::Cache { mesh, positions } => {
            let format = format_of(&positions)?;
            let path = positions.path().to_owned();
            let source = cache::open(&mesh, &positions, format, options)
                .map_err(|fault| Error::new(path, fault))?;
            let end = source.frame_count();
            let files = vec![FrameFile {
                found: positions,
                format,
                end,
            }];
            let mut body = Body::begin(asked, argument.to_owned(), files, source, 0)?;
            body.mesh_file = Some(Box::new(mesh));
            Ok(vec![body])
        }
    }
}

fn format_of(found: &Found) -> Result<Format, Error> {
    Format::of(found.path()).map_err(|reason| Error::new(found.path(), reason))
}

/// The request, shared by the bodies of a file, which may be very many.
#[derive(Clone)]
struct Asked {
    argument: Arc<str>,
    options: Arc<OpenOptions>,
}

impl Asked {
    /// Opens the body whose frames are in these files.
    fn open_files(self, found: Vec<Found>) -> Result<Body, Error> {
        let mut files = Vec::new();
        let mut end = 0_usize;
        for found in found {
            let format = format_of(&found)?;
            let frames = format
                .frame_count(&found, &self.options)
                .map_err(|fault| Error::new(found.path(), fault))?;
            end = end.saturating_add(frames);
            files.push(FrameFile { found, format, end });
        }
        let argument = self.argument.to_string();
        let first = files
            .first()
            .ok_or_else(|| Error::new(&argument, Reason::NoMatch))?;
        let source = first.open(first.end, &self.options)?;
        Body::begin(self, argument, files, source, 0)
    }

    /// Opens all bodies of a glTF file, or the one called `name`. They share the memory limit.
    fn open_scene(&self, found: &Found, name: Option<&str>) -> Result<Vec<Body>, Error> {
        let scene = gltf::open(found, name, &self.options)
            .map_err(|fault| Error::new(found.path(), fault))?;
        let mut held = scene.held;
        let alone = scene.bodies.len() == 1;
        let mut bodies = Vec::new();
        for (own_name, source) in scene.bodies {
            let files = vec![FrameFile {
                found: found.clone(),
                format: Format::Gltf,
                end: source.frame_count(),
            }];
            let Self { argument, .. } = self;
            let name = if alone {
                argument.to_string()
            } else {
                format!("{argument}#{own_name}")
            };
            // The body's own name is already in the scene's account.
            let itself = argument.len() + size_of::<Body>() + size_of::<FrameFile>();
            held = held.saturating_add(itself as u64);
            let body = Body::begin(self.clone(), name, files, Box::new(source), held)?;
            held = body.first.frame.held();
            bodies.push(body);
        }
        Ok(bodies)
    }
}

impl Body {
    /// Reads the first frame, with which all later ones are compared.
    ///
    /// `held`: bytes already held by bodies that share the memory limit.
    fn begin(
        Asked { argument, options }: Asked,
        name: String,
        files: Vec<FrameFile>,
        mut source: Box<dyn FrameSource>,
        held: u64,
    ) -> Result<Self, Error> {
        let path: Arc<Path> = match files.first() {
            Some(file) => file.found.shared_path(),
            None => Path::new("").into(),
        };
        let in_first = |fault: Fault| Error::new(&*path, fault);
        let mut frame = Frame::new(options.max_memory, options.weld).beside(held);
        let filled = frame.fill_from(source.held());
        filled.map_err(|reason| in_first(reason.into()))?;
        let tolerance = options.weld_tolerance;
        let first = Mesh::read(&mut *source, frame, path.clone(), tolerance).map_err(in_first)?;
        if files.last().is_some_and(|file| file.end == 1) {
            source = Box::new(AllRead {
                clip: source.clip().cloned(),
            });
        }
        Ok(Self {
            argument,
            name,
            files,
            source,
            file: 0,
            first,
            other: None,
            mesh_number: 0,
            numbering: RandomState::new(),
            mesh_file: None,
            group: None,
            mesh_may_change: false,
            options,
            read: 1,
            handed_out: 0,
            failed: false,
        })
    }

    /// Opens a body whose frames the calling program evaluates.
    pub(crate) fn begin_evaluated(
        (argument, name): (Arc<str>, String),
        found: Found,
        source: Box<dyn FrameSource>,
        options: &OpenOptions,
    ) -> Result<Self, Error> {
        let asked = Asked {
            argument,
            options: Arc::new(options.clone()),
        };
        let files = vec![FrameFile {
            found,
            format: Format::Evaluated,
            end: source.frame_count(),
        }];
        Self::begin(asked, name, files, source, 0)
    }

    /// The argument as given; shared by all bodies of a file of several.
    pub fn argument(&self) -> &str {
        &self.argument
    }

    /// Name of the body: the argument, and `#` and its own name where the argument names several.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The files among which the argument names some.
    pub fn among(&self) -> &Files {
        &self.options.files
    }

    /// Lets later files of the body have other meshes: other triangles, more or fewer vertices.
    ///
    /// The seams and polygons of a file with another mesh come from its own first frame, which is
    /// read even where it is skipped. Such a file is read a second time when the difference is
    /// found. The first mesh stays in memory beside the current one.
    ///
    /// [`triangles`](Self::triangles), [`faces`](Self::faces), [`outlines`](Self::outlines),
    /// [`vertex_count`](Self::vertex_count) and [`welded`](Self::welded) then describe the mesh of
    /// the current frame. Notes stay the first frame's. [`mesh_number`](Self::mesh_number) tells
    /// meshes apart.
    ///
    /// Without effect on a group ([`is_part`](Self::is_part)): there a file with another mesh stays
    /// an error.
    pub fn let_mesh_change(&mut self) {
        self.mesh_may_change = self.group.is_none();
    }

    /// Reason why the file cannot have [`groups`](Self::groups); None where its format can.
    pub fn why_no_groups(&self) -> Option<&'static str> {
        let file = self.mesh_file.as_deref();
        let file = file.unwrap_or(&self.files[0].found);
        match Format::of(file.path()) {
            _ if self.files[0].format == Format::Evaluated => None,
            Ok(Format::Ply) => Some("a PLY file names no groups of its faces"),
            Ok(Format::Npz) => Some("an NPZ file names no groups of its faces"),
            Ok(Format::Stl) => Some("no solid of it has a name, or it is binary and is one solid"),
            _ => None,
        }
    }

    /// Reads the groups of an OBJ or STL file: a name for each triangle.
    ///
    /// Of several files, the first is read again; where positions move a mesh, the file of the
    /// mesh. The result has no names where the file has none, and in every other format. Takes
    /// O(size of the file).
    ///
    /// # Errors
    ///
    /// The file has changed, or the names need more memory than is left.
    pub fn groups(&self) -> Result<Groups, Error> {
        let file = self.mesh_file.as_deref();
        let file = file.unwrap_or(&self.files[0].found);
        let path = file.shared_path();
        let polygons = self.first.frame.polygons();
        let read = || -> Result<Groups, Fault> {
            // An evaluated body's file may have any ending, but is not read here.
            let is_evaluated = self.files[0].format == Format::Evaluated;
            if is_evaluated || !Format::of(file.path()).is_ok_and(Format::holds_groups) {
                return Ok(Groups::none(path.clone()));
            }
            let mut naming = Naming::new(self.first.frame.account().clone());
            let mut input = BufReader::with_capacity(1 << 16, file.open()?);
            let length = input.get_ref().length();
            let named = match Format::of(file.path())? {
                Format::Stl => stl::name_faces(&mut input, length, &mut naming),
                _ => obj::name_faces(&mut input, &mut naming),
            };
            // Before the reader's own error: a change while reading is the likelier cause of it.
            input.get_ref().unchanged()?;
            named?;
            let count = polygons.triangles().len();
            Ok(naming.end(path.clone(), polygons.faces(), count)?)
        };
        read().map_err(|fault| Error::new(&*path, fault))
    }

    /// Whether the body is a group of its file.
    ///
    /// Its triangles are then some of the file's and use some of its vertices; frames have all
    /// vertices.
    pub fn is_part(&self) -> bool {
        self.group.is_some()
    }

    /// Keeps only the triangles of the groups that `name` names; the whole file decides on seams.
    fn only(mut self, name: &str) -> Result<Self, Error> {
        let groups = self.groups()?;
        let wanted = groups.called(name)?;
        let of_triangles = groups.of_triangles.iter().zip(0..);
        let numbers = of_triangles.filter(|(group, _)| wanted.binary_search(group).is_ok());
        let numbers: Vec<u32> = numbers.map(|(_, triangle)| triangle).collect();
        let all = self.triangles();
        let triangles: Vec<_> = numbers.iter().map(|&t| all[t as usize]).collect();
        let faces = self.faces().map(|faces| {
            let (mut last, mut count) = (None, 0);
            let numbered = numbers.iter().map(|&triangle| {
                let face = Some(faces[triangle as usize]);
                count += u32::from(face != last);
                last = face;
                count - 1
            });
            numbered.collect::<Vec<_>>()
        });
        let held = bytes_of(&numbers) + bytes_of(&triangles) + faces.as_deref().map_or(0, bytes_of);
        let entered = self.first.frame.enter(held);
        entered.map_err(|reason| Error::new(self.files[0].path(), reason))?;
        self.group = Some(Box::new(GroupMesh {
            numbers,
            triangles,
            faces,
        }));
        Ok(self)
    }

    fn mesh(&self) -> &Mesh {
        self.other.as_deref().unwrap_or(&self.first)
    }

    /// Triangles of the mesh with the seams of the current frame, in file order.
    ///
    /// Polygons are triangulated, mostly as fans. The smallest of several welded vertices
    /// represents them. All frames of a mesh have the same triangles, apart from their seams.
    pub fn triangles(&self) -> &[[u32; 3]] {
        match &self.group {
            Some(group) => &group.triangles,
            None => self.mesh().triangles(),
        }
    }

    /// Triangles as in the file, with no vertex welded: equal in all frames of a mesh. Takes O(n).
    pub fn unwelded(&self) -> Vec<[u32; 3]> {
        let all = self.mesh().frame.polygons().triangles();
        match &self.group {
            Some(group) => group.numbers.iter().map(|&it| all[it as usize]).collect(),
            None => all.to_vec(),
        }
    }

    /// Number that tells meshes apart: 0 for the first mesh, whatever the seams of a frame.
    ///
    /// Equal triangles and equal numbers of vertices give equal numbers. Different meshes have
    /// different numbers, except with a probability of 2^-63. Numbers are random, so no file can
    /// force a collision.
    pub fn mesh_number(&self) -> u64 {
        self.mesh_number
    }

    /// Vertices that are one in the first frame of the mesh and apart in the current frame.
    ///
    /// None where there are none. Vertices that are one only in the current frame are not listed.
    pub fn parted_seams(&self) -> Option<PartedSeams> {
        let Mesh {
            frame, seams, now, ..
        } = self.mesh();
        let all = frame.polygons().triangles();
        seams.parted(now.as_deref()?, all, frame.positions())
    }

    /// Polygon of each triangle; None where every polygon is a triangle.
    pub fn faces(&self) -> Option<&[u32]> {
        match &self.group {
            Some(group) => group.faces.as_deref(),
            None => self.mesh().frame.polygons().faces(),
        }
    }

    /// Corners, in order, of the polygons that are no fans, by their number in
    /// [`faces`](Self::faces).
    ///
    /// The smallest of several welded vertices represents them.
    pub fn outlines(&self) -> BTreeMap<u32, Vec<u32>> {
        let mesh = self.mesh();
        let frame = &mesh.frame;
        let mut outlines = frame.polygons().outlines().clone();
        if let Some(group) = &self.group
            && let (Some(all), Some(own)) = (frame.polygons().faces(), &group.faces)
        {
            let faces = group.numbers.iter().zip(own);
            let faces = faces.map(|(&triangle, &own)| (all[triangle as usize], own));
            let kept = faces.filter_map(|(face, own)| Some((own, outlines.remove(&face)?)));
            outlines = kept.collect();
        }
        for corner in outlines.values_mut().flatten() {
            *corner = mesh.seams().leader(*corner);
        }
        outlines
    }

    /// Number of vertices of each frame, as in the file, welded or not.
    pub fn vertex_count(&self) -> usize {
        self.mesh().frame.vertex_count()
    }

    /// Number of vertices welded away: no triangle of the current frame uses them.
    pub fn welded(&self) -> usize {
        let welding = self.mesh().seams().welding.as_ref();
        welding.map_or(0, Welding::count)
    }

    /// Finds further vertices of the frame read last that welding with a tolerance would join.
    ///
    /// Boundary edges count whose ends are at most `tolerance` times the diagonal of the body's
    /// bounding box apart. None where there are none. Also None, without a search, where vertices
    /// are not welded or more than 65,536 boundary edges are left.
    ///
    /// # Errors
    ///
    /// [`Reason::SeamsTooLarge`] or [`Reason::SeamsTooDense`]; the body is unchanged.
    pub fn near_seams(&mut self, tolerance: f64) -> Result<Option<NearSeams>, Error> {
        let Mesh {
            frame, seams, now, ..
        } = self.other.as_deref_mut().unwrap_or(&mut self.first);
        let found = frame.near_seams(now.as_deref().unwrap_or(seams), tolerance);
        found.map_err(|reason| Error::new(self.files[self.file].path(), reason))
    }

    /// Remarks of the reader about the body's file, for its owner.
    pub fn notes(&self) -> &[Note] {
        &self.first.notes
    }

    /// Type of the coordinates of all frames.
    pub fn precision(&self) -> Precision {
        self.first.frame.precision()
    }

    /// Number of frames, at least one.
    pub fn frame_count(&self) -> usize {
        self.files.last().map_or(0, |file| file.end)
    }

    /// File of a frame; None if there is no such frame.
    pub fn frame_file(&self, frame: usize) -> Option<&Path> {
        let at = self.files.partition_point(|file| file.end <= frame);
        self.files.get(at).map(FrameFile::path)
    }

    /// Name of the glTF animation that moves the body; None where none does.
    pub fn clip(&self) -> Option<&str> {
        self.source.clip().map(|clip| &**clip)
    }

    /// Skips `frames` frames, or all that are left.
    ///
    /// [`next_frame`](Self::next_frame) then returns the frame behind them. Files of which no frame
    /// is wanted are not opened. Within a file, frames are skipped without reading where the format
    /// allows it, which a deflated array does not. Skipped data are not checked: coordinates,
    /// faces, and the checksum of their array.
    pub fn skip(&mut self, frames: usize) {
        let after = self.handed_out.saturating_add(frames);
        self.handed_out = after.min(self.frame_count());
    }

    /// Reads the next frame and returns its positions, from frame 0 on; None after the last.
    ///
    /// They are valid until the next call, which overwrites them.
    ///
    /// # Errors
    ///
    /// The frame cannot be read, or does not agree with the first. All later calls are errors too.
    pub fn next_frame(&mut self) -> Result<Option<Positions<'_>>, Error> {
        if self.failed {
            let path = self.files[self.file].path();
            return Err(Error::new(path, Reason::AfterError));
        }
        if self.handed_out == self.frame_count() {
            return Ok(None);
        }
        if self.handed_out >= self.read {
            // Set first, so that an error on any way out leaves it set.
            self.failed = true;
            self.advance()?;
            self.failed = false;
        }
        self.handed_out += 1;
        Ok(Some(self.positions()))
    }

    /// Positions of the frame handed out last, even after [`rewind`](Self::rewind).
    ///
    /// Before the first call of [`next_frame`](Self::next_frame) they are the positions of frame 0;
    /// after an error they are meaningless.
    pub fn positions(&self) -> Positions<'_> {
        self.mesh().frame.positions()
    }

    /// Returns to frame 0, which [`next_frame`](Self::next_frame) then reads.
    ///
    /// Files that are read again must not have changed. Data held of a glTF file are not read
    /// again.
    ///
    /// # Errors
    ///
    /// The first file cannot be opened or has changed, or an earlier frame could not be read. All
    /// later calls are errors too.
    pub fn rewind(&mut self) -> Result<(), Error> {
        if self.failed {
            return Err(Error::new(self.files[self.file].path(), Reason::AfterError));
        }
        if self.read > 1 {
            self.failed = true;
            let rewound = self.file == 0 && {
                let rewound = self.source.rewind();
                rewound.map_err(|fault| Error::new(self.files[0].path(), fault))?
            };
            if !rewound {
                self.open_file(0)?;
            }
            self.failed = false;
            self.read = 0;
        }
        self.handed_out = 0;
        Ok(())
    }

    /// Reads the frame to hand out next, over the last one read.
    fn advance(&mut self) -> Result<(), Error> {
        let frame = self.handed_out;
        let at = self.files.partition_point(|file| file.end <= frame);
        if at != self.file {
            self.open_file(at)?;
            self.read = self.begin_of(at);
            if self.mesh_may_change {
                self.read_mesh()?;
                if frame < self.read {
                    return Ok(());
                }
            }
        } else if at == 0 {
            self.return_to_first_mesh();
        }
        let path = self.files[self.file].path();
        let in_file = |fault: Fault| Error::new(path, fault);
        if frame > self.read {
            self.source.skip(frame - self.read).map_err(in_file)?;
        }
        let Mesh {
            frame: positions, ..
        } = self.other.as_deref_mut().unwrap_or(&mut self.first);
        let _complete = self.source.read(positions).map_err(in_file)?;
        self.read = frame;
        self.find_seams()?;
        self.read += 1;
        Ok(())
    }

    /// Drops the current file's own mesh.
    fn return_to_first_mesh(&mut self) {
        (self.other, self.mesh_number) = (None, 0);
    }

    /// Reads the first frame of a file, which may have another mesh than the first file.
    fn read_mesh(&mut self) -> Result<(), Error> {
        self.return_to_first_mesh();
        match self.source.read(&mut self.first.frame) {
            Ok(_complete) => self.find_seams()?,
            Err(fault) if fault.reason.is_of_another_mesh() => {
                self.open_file(self.file)?;
                let own = self.first.frame.for_another_mesh();
                let found = &self.files[self.file].found;
                let tolerance = self.options.weld_tolerance;
                let other = Mesh::read(&mut *self.source, own, found.shared_path(), tolerance);
                let other = other.map_err(|fault| Error::new(found.path(), fault))?;
                let frame = &other.frame;
                let mesh = (frame.vertex_count(), frame.polygons().triangles());
                self.mesh_number = self.numbering.hash_one(mesh).max(1);
                self.other = Some(Box::new(other));
            }
            Err(fault) => return Err(Error::new(self.files[self.file].path(), fault)),
        }
        self.read += 1;
        Ok(())
    }

    /// Finds the seams of the frame just read.
    fn find_seams(&mut self) -> Result<(), Error> {
        let mesh = self.other.as_deref_mut().unwrap_or(&mut self.first);
        let had_others = mesh.now.is_some();
        let found = mesh.find_seams(self.options.weld_tolerance);
        if (had_others || mesh.now.is_some())
            && let Some(group) = &mut self.group
        {
            let all = mesh.triangles();
            let own = group.triangles.iter_mut().zip(&group.numbers);
            own.for_each(|(triangle, &number)| *triangle = all[number as usize]);
        }
        found.map_err(|reason| {
            let path = self.files[self.file].path();
            Error::new(path, reason.at(self.place()))
        })
    }

    /// Opens a file of the body at its first frame.
    fn open_file(&mut self, at: usize) -> Result<(), Error> {
        let file = &self.files[at];
        self.file = at;
        self.source = file.open(file.end - self.begin_of(at), &self.options)?;
        let filled = self.first.frame.fill_from(self.source.held());
        filled.map_err(|reason| Error::new(file.path(), reason))
    }

    /// Number of the first frame of a file.
    fn begin_of(&self, file: usize) -> usize {
        file.checked_sub(1)
            .map_or(0, |before| self.files[before].end)
    }

    /// Place in its file of the frame just read.
    fn place(&self) -> Place {
        let begin = self.begin_of(self.file);
        if self.files[self.file].end - begin == 1 {
            Place::File
        } else {
            Place::Frame((self.read - begin) as u64)
        }
    }
}

impl fmt::Debug for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Body")
            .field("name", &self.name)
            .field("vertices", &self.vertex_count())
            .field("triangles", &self.triangles().len())
            .field("welded", &self.welded())
            .field("precision", &self.precision())
            .field("frames", &self.frame_count())
            .finish_non_exhaustive()
    }
}
