//! Figure 2 of the paper: in a binary tree of 31 nodes, only 11 boxes are updated.
//!
//! Levels 0 to 2 are made bottom-up, and of the rest only what is reached. "There are 31 nodes in
//! this small example tree, but only 11 of them are updated."

use crate::common::TrianglesOf;
use pliant::{Degree, Options, Selection, TreeShape, World};

#[test]
fn eleven_of_31_boxes() {
    let mut options = Options::paper();
    options.degree = Degree::Two;
    let mut world = World::<f32>::with_options(options);

    // Sixteen small triangles in a row: the box centre divides them evenly four times.
    let positions: Vec<[f32; 3]> = (0..16)
        .flat_map(|i| {
            [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.5, 0.0]]
                .map(|[x, y, z]| [x + i as f32, y, z])
        })
        .collect();
    let triangles: Vec<[u32; 3]> = (0..16).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let row = world.add(&triangles, &positions).unwrap();
    assert_eq!(
        world.tree_shape(row).unwrap(),
        TreeShape {
            depth: 4,
            nodes: 31,
            leaves: 16
        }
    );

    // A single triangle that crosses the sixth: it leads the traversal down one path.
    let needle = world
        .add(
            &[[0, 1, 2]],
            &[[5.1, 0.1, -1.0], [5.1, 0.1, 1.0], [5.2, 0.1, 1.0]],
        )
        .unwrap();
    assert_eq!(world.tree_shape(needle).unwrap().nodes, 1);

    assert_eq!(
        world.triangles_of(Selection::Between(row, needle)),
        [[5, 0]]
    );
    let statistics = *world.statistics();
    // n = 4, so levels 0, 1, 2 at once: 1 + 2 + 4 boxes; and the one box of the needle.
    assert_eq!(statistics.boxes_bottom_up, 7 + 1);
    // Then the two children of the node reached at level 2, and the two children of one of them.
    assert_eq!(statistics.boxes_top_down, 4);

    // A second query without movement makes nothing.
    world.triangles_of(Selection::Between(row, needle));
    assert_eq!(
        (
            world.statistics().boxes_bottom_up,
            world.statistics().boxes_top_down
        ),
        (0, 0)
    );
}
