//! `pliant man`: manual pages of the program and of each verb, generated from the argument structs.

use crate::outcome::Outcome;
use crate::terminal::print_all;
use anyhow::Context;
use clap::{Args, Command};
use clap_mangen::Man;
use pliant_io::shown;
use std::fs;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// The folder for pliant.1, pliant-run.1, ...; it is made if it is not there. Without a folder,
    /// pliant.1 goes to standard output
    #[arg(value_name = "DIR")]
    folder: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  pliant man ~/.local/share/man/man1    then `man pliant`, `man pliant-check`
  pliant man | man -l -                 read it now";

/// Writes the manual pages to a folder, or the first one to standard output.
pub(crate) fn write(arguments: &Arguments, program: Command) -> anyhow::Result<Outcome> {
    let pages = pages(program)?;
    let Some(folder) = &arguments.folder else {
        let page = pages.into_iter().next().map(|(_, page)| page);
        print_all(&page.unwrap_or_default())?;
        return Ok(Outcome::Clear);
    };
    fs::create_dir_all(folder).with_context(|| format!("cannot write {}", shown(folder)))?;
    for (name, page) in pages {
        let file = folder.join(name);
        fs::write(&file, page).with_context(|| format!("cannot write {}", shown(&file)))?;
    }
    Ok(Outcome::Clear)
}

/// File names and texts of the pages: the program first, then its verbs.
fn pages(program: Command) -> anyhow::Result<Vec<(String, String)>> {
    let mut program = program.disable_help_subcommand(true);
    // Makes usage lines name the program.
    program.build();
    let verbs: Vec<_> = program.get_subcommands().cloned().collect();
    std::iter::once(program)
        .chain(verbs)
        .map(|verb| {
            let man = Man::new(verb);
            let mut page = Vec::new();
            man.render(&mut page)?;
            let page = String::from_utf8_lossy(&page).into_owned();
            Ok((man.get_filename(), page))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::pages;
    use crate::examples::for_each_option;

    #[test]
    fn a_page_a_verb_names_every_option_and_example() {
        let pages = pages(crate::command()).unwrap();
        // A page for each verb, and none for the `help` that clap adds.
        let files: Vec<&str> = pages.iter().map(|(file, _)| file.as_str()).collect();
        let verbs = [
            "run",
            "check",
            "summary",
            "convert",
            "bench",
            "formats",
            "completions",
            "man",
        ];
        assert_eq!(files[0], "pliant.1");
        assert_eq!(files[1..], verbs.map(|verb| format!("pliant-{verb}.1")));
        for_each_option(|verb, option| {
            let name = format!("pliant-{verb}.1");
            let (_, page) = pages.iter().find(|(file, _)| *file == name).expect(&name);
            let roff = format!("\\-\\-{}", option.replace('-', "\\-"));
            assert!(page.contains(&roff), "{name}: {roff}");
            assert!(page.contains("Examples:"), "{name}");
            assert!(
                pages[0]
                    .1
                    .contains(&name.replace(".1", "(1)").replace('-', "\\-")),
                "{name}"
            );
        });
    }
}
