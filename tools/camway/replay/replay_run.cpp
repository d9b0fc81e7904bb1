// SPDX-License-Identifier: MIT
#include "tools/camway/replay/replay_run.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <thread>
#include <utility>

#include "daemon/messages/text.h"
#include "daemon/planning/plan.h"
#include "daemon/planning/result/witness_names.h"

namespace camway::tools {
namespace {

using planning::PlanResult;
using planning::Status;

/// Plans a request again; `scene` may be null.
PlanResult plan_again(const RecordedRequest& recorded, const scene::Snapshot* scene,
                      double least_deadline_s) {
  PlanResult result;
  if (!recorded.request) {
    result.status = Status::kInvalid;
    result.message = recorded.error;
    return result;
  }
  if (scene == nullptr) {
    result.status = Status::kUnknownScene;
    result.message = "no scene '" + recorded.scene + "'";
    return result;
  }
  planning::PlanRequest request = *recorded.request;
  // Only the answer has the bounds of the recorded scene.
  if (recorded.answer && recorded.answer->result) {
    request.options.bounds =
        request.options.bounds.within(messages::from_wire(recorded.answer->result->bounds));
  }
  request.options.deadline_s = std::max(request.options.deadline_s, least_deadline_s);
  result = planning::plan(*scene, request);
  planning::name_witnesses(scene->mesh, request, result);
  return result;
}

/// Returns the time that a request took to plan, as recorded.
double recorded_ms(const RecordedRequest& request) {
  const auto& answer = request.answer;
  const double total_ms = answer && answer->result ? answer->result->total_ms : 0.0;
  return std::isfinite(total_ms) ? total_ms : 0.0;
}

/// Returns the order in which to plan: scenes by their revisions, since going back costs a rebuild;
/// in each, those first that took the longest, since a long one at the end would keep one thread
/// busy and let the others wait.
std::vector<std::size_t> planning_order(const Session& session) {
  std::vector<std::size_t> order(session.requests.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::map<std::pair<std::string, std::int64_t>, std::size_t> first_of_revision;
  std::vector<std::pair<std::size_t, double>> keys;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const RecordedRequest& request = session.requests[i];
    const std::int64_t revision =
        request.answer && request.answer->result ? request.answer->result->scene_revision : 0;
    const auto first = first_of_revision.try_emplace({request.scene, revision}, i).first;
    keys.emplace_back(first->second, -recorded_ms(request));
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t index) { return keys[index]; });
  return order;
}

}  // namespace

void name_remedy(Judgement& judgement) {
  if (judgement.note == kCutShort) judgement.note += "; --least-deadline-s lengthens deadlines";
}

ReplayedRequest replay_one(const RecordedRequest& recorded, ReplayScenes& scenes,
                           const ReplayOptions& options) {
  ReplayedRequest replayed;
  ComparedRequest& compared = replayed.compared;
  compared.recorded = &recorded;
  const FoundScene found = recorded.request ? scenes.snapshot_of(recorded) : FoundScene{};
  if (!found.why_not.empty()) {
    compared.note = found.why_not;
    compared.scene_is_damaged = found.is_damaged;
    return replayed;
  }
  replayed.result = plan_again(recorded, found.snapshot.get(), options.least_deadline_s);
  RecordedAnswer& answer = compared.now.emplace();
  answer.result = messages::to_wire(replayed.result, {});
  answer.status = messages::status_name(answer.result->status);
  if (found.snapshot != nullptr) answer.scene_digest = found.snapshot->digest;
  static_cast<Judgement&>(compared) = judge(recorded, answers_of(compared), options.thresholds);
  name_remedy(compared);
  return replayed;
}

std::vector<ReplayedRequest> replay(const Session& session, ReplayScenes& scenes,
                                    const ReplayOptions& options) {
  std::vector<ReplayedRequest> replayed(session.requests.size());
  const std::vector<std::size_t> order = planning_order(session);
  std::atomic<std::size_t> next{0};
  // Threads share the counter and the scenes only: each writes the elements whose indices it took.
  const auto work = [&] {
    for (std::size_t turn = next++; turn < order.size(); turn = next++) {
      replayed[order[turn]] = replay_one(session.requests[order[turn]], scenes, options);
    }
  };
  std::vector<std::jthread> threads;
  for (unsigned i = 1; i < options.threads; ++i) threads.emplace_back(work);
  work();
  threads.clear();  // joins
  return replayed;
}

}  // namespace camway::tools
