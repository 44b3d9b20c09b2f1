//! One body: connectivity, the shape it has now, and what it may meet.

use super::BodyId;
use crate::error::ErrorKind;
use crate::geometry::{Aabb, Bounds, Scalar, Shape};
use crate::mesh::{self, Mesh};

pub(super) struct Body<S> {
    id: BodyId,
    pub(super) mesh: Mesh,
    /// The shape, in tree order.
    positions: Vec<[S; 3]>,
    /// Where the next shape is written, so that a bad one never replaces a good one.
    spare: Vec<[S; 3]>,
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
        let in_tree_order: Vec<_> = mesh
            .vertex_ids()
            .iter()
            .map(|&vertex| positions[vertex as usize])
            .collect();
        let mut bounds = Bounds::EMPTY;
        in_tree_order[..mesh.used_vertices()]
            .iter()
            .for_each(|&position| bounds.include(position));
        Self {
            id,
            mesh,
            spare: in_tree_order.clone(),
            positions: in_tree_order,
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

    /// What makes boxes and decides pairs.
    #[inline]
    pub(super) fn shape(&self, origin: [f64; 3]) -> Shape<'_, S> {
        Shape {
            positions: &self.positions,
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
    pub(super) fn exact_box(&self, origin: [f64; 3]) -> Aabb {
        self.bounds.to_box(origin)
    }

    /// The box that the broad phase works with: the loose one if there is one.
    pub(super) fn broad_box(&self, origin: [f64; 3]) -> Aabb {
        self.loose.unwrap_or(self.bounds).to_box(origin)
    }

    /// Takes a new shape over, in one pass; or leaves the body as it is and says what was wrong.
    pub(super) fn take_over(&mut self, positions: &[[S; 3]]) -> Result<(), ErrorKind> {
        if positions.len() != self.positions.len() {
            return Err(ErrorKind::WrongLength {
                expected: self.positions.len(),
                found: positions.len(),
            });
        }
        // A NaN or an infinity cannot be seen in the bounds (a comparison passes it over), so it is looked for as we go; which
        // vertex it was is found out only if there was one.
        let (used, unused) = self.spare.split_at_mut(self.mesh.used_vertices());
        let (used_ids, unused_ids) = self.mesh.vertex_ids().split_at(used.len());
        let mut all_in_range = true;
        let mut bounds = Bounds::EMPTY;
        for (place, &vertex) in used.iter_mut().zip(used_ids) {
            let position = positions[vertex as usize];
            *place = position;
            all_in_range &= is_in_range(position);
            bounds.include(position);
        }
        let mut all_bounds = bounds;
        for (place, &vertex) in unused.iter_mut().zip(unused_ids) {
            let position = positions[vertex as usize];
            *place = position;
            all_in_range &= is_in_range(position);
            all_bounds.include(position);
        }
        if !all_in_range {
            return Err(first_outside(
                positions,
                |&position| is_in_range(position),
                |vertex, position| ErrorKind::BadPosition { vertex, position },
            ));
        }
        if let Some(loose) = self
            .loose
            .filter(|loose| !(loose.holds(all_bounds.lo) && loose.holds(all_bounds.hi)))
        {
            return Err(first_outside(
                positions,
                |&position| loose.holds(position),
                |vertex, position| ErrorKind::OutsideLooseBox { vertex, position },
            ));
        }
        std::mem::swap(&mut self.positions, &mut self.spare);
        self.bounds = bounds;
        self.epoch += 1;
        Ok(())
    }

    /// Boxes made so far are no longer true, though the shape is the same: the origin moved.
    pub(super) fn forget_boxes(&mut self) {
        self.epoch += 1;
    }

    /// Triangles and shape as the caller numbers them.
    pub(super) fn in_callers_order(&self) -> (Vec<[u32; 3]>, Vec<[S; 3]>) {
        let mut positions = vec![[S::NAN; 3]; self.positions.len()];
        for (&position, &vertex) in self.positions.iter().zip(self.mesh.vertex_ids()) {
            positions[vertex as usize] = position;
        }
        (self.mesh.in_callers_order(), positions)
    }

    /// The same body in the order of a new tree; positions, the same as now, in the caller's order.
    pub(super) fn reorder(&mut self, mesh: Mesh, positions: &[[S; 3]]) {
        for (place, &vertex) in self.positions.iter_mut().zip(mesh.vertex_ids()) {
            *place = positions[vertex as usize];
        }
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
            let (_, positions) = self.in_callers_order();
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
