//! `*INSTANCE`, `*TRANSFORM` and `*ORIENTATION`: a spoke's own axes.
//!
//! Local 1 points inward from rim to hub, 2 across, 3 up, so one set of boundary conditions serves all spokes. A nodal
//! system stays fixed in space, a material's turns with the shell.

use crate::deck::DeckError;
use crate::deck::number::real;
use crate::deck::sink::Sink;

/// A part, turned about the vertical axis.
pub(crate) fn instance(sink: &mut Sink<'_>, name: &str, part: &str, azimuth_deg: f64) -> Result<(), DeckError> {
    sink.line(&format!("*INSTANCE, NAME={name}, PART={part}"))?;
    if azimuth_deg != 0.0 {
        // A rotation is always the second line: the first is the translation.
        sink.line("0,0,0")?;
        sink.line(&format!("0,0,0,0,0,1,{}", real(azimuth_deg)))?;
    }
    sink.line("*END INSTANCE")
}

/// Degrees of freedom of a node set in the axes of a spoke that points along `outward`.
pub(crate) fn transform(sink: &mut Sink<'_>, set: &str, outward: [f64; 2]) -> Result<(), DeckError> {
    sink.line(&format!("*TRANSFORM, NSET={set}, TYPE=R"))?;
    sink.line(&axes(outward))
}

/// Stresses and strains in the axes of a spoke that points along `outward`.
pub(crate) fn orientation(sink: &mut Sink<'_>, name: &str, outward: [f64; 2]) -> Result<(), DeckError> {
    sink.line(&format!("*ORIENTATION, NAME={name}, SYSTEM=RECTANGULAR"))?;
    sink.line(&axes(outward))?;
    // Direction 3 is the normal; no further rotation about it.
    sink.line("3,0")
}

/// A point on axis 1 and one in the plane of axes 1 and 2.
fn axes([cos, sin]: [f64; 2]) -> String {
    format!("{},{},0,{},{},0", real(-cos), real(-sin), real(sin), real(-cos))
}
