//! Frame buffer that readers fill: vertices and polygons, checked as they arrive.
//!
//! The first frame of a body fixes its precision, its faces and its number of vertices. Later
//! frames are compared with them. Readers need not know which they read.

use std::path::Path;
use std::sync::Arc;

use crate::error::{Fault, Place, Reason};
use crate::memory::{Account, Excess};
use crate::near::NearSeams;
use crate::note::Note;
use crate::polygons::Polygons;
use crate::positions::{Positions, Precision, Vertices};
use crate::weld::{self, Seams};

/// Buffer for one frame, reused for all frames of a mesh.
#[derive(Debug)]
pub(crate) struct Frame {
    vertices: Vertices,
    polygons: Polygons,
    account: Account,
    /// Bytes of the account that the source of the frames holds.
    source: u64,
    /// Whether seams will be searched for.
    weld: bool,
    /// The file that fixed the precision, once one has.
    precision_of: Option<Arc<Path>>,
    first: Option<First>,
    /// Remarks about the first frame, from readers that are functions and keep no state.
    notes: Vec<Note>,
}

/// Numbers of vertices and faces that a file announces; 0 where it announces none.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Announced {
    pub(crate) vertices: u64,
    pub(crate) faces: u64,
}

/// Properties of the first frame with which later frames are compared.
#[derive(Debug)]
struct First {
    file: Arc<Path>,
    vertices: usize,
}

/// Proof that a reader read its frame to the end and that the frame is complete.
///
/// Only [`Frame::complete`] makes it.
#[derive(Debug)]
#[must_use]
pub(crate) struct Complete(());

impl Frame {
    /// An empty frame. `limit`: the bytes that all data may take, including the search for seams.
    pub(crate) fn new(limit: u64, weld: bool) -> Self {
        Self {
            vertices: Vertices::new(),
            polygons: Polygons::new(),
            account: Account::new(limit),
            source: 0,
            weld,
            precision_of: None,
            first: None,
            notes: Vec::new(),
        }
    }

    /// Returns a frame for another mesh of the same body, in the same precision.
    ///
    /// This frame stays in memory but loses its positions.
    pub(crate) fn for_another_mesh(&mut self) -> Self {
        let precision = self.precision();
        self.vertices.clear(0, &mut self.account);
        self.vertices.set_precision(precision);
        let mut another = Self::new(self.account.limit(), self.weld).beside(self.held());
        another.vertices.set_precision(precision);
        another.precision_of.clone_from(&self.precision_of);
        another
    }

    /// Counts `held` bytes that other bodies under the same limit hold.
    pub(crate) fn beside(mut self, held: u64) -> Self {
        self.account.enter_allowed(held);
        self
    }

    /// Counts `more` bytes that belong to this frame's mesh but lie outside it.
    pub(crate) fn enter(&mut self, more: u64) -> Result<(), Reason> {
        Ok(self.account.enter(more)?)
    }

    /// Memory account: bytes held, and the limit.
    pub(crate) fn account(&self) -> &Account {
        &self.account
    }

    /// Bytes held in all.
    pub(crate) fn held(&self) -> u64 {
        self.account.held()
    }

    /// Counts the bytes held by the source that now fills the frame, in place of the last source's.
    pub(crate) fn fill_from(&mut self, held: u64) -> Result<(), Reason> {
        self.account.take_off(self.source);
        self.source = 0;
        self.account.enter(held)?;
        self.source = held;
        Ok(())
    }

    /// Begins a frame with coordinates of `precision`.
    ///
    /// An error if the frame announces more than the limit allows, or a higher precision than the
    /// first.
    pub(crate) fn begin(
        &mut self,
        precision: Precision,
        announced: Announced,
    ) -> Result<(), Reason> {
        match &self.precision_of {
            None => self.vertices.set_precision(precision),
            Some(file) if precision > self.vertices.precision() => {
                let than = file.to_path_buf();
                return Err(Reason::Precision { than });
            }
            Some(_) => {}
        }
        self.polygons.rewind();
        self.vertices.clear(announced.vertices, &mut self.account);
        let positions = announced
            .vertices
            .saturating_mul(self.vertices.precision().bytes());
        if self.first.is_some() {
            self.account.check(positions)?;
            return Ok(());
        }
        // A face is one triangle or more.
        let triangles = announced.faces.saturating_mul(size_of::<[u32; 3]>() as u64);
        let frame = positions.saturating_add(triangles);
        self.account.check(frame)?;
        self.check_seams(announced.faces, announced.vertices, frame)
    }

    /// Refuses a first frame whose seams cannot be found within the limit.
    ///
    /// `more`: bytes that will be held by then and are not held yet.
    fn check_seams(&self, triangles: u64, vertices: u64, more: u64) -> Result<(), Reason> {
        let finding = weld::memory(triangles, vertices);
        let checked = self.account.check(more.saturating_add(finding));
        match checked {
            Err(Excess { needed, limit }) if self.weld => {
                Err(Reason::SeamsTooLarge { needed, limit })
            }
            _ => Ok(()),
        }
    }

    /// Drops the vertices of the first frame but keeps its faces: a cache supplies the positions.
    pub(crate) fn replace_vertices(
        &mut self,
        precision: Precision,
        announced: u64,
    ) -> Result<(), Reason> {
        self.vertices.clear(0, &mut self.account);
        self.vertices.set_precision(precision);
        self.vertices.clear(announced, &mut self.account);
        self.account
            .check(announced.saturating_mul(precision.bytes()))?;
        Ok(())
    }

    /// Appends the next vertex.
    pub(crate) fn vertex(&mut self, position: [f64; 3]) -> Result<(), Reason> {
        self.vertices.push(position, &mut self.account)
    }

    /// Appends the next polygon, its corners counted from 0, written at `place`.
    ///
    /// The range of the corners is checked once the frame is complete.
    pub(crate) fn face(
        &mut self,
        corners: &[u32],
        place: impl FnOnce() -> Place,
    ) -> Result<(), Reason> {
        let face = self.polygons.next_face();
        let equal = self.polygons.push(corners, place, &mut self.account)?;
        match (equal, &self.first) {
            (false, Some(first)) => {
                let than = first.file.to_path_buf();
                Err(Reason::FacesDiffer { face, than })
            }
            _ => Ok(()),
        }
    }

    /// Declares that this frame has the polygons already recorded.
    pub(crate) fn same_faces(&mut self) {
        self.polygons.repeat();
    }

    /// Ends a frame. `first_index` is the number of the first vertex in the file: 0, or 1 in OBJ.
    pub(crate) fn complete(&mut self, first_index: i64) -> Result<Complete, Fault> {
        let vertices = self.vertices.len();
        let (faces, expected) = self.polygons.counts();
        if vertices == 0 {
            return Err(Reason::NoVertices.into());
        }
        if faces == 0 {
            return Err(Reason::NoFaces.into());
        }
        // Before the range of indices: where vertices are missing, "too few vertices" says more
        // than "index out of range".
        if let Some(First {
            file,
            vertices: before,
        }) = &self.first
        {
            let than = file.to_path_buf();
            if vertices != *before {
                let (vertices, expected) = (vertices as u64, *before as u64);
                return Err(Reason::VertexCount {
                    vertices,
                    expected,
                    than,
                }
                .into());
            }
            if faces != expected {
                return Err(Reason::FaceCount {
                    faces,
                    expected,
                    than,
                }
                .into());
            }
        }
        self.polygons.check_range(vertices, first_index)?;
        if self.first.is_none() {
            self.check_seams(self.polygons.triangles().len() as u64, vertices as u64, 0)?;
        }
        Ok(Complete(()))
    }

    /// Adds a note, if this is the first frame.
    pub(crate) fn note(&mut self, note: Note) {
        if self.first.is_none() {
            self.notes.push(note);
        }
    }

    /// Triangulates the polygons of the first frame, which is complete; returns notes about them.
    pub(crate) fn shape_polygons(&mut self) -> Result<Vec<Note>, Reason> {
        let mut notes = std::mem::take(&mut self.notes);
        let positions = self.vertices.positions();
        notes.extend(self.polygons.shape(positions, &mut self.account)?);
        Ok(notes)
    }

    /// Makes this the first frame, with which all later ones are compared; it came from `file`.
    pub(crate) fn becomes_first(&mut self, file: Arc<Path>) {
        let vertices = self.vertices.len();
        self.precision_of.get_or_insert_with(|| file.clone());
        self.first = Some(First { file, vertices });
        self.polygons.compare_from_now_on();
    }

    /// Finds the seams of the first frame, if it is to be welded.
    ///
    /// `alike`: see [`FrameSource::alike`](crate::source::FrameSource::alike).
    pub(crate) fn seams(
        &mut self,
        tolerance: f64,
        alike: impl FnOnce() -> Option<Vec<u64>>,
    ) -> Result<Seams, Reason> {
        if !self.weld {
            return Ok(Seams::default());
        }
        let alike = alike();
        let mut seams = self.welded(alike.as_deref());
        if alike.is_some() {
            seams.are_a_rule();
        }
        self.join_near(&mut seams, tolerance)?;
        // Fewer bytes than the search took, which were allowed.
        self.account.enter_allowed(seams.bytes());
        Ok(seams)
    }

    /// Finds the seams of a later frame; None where they equal the first frame's.
    pub(crate) fn other_seams(
        &mut self,
        first: &Seams,
        tolerance: f64,
    ) -> Result<Option<Seams>, Reason> {
        if !self.weld {
            return Ok(None);
        }
        let holds = first.hold(self.vertices.positions());
        if holds && tolerance == 0.0 {
            return Ok(None);
        }
        let all = self.polygons.triangles();
        self.check_seams(all.len() as u64, self.vertices.len() as u64, 0)?;
        let mut seams = if holds {
            first.exactly(all)
        } else {
            self.welded(None)
        };
        self.join_near(&mut seams, tolerance)?;
        let all = self.polygons.triangles();
        if seams.triangles(all) == first.triangles(all) {
            return Ok(None);
        }
        self.account.enter_allowed(seams.bytes());
        Ok(Some(seams))
    }

    /// Subtracts bytes that are no longer held.
    pub(crate) fn take_off(&mut self, less: u64) {
        self.account.take_off(less);
    }

    /// Welds the vertices that coincide.
    fn welded(&self, alike: Option<&[u64]>) -> Seams {
        let (triangles, positions) = (self.polygons.triangles(), self.vertices.positions());
        match alike {
            Some(alike) => weld::weld(triangles, positions.len(), |vertex| alike[vertex as usize]),
            None => weld::weld(triangles, positions.len(), |vertex| {
                weld::position_bits(positions, vertex)
            }),
        }
    }

    /// Joins boundary edges that nearly coincide, if `tolerance` is not 0.
    fn join_near(&mut self, seams: &mut Seams, tolerance: f64) -> Result<(), Reason> {
        if tolerance == 0.0 {
            return Ok(());
        }
        let all = self.polygons.triangles();
        let positions = self.vertices.positions();
        let triangles = seams.triangles(all);
        let near = NearSeams::find(triangles, positions, tolerance, &mut self.account)?;
        if let Some(near) = near {
            seams.join(near, all);
        }
        Ok(())
    }

    /// Finds near seams of the frame read last, whose exact seams are `seams`.
    pub(crate) fn near_seams(
        &mut self,
        seams: &Seams,
        tolerance: f64,
    ) -> Result<Option<NearSeams>, Reason> {
        let Some(open) = seams.open.clone().filter(|open| !open.is_empty()) else {
            return Ok(None);
        };
        let triangles = seams.triangles(self.polygons.triangles());
        let positions = self.vertices.positions();
        NearSeams::among(open, triangles, positions, tolerance, &mut self.account)
    }

    /// Number of vertices so far: the number of the next one.
    pub(crate) fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    /// Number of the next face of this frame.
    pub(crate) fn next_face(&self) -> u64 {
        self.polygons.next_face()
    }

    pub(crate) fn positions(&self) -> Positions<'_> {
        self.vertices.positions()
    }

    pub(crate) fn precision(&self) -> Precision {
        self.vertices.precision()
    }

    pub(crate) fn polygons(&self) -> &Polygons {
        &self.polygons
    }
}
