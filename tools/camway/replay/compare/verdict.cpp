// SPDX-License-Identifier: MIT
#include "tools/camway/replay/compare/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <camway/plan_request_t.hpp>

#include "daemon/correction/path/closeness.h"
#include "daemon/service/watches/answer_quality.h"

namespace camway::tools {
namespace {

using Message = plan_response_t;

/// Returns why an answer cannot be compared; empty if it can. `when`: "recorded" or "now".
std::string why_useless(const RecordedAnswer* answer, std::string_view when) {
  if (answer == nullptr) return fmt::format("no answer {}", when);
  if (!answer->result) return fmt::format("{}: {}", when, answer->status);
  return {};
}

bool is_cut_short(const Message& answer) {
  return answer.status == Message::STATUS_TIMEOUT || answer.deadline_reached != 0;
}

/// Returns why two answers cannot be compared; empty if they can.
std::string why_not_compared(const AnswerPair& answers) {
  if (answers.then == nullptr) return "no answer in the log";
  std::string reason = why_useless(answers.then, "recorded");
  if (reason.empty()) reason = why_useless(answers.now, "now");
  if (!reason.empty()) return reason;
  const Message& then = *answers.then->result;
  if (is_cut_short(then)) {
    return fmt::format(
        "recorded: {}, cut short by its deadline, which hangs on the machine's speed",
        answers.then->status);
  }
  const bool was_unknown = then.status == Message::STATUS_UNKNOWN_SCENE;
  if (was_unknown && answers.now->result->status != then.status) return "recorded: unknown_scene";
  return {};
}

/// Returns the viewing distance of two answers: the smaller one, by which the same move shifts the
/// picture more, so that their order does not matter; a default if neither tells any.
double told_distance_m(const Message& then, const Message& now) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const double told_m : {then.viewing_distance_m, now.viewing_distance_m}) {
    if (told_m > 0.0) least_m = std::min(least_m, told_m);
  }
  return std::isfinite(least_m) ? least_m : correction::Closeness{}.viewing_distance_m;
}

/// Returns the body and the viewing distance of the request. For a request that has none, the body
/// is a point, and the distance that of the answers.
Yardstick yardstick_of(const RecordedRequest& recorded, const AnswerPair& answers) {
  Yardstick yardstick{motion::Body(motion::Camera{}),
                      told_distance_m(*answers.then->result, *answers.now->result)};
  if (!recorded.request) return yardstick;
  if (auto body = motion::Body::make(planning::body_shape(*recorded.request))) {
    yardstick.body = std::move(*body.value);
  }
  const double asked_m = recorded.request->options.viewing_distance_m.value_or(0.0);
  if (asked_m > 0.0) yardstick.viewing_distance_m = asked_m;
  return yardstick;
}

/// Returns the rank of a status by its use for the client, the best first.
int rank_of(std::int32_t status) {
  constexpr std::array<std::int32_t, 6> kBestFirst{
      Message::STATUS_OK,      Message::STATUS_INFEASIBLE, Message::STATUS_PARTIAL,
      Message::STATUS_TIMEOUT, Message::STATUS_INVALID,    Message::STATUS_UNKNOWN_SCENE};
  return static_cast<int>(std::ranges::find(kBestFirst, status) - kBestFirst.begin());
}

bool is_refused(std::int32_t status) { return rank_of(status) >= rank_of(Message::STATUS_INVALID); }

double colliding_s(const Message& answer) {
  double sum_s = 0.0;
  for (const collision_interval_t& interval : answer.remaining) {
    sum_s += interval.t_end_s - interval.t_begin_s;
  }
  return sum_s;
}

/// Returns what decides between two answers without a proof: the time in collision.
service::QualityGain collision_gain(const Message& now, const Message& then) {
  const double now_s = colliding_s(now);
  const double then_s = colliding_s(then);
  const auto is_less = [](double one_s, double other_s) {
    return one_s < (1.0 - service::kBetterShare) * other_s;
  };
  const int sign = is_less(now_s, then_s) ? 1 : is_less(then_s, now_s) ? -1 : 0;
  return {sign, "time in collision", " s", then_s, now_s};
}

/// A verdict with its reason.
struct Ruling {
  Verdict verdict;
  std::string reason;
};

/// Judges answers whose status or proof differs; nothing where both are the same.
std::optional<Ruling> ruling_by_proof(const AnswerPair& answers) {
  const Message& then = *answers.then->result;
  const Message& now = *answers.now->result;
  if (is_cut_short(now)) return Ruling{Verdict::kRegressed, std::string(kCutShort)};
  if (then.status == now.status) {
    if (then.certified == now.certified) return std::nullopt;
    return now.certified != 0 ? Ruling{Verdict::kBetter, "proved free"}
                              : Ruling{Verdict::kRegressed, "not proved free any more"};
  }
  const auto are = [&](std::int32_t one, std::int32_t other) {
    return (then.status == one && now.status == other) ||
           (then.status == other && now.status == one);
  };
  if (answers.has_same_scene && are(Message::STATUS_OK, Message::STATUS_INFEASIBLE)) {
    return Ruling{Verdict::kRegressed, "one of the two proofs is wrong"};
  }
  const std::string change =
      fmt::format("status {} -> {}", answers.then->status, answers.now->status);
  if (rank_of(now.status) > rank_of(then.status)) return Ruling{Verdict::kRegressed, change};
  // A request that was refused may be planned rightly or wrongly.
  return Ruling{is_refused(then.status) ? Verdict::kDifferent : Verdict::kBetter, change};
}

/// Returns the limits that the answer exceeds now, as a text; empty if there are none.
std::string exceeded(const Message& then, const Message& now, const Thresholds& limits) {
  std::vector<std::string> found;
  const bool are_proved = then.certified != 0 && now.certified != 0;
  const double loss_m = then.clearance_lower_bound_m - now.clearance_lower_bound_m;
  if (limits.clearance_loss_m && are_proved && loss_m > *limits.clearance_loss_m) {
    found.push_back(fmt::format("clearance {:.4g} -> {:.4g} m", then.clearance_lower_bound_m,
                                now.clearance_lower_bound_m));
  }
  if (limits.longer && then.has_measures != 0 && now.has_measures != 0 &&
      now.measures.length_m > *limits.longer * then.measures.length_m) {
    found.push_back(
        fmt::format("length {:.4g} -> {:.4g} m", then.measures.length_m, now.measures.length_m));
  }
  if (limits.slower && now.total_ms >= kLeastSlow_ms &&
      now.total_ms > *limits.slower * then.total_ms) {
    found.push_back(fmt::format("time {:.4g} -> {:.4g} ms", then.total_ms, now.total_ms));
  }
  return fmt::format("{}", fmt::join(found, ", "));
}

bool is_within(const Difference& difference, const Message& then, const Message& now,
               const Thresholds& thresholds) {
  return thresholds.tolerance_m > 0.0 && then.status == now.status &&
         then.certified == now.certified && then.keyframes.size() == now.keyframes.size() &&
         difference.path_m <= thresholds.tolerance_m &&
         difference.shift_rad <= thresholds.tolerance_shift_rad;
}

/// Judges answers of one status by the measures of their paths.
Ruling ruling_by_quality(const Message& then, const Message& now, correction::Objective objective) {
  service::QualityGain gain;
  if (then.certified == 0) {
    gain = collision_gain(now, then);
  } else if (then.has_measures != 0 && now.has_measures != 0) {
    gain = service::gain_of(service::AnswerQuality::of(now), service::AnswerQuality::of(then),
                            static_cast<std::int8_t>(objective));
  }
  if (gain.sign == 0) return {Verdict::kDifferent, {}};
  std::string reason =
      fmt::format("{} {:.4g} -> {:.4g}{}", gain.what, gain.before, gain.now, gain.unit);
  if (gain.is_of_objective) reason += fmt::format(" ({})", base::name_of(objective));
  return {gain.sign > 0 ? Verdict::kBetter : Verdict::kWorse, std::move(reason)};
}

Ruling ruling_of(const RecordedRequest& recorded, const AnswerPair& answers,
                 const Difference& difference, const Thresholds& thresholds) {
  const Message& then = *answers.then->result;
  const Message& now = *answers.now->result;
  if (!difference.has_same_bits()) {
    if (auto ruling = ruling_by_proof(answers)) return *ruling;
  }
  if (std::string limit = exceeded(then, now, thresholds); !limit.empty()) {
    return {Verdict::kRegressed, limit};
  }
  if (difference.has_same_bits()) return {Verdict::kSame, {}};
  if (is_within(difference, then, now, thresholds)) {
    return {Verdict::kSame, "within the tolerances"};
  }
  const auto objective =
      recorded.request ? recorded.request->options.objective : correction::Objective::kClosest;
  return ruling_by_quality(then, now, objective);
}

}  // namespace

Judgement judge(const RecordedRequest& recorded, const AnswerPair& answers,
                const Thresholds& thresholds) {
  Judgement judgement;
  judgement.note = why_not_compared(answers);
  if (!judgement.note.empty()) return judgement;
  judgement.difference =
      difference_of(*answers.then->result, *answers.now->result, yardstick_of(recorded, answers));
  Ruling ruling = ruling_of(recorded, answers, judgement.difference, thresholds);
  judgement.verdict = ruling.verdict;
  judgement.note = std::move(ruling.reason);
  return judgement;
}

}  // namespace camway::tools
