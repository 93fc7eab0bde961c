//! What the command line accepts.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use voxelastica_core::input::FabricationKind;
use voxelastica_core::sweep::run::Batch;

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
    /// Compare a mid-line of another solver, or a scan of the real dome, with the target and the prediction.
    Compare(CompareOptions),
    /// Make the files to print, cut and assemble a design.
    Fabricate(FabricateOptions),
    /// Let heat and current through a design's strip: fields, effective conductivities, pictures.
    Conduct(Box<ConductOptions>),
    /// Press the hub of a closed dome down: force-displacement curve, rigidity, energy.
    Indent(IndentOptions),
    /// Look for the design that has most rigidity, energy or printability and keeps all limits.
    Optimise(OptimiseOptions),
    /// Compute many designs: a grid or a Latin hypercube over keys of a design file, in one table.
    Sweep(SweepOptions),
    /// Test every layout of a small cell of two phases: moduli along x, y and z against their bounds.
    Micromechanics(MicromechanicsOptions),
    /// List the materials of the library, or take a custom one from tensile tests.
    Materials(MaterialsOptions),
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

/// Options of `compare`.
#[derive(Debug, Args)]
pub struct CompareOptions {
    /// Folder that `design` wrote.
    pub folder: PathBuf,
    /// The measured shape, mm: columns s_mm,x_mm,z_mm (a mid-line), rho_mm,z_mm (a meridian) or x_mm,y_mm,z_mm (points
    /// of a dome, anywhere in space).
    #[arg(long, value_name = "FILE.csv")]
    pub result: PathBuf,
    /// How it is laid onto the target.
    #[arg(long, value_enum, default_value_t = Placing::Auto)]
    pub placement: Placing,
    /// The surface that points are compared with.
    #[arg(long, value_enum, default_value_t = SurfaceChoice::Auto)]
    pub surface: SurfaceChoice,
    /// The side of the sheet that was scanned.
    #[arg(long, value_enum, default_value_t = FaceChoice::Middle)]
    pub face: FaceChoice,
    /// Exit with 6 if the largest error exceeds this share of the length, percent.
    #[arg(long, value_name = "PCT", value_parser = positive)]
    pub target_error: Option<f64>,
}

/// Ways to lay a result onto the target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Placing {
    /// A mid-line by its rim, a scan by the best fit.
    Auto,
    /// Not moved at all.
    AsGiven,
    /// A mid-line's first point on the target's.
    Rim,
    /// The rigid motion that fits best.
    Fit,
}

/// Surfaces that points are compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SurfaceChoice {
    /// The one that fits better.
    Auto,
    /// The target's surface of revolution.
    Revolution,
    /// Spokes that are straight across their width.
    Spokes,
}

/// Sides of the sheet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FaceChoice {
    /// The middle of the thickness, where the target is.
    Middle,
    /// The outer face.
    Outer,
    /// The inner face.
    Inner,
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

/// Options of `conduct`. What is not given is what the design's [conduction] table says.
#[derive(Debug, Args)]
pub struct ConductOptions {
    /// Folder that `design` wrote.
    pub folder: PathBuf,
    /// What flows.
    #[arg(long, value_enum, default_value_t = Flow::Both)]
    pub flow: Flow,
    /// The state in the long run, the way there, or both.
    #[arg(long, value_enum, default_value_t = Regime::Both)]
    pub regime: Regime,
    /// Every voxel its phase, or the smooth strip with the designed mixture.
    #[arg(long, value_enum, default_value_t = ConductModel::Voxel)]
    pub model: ConductModel,
    /// As printed, or at the end of the morph.
    #[arg(long, value_enum, default_value_t = ConductShape::Flat)]
    pub shape: ConductShape,
    /// Temperature of the rim, K.
    #[arg(long, value_name = "K")]
    pub rim_temperature: Option<f64>,
    /// Temperature of the rest at the start, K.
    #[arg(long, value_name = "K")]
    pub start_temperature: Option<f64>,
    /// Current that enters at the rim, A.
    #[arg(long, value_name = "A")]
    pub current: Option<f64>,
    /// How it enters.
    #[arg(long, value_enum)]
    pub electrode: Option<ElectrodeChoice>,
    /// Times of temperature fields, s, separated by commas.
    #[arg(long, value_name = "S,...", value_delimiter = ',')]
    pub heat_times: Option<Vec<f64>>,
    /// Times of potential fields, s, separated by commas.
    #[arg(long, value_name = "S,...", value_delimiter = ',')]
    pub current_times: Option<Vec<f64>>,
    /// Measuring points on the mid-line as shares of the length from the rim, separated by commas.
    #[arg(long, value_name = "SHARE,...", value_delimiter = ',')]
    pub measure_at: Option<Vec<f64>>,
    /// Share of the final temperature at the critical time.
    #[arg(long, value_name = "SHARE")]
    pub threshold: Option<f64>,
    /// What that is a share of.
    #[arg(long, value_enum)]
    pub threshold_of: Option<ThresholdChoice>,
    /// Share off the steady potential that counts as its plateau.
    #[arg(long, value_name = "SHARE")]
    pub plateau: Option<f64>,
    /// Largest error of a time step as a share of the rise.
    #[arg(long, value_name = "SHARE")]
    pub time_tolerance: Option<f64>,
    /// Also draw modulus against conductivity for mixtures of the phases in every pattern.
    #[arg(long)]
    pub ashby: bool,
    /// Write no fields for ParaView.
    #[arg(long)]
    pub no_vtu: bool,
    /// Folder to write into [default: the design's].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Write even if the disk seems too small.
    #[arg(long)]
    pub yes: bool,
}

/// Options of `indent`. What is not given is what the design's [indentation] table says.
#[derive(Debug, Args)]
pub struct IndentOptions {
    /// Folder that `design` wrote.
    pub folder: PathBuf,
    /// Which model to press.
    #[arg(long, value_enum, default_value_t = IndentModel::Elastica)]
    pub model: IndentModel,
    /// What presses.
    #[arg(long, value_enum)]
    pub indenter: Option<IndenterChoice>,
    /// How far, mm [default: a tenth of the spoke's length].
    #[arg(long, value_name = "MM")]
    pub depth: Option<f64>,
    /// Steps of the curve.
    #[arg(long, value_name = "N")]
    pub steps: Option<usize>,
    /// Diameter of the flat indenter, mm [default: 0.339 of the dome's].
    #[arg(long, value_name = "MM")]
    pub indenter_diameter: Option<f64>,
    /// How the elastica bends.
    #[arg(long, value_enum)]
    pub bending: Option<BendingChoice>,
    /// Let the spoke pass through its neighbours, in finite elements.
    #[arg(long)]
    pub ignore_neighbours: bool,
    /// Share by which all moduli may be off: the force's band.
    #[arg(long, value_name = "PCT")]
    pub modulus_band: Option<f64>,
    /// Pressure between indenter and spokes over their penetration, in CalculiX, N/mm^3.
    #[arg(long, value_name = "N/MM3")]
    pub contact_stiffness: Option<f64>,
    /// The CalculiX program.
    #[arg(long, value_name = "PROGRAM", default_value = "ccx")]
    pub ccx: PathBuf,
    /// Keep CalculiX's files in this folder.
    #[arg(long, value_name = "DIR")]
    pub keep: Option<PathBuf>,
    /// Folder to write into [default: the design's].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// Options of `optimise`.
#[derive(Debug, Args)]
pub struct OptimiseOptions {
    /// The file of the optimisation (TOML, or JSON with the same keys).
    pub file: PathBuf,
    /// Folder to write into [default: out/NAME].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Designs at once [default: all cores].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// Options of `sweep`.
#[derive(Debug, Args)]
pub struct SweepOptions {
    /// The sweep file (TOML, or JSON with the same keys).
    pub file: PathBuf,
    /// Folder to write into [default: out/NAME].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Points at once [default: all cores].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Print what there is to do, as JSON, and compute nothing that is kept.
    #[arg(long, conflicts_with_all = ["batch", "gather", "record"])]
    pub plan: bool,
    /// Compute the I-th of N parts only and write no table.
    #[arg(long, value_name = "I/N", value_parser = batch, conflicts_with_all = ["gather", "record"])]
    pub batch: Option<Batch>,
    /// Compute nothing: write the design of every point (of the batch) into designs/, for another solver.
    #[arg(long, conflicts_with_all = ["plan", "gather", "record"])]
    pub designs: bool,
    /// Compute nothing: gather what all parts have computed.
    #[arg(long, conflicts_with = "record")]
    pub gather: bool,
    /// Take results of another solver: one JSON object a line, {"point": 3, "outputs": {...}} or {"point": 3, "failure": "..."}.
    #[arg(long, value_name = "FILE")]
    pub record: Option<PathBuf>,
    /// Gather although points are missing.
    #[arg(long)]
    pub partial: bool,
    /// The CalculiX program, for the model that needs it.
    #[arg(long, value_name = "PROGRAM", default_value = "ccx")]
    pub ccx: PathBuf,
    /// Compute however many points there are and however long it takes.
    #[arg(long)]
    pub yes: bool,
}

fn batch(text: &str) -> Result<Batch, String> {
    let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse::<u64>().ok()?, n.parse::<u64>().ok()?)));
    match numbers {
        Some((index, count)) if (1..=count).contains(&index) => Ok(Batch { index, count }),
        _ => Err("it must be I/N with I from 1 to N, such as 3/10".to_owned()),
    }
}

/// Models that can be pressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum IndentModel {
    /// The graded strip as an elastica; milliseconds.
    Elastica,
    /// The graded strip in finite elements (the mesh of CalculiX's graded deck).
    Graded,
    /// Every voxel in finite elements.
    Voxel,
    /// The graded strip in CalculiX, by the deck graded_solid_indentation.
    Calculix,
}

/// What presses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum IndenterChoice {
    /// A flat rigid plate that moves with the hub and may touch the spokes.
    Flat,
    /// Nothing but the hub is pushed.
    Hub,
}

/// How a strip bends across its width.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum BendingChoice {
    /// Free to curl: modulus E.
    Beam,
    /// Kept straight: modulus E/(1 - nu^2).
    PlaneStrain,
}

/// What flows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Flow {
    /// Heat.
    Heat,
    /// Current.
    Current,
    /// One after the other.
    Both,
}

/// What of it is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Regime {
    /// The state in the long run.
    Steady,
    /// The way there.
    Transient,
    /// Both.
    Both,
}

/// Strips that conduct.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ConductModel {
    /// Every voxel its phase.
    Voxel,
    /// Smooth width, designed mixture.
    Graded,
    /// Both.
    Both,
}

/// Shapes in which they conduct.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ConductShape {
    /// As printed.
    Flat,
    /// At the end of the morph.
    Morphed,
    /// Both.
    Both,
}

/// How current enters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ElectrodeChoice {
    /// Through a contact of one potential.
    Equipotential,
    /// With one density over the cross-section.
    Uniform,
}

/// What a threshold is a share of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ThresholdChoice {
    /// The rise from the start.
    Rise,
    /// The absolute temperature.
    Value,
}

/// Options of `micromechanics`.
#[derive(Debug, Args)]
pub struct MicromechanicsOptions {
    /// The soft and the rigid phase: names from the library, or MPa:POISSON such as 3.1:0.3 [default: FLX9070 FLX9095].
    #[arg(long, num_args = 2, value_names = ["SOFT", "RIGID"])]
    pub phases: Vec<String>,
    /// Take the phases of this design file.
    #[arg(long, value_name = "FILE", conflicts_with = "phases")]
    pub design: Option<PathBuf>,
    /// Voxels along x, y and z.
    #[arg(long, value_enum, default_value_t = CellChoice::Three)]
    pub cell: CellChoice,
    /// Elements along a voxel's edge.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=8))]
    pub elements_per_voxel: u8,
    /// Which element.
    #[arg(long, value_enum, default_value_t = ElementChoice::Enhanced)]
    pub element: ElementChoice,
    /// Clamp the loaded faces instead of letting them slide: the bounds then need not hold.
    #[arg(long)]
    pub clamped: bool,
    /// Also write decks for ABAQUS and CalculiX that test this layout along x, y and z, such as 110/000/001.
    #[arg(long, value_name = "LAYOUT")]
    pub deck: Option<String>,
    /// Folder to write into [default: out/micromechanics].
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// Sizes of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CellChoice {
    /// 16 layouts in 6 classes.
    #[value(name = "2x2x1")]
    Two,
    /// 512 layouts in 102 classes.
    #[value(name = "3x3x1")]
    Three,
    /// 65 536 layouts in 8 548 classes.
    #[value(name = "4x4x1")]
    Four,
}

/// Elements of unit cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ElementChoice {
    /// Bricks with enhanced strains.
    Enhanced,
    /// Trilinear bricks: too stiff on coarse meshes.
    Trilinear,
}

/// Options of `materials`.
#[derive(Debug, Args)]
pub struct MaterialsOptions {
    /// What to do instead of listing them.
    #[command(subcommand)]
    pub command: Option<MaterialsCommand>,
}

/// What `materials` does besides listing.
#[derive(Debug, Subcommand)]
pub enum MaterialsCommand {
    /// Print a custom material from tensile tests: modulus, its scatter over several tests, yield (0.2 % offset), break.
    Fit(FitOptions),
}

/// Options of `materials fit`.
#[derive(Debug, Args)]
pub struct FitOptions {
    /// Tensile curves, one a specimen: columns strain or strain_percent (or extension_mm) and stress_mpa (or force_n).
    #[arg(required = true, value_name = "CURVE.csv")]
    pub curves: Vec<PathBuf>,
    /// Name of the material.
    #[arg(long)]
    pub name: String,
    /// Its Poisson's ratio, which a tensile curve does not tell.
    #[arg(long, allow_negative_numbers = true)]
    pub poisson: f64,
    /// Length over which the extension is measured, mm.
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub gauge_length_mm: Option<f64>,
    /// Area of the specimen's cross-section before the test, mm^2.
    #[arg(long, value_name = "MM2", allow_negative_numbers = true)]
    pub area_mm2: Option<f64>,
    /// Strains between which the modulus is taken [default: 0.0005 0.0025, or the straight part behind a toe or where there are
    /// too few rows].
    #[arg(long, num_args = 2, value_names = ["LOW", "HIGH"], allow_negative_numbers = true)]
    pub window: Option<Vec<f64>>,
    /// Write the material into this file instead.
    #[arg(short, long, value_name = "FILE.toml")]
    pub output: Option<PathBuf>,
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
