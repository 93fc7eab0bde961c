//! Speed of the parts a user waits for: the inverse problem, a whole design, one step of a morph.

use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use voxelastica_core::elastica::tessellation::widths;
use voxelastica_core::elastica::{HubSupport, ThrustChoice, inverse};
use voxelastica_core::input::files::Format;
use voxelastica_core::modulus_field::ModulusField;
use voxelastica_core::target::{MeridianCurve, PolynomialMeridian};
use voxelastica_core::{Design, DesignInput, Limits};

const NOSE_CONE: [f64; 8] = [26.52, -116.3, 162.3, -132.0, 63.5, -47.14, 18.64, 41.56];

fn input(name: &str) -> DesignInput {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples");
    let text = std::fs::read_to_string(examples.join(format!("{name}.toml"))).expect("the example is there");
    DesignInput::from_text(&text, Format::Toml, name, name, &examples).expect("the example is right")
}

fn inverse_problem(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("inverse design, 1001 stations");
    for (name, support, choice) in [
        ("equal ends", HubSupport::Free, ThrustChoice::EqualEnds),
        ("held, least contrast", HubSupport::Held, ThrustChoice::LeastContrast),
    ] {
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let curve = PolynomialMeridian::new(black_box(&NOSE_CONE), 100.0).expect("a meridian");
                let stations = curve.stations(1001);
                let end = stations[1000].x;
                let widths = widths(12, stations.iter().map(|p| (p.s, 5.0 + end - p.x))).expect("widths");
                inverse::solve(&curve, &stations, &widths, support, choice).expect("feasible")
            });
        });
    }
    group.finish();
}

fn whole_design(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("in-memory design, 67 000 voxels");
    for name in ["hemisphere", "nose_cone"] {
        let input = input(name);
        group.bench_function(name, |b| b.iter(|| Design::compute(black_box(&input), Limits::default())));
    }
    group.finish();
}

fn morph(criterion: &mut Criterion) {
    let design = Design::compute(&input("hemisphere"), Limits::default()).expect("feasible");
    let path = design.graded_path().expect("solved").expect("a dome");
    criterion.bench_function("morph at a new fraction", |b| b.iter(|| path.at(black_box(0.37))));
    let profile = design.profile();
    criterion
        .bench_function("modulus field", |b| b.iter(|| ModulusField::fit(&profile.s, &profile.modulus_mpa, 100.0)));
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = inverse_problem, whole_design, morph
}
criterion_main!(benches);
