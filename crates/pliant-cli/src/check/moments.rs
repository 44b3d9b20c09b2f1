//! Contacts between two frames: the first in words, and all for a page.

use pliant_check::{FirstImpact, Impact, Interval};
use pliant_report::{Contact, Elements, Moment};

/// The first two elements in contact, in words. `name` returns a body's name; an empty one is left
/// out.
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

/// All contacts of an interval, the first contact before the others. `None` if there are none.
pub(super) fn moment(interval: &Interval) -> Option<Moment> {
    let first = match interval.first? {
        FirstImpact::VertexTriangle(impact) => of_vertex(&impact),
        FirstImpact::EdgeEdge(impact) => of_edges(&impact),
    };
    let vertices = interval.vertex_triangle.iter().map(of_vertex);
    let edges = interval.edge_edge.iter().map(of_edges);
    let mut contacts: Vec<Contact> = vertices.chain(edges).collect();
    // Of equally early contacts the first is known. The others keep their order.
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
