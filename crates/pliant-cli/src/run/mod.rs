//! `pliant run`: plays a built-in scene, times every step, and reports.

mod query;
mod record;
mod scene;

use crate::outcome::Outcome;
use crate::report::{PictureOptions, Watcher};
use crate::terminal::{print_all, progress};
use crate::tree_options::{TreeOptions, value_name};
use anyhow::{Context, bail};
use clap::{Args, ValueEnum};
use indicatif::ProgressStyle;
use pliant::{Scalar, Selection, World};
use pliant_scenes::Scene;
use query::Query;
use record::{Record, StepRecord};
use scene::AnyScene;
use std::time::Instant;

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// The scene. spheres: two move into each other. crowd: 27 jostle. arms: 27 bodies with arms.
    /// gather: many move to one place. cloth: a sheet folds onto itself. In the others meshes
    /// change. cut: a sphere is sliced. tear: a sheet is torn, then folds. fuse: two merge.
    /// shuffle: pieces that all go elsewhere. remesh: triangles are split and collapsed
    #[arg(default_value = "spheres")]
    scene: String,
    /// Triangles of a body [default: the scene's]
    #[arg(long, value_name = "N")]
    triangles: Option<usize>,
    /// Play the first K steps [default: all]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..))]
    steps: Option<u32>,
    /// Play every S-th step: S, 2 S, ...
    #[arg(
        long,
        value_name = "S",
        default_value = "1",
        value_parser = clap::value_parser!(u32).range(1..)
    )]
    stride: u32,
    /// Pairs to find. all: between bodies. first: one pair between bodies. self: of each body with
    /// itself. everything: all and self [default: all; self for cloth; everything where meshes
    /// change]
    #[arg(long, value_enum)]
    query: Option<Query>,
    /// Type of coordinates; f64 has the values of f32, widened
    #[arg(long, value_enum, default_value_t = Precision::F32)]
    precision: Precision,
    /// A scene of the same kind with other bumps
    #[arg(
        long,
        value_name = "SEED",
        allow_negative_numbers = true,
        value_parser = seed,
        default_value_t = Scene::DEFAULT_SEED
    )]
    seed: u64,
    /// A table, or one JSON object with a figure for every step
    #[arg(long, value_enum, default_value_t = Format::Table)]
    format: Format,
    /// Print nothing on standard output, and show no progress
    #[arg(short, long)]
    quiet: bool,
    #[command(flatten)]
    pictures: PictureOptions,
    #[command(flatten)]
    trees: TreeOptions,
}

const EXAMPLES: &str = "\
Examples:
  pliant run                                     two spheres, 200 steps
  pliant run crowd --steps 50 --threads 2        27 bodies, two threads
  pliant run cloth --precision f64               a folding sheet with itself
  pliant run tear --stride 10 --report tear.html  a sheet is torn
  pliant run spheres --query first               is there any pair? much cheaper
  pliant run spheres --triangles 80 --stride 20  small bodies, every 20th step
  pliant run --partition centre --leaf-size 1    the trees of the paper
  pliant run --partition centre --leaf-size 1 --degree 4 --update top-down
  pliant run gather --format json > gather.json  a figure for every step";

/// Parses a seed.
fn seed(text: &str) -> Result<u64, String> {
    text.parse()
        .map_err(|_| format!("write a whole number from 0 to {}", u64::MAX))
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Precision {
    F32,
    F64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    Table,
    Json,
}

/// Plays the scene and prints the record.
pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<Outcome> {
    let scene = AnyScene::new(&arguments.scene, arguments.triangles, arguments.seed)?;
    let last = arguments.steps.unwrap_or(scene.steps());
    if last > scene.steps() {
        bail!(
            "scene {} has {} steps; --steps {last} is too many, leave it out to play all",
            scene.name(),
            scene.steps()
        );
    }
    let steps: Vec<u32> = (arguments.stride..=last)
        .step_by(arguments.stride as usize)
        .collect();
    if steps.is_empty() {
        bail!(
            "--stride {} is longer than the {last} steps to play; choose a smaller one",
            arguments.stride
        );
    }
    let query = arguments.query.unwrap_or(scene.query());

    let mut watcher = Watcher::new(&arguments.pictures, Vec::new, "step", steps.iter().copied())?;
    let played = match arguments.precision {
        Precision::F32 => play::<f32>(arguments, &scene, query, &steps, |x| x, &mut watcher)?,
        Precision::F64 => play::<f64>(arguments, &scene, query, &steps, f64::from, &mut watcher)?,
    };
    let record = Record {
        scene: scene.name(),
        bodies: scene.body_count(),
        triangles: scene.triangles(0).len(),
        steps: last,
        stride: arguments.stride,
        seed: arguments.seed,
        query: value_name(query),
        precision: value_name(arguments.precision),
        trees: &arguments.trees,
        played,
    };
    let text = match arguments.format {
        Format::Table => record.table(),
        Format::Json => format!("{}\n", record.json()),
    };
    watcher.finish(scene.name(), "step", |_, play| record.tell(play))?;
    if !arguments.quiet {
        print_all(&text)?;
    }
    Ok(Outcome::Clear)
}

/// Plays one world step by step, and measures every step.
///
/// Positions are computed before the clock starts, so vertices are in the cache where they fit.
fn play<S: Scalar>(
    arguments: &Arguments,
    scene: &AnyScene,
    query: Query,
    steps: &[u32],
    convert: impl Fn(f32) -> S,
    watcher: &mut Watcher,
) -> anyhow::Result<Vec<StepRecord>> {
    let mut world = World::<S>::with_options(arguments.trees.to_options()?);
    let mut single = Vec::new();
    let mut shape = |body: usize, step: Option<u32>, out: &mut Vec<[S; 3]>| {
        match step {
            Some(step) => scene.positions(body, step, &mut single),
            None => scene.first_positions(body, &mut single),
        }
        out.clear();
        out.extend(single.iter().map(|position| position.map(&convert)));
    };

    let mut shapes = vec![Vec::new(); scene.body_count()];
    let mut bodies = Vec::new();
    for (body, positions) in shapes.iter_mut().enumerate() {
        // Trees are built on the shape of the first step, whichever steps are played.
        shape(body, None, positions);
        bodies.push(
            world
                .add(scene.triangles(body), positions)
                .context("a bug of pliant, please report it: a built-in scene is refused")?,
        );
    }

    let bar = progress(steps.len() as u64, arguments.quiet)
        .with_style(ProgressStyle::with_template(
            "{msg} {wide_bar} {pos}/{len} steps, {eta} to go",
        )?)
        .with_message(scene.name());
    let mut played = Vec::with_capacity(steps.len());
    let mut before = 0;
    for &step in steps {
        // Changes in steps that are not played happen off the clock.
        for passed in (before + 1..step).filter(|&step| scene.changes(step)) {
            for (body, positions) in shapes.iter_mut().enumerate() {
                shape(body, Some(passed), positions);
            }
            scene.change(&mut world, &bodies, passed, &shapes)?;
        }
        before = step;
        for (body, positions) in shapes.iter_mut().enumerate() {
            shape(body, Some(step), positions);
        }
        let start = Instant::now();
        scene.change(&mut world, &bodies, step, &shapes)?;
        for (&body, positions) in bodies.iter().zip(&shapes) {
            // A body that was fused with another is gone.
            if !positions.is_empty() {
                world.set_positions(body, positions)?;
            }
        }
        let asked = match query {
            Query::Itself => world.bodies().map(Selection::Within).collect(),
            Query::All | Query::First => vec![Selection::World],
            Query::Everything => vec![Selection::Everything],
        };
        for &of in &asked {
            world.intersections(of).prepare()?;
        }
        let updated = Instant::now();
        let mut statistics = pliant::Statistics::default();
        let mut first = None;
        let mut pairs = 0;
        for &of in &asked {
            if query == Query::First {
                first = world.intersections(of).first()?;
                pairs += usize::from(first.is_some());
            } else {
                pairs += world.intersections(of).all()?.len();
            }
            statistics += *world.statistics();
        }
        let end = Instant::now();
        let milliseconds = |from: Instant, to: Instant| (to - from).as_secs_f64() * 1e3;
        played.push(StepRecord {
            step,
            pairs,
            update_ms: milliseconds(start, updated),
            query_ms: milliseconds(updated, end),
            statistics,
        });
        if watcher.looks_at(step) {
            let mut rows: Vec<[u32; 4]> = first.map(Into::into).into_iter().collect();
            if query != Query::First {
                // Asked again, off the clock: it makes no box.
                for &of in &asked {
                    let pairs = world.intersections(of).all()?.iter();
                    rows.extend(pairs.map(|&pair| <[u32; 4]>::from(pair)));
                }
            }
            watcher.frame(step, &world, &rows)?;
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(played)
}
