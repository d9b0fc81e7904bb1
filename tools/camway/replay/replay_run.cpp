// SPDX-License-Identifier: MIT
#include "tools/camway/replay/replay_run.h"

#include <algorithm>
#include <atomic>
#include <set>
#include <thread>
#include <utility>

#include "daemon/planning/plan.h"
#include "daemon/planning/result/witness_names.h"

namespace camway::tools {
namespace {

using planning::PlanResult;
using planning::Status;

bool scene_was_unknown(const RecordedRequest& request) {
  return request.answer && request.answer->result &&
         request.answer->result->status == plan_response_t::STATUS_UNKNOWN_SCENE;
}

PlanResult plan_again(const RecordedRequest& recorded, const Scenes& scenes) {
  PlanResult result;
  if (!recorded.request) {
    result.status = Status::kInvalid;
    result.message = recorded.error;
    return result;
  }
  const auto scene = scenes.find(recorded.scene);
  if (scene == scenes.end()) {
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
  result = planning::plan(*scene->second, request);
  planning::name_witnesses(scene->second->mesh, request, result);
  return result;
}

}  // namespace

std::vector<std::string> missing_scenes(const Session& session, const Scenes& scenes) {
  std::set<std::string> missing;
  for (const RecordedRequest& request : session.requests) {
    if (request.request && !scenes.contains(request.scene) && !scene_was_unknown(request)) {
      missing.insert(request.scene);
    }
  }
  return {missing.begin(), missing.end()};
}

std::vector<ReplayedRequest> replay(const Session& session, const Scenes& scenes,
                                    const ReplayOptions& options) {
  std::vector<ReplayedRequest> replayed(session.requests.size());
  std::atomic<std::size_t> next{0};
  // Threads share the counter only: each writes the elements whose indices it took.
  const auto work = [&] {
    for (std::size_t i = next++; i < replayed.size(); i = next++) {
      const RecordedRequest& recorded = session.requests[i];
      ReplayedRequest& item = replayed[i];
      item.result = plan_again(recorded, scenes);
      static_cast<Judgement&>(item) = judge(recorded, item.result, options.tolerance_m);
      const auto scene = scenes.find(recorded.scene);
      item.scene_changed = scene != scenes.end() && recorded.answer &&
                           !recorded.answer->scene_digest.empty() &&
                           recorded.answer->scene_digest != scene->second->digest;
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
