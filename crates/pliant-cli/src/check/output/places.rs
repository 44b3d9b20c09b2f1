//! Places of pairs in words, one line each, for the table and for annotations.

use crate::check::figures::counted;
use crate::table::short;
use pliant_check::{Check, Life, Place};
use pliant_io::shown;

/// Most bodies of a place that are named.
const MOST_NAMED: usize = 3;

/// Frames and pairs of a place. The text depends on what there is to say:
///
/// - `place 3: frames 12 to 40, 118 pairs at most, in frame 20`;
/// - for a place in one frame `place 3: 118 pairs in frame 20`;
/// - for a check of one frame `place 3: 118 pairs`.
pub(super) fn lived(check: &Check, life: &Life) -> String {
    let Life {
        first_frame,
        last_frame,
        worst_frame,
        worst,
    } = life;
    let number = worst.number;
    let pairs = counted((worst.count, "pair", "pairs"));
    if first_frame < last_frame {
        format!(
            "place {number}: frames {first_frame} to {last_frame}, \
             {pairs} at most, in frame {worst_frame}"
        )
    } else if check.frame_count() > 1 {
        format!("place {number}: {pairs} in frame {worst_frame}")
    } else {
        format!("place {number}: {pairs}")
    }
}

/// Size, centre and triangles of a place.
pub(super) fn lies(check: &Check, place: &Place) -> String {
    let [x, y, z] = place.centre().map(short);
    let size = short(place.size());
    let name = |body| check.body(body).map_or_else(String::new, |body| body.name);
    let named = place.bodies.iter().take(MOST_NAMED).map(|it| {
        let triangles = counted((it.triangles, "triangle", "triangles"));
        let of = match check.body_count() {
            1 => String::new(),
            _ => format!(" of {}", shown(name(it.body))),
        };
        format!("{triangles}{of} from {} on", it.first_triangle)
    });
    let named: Vec<String> = named.collect();
    let more = match place.bodies.len().saturating_sub(MOST_NAMED) {
        0 => String::new(),
        more => format!(" and of {}", counted((more, "more body", "more bodies"))),
    };
    let depth = match place.depth {
        Some(depth) if depth > 0.0 => format!(", {} deep", short(depth)),
        _ => String::new(),
    };
    format!(
        "{size} across{depth}, round ({x}, {y}, {z}); {}{more}",
        named.join(", ")
    )
}
