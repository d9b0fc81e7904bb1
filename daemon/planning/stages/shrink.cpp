// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/shrink.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/planning/stages/keyframe_times.h"
#include "daemon/planning/stages/sentences.h"
#include "daemon/planning/stages/slowing.h"

namespace camway::planning {

namespace {

using base::Deadline;
using correction::CorrectionKind;

constexpr double kStep = 0.85;       // from one scale to the next
constexpr double kFirstShare = 0.5;  // of the deadline, for the camera as it is; then for the least

/// From the largest to the least. [Limit: max_shrink < 1]
std::vector<double> scales(double max_shrink) {
  const double least = 1.0 - max_shrink;
  std::vector<double> scales;
  for (double scale = kStep; scale > least; scale *= kStep) scales.push_back(scale);
  scales.push_back(least);
  return scales;
}

class Shrinking {
 public:
  Shrinking(const PlanRequest& request, const Deadline& deadline, const PlanAtSize& plan_at_size)
      : request_(request), deadline_(deadline), plan_at_size_(plan_at_size) {}

  UnsentResult run() {
    UnsentResult full = plan_at_size_(request_, deadline_.share_of_rest(kFirstShare));
    const Status status = full.result.status;
    const bool is_open = status == Status::kPartial || status == Status::kTimeout;
    if (!is_open || full.result.remaining_collisions.empty()) return full;
    const double begun_ms = deadline_.elapsed_ms();
    cut_off_ = status == Status::kTimeout;
    // Not before: it may be that the first plan found the request invalid, and this with it.
    scales_ = scales(request_.options.max_shrink);
    search();
    if (best_) {
      add_answer(std::move(full.result));
    } else {
      add_refusal(full.result);
    }
    UnsentResult& answer = best_ ? *best_ : full;
    const double took_ms = deadline_.elapsed_ms() - begun_ms;
    answer.result.timing.correct_ms += took_ms;
    answer.result.timing.total_ms += took_ms;
    return std::move(answer);
  }

 private:
  void search() {
    const std::size_t least = scales_.size() - 1;
    if (is_free(least, least == 0 ? 1.0 : kFirstShare)) {
      std::size_t first = 0;
      for (std::size_t free = least; first < free;) {
        const std::size_t middle = (first + free) / 2;
        if (is_free(middle, 1.0 / static_cast<double>(std::bit_width(free - first)))) {
          free = middle;
        } else {
          first = middle + 1;
        }
      }
      return;
    }
    // A keyframe without a way out at the smallest size has none at any size.
    if (!shut_in_.empty()) return;
    for (std::size_t i = 0; i < least; ++i) {
      if (is_free(i, 1.0 / static_cast<double>(least - i))) return;
    }
  }

  bool is_free(std::size_t index, double share) {
    if (deadline_.passed()) {
      cut_off_ = true;
      return false;
    }
    PlanRequest smaller = request_;
    moving_camera(smaller)->near_m *= scales_[index];
    // It may be proved that there is no path at this size, whatever there is at others.
    smaller.options.max_shrink = 0.0;
    UnsentResult found = plan_at_size_(smaller, deadline_.share_of_rest(share));
    tried_.push_back(scales_[index]);
    if (found.result.status == Status::kTimeout) cut_off_ = true;
    shut_in_ = std::move(found.result.shut_in);
    // Where a search ended at its limit, there may be a way that it did not find.
    std::erase_if(shut_in_, [](const correction::ShutIn& known) { return !known.is_complete; });
    if (found.result.status != Status::kOk) return false;
    found.result.near_scale = scales_[index];
    best_ = std::move(found);
    return true;
  }

  /// Adds the findings of `full`, which are about the camera that was asked for.
  void add_answer(PlanResult full) {
    PlanResult& result = best_->result;
    const double near_m = moving_camera(request_)->near_m;
    result.message = fmt::format("with a near distance of {:.3g} m instead of {:.3g} m: {}",
                                 near_m * result.near_scale, near_m, result.message);
    result.timing = full.timing;
    result.collisions = std::move(full.collisions);
    result.measures_before = full.measures_before;
    result.corrections = std::move(full.corrections);
    for (correction::Correction& correction : result.corrections) {
      if (correction.kind != CorrectionKind::kNone) continue;
      correction.kind = CorrectionKind::kShrink;
      correction.tried = {};
    }
  }

  void add_refusal(PlanResult& full) {
    std::ranges::sort(tried_, std::ranges::greater());
    std::vector<std::string> scales;
    for (const double scale : tried_) scales.push_back(fmt::format("{:.2g}", scale));
    scales.erase(std::ranges::unique(scales).begin(), scales.end());
    const std::string list = fmt::format("{}", fmt::join(scales, ", "));
    full.message += tried_.empty()
                        ? "; the deadline left no time to make the near distance smaller"
                        : "; nor was there a free path with the near distance times " + list;
    // Where a search of everything reachable found no way out at the smallest size, a longer one at
    // the full size finds none either.
    if (!shut_in_.empty()) {
      full.status = Status::kPartial;
      if (!full.shut_in.empty()) return;
      full.message += note_of_shut_in(shut_in_, full.bounds.any());
      full.keyframe = shut_in_.front().keyframe;
      full.shut_in = std::move(shut_in_);
      return;
    }
    if (cut_off_ && !tried_.empty()) full.message += ", as far as the deadline allowed to search";
    if (cut_off_) full.status = Status::kTimeout;
  }

  const PlanRequest& request_;
  const Deadline& deadline_;
  const PlanAtSize& plan_at_size_;
  std::vector<double> scales_;
  std::vector<double> tried_;
  std::optional<UnsentResult> best_;
  bool cut_off_ = false;
  /// Keyframes of which everything reachable was searched, for the camera that was tried last.
  std::vector<correction::ShutIn> shut_in_;
};

}  // namespace

PlanResult with_sent_times(UnsentResult unsent) {
  if (unsent.law) move_findings(*unsent.law, unsent.result);
  to_sent_times(unsent.origin, unsent.result);
  return std::move(unsent.result);
}

UnsentResult plan_with_shrinking(const PlanRequest& request, const Deadline& deadline,
                                 const PlanAtSize& plan_at_size) {
  return Shrinking(request, deadline, plan_at_size).run();
}

}  // namespace camway::planning
