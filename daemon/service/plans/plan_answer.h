// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>

#include "daemon/base/deadline.h"
#include "daemon/messages/answer_pages.h"
#include "daemon/messages/convert.h"
#include "daemon/planning/watched_path.h"
#include "daemon/scene/snapshot/snapshot.h"
#include "daemon/service/core/core.h"

/// From a whole request to the messages of its answer. Functions without state, safe from any
/// thread.
namespace camway::service {

/// `snapshot` may be null: the answer is about no scene then.
AnswerHeader header_of(const plan_request_t& request, const scene::Snapshot* snapshot);

/// An answer, and what of it can be watched: null unless its request asks for that and the answer
/// proves a path.
struct Answered {
  plan_response_t wire;
  std::shared_ptr<const planning::WatchedPath> path;
};

/// The answer of `planner`, whatever happens: a planner that throws is an internal error.
Answered answer_of(const Planner& planner, const scene::Snapshot& snapshot,
                   const plan_request_t& wire, const DeadlineLimits& limits,
                   const collision::Deadline& deadline);

/// Encodes `answer`, or what takes its place: an answer that says that it has more than
/// `most_pages`.
Pages encode_answer(plan_response_t& answer, int most_pages);

}  // namespace camway::service
