//! `voxelastica compare`.

use voxelastica_core::output::folder::Staging;
use voxelastica_core::output::json;
use voxelastica_core::report::{VerificationPicture, verification_svg};
use voxelastica_core::results::measured::{Deviation, Face, Kind, MeasuredOptions, PlacementChoice, Surface};
use voxelastica_core::results::{MeasuredComparison, compare_table, read_table};
use voxelastica_core::{Design, Error};

use super::{MISSED, designed, figures, require_unchanged};
use crate::args::{CompareOptions, FaceChoice, Placing, SurfaceChoice};
use crate::console::Console;

/// An uncertain turn, degrees, or shift, as a share of the length, beyond which the user is warned.
const UNCERTAIN: (f64, f64) = (1.0, 0.005);

/// Compares a measured or separately solved shape with a design.
pub fn run(options: &CompareOptions, console: &Console) -> Result<u8, Error> {
    let cancelled = || console.is_cancelled();
    let design = designed(&options.folder, console)?;
    require_unchanged(&design, &options.folder.join("design.json"))?;
    let table = read_table(&options.result, &cancelled)?;
    let how = MeasuredOptions {
        placement: match options.placement {
            Placing::Auto => PlacementChoice::Auto,
            Placing::AsGiven => PlacementChoice::AsGiven,
            Placing::Rim => PlacementChoice::Rim,
            Placing::Fit => PlacementChoice::Fit,
        },
        surface: match options.surface {
            SurfaceChoice::Auto => None,
            SurfaceChoice::Revolution => Some(Surface::Revolution),
            SurfaceChoice::Spokes => Some(Surface::Spokes),
        },
        face: match options.face {
            FaceChoice::Middle => Face::Middle,
            FaceChoice::Outer => Face::Outer,
            FaceChoice::Inner => Face::Inner,
        },
    };
    let comparison = compare_table(&design, &table, how, &cancelled)
        .map_err(|error| error.in_file(&options.folder.join("design.json").display().to_string()))?;
    write(&design, options, &comparison)?;
    tell(&design, options, &comparison, console);
    match options.target_error {
        Some(limit) if comparison.max_error_percent > limit => {
            eprintln!(
                "error: {}: the error of {:.3} % exceeds --target-error {limit} %",
                comparison.result.file, comparison.max_error_percent
            );
            Ok(MISSED)
        }
        _ => Ok(0),
    }
}

fn tell(design: &Design, options: &CompareOptions, comparison: &MeasuredComparison, console: &Console) {
    let what = match (comparison.result.kind, comparison.surface) {
        (Kind::Midline, _) => "a mid-line, compared at equal arc lengths".to_owned(),
        (Kind::Meridian, _) => "a meridian".to_owned(),
        (Kind::Points, Some(Surface::Spokes)) => {
            format!("points of a dome of {} spokes, straight across", design.input().count())
        }
        (Kind::Points, _) => "points of a surface of revolution".to_owned(),
    };
    console.say(format!("read      {} rows of {}: {what}", comparison.result.rows, comparison.result.file));
    place(design, &comparison.target, console);
    let say = |deviation: &Deviation, against: &str| {
        let shape = deviation.max_shape_error_percent.map_or_else(String::new, |s| format!("; as a shape {s:.3} %"));
        console.say(format!(
            "error     {:.3} % of the length at most, {:.3} % rms{shape}, against the {against}",
            deviation.max_error_percent, deviation.rms_error_percent
        ));
    };
    say(&comparison.target, "target");
    if let Some(prediction) = &comparison.prediction {
        say(prediction, "prediction");
    }
    if let Some(points) = &comparison.target.points {
        console.say(format!(
            "points    {} compared: {} mm rms, 95 % within {} mm, at most {} mm, {} mm outside on the average",
            points.compared,
            figures(points.rms_mm),
            figures(points.p95_mm),
            figures(points.max_mm),
            figures(points.mean_mm)
        ));
        let left_out = [
            (points.stray, "further from the dome than a tenth of the length"),
            (points.on_hub, "on the hub"),
            (points.beyond_ends, "beyond the rim or the hub edge"),
        ];
        let left_out: Vec<String> =
            left_out.iter().filter(|(n, _)| *n > 0).map(|(n, why)| format!("{n} {why}")).collect();
        if !left_out.is_empty() {
            console.say(format!("left out  {}", left_out.join(", ")));
        }
        if 2 * points.stray > comparison.result.rows {
            console.warn("most of the points are no part of the dome; is it a scan of this design, in mm?");
        }
    }
    console.say(format!("written   {}", options.folder.join("comparison.json").display()));
}

/// States where the result was laid.
fn place(design: &Design, deviation: &Deviation, console: &Console) {
    let placement = &deviation.placement;
    let vector = |v: [f64; 3]| v.map(|c| format!("{c:.4}")).join(", ");
    let length = design.input().strips.length_mm;
    match placement.choice {
        "as-given" => console.say("placed    as given"),
        "rim" => console.say(format!("placed    by its rim, moved by ({}) mm", vector(placement.shift_mm))),
        _ => {
            console.say(format!(
                "placed    by the best fit: turned by {:.3} degrees about ({}), then moved by ({}) mm",
                placement.rotation_angle_deg,
                vector(placement.rotation_axis),
                vector(placement.shift_mm)
            ));
            console.detail(format!(
                "the dome's axis has the direction ({}) in the file and meets the plane of the rim at ({}) mm",
                vector(placement.dome_axis),
                vector(placement.dome_origin_mm)
            ));
            let doubt = |value: Option<f64>, limit: f64| value.is_none_or(|v| v > limit);
            // A scan without uncertainties leaves some motion open altogether.
            if deviation.points.is_some()
                && (doubt(placement.rotation_uncertainty_deg, UNCERTAIN.0)
                    || doubt(placement.shift_uncertainty_mm, UNCERTAIN.1 * length))
            {
                let known = |value: Option<f64>| value.map_or_else(|| "any amount".to_owned(), figures);
                console.warn(format!(
                    "the points leave the placement open by {} degrees and {} mm; scan more of the dome",
                    known(placement.rotation_uncertainty_deg),
                    known(placement.shift_uncertainty_mm)
                ));
            }
        }
    }
}

fn write(design: &Design, options: &CompareOptions, comparison: &MeasuredComparison) -> Result<(), Error> {
    let points = |x: &[f64], z: &[f64]| x.iter().zip(z).map(|(x, z)| [*x, *z]).collect::<Vec<[f64; 2]>>();
    let profile = design.profile();
    let picture = VerificationPicture {
        name: design.input().name.clone(),
        target: points(&profile.x, &profile.z),
        prediction: design.voxel_path().map(|p| points(&p.final_shape().x, &p.final_shape().z)),
        solver: comparison.midline_mm.iter().map(|[_, x, z]| [*x, *z]).collect(),
        solver_name: match comparison.result.kind {
            Kind::Midline => comparison.result.file.clone(),
            Kind::Meridian | Kind::Points => format!("mean of {}", comparison.result.file),
        },
        max_error_percent: comparison.max_error_percent,
        rms_error_percent: comparison.rms_error_percent,
        length_mm: design.input().strips.length_mm,
        error_along: Some(comparison.target.along.clone()),
        cloud: comparison.target.cloud.clone(),
    };
    let text = json::to_text(comparison).map_err(|e| Error::Internal(format!("comparison.json: {e}")))?;
    let mut staging = Staging::new(&options.folder)?;
    staging.write_text("comparison.svg", &verification_svg(&picture))?;
    staging.write_text("comparison.json", &text)?;
    staging.commit()
}
