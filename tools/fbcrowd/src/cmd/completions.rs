//! `fbcrowd completions`: a script with which a shell completes commands and options.

use clap::CommandFactory;
use clap_complete::Shell;

use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;

/// Print the completion script of a shell.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd completions bash > ~/.local/share/bash-completion/completions/fbcrowd")]
pub(crate) struct Args {
    /// The shell.
    shell: Shell,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut crate::Cli::command(), "fbcrowd", &mut script);
    output::print(&String::from_utf8_lossy(&script))?;
    Ok(Answer::Yes)
}
