// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace camway::testing {

/// Counts what the calling thread asks of `operator new` during its life. The program that links
/// allocation_meter.cpp replaces that operator.
class AllocationMeter {
 public:
  AllocationMeter();
  [[nodiscard]] std::size_t bytes() const;

 private:
  std::size_t before_;
};

}  // namespace camway::testing
