// SPDX-License-Identifier: MIT
#include "tools/camway/replay/replay_run.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>

#include "daemon/planning/plan.h"
#include "daemon/planning/result/witness_names.h"

namespace camway::tools {
namespace {

using planning::PlanResult;
using planning::Status;

/// Plans a request again; `scene` may be null.
PlanResult plan_again(const RecordedRequest& recorded, const scene::Snapshot* scene) {
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
  result = planning::plan(*scene, request);
  planning::name_witnesses(scene->mesh, request, result);
  return result;
}

ReplayedRequest replay_one(const RecordedRequest& recorded, ReplayScenes& scenes,
                           double tolerance_m) {
  ReplayedRequest item;
  const FoundScene found = recorded.request ? scenes.snapshot_of(recorded) : FoundScene{};
  item.result = plan_again(recorded, found.snapshot.get());
  if (!found.why_not.empty()) {
    item.note = found.why_not;
    return item;
  }
  static_cast<Judgement&>(item) = judge(recorded, item.result, tolerance_m);
  if (found.snapshot == nullptr) return item;
  item.scene_digest = found.snapshot->digest;
  item.scene_changed = recorded.answer && !recorded.answer->scene_digest.empty() &&
                       recorded.answer->scene_digest != item.scene_digest;
  return item;
}

}  // namespace

std::vector<ReplayedRequest> replay(const Session& session, ReplayScenes& scenes,
                                    const ReplayOptions& options) {
  std::vector<ReplayedRequest> replayed(session.requests.size());
  std::atomic<std::size_t> next{0};
  // Threads share the counter and the scenes only: each writes the elements whose indices it took.
  const auto work = [&] {
    for (std::size_t i = next++; i < replayed.size(); i = next++) {
      replayed[i] = replay_one(session.requests[i], scenes, options.tolerance_m);
    }
  };
  std::vector<std::jthread> threads;
  for (unsigned i = 1; i < options.threads; ++i) threads.emplace_back(work);
  work();
  threads.clear();  // joins
  return replayed;
}

std::size_t count(const std::vector<ReplayedRequest>& replayed, Verdict verdict) {
  return static_cast<std::size_t>(
      std::count_if(replayed.begin(), replayed.end(),
                    [&](const ReplayedRequest& item) { return item.verdict == verdict; }));
}

}  // namespace camway::tools
