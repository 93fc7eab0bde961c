//! Where designs are looked for: variables and what they may be.
//!
//! A place has one number a variable: of choices and steps their index, of ranges the share of the way.

use serde_json::Value;

use super::input::VariableInput;
use crate::input::InputError;
use crate::input::parameters::{Kind, parameter};
use crate::sweep::axis::{AxisInput, Spacing};
use crate::sweep::base::Base;

/// Steps of a variable that are all tried around the best design.
const FEW_STEPS: usize = 8;
/// Most steps of a variable.
const MOST_STEPS: f64 = 1e6;
/// How near to an end a place in a range is said to be at it, share of the range: a simplex stops a little short of it.
const NEAR: f64 = 0.02;
/// Lengths that whole voxels must divide.
const ON_THE_LATTICE: [&str; 2] = ["strips.length_mm", "strips.thickness_mm"];

/// A key and what it may be.
#[derive(Debug, Clone)]
pub struct Variable {
    axis: AxisInput,
    kind: VariableKind,
}

/// How the values of a variable lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VariableKind {
    /// Without order.
    Choice {
        /// How many.
        count: usize,
    },
    /// At equal distances.
    Steps {
        /// The first.
        from: f64,
        /// The distance.
        step: f64,
        /// How many.
        count: usize,
    },
    /// Anywhere between two ends.
    Range,
}

/// All variables.
#[derive(Debug, Clone)]
pub struct Space {
    variables: Vec<Variable>,
}

impl Space {
    /// The space of some variables.
    ///
    /// # Errors
    /// [`InputError`] naming the variable's key.
    pub fn new(inputs: &[VariableInput], base: &Base) -> Result<Self, InputError> {
        let lattice = inputs.iter().all(|v| v.key != "voxels.size_mm").then(|| base.number("voxels.size_mm")).flatten();
        let kind = base.target_kind();
        let variables = inputs.iter().enumerate().map(|(i, input)| variable(i, input, kind, lattice));
        Ok(Self { variables: variables.collect::<Result<_, _>>()? })
    }

    /// The variables.
    #[must_use]
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// The nearest place that exists.
    #[must_use]
    pub fn snap(&self, place: &[f64]) -> Vec<f64> {
        let snap = |(v, p): (&Variable, &f64)| match v.count() {
            Some(count) => p.round().clamp(0.0, (count - 1) as f64),
            None => p.clamp(0.0, 1.0),
        };
        self.variables.iter().zip(place).map(snap).collect()
    }

    /// The place at shares of every variable, in `[0, 1)`.
    #[must_use]
    pub fn at_shares(&self, shares: impl Iterator<Item = f64>) -> Vec<f64> {
        let place = |(v, share): (&Variable, f64)| v.count().map_or(share, |count| (share * count as f64).floor());
        let places: Vec<f64> = self.variables.iter().zip(shares).map(place).collect();
        self.snap(&places)
    }

    /// Values of a place.
    #[must_use]
    pub fn values(&self, place: &[f64]) -> Vec<Value> {
        self.variables.iter().zip(place).map(|(v, p)| v.value(*p)).collect()
    }

    /// Number of places; `None` where a variable has a range.
    #[must_use]
    pub fn size(&self) -> Option<u64> {
        self.variables.iter().try_fold(1_u64, |size, v| Some(size.saturating_mul(v.count()? as u64)))
    }

    /// A place of a finite space by its number.
    #[must_use]
    pub fn numbered(&self, number: u64) -> Vec<f64> {
        let mut rest = number;
        let mut place = |v: &Variable| {
            let count = v.count().unwrap_or(1) as u64;
            let index = rest % count;
            rest /= count;
            index as f64
        };
        self.variables.iter().map(&mut place).collect()
    }

    /// Numbers of the variables that have an order.
    #[must_use]
    pub fn ordered(&self) -> Vec<usize> {
        (0..self.variables.len()).filter(|k| !matches!(self.variables[*k].kind, VariableKind::Choice { .. })).collect()
    }

    /// Numbers of the variables with ranges.
    #[must_use]
    pub fn ranges(&self) -> Vec<usize> {
        (0..self.variables.len()).filter(|k| self.variables[*k].kind == VariableKind::Range).collect()
    }

    /// The choices of a place: designs of one branch differ by numbers only.
    #[must_use]
    pub fn branch(&self, place: &[f64]) -> Vec<u64> {
        let choice = |(v, p): (&Variable, &f64)| matches!(v.kind, VariableKind::Choice { .. }).then_some(*p as u64);
        self.variables.iter().zip(place).filter_map(choice).collect()
    }

    /// Places that differ by another choice or by one step, where there are few (`FEW_STEPS`) by any number of them: an objective
    /// may first fall with the number of spokes, say, and then rise.
    #[must_use]
    pub fn neighbours(&self, place: &[f64]) -> Vec<Vec<f64>> {
        let mut all = Vec::new();
        for (k, variable) in self.variables.iter().enumerate() {
            let others: Vec<f64> = match variable.kind {
                VariableKind::Choice { count } => (0..count).map(|i| i as f64).filter(|i| *i != place[k]).collect(),
                VariableKind::Steps { count, .. } if count <= FEW_STEPS => {
                    let mut others: Vec<f64> = (0..count).map(|i| i as f64).filter(|i| *i != place[k]).collect();
                    others.sort_by(|a, b| (a - place[k]).abs().total_cmp(&(b - place[k]).abs()));
                    others
                }
                VariableKind::Steps { count, .. } => {
                    [place[k] - 1.0, place[k] + 1.0].into_iter().filter(|i| *i >= 0.0 && *i < count as f64).collect()
                }
                VariableKind::Range => Vec::new(),
            };
            all.extend(others.into_iter().map(|other| {
                let mut next = place.to_vec();
                next[k] = other;
                next
            }));
        }
        all
    }
}

impl Variable {
    /// Its key.
    #[must_use]
    pub fn key(&self) -> &str {
        &self.axis.key
    }

    /// How its values lie.
    #[must_use]
    pub fn kind(&self) -> VariableKind {
        self.kind
    }

    /// Number of its values; `None` for a range.
    #[must_use]
    pub fn count(&self) -> Option<usize> {
        match self.kind {
            VariableKind::Choice { count } | VariableKind::Steps { count, .. } => Some(count),
            VariableKind::Range => None,
        }
    }

    /// Its value at a place.
    #[must_use]
    pub fn value(&self, place: f64) -> Value {
        match self.kind {
            VariableKind::Choice { .. } => {
                self.axis.values.as_ref().and_then(|v| v.get(place as usize)).cloned().unwrap_or_default()
            }
            VariableKind::Steps { from, step, .. } => self.axis.number(from + step * place),
            VariableKind::Range => self.axis.at(place),
        }
    }

    /// At which end of its values a place is.
    #[must_use]
    pub fn end(&self, place: f64) -> Option<&'static str> {
        let (last, near) = match self.kind {
            VariableKind::Choice { .. } => return None,
            // Of steps every one counts.
            VariableKind::Steps { count, .. } => ((count - 1) as f64, 0.0),
            VariableKind::Range => (1.0, NEAR),
        };
        match place {
            p if p <= near => Some("lower"),
            p if p >= last - near => Some("upper"),
            _ => None,
        }
    }
}

fn variable(i: usize, input: &VariableInput, target: &str, lattice: Option<f64>) -> Result<Variable, InputError> {
    let at = |name: &str| format!("variables.{i}.{name}");
    let axis = AxisInput {
        key: input.key.clone(),
        values: input.values.clone(),
        from: input.from,
        to: input.to,
        count: None,
        spacing: input.spacing,
    };
    axis.check(&format!("variables.{i}"), target)?;
    let (Some(from), Some(to)) = (input.from, input.to) else {
        if let Some(step) = input.step {
            return Err(InputError::new(at("step"), step, "a list of values has no steps"));
        }
        let count = input.values.as_ref().map_or(0, Vec::len);
        return Ok(Variable { axis, kind: VariableKind::Choice { count } });
    };
    if from >= to {
        return Err(InputError::new(at("to"), to, "the range is empty").help(format!("let to be more than {from}")));
    }
    let whole = matches!(parameter(&input.key).map(|p| p.kind), Some(Kind::Integer { .. }));
    let on_lattice = ON_THE_LATTICE.contains(&input.key.as_str());
    let step = match input.step {
        None if whole => Some(1.0),
        None if on_lattice => lattice,
        given => given,
    };
    let Some(step) = step else {
        return Ok(Variable { axis, kind: VariableKind::Range });
    };
    if !(step > 0.0 && step <= to - from) || (whole && step.fract() != 0.0) {
        let whole = if whole { ", a whole number" } else { "" };
        let problem = format!("a step must be greater than 0 and at most the range{whole}");
        return Err(InputError::new(at("step"), step, problem));
    }
    if input.spacing == Some(Spacing::Log) {
        return Err(InputError::new(at("spacing"), "\"log\"", "steps are linear").help("leave spacing out"));
    }
    // Whole numbers lie within the range; steps of whole voxels start at the first one in it.
    let first = match (input.step, whole) {
        (None, true) => from.ceil(),
        (None, false) => (from / step - 1e-9).ceil() * step,
        (Some(_), _) => from,
    };
    let count = ((to - first) / step + 1e-9).floor() + 1.0;
    if !(1.0..=MOST_STEPS).contains(&count) {
        let problem = format!("the range has no step of {step}, or more than {MOST_STEPS}");
        return Err(InputError::new(at("to"), to, problem));
    }
    Ok(Variable { axis, kind: VariableKind::Steps { from: first, step, count: count as usize } })
}
