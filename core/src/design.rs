//! The design pipeline: target -> widths -> modulus -> voxels -> predicted shape.

mod reach;
mod warnings;

use std::sync::{Arc, OnceLock};

use crate::elastica::forward::{EndForces, Equilibrium, Section, StripStiffness};
use crate::elastica::inverse::{self, HubSupport, InverseSolution, ThrustChoice};
use crate::elastica::morph::{Guide, MorphPath};
use crate::elastica::{ElasticaError, tessellation};
use crate::error::Error;
use crate::input::{DesignInput, TargetInput};
use crate::micromechanics::calibration::{MixtureRule, calibrate};
use crate::micromechanics::{Fractions, PhaseSet, voigt};
use crate::modulus_field::{ModulusField, ModulusFieldError};
use crate::profile::Profile;
use crate::progress::{self, Cancelled};
use crate::target::{MeridianCurve, MeridianPoint, Target, resolve};
use crate::voxel::counts::{Filling, fill_unless};
use crate::voxel::{Lattice, LatticeError, Match, Slice, SliceTarget, VoxelGrid};

/// Stations of the profile, evenly spaced, ends included.
pub const STATIONS: usize = 1001;

/// Voxels above which work is refused unless it was asked for explicitly.
pub const LARGEST_VOXELS: u64 = 200_000_000;

/// What a computation may do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Limits {
    /// Allow more than [`LARGEST_VOXELS`] voxels.
    pub allow_large: bool,
}

/// What the strip is made to follow.
#[derive(Debug, Clone)]
enum Body {
    /// A spoke of a dome.
    Dome { curve: Arc<dyn MeridianCurve>, solution: InverseSolution, hub_x: f64 },
    /// A rectangular strip; the modulus in the middle over that at the ends.
    Strip { width_mm: f64, middle_ratio: f64 },
}

/// A finished design, computed in memory; nothing is read or written.
pub struct Design {
    input: DesignInput,
    phases: PhaseSet,
    target: Option<Target>,
    body: Body,
    contrast: f64,
    scale_mpa: f64,
    rule: Option<Arc<MixtureRule>>,
    profile: Profile,
    grid: VoxelGrid,
    slices: Vec<Slice>,
    guide: Option<Guide>,
    forces: EndForces,
    graded_path: OnceLock<Result<Option<MorphPath>, ElasticaError>>,
    voxel_path: Option<MorphPath>,
    predicted_error: Option<f64>,
    warnings: Vec<String>,
    modulus_field: OnceLock<Result<ModulusField, ModulusFieldError>>,
}

impl Design {
    /// Computes a design.
    ///
    /// # Errors
    /// [`Error::Input`] for a target or a voxel size that cannot be used, [`Error::Infeasible`] where mechanics or the
    /// phases rule the design out.
    pub fn compute(input: &DesignInput, limits: Limits) -> Result<Self, Error> {
        Self::compute_unless(input, limits, &progress::never)
    }

    /// Computes a design unless it is cancelled: `cancelled` is asked between the steps and before every slice of voxels.
    ///
    /// # Errors
    /// Those of [`Design::compute`], and [`Error::Cancelled`].
    pub fn compute_unless(input: &DesignInput, limits: Limits, cancelled: Cancelled<'_>) -> Result<Self, Error> {
        input.validate()?;
        let phases = input.phase_set()?;
        let size = input.voxels.size_mm;
        let lattice = Lattice::new(input.strips.length_mm, input.strips.thickness_mm, size)
            .map_err(|error| Error::lattice(size, &error))?;

        let go_on = || if cancelled() { Err(Error::Cancelled) } else { Ok(()) };
        let target = resolve(input)?;
        go_on()?;
        let body = solve_body(input, target.as_ref())?;
        let contrast = body.contrast();
        reach::check(input, &phases, &body, target.as_ref())?;

        let outline = outline(input, &lattice, &body, limits)?;
        let rule = mixture_rule(input, &phases, lattice.layers, cancelled)?;
        let scale_mpa =
            scale(input, &phases, rule.as_deref(), &lattice, &outline, voxel_contrast(input, &outline, contrast));
        let targets: Vec<SliceTarget> = outline
            .iter()
            .map(|o| SliceTarget {
                width_mm: o.width_mm,
                modulus_mpa: scale_mpa * o.ratio * o.correction,
                half_width: o.half_width,
            })
            .collect();
        let filling = Filling {
            phases: &phases,
            pattern: input.voxels.pattern,
            seed: input.voxels.seed,
            matching: input.voxels.matching,
            rule: rule.as_deref(),
        };
        let (grid, slices) = fill_unless(&lattice, &targets, &filling, cancelled).ok_or(Error::Cancelled)?;

        let guide = guide(input, target.as_ref());
        let mut design = Self {
            forces: designed_forces(&body, scale_mpa, input.strips.thickness_mm),
            input: input.clone(),
            phases,
            target,
            body,
            contrast,
            scale_mpa,
            rule,
            profile: Profile::default(),
            grid,
            slices,
            guide,
            graded_path: OnceLock::new(),
            voxel_path: None,
            predicted_error: None,
            warnings: Vec::new(),
            modulus_field: OnceLock::new(),
        };
        design.profile = design.sample_profile()?;
        go_on()?;
        design.predict();
        design.collect_warnings();
        Ok(design)
    }

    /// The input, defaults filled in.
    #[must_use]
    pub fn input(&self) -> &DesignInput {
        &self.input
    }

    /// The phases, softest first.
    #[must_use]
    pub fn phases(&self) -> &PhaseSet {
        &self.phases
    }

    /// The target; absent for a rectangular strip.
    #[must_use]
    pub fn target(&self) -> Option<&Target> {
        self.target.as_ref()
    }

    /// The solution of the inverse problem; absent for a rectangular strip.
    #[must_use]
    pub fn inverse(&self) -> Option<&InverseSolution> {
        match &self.body {
            Body::Dome { solution, .. } => Some(solution),
            Body::Strip { .. } => None,
        }
    }

    /// Largest over smallest designed modulus.
    #[must_use]
    pub fn contrast(&self) -> f64 {
        self.contrast
    }

    /// Largest designed modulus, MPa.
    #[must_use]
    pub fn peak_modulus(&self) -> f64 {
        self.scale_mpa
    }

    /// The profile at [`STATIONS`] stations.
    #[must_use]
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// The voxels of a spoke.
    #[must_use]
    pub fn grid(&self) -> &VoxelGrid {
        &self.grid
    }

    /// The slices of a spoke, rim first.
    #[must_use]
    pub fn slices(&self) -> &[Slice] {
        &self.slices
    }

    /// How the ends of a spoke are moved; absent for a strip that is only stretched.
    #[must_use]
    pub fn guide(&self) -> Option<&Guide> {
        self.guide.as_ref()
    }

    /// Forces that one spoke of the smooth design carries at the end of the morph, beam bending, N and N mm.
    #[must_use]
    pub fn forces(&self) -> EndForces {
        self.forces
    }

    /// Smooth width (mm) and designed modulus (MPa) at arc length `s`.
    #[must_use]
    pub fn width_and_modulus(&self, s: f64) -> (f64, f64) {
        let (width, ratio) = self.body.local(&self.input, s);
        (width, self.scale_mpa * ratio)
    }

    /// The morph of the smooth, graded strip; absent for a strip that is only stretched.
    ///
    /// # Errors
    /// [`ElasticaError::NoEquilibrium`] where its final shape is not found.
    pub fn graded_path(&self) -> Result<Option<&MorphPath>, ElasticaError> {
        let path = self.graded_path.get_or_init(|| {
            let Some(guide) = self.guide.clone() else { return Ok(None) };
            MorphPath::new(self.graded_stiffness(), guide, self.forces).map(Some)
        });
        path.as_ref().map(Option::as_ref).map_err(Clone::clone)
    }

    /// The morph that the forward model predicts for the voxelised strip, where it was found.
    #[must_use]
    pub fn voxel_path(&self) -> Option<&MorphPath> {
        self.voxel_path.as_ref()
    }

    /// Largest distance of the voxelised strip's predicted mid-line from the target, as a share of the length.
    #[must_use]
    pub fn predicted_error(&self) -> Option<f64> {
        self.predicted_error
    }

    /// The modulus as one expression, fitted when first asked for: it takes longer than the rest of the design.
    ///
    /// # Errors
    /// [`ModulusFieldError`] for a profile that no expression can be fitted to, which a finished design has not.
    pub fn modulus_field(&self) -> Result<&ModulusField, ModulusFieldError> {
        let length = self.input.strips.length_mm;
        let fit = || ModulusField::fit(&self.profile.s, &self.profile.modulus_mpa, length);
        self.modulus_field.get_or_init(fit).as_ref().map_err(Clone::clone)
    }

    /// What the user should know about this design.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Mean Poisson's ratio of a spoke, by volume.
    #[must_use]
    pub fn mean_poisson(&self) -> f64 {
        let counts = self.grid.counts(self.phases.phases().len());
        let total = counts.iter().sum::<u64>().max(1) as f64;
        self.phases.phases().iter().zip(&counts).map(|(p, n)| p.poisson * *n as f64 / total).sum()
    }

    /// The calibrated mixture rule, where the design matches by one.
    #[must_use]
    pub fn mixture_rule(&self) -> Option<&MixtureRule> {
        self.rule.as_deref()
    }

    /// Fractions of the phases that a modulus takes by the design's mixture rule.
    #[must_use]
    pub fn fractions(&self, modulus_mpa: f64) -> Fractions {
        let plain = self.phases.fractions(modulus_mpa);
        self.rule.as_ref().map_or(plain, |rule| {
            let rigid = rule.fraction(modulus_mpa);
            Fractions { values: [1.0 - rigid, rigid, 0.0], ..plain }
        })
    }

    /// Fraction of the stiffest phase that a modulus takes by the design's mixture rule.
    #[must_use]
    pub fn rigid_fraction(&self, modulus_mpa: f64) -> f64 {
        self.fractions(modulus_mpa).values[self.phases.phases().len() - 1]
    }

    fn graded_stiffness(&self) -> StripStiffness {
        self.graded_stiffness_times(|_| 1.0)
    }

    /// The stiffness of the smooth strip, multiplied by a factor of the share of the length.
    pub(crate) fn graded_stiffness_times(&self, factor: impl Fn(f64) -> f64) -> StripStiffness {
        let third = self.input.strips.thickness_mm.powi(3) / 12.0;
        let last = 2 * (STATIONS - 1);
        let length = self.input.strips.length_mm;
        let section = |i: usize| {
            let share = i as f64 / last as f64;
            let (width, modulus) = self.width_and_modulus(length * share);
            Section { stiffness: factor(share) * width * modulus * third, neutral_offset: 0.0 }
        };
        StripStiffness::Smooth((0..=last).map(section).collect())
    }

    /// The profile: the target, or for a rectangular strip the shape its smooth stiffness takes.
    fn sample_profile(&self) -> Result<Profile, Error> {
        let length = self.input.strips.length_mm;
        let mut profile = Profile::with_capacity(STATIONS);
        let shape = match (&self.target, self.guide.is_some()) {
            (Some(_), _) | (None, false) => None,
            (None, true) => self.graded_path().map_err(|e| Error::infeasible(&self.input.name, e))?,
        };
        let shape = shape.map(MorphPath::final_shape);
        let hub_x = match (&self.target, shape) {
            (Some(target), _) => target.stations.last().map_or(0.0, |p| p.x),
            (None, Some(shape)) => shape.x.last().copied().unwrap_or(length),
            (None, None) => length,
        };
        for i in 0..STATIONS {
            let s = length * i as f64 / (STATIONS - 1) as f64;
            let (inclination, x, z) = match (&self.target, shape) {
                (Some(target), _) => {
                    let p = &target.stations[i];
                    (p.inclination, p.x, p.z)
                }
                (None, Some(shape)) => {
                    let [x, z] = shape.position(s);
                    (shape.inclination_at(s), x, z)
                }
                (None, None) => (0.0, s, 0.0),
            };
            let (width, ratio) = match (&self.body, self.inverse()) {
                (Body::Dome { .. }, Some(solution)) => {
                    (self.body.local_width(&self.input, x), solution.modulus_ratio[i])
                }
                _ => self.body.local(&self.input, s),
            };
            let modulus = self.scale_mpa * ratio;
            profile.s.push(s);
            profile.inclination.push(inclination);
            profile.x.push(x);
            profile.z.push(z);
            profile.rho.push(self.input.hub_radius() + hub_x - x);
            profile.width.push(width);
            profile.modulus_ratio.push(ratio);
            profile.modulus_mpa.push(modulus);
            profile.rigid_fraction.push(self.rigid_fraction(modulus));
        }
        Ok(profile)
    }

    /// The final shape by the elastica of the voxels as they are, whatever a refinement found them to lack.
    pub(crate) fn shape_of_slices(&self) -> Option<MorphPath> {
        let stiffness = StripStiffness::Slices(self.slices.iter().map(|s| s.section).collect());
        MorphPath::new(stiffness, self.guide.clone()?, self.forces).ok()
    }

    /// The shape the voxelised strip takes, and how far it is from the target. What a refinement found the mixture to lack
    /// is taken off the sections' stiffness again.
    fn predict(&mut self) {
        let Some(guide) = self.guide.clone() else { return };
        let section =
            |s: &Slice| Section { stiffness: s.section.stiffness / correction(&self.input, s.s_mm), ..s.section };
        let stiffness = StripStiffness::Slices(self.slices.iter().map(section).collect());
        match MorphPath::new(stiffness, guide, self.forces) {
            Ok(path) => {
                self.predicted_error =
                    Some(self.profile.largest_distance(path.final_shape()) / self.input.strips.length_mm);
                self.voxel_path = Some(path);
            }
            Err(error) => {
                self.warnings.push(format!("the shape of the voxelised strip could not be predicted: {error}"))
            }
        }
    }
}

impl std::fmt::Debug for Design {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Design")
            .field("name", &self.input.name)
            .field("contrast", &self.contrast)
            .finish_non_exhaustive()
    }
}

impl Body {
    fn contrast(&self) -> f64 {
        match self {
            Self::Dome { solution, .. } => solution.contrast,
            Self::Strip { middle_ratio, .. } => middle_ratio.max(1.0 / middle_ratio),
        }
    }

    fn local_width(&self, input: &DesignInput, x: f64) -> f64 {
        match self {
            Self::Dome { hub_x, .. } => tessellation::width(input.count(), input.hub_radius() + hub_x - x),
            Self::Strip { width_mm, .. } => *width_mm,
        }
    }

    /// Width (mm) and `E / max E` at arc length `s`.
    fn local(&self, input: &DesignInput, s: f64) -> (f64, f64) {
        match self {
            Self::Dome { curve, solution, .. } => {
                let point = curve.at(s);
                let width = self.local_width(input, point.x);
                (width, solution.ratio_at(&point, width, curve.length()))
            }
            Self::Strip { width_mm, middle_ratio } => {
                let from_end = 1.0 - (2.0 * s / input.strips.length_mm - 1.0).abs();
                (*width_mm, (1.0 + (middle_ratio - 1.0) * from_end) / middle_ratio.max(1.0))
            }
        }
    }
}

fn solve_body(input: &DesignInput, target: Option<&Target>) -> Result<Body, Error> {
    let infeasible = |error: ElasticaError| Error::infeasible(&input.name, error);
    match (&input.target, target) {
        (TargetInput::Strip { width_mm, modulus_ratio, .. }, _) => {
            Ok(Body::Strip { width_mm: *width_mm, middle_ratio: modulus_ratio.unwrap_or(1.0) })
        }
        (_, Some(target)) => {
            let (support, choice) = thrust(input);
            let hub_x = target.stations.last().map_or(0.0, |p| p.x);
            let widths = widths(input, &target.stations, hub_x).map_err(infeasible)?;
            let solution = inverse::solve(target.curve.as_ref(), &target.stations, &widths, support, choice)
                .map_err(infeasible)?;
            Ok(Body::Dome { curve: Arc::clone(&target.curve), solution, hub_x })
        }
        (_, None) => Err(Error::Internal("a dome without a meridian".to_owned())),
    }
}

fn widths(input: &DesignInput, stations: &[MeridianPoint], hub_x: f64) -> Result<Vec<f64>, ElasticaError> {
    tessellation::widths(input.count(), stations.iter().map(|p| (p.s, input.hub_radius() + hub_x - p.x)))
}

fn thrust(input: &DesignInput) -> (HubSupport, ThrustChoice) {
    input
        .thrust
        .as_ref()
        .map_or((HubSupport::Free, ThrustChoice::EqualEnds), |thrust| (thrust.hub, thrust.resolved_choice()))
}

/// A slice before its modulus has a scale.
struct Outline {
    width_mm: f64,
    ratio: f64,
    /// Factor by which the voxels' modulus is raised because the mixture bends more softly than its mean modulus says.
    correction: f64,
    half_width: usize,
}

fn outline(input: &DesignInput, lattice: &Lattice, body: &Body, limits: Limits) -> Result<Vec<Outline>, Error> {
    let largest = if limits.allow_large { u64::MAX } else { LARGEST_VOXELS };
    // The widest slice bounds the count before any memory is taken.
    let widest = match body {
        Body::Dome { .. } => tessellation::width(input.count(), input.hub_radius() + input.strips.length_mm),
        Body::Strip { width_mm, .. } => *width_mm,
    };
    let slices: Vec<Outline> = if lattice.slices as u64 > largest {
        Vec::new()
    } else {
        (0..lattice.slices)
            .map(|i| {
                let (width_mm, ratio) = body.local(input, lattice.centre(i));
                let correction = correction(input, lattice.centre(i));
                Outline { width_mm, ratio, correction, half_width: lattice.half_width(width_mm, input.voxels.rounding) }
            })
            .collect()
    };
    let voxels = if slices.is_empty() {
        lattice.slices as f64 * lattice.layers as f64 * widest / lattice.size_mm
    } else {
        slices.iter().map(|o| 2.0 * o.half_width as f64).sum::<f64>() * lattice.layers as f64
    };
    if voxels > largest as f64 {
        let help = " or ask for it with --yes";
        let error = LatticeError::TooMany { voxels, limit: largest as f64, help };
        return Err(Error::lattice(lattice.size_mm, &error));
    }
    Ok(slices)
}

/// The factor of the voxels' modulus that a refinement found at arc length `s`.
fn correction(input: &DesignInput, s: f64) -> f64 {
    input.refine.as_ref().map_or(1.0, |refine| refine.factor(s / input.strips.length_mm))
}

/// Largest over smallest modulus that the voxels are to have.
fn voxel_contrast(input: &DesignInput, outline: &[Outline], contrast: f64) -> f64 {
    if input.refine.as_ref().is_none_or(|refine| refine.correction.is_empty()) {
        return contrast;
    }
    let moduli = || outline.iter().map(|o| o.ratio * o.correction);
    moduli().fold(f64::MIN, f64::max) / moduli().fold(f64::MAX, f64::min)
}

/// The largest modulus, MPa: the phases' default, reduced so that no slice of whole voxels needs more than it, or raised
/// where the softest slice would else need less than the softest phase and the stiffest phase allows it.
fn scale(
    input: &DesignInput,
    phases: &PhaseSet,
    rule: Option<&MixtureRule>,
    lattice: &Lattice,
    outline: &[Outline],
    contrast: f64,
) -> f64 {
    if let TargetInput::Strip { rigid_fraction: Some(rigid), .. } = input.target {
        if let Some(rule) = rule {
            return rule.modulus(rigid);
        }
        return uniform_modulus(phases, rigid, input.materials.intermediate_fraction);
    }
    let peak = phases.default_peak(contrast);
    let need = |o: &Outline| o.ratio * o.correction * o.width_mm / (2.0 * o.half_width as f64 * lattice.size_mm);
    let needs = || outline.iter().map(need);
    let (most, least) = (needs().fold(1.0, f64::max), needs().fold(1.0 / contrast, f64::min));
    let (default, highest) = (peak / most, phases.stiffest() / most);
    (phases.softest() / least).clamp(default, highest.max(default))
}

/// The mixture rule of `match = "calibrated"`.
fn mixture_rule(
    input: &DesignInput,
    phases: &PhaseSet,
    layers: usize,
    cancelled: Cancelled<'_>,
) -> Result<Option<Arc<MixtureRule>>, Error> {
    if input.voxels.matching != Match::Calibrated {
        return Ok(None);
    }
    let rule = calibrate(phases, input.voxels.pattern, layers, cancelled);
    rule.map(Some).map_err(|error| Error::calibration(&error))
}

/// Voigt modulus of a uniform strip with a given fraction of the stiffest phase.
fn uniform_modulus(phases: &PhaseSet, rigid: f64, intermediate: f64) -> f64 {
    let moduli = phases.moduli();
    if moduli.len() == 3 {
        let kept = intermediate.min(1.0 - rigid);
        voigt(&[1.0 - rigid - kept, kept, rigid], &moduli)
    } else {
        voigt(&[1.0 - rigid, rigid], &moduli)
    }
}

fn guide(input: &DesignInput, target: Option<&Target>) -> Option<Guide> {
    match (&input.target, target) {
        (TargetInput::Strip { shortening, .. }, _) => {
            shortening.map(|shortening| Guide::Clamped { length_mm: input.strips.length_mm, shortening })
        }
        (_, Some(target)) => Some(Guide::Target { stations: target.stations.clone(), support: thrust(input).0 }),
        (_, None) => None,
    }
}

fn designed_forces(body: &Body, scale_mpa: f64, thickness_mm: f64) -> EndForces {
    match body {
        Body::Dome { solution, .. } => {
            let unit = scale_mpa * thickness_mm.powi(3) / 12.0;
            EndForces {
                rim_moment: unit * solution.thrust.moment(0.0, 0.0),
                horizontal: unit * solution.thrust.horizontal,
                vertical: unit * solution.thrust.vertical,
            }
        }
        Body::Strip { .. } => EndForces::default(),
    }
}

impl Profile {
    /// Largest distance between a shape and the profile at equal arc lengths, mm.
    #[must_use]
    pub fn largest_distance(&self, shape: &Equilibrium) -> f64 {
        (0..self.s.len())
            .map(|i| {
                let [x, z] = shape.position(self.s[i]);
                (x - self.x[i]).hypot(z - self.z[i])
            })
            .fold(0.0, f64::max)
    }
}
