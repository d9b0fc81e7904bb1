// SPDX-License-Identifier: MIT
#include "tools/cameras/formats/key_rows.h"

#include <fmt/format.h>

namespace camway::tools {
namespace {

bool is_same_key(const TrackKey& a, const TrackKey& b) {
  return a.time_s == b.time_s && a.pose_W.position == b.pose_W.position &&
         a.pose_W.orientation.coeffs() == b.pose_W.orientation.coeffs() &&
         a.fov_x_rad == b.fov_x_rad && a.fov_y_rad == b.fov_y_rad;
}

}  // namespace

std::string KeyRows::add(const TrackKey& key, std::size_t line) {
  if (!(key.pose_W.orientation.norm() > 0.0)) {
    return fmt::format("line {}: its quaternion is 0, so it has no direction", line);
  }
  if (!track_.keys.empty()) {
    const TrackKey& last = track_.keys.back();
    if (is_same_key(last, key)) {
      ++repeated_;
      return "";
    }
    if (key.time_s == last.time_s) {
      return fmt::format("line {}: its time is that of line {}, with another pose: remove one",
                         line, last_line_);
    }
    if (!(key.time_s > last.time_s)) {
      return fmt::format("line {}: its time is before that of line {}: sort the lines by time",
                         line, last_line_);
    }
  }
  track_.keys.push_back(key);
  last_line_ = line;
  return "";
}

void KeyRows::finish() {
  if (repeated_ > 0) {
    track_.notes.push_back(
        fmt::format("rows that repeat the one before were left out: {}", repeated_));
  }
}

}  // namespace camway::tools
