//! Triangles with corners in common, on a lattice, by the points where they may meet.
//!
//! Two triangles have the hull of some points in common. These are corners, points where two edges
//! meet, or points where an edge goes through the other's plane. All are computed as fractions. The
//! ones that both triangles hold span it.

/// A point as a fraction: three numerators, and one positive denominator.
pub(super) type Fraction = ([i128; 3], i128);

pub(super) type Corners = [[i128; 3]; 3];

pub(super) fn minus(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

pub(super) fn dot(a: [i128; 3], b: [i128; 3]) -> i128 {
    (0..3).map(|axis| a[axis] * b[axis]).sum()
}

pub(super) fn cross(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

/// Whether a closed segment holds a point.
pub(super) fn segment_holds([p, q]: [[i128; 3]; 2], (x, d): Fraction) -> bool {
    let scaled = |corner: [i128; 3]| corner.map(|value| value * d);
    let (p, q) = (scaled(p), scaled(q));
    let along = minus(q, p);
    let from = minus(x, p);
    if p == q {
        return from == [0; 3];
    }
    cross(along, from) == [0; 3] && (0..=dot(along, along)).contains(&dot(along, from))
}

/// Whether a closed triangle, or the segment or point that it is, holds a point.
pub(super) fn holds([a, b, c]: Corners, (x, d): Fraction) -> bool {
    let normal = cross(minus(b, a), minus(c, a));
    if normal == [0; 3] {
        return [[a, b], [b, c], [c, a]]
            .into_iter()
            .any(|edge| segment_holds(edge, (x, d)));
    }
    let scaled = |corner: [i128; 3]| corner.map(|value| value * d);
    if dot(normal, minus(x, scaled(a))) != 0 {
        return false;
    }
    [[a, b], [b, c], [c, a]].into_iter().all(|[p, q]| {
        let inward = cross(normal, minus(q, p));
        dot(inward, minus(x, scaled(p))) >= 0
    })
}

/// Where an edge meets a plane that it does not lie in: a fraction on its line.
fn on_plane([p, q]: [[i128; 3]; 2], normal: [i128; 3], origin: [i128; 3]) -> Option<Fraction> {
    let (from, to) = (dot(normal, minus(p, origin)), dot(normal, minus(q, origin)));
    let d = from - to;
    if d == 0 {
        return None;
    }
    let x = std::array::from_fn(|axis| (p[axis] * d + from * (q[axis] - p[axis])) * d.signum());
    Some((x, d.abs()))
}

/// Points of a pair of triangles that may be corners of what they have in common.
pub(super) fn candidates(a: Corners, b: Corners) -> Vec<Fraction> {
    let edges = |[p, q, r]: Corners| [[p, q], [q, r], [r, p]];
    let mut all: Vec<Fraction> = a.iter().chain(&b).map(|&corner| (corner, 1)).collect();
    for (one, other) in [(a, b), (b, a)] {
        let normal = cross(minus(other[1], other[0]), minus(other[2], other[0]));
        for edge in edges(one) {
            all.extend(on_plane(edge, normal, other[0]));
            for [r, s] in edges(other) {
                // A plane through the other edge that does not hold this one.
                let along = cross(minus(edge[1], edge[0]), minus(s, r));
                let upright = cross(along, minus(s, r));
                all.extend(on_plane(edge, upright, r));
            }
        }
    }
    all
}

/// How two triangles meet beyond the hull of their corners of equal numbers: 0 touching, 1
/// overlapping, 2 crossing; none if they do not. Coordinates are below 2^5 in magnitude.
///
/// They cross if they still meet so after every small move. With two corners in common they never
/// do.
pub fn adjacent_contact(numbers: [[u32; 3]; 2], corners: [[[i64; 3]; 3]; 2]) -> Option<u8> {
    let [a, b] = corners.map(|triangle| triangle.map(|corner| corner.map(i128::from)));
    let mut common: Vec<u32> = numbers[0].to_vec();
    common.retain(|number| numbers[1].contains(number));
    common.sort_unstable();
    common.dedup();
    if common.len() == 3 {
        return Some(1);
    }
    let place = |number: u32| a[numbers[0].iter().position(|&it| it == number).unwrap_or(0)];
    let is_in_hull = |point: Fraction| match common[..] {
        [] => false,
        [p] => segment_holds([place(p); 2], point),
        [p, q] => segment_holds([place(p), place(q)], point),
        _ => true,
    };
    let mut both = candidates(a, b);
    both.retain(|&point| holds(a, point) && holds(b, point));
    if both.iter().all(|&point| is_in_hull(point)) {
        return None;
    }
    if spans_area(&both) {
        return Some(1);
    }
    let is_crossing = match common[..] {
        [] => strictly_cross(a, b, false),
        [_] => strictly_cross(a, b, true),
        _ => false,
    };
    Some(if is_crossing { 2 } else { 0 })
}

fn spans_area(points: &[Fraction]) -> bool {
    let Some(&(p, d)) = points.first() else {
        return false;
    };
    let ways: Vec<[i128; 3]> = points
        .iter()
        .map(|&(x, e)| std::array::from_fn(|axis| x[axis] * d - p[axis] * e))
        .collect();
    let mut pairs = ways
        .iter()
        .flat_map(|&a| ways.iter().map(move |&b| cross(a, b)));
    pairs.any(|normal| normal != [0; 3])
}

/// Whether triangles that meet beyond a corner in common, or at all, still do after every small
/// move. A segment through the inside of a triangle does, if no corner is in common.
fn strictly_cross(a: Corners, b: Corners, has_corner: bool) -> bool {
    let normals = [a, b].map(|[p, q, r]| cross(minus(q, p), minus(r, p)));
    let sides = |of: Corners, normal: [i128; 3], origin: [i128; 3]| {
        of.map(|point| dot(normal, minus(point, origin)).signum())
    };
    let are_both = |sides: [i128; 3]| sides.contains(&1) && sides.contains(&-1);
    let (of_b, of_a) = (sides(b, normals[0], a[0]), sides(a, normals[1], b[0]));
    if normals.iter().all(|&normal| normal != [0; 3]) {
        let along = cross(normals[0], normals[1]);
        if !are_both(of_a) || !are_both(of_b) {
            return false;
        }
        // Open intervals on the line of both planes. With a corner in common both begin or end
        // there, so that they overlap wherever they are more than that corner.
        let interval = |corners: Corners, plane: usize, origin: [i128; 3]| {
            let [p, q, r] = corners;
            let sides = sides(corners, normals[plane], origin);
            let mut ends: Vec<(i128, i128)> = Vec::new();
            for (edge, [from, to]) in [([p, q], [0, 1]), ([q, r], [1, 2]), ([r, p], [2, 0])] {
                if sides[from] * sides[to] <= 0
                    && let Some((x, d)) = on_plane(edge, normals[plane], origin)
                {
                    ends.push((dot(along, x), d));
                }
            }
            ends
        };
        let (ends_a, ends_b) = (interval(a, 1, b[0]), interval(b, 0, a[0]));
        let less = |a: &(i128, i128), b: &(i128, i128)| (a.0 * b.1).cmp(&(b.0 * a.1));
        let range = |ends: &[(i128, i128)]| {
            let low = ends.iter().copied().min_by(less);
            low.zip(ends.iter().copied().max_by(less))
        };
        let (Some((low_a, high_a)), Some((low_b, high_b))) = (range(&ends_a), range(&ends_b))
        else {
            return false;
        };
        return less(&low_a, &high_b).is_lt() && less(&low_b, &high_a).is_lt();
    }
    if has_corner {
        return false;
    }
    // A segment through the inside of a triangle.
    for (triangle, normal, segment, of_segment) in
        [(a, normals[0], b, of_b), (b, normals[1], a, of_a)]
    {
        if normal != [0; 3] && are_both(of_segment) {
            let low = segment[of_segment.iter().position(|&side| side < 0).unwrap_or(0)];
            let high = segment[of_segment.iter().position(|&side| side > 0).unwrap_or(0)];
            let Some((x, d)) = on_plane([low, high], normal, triangle[0]) else {
                return false;
            };
            let [p, q, r] = triangle;
            return [[p, q], [q, r], [r, p]].into_iter().all(|[p, q]| {
                let inward = cross(normal, minus(q, p));
                dot(inward, minus(x, p.map(|value| value * d))) > 0
            });
        }
    }
    false
}
