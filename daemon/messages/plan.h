// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>

#include "daemon/base/result.h"
#include "daemon/geometry/bounds.h"
#include "daemon/messages/deadline_limits.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/result/result.h"

/// Conversions between messages and the structs of planning. They check the form only;
/// `planning::validate` checks the values. Functions without state.
/// Thread-safe.
namespace camway::messages {

/// Converts a request; `wire` holds the keyframes of all pages. Zeros become the defaults of
/// `planning::PlanOptions`. Returns an error for a name or number that has no meaning, e.g.
/// "method: 'magic' is unknown; the values are ...". A value that is not zero but has no effect (a
/// time without `has_times`, a target without its policy) is an error, since its sender meant it.
base::Result<planning::PlanRequest> from_wire(const plan_request_t& wire,
                                              const DeadlineLimits& limits = {});

/// Identifies a request and its sender.
struct RequestIds {
  std::string client_id;
  std::int64_t request_id = 0;
  std::int64_t utime = 0;  ///< microseconds since 1970
};

/// Convert bounds without a check; `geometry::fault_in` checks the numbers.
bounds_t to_wire(const geometry::Bounds& bounds);
geometry::Bounds from_wire(const bounds_t& wire);

/// Reads the path of an answer from the segments of all its pages. Returns an error for segments
/// that are no path.
base::Result<motion::Path> path_of(const std::vector<segment_t>& segments);

/// The members of an answer that are not in the result.
struct AnswerHeader {
  RequestIds ids;  ///< its `utime` is the time at which the answer was computed
  std::string scene;
  std::int64_t scene_revision = 0;
  std::string scene_digest;
};

/// Returns the whole answer as one page, which may be too large for a message: see `encode_pages`.
plan_response_t to_wire(const planning::PlanResult& result, const AnswerHeader& header);

/// Returns the part of an answer's result that `planning::WatchedPath` reads: the path, bit for
/// bit, its certificate and near scale, the times of the collisions, and the keyframe faults with
/// their free poses. `keyframes`: number of keyframes of the request. Fails for numbers that no
/// result has.
base::Result<planning::PlanResult> watched_part_of(const plan_response_t& answer,
                                                   std::size_t keyframes);

/// Returns the answer without all that may differ between two answers to one request on one scene:
/// the durations, whose names end in `_ms`, `utime`, and the start of the daemon.
plan_response_t without_times(plan_response_t answer);

/// Returns an answer that holds only a status of `plan_response_t` and a message.
plan_response_t plain_answer(std::int32_t status, std::string_view message,
                             const AnswerHeader& header);

}  // namespace camway::messages
