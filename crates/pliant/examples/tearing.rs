//! Tearing: a cloth is torn from one side to the other, and falls into two bodies.
//!
//! `cargo run -p pliant --example tearing`

use pliant::{Selection, World};

/// Vertices along each side.
const SIDE: u32 = 9;
/// The row of vertices along which it tears.
const TEAR: u32 = SIDE / 2;

fn main() -> Result<(), pliant::Error> {
    let vertex = |row: u32, column: u32| SIDE * row + column;
    let squares = (0..SIDE - 1).flat_map(|row| (0..SIDE - 1).map(move |column| [row, column]));
    let triangles: Vec<[u32; 3]> = squares
        .flat_map(|[row, column]| {
            let [a, b] = [vertex(row, column), vertex(row + 1, column)];
            [[a, b, b + 1], [a, b + 1, a + 1]]
        })
        .collect();
    let count = SIDE * SIDE;
    let mut positions: Vec<[f32; 3]> = (0..count)
        .map(|v| [(v / SIDE) as f32, (v % SIDE) as f32, 0.0])
        .collect();
    let mut world = World::new();
    let cloth = world.add(&triangles, &positions)?;

    for column in 0..SIDE {
        // One edit a step: the triangles on one side get a vertex of their own.
        let tip = vertex(TEAR, column);
        let is_beyond = |&v: &u32| v < count && v / SIDE > TEAR;
        let beyond: Vec<u32> = (0..)
            .zip(world.triangles(cloth)?)
            .filter(|(_, corners)| corners.contains(&tip) && corners.iter().any(is_beyond))
            .map(|(triangle, _)| triangle)
            .collect();
        let mut edit = world.edit(cloth)?;
        let new = edit.split_vertex(tip, &beyond);
        world.apply(&edit)?;

        // The solver moves what there is now; here both sides only part.
        positions.push(positions[tip as usize]);
        for v in (vertex(TEAR + 1, 0)..count).chain([new]) {
            positions[v as usize][0] += 0.01;
        }
        world.set_positions(cloth, &positions)?;
        let is_clean = world
            .intersections(Selection::Within(cloth))
            .first()?
            .is_none();
        println!("torn at column {column}; it meets itself: {}", !is_clean);
    }

    for piece in world.split(cloth)? {
        let triangles = world.triangle_count(piece.body)?;
        println!("a piece of {triangles} triangles is a body of its own now");
    }
    Ok(())
}
