// SPDX-License-Identifier: MIT
#include "tools/camway/replay/verdict.h"

#include <fmt/format.h>

namespace camway::tools {
namespace {

using planning::PlanResult;
using planning::Status;

/// Returns why the recorded answer cannot be compared with the new one; empty if it can.
std::string why_not_compared(const RecordedRequest& recorded, const PlanResult& now) {
  if (!recorded.answer) return "no answer in the log";
  if (!recorded.answer->result) return "recorded: " + recorded.answer->status;
  const plan_response_t& then = *recorded.answer->result;
  if (then.status == plan_response_t::STATUS_TIMEOUT || then.deadline_reached != 0) {
    return fmt::format(
        "recorded: {}, cut short by its deadline, which hangs on the machine's speed",
        recorded.answer->status);
  }
  if (then.status == plan_response_t::STATUS_UNKNOWN_SCENE && now.status != Status::kUnknownScene) {
    return "recorded: unknown_scene";
  }
  return {};
}

/// Returns the body of the request; a point if its body is not valid.
motion::Body body_of(const RecordedRequest& recorded) {
  if (recorded.request) {
    auto body = motion::Body::make(planning::body_shape(*recorded.request));
    if (body) return *body;
  }
  return motion::Body(motion::Camera{});
}

}  // namespace

Judgement judge(const RecordedRequest& recorded, const PlanResult& now, double tolerance_m) {
  Judgement judgement;
  judgement.note = why_not_compared(recorded, now);
  if (!judgement.note.empty()) return judgement;
  const plan_response_t& then = *recorded.answer->result;
  judgement.difference = difference_of(then, now, body_of(recorded));
  const bool is_close = tolerance_m > 0.0 && then.status == static_cast<int>(now.status) &&
                        then.keyframes.size() == now.keyframes.size() &&
                        judgement.difference.path_m <= tolerance_m;
  const bool agrees = judgement.difference.what.empty() || is_close;
  judgement.verdict = agrees ? Verdict::kAgrees : Verdict::kDiffers;
  if (!agrees) judgement.note = judgement.difference.what;
  return judgement;
}

}  // namespace camway::tools
