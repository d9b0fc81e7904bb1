// SPDX-License-Identifier: MIT
#include "tests/fuzz/exercise_message.h"

#include <algorithm>
#include <mutex>
#include <vector>

#include <camway/cancel_t.hpp>
#include <camway/claim_t.hpp>
#include <camway/envelope_t.hpp>
#include <camway/error_t.hpp>
#include <camway/fleet_answer_t.hpp>
#include <camway/fleet_job_t.hpp>
#include <camway/map_page_t.hpp>
#include <camway/missing_pages_t.hpp>
#include <camway/occupancy_request_t.hpp>
#include <camway/occupancy_response_t.hpp>
#include <camway/plan_progress_t.hpp>
#include <camway/plan_request_t.hpp>
#include <camway/plan_response_t.hpp>
#include <camway/planner_status_t.hpp>
#include <camway/scene_response_t.hpp>
#include <camway/status_t.hpp>
#include <camway/upload_status_t.hpp>
#include <camway/watch_report_t.hpp>
#include <camway/watch_t.hpp>

#include "client/engine/occupancy_collector.h"
#include "client/engine/plan_collector.h"
#include "client/messages/occupancy.h"
#include "client/messages/plan.h"
#include "client/messages/status.h"
#include "daemon/messages/plan.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/request/validate.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "daemon/service/core/answer_cache.h"
#include "daemon/service/occupancy/occupancy_answer.h"
#include "daemon/service/scenes/scene_operation.h"
#include "daemon/service/scenes/uploads.h"
#include "lcmtypes/wire/check.h"
#include "lcmtypes/wire/envelope.h"
#include "lcmtypes/wire/page_assembly.h"
#include "tests/fuzz/targets.h"

namespace camway::testing {
namespace {

template <class Message>
std::optional<Message> decoded(std::span<const std::uint8_t> bytes) {
  wire::Decoded<Message> result = wire::decode<Message>(bytes);
  if (!result.message) {
    promise(!result.fault.reason.empty(), "a refusal has a reason");
    static_cast<void>(wire::peek_sender(wire::layout_of<Message>(), bytes));
    return std::nullopt;
  }
  const std::vector<std::uint8_t> again = wire::encode(*result.message);
  promise(std::equal(again.begin(), again.end(), bytes.begin(), bytes.end()),
          "what is accepted encodes to the same bytes");
  return std::move(result.message);
}

void exercise(const plan_request_t& message) {
  wire::PageAssembly<plan_request_t> pages;
  const auto outcome = pages.add(message);
  promise(outcome.whole.has_value() + !outcome.error.empty() + (pages.half_received() > 0) == 1,
          "a page completes a message, waits or is refused");
  if (!outcome.whole) return;
  static_cast<void>(service::digest_of(*outcome.whole));
  const auto converted = messages::from_wire(*outcome.whole);
  promise(converted.value.has_value() == converted.error.empty(), "a request or a reason");
  if (converted) static_cast<void>(planning::validate(*converted));
}

/// Runs a scene request on a scene of one box. It reads no files, because there are neither roots
/// nor uploads.
void exercise(const scene_request_t& message) {
  // Round shapes with a fine chord error would only take long.
  if (message.kind == scene_request_t::SPHERE || message.kind == scene_request_t::CYLINDER) return;
  scene::SceneStore scenes;
  scene::SnapshotOptions options;
  options.field.reset();
  scenes.put(scene::make_snapshot(message.scene, *scene::box_mesh({1, 1, 1}), options).snapshot);
  const service::SceneRules rules;
  std::mutex writing;
  const scene_response_t answer =
      service::execute(message, nullptr, {rules, scenes, writing, {}}).answer;
  promise(answer.status == scene_response_t::STATUS_OK || !answer.message.empty(),
          "a refusal has a reason");
}

void exercise(const upload_page_t& message) {
  service::Uploads::Limits limits;
  limits.bytes = 100'000;
  service::Uploads uploads(limits);
  static_cast<void>(uploads.take(message, {}));
  promise(uploads.bytes() <= limits.bytes, "uploads keep within their limits");
}

/// Processes an answer like `camway replay` and like a client.
void exercise(const plan_response_t& message, std::span<const std::uint8_t> bytes) {
  const auto path = messages::path_of(message.segments);
  promise(path.value.has_value() == path.error.empty(), "a path or a reason");
  PlanCollector collector(message.client_id, message.request_id);
  collector.take(bytes);
  if (collector.complete()) static_cast<void>(collector.response());
}

/// Processes an answer to an empty batch.
void exercise(const occupancy_response_t& message, std::span<const std::uint8_t> bytes) {
  OccupancyCollector collector(message.client_id, message.request_id);
  collector.take(bytes);
  if (!collector.response()) return;
  OccupancyAnswer answer;
  static_cast<void>(append(occupancy_request_t{}, *collector.response(), answer));
}

}  // namespace

int exercise_message(std::span<const std::uint8_t> bytes) {
  int right = 0;
  if (const auto request = decoded<plan_request_t>(bytes)) {
    exercise(*request);
    ++right;
  }
  if (const auto batch = decoded<occupancy_request_t>(bytes)) {
    static_cast<void>(service::batch_fault(*batch));
    ++right;
  }
  if (const auto request = decoded<scene_request_t>(bytes)) {
    exercise(*request);
    ++right;
  }
  if (const auto page = decoded<upload_page_t>(bytes)) {
    exercise(*page);
    ++right;
  }
  if (decoded<cancel_t>(bytes)) ++right;
  if (decoded<claim_t>(bytes)) ++right;
  if (decoded<fleet_job_t>(bytes)) ++right;
  if (decoded<fleet_answer_t>(bytes)) ++right;
  if (decoded<planner_status_t>(bytes)) ++right;
  if (decoded<missing_pages_t>(bytes)) ++right;
  if (decoded<watch_t>(bytes)) ++right;
  if (decoded<watch_report_t>(bytes)) ++right;
  if (const auto progress = decoded<plan_progress_t>(bytes)) {
    PlanProgress read_progress;
    convert(*progress, read_progress);
    ++right;
  }
  if (const auto answer = decoded<plan_response_t>(bytes)) {
    exercise(*answer, bytes);
    ++right;
  }
  if (const auto answer = decoded<occupancy_response_t>(bytes)) {
    exercise(*answer, bytes);
    ++right;
  }
  if (const auto status = decoded<status_t>(bytes)) {
    promise(read_status(bytes).has_value(), "a status that is right is one for clients");
    ++right;
  }
  if (decoded<scene_response_t>(bytes)) ++right;
  if (decoded<upload_status_t>(bytes)) ++right;
  if (decoded<map_page_t>(bytes)) ++right;
  if (decoded<error_t>(bytes)) ++right;
  if (decoded<envelope_t>(bytes)) ++right;
  static_cast<void>(wire::payload_unchecked(bytes));
  return right;
}

}  // namespace camway::testing
