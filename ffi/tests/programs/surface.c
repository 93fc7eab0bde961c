/* Calls every function of the library once as it is meant, and each error once. Prints the number of checks.
 *
 * usage: surface DESIGN.toml FOLDER */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "voxelastica.h"

static int checks;

#define CHECK(condition)                                                       \
  do {                                                                         \
    ++checks;                                                                  \
    if (!(condition)) {                                                        \
      fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition); \
      exit(1);                                                                 \
    }                                                                          \
  } while (0)

#define TEXT(text) text, strlen(text)

/* The call has failed with this code and said so in an error that holds these words. */
static void failed(voxelastica_status status, voxelastica_status wanted, voxelastica_error *error, const char *key,
                   const char *words) {
  CHECK(status == wanted);
  CHECK(error != NULL);
  CHECK(voxelastica_error_code(error) == wanted);
  if (strcmp(voxelastica_error_key(error), key) != 0 || !strstr(voxelastica_error_message(error), words)) {
    fprintf(stderr, "%s: %s\n", voxelastica_error_key(error), voxelastica_error_message(error));
    CHECK(0);
  }
  CHECK(voxelastica_error_value(error) != NULL);
  CHECK(voxelastica_error_file(error) != NULL);
  CHECK(voxelastica_error_free(error) == VOXELASTICA_STATUS_OK);
}

static const char *SMALL =
    "[target]\nkind = \"hemi-ellipsoid\"\n[strips]\ncount = 6\nlength_mm = 20.0\nhub_radius_mm = 3.0\n"
    "thickness_mm = 2.0\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\nsize_mm = 1.0\n";

static voxelastica_input *parsed(const char *toml) {
  voxelastica_input *input = NULL;
  voxelastica_error *error = NULL;
  if (voxelastica_input_parse_toml(TEXT(toml), NULL, 0, NULL, 0, NULL, NULL, &input, &error) != VOXELASTICA_STATUS_OK) {
    fprintf(stderr, "%s\n", voxelastica_error_message(error));
    CHECK(0);
  }
  CHECK(error == NULL);
  return input;
}

static bool go_on(void *user, uint64_t done, uint64_t total) {
  (void)done;
  (void)total;
  ++*(int *)user;
  return true;
}

static bool stop(void *user, uint64_t done, uint64_t total) {
  (void)done;
  (void)total;
  ++*(int *)user;
  return false;
}

static void texts_and_lists(void) {
  CHECK(voxelastica_abi_version() == VOXELASTICA_ABI_VERSION);
  CHECK(strchr(voxelastica_version(), '.') != NULL);

  CHECK(voxelastica_materials_count() >= 6);
  voxelastica_material material;
  CHECK(voxelastica_materials_get(0, &material, NULL) == VOXELASTICA_STATUS_OK);
  CHECK(strcmp(material.name, "FLX9070") == 0 && material.modulus_mpa == 3.1 && isnan(material.max_strain));
  CHECK(voxelastica_parameters_count() > 40);
  voxelastica_parameter parameter;
  CHECK(voxelastica_parameters_get(1, &parameter, NULL) == VOXELASTICA_STATUS_OK);
  CHECK(strcmp(parameter.key, "target.kind") == 0 && parameter.required);
  CHECK(strstr(parameter.range, "hemi-ellipsoid") && strlen(parameter.description) > 10);

  voxelastica_text *text = NULL;
  CHECK(voxelastica_materials_json(&text, NULL) == VOXELASTICA_STATUS_OK);
  CHECK(voxelastica_text_length(text) == strlen(voxelastica_text_data(text)));
  CHECK(strstr(voxelastica_text_data(text), "VeroClear") != NULL);
  CHECK(voxelastica_text_free(text) == VOXELASTICA_STATUS_OK);
  CHECK(voxelastica_parameters_json(&text, NULL) == VOXELASTICA_STATUS_OK);
  CHECK(strstr(voxelastica_text_data(text), "voxels.size_mm") != NULL);
  CHECK(voxelastica_text_free(text) == VOXELASTICA_STATUS_OK);
  CHECK(voxelastica_parameters_schema(&text, NULL) == VOXELASTICA_STATUS_OK);
  CHECK(strstr(voxelastica_text_data(text), "$schema") != NULL);
  CHECK(voxelastica_text_free(text) == VOXELASTICA_STATUS_OK);

  voxelastica_error *error = NULL;
  voxelastica_status status = voxelastica_materials_get(1000, &material, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "index", "1000");
  status = voxelastica_parameters_get(1000, &parameter, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "index", "1000");
}

static void inputs(const char *file) {
  voxelastica_input *input = NULL, *again = NULL;
  voxelastica_text *json = NULL, *one = NULL, *two = NULL;
  voxelastica_error *error = NULL;
  CHECK(voxelastica_input_read(TEXT(file), NULL, NULL, &input, &error) == VOXELASTICA_STATUS_OK);
  CHECK(voxelastica_input_validate(input, &error) == VOXELASTICA_STATUS_OK);
  CHECK(voxelastica_input_json(input, &json, &error) == VOXELASTICA_STATUS_OK);
  const char *text = voxelastica_text_data(json);
  CHECK(voxelastica_input_parse_json(TEXT(text), NULL, 0, NULL, 0, NULL, NULL, &again, &error) == VOXELASTICA_STATUS_OK);
  CHECK(voxelastica_input_hash(input, &one, &error) == VOXELASTICA_STATUS_OK);
  CHECK(voxelastica_input_hash(again, &two, &error) == VOXELASTICA_STATUS_OK);
  CHECK(strcmp(voxelastica_text_data(one), voxelastica_text_data(two)) == 0);
  voxelastica_text_free(json);
  voxelastica_text_free(one);
  voxelastica_text_free(two);
  CHECK(voxelastica_input_free(again) == VOXELASTICA_STATUS_OK);

  /* Errors. */
  voxelastica_status status = voxelastica_input_free(again);
  CHECK(status == VOXELASTICA_STATUS_BAD_HANDLE);
  status = voxelastica_input_validate(again, &error);
  failed(status, VOXELASTICA_STATUS_BAD_HANDLE, error, "input", "was freed");
  status = voxelastica_input_validate(NULL, &error);
  failed(status, VOXELASTICA_STATUS_NULL_ARGUMENT, error, "input", "null");
  status = voxelastica_input_validate((const voxelastica_input *)(const void *)&status, &error);
  failed(status, VOXELASTICA_STATUS_BAD_HANDLE, error, "input", "not a handle");
  again = NULL;
  status = voxelastica_input_parse_toml("name = \"\xff\xfe\"", 11, NULL, 0, NULL, 0, NULL, NULL, &again, &error);
  failed(status, VOXELASTICA_STATUS_BAD_TEXT, error, "toml", "UTF-8");
  status = voxelastica_input_parse_toml(NULL, 5, NULL, 0, NULL, 0, NULL, NULL, &again, &error);
  failed(status, VOXELASTICA_STATUS_NULL_ARGUMENT, error, "toml", "null");
  status = voxelastica_input_parse_toml(SMALL, SIZE_MAX, NULL, 0, NULL, 0, NULL, NULL, &again, &error);
  failed(status, VOXELASTICA_STATUS_WRONG_LENGTH, error, "toml", "long");
  status = voxelastica_input_parse_toml(TEXT(SMALL), NULL, 0, NULL, 0, NULL, NULL, NULL, &error);
  failed(status, VOXELASTICA_STATUS_NULL_ARGUMENT, error, "input", "null");
  const char *wrong = "[target]\nkind = \"hemi-ellipsoid\"\n[strips]\ncuont = 3\n";
  status = voxelastica_input_parse_toml(TEXT(wrong), TEXT("my.toml"), NULL, 0, NULL, NULL, &again, &error);
  CHECK(strcmp(voxelastica_error_file(error), "my.toml") == 0 && voxelastica_error_line(error) == 4);
  failed(status, VOXELASTICA_STATUS_INPUT, error, "strips.cuont", "count");
  status = voxelastica_input_read(TEXT("no/such.toml"), NULL, NULL, &again, &error);
  CHECK(strcmp(voxelastica_error_file(error), "no/such.toml") == 0);
  failed(status, VOXELASTICA_STATUS_INPUT, error, "", "no such file");
  CHECK(again == NULL);

  CHECK(voxelastica_input_free(input) == VOXELASTICA_STATUS_OK);
  CHECK(voxelastica_input_free(NULL) == VOXELASTICA_STATUS_OK);
}

static double value(const voxelastica_array_f64 *array, size_t row, size_t column) {
  return *(const double *)(const void *)((const char *)array->data + row * array->stride + column * sizeof(double));
}

static void lent_arrays(const voxelastica_design *design) {
  voxelastica_error *error = NULL;
  voxelastica_array_f64 array, again;
  for (int32_t column = VOXELASTICA_PROFILE_COLUMN_S; column <= VOXELASTICA_PROFILE_COLUMN_RIGID_FRACTION; ++column) {
    CHECK(voxelastica_design_profile(design, column, &array, &error) == VOXELASTICA_STATUS_OK);
    CHECK(array.rows == 1001 && array.columns == 1 && array.stride == sizeof(double));
    CHECK(voxelastica_design_profile(design, column, &again, &error) == VOXELASTICA_STATUS_OK);
    CHECK(array.data == again.data); /* lent, not copied */
  }
  CHECK(voxelastica_design_outline(design, &array, &error) == VOXELASTICA_STATUS_OK);
  CHECK(array.rows == 2002 && array.columns == 2 && value(&array, 1000, 0) == value(&array, 1001, 0));
  double total = 0.0;
  for (int32_t column = VOXELASTICA_SLICE_COLUMN_S; column <= VOXELASTICA_SLICE_COLUMN_NEUTRAL_OFFSET; ++column) {
    CHECK(voxelastica_design_slices(design, column, &array, &error) == VOXELASTICA_STATUS_OK);
    CHECK(array.rows == 20);
    for (size_t i = 0; i < array.rows; ++i) {
      total += value(&array, i, 0);
    }
  }
  CHECK(isfinite(total));

  voxelastica_voxels voxels;
  CHECK(voxelastica_design_voxels(design, &voxels, &error) == VOXELASTICA_STATUS_OK);
  CHECK(voxels.size_mm == 1.0 && voxels.slices == 20 && voxels.layers == 2 && voxels.phase_count == 2);
  CHECK(voxels.offsets.rows == 21 && voxels.offsets.data[20] == voxels.phases.rows);
  CHECK(voxels.half_widths.rows == 20 && voxels.half_widths.data[0] * 4 == voxels.offsets.data[1]);
  CHECK(voxelastica_design_phases(design) == 2);
  size_t seen = 0;
  for (size_t phase = 0; phase < 2; ++phase) {
    voxelastica_text *name = NULL;
    CHECK(voxelastica_design_phase_name(design, phase, &name, &error) == VOXELASTICA_STATUS_OK);
    CHECK(strncmp(voxelastica_text_data(name), "FLX90", 5) == 0);
    voxelastica_text_free(name);
    size_t count = 0;
    CHECK(voxelastica_design_phase_voxels(design, phase, &count, &error) == VOXELASTICA_STATUS_OK);
    seen += count;
    double *centres = malloc(3 * count * sizeof(double));
    CHECK(voxelastica_design_phase_centres(design, phase, centres, 3 * count, &error) == VOXELASTICA_STATUS_OK);
    CHECK(centres[0] == 0.5 && fabs(centres[2]) == 0.5);
    voxelastica_status status = voxelastica_design_phase_centres(design, phase, centres, 3 * count - 1, &error);
    failed(status, VOXELASTICA_STATUS_WRONG_LENGTH, error, "centres", "must hold");
    free(centres);
  }
  CHECK(seen == voxels.phases.rows);

  voxelastica_status status = voxelastica_design_profile(design, 99, &array, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "column", "99");
  status = voxelastica_design_slices(design, -1, &array, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "column", "-1");
  size_t count = 0;
  status = voxelastica_design_phase_voxels(design, 2, &count, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "phase", "below 2");
}

static void geometry(const voxelastica_design *design) {
  voxelastica_error *error = NULL;
  voxelastica_mesh *mesh = NULL;
  voxelastica_array_f64 positions, normals, modulus;
  voxelastica_array_u32 quads;
  const double fractions[] = {0.0, 0.37, 1.0};
  for (size_t i = 0; i < 3; ++i) {
    for (int32_t strip = VOXELASTICA_STRIP_KIND_GRADED; strip <= VOXELASTICA_STRIP_KIND_VOXEL; ++strip) {
      CHECK(voxelastica_mesh_new(design, strip, fractions[i], 5, 10, 4, &mesh, &error) == VOXELASTICA_STATUS_OK);
      CHECK(voxelastica_mesh_positions(mesh, &positions, &error) == VOXELASTICA_STATUS_OK);
      CHECK(voxelastica_mesh_normals(mesh, &normals, &error) == VOXELASTICA_STATUS_OK);
      CHECK(voxelastica_mesh_modulus(mesh, &modulus, &error) == VOXELASTICA_STATUS_OK);
      CHECK(voxelastica_mesh_quads(mesh, &quads, &error) == VOXELASTICA_STATUS_OK);
      CHECK(positions.rows == 55 && positions.columns == 3 && normals.rows == 55 && modulus.rows == 55);
      CHECK(quads.rows == 40 && quads.columns == 4 && quads.data[159] < 55);
      double length = hypot(hypot(value(&normals, 7, 0), value(&normals, 7, 1)), value(&normals, 7, 2));
      CHECK(fabs(length - 1.0) < 1e-12 && value(&modulus, 0, 0) > 0.0);
      CHECK(i > 0 || value(&positions, 54, 2) == 0.0); /* flat */
      CHECK(voxelastica_mesh_free(mesh) == VOXELASTICA_STATUS_OK);
    }
  }
  double hub[18];
  CHECK(voxelastica_design_hub(design, VOXELASTICA_STRIP_KIND_GRADED, 1.0, hub, 18, &error) == VOXELASTICA_STATUS_OK);
  CHECK(hub[2] > 10.0 && hub[2] == hub[17]);

  voxelastica_flower *flower = NULL;
  CHECK(voxelastica_flower_new(design, 0, 20, 4, &flower, &error) == VOXELASTICA_STATUS_OK);
  const size_t vertices = voxelastica_flower_vertices(flower);
  CHECK(vertices == 6 * 21 * 5);
  CHECK(voxelastica_flower_quads(flower, &quads, &error) == VOXELASTICA_STATUS_OK && quads.rows == 480);
  CHECK(voxelastica_flower_modulus(flower, &modulus, &error) == VOXELASTICA_STATUS_OK && modulus.rows == vertices);
  float *f = malloc(6 * vertices * sizeof(float));
  double *d = malloc(6 * vertices * sizeof(double));
  CHECK(voxelastica_flower_fill_f32(flower, 0.5, f, 3 * vertices, f + 3 * vertices, 3 * vertices, &error) == 0);
  CHECK(voxelastica_flower_fill_f64(flower, 0.5, d, 3 * vertices, d + 3 * vertices, 3 * vertices, &error) == 0);
  for (size_t i = 0; i < 6 * vertices; ++i) {
    CHECK(f[i] == (float)d[i]);
  }
  CHECK(voxelastica_flower_fill_f64(flower, 0.5, d, 3 * vertices, NULL, 0, &error) == VOXELASTICA_STATUS_OK);

  voxelastica_status status = voxelastica_flower_fill_f32(flower, 0.5, f, 3, NULL, 0, &error);
  failed(status, VOXELASTICA_STATUS_WRONG_LENGTH, error, "positions", "must hold");
  status = voxelastica_flower_fill_f32(flower, 0.5, f, 3 * vertices, f + 3 * vertices, 4, &error);
  failed(status, VOXELASTICA_STATUS_WRONG_LENGTH, error, "normals", "must hold");
  status = voxelastica_flower_fill_f32(flower, NAN, f, 3 * vertices, NULL, 0, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "fraction", "from 0 to 1");
  status = voxelastica_flower_fill_f32(flower, 0.5, NULL, 3 * vertices, NULL, 0, &error);
  failed(status, VOXELASTICA_STATUS_NULL_ARGUMENT, error, "positions", "null");
  status = voxelastica_mesh_new(design, 0, 1.5, 0, 10, 4, &mesh, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "fraction", "1.5");
  status = voxelastica_mesh_new(design, 7, 0.5, 0, 10, 4, &mesh, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "strip", "7");
  status = voxelastica_mesh_new(design, 0, 0.5, 6, 10, 4, &mesh, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "spoke", "6");
  status = voxelastica_flower_new(design, 0, 0, 4, &flower, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "along", "from 1");
  status = voxelastica_design_hub(design, 0, 1.0, hub, 17, &error);
  failed(status, VOXELASTICA_STATUS_WRONG_LENGTH, error, "corners", "18");
  status = voxelastica_mesh_quads((const voxelastica_mesh *)(const void *)flower, &quads, &error);
  failed(status, VOXELASTICA_STATUS_BAD_HANDLE, error, "mesh", "another type");
  free(f);
  free(d);
  CHECK(voxelastica_flower_free(flower) == VOXELASTICA_STATUS_OK);

  int told = 0;
  voxelastica_path *path = NULL;
  CHECK(voxelastica_path_new(design, 0, 11, go_on, &told, &path, &error) == VOXELASTICA_STATUS_OK);
  CHECK(told >= 1);
  for (int32_t column = VOXELASTICA_PATH_COLUMNS_FRACTION; column <= VOXELASTICA_PATH_COLUMNS_HEIGHT; ++column) {
    CHECK(voxelastica_path_column(path, column, &modulus, &error) == VOXELASTICA_STATUS_OK && modulus.rows == 11);
  }
  status = voxelastica_path_column(path, 7, &modulus, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "column", "7");
  CHECK(voxelastica_path_free(path) == VOXELASTICA_STATUS_OK);
  status = voxelastica_path_new(design, 0, 100000, stop, &told, &path, &error);
  failed(status, VOXELASTICA_STATUS_CANCELLED, error, "", "cancelled");
}

static void designs(const char *folder) {
  voxelastica_error *error = NULL;
  voxelastica_design *design = NULL;
  voxelastica_text *text = NULL;
  double figure = 0.0;
  int told = 0;
  voxelastica_input *input = parsed(SMALL);
  CHECK(voxelastica_design_compute(input, false, go_on, &told, &design, &error) == VOXELASTICA_STATUS_OK);
  CHECK(voxelastica_design_summary(design, &text, &error) == VOXELASTICA_STATUS_OK);
  CHECK(strstr(voxelastica_text_data(text), "\"contrast\"") != NULL);
  voxelastica_text_free(text);
  CHECK(voxelastica_design_json(design, &text, &error) == VOXELASTICA_STATUS_OK);
  CHECK(strstr(voxelastica_text_data(text), "voxelastica/design/1") != NULL);
  voxelastica_text_free(text);
  CHECK(voxelastica_design_figure(design, TEXT("thrust.total.beam.horizontal_n"), &figure, &error) == 0);
  CHECK(figure != 0.0 && voxelastica_design_spokes(design) == 6);
  for (size_t i = 0; i < voxelastica_design_warnings(design); ++i) {
    CHECK(strlen(voxelastica_design_warning(design, i)) > 10);
  }
  CHECK(voxelastica_design_warning(design, 1000) == NULL);
  voxelastica_status status = voxelastica_design_figure(design, TEXT("thrust"), &figure, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "name", "thrust");

  lent_arrays(design);
  geometry(design);

  CHECK(voxelastica_design_write(design, TEXT(folder), VOXELASTICA_OUTPUT_ALL, false, go_on, &told, &text, &error) == 0);
  CHECK(strstr(voxelastica_text_data(text), "abaqus/voxel_solid.inp") != NULL);
  voxelastica_text_free(text);
  status = voxelastica_design_write(design, TEXT(folder), 0, false, NULL, NULL, NULL, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "kinds", "voxelastica_output");
  status = voxelastica_design_write(design, TEXT("/dev/null/x"), VOXELASTICA_OUTPUT_TABLES, false, NULL, NULL, NULL, &error);
  failed(status, VOXELASTICA_STATUS_OUTPUT, error, "", "/dev/null");
  status = voxelastica_design_write(design, "a\0b", 3, 1, false, NULL, NULL, NULL, &error);
  failed(status, VOXELASTICA_STATUS_BAD_TEXT, error, "folder", "zero");

  /* What is made of a design outlives it. */
  voxelastica_flower *flower = NULL;
  CHECK(voxelastica_flower_new(design, 0, 2, 1, &flower, NULL) == VOXELASTICA_STATUS_OK);
  CHECK(voxelastica_design_free(design) == VOXELASTICA_STATUS_OK);
  double places[6 * 6 * 3];
  CHECK(voxelastica_flower_fill_f64(flower, 1.0, places, 108, NULL, 0, NULL) == VOXELASTICA_STATUS_OK);
  CHECK(voxelastica_flower_free(flower) == VOXELASTICA_STATUS_OK);
  voxelastica_input_free(input);

  input = parsed(
      "[target]\nkind = \"inclination-polynomial\"\ncoefficients_deg = [0.0]\n[strips]\ncount = 6\nlength_mm = 20.0\n"
      "hub_radius_mm = 3.0\nthickness_mm = 2.0\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\nsize_mm = 1.0\n");
  status = voxelastica_design_compute(input, false, NULL, NULL, &design, &error);
  failed(status, VOXELASTICA_STATUS_INFEASIBLE, error, "target", "straight");
  voxelastica_input_free(input);

  input = parsed(
      "[target]\nkind = \"hemi-ellipsoid\"\n[strips]\ncount = 8\nlength_mm = 100.0\nhub_radius_mm = 10.0\n"
      "thickness_mm = 20.0\n[materials]\nphases = [\"FLX9070\", \"FLX9095\"]\n[voxels]\nsize_mm = 0.1\n");
  told = 0;
  status = voxelastica_design_compute(input, false, stop, &told, &design, &error);
  failed(status, VOXELASTICA_STATUS_CANCELLED, error, "", "cancelled");
  CHECK(told == 1);
  voxelastica_input_free(input);
}

/* Solving, correcting, conducting and making: everything that takes longer than a design. */
static void analyses(const char *folder) {
  voxelastica_error *error = NULL;
  voxelastica_design *design = NULL, *refined = NULL;
  voxelastica_input *again = NULL;
  voxelastica_text *text = NULL;
  int told = 0;
  voxelastica_input *input = parsed(
    "[target]\n"
    "kind = \"hemi-ellipsoid\"\n"
    "[strips]\n"
    "count = 6\n"
    "length_mm = 20.0\n"
    "hub_radius_mm = 3.0\n"
    "thickness_mm = 2.0\n"
    "[materials]\n"
    "phases = [\"a\", \"b\"]\n"
    "[[materials.custom]]\n"
    "name = \"a\"\n"
    "modulus_mpa = 3.0\n"
    "poisson = 0.3\n"
    "density_kg_m3 = 1400.0\n"
    "conductivity_w_mk = 0.3\n"
    "specific_heat_j_kgk = 1100.0\n"
    "[[materials.custom]]\n"
    "name = \"b\"\n"
    "modulus_mpa = 12.0\n"
    "poisson = 0.3\n"
    "density_kg_m3 = 1300.0\n"
    "conductivity_w_mk = 2.0\n"
    "specific_heat_j_kgk = 1200.0\n"
    "[voxels]\n"
    "size_mm = 1.0\n");
  CHECK(voxelastica_design_compute(input, false, NULL, NULL, &design, &error) == VOXELASTICA_STATUS_OK);
  CHECK(voxelastica_design_verify(design, VOXELASTICA_SOLVED_MODEL_VOXEL, go_on, &told, &text, &error) == 0);
  CHECK(told >= 1 && strstr(voxelastica_text_data(text), "\"max_error_percent\"") != NULL);
  voxelastica_text_free(text);
  voxelastica_status status = voxelastica_design_verify(design, 2, NULL, NULL, &text, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "model", "voxelastica_solved_model");
  status = voxelastica_design_verify(design, 0, stop, &told, &text, &error);
  failed(status, VOXELASTICA_STATUS_CANCELLED, error, "", "cancelled");

  status = voxelastica_design_verify_ccx(design, 1, TEXT("no such solver"), TEXT("unused"), NULL, NULL, &text, &error);
  failed(status, VOXELASTICA_STATUS_SOLVER, error, "", "no such solver");

  CHECK(voxelastica_design_refine(design, 1, false, go_on, &told, &refined, &error) == VOXELASTICA_STATUS_OK);
  CHECK(voxelastica_design_input(refined, &again, &error) == VOXELASTICA_STATUS_OK);
  CHECK(voxelastica_input_json(again, &text, &error) == VOXELASTICA_STATUS_OK);
  CHECK(strstr(voxelastica_text_data(text), "\"refine\"") != NULL);
  voxelastica_text_free(text);
  voxelastica_input_free(again);
  voxelastica_design_free(refined);
  status = voxelastica_design_refine(design, 0, false, NULL, NULL, &refined, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "iterations", "1");

  CHECK(voxelastica_design_conduct(design, VOXELASTICA_FLOW_HEAT, VOXELASTICA_SOLVED_MODEL_VOXEL,
                                   VOXELASTICA_CONDUCT_SHAPE_MORPHED, VOXELASTICA_REGIME_STEADY, go_on, &told, &text,
                                   &error) == VOXELASTICA_STATUS_OK);
  CHECK(strstr(voxelastica_text_data(text), "\"effective_conductivity\"") != NULL);
  voxelastica_text_free(text);
  status = voxelastica_design_conduct(design, 2, 0, 0, 0, NULL, NULL, &text, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "flow", "voxelastica_flow");
  status = voxelastica_design_conduct(design, VOXELASTICA_FLOW_CURRENT, 0, 0, 0, NULL, NULL, &text, &error);
  CHECK(status == VOXELASTICA_STATUS_INPUT && strstr(voxelastica_error_message(error), "conductivity") != NULL);
  voxelastica_error_free(error);
  error = NULL;

  CHECK(voxelastica_design_fabricate(design, TEXT(folder), VOXELASTICA_FABRICATION_SVG | VOXELASTICA_FABRICATION_STL,
                                     false, go_on, &told, &text, &error) == VOXELASTICA_STATUS_OK);
  CHECK(strstr(voxelastica_text_data(text), "fabrication/") != NULL);
  voxelastica_text_free(text);
  status = voxelastica_design_fabricate(design, TEXT(folder), 256, false, NULL, NULL, NULL, &error);
  failed(status, VOXELASTICA_STATUS_OUT_OF_RANGE, error, "kinds", "voxelastica_fabrication");
  voxelastica_design_free(design);
  voxelastica_input_free(input);
}

int main(int argc, char **argv) {
  if (argc != 3) {
    fprintf(stderr, "usage: surface DESIGN.toml FOLDER\n");
    return 2;
  }
  texts_and_lists();
  inputs(argv[1]);
  designs(argv[2]);
  analyses(argv[2]);
  CHECK(voxelastica_live_objects() == 0);
  CHECK(voxelastica_error_message(NULL) == NULL && voxelastica_error_line(NULL) == 0);
  CHECK(voxelastica_error_free(NULL) == VOXELASTICA_STATUS_OK && voxelastica_text_free(NULL) == VOXELASTICA_STATUS_OK);
  printf("%d checks\n", checks);
  return 0;
}
