//! The program `meshweft`: optimise, inspect and compare the face order of mesh files.
#![forbid(unsafe_code)]

mod args;
mod compare;
mod count;
mod demo;
mod inputs;
mod inspect;
mod methods;
mod optimize;
mod output;
mod paper;
mod plot;

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Verb, WhichPaper};

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let done = match &arguments.verb {
        Verb::Optimize(arguments) => optimize::run(arguments),
        Verb::Inspect(arguments) => inspect::run(arguments),
        Verb::Compare(arguments) => compare::run(arguments),
        Verb::Demo(arguments) => demo::run(arguments),
        Verb::Paper(arguments) => match &arguments.paper {
            WhichPaper::LinYu(arguments) => paper::lin_yu::run(arguments),
            WhichPaper::BogomjakovGotsman(arguments) => paper::bogomjakov_gotsman::run(arguments),
        },
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if output::is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(match error.is::<args::Usage>() {
                true => 2,
                false => 1,
            })
        }
    }
}
