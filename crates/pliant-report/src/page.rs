//! The HTML page: one file, which loads nothing from outside.
//!
//! Text from files and commands (names, paths) may be hostile. It goes into the page in two places
//! only: escaped in the title, and as JSON. In the JSON `<` is written `\u003c`, so that no text
//! can end the element it is in. The viewer shows text as text.

use crate::MARK;
use crate::chart::Chart;
use crate::colours::{BODIES, HIT, NEAR, of_line};
use crate::escape::escape;
use crate::frames::{Elements, Frame, Motion};
use crate::pack::{Normalisation, STEPS};
use crate::recorder::{BUDGET, MOST_LINES};
use crate::report::{Play, Report};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

const VIEWER: &str = include_str!("../assets/viewer.js");
const STYLE: &str = include_str!("../assets/viewer.css");

impl Report {
    /// Renders the report as one HTML file. Costs O(n) for n bytes of the page.
    pub fn page(&self) -> String {
        let facts = |facts: &[(String, String)]| json!(facts);
        let head = json!({
            "version": env!("CARGO_PKG_VERSION"),
            "asked": self.asked,
            "found": self.found,
            "facts": facts(&self.facts),
            "hit": hex(HIT),
            "near": hex(NEAR),
            "colours": BODIES.map(hex),
            "plays": self.plays.iter().map(|play| self.play(play)).collect::<Value>(),
            "motions": self.motions.iter().map(motion).collect::<Value>(),
        });
        let mut data = String::new();
        for motion in &self.motions {
            data.push_str("<script type=\"application/octet-stream\" class=\"motion\">");
            if !motion.too_large {
                STANDARD.encode_string(motion.pack(), &mut data);
            }
            data.push_str("</script>\n");
        }
        // The browser itself refuses to load anything from outside.
        format!(
            r#"<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="generator" content="{MARK}">
<meta http-equiv="Content-Security-Policy" content="{POLICY}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
<style>
{STYLE}</style>
</head>
<body>
<main id="page"><noscript>{NO_SCRIPT}</noscript></main>
<script type="application/json" id="report">{head}</script>
{data}<script>
{VIEWER}</script>
</body>
</html>
"#,
            title = escape(&self.asked),
            head = head.to_string().replace('<', "\\u003c"),
        )
    }

    fn play(&self, play: &Play) -> Value {
        let motion = play.motion.and_then(|place| self.motions.get(place));
        let mut notes = play.notes.clone();
        notes.extend(motion.and_then(|motion| thinned(motion, &play.along)));
        notes.extend(motion.and_then(|motion| without_lines(motion, &play.along)));
        json!({
            "name": play.name,
            "along": play.along,
            "within": play.within,
            "facts": play.facts,
            "notes": notes,
            "motion": play.motion,
            "charts": play.charts.iter().map(chart).collect::<Value>(),
        })
    }
}

/// Content security policy of the page: nothing from outside.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; \
    style-src 'unsafe-inline'; img-src data: blob:";
const NO_SCRIPT: &str = "This report needs JavaScript, which your browser does not run.";

/// Note about frames in which the viewer draws no curves; `None` if there is none.
fn without_lines(motion: &Motion, along: &str) -> Option<String> {
    let has_more = motion.frames.iter().any(|frame| {
        let pairs = motion.pairs[frame.index];
        frame.moment.is_none() && pairs > MOST_LINES as u64
    });
    has_more.then(|| {
        format!("In {along}s of more than {MOST_LINES} pairs no lines are drawn where these meet.")
    })
}

/// Note about frames that the viewer does not show; `None` if it shows all.
fn thinned(motion: &Motion, along: &str) -> Option<String> {
    let (shown, all) = (motion.shown().count(), motion.numbers.len());
    if motion.too_large {
        let [_, _, triangles] = motion.sizes;
        Some(format!(
            "The bodies have {triangles} triangles, too many to be drawn in a page; \
             all figures are complete."
        ))
    } else if shown < all {
        let last = motion.numbers.last().copied();
        let those = [
            (motion.first_contact(), "the first contact".to_owned()),
            (
                motion.worst().map(|(worst, _)| worst),
                format!("the {along} with the most pairs"),
            ),
            (last, "the last".to_owned()),
        ];
        // Excludes frames whose mesh was too large to be drawn.
        let there = those
            .into_iter()
            .filter_map(|(number, what)| motion.shows(number?).then_some(what));
        let there = match &there.collect::<Vec<_>>()[..] {
            [] => String::new(),
            [one] => format!("; {one} is among them"),
            [some @ .., last] => format!("; {} and {last} are among them", some.join(", ")),
        };
        Some(format!(
            "The picture shows {shown} of {all} {along}s, since a page has room for {} MiB of \
             them{there}. All figures are of all {along}s.",
            BUDGET >> 20
        ))
    } else {
        None
    }
}

fn motion(motion: &Motion) -> Value {
    let normalisation = motion.normalisation();
    let bodies = motion.bodies.iter().enumerate().map(|(number, body)| {
        json!({
            "name": body.label.name,
            "number": body.number,
            "parts": body.label.parts.as_ref().map(|parts| &parts.names),
            "vertices": body.vertices,
            "triangles": body.triangles.len(),
            "levels": body.starts.iter().map(Vec::len).collect::<Value>(),
            "faces": body.label.faces.is_some(),
            "step": motion.side(number) / STEPS / normalisation.radius,
        })
    });
    json!({
        "numbers": motion.numbers,
        "pairs": motion.pairs,
        "places": motion.frames.iter().map(|frame| spots(frame, normalisation)).collect::<Value>(),
        "depths": motion.depths,
        "placeCounts": motion.frames.iter().map(|frame| frame.all_spots).collect::<Value>(),
        "frames": motion.frames.iter().map(|frame| frame.index).collect::<Value>(),
        "moments": motion.frames.iter().map(moment).collect::<Value>(),
        "bodies": bodies.collect::<Value>(),
    })
}

/// JSON of the impacts between two frames: the time of each, and the numbers of its elements.
fn moment(frame: &Frame) -> Value {
    let Some(moment) = &frame.moment else {
        return Value::Null;
    };
    let contacts = moment.contacts.iter().map(|contact| {
        let numbers = match &contact.elements {
            Elements::VertexTriangle(numbers) => &numbers[..],
            Elements::EdgeEdge(numbers) => &numbers[..],
        };
        let numbers = numbers.iter().map(|&number| json!(number));
        std::iter::once(json!(contact.time))
            .chain(numbers)
            .collect()
    });
    json!({
        "until": moment.until,
        "count": moment.count,
        "contacts": contacts.collect::<Vec<Value>>(),
    })
}

/// JSON of a frame's places, in the page's coordinates: number, pairs, lower and upper corner,
/// label, depth.
fn spots(frame: &Frame, normalisation: Normalisation) -> Value {
    let inside = |corner: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|axis| {
            (corner[axis] - normalisation.centre[axis]) / normalisation.radius
        })
    };
    let spots = frame.spots.iter();
    let spots = spots.map(|it| {
        json!([
            it.number,
            it.count,
            inside(it.lower),
            inside(it.upper),
            it.label,
            it.depth
        ])
    });
    spots.collect()
}

fn chart(chart: &Chart) -> Value {
    let lines = chart.series.iter().enumerate().map(|(number, series)| {
        let (colour, dashes) = of_line(number);
        json!({ "name": series.name, "colour": colour, "dash": dashes, "values": series.values })
    });
    json!({
        "title": chart.title,
        "unit": chart.unit,
        "along": chart.along,
        "logarithmic": chart.is_logarithmic(),
        "ceiling": chart.ceiling(),
        "x": chart.x,
        "lines": lines.collect::<Value>(),
        "svg": chart.svg(),
    })
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}
