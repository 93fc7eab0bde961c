//! The page: what stands where.

use super::ReportError;
use super::figures::{flower, meridian, morph, print, profile, sections, voxels};
use super::text::{escape, number};
use super::{key_numbers, tables};
use crate::design::Design;
use crate::input::{DesignInput, TargetInput};
use crate::modulus_field::ModulusField;
use crate::output::{Provenance, Summary};

const STYLE: &str = include_str!("style.css");

/// The report of a design: one page of HTML that needs nothing else.
///
/// `files` lists what was written beside it, name and description. The same arguments give the same bytes.
///
/// # Errors
/// [`ReportError`] where a value of the design is not a number.
pub fn html(
    design: &Design,
    summary: &Summary,
    field: Option<&ModulusField>,
    provenance: &Provenance,
    files: &[(String, String)],
) -> Result<String, ReportError> {
    let name = escape(&design.input().name);
    let mut page = String::with_capacity(512 * 1024);
    page.push_str("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n");
    page.push_str("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n");
    page.push_str(&format!("<meta name=\"generator\" content=\"{}\"/>\n", escape(&provenance.line())));
    page.push_str(&format!("<title>{name} · Voxelastica</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n"));
    page.push_str(&format!(
        "<header>\n<p class=\"kind\">Voxelastica design report</p>\n<h1>{name}</h1>\n<p>{}</p>\n</header>\n",
        escape(&description(design.input()))
    ));
    page.push_str(&warnings(design));
    page.push_str(&key_numbers::tiles(design, summary));
    page.push_str(&key_numbers::forces(design, summary));
    page.push_str(&key_numbers::amounts(design, summary));
    let figures = [
        meridian::figure(design)?,
        Some(profile::figure(design)?),
        Some(flower::figure(design)),
        Some(voxels::figure(design)),
        Some(sections::figure(design)),
        print::figure(design),
        morph::figure(design)?,
    ];
    for (i, figure) in figures.iter().flatten().enumerate() {
        page.push_str(&figure.html(i + 1));
    }
    page.push_str(&tables::inputs(design.input()));
    page.push_str(&tables::modulus(field));
    page.push_str(&tables::materials(design));
    page.push_str(&tables::files(files));
    page.push_str(&format!(
        "<footer>\n<p>Voxelastica {}, seed {}</p>\n<p>design {}</p>\n</footer>\n</main>\n</body>\n</html>\n",
        escape(&provenance.version),
        provenance.seed,
        escape(&provenance.design_sha256)
    ));
    Ok(page)
}

/// The target in one line.
fn description(input: &DesignInput) -> String {
    let n = |v: f64| number(v, 4);
    let strips = &input.strips;
    let target = match &input.target {
        TargetInput::HemiEllipsoid { aspect_ratio } if *aspect_ratio == 1.0 => "Hemisphere".to_owned(),
        TargetInput::HemiEllipsoid { aspect_ratio } => format!("Hemi-ellipsoid of aspect ratio {}", n(*aspect_ratio)),
        TargetInput::InclinationPolynomial { coefficients_deg } => {
            format!("Dome whose inclination is a polynomial of degree {}", coefficients_deg.len().saturating_sub(1))
        }
        TargetInput::Points { meridian, .. } => format!("Dome through a meridian of {} points", meridian.len()),
        TargetInput::Mesh { .. } => "Dome after the outer meridian of a mesh".to_owned(),
        TargetInput::Strip { width_mm, modulus_ratio, rigid_fraction, shortening } => {
            let size = [strips.length_mm, *width_mm, strips.thickness_mm].map(n).join(" × ");
            let modulus = match (modulus_ratio, rigid_fraction) {
                (Some(ratio), _) => format!("modulus {} times that of the ends in the middle", n(*ratio)),
                (None, Some(rigid)) => format!("uniform, {} % of the stiffest phase", n(100.0 * rigid)),
                (None, None) => "uniform".to_owned(),
            };
            let ends = match shortening {
                Some(share) => format!("clamped ends pushed together by {} % of the length", n(100.0 * share)),
                None => "flat, to be stretched".to_owned(),
            };
            return format!("Rectangular strip of {size} mm, {modulus}, {ends}");
        }
    };
    format!(
        "{target}, from {} spokes {} mm long and {} mm thick on a hub of {} mm radius",
        input.count(),
        n(strips.length_mm),
        n(strips.thickness_mm),
        n(input.hub_radius())
    )
}

fn warnings(design: &Design) -> String {
    let list = design.warnings_for_files();
    if list.is_empty() {
        return "<div class=\"warnings none\"><p>Warnings: none</p></div>\n".to_owned();
    }
    let items: String = list.iter().map(|w| format!("<li>{}</li>\n", escape(&capitalised(w)))).collect();
    let title = if list.len() == 1 { "Warning".to_owned() } else { format!("{} warnings", list.len()) };
    format!("<div class=\"warnings\" role=\"note\"><h2>{title}</h2>\n<ul>\n{items}</ul></div>\n")
}

/// A text with a capital first letter.
fn capitalised(text: &str) -> String {
    let mut rest = text.chars();
    rest.next().map_or_else(String::new, |first| first.to_uppercase().chain(rest).collect())
}
