//! `pliant completions`: scripts with which a shell completes verbs, options and their values.

use crate::outcome::Outcome;
use crate::terminal::print_all;
use clap::{Args, Command};
use clap_complete::Shell;

#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Arguments {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

const EXAMPLES: &str = "\
Examples:
  pliant completions bash > ~/.local/share/bash-completion/completions/pliant
  pliant completions zsh > ~/.zfunc/_pliant
  pliant completions fish > ~/.config/fish/completions/pliant.fish
  pliant completions powershell >> $PROFILE
  pliant completions elvish >> ~/.config/elvish/rc.elv

The folder must be there; zsh needs fpath+=(~/.zfunc) before compinit in ~/.zshrc.";

/// Prints the completion script for a shell.
pub(crate) fn print(arguments: &Arguments, program: Command) -> anyhow::Result<Outcome> {
    print_all(&script(arguments.shell, program))?;
    Ok(Outcome::Clear)
}

fn script(shell: Shell, mut program: Command) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut program, "pliant", &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

#[cfg(test)]
mod tests {
    use super::script;
    use crate::examples::for_each_option;
    use clap::ValueEnum;
    use clap_complete::Shell;

    #[test]
    fn every_shell_knows_every_verb_and_option() {
        for &shell in Shell::value_variants() {
            let script = script(shell, crate::command());
            for_each_option(|verb, option| {
                // fish names options by `-l`, without their dashes.
                let written = match shell {
                    Shell::Fish => format!("-l {option}"),
                    _ => format!("--{option}"),
                };
                assert!(script.contains(verb), "{shell}: {verb}");
                assert!(script.contains(&written), "{shell}: {verb} {written}");
            });
        }
    }
}
