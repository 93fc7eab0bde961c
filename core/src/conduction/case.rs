//! Heat and current through the strip of a design: what is asked, and the answer.

use serde::Serialize;

use super::pcg::Watch;
use super::steady::{Apart, Steady};
use super::strip::{Model, Shape, Strip};
use super::transient::Effort;
use super::{ConductionError, current, heat};
use crate::input::ConductionInput;
use crate::materials::{AssumedProperty, Assumption};

/// What flows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Problem {
    /// Heat: the rim at a temperature.
    Heat,
    /// Current: a current in at the rim, the far end grounded.
    Current,
}

impl Problem {
    /// Name of the field and its unit.
    #[must_use]
    pub fn field(self) -> [&'static str; 2] {
        match self {
            Self::Heat => ["temperature", "K"],
            Self::Current => ["potential", "V"],
        }
    }

    /// The property that its transient may have to assume.
    fn assumed(self) -> AssumedProperty {
        match self {
            Self::Heat => AssumedProperty::SpecificHeat,
            Self::Current => AssumedProperty::RelativePermittivity,
        }
    }
}

/// What of it is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Regimes {
    /// The state after a long time.
    pub steady: bool,
    /// The way there.
    pub transient: bool,
}

/// A state in the long run.
#[derive(Debug, Clone, Serialize)]
pub struct SteadyAnswer {
    /// Heat flow, W, or current, A, from the rim to the far end.
    pub flow: f64,
    /// Difference of temperature, K, or potential, V, between the ends.
    pub difference: f64,
    /// Conductivity of the uniform strip of the same shape that lets the same flow through: W/(m K) or S/m.
    pub effective_conductivity: f64,
    /// No arrangement of the same phases in the same places conducts better (Dirichlet's principle): their mean, weighted with the
    /// dissipation in the uniform strip. On a strip of constant cross-section that is by volume, phases side by side.
    pub parallel_bound: f64,
    /// None conducts worse (Thomson's principle): the harmonic mean with the same weights, phases one behind the other.
    pub series_bound: f64,
    /// Largest difference between the flows through neighbouring cross-sections, as a share of the flow.
    pub imbalance: f64,
    /// Largest over smallest conductivity that is present.
    pub contrast: f64,
    /// Iterations of conjugate gradients.
    pub iterations: usize,
    /// Levels of the multigrid hierarchy.
    pub levels: usize,
    /// How phases of extreme contrast were solved apart.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub apart: Option<Apart>,
    /// Value at every node.
    #[serde(skip)]
    pub field: Vec<f64>,
    /// Value at the measuring points.
    pub at_points: Vec<f64>,
}

impl SteadyAnswer {
    pub(super) fn new(
        found: Steady,
        [flow, difference]: [f64; 2],
        effective: f64,
        [parallel, series]: [f64; 2],
        points: &[Vec<(usize, f64)>],
    ) -> Self {
        Self {
            flow,
            difference,
            effective_conductivity: effective,
            parallel_bound: parallel,
            series_bound: series,
            imbalance: found.imbalance,
            contrast: found.contrast,
            iterations: found.iterations.count,
            levels: found.levels,
            apart: found.apart,
            at_points: points.iter().map(|p| at(p, &found.values)).collect(),
            field: found.values,
        }
    }
}

/// The way to it.
#[derive(Debug, Clone, Serialize)]
pub struct TransientAnswer {
    /// Times of the history, s.
    #[serde(skip)]
    pub times: Vec<f64>,
    /// Values at the measuring points (for current first that of the rim), a row a point.
    #[serde(skip)]
    pub history: Vec<Vec<f64>>,
    /// When the points (for current: the rim) got to the threshold, s.
    pub critical_times_s: Vec<Option<f64>>,
    /// Conductivity of the uniform strip of the same shape, and of the same mean capacity, that gets there at the same time, for
    /// the points whose critical time is known: W/(m K); for current from the last potential of the rim, S/m.
    pub effective_conductivities: Vec<Option<f64>>,
    /// Times of the fields, s.
    pub field_times_s: Vec<f64>,
    /// Value at every node at these times.
    #[serde(skip)]
    pub fields: Vec<Vec<f64>>,
    /// Time at which the computation ended, s.
    pub end_s: f64,
    /// Steps and iterations.
    pub effort: Effort,
}

/// The answer to one case.
#[derive(Debug, Clone, Serialize)]
pub struct Answer {
    /// What flows.
    pub problem: Problem,
    /// Through which strip.
    pub model: Model,
    /// In which shape.
    pub shape: Shape,
    /// Nodes of the mesh.
    pub nodes: usize,
    /// Bricks that are not void.
    pub bricks: usize,
    /// Names and volume fractions of the phases.
    pub fractions: Vec<(String, f64)>,
    /// Measuring points as shares of the length from the rim.
    pub measured_at: Vec<f64>,
    /// The state in the long run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady: Option<SteadyAnswer>,
    /// The way there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transient: Option<TransientAnswer>,
    /// Values that nobody measured on these materials.
    pub assumptions: Vec<Assumption>,
    /// What the reader should know.
    pub notes: Vec<String>,
}

/// Solves a case.
///
/// # Errors
/// [`ConductionError`].
pub fn solve(
    strip: &Strip,
    problem: Problem,
    regimes: Regimes,
    input: &ConductionInput,
    watch: Watch<'_>,
) -> Result<Answer, ConductionError> {
    let points: Vec<Vec<(usize, f64)>> = input.measure_at.iter().map(|s| strip.midline_point(*s)).collect();
    let mut notes = Vec::new();
    if strip.model == Model::Graded {
        notes.push(
            "The graded strip conducts in every cross-section as its phases side by side: voxels of the same fractions conduct \
             less, unless they line up."
                .to_owned(),
        );
    }
    let task = Task { strip, input, regimes, points: &points };
    let (steady, transient) = match problem {
        Problem::Heat => heat::solve(&task, watch)?,
        Problem::Current => current::solve(&task, &mut notes, watch)?,
    };
    let names = strip.phases.iter().map(|p| p.name.clone());
    Ok(Answer {
        problem,
        model: strip.model,
        shape: strip.shape,
        nodes: strip.mesh.nodes(),
        bricks: strip.mesh.materials().iter().filter(|m| **m != super::mesh::VOID).count(),
        fractions: names.zip(strip.fractions()).collect(),
        measured_at: input.measure_at.clone(),
        steady,
        transient,
        // Steady states need neither capacities nor permittivities.
        assumptions: if regimes.transient { strip.assumptions(problem.assumed()) } else { Vec::new() },
        notes,
    })
}

/// What both problems need.
pub(super) struct Task<'a> {
    pub(super) strip: &'a Strip,
    pub(super) input: &'a ConductionInput,
    pub(super) regimes: Regimes,
    pub(super) points: &'a [Vec<(usize, f64)>],
}

/// Value at a measuring point.
pub(super) fn at(point: &[(usize, f64)], field: &[f64]) -> f64 {
    point.iter().map(|(node, weight)| weight * field[*node]).sum()
}

/// Bounds on the effective conductivity from the field of the uniform strip: the mean and the harmonic mean of the
/// conductivities, weighted with that field's dissipation.
pub(super) fn bounds(
    strip: &Strip,
    values: &[f64],
    uniform: &[f64],
    watch: Watch<'_>,
) -> Result<[f64; 2], ConductionError> {
    let weights = strip.mesh.dissipations(uniform, values.len(), watch)?;
    let whole: f64 = weights.iter().sum();
    let mean = |f: &dyn Fn(f64) -> f64| {
        weights.iter().zip(values).filter(|(w, _)| **w > 0.0).map(|(w, k)| w / whole * f(*k)).sum::<f64>()
    };
    Ok([mean(&|k| k), 1.0 / mean(&|k| 1.0 / k)])
}

/// The time within a step at which a function gets to zero from below.
pub(super) fn crossing(from: f64, to: f64, excess: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (from, to);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if excess(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}
