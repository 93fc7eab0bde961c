// Designs a hemisphere and prints the widths of its spokes.
#include <cstdio>

#include "voxelastica/voxelastica.hpp"

constexpr const char *TOML = R"(
[target]
kind = "hemi-ellipsoid"
[strips]
count = 8
length_mm = 100.0
hub_radius_mm = 10.0
thickness_mm = 2.0
[materials]
phases = ["FLX9070", "FLX9095"]
[voxels]
size_mm = 0.5
)";

int main() {
  try {
    const voxelastica::Design design(voxelastica::Input::from_toml(TOML, "hemisphere"));
    const auto s = design.profile(voxelastica::ProfileColumn::S);
    const auto width = design.profile(voxelastica::ProfileColumn::Width);
    for (std::size_t i = 0; i < width.size(); i += 100) {
      std::printf("s = %5.1f mm  width = %6.3f mm\n", s[i], width[i]);
    }
    return 0;
  } catch (const voxelastica::Error &error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return static_cast<int>(error.code());
  }
}
