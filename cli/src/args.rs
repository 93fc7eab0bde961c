//! What the command line accepts.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

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
    /// Morph a design with every voxel resolved and compare the result with the target.
    Verify(VerifyOptions),
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
    /// Correct the modulus with the finite elements inside, at most N times [default with this option: 4, without:
    /// refine.iterations of the design file].
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "4",
          value_parser = clap::value_parser!(u8).range(0..=20))]
    pub refine: Option<u8>,
    /// Do it even if there are more than 200 million voxels or the disk or the memory seems too small.
    #[arg(long)]
    pub yes: bool,
}

/// Options of `verify`.
#[derive(Debug, Args)]
pub struct VerifyOptions {
    /// Folder that `design` wrote.
    pub folder: PathBuf,
    /// Which model to solve.
    #[arg(long, value_enum, default_value_t = ModelChoice::Voxel)]
    pub model: ModelChoice,
    /// Which solver to use: the one inside, or CalculiX on the deck in the folder.
    #[arg(long, value_enum, default_value_t = SolverChoice::Embedded)]
    pub solver: SolverChoice,
    /// Elements along a voxel's edge, for the solver inside.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=8))]
    pub elements_per_voxel_edge: u8,
    /// The CalculiX program.
    #[arg(long, value_name = "PATH", default_value = "ccx")]
    pub ccx: PathBuf,
    /// Processor cores for the solver [default: all].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Exit with 6 if the largest error exceeds this share of the length, percent.
    #[arg(long, value_name = "PCT", value_parser = positive)]
    pub target_error: Option<f64>,
    /// Keep CalculiX's files in this folder.
    #[arg(long, value_name = "DIR")]
    pub keep: Option<PathBuf>,
    /// Do it even if it seems to need more memory than there is.
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
    /// The finite elements inside.
    Embedded,
    /// CalculiX.
    Ccx,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("it must be a positive number, in percent".to_owned()),
    }
}
