//! Worlds: bodies, their shapes, motions and filters. One call at a time is inside.

use crate::faces::PliantFaces;
use crate::hits::Columns;
use crate::points::{F32, F64, Number, PliantPoints, PliantScalar, positions};
use crate::status::{
    BAD_OPTION, BAD_SCALAR, BUSY, NULL, PANIC, PliantError, PliantStatus, Refused, WRONG_LENGTH,
    call, countable,
};
use pliant::{BodyId, BroadPhase, Degree, Labels, Options, Partition, Selection, Update, World};
use std::cell::UnsafeCell;
use std::num::{NonZeroU32, NonZeroUsize};
use std::sync::atomic::{AtomicU8, Ordering};

/// `pliant_options`: how a world works; no option changes an answer.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantOptions {
    /// Precision of positions.
    pub scalar: PliantScalar,
    /// Threads that share the work, at most.
    pub threads: u32,
    /// Most children of a node: 2, 4 or 8.
    pub degree: u32,
    /// How triangles are divided.
    pub partition: u32,
    /// Most triangles in a leaf.
    pub leaf_size: u32,
    /// When boxes are made.
    pub update: u32,
    /// How pairs of bodies are found.
    pub broad_phase: u32,
    /// Whether trees mend themselves: 0 or 1.
    pub mending: u8,
}

/// A world of either precision.
#[derive(Clone)]
pub(crate) enum AnyWorld {
    F32(World<f32>),
    F64(World<f64>),
}

/// Evaluates an expression with the [`World`] of an [`AnyWorld`], for either precision.
macro_rules! with_world {
    ($any:expr, $world:ident => $work:expr) => {
        match $any {
            $crate::world::AnyWorld::F32($world) => $work,
            $crate::world::AnyWorld::F64($world) => $work,
        }
    };
}
pub(crate) use with_world;

/// Kinds of questions that have a list each.
pub(crate) const QUESTIONS: usize = 11;

/// The world and its answers, which a call that is inside may change.
pub(crate) struct Inside {
    pub(crate) world: AnyWorld,
    /// The last list of each question.
    pub(crate) lists: [Columns; QUESTIONS],
    /// Hits that a visitor is shown.
    pub(crate) shown: Columns,
    /// The last list of edges.
    edges: Vec<[u32; 2]>,
}

/// `pliant_world`.
pub struct PliantWorld {
    /// [`FREE`], or why no call may begin.
    state: AtomicU8,
    inside: UnsafeCell<Inside>,
}

/// State of a world: no call is inside.
const FREE: u8 = 0;
/// State of a world: a call is inside.
const TAKEN: u8 = 1;
/// State of a world: a call ended in a panic.
const BROKEN: u8 = 2;

impl PliantWorld {
    fn new(world: AnyWorld) -> *mut Self {
        Box::into_raw(Box::new(Self {
            state: AtomicU8::new(FREE),
            inside: UnsafeCell::new(Inside {
                world,
                lists: Default::default(),
                shown: Columns::default(),
                edges: Vec::new(),
            }),
        }))
    }
}

/// A call that is inside a world. A panic leaves the world broken.
struct Taken<'w> {
    world: &'w PliantWorld,
    leaves: u8,
}

impl Drop for Taken<'_> {
    fn drop(&mut self) {
        self.world.state.store(self.leaves, Ordering::Release);
    }
}

/// Runs a call with what is inside a world, unless it is NULL, another call is inside, or one broke
/// it.
///
/// # Safety
///
/// `world` is NULL, or a world that was made and not freed. `error` is NULL, or may be written.
pub(crate) unsafe fn inside(
    world: *const PliantWorld,
    error: *mut PliantError,
    work: impl FnOnce(&mut Inside) -> Result<(), Refused>,
) -> PliantStatus {
    let work = || {
        // SAFETY: as above; a world is only ever shared.
        let Some(world) = (unsafe { world.as_ref() }) else {
            return Err(Refused::new(
                NULL,
                "world is NULL; give one of pliant_world_new",
            ));
        };
        let (free, taken) = (Ordering::Relaxed, Ordering::Acquire);
        if let Err(state) = world.state.compare_exchange(FREE, TAKEN, taken, free) {
            return Err(if state == BROKEN {
                let words = "the world is broken by an earlier fault; free it, and make another";
                Refused::new(PANIC, words)
            } else {
                let words = "another call is inside this world; wait for it, and call none of one";
                Refused::new(BUSY, words)
            });
        }
        let leaves = BROKEN;
        let mut taken = Taken { world, leaves };
        // SAFETY: no other call is inside, so this is the only reference.
        let done = work(unsafe { &mut *world.inside.get() });
        taken.leaves = FREE;
        done
    };
    // SAFETY: as above.
    unsafe { call(error, work) }
}

/// `pliant_options_default`.
///
/// # Safety
///
/// `options` is NULL, or may be written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_options_default(options: *mut PliantOptions) {
    let defaults = PliantOptions {
        scalar: F64,
        threads: 1,
        degree: 8,
        partition: 2,
        leaf_size: 8,
        update: 2,
        broad_phase: 0,
        mending: 0,
    };
    if !options.is_null() {
        // SAFETY: it is not NULL, so it may be written.
        unsafe { options.write_unaligned(defaults) };
    }
}

impl PliantOptions {
    fn checked(&self) -> Result<Options, Refused> {
        let bad = |name: &str, value: u32, are: &str| {
            Refused::new(
                BAD_OPTION,
                format_args!("options.{name} is {value}; give {are}"),
            )
        };
        let mut options = Options::default();
        let many = "at least 1";
        options.threads = NonZeroUsize::new(self.threads as usize)
            .ok_or_else(|| bad("threads", self.threads, many))?;
        options.leaf_size = NonZeroU32::new(self.leaf_size)
            .ok_or_else(|| bad("leaf_size", self.leaf_size, many))?;
        options.degree = match self.degree {
            2 => Degree::Two,
            4 => Degree::Four,
            8 => Degree::Eight,
            other => return Err(bad("degree", other, "2, 4 or 8")),
        };
        options.partition = match self.partition {
            0 => Partition::Centre,
            1 => Partition::Mean,
            2 => Partition::Balanced,
            3 => Partition::Connectivity,
            other => {
                return Err(bad(
                    "partition",
                    other,
                    "one of PLIANT_CENTRE to _CONNECTIVITY",
                ));
            }
        };
        options.update = match self.update {
            0 => Update::BottomUp,
            1 => Update::TopDown,
            2 => Update::HYBRID,
            other => return Err(bad("update", other, "one of PLIANT_BOTTOM_UP to _HYBRID")),
        };
        options.broad_phase = match self.broad_phase {
            0 => BroadPhase::Auto,
            1 => BroadPhase::BruteForce,
            2 => BroadPhase::SweepAndPrune,
            3 => BroadPhase::Tree,
            other => return Err(bad("broad_phase", other, "one of PLIANT_AUTO to _TREE")),
        };
        options.mending = match self.mending {
            0 => false,
            1 => true,
            other => return Err(bad("mending", other.into(), "0 or 1")),
        };
        Ok(options)
    }
}

/// `pliant_world_new`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_new(
    options: *const PliantOptions,
    world: *mut *mut PliantWorld,
    error: *mut PliantError,
) -> PliantStatus {
    let work = || {
        if world.is_null() {
            return Err(Refused::null("world"));
        }
        // SAFETY: as the header says.
        let (scalar, options) = match unsafe { options.as_ref() } {
            None => (F64, Options::default()),
            Some(options) => (options.scalar, options.checked()?),
        };
        let made = match scalar {
            F32 => AnyWorld::F32(World::with_options(options)),
            F64 => AnyWorld::F64(World::with_options(options)),
            other => {
                return Err(Refused::new(
                    BAD_SCALAR,
                    format_args!("options.scalar is {other}; give PLIANT_F32 or PLIANT_F64"),
                ));
            }
        };
        // SAFETY: it is not NULL, so it may be written.
        unsafe { world.write(PliantWorld::new(made)) };
        Ok(())
    };
    // SAFETY: as the header says.
    unsafe { call(error, work) }
}

/// `pliant_world_clone`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_clone(
    world: *const PliantWorld,
    copy: *mut *mut PliantWorld,
    error: *mut PliantError,
) -> PliantStatus {
    let work = |inside: &mut Inside| {
        if copy.is_null() {
            return Err(Refused::null("copy"));
        }
        // SAFETY: it is not NULL, so it may be written.
        unsafe { copy.write(PliantWorld::new(inside.world.clone())) };
        Ok(())
    };
    // SAFETY: as the header says.
    unsafe { inside(world, error, work) }
}

/// `pliant_world_free`.
///
/// # Safety
///
/// The world is NULL, or was made, is not freed, and no call is inside.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_free(world: *mut PliantWorld) {
    if !world.is_null() {
        // SAFETY: it was made by a box, and nothing else refers to it.
        drop(unsafe { Box::from_raw(world) });
    }
}

/// Writes a result, unless the pointer is NULL.
///
/// # Safety
///
/// `out` is NULL, or may be written.
pub(crate) unsafe fn give<T>(out: *mut T, value: T) {
    if !out.is_null() {
        // SAFETY: it is not NULL, so it may be written.
        unsafe { out.write_unaligned(value) };
    }
}

/// Adds a body to a world of a precision.
fn add<S: Number>(
    world: &mut World<S>,
    faces: &[[u32; 3]],
    points: &PliantPoints,
) -> Result<BodyId, Refused> {
    // SAFETY: as the header says of the caller's points.
    let positions = unsafe { positions::<S>(points)? };
    Ok(world.add(faces, &positions)?)
}

/// `pliant_world_add`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_add(
    world: *mut PliantWorld,
    faces: PliantFaces,
    points: PliantPoints,
    body: *mut u32,
    error: *mut PliantError,
) -> PliantStatus {
    let work = |inside: &mut Inside| {
        // SAFETY: as the header says.
        let faces = unsafe { faces.copied()? };
        let added = with_world!(&mut inside.world, world => add(world, &faces, &points)?);
        // SAFETY: as the header says.
        unsafe { give(body, added.0) };
        Ok(())
    };
    // SAFETY: as the header says.
    unsafe { inside(world, error, work) }
}

/// Functions that hand numbers to a method of worlds.
macro_rules! calls {
    ($($name:ident($($number:ident: $type:ty),+), |$world:ident| $call:expr;)*) => {
        $(
            #[doc = concat!("`", stringify!($name), "`.")]
            ///
            /// # Safety
            ///
            /// Pointers are NULL, or as the header says.
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name(
                world: *mut PliantWorld,
                $($number: $type,)+
                error: *mut PliantError,
            ) -> PliantStatus {
                let work = |inside: &mut Inside| {
                    with_world!(&mut inside.world, $world => $call.map_err(Refused::from))
                };
                // SAFETY: as the header says.
                unsafe { inside(world, error, work) }
            }
        )*
    };
}

calls! {
    pliant_world_remove(body: u32), |world| world.remove(BodyId(body));
    pliant_world_advance_motion(t: f64), |world| world.advance_motion(t);
    pliant_world_set_filter(body: u32, membership: u32, mask: u32),
        |world| world.set_filter(BodyId(body), membership, mask);
    pliant_world_set_environment(body: u32, environment: u32),
        |world| world.set_environment(BodyId(body), environment);
    pliant_world_ignore(a: u32, b: u32), |world| world.ignore(BodyId(a), BodyId(b));
}

/// A call of a world that takes a shape.
#[derive(Clone, Copy)]
enum Takes {
    Positions,
    Motion,
    Rest,
}

/// Gives a body of a world of a precision a shape.
fn take<S: Number>(
    world: &mut World<S>,
    (body, what): (BodyId, Takes),
    points: &PliantPoints,
) -> Result<(), Refused> {
    // SAFETY: as the header says of the caller's points.
    let shape = unsafe { positions::<S>(points) };
    let shape = shape.map_err(|mut refused| {
        refused.0.body = body.0;
        refused
    })?;
    match what {
        Takes::Positions => world.set_positions(body, &shape)?,
        Takes::Motion => world.set_motion(body, &shape)?,
        Takes::Rest => world.set_rest_positions(body, Some(&shape))?,
    }
    Ok(())
}

/// `pliant_world_set_positions`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_set_positions(
    world: *mut PliantWorld,
    body: u32,
    points: PliantPoints,
    error: *mut PliantError,
) -> PliantStatus {
    let how = (BodyId(body), Takes::Positions);
    let work =
        |inside: &mut Inside| with_world!(&mut inside.world, world => take(world, how, &points));
    // SAFETY: as the header says.
    unsafe { inside(world, error, work) }
}

/// `pliant_world_set_motion`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_set_motion(
    world: *mut PliantWorld,
    body: u32,
    end: PliantPoints,
    error: *mut PliantError,
) -> PliantStatus {
    let how = (BodyId(body), Takes::Motion);
    let work =
        |inside: &mut Inside| with_world!(&mut inside.world, world => take(world, how, &end));
    // SAFETY: as the header says.
    unsafe { inside(world, error, work) }
}

/// `pliant_world_set_rest_positions`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_set_rest_positions(
    world: *mut PliantWorld,
    body: u32,
    points: *const PliantPoints,
    error: *mut PliantError,
) -> PliantStatus {
    let body = BodyId(body);
    let work = |inside: &mut Inside| {
        // SAFETY: as the header says.
        let points = unsafe { points.as_ref() };
        with_world!(&mut inside.world, world => match points {
            Some(points) => take(world, (body, Takes::Rest), points),
            None => Ok(world.set_rest_positions(body, None)?),
        })
    };
    // SAFETY: as the header says.
    unsafe { inside(world, error, work) }
}

/// `pliant_world_positions`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_positions(
    world: *const PliantWorld,
    body: u32,
    out: *mut f64,
    count: usize,
    error: *mut PliantError,
) -> PliantStatus {
    let work = |inside: &mut Inside| {
        let all: Vec<[f64; 3]> = match &inside.world {
            AnyWorld::F32(world) => {
                let all = world.positions(BodyId(body))?.into_iter();
                all.map(|position| position.map(f64::from)).collect()
            }
            AnyWorld::F64(world) => world.positions(BodyId(body))?,
        };
        if count != all.len() {
            let vertices = all.len();
            let mut refused = Refused::new(
                WRONG_LENGTH,
                format_args!("out has {count} rows for {vertices} vertices; give as many"),
            );
            refused.0.body = body;
            (refused.0.count, refused.0.limit) = (count as u64, vertices as u64);
            return Err(refused);
        }
        if out.is_null() && count > 0 {
            return Err(Refused::null("out"));
        }
        for (row, position) in all.into_iter().enumerate() {
            // SAFETY: there is a row for each vertex.
            unsafe {
                out.wrapping_add(3 * row)
                    .cast::<[f64; 3]>()
                    .write_unaligned(position);
            };
        }
        Ok(())
    };
    // SAFETY: as the header says.
    unsafe { inside(world, error, work) }
}

/// `pliant_world_counts`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_counts(
    world: *const PliantWorld,
    body: u32,
    triangles: *mut usize,
    vertices: *mut usize,
    error: *mut PliantError,
) -> PliantStatus {
    let work = |inside: &mut Inside| {
        let counts = with_world!(&inside.world, world => {
            let body = BodyId(body);
            [world.triangle_count(body)?, world.vertex_count(body)?]
        });
        // SAFETY: as the header says.
        unsafe {
            give(triangles, counts[0]);
            give(vertices, counts[1]);
        }
        Ok(())
    };
    // SAFETY: as the header says.
    unsafe { inside(world, error, work) }
}

/// `pliant_world_set_vertex_groups`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_set_vertex_groups(
    world: *mut PliantWorld,
    body: u32,
    groups: *const u32,
    count: usize,
    error: *mut PliantError,
) -> PliantStatus {
    let work = |inside: &mut Inside| {
        // SAFETY: as the header says.
        let groups = unsafe { list(groups, count, "groups")? };
        let body = BodyId(body);
        with_world!(&mut inside.world, world => {
            world.set_vertex_groups(body, &groups).map_err(Refused::from)
        })
    };
    // SAFETY: as the header says.
    unsafe { inside(world, error, work) }
}

/// `pliant_world_set_vertex_thickness`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_set_vertex_thickness(
    world: *mut PliantWorld,
    body: u32,
    thickness: *const f64,
    count: usize,
    error: *mut PliantError,
) -> PliantStatus {
    let work = |inside: &mut Inside| {
        // SAFETY: as the header says.
        let all = unsafe { list(thickness, count, "thickness")? };
        let body = BodyId(body);
        with_world!(&mut inside.world, world => {
            world.set_vertex_thickness(body, &all).map_err(Refused::from)
        })
    };
    // SAFETY: as the header says.
    unsafe { inside(world, error, work) }
}

/// `pliant_world_set_labels`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_set_labels(
    world: *mut PliantWorld,
    body: u32,
    labels: *const u32,
    count: usize,
    neighbours: *const u32,
    neighbour_count: usize,
    error: *mut PliantError,
) -> PliantStatus {
    let work = |inside: &mut Inside| {
        // SAFETY: as the header says.
        let (of_triangles, pairs) = unsafe {
            let pairs = neighbours.cast::<[u32; 2]>();
            let all = (!labels.is_null()).then(|| list(labels, count, "labels"));
            let pairs = (!neighbours.is_null()).then(|| list(pairs, neighbour_count, "neighbours"));
            (all.transpose()?, pairs.transpose()?)
        };
        let labels = of_triangles.as_deref().map(|of_triangles| Labels {
            of_triangles,
            neighbours: pairs.as_deref(),
        });
        let body = BodyId(body);
        with_world!(&mut inside.world, world => {
            world.set_labels(body, labels).map_err(Refused::from)
        })
    };
    // SAFETY: as the header says.
    unsafe { inside(world, error, work) }
}

/// `pliant_world_set_mesh`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_set_mesh(
    world: *mut PliantWorld,
    body: u32,
    faces: PliantFaces,
    points: PliantPoints,
    error: *mut PliantError,
) -> PliantStatus {
    let work = |inside: &mut Inside| {
        // SAFETY: as the header says.
        let faces = unsafe { faces.copied()? };
        with_world!(&mut inside.world, world => set_mesh(world, BodyId(body), &faces, &points))
    };
    // SAFETY: as the header says.
    unsafe { inside(world, error, work) }
}

/// Gives a body of a world of a precision another mesh.
fn set_mesh<S: Number>(
    world: &mut World<S>,
    body: BodyId,
    faces: &[[u32; 3]],
    points: &PliantPoints,
) -> Result<(), Refused> {
    // SAFETY: as the header says of the caller's points.
    let positions = unsafe { positions::<S>(points)? };
    Ok(world.set_mesh(body, faces, &positions)?)
}

/// `pliant_world_set_edges`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_set_edges(
    world: *mut PliantWorld,
    body: u32,
    edges: *const u32,
    count: usize,
    error: *mut PliantError,
) -> PliantStatus {
    let work = |inside: &mut Inside| {
        // SAFETY: as the header says.
        let edges = unsafe { list(edges.cast::<[u32; 2]>(), count, "edges")? };
        let body = BodyId(body);
        with_world!(&mut inside.world, world => {
            world.set_edges(body, &edges).map_err(Refused::from)
        })
    };
    // SAFETY: as the header says.
    unsafe { inside(world, error, work) }
}

/// `pliant_world_edges`.
///
/// # Safety
///
/// Pointers are NULL, or as the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pliant_world_edges(
    world: *const PliantWorld,
    body: u32,
    edges: *mut *const u32,
    count: *mut usize,
    error: *mut PliantError,
) -> PliantStatus {
    let work = |inside: &mut Inside| {
        let Inside {
            world, edges: kept, ..
        } = inside;
        kept.clear();
        kept.extend(with_world!(world, world => world.edges(BodyId(body))?));
        // SAFETY: as the header says.
        unsafe {
            give(edges, kept.as_ptr().cast());
            give(count, kept.len());
        }
        Ok(())
    };
    // SAFETY: as the header says.
    unsafe { inside(world, error, work) }
}

/// Copies a list of the caller's, by its name in the header.
///
/// # Safety
///
/// It is NULL, or may be read.
unsafe fn list<T: Copy>(data: *const T, count: usize, name: &str) -> Result<Vec<T>, Refused> {
    if data.is_null() && count > 0 {
        return Err(Refused::null(name));
    }
    countable(count, name)?;
    let at = |place| data.wrapping_add(place);
    // SAFETY: the caller says that these may be read.
    Ok((0..count)
        .map(|place| unsafe { at(place).read_unaligned() })
        .collect())
}

/// `pliant_selection`: whom a question is about.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantSelection {
    /// Which selection.
    pub kind: u32,
    /// The body, or the first of two.
    pub a: u32,
    /// The second of two.
    pub b: u32,
}

impl PliantSelection {
    pub(crate) fn checked(self) -> Result<Selection, Refused> {
        let (a, b) = (BodyId(self.a), BodyId(self.b));
        match self.kind {
            0 => Ok(Selection::Everything),
            1 => Ok(Selection::World),
            2 => Ok(Selection::Between(a, b)),
            3 => Ok(Selection::Within(a)),
            other => Err(Refused::new(
                BAD_OPTION,
                format_args!("of.kind is {other}; give one of PLIANT_EVERYTHING to _WITHIN"),
            )),
        }
    }
}
