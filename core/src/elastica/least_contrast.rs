//! The line of thrust that needs the least contrast between moduli.
//!
//! With the moment `m = c0 + c1 z + c2 x`, the modulus at station `k` is `q_k . c` with
//! `q_k = (1, z_k, x_k) / (w_k theta'_k)`. Scaling so that the smallest modulus is one, the least contrast is the optimum
//! of the linear program
//!
//! ```text
//! minimise r   subject to   1 <= q_k . c <= r  for all k,   c0 + c1 z_i + c2 x_i = 0  at every inflection i,
//! ```
//!
//! with `c2 = 0` where no vertical force acts. At an inflection the row `q_k` is the limit
//! `(0, sin(theta), cos(theta)) / (w theta'')`. Rows are generated as they are violated, starting from nine.

use microlp::{ComparisonOp, OptimizationDirection, Problem, Variable};

use super::inverse::HubSupport;
use super::thrust_line::ThrustLine;
use super::{ElasticaError, inflection};
use crate::target::MeridianPoint;

/// Relative violation below which a row counts as satisfied.
const ROW_TOLERANCE: f64 = 1e-9;
const MAX_ROUNDS: usize = 100;
const FIRST_ROWS: usize = 9;

/// The line of thrust of least contrast through all inflections, scaled to a smallest modulus of one.
///
/// # Errors
/// [`ElasticaError::NoThrustLine`] where the program has no solution.
pub fn least_contrast(
    stations: &[MeridianPoint],
    widths: &[f64],
    inflections: &[MeridianPoint],
    support: HubSupport,
) -> Result<ThrustLine, ElasticaError> {
    let length = stations.last().map_or(1.0, |p| p.s);
    let rows = rows(stations, widths, inflections, length);
    let mut active: Vec<usize> = (0..FIRST_ROWS).map(|i| i * (rows.len() - 1) / (FIRST_ROWS - 1)).collect::<Vec<_>>();
    active.dedup();
    let mut coefficients = [0.0; 3];
    for _ in 0..MAX_ROUNDS {
        let (solution, contrast) = solve(&rows, &active, inflections, length, support)?;
        coefficients = solution;
        let mut worst_low = (1.0 - ROW_TOLERANCE, None);
        let mut worst_high = (contrast * (1.0 + ROW_TOLERANCE), None);
        for (k, row) in rows.iter().enumerate() {
            let modulus = dot(row, &coefficients);
            if modulus < worst_low.0 {
                worst_low = (modulus, Some(k));
            }
            if modulus > worst_high.0 {
                worst_high = (modulus, Some(k));
            }
        }
        let before = active.len();
        for k in [worst_low.1, worst_high.1].into_iter().flatten() {
            if !active.contains(&k) {
                active.push(k);
            }
        }
        if active.len() == before {
            break;
        }
    }
    Ok(line(coefficients, length, inflections))
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `q_k` for every station, in units of the length, so that the unknowns are of order one.
fn rows(stations: &[MeridianPoint], widths: &[f64], inflections: &[MeridianPoint], length: f64) -> Vec<[f64; 3]> {
    stations
        .iter()
        .zip(widths)
        .map(|(p, w)| {
            let unit = |c0: f64, horizontal: f64, vertical: f64| {
                let line = ThrustLine { anchor: [0.0; 2], anchor_moment: c0, horizontal, vertical };
                line.modulus_at(p, *w, length, inflections)
            };
            let near = inflection::nearest(inflections, p.s, length).is_some();
            [if near { 0.0 } else { unit(1.0, 0.0, 0.0) }, unit(0.0, -1.0 / length, 0.0), unit(0.0, 0.0, -1.0 / length)]
        })
        .collect()
}

fn solve(
    rows: &[[f64; 3]],
    active: &[usize],
    inflections: &[MeridianPoint],
    length: f64,
    support: HubSupport,
) -> Result<([f64; 3], f64), ElasticaError> {
    let free = (f64::NEG_INFINITY, f64::INFINITY);
    let mut problem = Problem::new(OptimizationDirection::Minimize);
    let c0 = problem.add_var(0.0, free);
    let c1 = problem.add_var(0.0, free);
    let c2 = problem.add_var(0.0, if support == HubSupport::Held { free } else { (0.0, 0.0) });
    let r = problem.add_var(1.0, (1.0, f64::INFINITY));
    let terms = |row: &[f64; 3]| -> Vec<(Variable, f64)> { vec![(c0, row[0]), (c1, row[1]), (c2, row[2])] };
    for &k in active {
        problem.add_constraint(terms(&rows[k]), ComparisonOp::Ge, 1.0);
        let mut upper = terms(&rows[k]);
        upper.push((r, -1.0));
        problem.add_constraint(upper, ComparisonOp::Le, 0.0);
    }
    for at in inflections {
        problem.add_constraint(terms(&[1.0, at.z / length, at.x / length]), ComparisonOp::Eq, 0.0);
    }
    let outcome = problem.solve().map_err(|error| match error {
        microlp::Error::Infeasible => ElasticaError::NoThrustLine { support, help: super::inverse::help_for(support) },
        other => ElasticaError::LinearProgram(other.to_string()),
    })?;
    let microlp::SolveOutcome::Solution(solution) = outcome else {
        return Err(ElasticaError::LinearProgram("interrupted before an optimum was found".to_owned()));
    };
    let value = |v: Variable| solution.var_value(v);
    Ok(([value(c0), value(c1), value(c2)], value(r)))
}

/// The optimum as a line of thrust, anchored at the first inflection where there is one.
fn line(c: [f64; 3], length: f64, inflections: &[MeridianPoint]) -> ThrustLine {
    // Subtracted from zero, so that no force becomes minus zero.
    let (horizontal, vertical) = (0.0 - c[1] / length, 0.0 - c[2] / length);
    match inflections.first() {
        Some(at) => ThrustLine { anchor: [at.x, at.z], anchor_moment: 0.0, horizontal, vertical },
        None => ThrustLine { anchor: [0.0; 2], anchor_moment: c[0], horizontal, vertical },
    }
}
