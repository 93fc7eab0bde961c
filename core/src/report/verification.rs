//! The picture of a verification: target, prediction and what a solver found.

use super::ReportError;
use super::chart::{Axis, Chart, LEFT, Layer, RIGHT, bounds, equal_aspect, thinned};
use super::figures::WIDTH;
use super::figures::meridian::error_chart;
use super::palette::{CLOUD, INK, MEASURED, MUTED, PREDICTED, TARGET};
use super::svg::{Anchor, Stroke, Svg};
use super::text::number;

/// What a verification compares; positions in mm, x from the rim towards the hub, z upwards.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct VerificationPicture {
    /// Name of the design.
    pub name: String,
    /// The target's mid-line.
    pub target: Vec<[f64; 2]>,
    /// The mid-line that the forward model predicts.
    pub prediction: Option<Vec<[f64; 2]>>,
    /// The mid-line that the solver found.
    pub solver: Vec<[f64; 2]>,
    /// The solver, as it is to be named.
    pub solver_name: String,
    /// Largest distance from the target, percent of the length.
    pub max_error_percent: f64,
    /// Root mean square distance, percent of the length.
    pub rms_error_percent: f64,
    /// Length of the strip, mm.
    pub length_mm: f64,
    /// Distance from the target along the strip: arc length in mm, percent of the length.
    pub error_along: Option<Vec<[f64; 2]>>,
    /// Single points of a scan, drawn faintly under everything.
    pub cloud: Vec<[f64; 2]>,
}

const TARGET_LINE: Stroke = Stroke::solid(TARGET, 7.0);
const PREDICTED_LINE: Stroke = Stroke::dashed(PREDICTED, 1.6, [7.0, 4.0]);
const SOLVER_LINE: Stroke = Stroke::solid(MEASURED, 1.4);
const HEAD: f64 = 84.0;
/// Solver points up to which every one gets a dot.
const MOST_DOTS: usize = 101;
const MOST_POINTS: usize = 1001;

/// The picture as an SVG file of its own. Points that are not numbers are left out.
#[must_use]
pub fn verification_svg(input: &VerificationPicture) -> String {
    let title = format!("{}: {} against the target", input.name, input.solver_name);
    match drawing(input) {
        Ok(svg) => svg.standalone(&title),
        Err(error) => {
            let mut svg = Svg::new(WIDTH, 80.0);
            svg.text([20.0, 44.0], Anchor::Start, 13.0, INK, &error.to_string());
            svg.standalone(&title)
        }
    }
}

fn drawing(input: &VerificationPicture) -> Result<Svg, ReportError> {
    let finite = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
        thinned(points.iter().filter(|p| p.iter().all(|v| v.is_finite())).copied().collect(), MOST_POINTS)
    };
    let (target, solver) = (finite(&input.target), finite(&input.solver));
    let prediction = input.prediction.as_deref().map(finite).unwrap_or_default();
    let cloud = finite(&input.cloud);
    let all = || target.iter().chain(&prediction).chain(&solver).chain(&cloud);
    let x = bounds(all().map(|p| p[0]), 0.04);
    let z = bounds(all().map(|p| p[1]), 0.08);
    let (x, z, height) = equal_aspect(x, z, WIDTH, [110.0, 480.0]);
    let mut layers = vec![
        Layer::Line(target, TARGET_LINE),
        Layer::Dots(cloud, 1.1, CLOUD),
        Layer::Line(solver.clone(), SOLVER_LINE),
        Layer::Dots(thinned(solver, MOST_DOTS), 2.4, MEASURED),
    ];
    let predicted = !prediction.is_empty();
    if predicted {
        layers.push(Layer::Line(prediction, PREDICTED_LINE));
    }
    let meridian = Chart {
        figure: "verification",
        size: [WIDTH, height],
        x: Axis::new("distance from the rim x, mm", x, 12),
        y: Axis::new("height z, mm", z, 7),
        layers,
    };
    let errors = input.error_along.as_deref().map(finite).filter(|e| !e.is_empty());
    let length = if input.length_mm.is_finite() && input.length_mm > 0.0 { input.length_mm } else { 1.0 };
    let along = Axis::new("arc length from the rim s, mm", [0.0, length], 12);
    let below = errors.map(|e| error_chart("verification", along, e, SOLVER_LINE).draw()).transpose()?;
    let mut svg = Svg::new(WIDTH, HEAD + height + below.as_ref().map_or(0.0, |b| b.height + 8.0));
    heading(&mut svg, input, predicted);
    svg.place([0.0, HEAD], &meridian.draw()?);
    if let Some(below) = &below {
        svg.place([0.0, HEAD + height + 8.0], below);
    }
    Ok(svg)
}

fn heading(svg: &mut Svg, input: &VerificationPicture, predicted: bool) {
    let mm = |percent: f64| number(0.01 * percent * input.length_mm, 3);
    let summary = format!(
        "largest distance from the target {} % of L ({} mm), rms {} % ({} mm)",
        number(input.max_error_percent, 3),
        mm(input.max_error_percent),
        number(input.rms_error_percent, 3),
        mm(input.rms_error_percent)
    );
    svg.text([LEFT, 26.0], Anchor::Start, 16.0, INK, &shortened(&input.name, 80));
    svg.text([LEFT, 46.0], Anchor::Start, 12.0, MUTED, &summary);
    let solver = shortened(&input.solver_name, 32);
    let mut marks = vec![(TARGET_LINE, "target")];
    if predicted {
        marks.push((PREDICTED_LINE, "prediction"));
    }
    marks.push((SOLVER_LINE, solver.as_str()));
    // Texts have no metrics here: every entry gets a column wide enough for any of them but the last.
    let column = 150.0_f64.min((WIDTH - LEFT - RIGHT) / marks.len() as f64);
    for (k, (stroke, text)) in marks.into_iter().enumerate() {
        let x = LEFT + k as f64 * column;
        svg.line([x, 67.0], [x + 28.0, 67.0], &stroke);
        if stroke == SOLVER_LINE {
            svg.circle([x + 14.0, 67.0], 2.4, &format!("fill=\"{}\"", MEASURED.hex()));
        }
        svg.text([x + 36.0, 71.0], Anchor::Start, 12.0, INK, text);
    }
}

/// A text of at most so many characters.
fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most.saturating_sub(1)).chain(['…']).collect()
}
