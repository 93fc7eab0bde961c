//! What a design must keep.

use serde::{Deserialize, Serialize};

use super::figures::{Figures, Outcome, Press};
use super::objective::Objective;
use crate::input::InputError;

/// The `[limits]` table.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LimitsInput {
    /// Contrast over what the phases reach; 1 where absent, which no design exceeds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contrast_share: Option<f64>,
    /// Largest strain of the faces while the dome is pressed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_strain: Option<f64>,
    /// Vertical force on the hub of the closed dome, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hub_force_n: Option<f64>,
    /// Sides of the printer's volume, mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub printer_volume_mm: Option<[f64; 3]>,
}

/// What a limit bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// Contrast over what the phases reach.
    ContrastShare,
    /// Strain.
    LargestStrain,
    /// Force on the hub, N.
    HubForce,
    /// The side that fits worst over the printer's; the part may be turned about the vertical.
    PrinterVolume([f64; 3]),
}

/// A figure that may be no larger than a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// What it bounds.
    pub bound: Bound,
    /// Largest value.
    pub most: f64,
}

impl LimitsInput {
    pub(super) fn check(&self) -> Result<(), InputError> {
        if let Some(share) = self.contrast_share
            && !(share > 0.0 && share <= 1.0)
        {
            let problem =
                "this must be greater than 0 and at most 1, the share of the phases' contrast that may be used";
            return Err(InputError::new("limits.contrast_share", share, problem));
        }
        let positive = |key: &str, value: f64| match value > 0.0 && value.is_finite() {
            true => Ok(()),
            false => Err(InputError::new(format!("limits.{key}"), value, "this must be greater than 0")),
        };
        self.largest_strain.map_or(Ok(()), |v| positive("largest_strain", v))?;
        self.hub_force_n.map_or(Ok(()), |v| positive("hub_force_n", v))?;
        self.printer_volume_mm.iter().flatten().try_for_each(|v| positive("printer_volume_mm", *v))
    }

    /// The limits, that of the phases' contrast always among them.
    #[must_use]
    pub fn all(&self) -> Vec<Limit> {
        let contrast = Limit { bound: Bound::ContrastShare, most: self.contrast_share.unwrap_or(1.0) };
        let strain = self.largest_strain.map(|most| Limit { bound: Bound::LargestStrain, most });
        let force = self.hub_force_n.map(|most| Limit { bound: Bound::HubForce, most });
        let volume = self.printer_volume_mm.map(|sides| Limit { bound: Bound::PrinterVolume(sides), most: 1.0 });
        [Some(contrast), strain, force, volume].into_iter().flatten().collect()
    }
}

/// How far domes are pressed for an objective under limits.
#[must_use]
pub fn press(objective: Objective, limits: &[Limit]) -> Press {
    let strain = limits.iter().any(|l| l.bound == Bound::LargestStrain);
    match objective {
        _ if strain => Press::Whole,
        Objective::SpecificEnergy => Press::Whole,
        Objective::Rigidity => Press::Rigidity,
        Objective::Printability => Press::Never,
    }
}

impl Limit {
    /// Its key.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self.bound {
            Bound::ContrastShare => "contrast_share",
            Bound::LargestStrain => "largest_strain",
            Bound::HubForce => "hub_force_n",
            Bound::PrinterVolume(_) => "printer_volume_mm",
        }
    }

    /// What a design has of it.
    #[must_use]
    pub fn value(&self, figures: &Figures) -> f64 {
        match self.bound {
            Bound::ContrastShare => figures.contrast / figures.contrast_reach,
            Bound::LargestStrain => figures.largest_strain,
            Bound::HubForce => figures.hub_force_n,
            Bound::PrinterVolume([x, y, z]) => {
                let [a, b, c] = figures.size_mm;
                let flat = (a / x).max(b / y).min((a / y).max(b / x));
                flat.max(c / z)
            }
        }
    }

    /// By what share of the limit an outcome exceeds it; nothing where it keeps it, infinite where it has no such figure.
    #[must_use]
    pub fn excess(&self, outcome: &Outcome) -> f64 {
        let over = |value: f64| if value <= self.most { 0.0 } else { value / self.most - 1.0 };
        match outcome {
            Outcome::Designed(figures) if self.value(figures).is_nan() => f64::INFINITY,
            // The design itself allows for rounding at the phases' whole contrast.
            Outcome::Designed(_) if self.bound == Bound::ContrastShare && self.most >= 1.0 => 0.0,
            Outcome::Designed(figures) => over(self.value(figures)),
            Outcome::Contrast { share, .. } if self.bound == Bound::ContrastShare => over(*share),
            Outcome::Contrast { .. } | Outcome::Refused { .. } => 0.0,
        }
    }

    /// The same limit, a share wider; `None` where nothing can be wider: no phases reach more than their contrast.
    #[must_use]
    pub fn relaxed(&self, share: f64) -> Option<Self> {
        let most = match self.bound {
            Bound::ContrastShare => (self.most * (1.0 + share)).min(1.0),
            _ => self.most * (1.0 + share),
        };
        (most > self.most).then_some(Self { most, ..*self })
    }
}
