//! Why a strip cannot take a shape.

use super::inverse::HubSupport;

/// A design that mechanics rules out, or a forward problem that was not solved.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ElasticaError {
    /// The meridian does not bend, so no modulus follows from it.
    #[error(
        "the meridian is straight: its largest curvature is {largest_curvature:.3e} 1/mm over a length of {length_mm} mm; \
         a target has to bend for a modulus to follow from it"
    )]
    Straight {
        /// 1/mm.
        largest_curvature: f64,
        /// mm.
        length_mm: f64,
    },
    /// A part of the meridian does not bend although the moment does not vanish along it.
    #[error(
        "the meridian is straight from s = {from_mm:.3} mm to s = {to_mm:.3} mm, where an elastic strip would need an \
         infinite modulus; give that part some curvature"
    )]
    StraightPart {
        /// mm from the rim.
        from_mm: f64,
        /// mm from the rim.
        to_mm: f64,
    },
    /// The curvature touches zero without changing sign.
    #[error(
        "the curvature touches zero at s = {at_mm:.3} mm without changing sign, where the modulus would grow without \
         limit; bend the target there or give it a true inflection"
    )]
    TouchingZero {
        /// mm from the rim.
        at_mm: f64,
    },
    /// More inflections than the line of thrust can pass through.
    #[error(
        "the meridian has {count} inflections (s = {positions} mm), but with the hub {} the line of thrust passes through at \
         most {allowed}; {help}",
        .support.name()
    )]
    TooManyInflections {
        /// How many were found.
        count: usize,
        /// Their arc lengths from the rim, formatted.
        positions: String,
        /// How many the support allows.
        allowed: usize,
        /// How the hub is supported.
        support: HubSupport,
        /// What would help.
        help: &'static str,
    },
    /// The modulus would be negative along a part of the strip.
    #[error(
        "the modulus would be negative from s = {from_mm:.3} mm to s = {to_mm:.3} mm (down to {lowest:.3} times its largest \
         value): the moment and the curvature have opposite signs there; {help}"
    )]
    MixedSign {
        /// mm from the rim.
        from_mm: f64,
        /// mm from the rim.
        to_mm: f64,
        /// Most negative modulus over the largest positive one.
        lowest: f64,
        /// What would help.
        help: String,
    },
    /// No line of thrust keeps the modulus positive.
    #[error("no line of thrust keeps the modulus positive along the whole strip with the hub {}; {help}", .support.name())]
    NoThrustLine {
        /// How the hub is supported.
        support: HubSupport,
        /// What would help.
        help: &'static str,
    },
    /// Equal moduli at both ends do not determine the line of thrust.
    #[error(
        "equal moduli at the rim and the hub do not fix the line of thrust because both ends are at the same height \
         (z(L) = {height_mm:.3e} mm); use choice = \"least-contrast\""
    )]
    EqualEndsUndetermined {
        /// mm.
        height_mm: f64,
    },
    /// Equal ends were asked for together with a held hub.
    #[error(
        "choice = \"equal-ends\" fixes the line of thrust without a vertical force; with hub = \"held\" use \"least-contrast\""
    )]
    EqualEndsHeld,
    /// The radius is not positive somewhere, so neither is the width.
    #[error(
        "the radius is {radius_mm:.4} mm at s = {at_mm:.3} mm; it must stay positive for the spokes to have a width: \
         use a larger hub radius or a target that does not cross its axis"
    )]
    NoWidth {
        /// mm.
        radius_mm: f64,
        /// mm from the rim.
        at_mm: f64,
    },
    /// The linear program for the least contrast did not end.
    #[error("the linear program for the least contrast failed: {0}")]
    LinearProgram(String),
    /// Newton's method did not find the equilibrium.
    #[error(
        "the equilibrium at {fraction:.4} of the morph was not found: after {iterations} iterations the end is still \
         {residual_mm:.3e} mm (or rad) off"
    )]
    NoEquilibrium {
        /// Fraction of the morph.
        fraction: f64,
        /// Iterations spent.
        iterations: usize,
        /// Largest residual.
        residual_mm: f64,
    },
}
