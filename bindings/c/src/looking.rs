//! A world as it is: bodies, meshes, shapes, settings, trees, counters.

use crate::arrays::{PliantList, give, start, write};
use crate::options::PliantOptions;
use crate::points::Number;
use crate::status::{INVALID, Refused};
use crate::world::{AnyWorld, calls, with_world};
use pliant::{BodyId, NodeBox, Statistics, World};
use std::ptr::{null, null_mut};

/// Lists that the caller reads, one for each function.
#[derive(Default)]
pub(crate) struct Lists {
    numbers: [Vec<u32>; 12],
    corners: Vec<[[f64; 3]; 2]>,
    valid: Vec<u8>,
}

/// `pliant_tree_shape`: depth and counts of a body's tree.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantTreeShape {
    /// Level of the deepest leaf.
    pub depth: u32,
    /// Number of nodes.
    pub nodes: usize,
    /// Number of leaves.
    pub leaves: usize,
}

/// `pliant_boxes`: boxes of a level of a tree.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantBoxes {
    /// Number of boxes.
    pub count: usize,
    /// Lower and upper corners.
    pub corners: *const f64,
    /// Whether the tree holds each.
    pub valid: *const u8,
}

/// `pliant_statistics`: work of the last question.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[expect(missing_docs, reason = "the fields of `pliant::Statistics`")]
pub struct PliantStatistics {
    pub body_pairs: u64,
    pub boxes_bottom_up: u64,
    pub boxes_top_down: u64,
    pub triangle_boxes: u64,
    pub node_pairs: u64,
    pub candidate_pairs: u64,
    pub scalar_decisions: u64,
    pub exact_decisions: u64,
    pub pairs: u64,
}

impl From<&Statistics> for PliantStatistics {
    fn from(of: &Statistics) -> Self {
        Self {
            body_pairs: of.body_pairs,
            boxes_bottom_up: of.boxes_bottom_up,
            boxes_top_down: of.boxes_top_down,
            triangle_boxes: of.triangle_boxes,
            node_pairs: of.node_pairs,
            candidate_pairs: of.candidate_pairs,
            scalar_decisions: of.scalar_decisions,
            exact_decisions: of.exact_decisions,
            pairs: of.pairs,
        }
    }
}

/// Functions that give a list of a body: by its place among the lists, and how the world is asked.
macro_rules! lists {
    (
        $($place:literal, $name:ident($($argument:ident: $type:ty),*), |$world:ident| $list:expr;)*
    ) => {
        calls! { $(
            fn $name($($argument: $type,)* out: *mut PliantList) |inside| {
                let kept = &mut inside.views.of::<Lists>().numbers[$place];
                kept.clear();
                let rows = with_world!(&inside.world, $world => {
                    let rows = $list;
                    let count = rows.len();
                    kept.extend(rows.flatten());
                    count
                });
                let mut list = PliantList::of(kept);
                list.count = rows;
                // SAFETY: as the header says.
                unsafe { give(out, list) };
                Ok(())
            }
        )* }
    };
}

/// Rows of one number each.
fn single<T: Into<u32>>(
    numbers: impl IntoIterator<Item = T, IntoIter: ExactSizeIterator>,
) -> impl ExactSizeIterator<Item = [u32; 1]> {
    numbers.into_iter().map(|it| [it.into()])
}

lists! {
    0, pliant_world_bodies(), |world| single(world.bodies().map(|it| it.0));
    1, pliant_world_triangles(body: u32), |world| world.triangles(BodyId(body))?.iter().copied();
    2, pliant_world_edges(body: u32), |world| world.edges(BodyId(body))?.iter().copied();
    3, pliant_world_vertex_order(body: u32),
        |world| single(world.vertex_order(BodyId(body))?.iter().copied());
    4, pliant_world_components(body: u32), |world| single(world.components(BodyId(body))?);
    5, pliant_world_vertex_groups(body: u32), |world| single(world.vertex_groups(BodyId(body))?);
    6, pliant_world_ignored(),
        |world| world.ignored().into_iter().map(|pair| pair.map(|it| it.0));
    7, pliant_world_tree_cut(body: u32, level: u32),
        |world| single(world.tree_cut(BodyId(body), level)?);
    8, pliant_world_live_triangles(body: u32), |world| single(world.live_triangles(BodyId(body))?);
    9, pliant_world_live_vertices(body: u32), |world| single(world.live_vertices(BodyId(body))?);
}

calls! {
    fn pliant_world_labels(
        body: u32,
        of_triangles: *mut PliantList,
        neighbours: *mut PliantList,
    ) |inside| {
        let lists = &mut inside.views.of::<Lists>().numbers;
        let (mut all, mut pairs) = (PliantList::default(), PliantList::default());
        with_world!(&inside.world, world => if let Some(labels) = world.labels(BodyId(body))? {
            labels.of_triangles.clone_into(&mut lists[10]);
            all = PliantList::of(&lists[10]);
            if let Some(of) = labels.neighbours {
                of.as_flattened().clone_into(&mut lists[11]);
                pairs = PliantList { count: of.len(), numbers: lists[11].as_ptr() };
            }
        });
        // SAFETY: as the header says.
        unsafe {
            give(of_triangles, all);
            give(neighbours, pairs);
        }
        Ok(())
    }

    fn pliant_world_positions(body: u32, out: *mut f64, count: usize) |inside| {
        let rows = with_world!(&inside.world, world => wide(world.positions(BodyId(body))?));
        // SAFETY: as the header says.
        unsafe { write(&rows, (out, count, "out"), body) }
    }

    fn pliant_world_end_positions(
        body: u32,
        out: *mut f64,
        count: usize,
        moves: *mut u8,
    ) |inside| {
        let end = with_world!(&inside.world, world => world.end_positions(BodyId(body))?.map(wide));
        // SAFETY: as the header says.
        unsafe {
            give(moves, u8::from(end.is_some()));
            end.map_or(Ok(()), |rows| write(&rows, (out, count, "out"), body))
        }
    }

    fn pliant_world_rest_positions(
        body: u32,
        out: *mut f64,
        count: usize,
        rests: *mut u8,
    ) |inside| {
        let rest = with_world!(&inside.world, world => {
            world.rest_positions(BodyId(body))?.map(|rows| wide(rows.to_vec()))
        });
        // SAFETY: as the header says.
        unsafe {
            give(rests, u8::from(rest.is_some()));
            rest.map_or(Ok(()), |rows| write(&rows, (out, count, "out"), body))
        }
    }

    fn pliant_world_thickness(body: u32, out: *mut f64, count: usize) |inside| {
        let all = with_world!(&inside.world, world => world.thickness(BodyId(body))?);
        // SAFETY: as the header says.
        unsafe { write(&all, (out, count, "out"), body) }
    }

    fn pliant_world_counts(body: u32, triangles: *mut usize, vertices: *mut usize) |inside| {
        let (all, of) = with_world!(&inside.world, world => {
            let body = BodyId(body);
            (world.triangle_count(body)?, world.vertex_count(body)?)
        });
        // SAFETY: as the header says.
        unsafe {
            give(triangles, all);
            give(vertices, of);
        }
        Ok(())
    }

    fn pliant_world_filter(body: u32, membership: *mut u32, mask: *mut u32) |inside| {
        let filter = with_world!(&inside.world, world => world.filter(BodyId(body))?);
        // SAFETY: as the header says.
        unsafe {
            give(membership, filter.0);
            give(mask, filter.1);
        }
        Ok(())
    }

    fn pliant_world_environment(body: u32, environment: *mut u32) |inside| {
        let of = with_world!(&inside.world, world => world.environment(BodyId(body))?);
        // SAFETY: as the header says.
        unsafe { give(environment, of) };
        Ok(())
    }

    fn pliant_world_mesh_revision(body: u32, revision: *mut u64) |inside| {
        let of = with_world!(&inside.world, world => world.mesh_revision(BodyId(body))?);
        // SAFETY: as the header says.
        unsafe { give(revision, of) };
        Ok(())
    }

    fn pliant_world_loose_box(body: u32, corners: *mut f64, has: *mut u8) |inside| {
        let loose = with_world!(&inside.world, world => {
            world.loose_box(BodyId(body))?.map(|(lower, upper)| wide(vec![lower, upper]))
        });
        // SAFETY: as the header says.
        unsafe {
            give(has, u8::from(loose.is_some()));
            if let Some(loose) = loose {
                give(corners.cast::<[[f64; 3]; 2]>(), [loose[0], loose[1]]);
            }
        }
        Ok(())
    }

    fn pliant_world_tree_quality(body: u32, quality: *mut f64) |inside| {
        let of = with_world!(&inside.world, world => world.tree_quality(BodyId(body))?);
        // SAFETY: as the header says.
        unsafe { give(quality, of) };
        Ok(())
    }

    fn pliant_world_tree_shape(body: u32, shape: *mut PliantTreeShape) |inside| {
        let of = with_world!(&inside.world, world => world.tree_shape(BodyId(body))?);
        let of = PliantTreeShape { depth: of.depth, nodes: of.nodes, leaves: of.leaves };
        // SAFETY: as the header says.
        unsafe { give(shape, of) };
        Ok(())
    }

    fn pliant_world_tree_boxes(body: u32, level: u32, boxes: *mut PliantBoxes) |inside| {
        let kept = inside.views.of::<Lists>();
        kept.corners.clear();
        kept.valid.clear();
        match &inside.world {
            AnyWorld::F32(world) => kept.take(&boxes_of(world, body, level)?),
            AnyWorld::F64(world) => kept.take(&boxes_of(world, body, level)?),
        }
        let corners = start(&kept.corners);
        let view = PliantBoxes { count: kept.valid.len(), corners, valid: start(&kept.valid) };
        // SAFETY: as the header says.
        unsafe { give(boxes, view) };
        Ok(())
    }

    fn pliant_world_options(options: *mut PliantOptions) |inside| {
        // Whether these are still there only the caller knows.
        let own = PliantOptions {
            pool: null(),
            parallel_for: None,
            parallel_user: null_mut(),
            ..inside.options
        };
        // SAFETY: as the header says.
        unsafe { give(options, own) };
        Ok(())
    }

    fn pliant_world_statistics(statistics: *mut PliantStatistics) |inside| {
        let of = with_world!(&inside.world, world => world.statistics().into());
        // SAFETY: as the header says.
        unsafe { give(statistics, of) };
        Ok(())
    }

    fn pliant_world_memory_usage(bytes: *mut usize) |inside| {
        let of = with_world!(&inside.world, world => world.memory_usage());
        // SAFETY: as the header says.
        unsafe { give(bytes, of) };
        Ok(())
    }

    fn pliant_world_validate() |inside| {
        let valid = with_world!(&inside.world, world => world.validate());
        valid.map_err(|why| Refused::new(INVALID, why))
    }
}

/// Positions in double precision.
fn wide<S: Number>(rows: Vec<[S; 3]>) -> Vec<[f64; 3]> {
    rows.into_iter().map(|row| row.map(S::to_f64)).collect()
}

fn boxes_of<S: Number>(
    world: &World<S>,
    body: u32,
    level: u32,
) -> Result<Vec<NodeBox<S>>, Refused> {
    Ok(world.tree_boxes(BodyId(body), level)?)
}

impl Lists {
    fn take<S: Number>(&mut self, boxes: &[NodeBox<S>]) {
        let corners = |it: &NodeBox<S>| [it.lower.map(S::to_f64), it.upper.map(S::to_f64)];
        self.corners.extend(boxes.iter().map(corners));
        self.valid.extend(boxes.iter().map(|it| u8::from(it.valid)));
    }
}
