/* Writes all outputs of a design file, as the command line does. usage: write DESIGN.toml FOLDER */
#include <stdio.h>
#include <string.h>

#include "voxelastica.h"

int main(int argc, char **argv) {
  voxelastica_input *input = NULL;
  voxelastica_design *design = NULL;
  voxelastica_error *error = NULL;
  if (argc != 3) {
    return 2;
  }
  voxelastica_status status = voxelastica_input_read(argv[1], strlen(argv[1]), NULL, NULL, &input, &error);
  if (status == VOXELASTICA_STATUS_OK) {
    status = voxelastica_design_compute(input, false, NULL, NULL, &design, &error);
  }
  if (status == VOXELASTICA_STATUS_OK) {
    status = voxelastica_design_write(design, argv[2], strlen(argv[2]), VOXELASTICA_OUTPUT_ALL, false, NULL, NULL, NULL,
                                      &error);
  }
  if (status != VOXELASTICA_STATUS_OK) {
    fprintf(stderr, "error: %s\n", voxelastica_error_message(error));
  }
  voxelastica_error_free(error);
  voxelastica_design_free(design);
  voxelastica_input_free(input);
  return (int)status;
}
