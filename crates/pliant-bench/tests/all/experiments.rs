//! Every experiment in its small form: all methods are right, and the record keeps to its schema.

use pliant_bench::contest::{Contender, Contest, Query};
use pliant_bench::decision::exact;
use pliant_bench::experiments::titles::TITLES;
use pliant_bench::experiments::{EXPERIMENTS, Form};
use pliant_bench::machine::this_machine;
use pliant_bench::method::{Counters, Method, Pair};
use pliant_bench::methods::{Ours, Sweep};
use pliant_bench::motion::{BodyMesh, Motion, Shape};
use pliant_bench::record::{Record, Verdict, Window, Wrong};
use pliant_scenes::Scene;
use std::path::Path;

fn schema() -> (boon::Schemas, boon::SchemaIndex) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../benchmarks/record.schema.json");
    let mut schemas = boon::Schemas::new();
    let schema = boon::Compiler::new()
        .compile(file.to_str().unwrap(), &mut schemas)
        .unwrap();
    (schemas, schema)
}

#[test]
fn versions_in_a_record_are_those_that_were_compiled() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../Cargo.lock");
    let lock = std::fs::read_to_string(file).unwrap();
    for (name, version) in this_machine().versions {
        let entry = format!("name = \"{name}\"\nversion = \"{version}\"\n");
        assert!(name == "rustc" || lock.contains(&entry), "{entry}");
    }
}

#[test]
fn small_forms_are_right_and_keep_to_the_schema() {
    let (schemas, schema) = schema();
    for (number, experiment) in EXPERIMENTS.iter().enumerate() {
        // One experiment suffices to show what several rounds become.
        let rounds = if number == 0 { 2 } else { 1 };
        let mut steps = 0;
        let done = experiment.run(Form::Small, rounds, &mut |_, played| steps += played);
        // Methods that are wrong are not timed: progress may fall short of the plan, but never
        // exceeds it.
        assert!(
            steps > 0 && steps <= experiment.length(Form::Small, rounds),
            "{}",
            experiment.name
        );
        assert!(!done.contests.is_empty() && !done.claims.is_empty());
        for contest in &done.contests {
            // Most bodies of `bodies` are still apart: it is about the broad phase. Nothing in a
            // lid is near anything else: it is about finding that soon.
            let idle = contest.name.ends_with("bodies") || contest.name.starts_with("lid");
            assert!(
                contest.pairs.iter().sum::<usize>() > 0 || idle,
                "{} is idle",
                contest.name
            );
            for method in &contest.methods {
                // The paper's triangle test takes part to be found wrong; nobody else may be.
                let may_be_wrong = method.name.contains("paper's triangle test");
                assert!(
                    method.wrong.is_none() || may_be_wrong,
                    "{}, {}: {:?}",
                    contest.name,
                    method.name,
                    method.wrong
                );
                if method.wrong.is_none() {
                    assert_eq!(method.update_ms.len(), contest.steps.len());
                    assert_eq!(method.windows.len(), contest.windows.len());
                }
                let worked = method
                    .counters
                    .iter()
                    .any(|counters| *counters != Counters::default());
                assert!(worked || idle, "{}", method.name);
            }
        }
        let record = Record {
            format: 1,
            machine: this_machine(),
            experiments: vec![done],
        };
        let json = serde_json::to_value(&record).unwrap();
        schemas
            .validate(&json, schema)
            .unwrap_or_else(|error| panic!("{}: {error:#}", experiment.name));
        // The text is read back unchanged, and unknown members are refused.
        let again: Record = serde_json::from_value(json.clone()).unwrap();
        assert_eq!(serde_json::to_value(again).unwrap(), json);
    }
}

#[test]
fn the_schema_refuses_what_is_not_a_record() {
    let (schemas, schema) = schema();
    let record = Record {
        format: 1,
        machine: this_machine(),
        experiments: Vec::new(),
    };
    let good = serde_json::to_value(record).unwrap();
    assert!(schemas.validate(&good, schema).is_ok());
    for (member, value) in [
        ("format", serde_json::json!(2)),
        ("experiments", serde_json::json!({})),
        ("extra", serde_json::json!(0)),
    ] {
        let mut bad = good.clone();
        bad[member] = value;
        assert!(schemas.validate(&bad, schema).is_err(), "{member}");
    }
}

#[test]
fn checked_in_records_keep_to_the_schema() {
    let (schemas, schema) = schema();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../benchmarks/records");
    for file in std::fs::read_dir(folder).into_iter().flatten() {
        let path = file.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy();
        // Records of many threads have a schema of their own: `cores`.
        if name.ends_with(".json") && !name.starts_with("cores-") {
            let json = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
            schemas
                .validate(&json, schema)
                .unwrap_or_else(|error| panic!("{}: {error:#}", path.display()));
        }
    }
}

/// A method that forgets a pair, or invents one, from a step on.
struct Liar {
    inner: Sweep,
    step: usize,
    lies_from: usize,
    invents: bool,
    pairs: Vec<Pair>,
}

impl Method for Liar {
    fn name(&self) -> String {
        "liar".to_owned()
    }
    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        self.inner.build(bodies);
    }
    fn step(&mut self, shapes: &[Shape<'_>]) {
        self.step += 1;
        self.inner.step(shapes);
    }
    fn all_pairs(&mut self) -> &[Pair] {
        self.pairs = self.inner.all_pairs().to_vec();
        if self.step >= self.lies_from {
            if self.invents {
                self.pairs.push([0, u32::MAX, 1, 0]);
            } else {
                self.pairs.remove(0);
            }
        }
        &self.pairs
    }
    fn first_pair(&mut self) -> Option<Pair> {
        self.all_pairs().last().copied()
    }
    fn take_counters(&mut self) -> Counters {
        Counters::default()
    }
}

#[test]
fn a_wrong_method_is_found_out_and_not_timed() {
    let liar = |lies_from, invents| {
        Contender::new(
            "liar",
            Liar {
                inner: Sweep::new(exact),
                step: 0,
                lies_from,
                invents,
                pairs: Vec::new(),
            },
        )
    };
    let play = |query, methods| {
        let scene = Scene::new("spheres", Some(320), Scene::DEFAULT_SEED).unwrap();
        let windows = vec![
            Window {
                name: "all".into(),
                first: 1,
                last: 200,
            },
            Window {
                name: "none".into(),
                first: 1,
                last: 9,
            },
        ];
        let motion = Motion::of_scene(&scene, [100, 150, 200]);
        let contest = Contest {
            name: "lies".into(),
            motion,
            query,
            truth: Box::new(Sweep::new(exact)),
            methods,
            windows,
            cold: false,
        };
        contest.play(3, &mut |_| ())
    };
    let ours = || Contender::new("ours", Ours::<f32>::new("ours", pliant::Options::default()));
    let record = play(
        Query::All,
        vec![ours(), liar(2, false), liar(3, true), liar(9, true)],
    );
    assert_eq!(record.methods[0].wrong, None);
    assert_eq!(
        record.methods[1].wrong,
        Some(Wrong {
            step: 150,
            missing: 2,
            extra: 0
        })
    );
    assert_eq!(
        record.methods[2].wrong,
        Some(Wrong {
            step: 200,
            missing: 0,
            extra: 1
        })
    );
    assert_eq!(record.methods[3].wrong, None);
    for method in &record.methods {
        assert_eq!(method.update_ms.is_empty(), method.wrong.is_some());
        assert_eq!(method.windows.is_empty(), method.wrong.is_some());
    }
    assert_eq!(
        record.windows.len(),
        1,
        "a window without steps is left out"
    );
    let speedup = record.methods[0].windows[0].speedup.unwrap();
    assert_eq!(
        (speedup.least, speedup.most),
        (1.0, 1.0),
        "a method is as fast as itself"
    );

    let record = play(Query::First, vec![ours(), liar(3, true)]);
    assert_eq!(record.methods[0].wrong, None);
    assert_eq!(
        record.methods[1].wrong.as_ref().map(|wrong| wrong.step),
        Some(200)
    );
}

#[test]
fn experiments_have_names_of_their_own() {
    let mut names: Vec<_> = TITLES.iter().map(|title| title.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), TITLES.len());
    assert_eq!(
        serde_json::to_value(Verdict::DoesNotHoldToday).unwrap(),
        "does-not-hold-today"
    );
}

#[test]
fn a_build_has_every_experiment_that_it_can_have() {
    let with_peers = cfg!(feature = "peers");
    let could = TITLES
        .iter()
        .filter(|title| with_peers || !title.with_peers)
        .map(|title| (title.name, title.about));
    let has = EXPERIMENTS
        .iter()
        .map(|experiment| (experiment.name, experiment.about));
    assert!(could.eq(has));
}
