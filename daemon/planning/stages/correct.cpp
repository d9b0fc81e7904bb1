// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/correct.h"

#include <algorithm>
#include <utility>

#include "daemon/correction/ladder/ladder.h"
#include "daemon/paper/keyframe_insertion.h"
#include "daemon/planning/stages/path_keyframes.h"
#include "daemon/planning/stages/search_changes.h"
#include "daemon/planning/stages/stage_times.h"

namespace camway::planning {

namespace {

using motion::Keyframe;

correction::LadderOptions ladder_options(const PlanRequest& request, const PreparedPlan& prepared) {
  correction::LadderOptions options;
  options.origin = prepared.origin;
  options.max_inserted_keyframes = request.options.max_inserted_keyframes;
  options.seed = request.options.seed;
  options.viewing_distance_m = request.options.viewing_distance_m.value_or(0.0);
  options.objective = request.options.objective;
  options.orientation = correction::without_unseen_turns(request.options.orientation);
  options.max_shrink = may_shrink(request) ? request.options.max_shrink : 0.0;
  options.rest_s_per_piece = kSearching_s_per_piece + rest_s_per_piece(request.options);
  return options;
}

std::optional<Infeasibility> infeasibility_of(correction::LadderResult& corrected) {
  if (corrected.separation) {
    return Infeasibility{corrected.separation->inside, corrected.separation->outside,
                         std::move(corrected.separation->triangles)};
  }
  if (corrected.cage) {
    return Infeasibility{corrected.cage->inside, corrected.cage->outside,
                         std::move(corrected.cage->triangles), corrected.cage->box};
  }
  return std::nullopt;
}

void add_keyframes(const std::vector<double>& inserted_s, PlanResult& result) {
  for (const double time_s : inserted_s) {
    result.keyframes.push_back(
        {time_s, result.path.pose(time_s), motion::KeyframeOrigin::kInserted});
  }
  std::ranges::stable_sort(result.keyframes, {}, &Keyframe::time_s);
}

// While corrections are made, they need more keyframes than once they are drawn again. So they are
// made without a limit first, and within it only where the answer would exceed it. The closest path
// may have fewer keyframes than what another objective makes of it.
correction::LadderResult within_keyframe_limit(
    const scene::Snapshot& snapshot, const collision::Query& query, const PlanRequest& request,
    const PreparedPlan& prepared, const base::Deadline& deadline, const PlanResult& result) {
  const correction::LadderOptions asked = ladder_options(request, prepared);
  const auto run = [&](const correction::LadderOptions& options) {
    return correction::correct_by_ladder(snapshot.mesh, query, result.keyframes,
                                         prepared.interpolated, result.collisions, options,
                                         deadline.share_of_rest(kShareOfCorrection));
  };
  const int limit = asked.max_inserted_keyframes;
  correction::LadderOptions without_limit = asked;
  without_limit.max_inserted_keyframes = PlanOptions().max_inserted_keyframes;
  if (limit == 0 || limit >= without_limit.max_inserted_keyframes) return run(asked);
  const auto inserted_by = [&](const correction::LadderResult& corrected) {
    return corrected.path.pieces.size() + 1 - result.keyframes.size();
  };
  correction::LadderResult unlimited = run(without_limit);
  if (std::cmp_less_equal(inserted_by(unlimited), limit)) return unlimited;
  if (without_limit.objective != correction::Objective::kClosest) {
    without_limit.objective = correction::Objective::kClosest;
    unlimited = run(without_limit);
    if (std::cmp_less_equal(inserted_by(unlimited), limit)) return unlimited;
  }
  correction::LadderResult limited = run(asked);
  // Until they are drawn again, corrections seem to need more than the answer does without a limit.
  if (limited.needed_keyframes) limited.needed_keyframes = inserted_by(unlimited);
  return limited;
}

CorrectedPlan correct_by_ladder(const scene::Snapshot& snapshot, const collision::Query& query,
                                const PlanRequest& request, const PreparedPlan& prepared,
                                const base::Deadline& deadline, PlanResult& result) {
  correction::LadderResult corrected =
      within_keyframe_limit(snapshot, query, request, prepared, deadline, result);
  CorrectedPlan plan;
  plan.timed_out = corrected.timed_out;
  plan.needed_keyframes = corrected.needed_keyframes;
  plan.is_polished = corrected.is_polished;
  plan.closeness = corrected.closeness;
  result.needs_more_keyframes = corrected.needed_keyframes.has_value();
  result.shut_in = std::move(corrected.shut_in);
  // A search that the deadline ended says nothing about the place that it began in.
  if (plan.timed_out) {
    std::erase_if(result.shut_in, [](const auto& shut_in) { return !shut_in.is_complete; });
  }
  result.corrections = std::move(corrected.corrections);
  result.infeasibility = infeasibility_of(corrected);
  // Corrections of less than the tolerance insert no keyframes, and are corrections.
  const bool any = std::ranges::any_of(result.corrections, [](const auto& correction) {
    return correction.kind != correction::CorrectionKind::kNone;
  });
  if (!any) return plan;
  plan.is_as_interpolated = false;
  plan.path = std::move(corrected.path);
  result.path = plan.path->path();
  if (!set_keyframes(*plan.path, request, prepared, result)) {
    drop_frame(result);
    add_keyframes(corrected.inserted_s, result);
  }
  return plan;
}

CorrectedPlan insert_keyframes(const collision::Query& query, const PlanRequest& request,
                               const PreparedPlan& prepared, const base::Deadline& deadline,
                               PlanResult& result) {
  paper::KeyframeInsertionOptions options;
  options.sweep = {request.options.chord_error_m, query.options};
  options.origin = prepared.origin;
  options.max_inserted_keyframes = request.options.max_inserted_keyframes;
  const double rest_s =
      rest_s_per_piece(request.options) * static_cast<double>(result.path.segments().size());
  paper::KeyframeInsertionResult corrected = paper::insert_keyframes(
      query.obstacles.index, result.keyframes, motion::near_corners_C(*moving_camera(request)),
      options, deadline.share_of_rest(kShareOfCorrection).sooner_by_s(rest_s));
  result.keyframes = std::move(corrected.keyframes);
  result.path = std::move(corrected.path);
  return {.path = {},
          .closeness = {},
          .is_as_interpolated = false,
          .timed_out = corrected.timed_out,
          .is_polished = false,
          .needed_keyframes = {}};
}

}  // namespace

CorrectedPlan correct(const scene::Snapshot& snapshot, const collision::Query& query,
                      const PlanRequest& request, const PreparedPlan& prepared,
                      const base::Deadline& deadline, PlanResult& result) {
  deadline.report(base::Progress::Stage::kCorrecting);
  if (request.options.method == Method::kLadder) {
    return correct_by_ladder(snapshot, query, request, prepared, deadline, result);
  }
  // The paper's method handles near quadrilaterals only, and no clearance.
  if (!prepared.body.is_camera()) return {};
  return insert_keyframes(query, request, prepared, deadline, result);
}

void put_back(double from_s, const PlanRequest& request, const PreparedPlan& prepared,
              CorrectedPlan& corrected, PlanResult& result) {
  corrected.is_as_interpolated = from_s <= prepared.interpolated.begin_s();
  if (corrected.is_as_interpolated) {
    corrected.path.reset();
    result.path = prepared.interpolated.path();
    reset_keyframes(prepared, result);
    return;
  }
  corrected.path = with_rest_of(*corrected.path, prepared.interpolated, from_s);
  result.path = corrected.path->path();
  if (set_keyframes(*corrected.path, request, prepared, result)) return;
  drop_frame(result);
  std::erase_if(result.keyframes, [&](const Keyframe& keyframe) {
    return keyframe.origin == motion::KeyframeOrigin::kInserted && keyframe.time_s >= from_s;
  });
}

}  // namespace camway::planning
