// Voxelastica for C++17: classes that own, views that look, exceptions that say what is wrong.
//
// - Every class here owns its part of the library and is moved, not copied. Const members may be called from several
//   threads at once.
// - A View is valid as long as the object that gave it; temporary objects give none.
// - What fails throws voxelastica::Error; a panic of the library arrives as one with the code Status::Internal.
// - Texts are UTF-8. Lengths are in mm, forces in N, moduli in MPa, angles in rad.
#ifndef VOXELASTICA_HPP
#define VOXELASTICA_HPP

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "voxelastica/cxx.h"
//
#include "voxelastica/bridge.h"
#include "voxelastica/progress.hpp"

namespace voxelastica {

enum class Status : int {
  Internal = 1,
  Input = 2,
  Infeasible = 3,
  Solver = 4,
  Output = 5,
  NullArgument = 7,
  BadHandle = 8,
  WrongLength = 9,
  BadText = 10,
  OutOfRange = 11,
  Cancelled = 130,
};

// What went wrong. what() is the whole message, as the command line prints it.
class Error : public std::runtime_error {
 public:
  Error(Status code, const std::string &message, std::string key, std::string value, std::string file, std::size_t line)
      : std::runtime_error(message),
        code_(code),
        key_(std::move(key)),
        value_(std::move(value)),
        file_(std::move(file)),
        line_(line) {}

  Status code() const noexcept { return code_; }
  // Dotted key of the design, such as voxels.size_mm, or the name of an argument; may be empty.
  const std::string &key() const noexcept { return key_; }
  // The offending value as written; may be empty.
  const std::string &value() const noexcept { return value_; }
  // The file; may be empty.
  const std::string &file() const noexcept { return file_; }
  // The line in that file; 0 where unknown.
  std::size_t line() const noexcept { return line_; }

 private:
  Status code_;
  std::string key_, value_, file_;
  std::size_t line_;
};

// Values of somebody else's, as std::span: read-only unless T is not const.
template <class T>
class View {
 public:
  View() = default;
  View(T *data, std::size_t size) : data_(data), size_(size) {}
  // From anything with data() and size(): std::vector, std::array, std::span.
  template <class Container, class = std::enable_if_t<
                                 std::is_convertible_v<decltype(std::declval<Container &>().data()), T *>>>
  View(Container &values) : data_(values.data()), size_(values.size()) {}

  T *data() const noexcept { return data_; }
  std::size_t size() const noexcept { return size_; }
  bool empty() const noexcept { return size_ == 0; }
  T *begin() const noexcept { return data_; }
  T *end() const noexcept { return data_ + size_; }
  T &operator[](std::size_t i) const { return data_[i]; }
  T &front() const { return data_[0]; }
  T &back() const { return data_[size_ - 1]; }

 private:
  T *data_ = nullptr;
  std::size_t size_ = 0;
};

// Hears how far work is; returning false cancels it. May be empty.
using Progress = std::function<bool(std::uint64_t done, std::uint64_t total)>;

enum class Strip : std::int32_t { Graded = 0, Voxel = 1 };

enum class ProfileColumn : std::int32_t {
  S = 0, Inclination, X, Z, Rho, Width, ModulusRatio, Modulus, RigidFraction
};

enum class PathColumn : std::int32_t { Fraction = 0, Horizontal, Vertical, RimMoment, HubMoment, Span, Height };

// Kinds of outputs, combined with |.
namespace output {
constexpr std::uint32_t GradedShell = 1, GradedSolid = 2, VoxelSolid = 4, VoxelShell = 8, Tables = 16, Report = 32,
                        Design = 64, Fabrication = 128, All = 255;
}

// Kinds of files to make a design, combined with |; 0 stands for those that it asks for, or where it asks for none, all.
namespace fabrication {
constexpr std::uint32_t Stl = 1, ThreeMf = 2, PrintStack = 4, Gcvf = 8, Dxf = 16, Svg = 32, Assembly = 64, Gltf = 128;
}

enum class SolvedModel : std::int32_t { Voxel = 0, Graded };
enum class Flow : std::int32_t { Heat = 0, Current };
enum class ConductShape : std::int32_t { Flat = 0, Morphed };
enum class Regime : std::int32_t { Steady = 0, Transient, Both };

namespace detail {

inline rust::Slice<const std::uint8_t> bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t *>(text.data()), text.size()};
}

template <class T>
View<const T> view(rust::Slice<const T> slice) {
  return {slice.data(), slice.size()};
}

inline std::string text(const rust::String &text) { return {text.data(), text.size()}; }

inline std::vector<std::string> texts(const rust::Vec<rust::String> &texts) {
  std::vector<std::string> copies;
  for (const auto &one : texts) {
    copies.push_back(text(one));
  }
  return copies;
}

// The bridge carries an error as one text: code, key, value, file, line and message, each ended by a unit separator.
[[noreturn]] inline void raise(const rust::Error &error) {
  std::string_view rest = error.what();
  auto next = [&rest]() {
    const auto end = rest.find('\x1f');
    const std::string field(rest.substr(0, end));
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    return field;
  };
  const auto code = next();
  auto key = next(), value = next(), file = next();
  const auto line = next();
  throw Error(static_cast<Status>(std::stoi(code)), std::string(rest), std::move(key), std::move(value),
              std::move(file), std::stoul(line));
}

template <class Body>
auto call(Body body) -> decltype(body()) {
  try {
    return body();
  } catch (const rust::Error &error) {
    raise(error);
  }
}

template <class Body>
auto watched(const Progress &function, Body body) {
  const bridge::Progress progress = function ? bridge::Progress(function) : bridge::Progress();
  try {
    return call([&] { return body(progress); });
  } catch (const Error &) {
    progress.rethrow();
    throw;
  }
}

}  // namespace detail

// A design as its author states it, read and checked.
class Input {
 public:
  // `file` names the text in errors; paths in it are relative to `folder`. Large meshes take seconds: `progress` may
  // cancel.
  static Input from_toml(std::string_view toml, std::string_view file = {}, std::string_view folder = {},
                         const Progress &progress = {}) {
    return Input(detail::watched(progress, [&](const bridge::Progress &told) {
      return bridge::parse_toml(detail::bytes(toml), detail::bytes(file), detail::bytes(folder), told);
    }));
  }
  static Input from_json(std::string_view json, std::string_view file = {}, std::string_view folder = {},
                         const Progress &progress = {}) {
    return Input(detail::watched(progress, [&](const bridge::Progress &told) {
      return bridge::parse_json(detail::bytes(json), detail::bytes(file), detail::bytes(folder), told);
    }));
  }
  static Input read(std::string_view file, const Progress &progress = {}) {
    return Input(detail::watched(
        progress, [&](const bridge::Progress &told) { return bridge::read(detail::bytes(file), told); }));
  }

  void validate() const {
    detail::call([&] { rust_->validate(); });
  }
  // With all defaults filled in.
  std::string json() const {
    return detail::text(detail::call([&] { return rust_->json(); }));
  }
  std::string hash() const {
    return detail::text(detail::call([&] { return rust_->hash(); }));
  }

 private:
  friend class Design;
  explicit Input(rust::Box<bridge::CxxInput> rust) : rust_(std::move(rust)) {}
  rust::Box<bridge::CxxInput> rust_;
};

// The surface of one spoke as quads, rim first, from one edge to the other.
class Mesh {
 public:
  // x, y, z a vertex.
  View<const double> positions() const & { return detail::view(rust_->positions()); }
  View<const double> positions() const && = delete;
  View<const double> normals() const & { return detail::view(rust_->normals()); }
  View<const double> normals() const && = delete;
  View<const double> modulus_mpa() const & { return detail::view(rust_->modulus()); }
  View<const double> modulus_mpa() const && = delete;
  // Four vertices a quad.
  View<const std::uint32_t> quads() const & { return detail::view(rust_->quads()); }
  View<const std::uint32_t> quads() const && = delete;

 private:
  friend class Design;
  explicit Mesh(rust::Box<bridge::CxxMesh> rust) : rust_(std::move(rust)) {}
  rust::Box<bridge::CxxMesh> rust_;
};

// All spokes, for animation: fill() writes the vertices at any fraction of the morph.
class Flower {
 public:
  std::size_t vertices() const { return rust_->vertices(); }
  View<const std::uint32_t> quads() const & { return detail::view(rust_->quads()); }
  View<const std::uint32_t> quads() const && = delete;
  View<const double> modulus_mpa() const & { return detail::view(rust_->modulus()); }
  View<const double> modulus_mpa() const && = delete;

  // Each buffer holds three values a vertex; normals may be left out.
  void fill(double fraction, View<float> positions, View<float> normals = {}) const {
    detail::call([&] { rust_->fill_f32(fraction, slice(positions), slice(normals)); });
  }
  void fill(double fraction, View<double> positions, View<double> normals = {}) const {
    detail::call([&] { rust_->fill_f64(fraction, slice(positions), slice(normals)); });
  }

 private:
  friend class Design;
  explicit Flower(rust::Box<bridge::CxxFlower> rust) : rust_(std::move(rust)) {}
  template <class T>
  static rust::Slice<T> slice(View<T> view) {
    return view.empty() ? rust::Slice<T>() : rust::Slice<T>(view.data(), view.size());
  }
  rust::Box<bridge::CxxFlower> rust_;
};

// Forces and moments of one spoke in beam bending, and the hub's place, from flat to closed.
class MorphPath {
 public:
  View<const double> column(PathColumn column) const & {
    return detail::view(detail::call([&] { return rust_->column(static_cast<std::int32_t>(column)); }));
  }
  View<const double> column(PathColumn column) const && = delete;

 private:
  friend class Design;
  explicit MorphPath(rust::Box<bridge::CxxPath> rust) : rust_(std::move(rust)) {}
  rust::Box<bridge::CxxPath> rust_;
};

// A computed design.
class Design {
 public:
  explicit Design(const Input &input, bool allow_large = false, const Progress &progress = {})
      : rust_(detail::watched(progress, [&](const bridge::Progress &told) {
          return bridge::compute(*input.rust_, allow_large, told);
        })) {}

  // The figures that sum the design up, as JSON.
  std::string summary() const {
    return detail::text(detail::call([&] { return rust_->summary(); }));
  }
  // One of them by its dotted name: "contrast", "thrust.total.beam.vertical_n"; NaN where the design has none.
  double figure(std::string_view name) const {
    return detail::call([&] { return rust_->figure(detail::bytes(name)); });
  }
  // What design.json holds, but for its list of files.
  std::string json() const {
    return detail::text(detail::call([&] { return rust_->json(); }));
  }
  std::size_t spokes() const { return rust_->spokes(); }
  std::vector<std::string> warnings() const {
    return detail::texts(detail::call([&] { return rust_->warnings(); }));
  }
  // Names, softest first.
  std::vector<std::string> phases() const {
    return detail::texts(detail::call([&] { return rust_->phases(); }));
  }

  // One value a station, evenly spaced, rim first.
  View<const double> profile(ProfileColumn column) const & {
    return detail::view(detail::call([&] { return rust_->profile(static_cast<std::int32_t>(column)); }));
  }
  View<const double> profile(ProfileColumn column) const && = delete;
  // x, y a point: up one edge of the flat spoke and back along the other.
  View<const double> outline() const & { return detail::view(rust_->outline()); }
  View<const double> outline() const && = delete;

  double voxel_size_mm() const { return rust_->voxel_size(); }
  std::size_t voxel_layers() const { return rust_->voxel_layers(); }
  // Phase of every voxel of one spoke: slices, in them layers, in them across.
  View<const std::uint8_t> voxel_phases() const & { return detail::view(rust_->voxel_phases()); }
  View<const std::uint8_t> voxel_phases() const && = delete;
  View<const std::size_t> voxel_offsets() const & { return detail::view(rust_->voxel_offsets()); }
  View<const std::size_t> voxel_offsets() const && = delete;
  View<const std::size_t> voxel_half_widths() const & { return detail::view(rust_->voxel_half_widths()); }
  View<const std::size_t> voxel_half_widths() const && = delete;
  // x, y, z of the centres of a phase's voxels in the flat spoke.
  std::vector<double> phase_centres(std::size_t phase) const {
    return copied(detail::call([&] { return rust_->phase_centres(phase); }));
  }

  // x, y, z of the hub's corners, counter-clockwise.
  std::vector<double> hub(double fraction, Strip strip = Strip::Graded) const {
    return copied(detail::call([&] { return rust_->hub(static_cast<std::int32_t>(strip), fraction); }));
  }
  Mesh mesh(double fraction, std::size_t spoke, std::size_t along, std::size_t across,
            Strip strip = Strip::Graded) const {
    return Mesh(detail::call(
        [&] { return rust_->mesh(static_cast<std::int32_t>(strip), fraction, spoke, along, across); }));
  }
  Flower flower(std::size_t along, std::size_t across, Strip strip = Strip::Graded) const {
    return Flower(detail::call([&] { return rust_->flower(static_cast<std::int32_t>(strip), along, across); }));
  }
  MorphPath path(std::size_t points, Strip strip = Strip::Graded, const Progress &progress = {}) const {
    return MorphPath(detail::watched(progress, [&](const bridge::Progress &told) {
      return rust_->path(static_cast<std::int32_t>(strip), points, told);
    }));
  }

  // Writes outputs into a folder; returns their paths relative to it. Either all files get their names or none.
  std::vector<std::string> write(std::string_view folder, std::uint32_t kinds = output::All, bool allow_large = false,
                                 const Progress &progress = {}) const {
    return detail::texts(detail::watched(progress, [&](const bridge::Progress &told) {
      return rust_->write(detail::bytes(folder), kinds, allow_large, told);
    }));
  }

  // Solves one spoke with the finite elements inside the library: what verification.json holds.
  std::string verify(SolvedModel model = SolvedModel::Voxel, const Progress &progress = {}) const {
    return detail::text(detail::watched(progress, [&](const bridge::Progress &told) {
      return rust_->verify(static_cast<std::int32_t>(model), told);
    }));
  }
  // The design corrected by what its voxels really do, at most `iterations` times.
  Design refine(std::size_t iterations, bool allow_large = false, const Progress &progress = {}) const {
    return Design(detail::watched(
        progress, [&](const bridge::Progress &told) { return rust_->refine(iterations, allow_large, told); }));
  }
  // Heat or current through one spoke: a case of conduct.json.
  std::string conduct(Flow flow, Regime regime = Regime::Steady, SolvedModel model = SolvedModel::Voxel,
                      ConductShape shape = ConductShape::Flat, const Progress &progress = {}) const {
    return detail::text(detail::watched(progress, [&](const bridge::Progress &told) {
      return rust_->conduct(static_cast<std::int32_t>(flow), static_cast<std::int32_t>(model),
                            static_cast<std::int32_t>(shape), static_cast<std::int32_t>(regime), told);
    }));
  }
  // Writes files to make the design into the folder of the design; returns their paths relative to it.
  std::vector<std::string> fabricate(std::string_view folder, std::uint32_t kinds = 0, bool allow_large = false,
                                     const Progress &progress = {}) const {
    return detail::texts(detail::watched(progress, [&](const bridge::Progress &told) {
      return rust_->fabricate(detail::bytes(folder), kinds, allow_large, told);
    }));
  }

 private:
  explicit Design(rust::Box<bridge::CxxDesign> rust) : rust_(std::move(rust)) {}
  static std::vector<double> copied(const rust::Vec<double> &values) { return {values.begin(), values.end()}; }
  rust::Box<bridge::CxxDesign> rust_;
};

// The library's materials and the table of the design file's keys, as JSON.
inline std::string materials() {
  return detail::text(detail::call([] { return bridge::materials(); }));
}
inline std::string parameters() {
  return detail::text(detail::call([] { return bridge::parameters(); }));
}
inline std::string version() { return detail::text(bridge::version()); }

}  // namespace voxelastica

#endif
