//! Inside, outside or on closed bodies; whether bodies are closed, and what lies inside which.

use crate::arrays::{PliantList, give, start};
use crate::points::{Number, PliantPoints, points};
use crate::questions::{Interrupt, PliantQuery};
use crate::status::{BAD_OPTION, Refused};
use crate::world::{calls, with_world};
use pliant::{BodyId, Error, InsideRule, Interruptible, Located, Side, Watertight, World};

/// Answers that the caller reads, one for each function.
#[derive(Default)]
pub(crate) struct Kept {
    points: Columns,
    vertices: Columns,
    edges: Watertight,
    contained: Vec<[u32; 3]>,
    open: Vec<u32>,
}

/// Sides of points in columns.
#[derive(Default)]
struct Columns {
    sides: Vec<u8>,
    windings: Vec<i32>,
}

/// `pliant_located`: on which side each of some points is.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantLocated {
    /// Number of points.
    pub count: usize,
    /// Sides.
    pub sides: *const u8,
    /// Winding numbers.
    pub windings: *const i32,
}

/// `pliant_watertight`: edges at which a body is not a closed surface.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantWatertight {
    /// Edges in an odd number of triangles.
    pub open: PliantList,
    /// Edges whose triangles are turned against each other.
    pub turned: PliantList,
    /// Edges in more than two triangles.
    pub doubled: PliantList,
}

/// `pliant_containment`: components inside bodies.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantContainment {
    /// Body, component, and the body that it lies inside.
    pub all: PliantList,
    /// Bodies that are not closed.
    pub open: PliantList,
}

impl Columns {
    /// Takes answers, and shows them.
    fn told(&mut self, all: &[Located]) -> PliantLocated {
        self.sides.clear();
        self.windings.clear();
        self.sides.extend(all.iter().map(|it| match it.side {
            Side::Outside => 0,
            Side::On => 1,
            Side::Inside => 2,
        }));
        self.windings.extend(all.iter().map(|it| it.winding));
        PliantLocated {
            count: all.len(),
            sides: start(&self.sides),
            windings: start(&self.windings),
        }
    }
}

/// The rule by its number.
fn rule_of(rule: u8) -> Result<InsideRule, Refused> {
    match rule {
        0 => Ok(InsideRule::NonZero),
        1 => Ok(InsideRule::Positive),
        2 => Ok(InsideRule::Parity),
        other => Err(Refused::new(
            BAD_OPTION,
            format_args!("rule is {other}; give one of PLIANT_NON_ZERO to _PARITY"),
        )),
    }
}

calls! {
    fn pliant_world_watertight(body: u32, edges: *mut PliantWatertight) |inside| {
        let found = with_world!(&inside.world, world => world.watertight(BodyId(body))?);
        let kept = &mut inside.views.of::<Kept>().edges;
        *kept = found;
        let view = PliantWatertight {
            open: PliantList::of(&kept.open),
            turned: PliantList::of(&kept.turned),
            doubled: PliantList::of(&kept.doubled),
        };
        // SAFETY: as the header says.
        unsafe { give(edges, view) };
        Ok(())
    }

    fn pliant_world_points_inside(
        at: PliantPoints,
        body: u32,
        rule: u8,
        query: *const PliantQuery,
        located: *mut PliantLocated,
    ) |inside| {
        let rule = rule_of(rule)?;
        // SAFETY: as the header says.
        let until = unsafe { PliantQuery::interrupt_alone(query)? };
        let found = with_world!(&mut inside.world, world => {
            with_points(world, &at, &until, |it, at| it.points_inside(at, BodyId(body), rule))?
        });
        let view = inside.views.of::<Kept>().points.told(&found);
        // SAFETY: as the header says.
        unsafe { give(located, view) };
        Ok(())
    }

    fn pliant_world_inside(
        a: u32,
        b: u32,
        rule: u8,
        query: *const PliantQuery,
        located: *mut PliantLocated,
    ) |inside| {
        let rule = rule_of(rule)?;
        // SAFETY: as the header says.
        let until = unsafe { PliantQuery::interrupt_alone(query)? };
        let found = with_world!(&mut inside.world, world => {
            world.interruptible(&|| until.ends()).inside(BodyId(a), BodyId(b), rule)?
        });
        let view = inside.views.of::<Kept>().vertices.told(&found);
        // SAFETY: as the header says.
        unsafe { give(located, view) };
        Ok(())
    }

    fn pliant_world_contained(
        query: *const PliantQuery,
        contained: *mut PliantContainment,
    ) |inside| {
        // SAFETY: as the header says.
        let (of, until) = unsafe { PliantQuery::of_one_answer(query)? };
        let found = with_world!(&mut inside.world, world => {
            world.interruptible(&|| until.ends()).contained(of)?
        });
        let kept = inside.views.of::<Kept>();
        let row = |it: &pliant::Contained| [it.body.0, it.component, it.inside.0];
        kept.contained = found.all.iter().map(row).collect();
        kept.open = found.open.iter().map(|it| it.0).collect();
        let view = PliantContainment {
            all: PliantList::of(&kept.contained),
            open: PliantList::of(&kept.open),
        };
        // SAFETY: as the header says.
        unsafe { give(contained, view) };
        Ok(())
    }
}

/// Asks a world of a precision about points of the caller.
pub(crate) fn with_points<S: Number, A>(
    world: &mut World<S>,
    at: &PliantPoints,
    until: &Interrupt,
    ask: impl FnOnce(Interruptible<'_, S>, &[[S; 3]]) -> Result<A, Error>,
) -> Result<A, Refused> {
    // SAFETY: as the header says of the caller's points.
    let at = unsafe { points::<S>(at, "points")? };
    Ok(ask(world.interruptible(&|| until.ends()), &at)?)
}
