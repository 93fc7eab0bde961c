//! Mid-lines: the same material point here and there.

use nalgebra::{Rotation3, Vector3};

use super::curve::Curve;
use super::placement::Placement;
use super::record::{Deviation, PlacementRecord};
use super::{Compared, Job, PlacementChoice};
use crate::error::Error;
use crate::input::InputError;
use crate::results::comparison::{MidlinePoint, distances};

/// How far arc lengths may leave the strip, as a share of its length.
const OUTSIDE: f64 = 0.01;

pub(super) fn compare(job: &Job<'_>, choice: PlacementChoice) -> Result<Compared, Error> {
    let rows = ordered(job)?;
    let target = deviation(job, &rows, &job.target, choice)?;
    let prediction = job.prediction.as_ref().map(|p| deviation(job, &rows, p, choice)).transpose()?;
    let midline = placed(&rows, &placement(&rows, &job.target, choice));
    Ok(Compared { target, prediction, surface: None, midline })
}

/// The rows, rim first.
fn ordered(job: &Job<'_>) -> Result<Vec<MidlinePoint>, Error> {
    let (table, length) = (job.table, job.length());
    let wrong = |row: usize, problem: String, help: &str| {
        let mut error = InputError::new("s_mm", table.rows[row][0], problem).help(help).in_file(&table.file);
        error.line = Some(table.lines[row]);
        Error::Input(error)
    };
    let backwards = table.rows.first().zip(table.rows.last()).is_some_and(|(a, b)| a[0] > b[0]);
    for (i, pair) in table.rows.windows(2).enumerate() {
        if (pair[1][0] > pair[0][0]) == backwards || pair[0][0] == pair[1][0] {
            let help = "sort the rows along the strip, rim first, one row a point";
            return Err(wrong(i + 1, "this arc length does not follow the one before".to_owned(), help));
        }
    }
    let margin = OUTSIDE * length;
    if let Some(i) = table.rows.iter().position(|r| r[0] < -margin || r[0] > length + margin) {
        let problem = format!("this arc length is not on the strip, which is {length} mm long");
        return Err(wrong(
            i,
            problem,
            "s is measured in the flat strip from the rim, in mm; is it this design's result?",
        ));
    }
    let mut rows = table.rows.clone();
    if backwards {
        rows.reverse();
    }
    Ok(rows)
}

fn deviation(job: &Job<'_>, rows: &[MidlinePoint], shape: &Curve, choice: PlacementChoice) -> Result<Deviation, Error> {
    let placement = placement(rows, shape, choice);
    let midline = placed(rows, &placement);
    let nearest = |p: &MidlinePoint| {
        let offset = shape.nearest([p[1], p[2]]).offset;
        offset[0].hypot(offset[1])
    };
    let comparison = distances(|s| shape.position(s), nearest, job.length(), &midline)
        .ok_or_else(|| Error::Internal("an empty mid-line".to_owned()))?;
    let percent = 100.0 / job.length();
    let along = midline.iter().zip(&comparison.distances_mm).map(|(p, d)| [p[0], percent * d]).collect();
    let name = match choice {
        PlacementChoice::Auto | PlacementChoice::Rim => "rim",
        PlacementChoice::AsGiven => "as-given",
        PlacementChoice::Fit => "fit",
    };
    Ok(Deviation {
        max_error_percent: comparison.max_error_percent,
        rms_error_percent: comparison.rms_error_percent,
        max_shape_error_percent: Some(comparison.max_shape_error_percent),
        points: None,
        placement: PlacementRecord::new(name, &placement),
        along,
        cloud: Vec::new(),
    })
}

fn placement(rows: &[MidlinePoint], shape: &Curve, choice: PlacementChoice) -> Placement {
    let space = |p: [f64; 2]| Vector3::new(p[0], 0.0, p[1]);
    match choice {
        PlacementChoice::AsGiven => Placement::IDENTITY,
        PlacementChoice::Auto | PlacementChoice::Rim => {
            let [s, x, z] = rows[0];
            Placement { shift: space(shape.position(s)) - space([x, z]), ..Placement::IDENTITY }
        }
        PlacementChoice::Fit => {
            // Least squares between points that belong together: the turn is that of the sums of products.
            let pairs: Vec<_> = rows.iter().map(|[s, x, z]| (space([*x, *z]), space(shape.position(*s)))).collect();
            let n = pairs.len() as f64;
            let here = pairs.iter().map(|p| p.0).sum::<Vector3<f64>>() / n;
            let there = pairs.iter().map(|p| p.1).sum::<Vector3<f64>>() / n;
            let (mut sin, mut cos) = (0.0, 0.0);
            for (a, b) in &pairs {
                let (a, b) = (a - here, b - there);
                cos += a.dot(&b);
                sin += a.cross(&b).y;
            }
            let rotation = Rotation3::from_axis_angle(&Vector3::y_axis(), sin.atan2(cos));
            Placement { rotation, shift: there - rotation * here }
        }
    }
}

fn placed(rows: &[MidlinePoint], placement: &Placement) -> Vec<MidlinePoint> {
    let place = |[s, x, z]: &MidlinePoint| {
        let p = placement.apply(&Vector3::new(*x, 0.0, *z));
        [*s, p.x, p.z]
    };
    rows.iter().map(place).collect()
}
