// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace camway::testing {

/// Counts the bytes that the calling thread allocates by `operator new` during the object's
/// lifetime. allocation_meter.cpp replaces that operator in the program that links it.
class AllocationMeter {
 public:
  AllocationMeter();
  [[nodiscard]] std::size_t bytes() const;

 private:
  std::size_t before_;
};

}  // namespace camway::testing
