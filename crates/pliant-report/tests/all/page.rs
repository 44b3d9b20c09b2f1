//! The page: one file, harmless names, and as much as it can hold.

use pliant::World;
use pliant_report::{BodyLabel, Chart, Motion, Play, Recorder, Report, Series};

const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [2, 1, 3]];

fn square(z: f32) -> [[f32; 3]; 4] {
    [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z], [1.0, 1.0, z]]
}

/// Records one frame for each count, with made-up pairs.
fn record(mut recorder: Recorder, counts: &[usize]) -> Motion {
    let mut world = World::<f32>::new();
    let bodies = [0.0, 1.0].map(|z| world.add(&TRIANGLES, &square(z)).unwrap());
    for (number, &count) in counts.iter().enumerate() {
        world
            .set_positions(bodies[1], &square(number as f32))
            .unwrap();
        recorder.frame(10 * number as u32, &world, &vec![[0, 0, 1, 1]; count]);
    }
    recorder.finish()
}

fn page_of(label: &str, chart: &str) -> String {
    let labels = vec![BodyLabel {
        name: label.to_owned(),
        ..BodyLabel::default()
    }];
    let motion = record(Recorder::new(labels), &[0, 1]);
    let mut report = Report::new(&format!("pliant check '{label}'"));
    label.clone_into(&mut report.found);
    report.facts.push((label.to_owned(), label.to_owned()));
    let mut play = Play::new(label, "frame");
    play.notes.push(label.to_owned());
    play.charts.push(Chart {
        title: chart.to_owned(),
        unit: chart.to_owned(),
        along: chart.to_owned(),
        x: vec![0, 1],
        series: vec![Series {
            name: chart.to_owned(),
            values: vec![0.0, f64::NAN],
        }],
    });
    report.add(play, motion);
    report.page()
}

/// The JSON of the page, which the viewer reads.
fn head_of(page: &str) -> serde_json::Value {
    let start = page.find(r#"id="report">"#).unwrap() + r#"id="report">"#.len();
    let end = start + page[start..].find("</script").unwrap();
    serde_json::from_str(&page[start..end]).unwrap()
}

#[test]
fn no_name_changes_the_page_round_it() {
    let plain = page_of("name", "name");
    for hostile in [
        "</script><script>alert(1)</script>",
        "<!--<script>",
        "</title><img src=x onerror=alert(1)>",
        "\" onload=\"x\u{0}\u{1b}[31m\u{2028}",
    ] {
        let page = page_of(hostile, hostile);
        for element in ["<script", "</script", "<!--", "<img", "<title", "</title"] {
            assert_eq!(
                page.matches(element).count(),
                plain.matches(element).count(),
                "{element} of {hostile:?}"
            );
        }
        let head = head_of(&page);
        assert_eq!(head["motions"][0]["bodies"][0]["name"], hostile);
        assert_eq!(head["plays"][0]["charts"][0]["lines"][0]["name"], hostile);
        assert_eq!(head["found"], hostile);
    }
}

#[test]
fn nothing_is_asked_for_from_outside() {
    let page = page_of("name", "name");
    assert!(page.contains("default-src 'none'"));
    for outside in ["src=", "href=", "@import", "url(", "import("] {
        let markup = page.split("<script>").next().unwrap();
        assert!(!markup.contains(outside), "{outside}");
    }
    for licence in [
        "three.js authors",
        "Leon Sorokin",
        "Permission is hereby granted",
    ] {
        assert!(page.contains(licence), "{licence}");
    }
}

#[test]
fn facts_of_a_motion() {
    let motion = record(Recorder::new(Vec::new()), &[0, 0, 3, 1, 3, 0]);
    assert_eq!(motion.first_contact(), Some(20));
    assert_eq!(motion.worst(), Some((20, 3)));
    assert_eq!(motion.frames_with_hits(), 3);
    assert_eq!(motion.sizes(), [2, 8, 4]);
    assert_eq!(motion.pairs(), [0, 0, 3, 1, 3, 0]);
    assert!(motion.shown().eq([0, 10, 20, 30, 40, 50]));
    let nothing = record(Recorder::new(Vec::new()), &[0, 0]);
    assert_eq!((nothing.first_contact(), nothing.worst()), (None, None));
    let empty = record(Recorder::new(Vec::new()), &[]);
    assert_eq!((empty.worst(), empty.sizes()), (None, [0; 3]));
    let mut report = Report::new("nothing");
    report.add(Play::new("nothing", "frame"), empty);
    assert_eq!(
        head_of(&report.page())["motions"][0]["frames"],
        serde_json::json!([])
    );
}

#[test]
fn a_page_without_a_picture_has_its_figures() {
    let mut report = Report::new("figures");
    report.plays.push(Play::new("alone", "step"));
    let head = head_of(&report.page());
    assert_eq!(head["plays"][0]["motion"], serde_json::Value::Null);
}
