//! Meshes that change: edits, pieces of a body, bodies that become one.

use crate::arrays::{PliantList, give, list, row, start};
use crate::faces::PliantFaces;
use crate::objects::{hand_out, held, take_back, uses};
use crate::points::{Number, PliantPoints, positions};
use crate::questions::PliantQuery;
use crate::status::{OUTDATED_EDIT, Refused, WRONG_LENGTH};
use crate::world::{AnyWorld, calls, with_world};
use pliant::{BodyId, Edit, Edited, Fused, Piece, World};
use std::sync::Mutex;

/// Changes of meshes, which the caller reads until the next.
#[derive(Default)]
pub(crate) struct Edits {
    edited: Edited,
    pieces: Vec<Piece>,
    views: Vec<PliantPiece>,
    fused: Option<Fused>,
}

/// `pliant_edited`: numbers that an edit has changed.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct PliantEdited {
    /// Triangles that are new.
    pub new_triangles: PliantList,
    /// Triangles that have other corners.
    pub changed_triangles: PliantList,
    /// Triangles that were removed.
    pub removed_triangles: PliantList,
    /// Vertices that are new.
    pub new_vertices: PliantList,
    /// Vertices that were removed.
    pub removed_vertices: PliantList,
}

impl PliantEdited {
    fn of(edited: &Edited) -> Self {
        Self {
            new_triangles: PliantList::of(&edited.new_triangles),
            changed_triangles: PliantList::of(&edited.changed_triangles),
            removed_triangles: PliantList::of(&edited.removed_triangles),
            new_vertices: PliantList::of(&edited.new_vertices),
            removed_vertices: PliantList::of(&edited.removed_vertices),
        }
    }

    /// Copies the lists.
    ///
    /// # Safety
    ///
    /// The lists may be read.
    pub(crate) unsafe fn copied(&self) -> Result<Edited, Refused> {
        // SAFETY: as above.
        let all = |of: &PliantList| unsafe { list(of.numbers, of.count, "edited") };
        Ok(Edited {
            new_triangles: all(&self.new_triangles)?,
            changed_triangles: all(&self.changed_triangles)?,
            removed_triangles: all(&self.removed_triangles)?,
            new_vertices: all(&self.new_vertices)?,
            removed_vertices: all(&self.removed_vertices)?,
        })
    }
}

/// `pliant_piece`: a body that was a component of another.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantPiece {
    /// The new body.
    pub body: u32,
    /// Numbers that its triangles had.
    pub triangles: PliantList,
    /// Numbers that its vertices had.
    pub vertices: PliantList,
}

/// `pliant_fused`: new numbers of what came from another body.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantFused {
    /// New numbers of triangles.
    pub triangles: PliantList,
    /// New numbers of vertices.
    pub vertices: PliantList,
}

/// An edit of either precision.
enum AnyEdit {
    F32(Edit<f32>),
    F64(Edit<f64>),
}

/// `pliant_edit`.
pub struct PliantEdit(Mutex<AnyEdit>);

macro_rules! with_edit {
    ($any:expr, $edit:ident => $work:expr) => {
        match $any {
            AnyEdit::F32($edit) => $work,
            AnyEdit::F64($edit) => $work,
        }
    };
}

uses! {
    edit: PliantEdit as AnyEdit;

    fn pliant_edit_counts(body: *mut u32, triangles: *mut usize, vertices: *mut usize) |edit| {
        with_edit!(edit, edit => {
            // SAFETY: as the header says.
            unsafe {
                give(body, edit.body().0);
                give(triangles, edit.triangle_count());
                give(vertices, edit.vertex_count());
            }
        });
        Ok(())
    }

    fn pliant_edit_add_vertices(points: PliantPoints, first: *mut u32) |edit| {
        let new = with_edit!(edit, edit => add_vertices(edit, &points)?);
        // SAFETY: as the header says.
        unsafe { give(first, new) };
        Ok(())
    }

    fn pliant_edit_place_vertex(vertex: u32, point: PliantPoints) |edit| {
        with_edit!(edit, edit => place(edit, vertex, &point))
    }

    fn pliant_edit_split_vertex(
        vertex: u32,
        triangles: *const u32,
        count: usize,
        new_vertex: *mut u32,
    ) |edit| {
        // SAFETY: as the header says.
        let triangles = unsafe { list(triangles, count, "triangles")? };
        let new = with_edit!(edit, edit => edit.split_vertex(vertex, &triangles));
        // SAFETY: as the header says.
        unsafe { give(new_vertex, new) };
        Ok(())
    }

    fn pliant_edit_merge_vertices(kept: u32, gone: u32) |edit| {
        with_edit!(edit, edit => edit.merge_vertices(kept, gone));
        Ok(())
    }

    fn pliant_edit_add_triangles(faces: PliantFaces, first: *mut u32) |edit| {
        // SAFETY: as the header says.
        let faces = unsafe { faces.copied()? };
        let new = with_edit!(edit, edit => edit.add_triangles(&faces).start);
        // SAFETY: as the header says.
        unsafe { give(first, new) };
        Ok(())
    }

    fn pliant_edit_set_triangle(triangle: u32, corners: *const u32) |edit| {
        // SAFETY: as the header says.
        let corners = unsafe { row(corners.cast::<[u32; 3]>(), "corners")? };
        with_edit!(edit, edit => edit.set_triangle(triangle, corners));
        Ok(())
    }

    fn pliant_edit_remove_triangles(triangles: *const u32, count: usize) |edit| {
        // SAFETY: as the header says.
        let triangles = unsafe { list(triangles, count, "triangles")? };
        with_edit!(edit, edit => edit.remove_triangles(&triangles));
        Ok(())
    }
}

/// `pliant_edit_free`.
///
/// # Safety
///
/// The edit is NULL, or was made, is not freed, and no call is inside.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_edit_free(edit: *mut PliantEdit) {
    // SAFETY: as above.
    unsafe { take_back(edit) };
}

fn add_vertices<S: Number>(edit: &mut Edit<S>, points: &PliantPoints) -> Result<u32, Refused> {
    // SAFETY: as the header says of the caller's points.
    let points = unsafe { positions::<S>(points)? };
    Ok(edit.add_vertices(&points).start)
}

fn place<S: Number>(edit: &mut Edit<S>, vertex: u32, point: &PliantPoints) -> Result<(), Refused> {
    // SAFETY: as the header says of the caller's points.
    let point = unsafe { positions::<S>(point)? };
    let &[point] = &point[..] else {
        let words = format_args!("point has {} points; give 1", point.len());
        let mut refused = Refused::new(WRONG_LENGTH, words);
        (refused.0.count, refused.0.limit) = (point.len() as u64, 1);
        return Err(refused);
    };
    edit.place_vertex(vertex, point);
    Ok(())
}

calls! {
    fn pliant_world_edit(body: u32, edit: *mut *mut PliantEdit) |inside| {
        let begin = || {
            let begun = match &inside.world {
                AnyWorld::F32(world) => AnyEdit::F32(world.edit(BodyId(body))?),
                AnyWorld::F64(world) => AnyEdit::F64(world.edit(BodyId(body))?),
            };
            Ok(PliantEdit(Mutex::new(begun)))
        };
        // SAFETY: as the header says.
        unsafe { hand_out(edit, "edit", begin) }
    }

    fn pliant_world_apply(edit: *const PliantEdit, edited: *mut PliantEdited) |inside| {
        // SAFETY: as the header says.
        let edit = held(unsafe { edit.as_ref() }.map(|it| &it.0), "edit")?;
        let done = match (&mut inside.world, &*edit) {
            (AnyWorld::F32(world), AnyEdit::F32(edit)) => applied(world, edit)?,
            (AnyWorld::F64(world), AnyEdit::F64(edit)) => applied(world, edit)?,
            _ => {
                let words = "the edit is of a world of another precision";
                return Err(Refused::new(OUTDATED_EDIT, words));
            }
        };
        inside.views.of::<Edits>().edited = done;
        // SAFETY: as the header says.
        unsafe { give(edited, PliantEdited::of(&inside.views.of::<Edits>().edited)) };
        Ok(())
    }

    fn pliant_world_weld(
        body: u32,
        tolerance: f64,
        query: *const PliantQuery,
        edited: *mut PliantEdited,
    ) |inside| {
        // SAFETY: as the header says.
        let until = unsafe { PliantQuery::interrupt_alone(query)? };
        let done = with_world!(&mut inside.world, world => {
            world.interruptible(&|| until.ends()).weld(BodyId(body), tolerance)?
        });
        inside.views.of::<Edits>().edited = done;
        // SAFETY: as the header says.
        unsafe { give(edited, PliantEdited::of(&inside.views.of::<Edits>().edited)) };
        Ok(())
    }

    fn pliant_world_split(body: u32, pieces: *mut *const PliantPiece, count: *mut usize) |inside| {
        let kept = inside.views.of::<Edits>();
        kept.pieces = with_world!(&mut inside.world, world => world.split(BodyId(body))?);
        let view = |piece: &Piece| PliantPiece {
            body: piece.body.0,
            triangles: PliantList::of(&piece.triangles),
            vertices: PliantList::of(&piece.vertices),
        };
        kept.views = kept.pieces.iter().map(view).collect();
        // SAFETY: as the header says.
        unsafe {
            give(pieces, start(&kept.views));
            give(count, kept.views.len());
        }
        Ok(())
    }

    fn pliant_world_fuse(a: u32, b: u32, fused: *mut PliantFused) |inside| {
        let new = with_world!(&mut inside.world, world => world.fuse(BodyId(a), BodyId(b))?);
        let new = inside.views.of::<Edits>().fused.insert(new);
        let view = PliantFused {
            triangles: PliantList::of(&new.triangles),
            vertices: PliantList::of(&new.vertices),
        };
        // SAFETY: as the header says.
        unsafe { give(fused, view) };
        Ok(())
    }
}

fn applied<S: Number>(world: &mut World<S>, edit: &Edit<S>) -> Result<Edited, Refused> {
    Ok(world.apply(edit)?)
}
