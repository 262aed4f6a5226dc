//! The command `snake`: the shell's question as a scene, the outcome as text and a code.
//!
//! Exit code 0: it came to rest, or ran as asked. 1: it ran, but blew up, left the picture, found no outline,
//! was stopped, or ran out of steps before rest. 2: refused, with one line that says why and what is needed.

mod args;
mod commands;
mod crop;
mod eval;
mod fit;
mod live;
mod manual;
mod output;
mod stop;
mod track;

use std::process::ExitCode;

use clap::Parser as _;
use clap::error::ErrorKind;
use scene::SceneError;

fn main() -> ExitCode {
    let args = match args::Args::try_parse() {
        Ok(args) => args,
        Err(error) => return mistyped(&error),
    };
    let words = args.words;
    let outcome = match args.command {
        args::Command::Run(run) => commands::run(&run, words),
        args::Command::Field(field) => commands::field(&field, words),
        args::Command::Fit(flags) => fit::fit(&flags, words),
        args::Command::Track(flags) => track::track(&flags, words),
        args::Command::Live(flags) => live::live(&flags, words),
        args::Command::Eval(eval) => eval::eval(&eval, words),
        args::Command::Show(show) => commands::show(&show),
        args::Command::List(list) => commands::list(&list, words),
        args::Command::Completions(completions) => manual::completions(&completions),
        args::Command::Man(man) => manual::page(&man),
    };
    match outcome {
        Ok(code) => code,
        Err(error) => {
            let hint = match error {
                SceneError::UnknownScene { .. } => {
                    " (`snake list` shows all; a file needs its ending or a folder)"
                }
                _ => "",
            };
            output::complain(&format!("snake: {error}{hint}"));
            ExitCode::from(2)
        }
    }
}

/// Help that was asked for, or what is wrong with the flags, on one line.
fn mistyped(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        return match output::put(&error.render().to_string()) {
            Ok(()) => ExitCode::SUCCESS,
            Err(refused) => {
                output::complain(&format!("snake: {refused}"));
                ExitCode::from(2)
            }
        };
    }
    if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        // nobody may be there to read it
        let _ = error.print();
        return ExitCode::from(2);
    }
    let text = error.to_string();
    let lines: Vec<&str> = text
        .lines()
        .map(str::trim)
        .take_while(|line| !line.starts_with("Usage:"))
        .filter(|line| !line.is_empty() && !line.starts_with("For more information"))
        .collect();
    let line = match &lines[..] {
        // what is missing, as a list
        [first, missing @ ..] if error.kind() == ErrorKind::MissingRequiredArgument => {
            format!("{first} {}", missing.join(", "))
        }
        _ => lines.join("; "),
    };
    let line = line.strip_prefix("error: ").unwrap_or(&line);
    output::complain(&format!("snake: {line} (--help shows all)"));
    if error.kind() == ErrorKind::MissingRequiredArgument {
        let usage = text.lines().find(|line| line.starts_with("Usage:"));
        usage.into_iter().for_each(output::complain);
    }
    ExitCode::from(2)
}
