//! Bodies: shapes, meshes, motions, and who meets whom.

use crate::arrays::{give, list, read, row};
use crate::faces::PliantFaces;
use crate::points::{Number, PliantPoints, exactly, positions};
use crate::status::Refused;
use crate::world::{AnyWorld, calls, with_world};
use pliant::{BodyId, Labels, World};

/// Functions that hand numbers to a method of worlds.
macro_rules! plain {
    ($($name:ident($($number:ident: $type:ty),*), |$world:ident| $call:expr;)*) => {
        calls! { $(
            fn $name($($number: $type),*) |inside| {
                with_world!(&mut inside.world, $world => $call?);
                Ok(())
            }
        )* }
    };
}

plain! {
    pliant_world_remove(body: u32), |world| world.remove(BodyId(body));
    pliant_world_rebuild(body: u32), |world| world.rebuild(BodyId(body));
    pliant_world_advance_motion(t: f64), |world| world.advance_motion(t);
    pliant_world_set_filter(body: u32, membership: u32, mask: u32),
        |world| world.set_filter(BodyId(body), membership, mask);
    pliant_world_set_environment(body: u32, environment: u32),
        |world| world.set_environment(BodyId(body), environment);
    pliant_world_ignore(a: u32, b: u32), |world| world.ignore(BodyId(a), BodyId(b));
    pliant_world_unignore(a: u32, b: u32), |world| world.unignore(BodyId(a), BodyId(b));
    pliant_world_set_thickness(body: u32, thickness: f64),
        |world| world.set_thickness(BodyId(body), thickness);
}

calls! {
    fn pliant_world_add(faces: PliantFaces, points: PliantPoints, body: *mut u32) |inside| {
        // SAFETY: as the header says.
        let faces = unsafe { faces.copied()? };
        let added = with_world!(&mut inside.world, world => add(world, &faces, &points)?);
        // SAFETY: as the header says.
        unsafe { give(body, added.0) };
        Ok(())
    }

    fn pliant_world_set_mesh(body: u32, faces: PliantFaces, points: PliantPoints) |inside| {
        // SAFETY: as the header says.
        let faces = unsafe { faces.copied()? };
        with_world!(&mut inside.world, world => set_mesh(world, BodyId(body), &faces, &points))
    }

    fn pliant_world_set_positions(body: u32, points: PliantPoints) |inside| {
        with_world!(&mut inside.world, world => take(world, body, Takes::Positions, &points))
    }

    fn pliant_world_set_positions_of(
        bodies: *const u32,
        points: *const PliantPoints,
        count: usize,
    ) |inside| {
        // SAFETY: as the header says.
        let (bodies, points) = unsafe {
            (list(bodies, count, "bodies")?, list(points, count, "positions")?)
        };
        with_world!(&mut inside.world, world => take_all(world, &bodies, &points))
    }

    fn pliant_world_set_motion(body: u32, end: PliantPoints) |inside| {
        with_world!(&mut inside.world, world => take(world, body, Takes::Motion, &end))
    }

    fn pliant_world_finish_motion() |inside| {
        with_world!(&mut inside.world, world => world.finish_motion());
        Ok(())
    }

    fn pliant_world_set_rest_positions(body: u32, points: *const PliantPoints) |inside| {
        // SAFETY: as the header says.
        let points = unsafe { read(points) };
        with_world!(&mut inside.world, world => match &points {
            Some(points) => take(world, body, Takes::Rest, points),
            None => Ok(world.set_rest_positions(BodyId(body), None)?),
        })
    }

    fn pliant_world_set_edges(body: u32, edges: *const u32, count: usize) |inside| {
        // SAFETY: as the header says.
        let edges = unsafe { list(edges.cast::<[u32; 2]>(), count, "edges")? };
        with_world!(&mut inside.world, world => world.set_edges(BodyId(body), &edges)?);
        Ok(())
    }

    fn pliant_world_set_vertex_groups(body: u32, groups: *const u32, count: usize) |inside| {
        // SAFETY: as the header says.
        let groups = unsafe { list(groups, count, "groups")? };
        with_world!(&mut inside.world, world => world.set_vertex_groups(BodyId(body), &groups)?);
        Ok(())
    }

    fn pliant_world_set_vertex_thickness(
        body: u32,
        thickness: *const f64,
        count: usize,
    ) |inside| {
        // SAFETY: as the header says.
        let all = unsafe { list(thickness, count, "thickness")? };
        with_world!(&mut inside.world, world => world.set_vertex_thickness(BodyId(body), &all)?);
        Ok(())
    }

    fn pliant_world_set_labels(
        body: u32,
        labels: *const u32,
        count: usize,
        neighbours: *const u32,
        neighbour_count: usize,
    ) |inside| {
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
        with_world!(&mut inside.world, world => world.set_labels(BodyId(body), labels)?);
        Ok(())
    }

    fn pliant_world_set_loose_box(body: u32, corners: *const f64) |inside| {
        let corners = if corners.is_null() {
            None
        } else {
            // SAFETY: as the header says.
            Some(unsafe { row(corners.cast::<[[f64; 3]; 2]>(), "corners")? })
        };
        match &mut inside.world {
            AnyWorld::F32(world) => loosen(world, body, corners),
            AnyWorld::F64(world) => loosen(world, body, corners),
        }
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
    body: u32,
    what: Takes,
    points: &PliantPoints,
) -> Result<(), Refused> {
    // SAFETY: as the header says of the caller's points.
    let shape = unsafe { positions::<S>(points) };
    let shape = shape.map_err(|refused| refused.of(body))?;
    let body = BodyId(body);
    match what {
        Takes::Positions => world.set_positions(body, &shape)?,
        Takes::Motion => world.set_motion(body, &shape)?,
        Takes::Rest => world.set_rest_positions(body, Some(&shape))?,
    }
    Ok(())
}

/// Gives several bodies of a world of a precision shapes.
fn take_all<S: Number>(
    world: &mut World<S>,
    bodies: &[u32],
    points: &[PliantPoints],
) -> Result<(), Refused> {
    let mut shapes = Vec::with_capacity(points.len());
    for (&body, points) in bodies.iter().zip(points) {
        // SAFETY: as the header says of the caller's points.
        let shape = unsafe { positions::<S>(points) };
        shapes.push((BodyId(body), shape.map_err(|refused| refused.of(body))?));
    }
    let shapes = shapes.iter().map(|(body, shape)| (*body, &shape[..]));
    Ok(world.set_positions_of(&shapes.collect::<Vec<_>>())?)
}

/// Gives a body of a world of a precision a loose box, or takes it away.
fn loosen<S: Number>(
    world: &mut World<S>,
    body: u32,
    corners: Option<[[f64; 3]; 2]>,
) -> Result<(), Refused> {
    let corners = match corners {
        None => None,
        Some([lower, upper]) => Some((
            exactly(lower).map_err(|refused| refused.of(body))?,
            exactly(upper).map_err(|refused| refused.of(body))?,
        )),
    };
    Ok(world.set_loose_box(BodyId(body), corners)?)
}
