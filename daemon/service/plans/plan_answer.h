// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>

#include "daemon/base/deadline.h"
#include "daemon/messages/deadline_limits.h"
#include "daemon/messages/plan.h"
#include "daemon/planning/watched_path.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "daemon/service/core/core.h"
#include "daemon/service/transport/answer_pages.h"

/// From a complete request to the messages of its answer. Functions without state.
/// Thread-safe.
namespace camway::service {

/// Returns the header of an answer; with a null `snapshot`, of one that concerns no scene.
messages::AnswerHeader header_of(const plan_request_t& request, const scene::Snapshot* snapshot);

/// An answer, and its paths for watching. A path is null unless the request asks for a watch and
/// the answer has a proved path.
struct Answered {
  plan_response_t wire;
  std::shared_ptr<const planning::WatchedPath> path = nullptr;
  /// The path as interpolated; null also where that is `path`.
  std::shared_ptr<const planning::WatchedPath> interpolated = nullptr;
  /// The revision of the scene that the answer names; null if this process does not hold it.
  std::shared_ptr<const scene::Snapshot> proved_in = nullptr;
};

/// Returns the answer of `planner`. Does not throw: an exception of the planner is an internal
/// error.
Answered answer_of(const Planner& planner, const std::shared_ptr<const scene::Snapshot>& snapshot,
                   const plan_request_t& wire, const messages::DeadlineLimits& limits,
                   const base::Deadline& deadline);

/// Encodes `answer`. If it has more than `most_pages`, replaces it by an answer that says so.
Pages encode_answer(plan_response_t& answer, const daemon_start_t& start, int most_pages);

}  // namespace camway::service
