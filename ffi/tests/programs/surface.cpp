// Uses every class once as it is meant, and each error once. usage: surface DESIGN.toml FOLDER

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <thread>

#include "voxelastica/voxelastica.hpp"

using namespace voxelastica;

static int checks;

#define CHECK(condition)                                                             \
  do {                                                                               \
    ++checks;                                                                        \
    if (!(condition)) {                                                              \
      std::fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition); \
      std::exit(1);                                                                  \
    }                                                                                \
  } while (0)

template <class Body>
static Error failed(Status code, const char *key, const char *words, Body body) {
  try {
    body();
  } catch (const Error &error) {
    if (error.code() != code || error.key() != key || !std::strstr(error.what(), words)) {
      std::fprintf(stderr, "%d %s: %s\n", static_cast<int>(error.code()), error.key().c_str(), error.what());
      CHECK(false);
    }
    ++checks;
    return error;
  }
  CHECK(false);
  std::abort();
}

static const char *SMALL = R"(
[target]
kind = "hemi-ellipsoid"
[strips]
count = 6
length_mm = 20.0
hub_radius_mm = 3.0
thickness_mm = 2.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 1.0
)";

static void inputs(const char *file) {
  const auto input = Input::read(file);
  input.validate();
  CHECK(Input::from_json(input.json()).hash() == input.hash());
  const auto error = failed(Status::Input, "strips.cuont", "count", [] {
    Input::from_toml("[target]\nkind = \"hemi-ellipsoid\"\n[strips]\ncuont = 3\n", "my.toml");
  });
  CHECK(error.file() == "my.toml" && error.line() == 4);
  failed(Status::Input, "", "no such file", [] { Input::read("no/such.toml"); });
  failed(Status::BadText, "toml", "UTF-8", [] { Input::from_toml("\xff\xfe"); });
  failed(Status::Internal, "", "internal error", [] { detail::call([] { bridge::panic_for_tests(); }); });
}

static void designs(const char *folder) {
  int told = 0;
  const Design design(Input::from_toml(SMALL), false, [&told](std::uint64_t, std::uint64_t) { return ++told, true; });
  CHECK(told >= 1 && design.spokes() == 6);
  CHECK(design.summary().find("\"contrast\"") != std::string::npos);
  CHECK(design.json().find("voxelastica/design/1") != std::string::npos);
  CHECK(design.figure("contrast") > 1.0);
  CHECK(design.phases().size() == 2 && design.phases()[0] == "FLX9070");
  for (const auto &warning : design.warnings()) {
    CHECK(!warning.empty());
  }
  const auto widths = design.profile(ProfileColumn::Width);
  CHECK(widths.size() == 1001 && widths.data() == design.profile(ProfileColumn::Width).data());
  CHECK(*std::max_element(widths.begin(), widths.end()) == widths.front());
  CHECK(design.outline().size() == 4004);
  CHECK(design.voxel_size_mm() == 1.0 && design.voxel_layers() == 2);
  CHECK(design.voxel_offsets().back() == design.voxel_phases().size());
  CHECK(design.voxel_half_widths().size() == 20);
  CHECK(design.phase_centres(0).size() + design.phase_centres(1).size() == 3 * design.voxel_phases().size());
  CHECK(design.hub(1.0).size() == 18);

  const auto mesh = design.mesh(0.37, 5, 10, 4, Strip::Voxel);
  CHECK(mesh.positions().size() == 165 && mesh.normals().size() == 165);
  CHECK(mesh.modulus_mpa().size() == 55 && mesh.quads().size() == 160);

  const auto flower = design.flower(20, 4);
  std::vector<float> positions(3 * flower.vertices()), normals(3 * flower.vertices());
  std::vector<double> exact(3 * flower.vertices());
  flower.fill(0.5, positions, normals);
  flower.fill(0.5, exact);
  CHECK(positions[100] == static_cast<float>(exact[100]));
  CHECK(flower.quads().size() == 4 * 480 && flower.modulus_mpa().size() == flower.vertices());

  const auto path = design.path(11);
  CHECK(path.column(PathColumn::Fraction).back() == 1.0 && path.column(PathColumn::Height).size() == 11);

  failed(Status::OutOfRange, "name", "thrust", [&] { design.figure("thrust"); });
  failed(Status::OutOfRange, "fraction", "1.5", [&] { design.mesh(1.5, 0, 2, 2); });
  failed(Status::OutOfRange, "phase", "below 2", [&] { design.phase_centres(2); });
  failed(Status::OutOfRange, "column", "99", [&] { design.profile(static_cast<ProfileColumn>(99)); });
  failed(Status::WrongLength, "normals", "must hold", [&] { flower.fill(0.5, exact, View<double>(exact.data(), 3)); });
  failed(Status::Cancelled, "", "cancelled",
         [&] { design.path(100000, Strip::Graded, [](std::uint64_t, std::uint64_t) { return false; }); });
  try {
    design.path(100000, Strip::Graded, [](std::uint64_t, std::uint64_t) -> bool { throw std::runtime_error("mine"); });
    CHECK(false);
  } catch (const std::runtime_error &error) {
    CHECK(std::string(error.what()) == "mine");
  }
  failed(Status::Infeasible, "target", "straight", [] {
    std::string straight = SMALL;
    straight.replace(straight.find("\"hemi-ellipsoid\""), 16, "\"inclination-polynomial\"\ncoefficients_deg = [0.0]");
    Design design(Input::from_toml(straight));
  });

  const auto files = design.write(folder);
  CHECK(std::find(files.begin(), files.end(), "abaqus/voxel_solid.inp") != files.end());
  failed(Status::Output, "", "/dev/null", [&] { design.write("/dev/null/x", output::Tables); });
  failed(Status::OutOfRange, "kinds", "voxelastica_output", [&] { design.write(folder, 0); });

  const auto small = Design(Input::from_toml(SMALL));
  CHECK(small.verify().find("\"midline_mm\"") != std::string::npos);
  CHECK(small.refine(1).json().find("\"refine\"") != std::string::npos);
  CHECK(!small.fabricate(folder, fabrication::Svg).empty());
  failed(Status::OutOfRange, "model", "voxelastica_solved_model", [&] { small.verify(static_cast<SolvedModel>(7)); });
  failed(Status::OutOfRange, "iterations", "1", [&] { small.refine(0); });
  failed(Status::OutOfRange, "kinds", "voxelastica_fabrication", [&] { small.fabricate(folder, 1u << 20); });
  failed(Status::Input, "materials.phases", "conductivity", [&] { small.conduct(Flow::Heat); });
  failed(Status::Cancelled, "", "cancelled",
         [&] { small.verify(SolvedModel::Voxel, [](std::uint64_t, std::uint64_t) { return false; }); });

  // Several threads read one design; what they get is the same.
  std::array<double, 4> sums{};
  std::array<std::thread, 4> threads;
  for (std::size_t i = 0; i < threads.size(); ++i) {
    threads[i] = std::thread([&, i] {
      for (int k = 1; k <= 5; ++k) {
        const auto mesh = design.mesh(0.2 * k, i, 20, 2);
        for (const double value : mesh.positions()) {
          sums[i] += std::fabs(value) * 1e-3;
        }
      }
    });
  }
  for (auto &thread : threads) {
    thread.join();
  }
  CHECK(std::isfinite(sums[0]) && sums[0] > 0.0);

  Design moved = Design(Input::from_toml(SMALL));
  Design other = std::move(moved);
  CHECK(other.spokes() == 6);
}

int main(int argc, char **argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: surface DESIGN.toml FOLDER\n");
    return 2;
  }
  CHECK(version().find('.') != std::string::npos);
  CHECK(materials().find("VeroClear") != std::string::npos);
  CHECK(parameters().find("voxels.size_mm") != std::string::npos);
  inputs(argv[1]);
  designs(argv[2]);
  if (argc == 3 && std::getenv("VOXELASTICA_WRITE")) {
    Design(Input::read(argv[1])).write(std::getenv("VOXELASTICA_WRITE"));
  }
  std::printf("%d checks\n", checks);
}
