// SPDX-License-Identifier: MIT
#include "daemon/motion/path/time_origin.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace camway::motion {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

TimeOrigin TimeOrigin::of(double first_s, double last_s) {
  const bool is_far = last_s - first_s < std::min(std::abs(first_s), std::abs(last_s));
  return {is_far ? first_s : 0.0};
}

double TimeOrigin::sent_not_after_s(double local_s) const {
  const double time_s = sent_s(local_s);
  return this->local_s(time_s) > local_s ? std::nextafter(time_s, -kInfinity) : time_s;
}

double TimeOrigin::sent_not_before_s(double local_s) const {
  const double time_s = sent_s(local_s);
  return this->local_s(time_s) < local_s ? std::nextafter(time_s, kInfinity) : time_s;
}

double TimeOrigin::resolution_s(double local_s) const {
  const double size_s = std::abs(sent_s(local_s));
  return std::nextafter(size_s, kInfinity) - size_s;
}

}  // namespace camway::motion
