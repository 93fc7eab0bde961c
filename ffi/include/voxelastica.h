/* Voxelastica: inverse design of shape-morphing strips, as a native library.
 *
 * Made by cbindgen from ffi/src; change the sources and run `VOXELASTICA_UPDATE=1 cargo test -p voxelastica-ffi --test
 * header`. docs/embedding.md has examples and the rules of ownership and threads:
 *
 * - Every handle that a function makes belongs to the caller and is freed by its voxelastica_<type>_free.
 * - Arrays and texts that a handle lends are read-only and live until it is freed.
 * - Outputs are written only on success; *error is written only on failure, and may be null where it is not wanted.
 * - Handles may move between threads and be read by several at once.
 * - Texts are UTF-8, given by pointer and length; none needs a zero byte at its end.
 * - Lengths are in mm, forces in N, moduli in MPa, angles in rad.
 */

#ifndef VOXELASTICA_H
#define VOXELASTICA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Version of the interface that this header describes.
#define VOXELASTICA_ABI_VERSION 3

// What a call returns. Codes are never reused; those below 6 and 130 are the command line's exit codes.
enum voxelastica_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Done; outputs are written.
  VOXELASTICA_STATUS_OK = 0,
  // A defect of the library; please report it.
  VOXELASTICA_STATUS_INTERNAL = 1,
  // The design, or a file it names, is wrong.
  VOXELASTICA_STATUS_INPUT = 2,
  // Mechanics or the materials rule the design out.
  VOXELASTICA_STATUS_INFEASIBLE = 3,
  // A solver is missing, failed or did not converge.
  VOXELASTICA_STATUS_SOLVER = 4,
  // A file could not be written.
  VOXELASTICA_STATUS_OUTPUT = 5,
  // A pointer that must not be null is null.
  VOXELASTICA_STATUS_NULL_ARGUMENT = 7,
  // Not a handle of this type, or one that was freed.
  VOXELASTICA_STATUS_BAD_HANDLE = 8,
  // A buffer has another length than what is to be written into it.
  VOXELASTICA_STATUS_WRONG_LENGTH = 9,
  // A text is not UTF-8, or holds a zero byte.
  VOXELASTICA_STATUS_BAD_TEXT = 10,
  // A number or an index lies outside what is allowed.
  VOXELASTICA_STATUS_OUT_OF_RANGE = 11,
  // The progress callback cancelled the work.
  VOXELASTICA_STATUS_CANCELLED = 130,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum voxelastica_status voxelastica_status;
#else
typedef int32_t voxelastica_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A column of the profile: one value a station, evenly spaced, rim first.
enum voxelastica_profile_column
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Arc length from the rim, mm.
  VOXELASTICA_PROFILE_COLUMN_S = 0,
  // Inclination, rad.
  VOXELASTICA_PROFILE_COLUMN_INCLINATION = 1,
  // Horizontal distance from the rim, mm.
  VOXELASTICA_PROFILE_COLUMN_X = 2,
  // Height above the rim, mm.
  VOXELASTICA_PROFILE_COLUMN_Z = 3,
  // Distance from the dome's axis in the morphed state, mm.
  VOXELASTICA_PROFILE_COLUMN_RHO = 4,
  // Full width, mm.
  VOXELASTICA_PROFILE_COLUMN_WIDTH = 5,
  // Modulus over its largest value.
  VOXELASTICA_PROFILE_COLUMN_MODULUS_RATIO = 6,
  // Modulus, MPa.
  VOXELASTICA_PROFILE_COLUMN_MODULUS = 7,
  // Fraction of the stiffest phase.
  VOXELASTICA_PROFILE_COLUMN_RIGID_FRACTION = 8,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum voxelastica_profile_column voxelastica_profile_column;
#else
typedef int32_t voxelastica_profile_column;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A column of the table of voxel slices: one value a slice, rim first.
enum voxelastica_slice_column
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Arc length of the slice's centre, mm.
  VOXELASTICA_SLICE_COLUMN_S = 0,
  // Modulus the slice should have, MPa.
  VOXELASTICA_SLICE_COLUMN_MODULUS_TARGET = 1,
  // Modulus of its voxels, MPa.
  VOXELASTICA_SLICE_COLUMN_MODULUS = 2,
  // Bending stiffness it should have, N mm^2.
  VOXELASTICA_SLICE_COLUMN_STIFFNESS_TARGET = 3,
  // Bending stiffness of its voxels about their own neutral axis, N mm^2.
  VOXELASTICA_SLICE_COLUMN_STIFFNESS = 4,
  // Height of that axis above the mid-plane, mm.
  VOXELASTICA_SLICE_COLUMN_NEUTRAL_OFFSET = 5,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum voxelastica_slice_column voxelastica_slice_column;
#else
typedef int32_t voxelastica_slice_column;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A column of a path: one value a point, from flat to closed. Forces are those of one spoke in beam bending.
enum voxelastica_path_columns
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Fraction of the morph.
  VOXELASTICA_PATH_COLUMNS_FRACTION = 0,
  // Horizontal force, N; positive when the seat pushes the rim inward.
  VOXELASTICA_PATH_COLUMNS_HORIZONTAL = 1,
  // Vertical force, N; positive when the hub is pushed up.
  VOXELASTICA_PATH_COLUMNS_VERTICAL = 2,
  // Moment at the rim, N mm.
  VOXELASTICA_PATH_COLUMNS_RIM_MOMENT = 3,
  // Moment at the hub, N mm.
  VOXELASTICA_PATH_COLUMNS_HUB_MOMENT = 4,
  // Horizontal distance of the hub from the rim, mm.
  VOXELASTICA_PATH_COLUMNS_SPAN = 5,
  // Height of the hub above the rim, mm.
  VOXELASTICA_PATH_COLUMNS_HEIGHT = 6,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum voxelastica_path_columns voxelastica_path_columns;
#else
typedef int32_t voxelastica_path_columns;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Which strip's shape is taken.
enum voxelastica_strip_kind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // The smooth, graded one: the design itself.
  VOXELASTICA_STRIP_KIND_GRADED = 0,
  // The voxelised one, as the forward model predicts it.
  VOXELASTICA_STRIP_KIND_VOXEL = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum voxelastica_strip_kind voxelastica_strip_kind;
#else
typedef int32_t voxelastica_strip_kind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Kinds of outputs, to be combined with `|`.
enum voxelastica_output
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // `graded_shell.inp` for ABAQUS.
  VOXELASTICA_OUTPUT_GRADED_SHELL = 1,
  // `graded_solid.inp` for every solver of the design.
  VOXELASTICA_OUTPUT_GRADED_SOLID = 2,
  // `voxel_solid.inp` for every solver of the design.
  VOXELASTICA_OUTPUT_VOXEL_SOLID = 4,
  // `voxel_shell.inp` for ABAQUS.
  VOXELASTICA_OUTPUT_VOXEL_SHELL = 8,
  // `profile.csv` and `slices.csv`.
  VOXELASTICA_OUTPUT_TABLES = 16,
  // `report.html`.
  VOXELASTICA_OUTPUT_REPORT = 32,
  // `design.json`.
  VOXELASTICA_OUTPUT_DESIGN = 64,
  // The files to make the thing that the design asks for (`fabrication.write`).
  VOXELASTICA_OUTPUT_FABRICATION = 128,
  // All of them.
  VOXELASTICA_OUTPUT_ALL = 255,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum voxelastica_output voxelastica_output;
#else
typedef uint32_t voxelastica_output;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Which strip is solved.
enum voxelastica_solved_model
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Every voxel its phase.
  VOXELASTICA_SOLVED_MODEL_VOXEL = 0,
  // Smooth width, graded modulus.
  VOXELASTICA_SOLVED_MODEL_GRADED = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum voxelastica_solved_model voxelastica_solved_model;
#else
typedef int32_t voxelastica_solved_model;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What flows.
enum voxelastica_flow
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Heat: the rim at a temperature.
  VOXELASTICA_FLOW_HEAT = 0,
  // Current: in at the rim, the far end grounded.
  VOXELASTICA_FLOW_CURRENT = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum voxelastica_flow voxelastica_flow;
#else
typedef int32_t voxelastica_flow;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// The shape it flows through.
enum voxelastica_conduct_shape
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // The flat strip.
  VOXELASTICA_CONDUCT_SHAPE_FLAT = 0,
  // The closed one, as the forward model predicts it.
  VOXELASTICA_CONDUCT_SHAPE_MORPHED = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum voxelastica_conduct_shape voxelastica_conduct_shape;
#else
typedef int32_t voxelastica_conduct_shape;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What of it is computed.
enum voxelastica_regime
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // The state after a long time.
  VOXELASTICA_REGIME_STEADY = 0,
  // The way there.
  VOXELASTICA_REGIME_TRANSIENT = 1,
  // Both.
  VOXELASTICA_REGIME_BOTH = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum voxelastica_regime voxelastica_regime;
#else
typedef int32_t voxelastica_regime;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Kinds of files to make a design, to be combined with `|`; 0 stands for those that the design asks for, or where it asks
// for none, all that it can have.
enum voxelastica_fabrication
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Closed meshes for printers, one a phase.
  VOXELASTICA_FABRICATION_STL = 1,
  // A 3MF package.
  VOXELASTICA_FABRICATION_THREE_MF = 2,
  // A folder of PNG slices at a printer's pitch.
  VOXELASTICA_FABRICATION_PRINT_STACK = 4,
  // GrabCAD's container of PNG slices.
  VOXELASTICA_FABRICATION_GCVF = 8,
  // Cut lines for a laser cutter.
  VOXELASTICA_FABRICATION_DXF = 16,
  // The same as a drawing.
  VOXELASTICA_FABRICATION_SVG = 32,
  // Hub, base ring and post.
  VOXELASTICA_FABRICATION_ASSEMBLY = 64,
  // A preview of the flat and the closed flower.
  VOXELASTICA_FABRICATION_GLTF = 128,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum voxelastica_fabrication voxelastica_fabrication;
#else
typedef uint32_t voxelastica_fabrication;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A finished design. Immutable: any number of threads may read it at once.
typedef struct voxelastica_design voxelastica_design;

// An error that a call has returned. The caller owns it and frees it with `voxelastica_error_free`. Its texts are UTF-8,
// end with a zero byte and live as long as the error.
typedef struct voxelastica_error voxelastica_error;

// The surfaces of all spokes, prepared so that a new fraction of the morph fills a caller's buffers in about a
// millisecond. Immutable; several threads may fill buffers of their own at once.
typedef struct voxelastica_flower voxelastica_flower;

// A design's input: the design file with defaults filled in and the contents of the files it names. Immutable.
typedef struct voxelastica_input voxelastica_input;

// The mid-surface of one spoke as a grid of quads, `along + 1` by `across + 1` vertices, rim first, from one edge to the
// other. Immutable.
//
// A dome's spoke lies in the flower's frame: hub on the z axis, spoke 0 along +x, z up from the plane of the rim. A
// rectangular strip lies along x with its rim at the origin. All lengths in mm.
typedef struct voxelastica_mesh voxelastica_mesh;

// Forces, moments and the place of the hub at evenly spaced fractions of the morph. Immutable. A strip that is only
// stretched has no such path and all its forces are 0.
typedef struct voxelastica_path voxelastica_path;

// A text in UTF-8. The caller owns it and frees it with `voxelastica_text_free`.
typedef struct voxelastica_text voxelastica_text;

// Told how far work is: `done` of `total`, in a unit of the work's own; `total` is 0 where it is not known. Called on the
// thread that made the call, about fifty times a second. Returning `false` cancels the work. It must not unwind.
typedef bool (*voxelastica_progress)(void *user,
                                     uint64_t done,
                                     uint64_t total);

// As `voxelastica_array_f64`, for 32-bit whole numbers.
typedef struct {
  // First value; not to be used where `rows` is 0.
  const uint32_t *data;
  // Number of rows.
  size_t rows;
  // Number of columns.
  size_t columns;
  // Distance of two rows in bytes.
  size_t stride;
} voxelastica_array_u32;

// Numbers that belong to a handle: read them, never write or free them. They stay where they are until the handle that
// lent them is freed. Value `(row, column)` stands at `(const char *)data + row * stride + column * sizeof(double)`.
typedef struct {
  // First value; not to be used where `rows` is 0.
  const double *data;
  // Number of rows.
  size_t rows;
  // Number of columns.
  size_t columns;
  // Distance of two rows in bytes.
  size_t stride;
} voxelastica_array_f64;

// A material of the library. What is not known is NaN. Its name lives as long as the library is loaded.
typedef struct {
  // Name, as used in `materials.phases`.
  const char *name;
  // Young's modulus, MPa.
  double modulus_mpa;
  // Poisson's ratio.
  double poisson;
  // Density, kg/m^3.
  double density_kg_m3;
  // Thermal conductivity, W/(m K).
  double conductivity_w_mk;
  // Specific heat, J/(kg K).
  double specific_heat_j_kgk;
  // Electrical conductivity, S/m.
  double electrical_conductivity_s_m;
  // Permittivity over that of the vacuum.
  double relative_permittivity;
  // Largest principal strain the material stands.
  double max_strain;
} voxelastica_material;

// A key of the design file. Its texts live as long as the library is loaded; those it does not have are empty.
typedef struct {
  // Dotted key, such as `voxels.size_mm`.
  const char *key;
  // Type and range as JSON: `{"type": "number", "least": 0, "exclusive": true, "most": 10000}`, `{"type": "choice",
  // "choices": [...]}` and so on.
  const char *range;
  // Unit.
  const char *unit;
  // Default as JSON.
  const char *default_value;
  // Kinds of targets it applies to, as a JSON list; an empty list means all.
  const char *targets;
  // What it means.
  const char *description;
  // Whether it must be given.
  bool required;
} voxelastica_parameter;

// As `voxelastica_array_f64`, for bytes.
typedef struct {
  // First value; not to be used where `rows` is 0.
  const uint8_t *data;
  // Number of rows.
  size_t rows;
  // Number of columns.
  size_t columns;
  // Distance of two rows in bytes.
  size_t stride;
} voxelastica_array_u8;

// As `voxelastica_array_f64`, for sizes and places.
typedef struct {
  // First value; not to be used where `rows` is 0.
  const size_t *data;
  // Number of rows.
  size_t rows;
  // Number of columns.
  size_t columns;
  // Distance of two rows in bytes.
  size_t stride;
} voxelastica_array_size;

// The voxels of one flat spoke: slices from rim to hub, layers from the lower face up, voxels across the width.
//
// Slice `i` is `2 half_widths[i]` voxels wide and centred on the spoke's axis; its voxel `(layer, across)` stands at
// `phases[offsets[i] + layer * 2 half_widths[i] + across]`, `across = 0` at the most negative y. All arrays live until the
// design is freed.
typedef struct {
  // Voxel edge, mm.
  double size_mm;
  // Number of slices.
  size_t slices;
  // Number of layers.
  size_t layers;
  // Number of phases.
  size_t phase_count;
  // Phase of every voxel, from 0, softest first.
  voxelastica_array_u8 phases;
  // Where every slice begins, and the total.
  voxelastica_array_size offsets;
  // Half-width of every slice in voxels.
  voxelastica_array_size half_widths;
} voxelastica_voxels;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Solves heat or current on one spoke; nothing is read or written. `flow` is a `voxelastica_flow`, `model` a
// `voxelastica_solved_model`, `shape` a `voxelastica_conduct_shape`, `regime` a `voxelastica_regime`; temperatures,
// currents, times and thresholds are those of the design's table `conduction`. `json` becomes the case as `conduct.json`
// has it: flows, effective conductivities, critical times, and which values are assumptions. `progress` may be null and is
// told thousandths.
//
// # Safety
// `progress` may be called with `user` on this thread during the call; `json` and `error` are null or writable.
voxelastica_status voxelastica_design_conduct(const voxelastica_design *design,
                                              int32_t flow,
                                              int32_t model,
                                              int32_t shape,
                                              int32_t regime,
                                              voxelastica_progress progress,
                                              void *user,
                                              voxelastica_text **json,
                                              voxelastica_error **error);

// Computes a design; nothing is read or written. More than 200 million voxels are refused unless `allow_large`.
// `progress` may be null; it is called with `user`. Free the design with `voxelastica_design_free`; the input may go
// before.
//
// # Safety
// `progress` may be called with `user` on this thread during the call; `design` and `error` are null or writable.
voxelastica_status voxelastica_design_compute(const voxelastica_input *input,
                                              bool allow_large,
                                              voxelastica_progress progress,
                                              void *user,
                                              voxelastica_design **design,
                                              voxelastica_error **error);

// The figures that sum the design up, as JSON: `summary` of `design.json`.
//
// # Safety
// `json` and `error` are null or writable.
voxelastica_status voxelastica_design_summary(const voxelastica_design *design,
                                              voxelastica_text **json,
                                              voxelastica_error **error);

// One figure of the summary by its dotted name: `contrast`, `height_mm`, `thrust.per_spoke.beam.horizontal_n`,
// `volume_mm3.flower`, `voxels.FLX9070` and so on. NaN where the design has none.
//
// # Safety
// `name` is null or points to `name_length` bytes; `value` and `error` are null or writable.
voxelastica_status voxelastica_design_figure(const voxelastica_design *design,
                                             const char *name,
                                             size_t name_length,
                                             double *value,
                                             voxelastica_error **error);

// The whole result as JSON: what `design.json` holds, but for its list of files.
//
// # Safety
// `json` and `error` are null or writable.
voxelastica_status voxelastica_design_json(const voxelastica_design *design,
                                           voxelastica_text **json,
                                           voxelastica_error **error);

// Number of spokes; 1 for a rectangular strip, 0 if this is not a design.
size_t voxelastica_design_spokes(const voxelastica_design *design);

// Number of warnings: what its user should know about this design.
size_t voxelastica_design_warnings(const voxelastica_design *design);

// A warning, from 0 on; it lives as long as the design. Null where there is none of that index.
const char *voxelastica_design_warning(const voxelastica_design *design,
                                       size_t index);

// Frees a design; meshes, flowers and paths made of it stay, arrays it lent do not. Null is allowed.
voxelastica_status voxelastica_design_free(voxelastica_design *design);

// Code of the error; `VOXELASTICA_STATUS_BAD_HANDLE` if this is not an error.
voxelastica_status voxelastica_error_code(const voxelastica_error *error);

// The whole message, as the command line prints it. Null if this is not an error.
const char *voxelastica_error_message(const voxelastica_error *error);

// Dotted key of the design, such as `voxels.size_mm`, or the name of the argument; empty where there is none. Null if
// this is not an error.
const char *voxelastica_error_key(const voxelastica_error *error);

// The offending value as written; empty where there is none. Null if this is not an error.
const char *voxelastica_error_value(const voxelastica_error *error);

// The file that is wrong or could not be written; empty where there is none. Null if this is not an error.
const char *voxelastica_error_file(const voxelastica_error *error);

// The line in that file; 0 where there is none.
size_t voxelastica_error_line(const voxelastica_error *error);

// Frees an error. Null is allowed.
voxelastica_status voxelastica_error_free(voxelastica_error *error);

// Writes files to make a design into the folder `fabrication` of a design's folder: those of the kinds `kinds`
// (`voxelastica_fabrication`, combined; 0 for the design's own). Either all files get their names or none. `progress` may be
// null. `files` (null: not wanted) becomes a JSON list of the files' paths relative to the folder. More voxels or bytes than
// the limits are refused unless `allow_large`.
//
// # Safety
// `folder` is null or points to `folder_length` bytes; `progress` may be called with `user` on this thread during the
// call; `files` and `error` are null or writable.
voxelastica_status voxelastica_design_fabricate(const voxelastica_design *design,
                                                const char *folder,
                                                size_t folder_length,
                                                uint32_t kinds,
                                                bool allow_large,
                                                voxelastica_progress progress,
                                                void *user,
                                                voxelastica_text **files,
                                                voxelastica_error **error);

// Prepares the surfaces of all spokes of the strip `strip` (a `voxelastica_strip_kind`), `along` by `across` quads each,
// in the order and the frame of `voxelastica_mesh`, spoke after spoke. Free it with `voxelastica_flower_free`; the design
// may go before.
//
// # Safety
// `flower` and `error` are null or writable.
voxelastica_status voxelastica_flower_new(const voxelastica_design *design,
                                          int32_t strip,
                                          size_t along,
                                          size_t across,
                                          voxelastica_flower **flower,
                                          voxelastica_error **error);

// Number of vertices of all spokes; 0 if this is not a flower.
size_t voxelastica_flower_vertices(const voxelastica_flower *flower);

// Lends the quads of all spokes, four vertices a row, until the flower is freed. They do not change with the morph.
//
// # Safety
// `array` and `error` are null or writable.
voxelastica_status voxelastica_flower_quads(const voxelastica_flower *flower,
                                            voxelastica_array_u32 *array,
                                            voxelastica_error **error);

// Lends the designed modulus in MPa, one a vertex, until the flower is freed. It does not change with the morph.
//
// # Safety
// `array` and `error` are null or writable.
voxelastica_status voxelastica_flower_modulus(const voxelastica_flower *flower,
                                              voxelastica_array_f64 *array,
                                              voxelastica_error **error);

// Writes the vertices at a fraction of the morph, `x, y, z` each in mm, into `positions`, and unit normals into `normals`
// (null with length 0: none). Each holds exactly three times `voxelastica_flower_vertices` values; on an error both are
// untouched.
//
// # Safety
// Both buffers are null or writable for their lengths and do not overlap; `error` is null or writable.
voxelastica_status voxelastica_flower_fill_f32(const voxelastica_flower *flower,
                                               double fraction,
                                               float *positions,
                                               size_t positions_length,
                                               float *normals,
                                               size_t normals_length,
                                               voxelastica_error **error);

// As `voxelastica_flower_fill_f32`, in double precision.
//
// # Safety
// As for `voxelastica_flower_fill_f32`.
voxelastica_status voxelastica_flower_fill_f64(const voxelastica_flower *flower,
                                               double fraction,
                                               double *positions,
                                               size_t positions_length,
                                               double *normals,
                                               size_t normals_length,
                                               voxelastica_error **error);

// Frees a flower. Null is allowed.
voxelastica_status voxelastica_flower_free(voxelastica_flower *flower);

// Reads a design from TOML text. `file` names it in errors, and its stem names a design that has no name (may be empty);
// relative paths are relative to `folder` (empty: the working folder). `progress` may be null; a large mesh takes seconds.
// Free the input with `voxelastica_input_free`.
//
// # Safety
// Every pointer is null or points to as many bytes as its length says; `progress` may be called with `user` on this
// thread during the call; `input` and `error` are null or writable.
voxelastica_status voxelastica_input_parse_toml(const char *toml,
                                                size_t toml_length,
                                                const char *file,
                                                size_t file_length,
                                                const char *folder,
                                                size_t folder_length,
                                                voxelastica_progress progress,
                                                void *user,
                                                voxelastica_input **input,
                                                voxelastica_error **error);

// As `voxelastica_input_parse_toml`, from JSON text with the TOML's keys, or from a whole `design.json`.
//
// # Safety
// As for `voxelastica_input_parse_toml`.
voxelastica_status voxelastica_input_parse_json(const char *json,
                                                size_t json_length,
                                                const char *file,
                                                size_t file_length,
                                                const char *folder,
                                                size_t folder_length,
                                                voxelastica_progress progress,
                                                void *user,
                                                voxelastica_input **input,
                                                voxelastica_error **error);

// Reads a design file (`.json` as JSON, anything else as TOML) and the files it names. `progress` may be null. Free the
// input with `voxelastica_input_free`.
//
// # Safety
// As for `voxelastica_input_parse_toml`.
voxelastica_status voxelastica_input_read(const char *file,
                                          size_t file_length,
                                          voxelastica_progress progress,
                                          void *user,
                                          voxelastica_input **input,
                                          voxelastica_error **error);

// Checks an input again: ranges and what its keys demand of each other. Reading has done so already; whether mechanics
// allows the design shows when it is computed.
//
// # Safety
// `error` is null or writable.
voxelastica_status voxelastica_input_validate(const voxelastica_input *input,
                                              voxelastica_error **error);

// The input as JSON with all defaults filled in: enough to compute the design again, anywhere.
//
// # Safety
// `json` and `error` are null or writable.
voxelastica_status voxelastica_input_json(const voxelastica_input *input,
                                          voxelastica_text **json,
                                          voxelastica_error **error);

// SHA-256 of the design in hexadecimal, as in the header of every file it writes.
//
// # Safety
// `hash` and `error` are null or writable.
voxelastica_status voxelastica_input_hash(const voxelastica_input *input,
                                          voxelastica_text **hash,
                                          voxelastica_error **error);

// Frees an input; designs computed from it stay. Null is allowed.
voxelastica_status voxelastica_input_free(voxelastica_input *input);

// Number of materials in the library.
size_t voxelastica_materials_count(void);

// A material of the library, from 0 on.
//
// # Safety
// `material` and `error` are null or writable.
voxelastica_status voxelastica_materials_get(size_t index,
                                             voxelastica_material *material,
                                             voxelastica_error **error);

// The library's materials as JSON.
//
// # Safety
// `json` and `error` are null or writable.
voxelastica_status voxelastica_materials_json(voxelastica_text **json,
                                              voxelastica_error **error);

// Number of keys of the design file.
size_t voxelastica_parameters_count(void);

// A key of the design file, from 0 on, in the order of the file.
//
// # Safety
// `parameter` and `error` are null or writable.
voxelastica_status voxelastica_parameters_get(size_t index,
                                              voxelastica_parameter *parameter,
                                              voxelastica_error **error);

// All keys of the design file as JSON: key, type, range, unit, default, description.
//
// # Safety
// `json` and `error` are null or writable.
voxelastica_status voxelastica_parameters_json(voxelastica_text **json,
                                               voxelastica_error **error);

// The JSON Schema of the design file.
//
// # Safety
// `json` and `error` are null or writable.
voxelastica_status voxelastica_parameters_schema(voxelastica_text **json,
                                                 voxelastica_error **error);

// Version of the library, such as `0.1.0`; it lives as long as the library is loaded.
const char *voxelastica_version(void);

// Version of this interface, `VOXELASTICA_ABI_VERSION` of the header that fits. It rises with every change that breaks
// a compiled host.
uint32_t voxelastica_abi_version(void);

// Number of objects that callers hold at present: to find leaks.
size_t voxelastica_live_objects(void);

// Makes the surface of spoke `spoke` (from 0) of the strip `strip` (a `voxelastica_strip_kind`) at a fraction of the
// morph: 0 is flat, 1 closed. `along` by `across` quads. Free it with `voxelastica_mesh_free`; the design may go before.
//
// # Safety
// `mesh` and `error` are null or writable.
voxelastica_status voxelastica_mesh_new(const voxelastica_design *design,
                                        int32_t strip,
                                        double fraction,
                                        size_t spoke,
                                        size_t along,
                                        size_t across,
                                        voxelastica_mesh **mesh,
                                        voxelastica_error **error);

// Lends the vertices, `x, y, z` a row in mm, until the mesh is freed.
//
// # Safety
// `array` and `error` are null or writable.
voxelastica_status voxelastica_mesh_positions(const voxelastica_mesh *mesh,
                                              voxelastica_array_f64 *array,
                                              voxelastica_error **error);

// Lends the unit normals, one a vertex, up in the flat state and outward in the morphed one, until the mesh is freed.
//
// # Safety
// `array` and `error` are null or writable.
voxelastica_status voxelastica_mesh_normals(const voxelastica_mesh *mesh,
                                            voxelastica_array_f64 *array,
                                            voxelastica_error **error);

// Lends the designed modulus in MPa, one a vertex, until the mesh is freed.
//
// # Safety
// `array` and `error` are null or writable.
voxelastica_status voxelastica_mesh_modulus(const voxelastica_mesh *mesh,
                                            voxelastica_array_f64 *array,
                                            voxelastica_error **error);

// Lends the quads, four vertices a row, counter-clockwise seen from where the normals point, until the mesh is freed.
//
// # Safety
// `array` and `error` are null or writable.
voxelastica_status voxelastica_mesh_quads(const voxelastica_mesh *mesh,
                                          voxelastica_array_u32 *array,
                                          voxelastica_error **error);

// Writes the corners of the hub at a fraction of the morph, `x, y, z` each in mm, into a buffer of exactly three times
// `voxelastica_design_spokes` values, counter-clockwise; edge `i` is the end of spoke `i`. A rectangular strip has no hub.
//
// # Safety
// `corners` is null or writable for `length` values; `error` is null or writable.
voxelastica_status voxelastica_design_hub(const voxelastica_design *design,
                                          int32_t strip,
                                          double fraction,
                                          double *corners,
                                          size_t length,
                                          voxelastica_error **error);

// Frees a mesh. Null is allowed.
voxelastica_status voxelastica_mesh_free(voxelastica_mesh *mesh);

// Writes outputs of the kinds `kinds` (`voxelastica_output`, combined) into a folder, which is made where it does not
// exist. Either all files get their names or none. Of the decks those are written that the design has (`decks.write`,
// `decks.solvers`). `progress` may be null and is told bytes (of print files, voxels). `files` (null: not
// wanted) becomes a JSON list of the files' paths relative to the folder. More than the free disk is refused unless `allow_large`.
//
// # Safety
// `folder` is null or points to `folder_length` bytes; `progress` may be called with `user` on this thread during the
// call; `files` and `error` are null or writable.
voxelastica_status voxelastica_design_write(const voxelastica_design *design,
                                            const char *folder,
                                            size_t folder_length,
                                            uint32_t kinds,
                                            bool allow_large,
                                            voxelastica_progress progress,
                                            void *user,
                                            voxelastica_text **files,
                                            voxelastica_error **error);

// Follows the morph of the strip `strip` (a `voxelastica_strip_kind`) at `points` evenly spaced fractions from 0 to 1.
// `progress` may be null. Free the path with `voxelastica_path_free`; the design may go before.
//
// # Safety
// `progress` may be called with `user` on this thread during the call; `path` and `error` are null or writable.
voxelastica_status voxelastica_path_new(const voxelastica_design *design,
                                        int32_t strip,
                                        size_t points,
                                        voxelastica_progress progress,
                                        void *user,
                                        voxelastica_path **path,
                                        voxelastica_error **error);

// Lends a column of the path (a `voxelastica_path_column`), until the path is freed.
//
// # Safety
// `array` and `error` are null or writable.
voxelastica_status voxelastica_path_column(const voxelastica_path *path,
                                           int32_t column,
                                           voxelastica_array_f64 *array,
                                           voxelastica_error **error);

// Frees a path. Null is allowed.
voxelastica_status voxelastica_path_free(voxelastica_path *path);

// Lends a column of the profile (a `voxelastica_profile_column`), until the design is freed.
//
// # Safety
// `array` and `error` are null or writable.
voxelastica_status voxelastica_design_profile(const voxelastica_design *design,
                                              int32_t column,
                                              voxelastica_array_f64 *array,
                                              voxelastica_error **error);

// Lends the outline of the flat spoke, `x, y` a row in mm, x from the rim: up one edge and back along the other. It
// lives until the design is freed.
//
// # Safety
// `array` and `error` are null or writable.
voxelastica_status voxelastica_design_outline(const voxelastica_design *design,
                                              voxelastica_array_f64 *array,
                                              voxelastica_error **error);

// Lends a column of the table of slices (a `voxelastica_slice_column`), until the design is freed. Its stride is that of
// the table.
//
// # Safety
// `array` and `error` are null or writable.
voxelastica_status voxelastica_design_slices(const voxelastica_design *design,
                                             int32_t column,
                                             voxelastica_array_f64 *array,
                                             voxelastica_error **error);

// The text, ended by a zero byte; it lives as long as its handle. Null if this is not a text.
const char *voxelastica_text_data(const voxelastica_text *text);

// Length of the text in bytes, without the zero byte at its end; 0 if this is not a text.
size_t voxelastica_text_length(const voxelastica_text *text);

// Frees a text. Null is allowed.
voxelastica_status voxelastica_text_free(voxelastica_text *text);

// Solves one spoke with the finite elements inside the library and compares its mid-line with the target; nothing is read
// or written. `model` is a `voxelastica_solved_model`. `json` becomes what `verification.json` holds: errors, reactions,
// strains, the mid-line. `progress` may be null and is told thousandths; cancelling waits for a factorisation under way.
//
// # Safety
// `progress` may be called with `user` on this thread during the call; `json` and `error` are null or writable.
voxelastica_status voxelastica_design_verify(const voxelastica_design *design,
                                             int32_t model,
                                             voxelastica_progress progress,
                                             void *user,
                                             voxelastica_text **json,
                                             voxelastica_error **error);

// Solves one spoke with CalculiX and compares its mid-line with the target: `voxelastica_design_verify` with another solver.
// `ccx` is the program, a path or a name that is looked up on `PATH` (empty: `ccx`). The deck and the solver's files are
// written into `folder`, which is the caller's to remove. The design must have the model's deck (`decks.write`) for CalculiX
// (`decks.solvers`). Cancelling ends the solver.
//
// # Safety
// `ccx` and `folder` are null or point to as many bytes as their lengths say; `progress` may be called with `user` on this
// thread during the call; `json` and `error` are null or writable.
voxelastica_status voxelastica_design_verify_ccx(const voxelastica_design *design,
                                                 int32_t model,
                                                 const char *ccx,
                                                 size_t ccx_length,
                                                 const char *folder,
                                                 size_t folder_length,
                                                 voxelastica_progress progress,
                                                 void *user,
                                                 voxelastica_text **json,
                                                 voxelastica_error **error);

// Corrects a design's modulus by what its voxels really do, at most `iterations` times (1 to 50), and gives the best design
// found: a new one, to be freed by `voxelastica_design_free`. Its summary holds the error before and after. `progress` may
// be null and is told thousandths.
//
// # Safety
// `progress` may be called with `user` on this thread during the call; `refined` and `error` are null or writable.
voxelastica_status voxelastica_design_refine(const voxelastica_design *design,
                                             size_t iterations,
                                             bool allow_large,
                                             voxelastica_progress progress,
                                             void *user,
                                             voxelastica_design **refined,
                                             voxelastica_error **error);

// The input of a design as a handle of its own, with what a refinement recorded in it. Free it with
// `voxelastica_input_free`.
//
// # Safety
// `input` and `error` are null or writable.
voxelastica_status voxelastica_design_input(const voxelastica_design *design,
                                            voxelastica_input **input,
                                            voxelastica_error **error);

// Lends the voxels of one spoke, until the design is freed.
//
// # Safety
// `voxels` and `error` are null or writable.
voxelastica_status voxelastica_design_voxels(const voxelastica_design *design,
                                             voxelastica_voxels *voxels,
                                             voxelastica_error **error);

// Number of phases; 0 if this is not a design.
size_t voxelastica_design_phases(const voxelastica_design *design);

// Name of a phase, softest first, from 0 on.
//
// # Safety
// `name` and `error` are null or writable.
voxelastica_status voxelastica_design_phase_name(const voxelastica_design *design,
                                                 size_t phase,
                                                 voxelastica_text **name,
                                                 voxelastica_error **error);

// Number of voxels of a phase in one spoke.
//
// # Safety
// `count` and `error` are null or writable.
voxelastica_status voxelastica_design_phase_voxels(const voxelastica_design *design,
                                                   size_t phase,
                                                   size_t *count,
                                                   voxelastica_error **error);

// Writes the centres of a phase's voxels in the flat spoke, `x, y, z` each in mm, into a buffer of exactly three times
// `voxelastica_design_phase_voxels` values: x from the rim, y across, z from the mid-plane.
//
// # Safety
// `centres` is null or writable for `length` values; `error` is null or writable.
voxelastica_status voxelastica_design_phase_centres(const voxelastica_design *design,
                                                    size_t phase,
                                                    double *centres,
                                                    size_t length,
                                                    voxelastica_error **error);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* VOXELASTICA_H */
