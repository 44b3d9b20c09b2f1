//! Surfaces of long thin triangles, two units wide.

/// A mesh: triangles and positions.
type Mesh = (Vec<[u32; 3]>, Vec<[f32; 3]>);

fn on_circle(number: u32, count: u32) -> [f32; 2] {
    let angle = number as f32 / count as f32 * std::f32::consts::TAU;
    [angle.cos(), angle.sin()]
}

/// A disc of `count` corners as a fan from one of them.
pub(crate) fn fan(count: u32) -> Mesh {
    let positions = (0..count).map(|corner| {
        let [x, y] = on_circle(corner, count);
        [x, y, 0.0]
    });
    let triangles = (1..count - 1).map(|corner| [0, corner, corner + 1]);
    (triangles.collect(), positions.collect())
}

/// A square of `2 count` needles side by side.
pub(crate) fn strip(count: u32) -> Mesh {
    let row = |row: u32| {
        let y = row as f32 / count as f32 * 2.0 - 1.0;
        [[-1.0, y, 0.0], [1.0, y, 0.0]]
    };
    let triangles = (0..2 * count).map(|first| [first, first + 1, first + 2]);
    (triangles.collect(), (0..=count).flat_map(row).collect())
}

/// The side of a cylinder of `count` facets, each of two needles.
pub(crate) fn tube(count: u32) -> Mesh {
    let facet = |facet: u32| {
        let [x, y] = on_circle(facet, count).map(|x| x * 0.5);
        [[x, y, -1.0], [x, y, 1.0]]
    };
    let last = 2 * count;
    let triangles = (0..last).map(|first| [first, (first + 1) % last, (first + 2) % last]);
    (triangles.collect(), (0..count).flat_map(facet).collect())
}

/// Positions turned by an angle about one axis, by half of it about another.
pub(crate) fn turned(positions: &[[f32; 3]], angle: f32) -> Vec<[f32; 3]> {
    let ((sin, cos), (half_sin, half_cos)) = (angle.sin_cos(), (angle / 2.0).sin_cos());
    let turn = |&[x, y, z]: &[f32; 3]| {
        let [x, y] = [cos * x - sin * y, sin * x + cos * y];
        [x, half_cos * y - half_sin * z, half_sin * y + half_cos * z]
    };
    positions.iter().map(turn).collect()
}
