// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/scene/occupancy/occupancy_mirror.h"
#include "tools/camway/load/load_run.h"

namespace camway::tools {

/// What came of many batches of occupancy queries.
struct OccupancyLoad {
  std::int64_t batches = 0;
  std::int64_t queries = 0;  ///< that were answered as the map here does
  std::int64_t wrong = 0;    ///< batches with another answer
  std::int64_t lost = 0;     ///< batches without an answer
  double elapsed_s = 0.0;
  std::vector<float> latency_ms;     ///< of batches
  std::string error;                 ///< why there was no run, or the first failure
  Status status = Status::kInvalid;  ///< of why there was no run
};

/// Lets clients ask the daemon's map of `scene`, batch after batch, for as long as the options say,
/// and compares all answers with those of `map`, which is of that scene. A batch has as many
/// questions of each kind, of `queries` in all, about the box of the scene, the same in each run.
OccupancyLoad run_occupancy_load(const scene::OccupancyMirror& map, const geometry::Box& bounds_W,
                                 const LoadScene& scene, std::size_t queries,
                                 const LoadOptions& options);

}  // namespace camway::tools
