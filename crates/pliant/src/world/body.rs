//! One body: connectivity, the shape it has now, and what it may meet.

use super::BodyId;
use super::positions::Positions;
use crate::error::ErrorKind;
use crate::exec::Threads;
use crate::geometry::{Aabb, Bounds, Origin, Points, Scalar, Shape, denormals_are_kept};
use crate::kernels::{Level, widest};
use crate::mesh::{self, Mesh};
use std::borrow::Cow;

pub(super) struct Body<S> {
    id: BodyId,
    pub(super) mesh: Mesh,
    positions: Positions<S>,
    /// Of the vertices that triangles use.
    bounds: Bounds<S>,
    /// Counts changes of shape, and of the origin that boxes are relative to. Boxes of other epochs are not true.
    epoch: u64,
    membership: u32,
    mask: u32,
    loose: Option<Bounds<S>>,
}

/// Refuses what no body can be made of.
pub(crate) fn validate<S: Scalar>(
    triangles: &[[u32; 3]],
    positions: &[[S; 3]],
) -> Result<(), ErrorKind> {
    mesh::validate(triangles, positions.len())?;
    match positions
        .iter()
        .position(|&position| !is_in_range(position))
    {
        Some(vertex) => Err(ErrorKind::BadPosition {
            vertex,
            position: positions[vertex].map(S::to_f64),
        }),
        None => none_is_lost(positions),
    }
}

/// Refuses coordinates so small that this thread, where subnormal numbers are flushed, would lose them. Costs two products
/// where they are not.
fn none_is_lost<S: Scalar>(positions: &[[S; 3]]) -> Result<(), ErrorKind> {
    if denormals_are_kept() {
        return Ok(());
    }
    let is_lost = |position: &[S; 3]| position.iter().any(|x| x.needs_subnormals());
    match positions.iter().position(is_lost) {
        Some(vertex) => Err(ErrorKind::NeedsSubnormals { vertex }),
        None => Ok(()),
    }
}

#[inline]
fn is_in_range<S: Scalar>([x, y, z]: [S; 3]) -> bool {
    // No early exit: three comparisons without a branch.
    x.is_in_range() & y.is_in_range() & z.is_in_range()
}

impl<S: Scalar> Body<S> {
    /// A body of validated parts; positions in the caller's order.
    pub(super) fn new(id: BodyId, mesh: Mesh, positions: &[[S; 3]]) -> Self {
        let bounds = bounds_of(
            mesh.vertex_ids()[..mesh.used_vertices()]
                .iter()
                .map(|&vertex| positions[vertex as usize]),
        );
        Self {
            id,
            mesh,
            positions: Positions::new(positions),
            bounds,
            epoch: 1,
            membership: u32::MAX,
            mask: u32::MAX,
            loose: None,
        }
    }

    pub(super) fn id(&self) -> BodyId {
        self.id
    }

    pub(super) fn triangle_count(&self) -> usize {
        self.mesh.corners().len()
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// Brings the shape into tree order, which everything that looks at it needs.
    pub(super) fn bring_into_order(&mut self, level: Level, threads: &Threads) {
        let order = self.mesh.vertex_ids();
        self.positions.bring_into_tree_order(level, threads, order);
    }

    /// The shape in tree order, whether it was brought into it or not.
    pub(super) fn in_tree_order(&self) -> Points<S> {
        let mut points = Points::with_len(self.positions.len());
        let order = self.mesh.vertex_ids();
        points.gather(widest(), &Threads::one(), &self.positions(), order);
        points
    }

    /// The caller's number of a triangle in tree order.
    pub(super) fn name(&self, triangle: u32) -> u32 {
        self.mesh.triangle_ids()[triangle as usize]
    }

    /// The corners of a triangle in tree order, whether the shape was brought into it or not; exact.
    pub(super) fn corners_now(&self, triangle: u32) -> [[f64; 3]; 3] {
        let order = self.mesh.vertex_ids();
        self.mesh.corners()[triangle as usize]
            .map(|vertex| self.positions.get(vertex, order).map(S::to_f64))
    }

    pub(super) fn epoch(&self) -> u64 {
        self.epoch
    }

    /// What makes boxes and decides pairs; of a body that was brought into order.
    #[inline]
    pub(super) fn shape(&self, origin: Origin) -> Shape<'_, S> {
        Shape {
            positions: self.positions.in_tree_order(),
            triangles: self.mesh.corners(),
            origin,
            epoch: self.epoch,
        }
    }

    /// The exact extent, in the caller's coordinates.
    pub(super) fn bounds(&self) -> Bounds<S> {
        self.bounds
    }

    /// The box of the body as it is.
    #[inline]
    pub(super) fn exact_box(&self, origin: Origin) -> Aabb {
        self.bounds.to_box(origin)
    }

    /// The box that the broad phase works with: the loose one if there is one.
    pub(super) fn broad_box(&self, origin: Origin) -> Aabb {
        self.loose.unwrap_or(self.bounds).to_box(origin)
    }

    /// Takes a new shape over, in one pass; or leaves the body as it is and says what was wrong.
    pub(super) fn take_over(
        &mut self,
        level: Level,
        threads: &Threads,
        positions: &[[S; 3]],
    ) -> Result<(), ErrorKind> {
        if positions.len() != self.positions.len() {
            return Err(ErrorKind::WrongLength {
                expected: self.positions.len(),
                found: positions.len(),
            });
        }
        let Some(all) = self.positions.look_at(level, threads, positions) else {
            // Which vertex it was is found out only if there was one.
            return Err(first_outside(
                positions,
                |&position| is_in_range(position),
                |vertex, position| ErrorKind::BadPosition { vertex, position },
            ));
        };
        if let Some(loose) = self
            .loose
            .filter(|loose| !(loose.holds(all.lo) && loose.holds(all.hi)))
        {
            return Err(first_outside(
                positions,
                |&position| loose.holds(position),
                |vertex, position| ErrorKind::OutsideLooseBox { vertex, position },
            ));
        }
        none_is_lost(positions)?;
        let order = self.mesh.vertex_ids();
        self.positions.accept(level, threads, positions, order);
        let used = self.mesh.used_vertices();
        self.bounds = if used == positions.len() {
            all
        } else {
            let used = order[..used].iter();
            bounds_of(used.map(|&vertex| positions[vertex as usize]))
        };
        self.epoch += 1;
        Ok(())
    }

    /// Boxes made so far are no longer true, though the shape is the same: the origin moved.
    pub(super) fn forget_boxes(&mut self) {
        self.epoch += 1;
    }

    /// Triangles as the caller numbers them.
    pub(super) fn triangles(&self) -> Vec<[u32; 3]> {
        self.mesh.in_callers_order()
    }

    /// The shape as the caller orders vertices.
    pub(super) fn positions(&self) -> Cow<'_, [[S; 3]]> {
        self.positions.in_callers_order(self.mesh.vertex_ids())
    }

    /// The same body in the order of a new tree.
    pub(super) fn reorder(&mut self, mesh: Mesh) {
        self.positions.forget_tree_order(self.mesh.vertex_ids());
        self.mesh = mesh;
        self.epoch += 1;
    }

    pub(super) fn set_filter(&mut self, membership: u32, mask: u32) {
        (self.membership, self.mask) = (membership, mask);
    }

    /// Whether the masks of two bodies let them meet.
    pub(super) fn may_meet(&self, other: &Self) -> bool {
        self.membership & other.mask != 0 && other.membership & self.mask != 0
    }

    pub(super) fn set_loose_box(&mut self, loose: Option<Bounds<S>>) -> Result<(), ErrorKind> {
        if let Some(loose) = loose {
            let is_box = is_in_range(loose.lo)
                && is_in_range(loose.hi)
                && loose.holds(loose.lo)
                && loose.holds(loose.hi);
            if !is_box {
                return Err(ErrorKind::BadLooseBox);
            }
            let positions = self.positions();
            if !positions.iter().all(|&position| loose.holds(position)) {
                return Err(first_outside(
                    &positions,
                    |&position| loose.holds(position),
                    |vertex, position| ErrorKind::OutsideLooseBox { vertex, position },
                ));
            }
        }
        self.loose = loose;
        Ok(())
    }
}

fn bounds_of<S: Scalar>(positions: impl Iterator<Item = [S; 3]>) -> Bounds<S> {
    let mut bounds = Bounds::EMPTY;
    positions.for_each(|position| bounds.include(position));
    bounds
}

/// The error for the first position that is not good; there is one.
fn first_outside<S: Scalar>(
    positions: &[[S; 3]],
    is_good: impl Fn(&[S; 3]) -> bool,
    error: impl Fn(usize, [f64; 3]) -> ErrorKind,
) -> ErrorKind {
    let vertex = positions
        .iter()
        .position(|position| !is_good(position))
        .unwrap_or_default();
    error(vertex, positions[vertex].map(S::to_f64))
}
