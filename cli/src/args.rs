//! What the command line accepts.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use voxelastica_core::input::FabricationKind;

/// Target shape in, finite-element decks of a flat, modulus-graded flower out.
#[derive(Debug, Parser)]
#[command(
    name = "voxelastica",
    version,
    about,
    after_help = "Exit codes: 0 done; 1 internal error; 2 wrong input; 3 infeasible design; 4 solver failed; \
                  5 files could not be written; 6 --target-error missed; 130 cancelled."
)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Print nothing but errors.
    #[arg(long, short, global = true)]
    pub quiet: bool,
    /// Print more figures.
    #[arg(long, short, global = true, conflicts_with = "quiet")]
    pub verbose: bool,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Design a flower: widths, modulus, voxels, decks and a report.
    Design(DesignOptions),
    /// Let CalculiX morph a design and compare the result with the target.
    Verify(VerifyOptions),
    /// Make the files to print, cut and assemble a design.
    Fabricate(FabricateOptions),
    /// List the materials of the library.
    Materials,
    /// List the kinds of targets and the built-in examples, or print one of them.
    Targets(TargetsOptions),
    /// Print the JSON Schema of the design file.
    Schema,
}

/// Options of `design`.
#[derive(Debug, Args)]
pub struct DesignOptions {
    /// The design file (TOML, or JSON with the same keys).
    pub file: PathBuf,
    /// Folder to write into [default: out/NAME].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Do it even if there are more than 200 million voxels or the disk seems too small.
    #[arg(long)]
    pub yes: bool,
}

/// Options of `verify`.
#[derive(Debug, Args)]
pub struct VerifyOptions {
    /// Folder that `design` wrote.
    pub folder: PathBuf,
    /// Which deck to solve.
    #[arg(long, value_enum, default_value_t = ModelChoice::Graded)]
    pub model: ModelChoice,
    /// Which solver to use.
    #[arg(long, value_enum, default_value_t = SolverChoice::Ccx)]
    pub solver: SolverChoice,
    /// The CalculiX program.
    #[arg(long, value_name = "PATH", default_value = "ccx")]
    pub ccx: PathBuf,
    /// Processor cores for the solver [default: all].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Exit with 6 if the largest error exceeds this share of the length, percent.
    #[arg(long, value_name = "PCT", value_parser = positive)]
    pub target_error: Option<f64>,
    /// Keep the solver's files in this folder.
    #[arg(long, value_name = "DIR")]
    pub keep: Option<PathBuf>,
}

/// Options of `fabricate`.
#[derive(Debug, Args)]
pub struct FabricateOptions {
    /// Folder that `design` wrote.
    pub folder: PathBuf,
    /// Make this kind only; may be repeated [default: fabrication.write of the design, or all that it can have].
    #[arg(long, value_name = "KIND", value_delimiter = ',', value_parser = fabrication_kinds())]
    pub only: Vec<FabricationKind>,
    /// Do it even if there are very many voxels or the disk seems too small.
    #[arg(long)]
    pub yes: bool,
}

/// Options of `targets`.
#[derive(Debug, Args)]
pub struct TargetsOptions {
    /// Print this example's design file.
    pub name: Option<String>,
}

/// Models that can be solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ModelChoice {
    /// Smooth width, graded modulus.
    Graded,
    /// Every voxel its phase.
    Voxel,
}

/// Solvers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SolverChoice {
    /// CalculiX.
    Ccx,
}

fn fabrication_kinds() -> impl TypedValueParser<Value = FabricationKind> {
    PossibleValuesParser::new(FabricationKind::ALL.map(FabricationKind::name))
        .try_map(|name| FabricationKind::from_name(&name).ok_or_else(|| format!("{name} is not known")))
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("it must be a positive number, in percent".to_owned()),
    }
}
