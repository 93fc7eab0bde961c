// A function of the host that hears of progress.
#ifndef VOXELASTICA_PROGRESS_HPP
#define VOXELASTICA_PROGRESS_HPP

#include <cstdint>
#include <exception>
#include <functional>
#include <utility>

namespace voxelastica::bridge {

// Called on the thread that made the call. What the function throws cancels the work and is thrown again by that call.
class Progress {
 public:
  Progress() = default;
  explicit Progress(std::function<bool(std::uint64_t, std::uint64_t)> function) : function_(std::move(function)) {}

  bool listens() const noexcept { return static_cast<bool>(function_); }

  bool tell(std::uint64_t done, std::uint64_t total) const noexcept {
    try {
      return function_(done, total);
    } catch (...) {
      thrown_ = std::current_exception();
      return false;
    }
  }

  void rethrow() const {
    if (thrown_) {
      std::rethrow_exception(thrown_);
    }
  }

 private:
  std::function<bool(std::uint64_t, std::uint64_t)> function_;
  mutable std::exception_ptr thrown_;
};

}  // namespace voxelastica::bridge

#endif
