//! The command `snake`: the shell's question as a scene, the outcome as text and a code.
//!
//! Exit code 0: it came to rest, or ran as asked. 1: it ran, but blew up, left the picture or ran
//! out of steps before rest. 2: refused, with one line that says why and what would do.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "results go to standard output and words to standard error: that is its job"
)]

mod args;
mod commands;

use std::process::ExitCode;

use clap::Parser as _;

fn main() -> ExitCode {
    let args = args::Args::parse();
    let outcome = match args.command {
        args::Command::Run(run) => commands::run(&run),
        args::Command::Field(field) => commands::field(&field),
        args::Command::Fit(fit) => commands::fit(&fit),
        args::Command::List(list) => commands::list(&list),
    };
    match outcome {
        Ok(code) => code,
        Err(error) => {
            eprintln!("snake: {error}");
            ExitCode::from(2)
        }
    }
}
