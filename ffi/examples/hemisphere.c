/* Designs a hemisphere and prints the widths of its spokes. */
#include <stdio.h>
#include <string.h>

#include "voxelastica.h"

static const char *TOML =
    "[target]\n"
    "kind = \"hemi-ellipsoid\"\n"
    "[strips]\n"
    "count = 8\n"
    "length_mm = 100.0\n"
    "hub_radius_mm = 10.0\n"
    "thickness_mm = 2.0\n"
    "[materials]\n"
    "phases = [\"FLX9070\", \"FLX9095\"]\n"
    "[voxels]\n"
    "size_mm = 0.5\n";

int main(void) {
  voxelastica_input *input = NULL;
  voxelastica_design *design = NULL;
  voxelastica_error *error = NULL;
  voxelastica_array_f64 s, width;
  voxelastica_status status =
      voxelastica_input_parse_toml(TOML, strlen(TOML), "hemisphere", 10, NULL, 0, NULL, NULL, &input, &error);
  if (status == VOXELASTICA_STATUS_OK) {
    status = voxelastica_design_compute(input, false, NULL, NULL, &design, &error);
  }
  if (status == VOXELASTICA_STATUS_OK) {
    status = voxelastica_design_profile(design, VOXELASTICA_PROFILE_COLUMN_S, &s, &error);
  }
  if (status == VOXELASTICA_STATUS_OK) {
    status = voxelastica_design_profile(design, VOXELASTICA_PROFILE_COLUMN_WIDTH, &width, &error);
  }
  if (status == VOXELASTICA_STATUS_OK) {
    /* One column of whole doubles: the stride is that of an ordinary array. */
    for (size_t i = 0; i < width.rows; i += 100) {
      printf("s = %5.1f mm  width = %6.3f mm\n", s.data[i], width.data[i]);
    }
  } else {
    fprintf(stderr, "error: %s\n", voxelastica_error_message(error));
  }
  voxelastica_error_free(error);
  voxelastica_design_free(design);
  voxelastica_input_free(input);
  return (int)status;
}
