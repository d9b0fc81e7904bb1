// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "tools/cameras/camera_track.h"

namespace camway::tools {

/// Takes the keys of a table one after the other. Loggers write a pose twice: such rows are left
/// out and counted.
class KeyRows {
 public:
  explicit KeyRows(CameraTrack& track) : track_(track) {}

  /// Adds a key from a line. Returns why that is not possible, with the line: its time is not later
  /// than that of the row before, or its orientation has no direction. Empty if it is.
  std::string add(const TrackKey& key, std::size_t line);

  /// Notes in the track how many rows were left out. Call it once, at the end.
  void finish();

 private:
  CameraTrack& track_;
  std::size_t last_line_ = 0;
  std::size_t repeated_ = 0;
};

}  // namespace camway::tools
