//! Unit cells: closed forms, bounds, symmetry, convergence.

use voxelastica_core::materials::{Material, library};
use voxelastica_core::micromechanics::unit_cell::{
    BrickKind, Catalogue, CellMesh, CellSize, Layout, LoadedFaces, StretchTest, Symmetry, UnitCellError,
};
use voxelastica_core::progress;

fn material(modulus_mpa: f64, poisson: f64) -> Material {
    Material { modulus_mpa, poisson, ..library()[0].clone() }
}

fn catalogue(edge: usize, soft: &Material, rigid: &Material, mesh: CellMesh) -> Catalogue {
    Catalogue::compute(CellSize::new(edge).unwrap(), [soft, rigid], mesh, &progress::ignore).unwrap()
}

fn mesh(element: BrickKind, elements_per_voxel: usize) -> CellMesh {
    CellMesh { element, elements_per_voxel, ..CellMesh::default() }
}

fn near(value: f64, expected: f64, share: f64) {
    assert!((value / expected - 1.0).abs() < share, "{value} instead of {expected}");
}

/// Plates along the load share its strain, plates across it its stress: with Poisson's ratio zero, Voigt and Reuss exactly.
#[test]
fn plates_have_the_moduli_of_voigt_and_reuss() {
    let (soft, rigid) = (material(1.0, 0.0), material(10.0, 0.0));
    for element in [BrickKind::Trilinear, BrickKind::Enhanced] {
        let cells = catalogue(3, &soft, &rigid, mesh(element, 2));
        let size = cells.size();
        // One of three columns at constant x is rigid.
        let row = cells.layout(Layout::read("100/100/100", size).unwrap()).unwrap();
        near(row.moduli_mpa[0], row.reuss_mpa, 1e-10);
        near(row.moduli_mpa[1], row.voigt_mpa, 1e-10);
        near(row.moduli_mpa[2], row.voigt_mpa, 1e-10);
    }
}

#[test]
fn one_phase_alone_has_its_own_modulus() {
    let phase = material(7.0, 0.35);
    let cells = catalogue(2, &phase, &phase, mesh(BrickKind::Enhanced, 2));
    for row in cells.layouts() {
        row.moduli_mpa.iter().for_each(|e| near(*e, 7.0, 1e-10));
    }
}

/// The theorem of the module's documentation: with equal Poisson's ratios and faces that slide, all moduli of all layouts
/// lie between Reuss's and Voigt's bounds, and along z of a single layer they are Voigt's.
#[test]
fn all_512_layouts_lie_within_the_bounds() {
    for (contrast, poisson) in [(12.6 / 3.1, 0.3), (30.0, 0.3), (3279.6, 0.45)] {
        for element in [BrickKind::Trilinear, BrickKind::Enhanced] {
            let cells = catalogue(3, &material(1.0, poisson), &material(contrast, poisson), mesh(element, 2));
            assert_eq!((cells.layouts().count(), cells.classes().count()), (512, 102));
            for row in cells.layouts() {
                assert!(row.is_within_bounds(), "{contrast} {element:?}: {row:?}");
                near(row.moduli_mpa[2], row.voigt_mpa, 1e-8);
            }
            // In the plane the mixture is softer than Voigt's unless one phase is alone.
            let middle = &cells.departures()[4];
            assert!(middle.in_plane[1] < -0.05 && middle.in_plane[2] <= 1e-9, "{middle:?}");
        }
    }
}

/// A single layout is not isotropic, so Hashin and Shtrikman's bounds need not hold: along z it reaches Voigt's.
#[test]
fn hashin_shtrikman_does_not_bound_single_layouts() {
    let cells = catalogue(3, &library()[0], &library()[1], CellMesh::default());
    let beyond = cells.layouts().filter(|row| !row.is_within_hashin_shtrikman()).count();
    // All but the two pure ones: along z.
    assert_eq!(beyond, 510);
    let in_plane = |low: bool| {
        cells
            .layouts()
            .filter(|row| {
                let [x, y, _] = row.moduli_mpa;
                let [lower, upper] = row.hashin_shtrikman_mpa;
                if low { x.min(y) < lower * (1.0 - 1e-9) } else { x.max(y) > upper * (1.0 + 1e-9) }
            })
            .count()
    };
    println!("in the plane, {} below and {} above", in_plane(true), in_plane(false));
    assert!(in_plane(true) > 0 && in_plane(false) > 0);
}

/// Every image of a layout, solved on its own, has the moduli that symmetry says.
#[test]
fn permuted_layouts_agree() {
    let size = CellSize::new(3).unwrap();
    let (soft, rigid) = (material(3.1, 0.3), material(12.6, 0.4));
    let test = StretchTest::new(size, [&soft, &rigid], &CellMesh::default()).unwrap();
    let cells = catalogue(3, &soft, &rigid, CellMesh::default());
    for text in ["110/000/001", "101/110/000", "111/010/000"] {
        let layout = Layout::read(text, size).unwrap();
        let [x, y, z] = test.moduli(layout).unwrap();
        for symmetry in Symmetry::all() {
            let moved = layout.moved(symmetry, size);
            let expected = if symmetry.exchanges { [y, x, z] } else { [x, y, z] };
            for (own, by_class) in test.moduli(moved).unwrap().iter().zip(cells.layout(moved).unwrap().moduli_mpa) {
                near(by_class, *own, 1e-9);
            }
            for (own, expected) in test.moduli(moved).unwrap().iter().zip(expected) {
                near(*own, expected, 1e-9);
            }
        }
    }
}

/// Clamped faces hinder the lateral contraction: even one phase alone leaves the bounds upwards. Unequal Poisson's ratios
/// make the phases hinder each other: above Voigt's rule along z.
#[test]
fn clamped_faces_and_unequal_poissons_ratios_leave_the_bounds() {
    let phase = material(5.0, 0.3);
    let clamped = CellMesh { faces: LoadedFaces::Clamped, ..CellMesh::default() };
    let row = catalogue(2, &phase, &phase, clamped).layouts().next().unwrap();
    assert!(row.moduli_mpa[2] > 1.05 * row.voigt_mpa, "{row:?}");

    let cells = catalogue(3, &material(1.0, 0.45), &material(1.2, 0.0), CellMesh::default());
    let above = cells.layouts().filter(|row| row.moduli_mpa[2] > row.voigt_mpa * (1.0 + 1e-6)).count();
    assert!(above > 400, "{above}");
    assert!(cells.layouts().any(|row| !row.is_within_bounds()));
}

/// Trilinear bricks come from above; the enhanced ones are nearer to the limit on every mesh.
#[test]
fn enhanced_bricks_are_nearer_to_the_limit() {
    let size = CellSize::new(2).unwrap();
    let layout = Layout::read("10/01", size).unwrap();
    let (soft, rigid) = (material(3.1, 0.3), material(12.6, 0.3));
    let along_x =
        |element, n| StretchTest::new(size, [&soft, &rigid], &mesh(element, n)).unwrap().moduli(layout).unwrap()[0];
    let [coarse, fine] = [1, 4].map(|n| [along_x(BrickKind::Trilinear, n), along_x(BrickKind::Enhanced, n)]);
    println!("trilinear {} {}, enhanced {} {}", coarse[0], fine[0], coarse[1], fine[1]);
    assert!(coarse[0] > fine[0] && coarse[1] > fine[1] && fine[0] > fine[1]);
    // The limit lies below the finest value: the enhanced bricks' error is the smaller one.
    assert!(coarse[0] - fine[1] > 1.5 * (coarse[1] - fine[1]));
}

#[test]
fn wrong_requests_are_refused_and_cancelled_ones_stop() {
    let size = CellSize::new(3).unwrap();
    let good = material(1.0, 0.3);
    for (phase, elements) in [(material(-1.0, 0.3), 2), (material(f64::NAN, 0.3), 2), (material(1.0, 0.5), 2)] {
        let error = StretchTest::new(size, [&good, &phase], &mesh(BrickKind::Enhanced, elements)).unwrap_err();
        assert!(matches!(error, UnitCellError::Phase { .. }), "{error}");
    }
    for elements in [0, 9] {
        let error = StretchTest::new(size, [&good, &good], &mesh(BrickKind::Enhanced, elements)).unwrap_err();
        assert!(matches!(error, UnitCellError::Elements { .. }), "{error}");
    }
    let stopped = Catalogue::compute(size, [&good, &good], CellMesh::default(), &|_| false);
    assert_eq!(stopped.unwrap_err(), UnitCellError::Cancelled);
}

/// The figures of docs/micromechanics.md: `--ignored --nocapture`.
#[test]
#[ignore = "long"]
fn tables_for_the_documentation() {
    let size = CellSize::new(3).unwrap();
    for contrast in [12.6 / 3.1, 30.0, 3279.6] {
        let (soft, rigid) = (material(1.0, 0.3), material(contrast, 0.3));
        for element in [BrickKind::Trilinear, BrickKind::Enhanced] {
            for n in [1, 2, 4, 8] {
                let test = StretchTest::new(size, [&soft, &rigid], &mesh(element, n)).unwrap();
                let found = ["100/010/001", "101/010/101", "000/010/000", "111/101/111"]
                    .map(|text| test.moduli(Layout::read(text, size).unwrap()).unwrap()[0]);
                println!("contrast {contrast:.2} {element:?} {n}: {found:.6?}");
            }
        }
        let cells = catalogue(3, &soft, &rigid, CellMesh::default());
        for departure in cells.departures() {
            println!("{contrast:.2} {departure:.4?}");
        }
    }
}
