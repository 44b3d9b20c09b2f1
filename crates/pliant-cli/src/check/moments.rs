//! The first contact on the way from a frame to the next: in words, and as a page shows it.

use pliant_check::{Check, FirstImpact, Interval};
use pliant_io::shown;
use pliant_report::Moment;

/// The two elements, in words; `name` says what a body is called, nothing where nobody needs to be told.
pub(super) fn elements(first: &FirstImpact, name: impl Fn(u32) -> String) -> [String; 2] {
    let of = |element: String, body: u32| match name(body) {
        name if name.is_empty() => element,
        name => format!("{element} of {name}"),
    };
    match first {
        FirstImpact::VertexTriangle(impact) => {
            let [body_a, vertex, body_b, triangle] = impact.pair;
            [
                of(format!("vertex {vertex}"), body_a),
                of(format!("triangle {triangle}"), body_b),
            ]
        }
        FirstImpact::EdgeEdge(impact) => {
            let [body_a, a, b, body_b, c, d] = impact.pair;
            [
                of(format!("edge {a} to {b}"), body_a),
                of(format!("edge {c} to {d}"), body_b),
            ]
        }
    }
}

/// The first contact of an interval, where there is one, of bodies that are the sources.
pub(super) fn moment(check: &Check, interval: &Interval) -> Option<Moment> {
    let first = interval.first.as_ref()?;
    let name = |body| {
        check
            .body(body)
            .map_or_else(String::new, |it| shown(it.name))
    };
    let of = |body| check.source_of(body).unwrap_or_default();
    let triangles = |source: usize| check.sources()[source].triangles();
    let [(source_a, one), (source_b, other)] = match *first {
        FirstImpact::VertexTriangle(ref impact) => {
            let [body_a, vertex, body_b, triangle] = impact.pair;
            let source_b = of(body_b);
            let corners = triangles(source_b)[triangle as usize];
            [(of(body_a), vec![vertex]), (source_b, corners.to_vec())]
        }
        FirstImpact::EdgeEdge(ref impact) => {
            let [body_a, a, b, body_b, c, d] = impact.pair;
            [(of(body_a), vec![a, b]), (of(body_b), vec![c, d])]
        }
    };
    // The triangles that have all corners of an element.
    let having = |source: usize, element: &[u32]| -> Vec<[u32; 2]> {
        let all = triangles(source).iter().zip(0..);
        let having = all.filter(|(corners, _)| element.iter().all(|it| corners.contains(it)));
        having
            .map(|(_, triangle)| [source as u32, triangle])
            .collect()
    };
    let (of_one, of_other) = (having(source_a, &one), having(source_b, &other));
    let pairs = of_one.iter().flat_map(|a| {
        let pairs = of_other.iter().map(move |b| (a.min(b), a.max(b)));
        pairs.map(|(&[body_a, a], &[body_b, b])| [body_a, a, body_b, b])
    });
    let corners = |source: usize, element: &[u32]| -> Vec<[u32; 2]> {
        element
            .iter()
            .map(|&vertex| [source as u32, vertex])
            .collect()
    };
    Some(Moment {
        until: u32::try_from(interval.until).unwrap_or(u32::MAX),
        time: first.time(),
        count: interval.count,
        corners: [corners(source_a, &one), corners(source_b, &other)],
        pairs: pairs.collect(),
        label: elements(first, name).join(", "),
    })
}
