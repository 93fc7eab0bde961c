//! Wrong design files: every message names file, line, key and value, and says what would help.

use std::path::Path;

use voxelastica_core::input::files::Format;
use voxelastica_core::input::parameters::{Kind, PARAMETERS};
use voxelastica_core::input::schema::json_schema;
use voxelastica_core::{Design, DesignInput, InputError, Limits};

const GOOD: &str = r#"name = "dome"
[target]
kind = "hemi-ellipsoid"
aspect_ratio = 1.0
[strips]
count = 8
length_mm = 40.0
hub_radius_mm = 4.0
thickness_mm = 2.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 1.0
"#;

fn parse(text: &str) -> Result<DesignInput, InputError> {
    DesignInput::from_text(text, Format::Toml, "dome.toml", "dome", Path::new("."))
}

/// Replaces one line and returns the error, from reading or from computing.
fn error(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    let text = GOOD.replacen(from, to, 1);
    match parse(&text) {
        Err(error) => error.to_string(),
        Ok(input) => Design::compute(&input, Limits::default()).expect_err("this must be refused").to_string(),
    }
}

#[test]
fn wrong_values_name_file_line_key_value_and_help() {
    for (from, to, expected) in [
        ("count = 8", "cuont = 8", "dome.toml:6: strips.cuont: unknown key; did you mean \"count\"?"),
        ("[voxels]", "[voxel]", "dome.toml:12: voxel: unknown key; did you mean \"voxels\"?"),
        ("count = 8", "count = 2", "dome.toml:6: strips.count = 2: this must be a whole number between 3 and 1000"),
        ("count = 8", "count = 8.5", "strips.count = 8.5: this must be a whole number"),
        ("count = 8", "count = \"8\"", "strips.count = \"8\": this must be a whole number"),
        ("length_mm = 40.0", "length_mm = -40.0", "strips.length_mm = -40.0: this must be greater than 0 mm"),
        ("length_mm = 40.0", "length_mm = inf", "strips.length_mm = inf: numbers must be finite"),
        ("length_mm = 40.0", "length_mm = nan", "strips.length_mm = nan: numbers must be finite"),
        (
            "length_mm = 40.0",
            "length_mm = 1e300",
            "strips.length_mm = 1e+300: this must be greater than 0 mm and at most",
        ),
        ("hub_radius_mm = 4.0", "hub_radius_mm = 0.0", "strips.hub_radius_mm = 0.0: this must be greater than 0 mm"),
        ("hub_radius_mm = 4.0", "", "strips.hub_radius_mm: this key is missing"),
        ("size_mm = 1.0", "size_mm = 0.3", "voxels.size_mm = 0.3: voxels of 0.3 mm do not divide"),
        ("size_mm = 1.0", "size_mm = 0.3", "the nearest size that does is"),
        ("size_mm = 1.0", "size_mm = 4.0", "the thickness of 2 mm is less than one voxel of 4 mm"),
        ("size_mm = 1.0", "size_mm = 0.001", "more than the limit"),
        ("\"FLX9070\", \"FLX9095\"", "\"FLX9070\", \"FLX9905\"", "did you mean \"FLX9095\"?"),
        ("\"FLX9070\", \"FLX9095\"", "\"FLX9095\", \"FLX9070\"", "phases go from the softest to the stiffest; swap"),
        ("\"FLX9070\", \"FLX9095\"", "\"FLX9070\"", "materials.phases = [\"FLX9070\"]: this must have 2 to 3 entries"),
        ("\"hemi-ellipsoid\"", "\"hemi-elipsoid\"", "did you mean \"hemi-ellipsoid\"?"),
        ("aspect_ratio = 1.0", "aspect_ratio = 100.0", "target.aspect_ratio = 100.0: this must be at least 0.05"),
        ("aspect_ratio = 1.0", "width_mm = 4.0", "does not apply to a target of kind \"hemi-ellipsoid\"; remove it"),
        ("aspect_ratio = 1.0", "aspect_ratio = 2026-01-01", "no key accepts a date"),
        ("thickness_mm = 2.0", "thickness_mm = 20.0", "too thick to bend"),
        ("[voxels]", "[thrust]\nhub = \"held\"\nchoice = \"equal-ends\"\n[voxels]", "thrust.choice = \"equal-ends\""),
        ("name = \"dome\"", "name = \"a/b\"", "not usable as a file name"),
        ("[target]", "[target", "dome.toml:2: this is not TOML"),
        ("size_mm = 1.0", "size_mm = 1.0\nsize_mm = 2.0", "this is not TOML"),
        ("[materials]", "[decks]\nwrite = [\"solid\"]\n[materials]", "it is one of \"graded_shell\""),
        ("[materials]", "[decks]\nshell_elements = [10, 3]\n[materials]", "must be even"),
        ("kind = \"hemi-ellipsoid\"\naspect_ratio = 1.0", "kind = \"points\"", "target.file: this key is missing"),
    ] {
        let message = error(from, to);
        assert!(message.contains(expected), "{to}: {message}");
        assert!(message.starts_with("dome.toml:") || message.contains("more than the limit"), "{message}");
    }
}

#[test]
fn custom_materials_are_checked_entry_by_entry() {
    let custom = |body: &str| error("[voxels]", &format!("[[materials.custom]]\n{body}\n[voxels]"));
    assert!(custom("name = \"x\"\npoisson = 0.3").contains("materials.custom.0.modulus_mpa: this key is missing"));
    assert!(custom("name = \"x\"\nmodulus_mpa = 1\npoisson = 0.5").contains("materials.custom.0.poisson = 0.5"));
    assert!(custom("name = \"x\"\nmodulus = 1\npoisson = 0.3").contains("did you mean \"modulus_mpa\"?"));
}

#[test]
fn defaults_are_filled_in_and_survive_a_round_trip_through_json() {
    let input = parse(GOOD).unwrap();
    assert_eq!(input.voxels.seed, 1);
    assert_eq!(input.decks.write.len(), 4);
    let json = serde_json::to_string(&input).unwrap();
    let again = DesignInput::from_text(&json, Format::Json, "dome.json", "other", Path::new(".")).unwrap();
    assert_eq!(again, input);
}

#[test]
fn wrong_json_is_refused_with_its_line_or_schema() {
    let read =
        |text: &str| DesignInput::from_text(text, Format::Json, "x.json", "x", Path::new(".")).unwrap_err().to_string();
    assert!(read("{\n\"target\": }").contains("x.json:2: this is not JSON"));
    assert!(read("[]").contains("must be a JSON object"));
    assert!(read("{\"schema\": \"voxelastica/design/9\"}").contains("this build reads"));
    assert!(read("{\"schema\": \"voxelastica/design/1\"}").contains("holds no design table"));
}

#[test]
fn the_schema_knows_every_key_and_its_unit() {
    let schema = json_schema();
    for parameter in PARAMETERS {
        let mut node = &schema;
        for key in parameter.key.split('.') {
            node = &node["properties"][key];
            if key == "custom" {
                node = &node["items"];
            }
        }
        if matches!(parameter.kind, Kind::Recorded) {
            continue;
        }
        assert!(node["description"].is_string(), "{}", parameter.key);
        assert_eq!(node["x-unit"].as_str(), parameter.unit, "{}", parameter.key);
    }
}

/// `VOXELASTICA_UPDATE_DOCS=1 cargo test` rewrites the reference.
#[test]
fn the_documented_keys_are_those_of_the_table() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/design-file.md");
    let text = std::fs::read_to_string(&path).unwrap();
    let marker = "<!-- keys: made from the parameter table; `cargo test` says when they differ -->\n";
    let (before, documented) = text.split_once(marker).unwrap();
    let table = voxelastica_core::input::reference::markdown();
    if std::env::var_os("VOXELASTICA_UPDATE_DOCS").is_some() {
        std::fs::write(&path, format!("{before}{marker}{table}")).unwrap();
    } else {
        assert_eq!(documented, table, "run the tests once with VOXELASTICA_UPDATE_DOCS=1");
    }
}
