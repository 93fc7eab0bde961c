//! Finite elements of the voxel strip: one morph at 1, 2, 4 and 8 times the voxels.

use std::hint::black_box;
use std::path::Path;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use voxelastica_core::input::files::Format;
use voxelastica_core::progress::unseen;
use voxelastica_core::results::{EmbeddedOptions, verify_embedded};
use voxelastica_core::{Design, DesignInput, Limits};

fn hemisphere(size: f64, thickness: f64) -> Design {
    let text = format!(
        "[target]\nkind = \"hemi-ellipsoid\"\n[strips]\ncount = 8\nlength_mm = 40.0\nhub_radius_mm = 4.0\nthickness_mm = \
         {thickness:?}\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\nsize_mm = {size:?}"
    );
    let design = DesignInput::from_text(&text, Format::Toml, "bench", "bench", Path::new("."))
        .map(|input| Design::compute(&input, Limits::default()));
    match design {
        Ok(Ok(design)) => design,
        other => panic!("{other:?}"),
    }
}

fn morph(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("morph");
    group.sample_size(10);
    for (size, thickness) in [(1.0, 2.0), (0.8, 1.6), (0.625, 1.875), (0.5, 2.0)] {
        let design = hemisphere(size, thickness);
        let voxels = design.grid().phases().len() as u64;
        group.throughput(Throughput::Elements(voxels));
        group.bench_with_input(BenchmarkId::from_parameter(voxels), &design, |bencher, design| {
            bencher.iter(|| black_box(verify_embedded(design, &EmbeddedOptions::default(), &unseen)).is_ok());
        });
    }
    group.finish();
}

criterion_group!(benches, morph);
criterion_main!(benches);
