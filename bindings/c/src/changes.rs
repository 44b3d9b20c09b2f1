//! Changes of a list of hits from one step to the next.

use crate::arrays::{PliantList, give, list, read, start};
use crate::edits::{PliantEdited, PliantFused, PliantPiece};
use crate::objects::{hand_out, take_back, uses};
use crate::status::{BAD_OPTION, PliantError, PliantStatus, Refused, call};
use pliant::{BodyId, Fused, Piece, RowChanges, Thing};
use std::sync::Mutex;

/// `pliant_changes`.
pub struct PliantChanges(Mutex<Kept>);

/// The memory of a list, and the last answer.
struct Kept {
    changes: RowChanges,
    numbers: Vec<u64>,
    began: Vec<u64>,
    ended: Vec<[u32; 4]>,
    ended_numbers: Vec<u64>,
}

/// `pliant_changed`: what began, persists and ended.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantChanged {
    /// Number of hits in the new list.
    pub count: usize,
    /// Number of each.
    pub numbers: *const u64,
    /// How many began.
    pub began_count: usize,
    /// Their places in the new list.
    pub began: *const u64,
    /// How many ended.
    pub ended_count: usize,
    /// Body, element, body, element of each.
    pub ended: *const u32,
    /// Number that each had.
    pub ended_numbers: *const u64,
}

/// `pliant_changes_new`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_changes_new(
    elements: u32,
    changes: *mut *mut PliantChanges,
    error: *mut PliantError,
) -> PliantStatus {
    let make = || {
        let things = match elements {
            0 => [Thing::Triangle; 2],
            1 => [Thing::Vertex, Thing::Triangle],
            2 => [Thing::Edge; 2],
            3 => [Thing::Edge, Thing::Triangle],
            other => {
                let least = "PLIANT_TRIANGLES to _EDGE_TRIANGLE";
                let words = format_args!("elements is {other}; give one of {least}");
                return Err(Refused::new(BAD_OPTION, words));
            }
        };
        Ok(PliantChanges(Mutex::new(Kept {
            changes: RowChanges::new(things),
            numbers: Vec::new(),
            began: Vec::new(),
            ended: Vec::new(),
            ended_numbers: Vec::new(),
        })))
    };
    // SAFETY: as the header says.
    unsafe { call(error, || hand_out(changes, "changes", make)) }
}

/// `pliant_changes_free`.
///
/// # Safety
///
/// It is NULL, or was made, is not freed, and no call is inside.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_changes_free(changes: *mut PliantChanges) {
    // SAFETY: as above.
    unsafe { take_back(changes) };
}

uses! {
    changes: PliantChanges as Kept;

    fn pliant_changes_update(
        pairs: *const u32,
        count: usize,
        changed: *mut PliantChanged,
    ) |kept| {
        // SAFETY: as the header says.
        let pairs = unsafe { list(pairs.cast::<[u32; 4]>(), count, "pairs")? };
        let things = |[body_a, a, body_b, b]: [u32; 4]| [(BodyId(body_a), a), (BodyId(body_b), b)];
        let told = kept.changes.update(pairs.into_iter().map(things));
        let row = |[(body_a, a), (body_b, b)]: [(BodyId, u32); 2]| [body_a.0, a, body_b.0, b];
        told.numbers.clone_into(&mut kept.numbers);
        kept.began = told.began.iter().map(|&place| place as u64).collect();
        kept.ended = told.ended.iter().map(|ended| row(ended.things)).collect();
        kept.ended_numbers = told.ended.iter().map(|ended| ended.number).collect();
        let view = PliantChanged {
            count: kept.numbers.len(),
            numbers: start(&kept.numbers),
            began_count: kept.began.len(),
            began: start(&kept.began),
            ended_count: kept.ended.len(),
            ended: start(&kept.ended),
            ended_numbers: start(&kept.ended_numbers),
        };
        // SAFETY: as the header says.
        unsafe { give(changed, view) };
        Ok(())
    }

    fn pliant_changes_edited(body: u32, edited: *const PliantEdited) |kept| {
        // SAFETY: as the header says.
        let edited = unsafe { read(edited) }.ok_or_else(|| Refused::null("edited"))?;
        // SAFETY: as the header says.
        let edited = unsafe { edited.copied()? };
        kept.changes.edited(BodyId(body), &edited);
        Ok(())
    }

    fn pliant_changes_edges_edited(
        body: u32,
        before: *const u32,
        before_count: usize,
        after: *const u32,
        after_count: usize,
    ) |kept| {
        // SAFETY: as the header says.
        let (before, after) = unsafe {
            let before = list(before.cast::<[u32; 2]>(), before_count, "before")?;
            (before, list(after.cast::<[u32; 2]>(), after_count, "after")?)
        };
        kept.changes.edges_edited(BodyId(body), &before, &after);
        Ok(())
    }

    fn pliant_changes_split(body: u32, pieces: *const PliantPiece, count: usize) |kept| {
        // SAFETY: as the header says.
        let pieces = unsafe { list(pieces, count, "pieces")? };
        let mut all = Vec::with_capacity(pieces.len());
        for piece in pieces {
            all.push(Piece {
                body: BodyId(piece.body),
                triangles: numbers(&piece.triangles, "pieces.triangles")?,
                vertices: numbers(&piece.vertices, "pieces.vertices")?,
            });
        }
        kept.changes.split(BodyId(body), &all);
        Ok(())
    }

    fn pliant_changes_fused(body: u32, gone: u32, fused: *const PliantFused) |kept| {
        // SAFETY: as the header says.
        let fused = unsafe { read(fused) }.ok_or_else(|| Refused::null("fused"))?;
        let fused = Fused {
            triangles: numbers(&fused.triangles, "fused.triangles")?,
            vertices: numbers(&fused.vertices, "fused.vertices")?,
        };
        kept.changes.fused(BodyId(body), BodyId(gone), &fused);
        Ok(())
    }
}

/// The numbers of a list of the caller's.
fn numbers(of: &PliantList, name: &str) -> Result<Vec<u32>, Refused> {
    // SAFETY: the header says that lists may be read.
    unsafe { list(of.numbers, of.count, name) }
}
