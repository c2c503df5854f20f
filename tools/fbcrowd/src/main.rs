//! `fbcrowd`: clips to a motion database, a database to a crowd, a crowd to pictures.
//!
//! One file a subcommand under [`cmd`]; what it reports is made in [`report`] and printed by [`terminal`]. Results go
//! to standard output, all else to standard error. Exit codes: 0 yes; 1 the answer is no, or an output was written
//! though some input was refused; 2 bad usage or input, nothing written; 3 the machine failed, so a retry may help.
//! After a signal: 128 + its number.

mod cmd;
#[cfg(test)]
mod docs;
mod report;
mod terminal;

use std::io::{self, IsTerminal};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use miette::MietteHandlerOpts;
use motiondb::files::atomic_file;

use crate::terminal::failure::{Answer, Failure};

/// Most threads: more than any machine has cores.
const THREADS_MAX: i64 = 1024;

/// Exit codes, as `--help` lists them.
const EXIT_CODES: &str = "\
Exit codes:
  0  yes
  1  the answer is no, or some input was refused while the rest was used
  2  bad usage or input; nothing was written
  3  the machine failed (disk, memory, permission): a retry may help; the message names the complete outputs
  129, 130, 143  ended by SIGHUP, SIGINT, SIGTERM; temporary files are removed";

/// Clips to a motion database, a database to a crowd, a crowd to pictures.
#[derive(Parser)]
#[command(name = "fbcrowd", version, max_term_width = 110, arg_required_else_help = true, after_help = EXIT_CODES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Threads to use; all cores by default. Every output is the same for any number.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=THREADS_MAX))]
    threads: Option<u16>,
    /// Do not force outputs onto the disk: faster, but a power failure soon after may leave an empty file.
    #[arg(long, global = true)]
    no_sync: bool,
}

#[derive(Subcommand)]
enum Command {
    Run(cmd::run::Args),
    Compile(cmd::compile::Args),
    Validate(cmd::validate::Args),
    Inspect(cmd::inspect::Args),
    Clips(cmd::clips::Args),
    Check(cmd::check::Args),
    Convert(cmd::convert::Args),
    Simulate(cmd::simulate::Args),
    Measure(cmd::measure::Args),
    Render(cmd::render::Args),
    Bench(cmd::bench::Args),
    Completions(cmd::completions::Args),
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    if !io::stderr().is_terminal() {
        // Programs that read a log search whole lines.
        let whole_lines = || MietteHandlerOpts::new().wrap_lines(false).build();
        miette::set_hook(Box::new(move |_| Box::new(whole_lines()))).expect("set once");
    }
    atomic_file::set_sync(!cli.no_sync);
    match handle_signals().and_then(|()| use_threads(cli.threads)).and_then(|()| dispatch(cli.command)) {
        Ok(Answer::Yes) => ExitCode::SUCCESS,
        Ok(Answer::No) => ExitCode::from(1),
        Err(failure) => failure.report(),
    }
}

fn dispatch(command: Command) -> Result<Answer, Failure> {
    match command {
        Command::Run(args) => cmd::run::run(&args),
        Command::Compile(args) => cmd::compile::run(&args),
        Command::Validate(args) => cmd::validate::run(&args),
        Command::Inspect(args) => cmd::inspect::run(&args),
        Command::Clips(args) => cmd::clips::run(&args),
        Command::Check(args) => cmd::check::run(&args),
        Command::Convert(args) => cmd::convert::run(&args),
        Command::Simulate(args) => cmd::simulate::run(&args),
        Command::Measure(args) => cmd::measure::run(&args),
        Command::Render(args) => cmd::render::run(&args),
        Command::Bench(args) => cmd::bench::run(&args),
        Command::Completions(args) => cmd::completions::run(&args),
    }
}

fn use_threads(threads: Option<u16>) -> Result<(), Failure> {
    let Some(threads) = threads else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(usize::from(threads))
        .build_global()
        .map_err(|error| Failure::of_machine(format!("cannot start {threads} threads: {error}; use fewer")))
}

/// Removes temporary files when a signal ends the process.
#[cfg(unix)]
fn handle_signals() -> Result<(), Failure> {
    let handled = terminal::signals::handle();
    handled.map_err(|error| Failure::of_machine(format!("signals cannot be handled: {error}; start again")))
}

/// Other systems end the process at once; the next one removes its temporary files.
#[cfg(not(unix))]
fn handle_signals() -> Result<(), Failure> {
    Ok(())
}
