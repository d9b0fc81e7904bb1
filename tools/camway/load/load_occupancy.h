// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/scene/mirror/scene_mirror.h"
#include "tools/camway/load/load_run.h"

namespace camway::tools {

/// The result of many batches of occupancy queries.
struct OccupancyLoad {
  std::int64_t batches = 0;
  std::int64_t queries = 0;  ///< queries with the same answer as the local map
  std::int64_t wrong = 0;    ///< batches with another answer than the local map
  std::int64_t lost = 0;     ///< batches without an answer
  double elapsed_s = 0.0;
  std::vector<float> latency_ms;     ///< latencies of the batches
  std::string error;                 ///< reason why there was no run, or the first failure
  Status status = Status::kInvalid;  ///< status of the failure if there was no run
};

/// Runs clients that query the daemon's map of `scene`, batch after batch, and compares all answers
/// with those of `map`, which is made of the same scene. A batch has `queries` queries, equally
/// many of each kind, in the box of the scene. They are the same in every run.
OccupancyLoad run_occupancy_load(const scene::SceneMirror& map, const geometry::Box& bounds_W,
                                 const LoadScene& scene, std::size_t queries,
                                 const LoadOptions& options);

}  // namespace camway::tools
