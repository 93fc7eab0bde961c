//! The command line: one subcommand a file, no mechanics.

mod args;
mod commands;
mod console;

use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command};
use console::Console;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let console = Console::new(arguments.quiet, arguments.verbose);
    let result = match arguments.command {
        Command::Design(options) => commands::design::run(&options, &console),
        Command::Verify(options) => commands::verify::run(&options, &console),
        Command::Compare(options) => commands::compare::run(&options, &console),
        Command::Fabricate(options) => commands::fabricate::run(&options, &console),
        Command::Conduct(options) => commands::conduct::run(&options, &console),
        Command::Indent(options) => commands::indent::run(&options, &console),
        Command::Optimise(options) => commands::optimise::run(&options, &console),
        Command::Sweep(options) => commands::sweep::run(&options, &console),
        Command::Micromechanics(options) => commands::micromechanics::run(&options, &console),
        Command::Materials(options) => commands::materials::run(&options, &console),
        Command::Targets(options) => commands::lists::targets(&options, &console),
        Command::Schema => commands::lists::schema(&console),
    };
    match result {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            console.error(&error);
            ExitCode::from(error.exit_code())
        }
    }
}
