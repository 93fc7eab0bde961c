//! The report and the picture of a verification: complete, well formed, small, and the same every time.

use std::path::Path;

use quick_xml::Reader;
use quick_xml::events::Event;
use voxelastica_core::input::files::Format;
use voxelastica_core::modulus_field::ModulusField;
use voxelastica_core::output::{Provenance, Summary};
use voxelastica_core::report::{self, VerificationPicture};
use voxelastica_core::{Design, DesignInput, Limits};

const LARGEST: usize = 2_000_000;

const FLX: &str = "phases = [\"FLX9070\", \"FLX9095\"]";
const HEMISPHERE: &str = "kind = \"hemi-ellipsoid\"";
const NOSE: &str = "kind = \"inclination-polynomial\"\n\
                    coefficients_deg = [26.52, -116.3, 162.3, -132, 63.5, -47.14, 18.64, 41.56]";
const ROOF: &str = "kind = \"inclination-polynomial\"\n\
                    coefficients_deg = [6395, -28300, 52140, -51860, 30530, -11170, 2808, -570.8, 89.7]";
/// Names that would break a page that does not escape them.
const HOSTILE: &str = "phases = ['soft <b>&\"', 'stiff ]]>ä']\n[[materials.custom]]\nname = 'soft <b>&\"'\nmodulus_mpa = 1.0\n\
                       poisson = 0.4\n[[materials.custom]]\nname = 'stiff ]]>ä'\nmodulus_mpa = 30.0\npoisson = 0.3\n\
                       electrical_conductivity_s_m = 1e-7";
const THREE: &str = "phases = [\"FLX9070\", \"middle\", \"FLX9095\"]\n[[materials.custom]]\nname = \"middle\"\n\
                     modulus_mpa = 6.0\npoisson = 0.35";

fn dome(
    target: &str,
    [count, length, hub, thickness]: [f64; 4],
    thrust: &str,
    materials: &str,
    voxels: &str,
) -> String {
    format!(
        "[target]\n{target}\n[strips]\ncount = {count}\nlength_mm = {length:?}\nhub_radius_mm = {hub:?}\n\
         thickness_mm = {thickness:?}\n{thrust}\n[materials]\n{materials}\n[voxels]\n{voxels}\n"
    )
}

fn strip(target: &str, [length, thickness]: [f64; 2], voxels: &str) -> String {
    format!(
        "[target]\nkind = \"strip\"\n{target}\n[strips]\nlength_mm = {length:?}\nthickness_mm = {thickness:?}\n\
         [materials]\n{FLX}\n[voxels]\n{voxels}\n"
    )
}

fn cases() -> Vec<(&'static str, String)> {
    let half = "size_mm = 0.5";
    let held = "[thrust]\nhub = \"held\"";
    let paper = [8.0, 100.0, 10.0, 2.0];
    let with = |pattern: &str| format!("{half}\npattern = \"{pattern}\"");
    vec![
        ("hemisphere", dome(HEMISPHERE, paper, "", FLX, half)),
        ("held & nose", dome(NOSE, [12.0, 100.0, 5.0, 2.0], held, FLX, &with("centred"))),
        ("Dach 'ä' 花", dome(ROOF, [6.0, 100.0, 20.0, 2.0], "", HOSTILE, &with("through-thickness"))),
        ("three phases", dome(HEMISPHERE, paper, "", THREE, half)),
        ("uniform", dome(HEMISPHERE, paper, held, FLX, &with("split"))),
        ("one edge, one layer", dome(HEMISPHERE, [8.0, 100.0, 10.0, 0.5], "", FLX, &with("one-edge"))),
        ("three spokes", dome(HEMISPHERE, [3.0, 100.0, 10.0, 2.0], "", FLX, &with("random-layered"))),
        ("thousand spokes", dome(HEMISPHERE, [1000.0, 100.0, 10.0, 1.0], "", FLX, half)),
        ("huge", dome(HEMISPHERE, [8.0, 1e5, 1e4, 500.0], "", FLX, "size_mm = 500.0")),
        ("tiny", dome(HEMISPHERE, [8.0, 0.01, 0.001, 0.001], "", FLX, "size_mm = 0.0005")),
        ("bow", strip("width_mm = 12.0\nmodulus_ratio = 2.0\nshortening = 0.6", [40.0, 2.0], half)),
        ("coupon", strip("width_mm = 6.0\nrigid_fraction = 0.5", [35.0, 2.0], "size_mm = 0.25")),
        ("wide", strip("width_mm = 5000.0\nmodulus_ratio = 2.0\nshortening = 0.1", [40.0, 2.0], "size_mm = 2.0")),
        ("narrow", strip("width_mm = 0.01\nmodulus_ratio = 0.5\nshortening = 0.01", [40.0, 2.0], half)),
    ]
}

fn compute(name: &str, text: &str) -> Design {
    let input = DesignInput::from_text(text, Format::Toml, "test.toml", name, Path::new("."))
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    Design::compute(&input, Limits::default()).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn page(design: &Design) -> String {
    let profile = design.profile();
    let field = ModulusField::fit(&profile.s, &profile.modulus_mpa, design.input().strips.length_mm).ok();
    let files = [("design.json".to_owned(), "the whole result, \"schema\" & all".to_owned())];
    report::html(design, &Summary::of(design), field.as_ref(), &Provenance::of(design.input()), &files).unwrap()
}

fn picture(design: &Design) -> VerificationPicture {
    let profile = design.profile();
    let curve: Vec<[f64; 2]> = profile.x.iter().zip(&profile.z).map(|(x, z)| [*x, *z]).collect();
    VerificationPicture {
        name: design.input().name.clone(),
        target: curve.clone(),
        prediction: Some(curve.iter().map(|[x, z]| [*x, 1.01 * z]).collect()),
        solver: curve.iter().step_by(10).map(|[x, z]| [1.001 * x, *z]).collect(),
        solver_name: "CalculiX 2.20 <voxel> & co".to_owned(),
        max_error_percent: 0.25,
        rms_error_percent: 0.13,
        length_mm: design.input().strips.length_mm,
        error_along: Some(profile.s.iter().map(|s| [*s, 0.1]).collect()),
        cloud: curve.clone(),
    }
}

/// Parses all of it: balanced elements, quoted attributes, known entities, numbers that are numbers.
fn check_xml(name: &str, text: &str) {
    let mut reader = Reader::from_str(text);
    reader.config_mut().check_end_names = true;
    let mut depth = 0_i64;
    loop {
        match reader.read_event().unwrap_or_else(|error| panic!("{name}: {error} at {}", reader.buffer_position())) {
            Event::Start(tag) => {
                depth += 1;
                check_attributes(name, &tag);
            }
            Event::Empty(tag) => check_attributes(name, &tag),
            Event::End(_) => depth -= 1,
            Event::Eof => break,
            _ => {}
        }
    }
    assert_eq!(depth, 0, "{name}");
}

fn check_attributes(name: &str, tag: &quick_xml::events::BytesStart<'_>) {
    for attribute in tag.attributes() {
        let attribute = attribute.unwrap_or_else(|error| panic!("{name}: {error}"));
        let (key, value): (&str, &str) = (attribute.key.as_ref(), &attribute.value);
        assert!(!value.contains('<'), "{name}: {key}={value}");
        if !["aria-label", "content"].contains(&key) {
            let mut words = value.split(|c: char| !c.is_ascii_alphabetic());
            assert!(!words.any(|w| ["NaN", "inf"].contains(&w)), "{name}: {key}={value}");
        }
    }
}

#[test]
fn every_kind_of_design_has_a_small_well_formed_page_that_needs_nothing_else() {
    for (name, text) in cases() {
        let design = compute(name, &text);
        let html = page(&design);
        assert!(html.len() < LARGEST, "{name}: {} bytes", html.len());
        check_xml(name, &html);
        for forbidden in ["http", "<script", "<img", "<link", "@import", "url(//", "NaN", "Infinity"] {
            assert!(!html.contains(forbidden), "{name}: {forbidden}");
        }
        // Only the figures that make sense: a strip that is only stretched has no meridian and no morph.
        let figures = html.matches("<figure>").count();
        assert_eq!(figures, if design.guide().is_some() { 6 } else { 4 }, "{name}");
        assert_eq!(html, page(&design), "{name} changes from call to call");
    }
}

#[test]
fn millions_of_voxels_make_no_larger_a_page() {
    let design = compute("fine", &dome(HEMISPHERE, [8.0, 100.0, 10.0, 2.0], "", FLX, "size_mm = 0.1"));
    assert!(design.grid().phases().len() > 8_000_000);
    let html = page(&design);
    assert!(html.len() < LARGEST, "{} bytes", html.len());
    assert!(html.contains("voxels are merged into a cell"), "merging must be said");
    check_xml("fine", &html);
}

#[test]
fn texts_of_the_user_are_escaped() {
    let html = page(&compute("a & b's \u{7f1d}", &cases()[2].1));
    assert!(html.contains("a &amp; b&#39;s \u{7f1d}"));
    assert!(html.contains("soft &lt;b&gt;&amp;&quot;") && !html.contains("soft <b>"));
    assert!(html.contains("stiff ]]&gt;ä"));
    assert!(html.contains("the whole result, &quot;schema&quot; &amp; all"));
}

#[test]
fn warnings_stand_at_the_head_or_their_absence_does() {
    let calm = page(&compute("calm", &cases()[0].1));
    assert!(calm.contains("Warnings: none"));
    let design = compute("roof", &cases()[2].1);
    let html = page(&design);
    assert!(!design.warnings().is_empty() && !html.contains("Warnings: none"));
    let (warning, numbers) = (html.find("is predicted to miss").unwrap(), html.find("Modulus contrast").unwrap());
    assert!(warning < numbers);
}

#[test]
fn numbers_of_the_summary_are_on_the_page() {
    let design = compute("hemisphere", &cases()[0].1);
    let html = page(&design);
    // Contrast, height, rim radius, horizontal force of one spoke in plane strain, voxels.
    for number in ["2.316", "63.66", "73.66", "−0.1160", "67\u{202f}000", "5.25–12.2"] {
        assert!(html.contains(number), "{number}");
    }
    assert!(html.contains(&Provenance::of(design.input()).design_sha256));
}

#[test]
fn verification_pictures_are_well_formed_whatever_they_are_given() {
    for (name, text) in cases() {
        let design = compute(name, &text);
        let svg = report::verification_svg(&picture(&design));
        check_xml(name, &svg);
        assert!(svg.contains("&lt;voxel&gt; &amp; co") && svg.len() < 200_000, "{name}: {}", svg.len());
        assert_eq!(svg, report::verification_svg(&picture(&design)));
    }
    let broken = VerificationPicture {
        target: vec![[0.0, 0.0], [f64::NAN, 1.0], [1.0, f64::INFINITY]],
        max_error_percent: f64::NAN,
        length_mm: f64::NAN,
        error_along: Some(vec![[f64::NAN, f64::NAN]]),
        ..VerificationPicture::default()
    };
    for picture in [VerificationPicture::default(), broken] {
        let svg = report::verification_svg(&picture);
        check_xml("broken", &svg);
        assert!(svg.contains("target") && !svg.contains("NaN"), "{svg}");
    }
}
