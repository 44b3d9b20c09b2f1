//! Queries for triangles that intersect. A query for the first begins with the pair that answered
//! last.

pub(crate) mod reference;

use super::ask::first_seen;
use crate::collide::{Ask, Request, near, pair_of};
use crate::error::Error;
use crate::ids::BodyId;
use crate::kernels::Coordinate;
use crate::queries::{Intersections, Needs, Pair};
use crate::selection::Selection;
use crate::statistics::Statistics;
use crate::threads::Interrupt;
use crate::traversal::Visitor;
use crate::world::handle::World;
use crate::world::query::Query;
use crate::world::scalar::Scalar;
use crate::world::state::State;

/// # Questions: triangles that intersect
impl<S: Scalar> World<S> {
    /// Asks which triangles intersect, between bodies or within one: pairs of triangles as closed
    /// sets; touching counts.
    ///
    /// The [`Selection`] says whom the question is about. The [`Query`] that comes back is told how
    /// much is wanted. Within a body, triangles that share a vertex of the mesh are left out, for
    /// they always touch. Surfaces only: a body wholly inside another meets none of its triangles.
    ///
    /// [`Query`] says the errors, [`Query::all`] the cost.
    ///
    /// ```
    /// # use pliant::{Selection, World};
    /// # let mut world = World::<f32>::new();
    /// # let shirt = world.add(&[[0, 1, 2]], &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])?;
    /// # let skin = world.add(&[[0, 1, 2]], &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])?;
    /// for pair in world.intersections(Selection::Between(shirt, skin)).all()? {
    ///     let [shirt, skin] = pair.triangles();
    ///     println!("triangle {shirt} of the shirt meets triangle {skin} of the skin");
    /// }
    /// if world.intersections(Selection::Everything).first()?.is_none() {
    ///     println!("nothing meets anything");
    /// }
    /// # assert_eq!(world.intersections(Selection::World).all()?.len(), 1);
    /// # Ok::<(), pliant::Error>(())
    /// ```
    #[doc(alias = "rtcCollide")]
    #[doc(alias = "bvhcast")]
    #[doc(alias = "findCollidingTriangles")]
    #[doc(alias = "findSelfCollidingTriangles")]
    #[doc(alias = "self_intersections")]
    #[doc(alias = "does_self_intersect")]
    pub fn intersections(&mut self, of: Selection) -> Query<'_, Pair> {
        Query::new(&mut *self.verbs, of)
    }
}

impl<S: Coordinate> Ask<Pair> for State<S> {
    fn all(&mut self, request: &Request) -> Result<&[Pair], Error> {
        let kind = &Intersections::default();
        self.kinds
            .intersections
            .all(kind, &mut self.common, request)
    }

    /// Asks the witness, the pair that answered last, before all others: see `witness`.
    fn first(&mut self, request: &Request) -> Result<Option<Pair>, Error> {
        let last = match request.of {
            Selection::World => self.witnesses.of_world[0],
            Selection::Everything => self.witnesses.of_world[1],
            Selection::Between(a, b) => Some([a, b]),
            Selection::Within(a) => Some([a; 2]),
        };
        if let Some(bodies) = last.filter(|&bodies| self.do_meet(bodies, request.of))
            && let Some(pair) = self.ask_witness(bodies, request)?
        {
            return Ok(Some(pair));
        }
        let found = first_seen(|visitor| Ask::<Pair>::visit(self, request, visitor))?;
        let bodies = found.map(|pair: Pair| [pair.body_a, pair.body_b]);
        match request.of {
            Selection::World => self.witnesses.of_world[0] = bodies,
            Selection::Everything => self.witnesses.of_world[1] = bodies,
            Selection::Between(..) | Selection::Within(_) => {}
        }
        if let (Some(bodies), Some(at)) = (bodies, self.kinds.intersections.tasks.broke_at.take()) {
            self.witnesses.keep(bodies, at);
        }
        Ok(found)
    }

    fn visit(&mut self, request: &Request, visitor: Visitor<Pair>) -> Result<(), Error> {
        let kind = &Intersections::default();
        self.kinds
            .intersections
            .visit(kind, &mut self.common, request, visitor)
    }

    fn prepare(&mut self, request: &Request) -> Result<(), Error> {
        self.common.prepare(Needs::TRIANGLES, request)
    }
}

/// The witness: the pair that answered the last question for a first pair.
impl<S: Coordinate> State<S> {
    /// Whether two bodies are still there, and meet in a query of this selection.
    fn do_meet(&self, [a, b]: [BodyId; 2], of: Selection) -> bool {
        let (Ok(body_a), Ok(body_b)) = (self.body(a), self.body(b)) else {
            return false;
        };
        match of {
            Selection::World | Selection::Everything => self.common.bodies.do_meet(body_a, body_b),
            Selection::Between(..) => a != b,
            Selection::Within(_) => true,
        }
    }

    /// Finds a pair of these bodies at or near the last answer, if one intersects. Its work is
    /// counted in any case.
    fn ask_witness(
        &mut self,
        bodies: [BodyId; 2],
        request: &Request,
    ) -> Result<Option<Pair>, Error> {
        let Some(last) = self.witnesses.get(bodies) else {
            return Ok(None);
        };
        if bodies[0] == bodies[1] {
            self.common.bodies.get_mut(bodies[0])?.know_labels();
        }
        let both = [self.body(bodies[0])?, self.body(bodies[1])?];
        let interrupt = Interrupt::new(request.question);
        let mut statistics = self.common.done_early;
        let found = near(both, last, &interrupt, &mut statistics);
        let pair = found.map(|found| pair_of(both, found));
        if let Some(found) = found {
            self.common.statistics = statistics;
            self.common.done_early = Statistics::default();
            self.witnesses.keep(bodies, found);
        } else {
            self.common.done_early = statistics;
            self.common.end(&interrupt)?;
        }
        Ok(pair)
    }
}
