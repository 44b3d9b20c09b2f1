//! Edits of a body's mesh: removed triangles stay in the trees and are skipped, new ones go into
//! trees of their own.
//!
//! Triangles in tree order are runs, a **part** each: first the first tree's, then runs of smaller
//! trees. Vertices are numbered as triangles first use them in any tree, so a new part behind all
//! others makes no box stale. Small last parts are merged with what comes (Bentley and Saxe 1980,
//! *Decomposable searching problems*), so each triangle is inserted a few times only. When much of
//! the first tree is out of date, the whole is rebuilt. So an edit costs what it names and what
//! came lately, amortised; only a body's first edit makes lists of all triangles, in O(n).

use super::Body;
use crate::bodies::build::divide;
use crate::bodies::checks;
use crate::bodies::part::Part;
use crate::edit::{Edit, Edited};
use crate::error::ErrorKind;
use crate::ids::TreeVertex;
use crate::kernels::{Coordinate, Instructions};
use crate::mesh::{EMPTY, Outcome};
use crate::options::Options;
use crate::threads::Executor;
use crate::tree::Tree;
use std::collections::BTreeMap;

/// Factor: a part at most this many times as large as what comes is merged with it.
const MUCH_LARGER: usize = 2;
/// A part of at most this many triangles is merged with whatever comes.
const FEW: usize = 64;
/// Divisor: the tree is rebuilt when more than one of this many triangles was removed or came
/// behind it.
const OUT_OF_DATE: usize = 16;
/// The most triangles out of date for which the tree is not rebuilt, however small it is.
const FEWEST: usize = 32;
/// Divisor: a mesh of which more than one of this many triangles differs is taken as another mesh.
const MUCH: usize = 8;

impl<S: Coordinate> Body<S> {
    /// Makes all changes of an edit. On an error the body stays as it is.
    ///
    /// A triangle that goes, or gets other corners, is marked as removed. With other corners it
    /// comes again behind all others.
    pub(crate) fn apply(&mut self, edit: &Edit<S>, options: &Options) -> Result<Edited, ErrorKind> {
        let outcome = self.mesh.draft(edit, &self.shape)?;
        for &(vertex, position) in &outcome.new_vertices {
            checks::one(vertex as usize, position, self.filter.loose())?;
        }
        let Some(edited) = self.mesh.said_of(&outcome) else {
            return Ok(Edited::default());
        };
        self.make(&outcome, options);
        Ok(edited)
    }

    /// Gives the body another mesh and its shape. On an error the body stays as it is.
    ///
    /// Triangles and vertices that are equal by number stay.
    pub(crate) fn set_mesh(
        &mut self,
        triangles: &[[u32; 3]],
        positions: &[[S; 3]],
        options: &Options,
        (instructions, executor): (Instructions, Executor),
    ) -> Result<(), ErrorKind> {
        checks::validate(triangles, positions)?;
        if let Some(loose) = self.filter.loose() {
            checks::all_inside(&loose, positions, |_| false)?;
        }
        let old = self.mesh.triangles();
        let numbers = 0..old.len().max(triangles.len());
        let of = |all: &[[u32; 3]], triangle| all.get(triangle).copied().unwrap_or(EMPTY);
        let both = |triangle| {
            (
                triangle as u32,
                [of(old, triangle), of(triangles, triangle)],
            )
        };
        let changed = numbers.map(both).filter(|(_, [old, new])| old != new);
        let is_much = changed.clone().count() * MUCH > self.mesh.topology().live_count();
        let vertices = self.mesh.vertex_count();
        if is_much || positions.len() < vertices {
            let mut new = Self::new(self.mesh.body(), triangles, positions, options);
            new.mesh.succeed(&self.mesh);
            new.shape.set_version(self.shape.version() + 1);
            std::mem::swap(&mut new.filter, &mut self.filter);
            new.filter.forget_elements();
            std::mem::swap(&mut new.thickness, &mut self.thickness);
            new.thickness.spread(positions.len());
            *self = new;
            return Ok(());
        }
        let added = vertices..positions.len();
        let outcome = Outcome {
            changed: changed.collect(),
            triangles: triangles.len(),
            vertices: positions.len(),
            new_vertices: added.map(|it| (it as u32, positions[it])).collect(),
            split_from: BTreeMap::new(),
            emptied: Vec::new(),
        };
        self.filter.forget_elements();
        self.thickness.spread(vertices);
        self.mesh.fill();
        self.make(&outcome, options);
        self.set_positions(positions, (instructions, executor))
    }

    /// Makes changes that were found good, as a part for what comes, or by rebuilding. A motion
    /// ends.
    fn make(&mut self, outcome: &Outcome<S>, options: &Options) {
        let are_fewer = outcome.triangles < self.mesh.triangles().len();
        let known = self.mesh.vertex_count();
        let is_known = |it: &(u32, [S; 3])| (it.0 as usize) < known;
        let (again, new) =
            (outcome.new_vertices).split_at(outcome.new_vertices.partition_point(is_known));
        self.motion.forget();
        self.mesh.change(outcome);
        self.filter.follow(outcome);
        self.thickness.follow(outcome);
        self.rebuild.note_edit(&outcome.changed, are_fewer);
        let new: Vec<[S; 3]> = new.iter().map(|&(_, position)| position).collect();
        self.shape.push(&new);
        let coming = self.mesh.take_out(outcome, new.len());
        let first = self.parts.in_first();
        let out_of_date = self.mesh.out_of_date(first) + coming.len();
        let is_much = out_of_date > FEWEST.max(first / OUT_OF_DATE);
        if !is_much {
            self.mesh.leave_orphans(&outcome.changed, &mut self.shape);
        }
        self.mesh.place_vertices(outcome, again, &mut self.shape);
        if is_much {
            self.rebuild(options);
        } else {
            self.append(coming, options);
            self.mesh.next_order();
        }
    }

    /// Appends triangles behind all others, as a part that absorbs the last parts that are not much
    /// larger.
    pub(super) fn append(&mut self, mut coming: Vec<u32>, options: &Options) {
        let order = self.mesh.order();
        let used = TreeVertex(order.used_vertices() as u32);
        let mut start = (order.all_corners().len() as u32, used);
        while !coming.is_empty()
            && let Some(last) = self.parts.pop(FEW.max(MUCH_LARGER * coming.len()))
        {
            coming.extend(self.mesh.still_there(last.triangles()));
            start = (last.triangles().start, last.first_vertex());
        }
        if coming.is_empty() {
            return;
        }
        coming.sort_unstable();
        let (first, first_vertex) = start;
        let (corners, positions) = self.mesh.alone(&coming, &self.shape);
        let mut plan = divide(&corners, &positions, options)
            .with_numbers(&coming)
            .behind(first);
        let order = std::mem::take(&mut plan.order);
        self.mesh.append(start, &order, &mut self.shape);
        let tree = Tree::new(&plan, self.mesh.order(), first_vertex);
        let end = first + order.len() as u32;
        self.parts.push(Part::new(tree, first..end, first_vertex));
    }
}
