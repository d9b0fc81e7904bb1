// SPDX-License-Identifier: MIT
#include "daemon/service/plans/plan_answer.h"

#include <fmt/format.h>

#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "daemon/planning/request/quaternion_order.h"
#include "daemon/planning/result/witness_names.h"
#include "daemon/scene/import/import_warnings.h"

namespace camway::service {
namespace {

/// Appends warnings to the message, where the sender reads them.
void append_warnings(const scene::ImportReport& report, const planning::PlanRequest& request,
                     planning::PlanResult& result) {
  const auto append = [&](const std::string& warning) {
    result.message += "; warning: " + warning;
  };
  const bool is_planned = result.status != planning::Status::kInvalid;
  // Cameras with wrong orientations often collide at their keyframes.
  if (is_planned || !result.keyframe_faults.empty()) {
    if (const auto warning = planning::quaternion_order_warning(request)) append(*warning);
  }
  if (!is_planned) return;
  const double resolution_m =
      scene::finest_length_m(request.options.interval_tolerance_m, request.options.clearance_m);
  for (const std::string& warning : scene::import_warnings(report, resolution_m)) append(warning);
}

std::shared_ptr<const planning::WatchedPath> shared(std::optional<planning::WatchedPath> path) {
  return path ? std::make_shared<const planning::WatchedPath>(std::move(*path)) : nullptr;
}

}  // namespace

messages::AnswerHeader header_of(const plan_request_t& request, const scene::Snapshot* snapshot) {
  messages::AnswerHeader header;
  header.ids = {request.client_id, request.request_id, utime_now()};
  header.scene = request.scene;
  if (snapshot != nullptr) {
    header.scene_revision = static_cast<std::int64_t>(snapshot->revision);
    header.scene_digest = snapshot->digest;
  }
  return header;
}

Answered answer_of(const Planner& planner, const std::shared_ptr<const scene::Snapshot>& snapshot,
                   const plan_request_t& wire, const messages::DeadlineLimits& limits,
                   const base::Deadline& deadline) {
  std::string error;
  try {
    const base::Result<planning::PlanRequest> converted = messages::from_wire(wire, limits);
    if (!converted) {
      return {messages::plain_answer(plan_response_t::STATUS_INVALID, converted.error,
                                     header_of(wire, snapshot.get()))};
    }
    planning::PlanResult result = planner(*snapshot, *converted, deadline);
    planning::name_witnesses(snapshot->mesh, *converted, result);
    append_warnings(snapshot->report, *converted, result);
    Answered answered{messages::to_wire(result, header_of(wire, snapshot.get()))};
    answered.proved_in = snapshot;
    if (wire.watch_lease_s > 0.0) {
      answered.path = shared(planning::WatchedPath::of(*converted, result));
      answered.interpolated = shared(planning::WatchedPath::as_interpolated(*converted, result));
    }
    return answered;
  } catch (const std::exception& exception) {
    error = exception.what();
  } catch (...) {
    error = "unknown exception";
  }
  return {messages::plain_answer(plan_response_t::STATUS_INTERNAL_ERROR, "internal error: " + error,
                                 header_of(wire, snapshot.get()))};
}

Pages encode_answer(plan_response_t& answer, const daemon_start_t& start, int most_pages) {
  const std::size_t pages = wire::count_pages(answer);
  if (pages > static_cast<std::size_t>(most_pages)) {
    const messages::AnswerHeader header{{answer.client_id, answer.request_id, answer.utime},
                                        answer.scene,
                                        answer.scene_revision,
                                        answer.scene_digest};
    answer =
        messages::plain_answer(plan_response_t::STATUS_LIMIT,
                               fmt::format("the answer takes {} pages, more than the {} allowed "
                                           "(queue.answer_pages); ask for parts of the path",
                                           pages, most_pages),
                               header);
  }
  answer.daemon_start = start;
  return std::make_shared<const std::vector<Bytes>>(wire::encode_pages(answer));
}

}  // namespace camway::service
