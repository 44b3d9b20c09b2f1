//! Queries for impacts: elements that meet during a motion, and when.

pub(crate) mod reference;

use crate::collide::{Ask, OfKind, Request};
use crate::error::Error;
use crate::kernels::Coordinate;
use crate::queries::{
    EdgeEdgeCandidates, EdgeEdgeImpact, Impacts, Kind, Margin, Reach, VertexTriangleCandidates,
    VertexTriangleImpact,
};
use crate::selection::Selection;
use crate::traversal::Visitor;
use crate::world::handle::World;
use crate::world::query::Query;
use crate::world::scalar::Scalar;
use crate::world::state::State;

/// # Questions: impacts during a motion
impl<S: Scalar> World<S> {
    /// Asks which vertices and triangles meet on the way to the end of a motion, and when first.
    ///
    /// See [`edge_edge_impacts`](Self::edge_edge_impacts) for the other half: surfaces that are
    /// apart first meet where a vertex meets a triangle or two edges meet.
    ///
    /// Time goes from 0 to 1. Vertices move on straight lines, in real arithmetic, from where they
    /// are to where [`set_motion`](Self::set_motion) said; a body without a motion stands still.
    /// Whether a pair meets is decided exactly, for closed sets. Degenerate triangles, motion in
    /// one plane, and touching at the start and at the end are included. The time is an interval
    /// ([`VertexTriangleImpact`]), as narrow as [`Query::width`] says. [`Query::first`] gives the
    /// impact with the least exact time, much faster than all.
    ///
    /// Which pairs are looked at is said at
    /// [`vertex_triangle_candidates`](Self::vertex_triangle_candidates): no corner of a triangle
    /// meets it, and vertex groups and filters count. Candidates are not listed on the way, so
    /// memory is for elements that meet.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// let mut world = World::<f64>::new();
    /// let large = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
    /// let floor = world.add(&[[0, 1, 2]], &large)?;
    /// let leaf = world.add(&[[0, 1, 2]], &[[0.0, 0.0, 2.0], [1.0, 0.0, 3.0], [0.0, 1.0, 3.0]])?;
    /// // It falls by 3, and its corner touches the floor after two thirds of the step.
    /// world.set_motion(leaf, &[[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// let first = world.vertex_triangle_impacts(Selection::World).first()?;
    /// let first = first.expect("it falls far enough");
    /// assert_eq!((first.pair.vertex_body, first.pair.vertex), (leaf, 0));
    /// assert!(first.low < 2.0 / 3.0 && 2.0 / 3.0 <= first.high && first.high - first.low <= 1e-6);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The errors of [`Query`].
    #[doc(alias = "time_of_impact")]
    #[doc(alias = "continuous_collision_detection")]
    #[doc(alias = "point_triangle_ccd")]
    pub fn vertex_triangle_impacts(&mut self, of: Selection) -> Query<'_, VertexTriangleImpact> {
        Query::new(&mut *self.verbs, of)
    }

    /// Asks which edges meet on the way to the end of a motion, and when first.
    ///
    /// All is as for [`vertex_triangle_impacts`](Self::vertex_triangle_impacts). Edges have the
    /// numbers that [`edges`](Self::edges) gives them; two that have an end in common are not
    /// looked at.
    ///
    /// # Errors
    ///
    /// The errors of [`Query`].
    #[doc(alias = "edge_edge_ccd")]
    pub fn edge_edge_impacts(&mut self, of: Selection) -> Query<'_, EdgeEdgeImpact> {
        Query::new(&mut *self.verbs, of)
    }
}

impl Query<'_, VertexTriangleImpact> {
    /// Sets how wide the interval of an impact may be: `high - low` is at most this. Default:
    /// 10^-6.
    ///
    /// The width is finite and at least 0. With 0, the ends are two neighbouring numbers, as near
    /// as there are. A width of 10^-6 costs next to nothing.
    ///
    /// The interval is a cell of a grid, whose spacing is the largest power of two that is not
    /// above the width. Its ends are the multiples next to the exact time. Where floating-point
    /// numbers are further from each other than that, they are the numbers next to it.
    pub fn width(mut self, width: f64) -> Self {
        self.request.width = width;
        self
    }
}

impl Query<'_, EdgeEdgeImpact> {
    /// Sets how wide the interval of an impact may be, as for vertices and triangles.
    pub fn width(mut self, width: f64) -> Self {
        self.request.width = width;
        self
    }
}

/// Implements queries for impacts of one kind.
macro_rules! ask_impacts {
    ($hit:ident, $kept:ident, $candidates:ident, $of:expr) => {
        impl<S: Coordinate> Ask<$hit> for State<S> {
            fn all(&mut self, request: &Request) -> Result<&[$hit], Error> {
                let kind = Self::all_of(request, $candidates::within)?;
                self.kinds
                    .impacts
                    .$kept
                    .all_listed(&kind, &mut self.common, request)
            }

            fn first(&mut self, request: &Request) -> Result<Option<$hit>, Error> {
                let grid = request.grid()?;
                let first = self
                    .kinds
                    .impacts
                    .first_contact(&mut self.common, request, $of)?;
                Ok(first.and_then(|first| $hit::of(first.in_cell_of(grid))))
            }

            fn visit(&mut self, request: &Request, visitor: Visitor<$hit>) -> Result<(), Error> {
                let kind = Self::all_of(request, $candidates::within)?;
                self.kinds
                    .impacts
                    .$kept
                    .visit(&kind, &mut self.common, request, visitor)
            }

            fn prepare(&mut self, request: &Request) -> Result<(), Error> {
                let kind = Self::all_of(request, $candidates::<S>::within)?;
                self.common.prepare(kind.needs(), request)
            }
        }
    };
}

ask_impacts!(
    VertexTriangleImpact,
    vertex_triangle,
    VertexTriangleCandidates,
    OfKind::VerticesAndTriangles
);
ask_impacts!(EdgeEdgeImpact, edge_edge, EdgeEdgeCandidates, OfKind::Edges);

impl<S: Coordinate> State<S> {
    /// Makes the question for all impacts of one kind of candidates.
    fn all_of<K>(request: &Request, within: impl Fn(Margin) -> K) -> Result<Impacts<K>, Error> {
        let candidates = within(Margin::new(0.0).counting_thickness(0.0));
        Ok(Impacts::of(candidates, request.grid()?, Reach::End))
    }
}
