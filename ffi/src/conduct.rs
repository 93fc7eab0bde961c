//! Heat and current through a design's strip.

use std::ffi::c_void;

use voxelastica_core::Design;
use voxelastica_core::conduction::case::{Answer, Problem, Regimes, solve};
use voxelastica_core::conduction::pcg;
use voxelastica_core::conduction::strip::{Model, Shape, Strip};

use crate::arguments::Out;
use crate::boundary::enter;
use crate::design::DesignObject;
use crate::error::ErrorObject;
use crate::failure::Failure;
use crate::input::to_json;
use crate::progress::{ProgressCallback, Watch, with_callback};
use crate::registry::{find, keep};
use crate::status::Status;
use crate::text::Text;

/// What flows.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// Heat: the rim at a temperature.
    Heat = 0,
    /// Current: in at the rim, the far end grounded.
    Current = 1,
}

/// The shape it flows through.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ConductShape {
    /// The flat strip.
    Flat = 0,
    /// The closed one, as the forward model predicts it.
    Morphed = 1,
}

/// What of it is computed.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// The state after a long time.
    Steady = 0,
    /// The way there.
    Transient = 1,
    /// Both.
    Both = 2,
}

/// A case, as numbers that come from a host.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Case {
    /// A [`Flow`].
    pub flow: i32,
    /// A `voxelastica_solved_model`.
    pub model: i32,
    /// A [`ConductShape`].
    pub shape: i32,
    /// A [`Regime`].
    pub regime: i32,
}

/// Solves a case while being watched; temperatures, currents and times are the design's (its table `conduction`).
///
/// # Errors
/// [`Failure`] for numbers that mean nothing, phases without the property, parts that nothing flows to, cancellation.
pub fn conduct(design: &Design, case: Case, watch: &Watch) -> Result<Answer, Failure> {
    let problem = match case.flow {
        0 => Problem::Heat,
        1 => Problem::Current,
        other => return Err(Failure::range("flow", other, "a voxelastica_flow")),
    };
    let model = match case.model {
        0 => Model::Voxel,
        1 => Model::Graded,
        other => return Err(Failure::range("model", other, "a voxelastica_solved_model")),
    };
    let shape = match case.shape {
        0 => Shape::Flat,
        1 => Shape::Morphed,
        other => return Err(Failure::range("shape", other, "a voxelastica_conduct_shape")),
    };
    let (steady, transient) = match case.regime {
        0 => (true, false),
        1 => (false, true),
        2 => (true, true),
        other => return Err(Failure::range("regime", other, "a voxelastica_regime")),
    };
    let input = design.input().conduction.clone().unwrap_or_default();
    let failed = |error| Failure::from(voxelastica_core::Error::from(error));
    let progress = watch.shares();
    let watched = pcg::Watch { progress: &progress, span: [0.0, 1.0] };
    let strip = Strip::new_unless(design, model, shape, input.graded_elements, watched).map_err(failed)?;
    solve(&strip, problem, Regimes { steady, transient }, &input, watched).map_err(failed)
}

/// Solves heat or current on one spoke; nothing is read or written. `flow` is a `voxelastica_flow`, `model` a
/// `voxelastica_solved_model`, `shape` a `voxelastica_conduct_shape`, `regime` a `voxelastica_regime`; temperatures,
/// currents, times and thresholds are those of the design's table `conduction`. `json` becomes the case as `conduct.json`
/// has it: flows, effective conductivities, critical times, and which values are assumptions. `progress` may be null and is
/// told thousandths.
///
/// # Safety
/// `progress` may be called with `user` on this thread during the call; `json` and `error` are null or writable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn voxelastica_design_conduct(
    design: *const DesignObject,
    flow: i32,
    model: i32,
    shape: i32,
    regime: i32,
    progress: ProgressCallback,
    user: *mut c_void,
    json: *mut *mut Text,
    error: *mut *mut ErrorObject,
) -> Status {
    // SAFETY: by this function's contract.
    unsafe {
        enter(error, || {
            let (design, out) = (find(design)?, Out::new("json", json)?);
            let case = Case { flow, model, shape, regime };
            let answer = with_callback(progress, user, |watch| conduct(&design.design, case, watch))?;
            out.set(keep(Text::new(&to_json(&answer)?)));
            Ok(())
        })
    }
}
