//! Tests of the help texts: each has examples, and the program accepts every example.

use clap::Command;

/// Calls `show` with every verb and each of its long options that are no secret.
pub(crate) fn for_each_option(mut show: impl FnMut(&str, &str)) {
    let mut program = crate::command();
    program.build();
    let mut shown = 0;
    for verb in verbs(&program) {
        let shown_in_help = verb.get_arguments().filter(|option| !option.is_hide_set());
        for option in shown_in_help.filter_map(|option| option.get_long()) {
            show(verb.get_name(), option);
            shown += 1;
        }
    }
    assert!(shown > 30, "only {shown} options");
}

fn verbs(program: &Command) -> impl Iterator<Item = &Command> {
    program
        .get_subcommands()
        .filter(|verb| verb.get_name() != "help")
}

/// Commands in a help text: lines that begin with ` pliant`, without remarks and shell operators.
fn examples(command: &Command) -> Vec<String> {
    let help = command
        .get_after_help()
        .map_or_else(String::new, ToString::to_string);
    help.lines()
        .filter_map(|line| line.strip_prefix("  "))
        .filter(|line| line.starts_with("pliant "))
        .map(|line| {
            let ends = ["  ", " && ", " | ", " > ", " >> "].map(|end| line.find(end));
            let end = ends.into_iter().flatten().min().unwrap_or(line.len());
            line[..end].to_owned()
        })
        .collect()
}

#[test]
fn examples_fit_a_narrow_terminal() {
    let program = crate::command();
    for command in std::iter::once(&program).chain(verbs(&program)) {
        let help = command.get_after_help().expect("examples").to_string();
        // A longer example would be wrapped and could not be copied. Prose may wrap.
        for line in help.lines().filter(|line| line.starts_with("  ")) {
            assert!(line.chars().count() <= 80, "{}: {line}", command.get_name());
        }
    }
}

/// Commands in the blocks of pages of the site and of READMEs, as the program is called.
#[test]
fn every_command_of_a_page_is_one_that_the_program_takes() {
    let workspace = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut pages = vec![workspace.join("README.md")];
    pages.push(workspace.join("crates/pliant-cli/README.md"));
    for folder in ["crates/pliant/guide", "site/pages"] {
        let entries = std::fs::read_dir(workspace.join(folder)).unwrap();
        pages.extend(entries.map(|entry| entry.unwrap().path()));
    }
    let mut count = 0;
    for page in pages {
        let text = std::fs::read_to_string(&page).unwrap();
        let blocks = text.split("\n```sh\n").skip(1);
        let blocks = blocks.map(|rest| rest.split("\n```").next().unwrap());
        for line in blocks.flat_map(str::lines) {
            let line = line.replace("cargo run --release -- ", "pliant ");
            if line.starts_with("pliant ") {
                let end = line.find(" # ").unwrap_or(line.len());
                let words = shlex::split(&line[..end]).expect("its quotes are closed");
                let taken = crate::command().try_get_matches_from(&words);
                taken.unwrap_or_else(|error| panic!("{}: {line}: {error}", page.display()));
                count += 1;
            }
        }
    }
    assert!(count > 40, "{count} commands");
}

#[test]
fn every_example_in_the_help_is_a_command_that_the_program_takes() {
    let program = crate::command();
    for command in std::iter::once(&program).chain(verbs(&program)) {
        let examples = examples(command);
        assert!(
            examples.len() >= 2,
            "{} has no examples",
            command.get_name()
        );
        for example in examples {
            let words = shlex::split(&example).expect("its quotes are closed");
            let taken = program.clone().try_get_matches_from(&words);
            let taken = taken.unwrap_or_else(|error| panic!("{example}: {error}"));
            let verb = taken.subcommand_name().expect("a verb");
            assert!(
                command.get_name() == "pliant" || command.get_name() == verb,
                "{example} is in the help of {}",
                command.get_name()
            );
        }
    }
}
