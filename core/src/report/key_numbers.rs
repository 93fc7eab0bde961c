//! The numbers at the head of a report.

use super::palette;
use super::text::{escape, number, significant, whole};
use crate::design::Design;
use crate::output::Summary;
use crate::output::summary::Forces;

/// One number with its name and a remark.
struct Tile {
    name: &'static str,
    value: String,
    unit: &'static str,
    note: String,
}

impl Tile {
    fn new(name: &'static str, value: String, unit: &'static str, note: String) -> Self {
        Self { name, value, unit, note }
    }
}

/// The most important numbers as tiles.
#[must_use]
pub fn tiles(design: &Design, summary: &Summary) -> String {
    let n = |v: f64| number(v, 4);
    let input = design.input();
    let (length, hub) = (input.strips.length_mm, input.hub_radius());
    let least = design.peak_modulus() / summary.contrast;
    let peak = design.peak_modulus();
    let modulus =
        if summary.contrast < 1.0 + 1e-6 { n(peak) } else { format!("{}–{}", number(least, 3), number(peak, 3)) };
    let mut tiles = vec![Tile::new(
        "Modulus contrast",
        n(summary.contrast),
        "",
        format!("the phases reach {}", n(summary.contrast_reach)),
    )];
    let layers = summary.lattice.layers;
    let slices_and_layers = format!(
        "{} slices, {layers} layer{}",
        whole(summary.lattice.slices as u64),
        if layers == 1 { "" } else { "s" }
    );
    let voxels = Tile::new(
        if input.is_strip() { "Voxels" } else { "Voxels per spoke" },
        whole(summary.voxels_per_spoke),
        "",
        slices_and_layers,
    );
    let which = if summary.contrast < 1.0 + 1e-6 { "everywhere" } else { "least and largest, designed" };
    let modulus = Tile::new("Modulus", modulus, "MPa", which.to_owned());
    let predicted = || match (summary.refinement, summary.predicted_error_percent) {
        (Some(refined), _) => Tile::new(
            "Refined error",
            number(refined.error_after_percent, 3),
            "% of L",
            format!("{} % before, finite elements", number(refined.error_before_percent, 3)),
        ),
        (None, Some(error)) => Tile::new(
            "Predicted error",
            number(error, 3),
            "% of L",
            format!("{} mm, voxelised", number(0.01 * error * length, 3)),
        ),
        (None, None) => Tile::new("Predicted error", "–".to_owned(), "", "the shape was not found".to_owned()),
    };
    let compression = || {
        let moved = n(length * summary.compression);
        let moved = if input.is_strip() { format!("ends {moved} mm closer") } else { format!("rim {moved} mm inward") };
        Tile::new("Compression", number(100.0 * summary.compression, 4), "%", moved)
    };
    if input.is_strip() {
        if design.guide().is_some() {
            let rise = design.profile().z.iter().copied().fold(0.0, f64::max);
            tiles.push(predicted());
            tiles.push(Tile::new("Rise", n(rise), "mm", "mid-line above the ends".to_owned()));
            tiles.push(compression());
        }
        tiles.push(modulus);
        tiles.push(voxels);
        let (width, thickness) = (design.profile().width[0], input.strips.thickness_mm);
        let volume = number(summary.volume_mm3.spoke_smooth, 5);
        let size = format!("{} × {} × {}", n(length), n(width), n(thickness));
        tiles.push(Tile::new("Size", size, "mm", "length, width, thickness".to_owned()));
        if design.guide().is_some() {
            tiles.push(Tile::new("Volume", volume, "mm³", "with smooth edges".to_owned()));
        }
    } else {
        let radius = format!("flat: {} mm", n(hub + length));
        let angles = format!("{}° → {}°", number(summary.rim_angle_deg, 3), number(summary.hub_angle_deg, 3));
        tiles.push(predicted());
        tiles.push(Tile::new("Height", n(summary.height_mm), "mm", "hub above the rim".to_owned()));
        tiles.push(Tile::new("Rim radius", n(summary.rim_radius_mm), "mm", radius));
        tiles.push(compression());
        tiles.push(Tile::new("Inclination", angles, "", "at the rim and at the hub".to_owned()));
        tiles.push(modulus);
        tiles.push(voxels);
    }
    let mut html = "<dl class=\"tiles\">\n".to_owned();
    for Tile { name, value, unit, note } in tiles {
        html.push_str(&format!(
            "<div><dt>{name}</dt><dd>{value} <small>{unit}</small></dd><dd class=\"note\">{}</dd></div>\n",
            escape(&note)
        ));
    }
    html.push_str("</dl>\n");
    html
}

/// Forces and moments of one spoke and of all.
#[must_use]
pub fn forces(design: &Design, summary: &Summary) -> String {
    if design.guide().is_none() {
        return String::new();
    }
    let strip = design.input().is_strip();
    let thrust = &summary.thrust;
    let mut columns = vec![thrust.per_spoke.beam, thrust.per_spoke.plane_strain];
    let mut head = "<tr><th rowspan=\"2\"></th><th class=\"n\" colspan=\"2\">one spoke</th>\
                    <th class=\"n\" colspan=\"2\">all spokes</th></tr>\n<tr>"
        .to_owned();
    let pair = "<th class=\"n\">beam</th><th class=\"n\">plane strain</th>";
    if strip {
        head = format!("<tr><th></th>{pair}</tr>\n");
    } else {
        columns.extend([thrust.total.beam, thrust.total.plane_strain]);
        head.push_str(&format!("{pair}{pair}</tr>\n"));
    }
    type Pick = fn(&Forces) -> f64;
    let (first, second) = if strip { ("at s = 0", "at s = L") } else { ("at the rim", "at the hub") };
    let quantities: [(String, Pick); 4] = [
        ("Horizontal force H, N".to_owned(), |f| f.horizontal_n),
        ("Vertical force V, N".to_owned(), |f| f.vertical_n),
        (format!("Moment {first}, N mm"), |f| f.rim_moment_nmm),
        (format!("Moment {second}, N mm"), |f| f.hub_moment_nmm),
    ];
    let largest = columns.iter().map(|f| f.horizontal_n.hypot(f.vertical_n)).fold(0.0, f64::max);
    let mut rows = String::new();
    for (name, pick) in quantities {
        rows.push_str(&format!("<tr><th>{name}</th>"));
        for forces in &columns {
            // What is left of cancelled terms is not a force.
            let value = pick(forces);
            let value = if value.abs() < 1e-9 * largest { 0.0 } else { value };
            rows.push_str(&format!("<td class=\"n\">{}</td>", significant(value, 4)));
        }
        rows.push_str("</tr>\n");
    }
    let hint = if strip {
        "H is positive where the ends are pushed together. A narrow strip bends as a beam, a wide one in plane strain."
    } else {
        "H is positive where the seat pushes the rim inward, V where the hub is pushed up. Narrow spokes bend as beams, \
         wide ones in plane strain; most lie in between."
    };
    format!(
        "<section>\n<h2>Forces in the final shape</h2>\n<table><thead>{head}</thead>\n<tbody>\n{rows}</tbody></table>\n\
         <p class=\"hint\">{hint}</p>\n</section>\n"
    )
}

/// Voxels by phase and volumes.
#[must_use]
pub fn amounts(design: &Design, summary: &Summary) -> String {
    let phases = design.phases().phases();
    let total = summary.voxels_per_spoke.max(1);
    let one = design.grid().size_mm().powi(3);
    let mut rows = String::new();
    for (i, phase) in phases.iter().enumerate() {
        let count = summary.voxels.get(&phase.label()).and_then(serde_json::Value::as_u64).unwrap_or(0);
        rows.push_str(&format!(
            "<tr><th><span class=\"swatch\" style=\"background:{}\"></span>{}</th><td class=\"n\">{}</td><td class=\"n\">{} %\
             </td><td class=\"n\">{}</td></tr>\n",
            palette::phase(i, phases.len()).hex(),
            escape(&phase.name),
            whole(count),
            number(100.0 * count as f64 / total as f64, 3),
            number(one * count as f64, 5)
        ));
    }
    let sum = format!(
        "<tr class=\"sum\"><th>together</th><td class=\"n\">{}</td><td class=\"n\"></td><td class=\"n\">{}</td></tr>\n",
        whole(summary.voxels_per_spoke),
        number(summary.volume_mm3.spoke_voxels, 5)
    );
    let strip = design.input().is_strip();
    let whose = if strip { "the strip" } else { "one spoke" };
    let volume = &summary.volume_mm3;
    let mut volumes = vec![
        (format!("{whose} with smooth edges"), volume.spoke_smooth),
        (format!("{whose} in voxels"), volume.spoke_voxels),
    ];
    if !strip {
        volumes.push(("hub".to_owned(), volume.hub));
        volumes.push((format!("flower: {} smooth spokes and hub", design.input().count()), volume.flower));
    }
    let volumes: String = volumes
        .iter()
        .map(|(name, v)| format!("<tr><th>{name}</th><td class=\"n\">{}</td></tr>\n", number(*v, 5)))
        .collect();
    format!(
        "<section class=\"columns\">\n<section>\n<h2>Voxels of {whose}</h2>\n<table><thead><tr><th>phase</th><th class=\"n\">\
         voxels</th><th class=\"n\">share</th><th class=\"n\">mm³</th></tr></thead>\n<tbody>\n{rows}{sum}</tbody></table>\n\
         </section>\n<section>\n<h2>Volumes</h2>\n<table><thead><tr><th>of</th><th class=\"n\">mm³</th></tr></thead>\n\
         <tbody>\n{volumes}</tbody></table>\n</section>\n</section>\n"
    )
}
