//! The optimum beats a grid of the same cost, keeps its limits, and is a design that `design` takes.

use std::path::Path;

use voxelastica_core::input::DesignInput;
use voxelastica_core::optimise::figures::Outcome;
use voxelastica_core::optimise::space::VariableKind;
use voxelastica_core::optimise::{Optimisation, Optimum, output};
use voxelastica_core::{Design, Error, Limits, progress};

const BASE: &str = "count = 8\nlength_mm = 60.0\nhub_radius_mm = 6.0\nthickness_mm = 2.0\n[thrust]\nhub = \"free\"\n\
                    [materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\nsize_mm = 1.0\n[decks]\nwrite = []\n\
                    [indentation]\nsteps = 12\n[fabrication]\nscope = \"flower\"\n";

const VARIABLES: &str = "[[variables]]\nkey = \"materials.phases\"\n\
                         values = [[\"FLX9070\", \"FLX9095\"], [\"TangoBlack\", \"VeroClear\"]]\n\
                         [[variables]]\nkey = \"strips.count\"\nfrom = 6\nto = 12\n\
                         [[variables]]\nkey = \"strips.hub_radius_mm\"\nfrom = 3.0\nto = 20.0\n\
                         [[variables]]\nkey = \"strips.thickness_mm\"\nfrom = 1.0\nto = 4.0\n";

/// A hemisphere, an ellipsoid and the roof of the paper.
const TARGETS: [&str; 3] = [
    "kind = \"hemi-ellipsoid\"",
    "kind = \"hemi-ellipsoid\"\naspect_ratio = 0.7",
    "kind = \"inclination-polynomial\"\ncoefficients_deg = [6395, -28300, 52140, -51860, 30530, -11170, 2808, -570.8, 89.7]",
];

fn optimisation(folder: &Path, target: &str, text: &str) -> Result<Optimisation, Error> {
    std::fs::write(folder.join("base.toml"), format!("[target]\n{target}\n[strips]\n{BASE}")).unwrap();
    let file = folder.join("optimise.toml");
    std::fs::write(&file, format!("base = \"base.toml\"\n{text}")).unwrap();
    Optimisation::read(&file)
}

fn run(optimisation: &Optimisation) -> Optimum {
    optimisation.run(2, &|_, _| true, &progress::never).unwrap()
}

/// The best of a grid of at least as many designs, ends of ranges included.
fn grid(optimisation: &Optimisation, counts: &[usize]) -> (f64, u64) {
    let variables = optimisation.space().variables();
    let total: usize = counts.iter().product();
    let place = |number: usize| -> Vec<f64> {
        let mut rest = number;
        let share = |(count, variable): (&usize, &_)| {
            let index = rest % count;
            rest /= count;
            let variable: &voxelastica_core::optimise::space::Variable = variable;
            let share = index as f64 / (count - 1).max(1) as f64;
            match variable.kind() {
                VariableKind::Choice { count } | VariableKind::Steps { count, .. } => {
                    (share * (count - 1) as f64).round()
                }
                VariableKind::Range => share,
            }
        };
        counts.iter().zip(variables).map(share).collect()
    };
    let achieved = |number: usize| {
        let outcome = optimisation.outcome(&place(number), &progress::never).unwrap();
        optimisation.goal().achieved(&outcome)
    };
    let best = (0..total).filter_map(|n| Some((achieved(n)?, n))).fold((0.0, 0), |m, x| if x.0 > m.0 { x } else { m });
    println!("grid best {:?}", optimisation.space().values(&place(best.1)));
    (best.0, total as u64)
}

#[test]
fn it_beats_a_grid_of_the_same_cost_on_three_targets() {
    let cases = [("specific_energy_nmm_mm3", 0.04), ("rigidity_n_mm", 0.04), ("specific_energy_nmm_mm3", 0.2)];
    for (target, (objective, strain)) in TARGETS.iter().zip(cases) {
        let folder = tempfile::tempdir().unwrap();
        let text = format!(
            "maximise = \"{objective}\"\nevaluations = 240\n[limits]\nlargest_strain = {strain}\n\
             printer_volume_mm = [150.0, 150.0, 100.0]\n{VARIABLES}"
        );
        let optimisation = optimisation(folder.path(), target, &text).unwrap();
        let optimum = run(&optimisation);
        assert!(optimum.evaluations.len() <= 240);
        let (most, cost) = grid(&optimisation, &[2, 4, 8, 4]);
        assert!(cost >= 240);
        println!("{target}: {:?}", optimum.refusals(optimisation.goal()));
        let best = optimum.best().unwrap();
        let achieved = optimisation.goal().achieved(&best.outcome).unwrap();
        println!("{target}: {achieved:.6e}, grid {most:.6e}, {:?}", best.values);
        println!("   {:?}", optimum.limits);
        assert!(achieved > most * (1.0 + 1e-6), "{target}: {achieved} {most}");
        // A limit binds, and that is said.
        assert!(optimum.limits.iter().any(|l| l.binds), "{:?}", optimum.limits);
        for limit in &optimum.limits {
            assert!(limit.value <= limit.most, "{limit:?}");
        }
        // What is written is a design file, and feasible.
        let out = folder.path().join("out");
        let files = output::write(&optimisation, &optimum, &out).unwrap();
        assert_eq!(files, ["optimum.toml", "evaluations.csv", "optimise.json"]);
        let input = DesignInput::read(&out.join("optimum.toml")).unwrap();
        let design = Design::compute(&input, Limits::default()).unwrap();
        let Outcome::Designed(figures) = &best.outcome else { panic!("{best:?}") };
        assert!((design.contrast() / figures.contrast - 1.0).abs() < 1e-12);
    }
}

#[test]
fn the_same_file_gives_the_same_designs_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let text = format!("maximise = \"printability\"\nevaluations = 60\n{VARIABLES}");
    let optimisation = optimisation(folder.path(), TARGETS[0], &text).unwrap();
    let values = |threads: usize| {
        let optimum = optimisation.run(threads, &|_, _| true, &progress::never).unwrap();
        (optimum.best, optimum.evaluations.into_iter().map(|e| e.values).collect::<Vec<_>>())
    };
    assert_eq!(values(1), values(3));
}

#[test]
fn a_small_space_is_searched_whole() {
    let folder = tempfile::tempdir().unwrap();
    let text = "maximise = \"rigidity_n_mm\"\nevaluations = 50\n[[variables]]\nkey = \"strips.count\"\nfrom = 6\nto = 12\n\
                [[variables]]\nkey = \"strips.thickness_mm\"\nfrom = 1.0\nto = 4.0\n";
    let optimisation = optimisation(folder.path(), TARGETS[0], text).unwrap();
    assert_eq!(optimisation.space().size(), Some(28));
    let optimum = run(&optimisation);
    assert_eq!(optimum.evaluations.len(), 28);
    let (most, _) = grid(&optimisation, &[7, 4]);
    assert_eq!(optimisation.goal().achieved(&optimum.best().unwrap().outcome), Some(most));
    // The stiffest is the thickest.
    assert!(optimum.ends.contains(&("strips.thickness_mm".to_owned(), "upper")), "{:?}", optimum.ends);
}

#[test]
fn where_nothing_is_feasible_it_says_why() {
    let folder = tempfile::tempdir().unwrap();
    // A tall dome needs more contrast than these phases reach.
    let target = "kind = \"hemi-ellipsoid\"\naspect_ratio = 4.0";
    let text = "maximise = \"rigidity_n_mm\"\nevaluations = 30\n[[variables]]\nkey = \"strips.hub_radius_mm\"\nfrom = 2.0\nto = 5.0\n";
    let optimisation = optimisation(folder.path(), target, text).unwrap();
    let optimum = run(&optimisation);
    assert_eq!((optimum.best, optimum.limits.len()), (None, 0));
    let refusals = optimum.refusals(optimisation.goal());
    assert_eq!(refusals[0], ("the phases do not reach the contrast".to_owned(), optimum.evaluations.len()));
    let out = folder.path().join("out");
    assert_eq!(output::write(&optimisation, &optimum, &out).unwrap(), ["evaluations.csv", "optimise.json"]);
    assert!(!out.join("optimum.toml").exists());
}

#[test]
fn it_can_be_cancelled() {
    let folder = tempfile::tempdir().unwrap();
    let text = format!("maximise = \"rigidity_n_mm\"\n{VARIABLES}");
    let optimisation = optimisation(folder.path(), TARGETS[0], &text).unwrap();
    let stopped = optimisation.run(2, &|done, _| done < 10, &progress::never);
    assert!(matches!(stopped, Err(Error::Cancelled)));
}

#[test]
fn wrong_files_are_refused_with_their_key() {
    let folder = tempfile::tempdir().unwrap();
    let variable = "[[variables]]\nkey = \"strips.count\"\nfrom = 6\nto = 12\n";
    for (text, words) in [
        (variable.to_owned(), "maximise"),
        (format!("maximise = \"weight\"\n{variable}"), "weight"),
        ("maximise = \"printability\"\nvariables = []\n".to_owned(), "variables = 0"),
        (format!("maximise = \"printability\"\nevaluations = 3\n{variable}"), "evaluations = 3"),
        (format!("maximise = \"printability\"\n{variable}{variable}"), "varies twice"),
        (
            format!("maximise = \"printability\"\n{}", variable.replace("count", "cuont")),
            "did you mean \"strips.count\"",
        ),
        (format!("maximise = \"printability\"\n{}", variable.replace("12", "6")), "the range is empty"),
        (format!("maximise = \"printability\"\n{variable}step = 0.5\n"), "a step must be"),
        (
            format!("maximise = \"printability\"\n[limits]\nlargest_strain = -1.0\n{variable}"),
            "limits.largest_strain = -1",
        ),
        (
            format!("maximise = \"printability\"\n[limits]\ncontrast_share = 1.5\n{variable}"),
            "limits.contrast_share = 1.5",
        ),
        (format!("maximise = \"printability\"\n[limits]\nweight = 1.5\n{variable}"), "weight"),
    ] {
        let error = optimisation(folder.path(), TARGETS[0], &text).map(|_| ()).unwrap_err();
        assert!(error.to_string().contains(words), "{text}: {error}");
        assert_eq!(error.exit_code(), 2);
    }
}
