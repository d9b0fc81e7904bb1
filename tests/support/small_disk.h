// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "tests/integration/process.h"
#include "tests/support/temporary_folder.h"

namespace camway::testing {

/// A file system of its own in memory that a test may fill. Other processes reach it by `path`.
class SmallDisk {
 public:
  explicit SmallDisk(std::size_t kibibytes);

  /// Whether this system lets the test mount one.
  [[nodiscard]] bool is_there() const { return is_there_; }
  [[nodiscard]] std::filesystem::path path() const;
  /// Leaves no byte free.
  void fill() const;
  /// Removes what `fill` has written.
  void make_room() const;

 private:
  TemporaryFolder folder_;
  /// Lives in a mount namespace of its own, and keeps it.
  std::unique_ptr<integration::Process> holder_;
  bool is_there_ = false;
};

}  // namespace camway::testing
