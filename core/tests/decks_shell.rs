//! Shell decks of the whole flower: what they say is what the design means.

mod flower;

use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use flower::{Label, Model};
use proptest::prelude::*;
use voxelastica_core::deck::{self, DeckPlan};
use voxelastica_core::input::files::Format;
use voxelastica_core::input::model::DeckKind;
use voxelastica_core::output::Provenance;
use voxelastica_core::{Design, DesignInput, Limits, progress};

const TWO: &str = "phases = [\"FLX9070\", \"FLX9095\"]";
/// A contrast of 3 280, which all four shapes of the paper are within.
const FAR: &str = "phases = [\"TangoBlack\", \"VeroClear\"]";
const STYLES: [&str; 2] = ["parts", "flat"];

fn design(target: &str, strips: &str, hub: &str, materials: &str, rest: &str) -> Design {
    let text = format!(
        "name = \"dome\"\n[target]\n{target}\n[strips]\n{strips}\n[thrust]\nhub = \"{hub}\"\n[materials]\n{materials}\n\
         [voxels]\n{rest}"
    );
    let input = DesignInput::from_text(&text, Format::Toml, "test.toml", "test", Path::new(".")).unwrap();
    Design::compute(&input, Limits::default()).unwrap()
}

fn strips(count: usize, hub_radius: f64) -> String {
    format!("count = {count}\nlength_mm = 100.0\nhub_radius_mm = {hub_radius:?}\nthickness_mm = 2.0")
}

const HEMISPHERE: &str = "kind = \"hemi-ellipsoid\"";

fn hemisphere(style: &str) -> Design {
    design(HEMISPHERE, &strips(8, 10.0), "free", TWO, &format!("size_mm = 0.5\n[decks]\nstyle = \"{style}\""))
}

const KINDS: &str = "\"graded_shell\", \"voxel_shell\", \"graded_shell_indentation\", \"voxel_shell_indentation\"";

/// Small enough to be read by a person.
fn tiny(style: &str) -> Design {
    let strips = "count = 3\nlength_mm = 10.0\nhub_radius_mm = 1.0\nthickness_mm = 2.0";
    let rest = format!("size_mm = 2.0\n[decks]\nwrite = [{KINDS}]\nshell_elements = [4, 2]\nstyle = \"{style}\"");
    design("kind = \"hemi-ellipsoid\"\naspect_ratio = 2.0", strips, "held", TWO, &rest)
}

/// The paper's four shapes with coarse voxels.
fn shapes(hub: &str, style: &str) -> Vec<(&'static str, Design)> {
    let polynomial = |c: &str| format!("kind = \"inclination-polynomial\"\ncoefficients_deg = [{c}]");
    [
        ("hemisphere", "-90, 90", 8, 10.0),
        ("nose cone", "26.52, -116.3, 162.3, -132, 63.5, -47.14, 18.64, 41.56", 12, 5.0),
        ("trumpet", "-11340, 49160, -86720, 79040, -38440, 8860, -564.5, 87.1, 6.467", 8, 5.0),
        ("roof", "6395, -28300, 52140, -51860, 30530, -11170, 2808, -570.8, 89.7", 6, 20.0),
    ]
    .into_iter()
    .map(|(name, coefficients, count, radius)| {
        let rest = format!("size_mm = 2.0\n[decks]\nstyle = \"{style}\"");
        (name, design(&polynomial(coefficients), &strips(count, radius), hub, FAR, &rest))
    })
    .collect()
}

fn plan(design: &Design, kind: DeckKind) -> DeckPlan {
    deck::plan(design).into_iter().find(|p| p.kind == kind).unwrap()
}

fn written(design: &Design, kind: DeckKind) -> String {
    let provenance = Provenance { version: "0.0.0".to_owned(), seed: 1, design_sha256: "0".repeat(64) };
    let mut out = Vec::new();
    deck::write(design, &plan(design, kind), &provenance, &mut out, &progress::ignore).unwrap();
    String::from_utf8(out).unwrap()
}

fn azimuth(spoke: usize, count: usize) -> f64 {
    2.0 * PI * (spoke - 1) as f64 / count as f64
}

/// Position in a spoke's own axes: along from the rim, across, up.
fn local(point: [f64; 3], spoke: usize, design: &Design) -> [f64; 3] {
    let (sin, cos) = azimuth(spoke, design.input().count()).sin_cos();
    let radius = point[0] * cos + point[1] * sin;
    let rim = design.input().hub_radius() + design.input().strips.length_mm;
    [rim - radius, point[0] * sin - point[1] * cos, point[2]]
}

fn spoke_nodes(model: &Model, spoke: usize) -> BTreeSet<Label> {
    model.element_sets[&format!("SPOKE-{spoke}")].iter().flat_map(|e| model.elements[e].clone()).collect()
}

/// Cross product at each corner, and the area.
fn areas(corners: &[[f64; 3]]) -> ([f64; 4], f64) {
    let cross = |i: usize| {
        let (p, q, r) = (corners[i], corners[(i + 1) % 4], corners[(i + 3) % 4]);
        (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
    };
    let all = [0, 1, 2, 3].map(cross);
    (all, 0.5 * (all[0] + all[2]))
}

#[test]
fn the_papers_counts() {
    for style in STYLES {
        let design = hemisphere(style);
        let graded = plan(&design, DeckKind::GradedShell);
        // The paper's smooth flower has 16 340 elements.
        assert_eq!((graded.nodes, graded.elements), (8 * 97 * 21 + 1 + 8 * 110 + 17, 8 * 96 * 20 + 8 * 100));
        assert!((graded.elements as f64 / 16_340.0 - 1.0).abs() < 0.02);
        // Its discrete one 133 840.
        let voxel = plan(&design, DeckKind::VoxelShell);
        assert_eq!(voxel.elements, 134_000);
        assert!((voxel.elements as f64 / 133_840.0 - 1.0).abs() < 5e-3);
        for (kind, plan) in [(DeckKind::GradedShell, graded), (DeckKind::VoxelShell, voxel)] {
            let text = written(&design, kind);
            assert!((plan.bytes as f64 / text.len() as f64 - 1.0).abs() < 0.02, "{} {}", plan.bytes, text.len());
            assert!(text.lines().all(|l| l.len() <= 256) && !text.contains("-0,") && !text.contains("NaN"));
            let model = Model::read(&text);
            assert_eq!((model.nodes.len() as u64, model.elements.len() as u64), (plan.nodes, plan.elements));
            if style == "flat" {
                assert!(model.nodes.keys().map(|k| k.1).eq(1..=plan.nodes));
                assert!(model.elements.keys().map(|k| k.1).eq(1..=plan.elements));
            }
        }
    }
}

#[test]
fn strips_have_no_flower() {
    let text = "[target]\nkind = \"strip\"\nwidth_mm = 12.0\nmodulus_ratio = 2.0\nshortening = 0.6\n[strips]\n\
                length_mm = 40.0\nthickness_mm = 2.0\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\n\
                size_mm = 0.5\n";
    let input = DesignInput::from_text(text, Format::Toml, "test.toml", "test", Path::new(".")).unwrap();
    let design = Design::compute(&input, Limits::default()).unwrap();
    let shell = |kind| matches!(kind, DeckKind::GradedShell | DeckKind::VoxelShell);
    assert!(deck::plan(&design).iter().all(|p| !shell(p.kind)));
}

#[test]
fn both_layouts_describe_the_same_model() {
    for kind in [DeckKind::GradedShell, DeckKind::VoxelShell] {
        let [parts, flat] = STYLES.map(|style| Model::read(&written(&tiny(style), kind)));
        assert_eq!(parts.elements.len(), flat.elements.len());
        let sets = |model: &Model| model.node_sets.keys().cloned().collect::<Vec<_>>();
        assert_eq!(sets(&parts), sets(&flat));
        for set in parts.node_sets.keys() {
            let (a, b) = (parts.points(set), flat.points(set));
            assert_eq!(a.len(), b.len(), "{set}");
            for (p, q) in a.iter().zip(&b) {
                assert!((0..3).all(|i| (p[i] - q[i]).abs() < 1e-7), "{set}: {p:?} {q:?}");
            }
        }
        for spoke in 1..=3 {
            let set = format!("SPOKE-{spoke}");
            for (a, b) in parts.element_sets[&set].iter().zip(&flat.element_sets[&set]) {
                let (a_corners, b_corners) = (parts.corners(a), flat.corners(b));
                for (p, q) in a_corners.iter().zip(&b_corners) {
                    assert!((p[0] - q[0]).hypot(p[1] - q[1]) < 1e-7);
                }
                for (p, q) in parts.elements[a].iter().zip(&flat.elements[b]) {
                    assert_eq!(parts.field[p], flat.field[q]);
                }
            }
        }
        let ends = |model: &Model| {
            (model.transforms.clone(), model.rigid.clone(), model.equations.clone(), model.boundary.clone())
        };
        assert_eq!(ends(&parts), ends(&flat));
        let slices = |model: &Model| model.element_sets.keys().filter(|k| k.starts_with("SLICE-")).count();
        let expected = if kind == DeckKind::VoxelShell { 5 } else { 0 };
        assert_eq!((slices(&parts), slices(&flat)), (expected, expected));
        let slice = if kind == DeckKind::VoxelShell { flat.element_sets["SLICE-2"].len() } else { 0 };
        assert_eq!(slice, if slice == 0 { 0 } else { 3 * 2 * tiny("flat").grid().half_widths()[1] });
    }
}

#[test]
fn every_node_has_the_designed_modulus() {
    for style in STYLES {
        let design = hemisphere(style);
        for kind in [DeckKind::GradedShell, DeckKind::VoxelShell] {
            let model = Model::read(&written(&design, kind));
            for nodes in model.elements.values() {
                assert!(nodes.iter().all(|n| model.field.contains_key(n)));
            }
            for spoke in [1, 2, 5, 8] {
                for node in spoke_nodes(&model, spoke).iter().step_by(7) {
                    let [s, y, z] = local(model.nodes[node], spoke, &design);
                    assert!(z == 0.0);
                    let (width, modulus) = design.width_and_modulus(s.clamp(0.0, 100.0));
                    let expected = if kind == DeckKind::GradedShell {
                        assert!(y.abs() <= 0.5 * width + 1e-6);
                        modulus
                    } else {
                        // The mean of the slices beside the row.
                        let row = (s / 0.5).round();
                        assert!((s - 0.5 * row).abs() < 1e-6);
                        let at = |slice: f64| {
                            let i = slice.clamp(0.0, 199.0) as usize;
                            let (width, modulus) = design.width_and_modulus((i as f64 + 0.5) * 0.5);
                            modulus * width / design.grid().half_widths()[i] as f64
                        };
                        0.5 * (at(row - 1.0) + at(row))
                    };
                    let found = model.field[node];
                    // A node's s is rounded to 1e-7 mm, its modulus to ten digits.
                    assert!((found / expected - 1.0).abs() < 1e-7, "{kind:?} spoke {spoke} s {s}: {found} {expected}");
                }
            }
        }
    }
}

#[test]
fn sets_run_from_rim_to_hub_and_meet_their_reference_nodes() {
    for style in STYLES {
        let rest = format!("size_mm = 1.0\n[decks]\nshell_elements = [40, 6]\nstyle = \"{style}\"");
        let design = design(HEMISPHERE, &strips(8, 10.0), "free", TWO, &rest);
        for kind in [DeckKind::GradedShell, DeckKind::VoxelShell] {
            let model = Model::read(&written(&design, kind));
            for spoke in 1..=8 {
                let own = |set: &str| {
                    let points = model.points(&format!("{set}-{spoke}"));
                    points.into_iter().map(|p| local(p, spoke, &design)).collect::<Vec<_>>()
                };
                let midline = &model.node_sets[&format!("MIDLINE-{spoke}")];
                assert!(midline.windows(2).all(|w| w[0] < w[1]), "sorting must not change the order");
                let line = own("MIDLINE");
                assert!(line.iter().all(|p| p[1].abs() < 1e-6) && line.windows(2).all(|w| w[0][0] < w[1][0]));
                assert!(line[0][0].abs() < 1e-6 && (line[line.len() - 1][0] - 100.0).abs() < 1e-6);
                for (edge, reference, s) in [("RIM", "RP-RIM", 0.0), ("HUB", "RP-HUB", 100.0)] {
                    assert!(own(edge).iter().all(|p| (p[0] - s).abs() < 1e-6));
                    let middle = own(edge).iter().map(|p| p[1]).sum::<f64>() / own(edge).len() as f64;
                    let point = own(reference)[0];
                    assert!((point[0] - s).abs() < 1e-6 && (point[1] - middle).abs() < 1e-6);
                    let pair = (format!("{edge}-{spoke}"), format!("{reference}-{spoke}"));
                    assert!(model.rigid.contains(&pair));
                }
                let ends = own("RIM").len() + own("HUB").len();
                let along = |n: &Label| local(model.nodes[n], spoke, &design)[0];
                let nodes = spoke_nodes(&model, spoke);
                let at_ends = nodes.iter().filter(|n| along(n) < 1e-6 || along(n) > 100.0 - 1e-6).count();
                assert_eq!(ends, at_ends, "all nodes of both edges are in their sets");
            }
            let mut tied = BTreeSet::new();
            for (nodes, _) in &model.rigid {
                assert!(model.node_sets[nodes].iter().all(|n| tied.insert(n.clone())), "{nodes} is tied twice");
            }
            assert_eq!(model.rigid.len(), if kind == DeckKind::GradedShell { 17 } else { 16 });
            assert_eq!(model.points("RP-HUB"), [[0.0; 3]]);
        }
    }
}

#[test]
fn flat_spokes_do_not_overlap_and_elements_are_well_shaped() {
    for (name, design) in shapes("free", "flat") {
        let model = Model::read(&written(&design, DeckKind::GradedShell));
        let (count, radius) = (design.input().count(), design.input().hub_radius());
        let slope = (PI / count as f64).tan();
        let mut aspect: f64 = 1.0;
        for spoke in 1..=count {
            for node in spoke_nodes(&model, spoke) {
                let [s, y, _] = local(model.nodes[&node], spoke, &design);
                // Within its own sector, whose borders only the hub end touches.
                assert!(y.abs() <= slope * (radius + 100.0 - s) + 1e-6, "{name}: spoke {spoke}, s = {s}");
            }
            for element in &model.element_sets[&format!("SPOKE-{spoke}")] {
                let corners = model.corners(element);
                let (at_corners, _) = areas(&corners);
                assert!(at_corners.iter().all(|a| *a > 0.0), "{name}: normals point up");
                let side = |i: usize| {
                    let (p, q) = (corners[i], corners[(i + 1) % 4]);
                    (p[0] - q[0]).hypot(p[1] - q[1])
                };
                let ratio = (side(0) + side(2)) / (side(1) + side(3));
                aspect = aspect.max(ratio).max(1.0 / ratio);
            }
        }
        println!("{name}: worst aspect ratio {aspect:.2}");
        assert!(aspect < 4.2, "{name}: {aspect}");
    }
}

#[test]
fn morphed_spokes_share_their_edges() {
    for (name, design) in shapes("held", "parts") {
        let model = Model::read(&written(&design, DeckKind::GradedShell));
        let count = design.input().count();
        let target = design.target().unwrap();
        let hub_x = target.stations[target.stations.len() - 1].x;
        // A point of the edge in space: radius and height of the target, the distance across kept.
        let morphed = |spoke: usize, side: f64, [s, half_width]: [f64; 2]| {
            let point = target.curve.at(s.clamp(0.0, 100.0));
            let (rho, y) = (design.input().hub_radius() + hub_x - point.x, side * half_width);
            let (sin, cos) = azimuth(spoke, count).sin_cos();
            [rho * cos + y * sin, rho * sin - y * cos, point.z]
        };
        // Distance from the rim and half-width of every row of nodes.
        let rows = |spoke: usize| {
            let nodes = spoke_nodes(&model, spoke);
            let mut points: Vec<_> = nodes.iter().map(|n| local(model.nodes[n], spoke, &design)).collect();
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let rows = points.chunk_by(|a, b| b[0] - a[0] < 1e-5);
            rows.map(|row| [row[0][0], row.iter().map(|p| p[1]).fold(0.0, f64::max)]).collect::<Vec<_>>()
        };
        for spoke in 1..=count {
            let next = spoke % count + 1;
            let (own, others) = (rows(spoke), rows(next));
            assert_eq!((own.len(), others.len()), (97, 97));
            let gap = own
                .iter()
                .zip(&others)
                .map(|(a, b)| {
                    // Across is clockwise, so the counter-clockwise neighbour is at the negative side.
                    let (p, q) = (morphed(spoke, -1.0, *a), morphed(next, 1.0, *b));
                    (0..3).map(|i| (p[i] - q[i]).powi(2)).sum::<f64>().sqrt()
                })
                .fold(0.0, f64::max);
            assert!(gap < 1e-6 * 100.0, "{name}: spokes {spoke} and {next} are {gap} mm apart");
        }
    }
}

#[test]
fn the_hub_is_a_polygon_that_meets_the_spokes() {
    for style in STYLES {
        for (name, design) in shapes("free", style) {
            let model = Model::read(&written(&design, DeckKind::GradedShell));
            let (count, radius) = (design.input().count(), design.input().hub_radius());
            let mut total = 0.0;
            for element in &model.element_sets["HUB"] {
                let (at_corners, area) = areas(&model.corners(element));
                assert!(at_corners.iter().all(|a| *a > 0.0));
                total += area;
            }
            let expected = count as f64 * (PI / count as f64).tan() * radius * radius;
            assert!((total / expected - 1.0).abs() < 1e-7, "{name}: {total} {expected}");
            let hub: BTreeSet<Label> = model.node_sets["HUB-PLATE"].iter().cloned().collect();
            for spoke in 1..=count {
                for node in &model.node_sets[&format!("HUB-{spoke}")] {
                    assert!(!hub.contains(node));
                    let p = model.nodes[node];
                    let nearest = hub.iter().map(|n| model.nodes[n]).map(|q| (p[0] - q[0]).hypot(p[1] - q[1]));
                    assert!(nearest.fold(f64::MAX, f64::min) < 1e-6, "{name}");
                }
            }
        }
    }
}

/// Moves the reference nodes as the deck says, in the axes it gives them, and looks where the rigid edges end up.
#[test]
fn boundary_conditions_lead_to_the_target() {
    for hub in ["free", "held"] {
        for (name, design) in shapes(hub, "flat") {
            let target = design.target().unwrap();
            let (first, last) = (target.stations[0], target.stations[target.stations.len() - 1]);
            let hub_radius = design.input().hub_radius();
            for kind in [DeckKind::GradedShell, DeckKind::VoxelShell] {
                let model = Model::read(&written(&design, kind));
                let fixed = |set: &str, dof: u8| model.boundary.get(&(set.to_owned(), dof)).copied();
                let held = fixed("RP-HUB", 3);
                assert_eq!(held.is_some(), hub == "held");
                // The hub is free in height at most; its followers' heights are eliminated and must not be prescribed.
                assert!([1, 2, 4, 5, 6].iter().all(|dof| fixed("RP-HUB", *dof) == Some(0.0)));
                assert!(fixed("RP-HUBS", 3).is_none());
                for spoke in 1..=design.input().count() {
                    let (sin, cos) = azimuth(spoke, design.input().count()).sin_cos();
                    assert!(model.equations.contains(&format!("2 RP-HUB-{spoke},3,1.,RP-HUB,3,-1.")));
                    for (sets, reference, inclination, radius, height) in [
                        ("RP-RIMS", format!("RP-RIM-{spoke}"), first.inclination, hub_radius + last.x, Some(0.0)),
                        ("RP-HUBS", format!("RP-HUB-{spoke}"), last.inclination, hub_radius, held.map(|_| last.z)),
                    ] {
                        assert!(model.node_sets[sets].contains(&model.node_sets[&reference][0]));
                        let system = &model.transforms[&reference];
                        let (a, b) = ([system[0], system[1], system[2]], [system[3], system[4], system[5]]);
                        let axes = [a, b, cross(a, b)];
                        let global = |v: [f64; 3]| [0, 1, 2].map(|i| (0..3).map(|k| v[k] * axes[k][i]).sum::<f64>());
                        let third = if sets == "RP-HUBS" { held.unwrap_or(0.0) } else { fixed(sets, 3).unwrap() };
                        let u = global([fixed(sets, 1).unwrap(), fixed(sets, 2).unwrap(), third]);
                        let start = model.points(&reference)[0];
                        let end = [start[0] + u[0], start[1] + u[1], start[2] + u[2]];
                        let expected = [radius * cos, radius * sin, height.unwrap_or(end[2])];
                        assert!((0..3).all(|i| (end[i] - expected[i]).abs() < 1e-6), "{name}: {end:?} {expected:?}");
                        // The strip runs inward; rotating it about the given vector must give the target's tangent.
                        let turn = global([4, 5, 6].map(|dof| fixed(sets, dof).unwrap()));
                        let tangent = rotate([-cos, -sin, 0.0], turn);
                        let wanted = [-cos * inclination.cos(), -sin * inclination.cos(), inclination.sin()];
                        assert!(
                            (0..3).all(|i| (tangent[i] - wanted[i]).abs() < 1e-8),
                            "{name}: {tangent:?} {wanted:?}"
                        );
                    }
                }
            }
        }
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Rotates a vector about another by that one's length, right-handed.
fn rotate(v: [f64; 3], turn: [f64; 3]) -> [f64; 3] {
    let angle = turn.iter().map(|c| c * c).sum::<f64>().sqrt();
    if angle == 0.0 {
        return v;
    }
    let k = turn.map(|c| c / angle);
    let (sin, cos) = angle.sin_cos();
    let across = cross(k, v);
    let along: f64 = (0..3).map(|i| k[i] * v[i]).sum();
    [0, 1, 2].map(|i| v[i] * cos + across[i] * sin + k[i] * along * (1.0 - cos))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn meshes_are_sound(
        count in 3_usize..14,
        hub_radius in 0.3_f64..30.0,
        aspect in 0.4_f64..2.2,
        elements in (2_usize..9, 1_usize..5),
        size in prop::sample::select(vec![0.5, 1.0, 2.0]),
        rounding in prop::sample::select(vec!["nearest", "inward"]),
        style in prop::sample::select(STYLES.to_vec()),
    ) {
        let design = design(
            &format!("kind = \"hemi-ellipsoid\"\naspect_ratio = {aspect:?}"),
            &format!("count = {count}\nlength_mm = 12.0\nhub_radius_mm = {hub_radius:?}\nthickness_mm = 2.0"),
            "free",
            FAR,
            &format!(
                "size_mm = {size:?}\nrounding = \"{rounding}\"\n[decks]\nstyle = \"{style}\"\n\
                 shell_elements = [{}, {}]", elements.0, 2 * elements.1
            ),
        );
        for kind in [DeckKind::GradedShell, DeckKind::VoxelShell] {
            let plan = plan(&design, kind);
            let model = Model::read(&written(&design, kind));
            prop_assert_eq!((model.nodes.len() as u64, model.elements.len() as u64), (plan.nodes, plan.elements));
            let used: BTreeSet<&Label> = model.elements.values().flatten().collect();
            prop_assert_eq!(used.len() + 2 * count + 1, model.nodes.len(), "nodes belong to elements or are references");
            prop_assert!(used.iter().all(|n| model.field.get(*n).is_some_and(|value| *value > 0.0)));
            for element in model.elements.keys() {
                prop_assert!(areas(&model.corners(element)).0.iter().all(|a| *a > 0.0), "{:?}", element);
            }
        }
    }
}

/// Numbers of the first data line below a keyword line, in the last step that has one.
fn last_data(text: &str, keyword: &str) -> Vec<String> {
    let lines: Vec<&str> = text.lines().collect();
    let at = lines.iter().rposition(|l| *l == keyword).unwrap_or_else(|| panic!("no {keyword}"));
    lines[at + 1].split(',').map(str::to_owned).collect()
}

#[test]
fn the_indenter_starts_above_what_it_covers_and_goes_down_by_the_depth() {
    for style in STYLES {
        for hub in ["free", "held"] {
            let rest = format!("size_mm = 1.0\n[decks]\nwrite = [{KINDS}]\nstyle = \"{style}\"");
            let design = design(HEMISPHERE, &strips(8, 10.0), hub, TWO, &rest);
            let profile = design.profile();
            let (top, radius) = (profile.z[profile.z.len() - 1], 0.339 * profile.rho[0]);
            for (kind, half) in [(DeckKind::GradedShellIndentation, 1.0), (DeckKind::VoxelShellIndentation, 0.25)] {
                let text = written(&design, kind);
                let model = Model::read(&text);
                let plate = &model.element_sets["INDENTER"];
                let nodes: BTreeSet<Label> = plate.iter().flat_map(|e| model.elements[e].clone()).collect();
                let heights = nodes.iter().map(|n| model.nodes[n][2]);
                let [low, high] = heights.fold([f64::MAX, f64::MIN], |[low, high], z| [low.min(z), high.max(z)]);
                assert!(low == high && low > half && low < half + 0.02, "{low} {high}");
                // The edge is straight across spoke 1, at the radius.
                let reach = nodes.iter().map(|n| model.nodes[n][0]).fold(0.0, f64::max);
                assert!((reach - radius).abs() < 1e-6, "{reach} {radius}");
                let explicit = kind == DeckKind::VoxelShellIndentation;
                // A velocity acts for the unit of time that a step of equilibria takes.
                let moved = |keyword: &str| {
                    let data = last_data(&text, keyword);
                    assert_eq!(data[..3], ["RP-HUB", "3", "3"]);
                    data[3].parse::<f64>().unwrap()
                };
                let total = match (explicit, hub) {
                    (true, _) => course(&text, hub == "held"),
                    (false, "free") => moved("*BOUNDARY, TYPE=VELOCITY"),
                    (false, _) => moved("*BOUNDARY") - top,
                };
                assert!((total + 10.0).abs() < 1e-3, "{style} {hub} {}: {total}", kind.name());
            }
        }
    }
}

/// How far the amplitude PRESS moves the hub: the change of a height, or the integral of a velocity.
fn course(text: &str, height: bool) -> f64 {
    let lines: Vec<&str> = text.lines().collect();
    let start = lines.iter().position(|l| *l == "*AMPLITUDE, NAME=PRESS").unwrap() + 1;
    let rows = lines[start..].iter().take_while(|l| !l.starts_with('*'));
    let numbers: Vec<f64> = rows.flat_map(|l| l.split(',')).map(|w| w.parse().unwrap()).collect();
    let points: Vec<[f64; 2]> = numbers.chunks(2).map(|p| [p[0], p[1]]).collect();
    let keyword = if height { "*BOUNDARY, AMPLITUDE=PRESS" } else { "*BOUNDARY, TYPE=VELOCITY, AMPLITUDE=PRESS" };
    let value: f64 = last_data(text, keyword)[3].parse().unwrap();
    let (first, last) = (points[0], points[points.len() - 1]);
    if height {
        // It starts where the morph ends: a jump would be ignored.
        assert_eq!(first[1], 1.0);
        return value * (last[1] - first[1]);
    }
    assert_eq!((first[1], last[1]), (0.0, 0.0));
    value * points.windows(2).map(|p| 0.5 * (p[0][1] + p[1][1]) * (p[1][0] - p[0][0])).sum::<f64>()
}

#[test]
fn the_loading_rate_sets_the_time_and_mass_scaling_is_only_written_where_asked_for() {
    let text = |more: &str| {
        let rest = format!("size_mm = 1.0\n[decks]\nwrite = [{KINDS}]\n[indentation]\ndepth_mm = 5.0\n{more}");
        let design = design(HEMISPHERE, &strips(8, 10.0), "free", TWO, &rest);
        let height = design.profile().z.iter().copied().fold(0.0, f64::max);
        (written(&design, DeckKind::VoxelShellIndentation), height)
    };
    let time = |text: &str| last_data(text, "*DYNAMIC, EXPLICIT")[1].parse::<f64>().unwrap();
    let (plain, height) = text("");
    assert!((time(&plain) - 5.0 / height / 0.1).abs() < 1e-6);
    assert!(!plain.contains("MASS SCALING"));
    let (scaled, _) = text("loading_rate_per_s = 0.5\nmass_scaling = 100.0");
    assert!((time(&scaled) - 5.0 / height / 0.5).abs() < 1e-6);
    assert_eq!(scaled.matches("*FIXED MASS SCALING, FACTOR=100").count(), 1);
}

#[test]
fn a_dome_that_is_not_as_deep_as_asked_is_said_to_have_no_deck() {
    let rest = format!("size_mm = 1.0\n[decks]\nwrite = [{KINDS}]\n[indentation]\ndepth_mm = 80.0");
    let design = design(HEMISPHERE, &strips(8, 10.0), "free", TWO, &rest);
    let kinds: Vec<DeckKind> = deck::plan(&design).iter().map(|p| p.kind).collect();
    assert_eq!(kinds, [DeckKind::GradedShell, DeckKind::VoxelShell]);
    let warnings = design.warnings_for_files();
    let about = |name: &str| warnings.iter().any(|w| w.contains(name) && w.contains("indentation.depth_mm"));
    assert!(about("graded_shell_indentation") && about("voxel_shell_indentation"), "{warnings:?}");
}

/// Compares with `tests/golden`, or rewrites it where `VOXELASTICA_UPDATE_GOLDEN` is set.
#[test]
fn shell_decks_are_the_golden_ones() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    for style in STYLES {
        let design = tiny(style);
        for (kind, file) in [
            (DeckKind::GradedShell, "graded_shell"),
            (DeckKind::VoxelShell, "voxel_shell"),
            (DeckKind::GradedShellIndentation, "graded_shell_indentation"),
            (DeckKind::VoxelShellIndentation, "voxel_shell_indentation"),
        ] {
            let text = written(&design, kind);
            let path = folder.join(format!("flower_{style}_abaqus_{file}.inp"));
            if std::env::var_os("VOXELASTICA_UPDATE_GOLDEN").is_some() {
                std::fs::create_dir_all(&folder).unwrap();
                std::fs::write(&path, &text).unwrap();
            }
            let golden = std::fs::read_to_string(&path).unwrap_or_default();
            assert_eq!(text.lines().count(), golden.lines().count(), "{}", path.display());
            for (found, wanted) in text.lines().zip(golden.lines()) {
                // The last digits may differ between mathematical libraries.
                let close = |(a, b): (&str, &str)| {
                    let near = |a: f64, b: f64| (a - b).abs() <= 2e-8 * b.abs().max(1e-3);
                    a == b || matches!((a.parse(), b.parse()), (Ok(a), Ok(b)) if near(a, b))
                };
                let same = found.split(',').count() == wanted.split(',').count()
                    && found.split(',').zip(wanted.split(',')).all(close);
                assert!(same, "{}: \"{found}\" for \"{wanted}\"", path.display());
            }
            assert_eq!(text, written(&design, kind), "the same design gives the same bytes");
        }
    }
}
