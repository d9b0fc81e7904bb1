// SPDX-License-Identifier: MIT
#include "daemon/collision/deadline.h"

#include <algorithm>

namespace camway::collision {

namespace {

// Longer than any process lives, short enough that no duration arithmetic overflows.
constexpr double kLongest_s = 1e8;

}  // namespace

Deadline::Deadline(Clock::duration budget) : start_(Clock::now()), budget_(budget) {}

Deadline Deadline::after_s(double seconds) {
  const std::chrono::duration<double> budget(std::clamp(seconds, 0.0, kLongest_s));
  return Deadline(std::chrono::duration_cast<Clock::duration>(budget));
}

Deadline Deadline::never() { return after_s(kLongest_s); }

bool Deadline::passed() const { return Clock::now() - start_ >= budget_; }

double Deadline::remaining_s() const {
  const double left_s = std::chrono::duration<double>(budget_ - (Clock::now() - start_)).count();
  return std::max(left_s, 0.0);
}

double Deadline::elapsed_ms() const {
  return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
}

}  // namespace camway::collision
