//! Distances of elements in plain `f64`, with which a truth measures; nothing of ours.
//!
//! Regions of a triangle and clamped feet of two segments, as in Ericson (2005, *Real-Time
//! Collision Detection*, 5.1).

type Point = [f64; 3];

fn minus(a: Point, b: Point) -> Point {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The point a + s (b - a).
fn along(a: Point, b: Point, s: f64) -> Point {
    std::array::from_fn(|axis| a[axis] + s * (b[axis] - a[axis]))
}

fn apart(p: Point, q: Point) -> f64 {
    dot(minus(p, q), minus(p, q)).sqrt()
}

/// Distance of a point from a triangle.
pub(super) fn of_point_and_triangle(p: Point, [a, b, c]: [Point; 3]) -> f64 {
    let (ab, ac, ap) = (minus(b, a), minus(c, a), minus(p, a));
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return apart(p, a);
    }
    let bp = minus(p, b);
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= 0.0 && d4 <= d3 {
        return apart(p, b);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return apart(p, along(a, b, d1 / (d1 - d3)));
    }
    let cp = minus(p, c);
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= 0.0 && d5 <= d6 {
        return apart(p, c);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return apart(p, along(a, c, d2 / (d2 - d6)));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return apart(p, along(b, c, (d4 - d3) / ((d4 - d3) + (d5 - d6))));
    }
    let whole = va + vb + vc;
    let (v, w) = (vb / whole, vc / whole);
    apart(
        p,
        std::array::from_fn(|axis| a[axis] + ab[axis] * v + ac[axis] * w),
    )
}

/// Distance of two segments.
pub(super) fn of_segments([p1, q1]: [Point; 2], [p2, q2]: [Point; 2]) -> f64 {
    let (d1, d2, r) = (minus(q1, p1), minus(q2, p2), minus(p1, p2));
    let (a, e, f) = (dot(d1, d1), dot(d2, d2), dot(d2, r));
    let part = |over: f64, under: f64| {
        if under > 0.0 {
            (over / under).clamp(0.0, 1.0)
        } else {
            0.0
        }
    };
    let (b, c) = (dot(d1, d2), dot(d1, r));
    let mut s = part(b * f - c * e, a * e - b * b);
    let t = if e > 0.0 { (b * s + f) / e } else { 0.0 };
    let clamped = t.clamp(0.0, 1.0);
    if clamped != t || e == 0.0 {
        s = part(b * clamped - c, a);
    }
    apart(along(p1, q1, s), along(p2, q2, clamped))
}

/// Distance of two triangles that do not intersect: the nearest of six corners and nine edges.
pub(super) fn of_triangles(a: [Point; 3], b: [Point; 3]) -> f64 {
    let mut least = f64::INFINITY;
    for i in 0..3 {
        least = least.min(of_point_and_triangle(a[i], b));
        least = least.min(of_point_and_triangle(b[i], a));
        for j in 0..3 {
            let edges = [[a[i], a[(i + 1) % 3]], [b[j], b[(j + 1) % 3]]];
            least = least.min(of_segments(edges[0], edges[1]));
        }
    }
    least
}
