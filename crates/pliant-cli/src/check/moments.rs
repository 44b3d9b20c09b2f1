//! What meets on the way from a frame to the next: the first in words, and all as a page shows it.

use pliant_check::{FirstImpact, Impact, Interval};
use pliant_report::{Contact, Elements, Moment};

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

/// What meets in an interval, the first to meet before all others; none where nothing does.
pub(super) fn moment(interval: &Interval) -> Option<Moment> {
    let first = match interval.first? {
        FirstImpact::VertexTriangle(impact) => of_vertex(&impact),
        FirstImpact::EdgeEdge(impact) => of_edges(&impact),
    };
    let vertices = interval.vertex_triangle.iter().map(of_vertex);
    let edges = interval.edge_edge.iter().map(of_edges);
    let mut contacts: Vec<Contact> = vertices.chain(edges).collect();
    // Of equally early ones it is known which is the first, and the others stay in order.
    contacts.sort_by(|a, b| {
        let is_later = |it: &Contact| *it != first;
        (is_later(a).cmp(&is_later(b))).then(a.time.total_cmp(&b.time))
    });
    Some(Moment {
        until: u32::try_from(interval.until).unwrap_or(u32::MAX),
        count: interval.complete.then_some(interval.count),
        contacts,
    })
}

fn of_vertex(impact: &Impact<4>) -> Contact {
    Contact {
        time: impact.high,
        elements: Elements::VertexTriangle(impact.pair),
    }
}

fn of_edges(impact: &Impact<6>) -> Contact {
    Contact {
        time: impact.high,
        elements: Elements::EdgeEdge(impact.pair),
    }
}
