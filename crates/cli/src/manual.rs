//! Completions and manual pages, made from the flags.

use std::process::ExitCode;

use clap::CommandFactory as _;

use crate::args::{Args, Completions, Man};
use crate::commands::{Answer, key};
use crate::output::put;

pub(crate) fn completions(args: &Completions) -> Answer {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Args::command(), "snake", &mut text);
    put(&String::from_utf8_lossy(&text))?;
    Ok(ExitCode::SUCCESS)
}

pub(crate) fn page(args: &Man) -> Answer {
    let mut command = Args::command();
    command.build();
    let page = match &args.command {
        None => clap_mangen::Man::new(command),
        Some(name) => {
            let known: Vec<&str> = command
                .get_subcommands()
                .map(clap::Command::get_name)
                .collect();
            let known = known.join(", ");
            let found = command.find_subcommand(name).cloned();
            let found =
                found.ok_or_else(|| key("man", format!("must be one of {known}, got {name}")))?;
            clap_mangen::Man::new(found)
        }
    };
    let mut text = Vec::new();
    page.render(&mut text).map_err(|error| key("man", error))?;
    put(&String::from_utf8_lossy(&text))?;
    Ok(ExitCode::SUCCESS)
}
