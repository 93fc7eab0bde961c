//! Steady heat through random voxels, from ten thousand to a million of them.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use voxelastica_core::conduction::mesh::{BrickMesh, Geometry};
use voxelastica_core::conduction::pcg::Watch;
use voxelastica_core::conduction::steady::{Boundary, SteadyOptions, solve};

fn steady(c: &mut Criterion) {
    let mut group = c.benchmark_group("steady heat");
    group.sample_size(10);
    for n in [4, 8, 14, 20] {
        let cells = [20 * n, n, 6 * n];
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let materials = (0..cells.iter().product()).map(|_| (rng.next_u64() & 1) as u16).collect();
        let Ok(mesh) = BrickMesh::new(cells, materials, Geometry::Cubes(0.5)) else { return };
        let mut boundary = Boundary::insulated(&mesh);
        boundary.give_plane(&mesh, 0, 1.0);
        boundary.give_plane(&mesh, cells[0], 0.0);
        let options = SteadyOptions::default();
        group.bench_function(BenchmarkId::from_parameter(mesh.materials().len()), |b| {
            b.iter(|| solve(&mesh, &[0.3155, 2.01], &boundary, &options, Watch::silent()).map(|s| s.slice_flux[0]));
        });
    }
    group.finish();
}

criterion_group!(benches, steady);
criterion_main!(benches);
