//! The bridge and its Rust side.

use std::fmt;
use std::path::Path;
use std::sync::Arc;

use voxelastica::boundary::run;
use voxelastica::failure::Failure;
use voxelastica::flower::PreparedFlower;
use voxelastica::progress::{Watch, watched};
use voxelastica::status::Status;
use voxelastica::{conduct, design, fabricate, input, lists, mesh, outputs, path, profile, verify, voxels};
use voxelastica_core::input::files::Format;
use voxelastica_core::output::{Provenance, Summary};
use voxelastica_core::surface::SpokeSurface;
use voxelastica_core::{Design, DesignInput};

/// Between the fields of an error on its way through `cxx`, which carries one text only.
const SEPARATOR: &str = "\u{1f}";

#[allow(missing_docs)]
#[cxx::bridge(namespace = "voxelastica::bridge")]
pub mod ffi {
    unsafe extern "C++" {
        include!("voxelastica/progress.hpp");
        /// A function of the host that hears of progress.
        type Progress;
        /// Whether there is one.
        fn listens(self: &Progress) -> bool;
        /// Tells it; `false` cancels.
        fn tell(self: &Progress, done: u64, total: u64) -> bool;
    }

    extern "Rust" {
        type CxxInput;
        type CxxDesign;
        type CxxMesh;
        type CxxFlower;
        type CxxPath;

        fn parse_toml(text: &[u8], file: &[u8], folder: &[u8], progress: &Progress) -> Result<Box<CxxInput>>;
        fn parse_json(text: &[u8], file: &[u8], folder: &[u8], progress: &Progress) -> Result<Box<CxxInput>>;
        fn read(file: &[u8], progress: &Progress) -> Result<Box<CxxInput>>;
        fn validate(self: &CxxInput) -> Result<()>;
        fn json(self: &CxxInput) -> Result<String>;
        fn hash(self: &CxxInput) -> Result<String>;

        fn compute(input: &CxxInput, allow_large: bool, progress: &Progress) -> Result<Box<CxxDesign>>;
        fn summary(self: &CxxDesign) -> Result<String>;
        fn figure(self: &CxxDesign, name: &[u8]) -> Result<f64>;
        fn json(self: &CxxDesign) -> Result<String>;
        fn spokes(self: &CxxDesign) -> usize;
        fn warnings(self: &CxxDesign) -> Result<Vec<String>>;
        fn phases(self: &CxxDesign) -> Result<Vec<String>>;
        fn profile(self: &CxxDesign, column: i32) -> Result<&[f64]>;
        fn outline(self: &CxxDesign) -> &[f64];
        fn voxel_size(self: &CxxDesign) -> f64;
        fn voxel_layers(self: &CxxDesign) -> usize;
        fn voxel_phases(self: &CxxDesign) -> &[u8];
        fn voxel_offsets(self: &CxxDesign) -> &[usize];
        fn voxel_half_widths(self: &CxxDesign) -> &[usize];
        fn phase_centres(self: &CxxDesign, phase: usize) -> Result<Vec<f64>>;
        fn hub(self: &CxxDesign, strip: i32, fraction: f64) -> Result<Vec<f64>>;
        fn write(
            self: &CxxDesign,
            folder: &[u8],
            kinds: u32,
            allow_large: bool,
            progress: &Progress,
        ) -> Result<Vec<String>>;

        fn verify(self: &CxxDesign, model: i32, progress: &Progress) -> Result<String>;
        fn refine(
            self: &CxxDesign,
            iterations: usize,
            allow_large: bool,
            progress: &Progress,
        ) -> Result<Box<CxxDesign>>;
        fn conduct(
            self: &CxxDesign,
            flow: i32,
            model: i32,
            shape: i32,
            regime: i32,
            progress: &Progress,
        ) -> Result<String>;
        fn fabricate(
            self: &CxxDesign,
            folder: &[u8],
            kinds: u32,
            allow_large: bool,
            progress: &Progress,
        ) -> Result<Vec<String>>;

        fn mesh(
            self: &CxxDesign,
            strip: i32,
            fraction: f64,
            spoke: usize,
            along: usize,
            across: usize,
        ) -> Result<Box<CxxMesh>>;
        fn positions(self: &CxxMesh) -> &[f64];
        fn normals(self: &CxxMesh) -> &[f64];
        fn modulus(self: &CxxMesh) -> &[f64];
        fn quads(self: &CxxMesh) -> &[u32];

        fn flower(self: &CxxDesign, strip: i32, along: usize, across: usize) -> Result<Box<CxxFlower>>;
        fn vertices(self: &CxxFlower) -> usize;
        fn quads(self: &CxxFlower) -> &[u32];
        fn modulus(self: &CxxFlower) -> &[f64];
        fn fill_f32(self: &CxxFlower, fraction: f64, positions: &mut [f32], normals: &mut [f32]) -> Result<()>;
        fn fill_f64(self: &CxxFlower, fraction: f64, positions: &mut [f64], normals: &mut [f64]) -> Result<()>;

        fn path(self: &CxxDesign, strip: i32, points: usize, progress: &Progress) -> Result<Box<CxxPath>>;
        fn column(self: &CxxPath, column: i32) -> Result<&[f64]>;

        fn materials() -> Result<String>;
        fn parameters() -> Result<String>;
        fn version() -> String;
        /// For tests of the boundary: panics inside it.
        fn panic_for_tests() -> Result<()>;
    }
}

/// A failure as the one text that `cxx` carries.
pub struct Thrown(Failure);

impl From<Failure> for Thrown {
    fn from(failure: Failure) -> Self {
        Self(failure)
    }
}

impl fmt::Display for Thrown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Failure { code, message, key, value, file, line } = &self.0;
        let fields = [&(*code as i32).to_string(), key, value, file, &line.to_string(), message];
        // A separator or a zero byte within a field would shift the others.
        let clean = fields.map(|field| field.replace(['\u{1f}', '\0'], "\u{fffd}"));
        f.write_str(&clean.join(SEPARATOR))
    }
}

type Result<T> = std::result::Result<T, Thrown>;

fn enter<T>(body: impl FnOnce() -> std::result::Result<T, Failure>) -> Result<T> {
    run(body).map_err(Thrown)
}

fn told<T: Send>(
    progress: &ffi::Progress,
    work: impl FnOnce(&Watch) -> std::result::Result<T, Failure> + Send,
) -> std::result::Result<T, Failure> {
    if progress.listens() { watched(|done, total| progress.tell(done, total), work) } else { work(&Watch::default()) }
}

/// An input.
pub struct CxxInput(DesignInput);

fn parse_toml(text: &[u8], file: &[u8], folder: &[u8], progress: &ffi::Progress) -> Result<Box<CxxInput>> {
    parse(Format::Toml, text, file, folder, progress)
}

fn parse_json(text: &[u8], file: &[u8], folder: &[u8], progress: &ffi::Progress) -> Result<Box<CxxInput>> {
    parse(Format::Json, text, file, folder, progress)
}

fn parse(format: Format, text: &[u8], file: &[u8], folder: &[u8], progress: &ffi::Progress) -> Result<Box<CxxInput>> {
    enter(|| {
        let name = if format == Format::Toml { "toml" } else { "json" };
        let (text, file) = (checked(name, text)?, checked("file", file)?);
        let folder = Path::new(checked("folder", folder)?);
        Ok(Box::new(CxxInput(told(progress, |watch| input::parse(text, format, file, folder, watch))?)))
    })
}

fn read(file: &[u8], progress: &ffi::Progress) -> Result<Box<CxxInput>> {
    enter(|| {
        let file = Path::new(checked("file", file)?);
        Ok(Box::new(CxxInput(told(progress, |watch| input::read(file, watch))?)))
    })
}

fn checked<'a>(name: &str, text: &'a [u8]) -> std::result::Result<&'a str, Failure> {
    std::str::from_utf8(text).map_err(|_| Failure::argument(Status::BadText, name, "", "this text is not UTF-8"))
}

impl CxxInput {
    fn validate(&self) -> Result<()> {
        enter(|| Ok(self.0.validate()?))
    }

    fn json(&self) -> Result<String> {
        enter(|| input::to_json(&self.0))
    }

    fn hash(&self) -> Result<String> {
        enter(|| Ok(Provenance::of(&self.0).design_sha256))
    }
}

/// A design and what it lends.
pub struct CxxDesign {
    design: Arc<Design>,
    outline: Vec<[f64; 2]>,
}

fn compute(input: &CxxInput, allow_large: bool, progress: &ffi::Progress) -> Result<Box<CxxDesign>> {
    enter(|| Ok(Box::new(CxxDesign::new(told(progress, |watch| design::compute(&input.0, allow_large, watch))?))))
}

impl CxxDesign {
    fn new(design: Design) -> Self {
        let outline = design.profile().flat_outline();
        Self { design: Arc::new(design), outline }
    }

    fn verify(&self, model: i32, progress: &ffi::Progress) -> Result<String> {
        enter(|| {
            let model = verify::model(model)?;
            input::to_json(&told(progress, |watch| verify::verify(&self.design, model, watch))?)
        })
    }

    fn refine(&self, iterations: usize, allow_large: bool, progress: &ffi::Progress) -> Result<Box<Self>> {
        enter(|| {
            let work = |watch: &Watch| verify::refined(&self.design, iterations, allow_large, watch);
            Ok(Box::new(Self::new(told(progress, work)?)))
        })
    }

    fn conduct(&self, flow: i32, model: i32, shape: i32, regime: i32, progress: &ffi::Progress) -> Result<String> {
        enter(|| {
            let case = conduct::Case { flow, model, shape, regime };
            input::to_json(&told(progress, |watch| conduct::conduct(&self.design, case, watch))?)
        })
    }

    fn fabricate(&self, folder: &[u8], kinds: u32, allow_large: bool, progress: &ffi::Progress) -> Result<Vec<String>> {
        enter(|| {
            let folder = Path::new(checked("folder", folder)?);
            Ok(told(progress, |watch| fabricate::fabricate(&self.design, folder, kinds, allow_large, watch))?.files)
        })
    }

    fn summary(&self) -> Result<String> {
        enter(|| input::to_json(&Summary::of(&self.design)))
    }

    fn figure(&self, name: &[u8]) -> Result<f64> {
        enter(|| design::figure(&self.design, checked("name", name)?))
    }

    fn json(&self) -> Result<String> {
        enter(|| design::document(&self.design))
    }

    fn spokes(&self) -> usize {
        self.design.input().count()
    }

    fn warnings(&self) -> Result<Vec<String>> {
        enter(|| Ok(self.design.warnings().to_vec()))
    }

    fn phases(&self) -> Result<Vec<String>> {
        enter(|| Ok(self.design.phases().phases().iter().map(|p| p.name.clone()).collect()))
    }

    fn profile(&self, column: i32) -> Result<&[f64]> {
        enter(|| profile::profile_column(&self.design, column))
    }

    fn outline(&self) -> &[f64] {
        self.outline.as_flattened()
    }

    fn voxel_size(&self) -> f64 {
        self.design.grid().size_mm()
    }

    fn voxel_layers(&self) -> usize {
        self.design.grid().layers()
    }

    fn voxel_phases(&self) -> &[u8] {
        self.design.grid().phases()
    }

    fn voxel_offsets(&self) -> &[usize] {
        self.design.grid().offsets()
    }

    fn voxel_half_widths(&self) -> &[usize] {
        self.design.grid().half_widths()
    }

    fn phase_centres(&self, phase: usize) -> Result<Vec<f64>> {
        enter(|| {
            voxels::phase_voxels(&self.design, phase)?;
            Ok(voxels::centres(&self.design, phase as u8).flatten().collect())
        })
    }

    fn hub(&self, strip: i32, fraction: f64) -> Result<Vec<f64>> {
        enter(|| Ok(mesh::hub(&self.design, mesh::strip(strip)?, fraction)?.into_flattened()))
    }

    fn write(&self, folder: &[u8], kinds: u32, allow_large: bool, progress: &ffi::Progress) -> Result<Vec<String>> {
        enter(|| {
            let folder = Path::new(checked("folder", folder)?);
            Ok(told(progress, |watch| outputs::write(&self.design, folder, kinds, allow_large, watch))?.files)
        })
    }

    fn mesh(&self, strip: i32, fraction: f64, spoke: usize, along: usize, across: usize) -> Result<Box<CxxMesh>> {
        enter(|| {
            let surface = mesh::spoke_surface(&self.design, mesh::strip(strip)?, fraction, spoke, along, across)?;
            Ok(Box::new(CxxMesh { quads: surface.quads(), surface }))
        })
    }

    fn flower(&self, strip: i32, along: usize, across: usize) -> Result<Box<CxxFlower>> {
        enter(|| {
            let flower = PreparedFlower::new(Arc::clone(&self.design), mesh::strip(strip)?, along, across)?;
            Ok(Box::new(CxxFlower(flower)))
        })
    }

    fn path(&self, strip: i32, points: usize, progress: &ffi::Progress) -> Result<Box<CxxPath>> {
        enter(|| {
            let strip = mesh::strip(strip)?;
            let path = told(progress, |watch| path::Path::follow(&self.design, strip, points, watch))?;
            Ok(Box::new(CxxPath(path)))
        })
    }
}

/// A spoke's surface.
pub struct CxxMesh {
    surface: SpokeSurface,
    quads: Vec<[u32; 4]>,
}

impl CxxMesh {
    fn positions(&self) -> &[f64] {
        self.surface.positions.as_flattened()
    }

    fn normals(&self) -> &[f64] {
        self.surface.normals.as_flattened()
    }

    fn modulus(&self) -> &[f64] {
        &self.surface.modulus_mpa
    }

    fn quads(&self) -> &[u32] {
        self.quads.as_flattened()
    }
}

/// All spokes.
pub struct CxxFlower(PreparedFlower);

impl CxxFlower {
    fn vertices(&self) -> usize {
        self.0.vertices()
    }

    fn quads(&self) -> &[u32] {
        self.0.quads().as_flattened()
    }

    fn modulus(&self) -> &[f64] {
        self.0.modulus_mpa()
    }

    fn fill_f32(&self, fraction: f64, positions: &mut [f32], normals: &mut [f32]) -> Result<()> {
        enter(|| self.0.fill(fraction, positions, normals))
    }

    fn fill_f64(&self, fraction: f64, positions: &mut [f64], normals: &mut [f64]) -> Result<()> {
        enter(|| self.0.fill(fraction, positions, normals))
    }
}

/// Forces along the morph.
pub struct CxxPath(path::Path);

impl CxxPath {
    fn column(&self, column: i32) -> Result<&[f64]> {
        enter(|| self.0.column(column))
    }
}

fn materials() -> Result<String> {
    enter(lists::materials_json)
}

fn parameters() -> Result<String> {
    enter(lists::parameters_json)
}

fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}

fn panic_for_tests() -> Result<()> {
    enter(|| panic!("asked for by a test"))
}
