//! Square sheet: `side` by `side` squares, each cut into two triangles.

use super::{MAX_TRIANGLES, Nearest, Surface};

/// Possible numbers of triangles: two in each of `side²` squares.
fn sheet_sizes() -> impl Iterator<Item = usize> + Clone {
    (1..)
        .map(|side: usize| 2 * side * side)
        .take_while(|size| *size <= MAX_TRIANGLES)
}

/// The unit square of z = 0 with `triangles` triangles.
///
/// Vertices go row by row: vertex `row · (side + 1) + column` is at (column / side, row / side).
/// The diagonals alternate like the squares of a chessboard, so that no direction is favoured.
pub(crate) fn sheet(triangles: usize) -> Result<Surface, Nearest> {
    let side = (triangles / 2).isqrt();
    if triangles == 0 || triangles != 2 * side * side || triangles > MAX_TRIANGLES {
        return Err(Nearest::among(sheet_sizes(), triangles));
    }
    let along = |i: usize| i as f64 / side as f64;
    let rest = (0..=side)
        .flat_map(|row| (0..=side).map(move |column| [along(column), along(row), 0.0]))
        .collect();
    let mut faces = Vec::with_capacity(triangles);
    for row in 0..side {
        for column in 0..side {
            let corner =
                |up: usize, right: usize| ((row + up) * (side + 1) + column + right) as u32;
            let [a, b, c, d] = [corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)];
            if (row + column) % 2 == 0 {
                faces.extend([[a, b, c], [a, c, d]]);
            } else {
                faces.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    Ok(Surface {
        rest,
        triangles: faces,
    })
}

#[cfg(test)]
mod tests {
    use super::{Nearest, sheet};

    #[test]
    fn covers_the_square_once() {
        let surface = sheet(2 * 7 * 7).unwrap();
        assert_eq!(surface.rest.len(), 64);
        let area: f64 = surface
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| surface.rest[v as usize]);
                let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
                assert!(twice > 0.0, "turned the wrong way");
                twice / 2.0
            })
            .sum();
        assert!((area - 1.0).abs() < 1e-12);
    }

    #[test]
    fn names_the_nearest_sizes() {
        assert_eq!(sheet(79_202).unwrap().rest.len(), 200 * 200);
        let nearest = |below, above| Nearest { below, above };
        assert_eq!(sheet(0).unwrap_err(), nearest(None, Some(2)));
        assert_eq!(sheet(2).unwrap().triangles.len(), 2);
        assert_eq!(sheet(3).unwrap_err(), nearest(Some(2), Some(8)));
        assert!(sheet(80_000).is_ok());
        assert_eq!(
            sheet(79_203).unwrap_err(),
            nearest(Some(79_202), Some(80_000))
        );
        assert_eq!(
            sheet(usize::MAX).unwrap_err(),
            nearest(Some(2 * 3238 * 3238), None)
        );
    }
}
