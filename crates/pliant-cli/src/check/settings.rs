//! Settings of a check, as the arguments of the program say them.

use super::arguments::{Arguments, Format, Split};
use pliant::Options;
use pliant_check::Settings;
use pliant_io::OpenOptions;

/// How files are read, and what is asked about them.
pub(super) fn settings(arguments: &Arguments) -> (OpenOptions, Settings) {
    let max_memory = arguments.many.per_frame(arguments.max_memory);
    let reading = OpenOptions {
        weld: !arguments.no_weld,
        weld_tolerance: arguments.weld,
        max_memory,
        clip: arguments.clip.clone(),
        fps: arguments.fps,
        ..OpenOptions::default()
    };
    let mut options = Options::default();
    options.threads = arguments.threads;
    let settings = Settings {
        itself: arguments.itself,
        within: arguments.within,
        rest: arguments.rest.clone(),
        labels: arguments.labels.clone(),
        crossing: arguments.crossing,
        ignore_adjacent: arguments.ignore_adjacent,
        crossing_edges: !arguments.quiet && arguments.format == Format::Json,
        swept: arguments.swept,
        inside: arguments.solid || !arguments.quiet,
        solid: arguments.solid,
        closest_points: arguments.pictures.any(),
        max_list: max_memory,
        split: arguments.split.map(|split| match split {
            Split::Components => pliant_check::Split::Components,
            Split::Groups => pliant_check::Split::Groups,
        }),
        groups: arguments.groups.clone(),
        ignore: arguments.ignore.clone(),
        baseline: arguments.baseline.clone(),
        skip_degenerate: arguments.skip_degenerate,
        places: finds_places(arguments),
        frames: Some(arguments.frames.to_check()),
        options,
        ..Settings::default()
    };
    (reading, settings)
}

/// Whether any output shows places.
fn finds_places(arguments: &Arguments) -> bool {
    let printed = !arguments.quiet && !arguments.count && arguments.format != Format::Lines;
    printed || arguments.pictures.any()
}
