// SPDX-License-Identifier: MIT
#include "tools/answers/check_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "daemon/collision/obstacles.h"
#include "daemon/planning/result/path_faults.h"
#include "daemon/planning/result/witness_names.h"
#include "daemon/planning/stages/sentences.h"
#include "daemon/scene/import/import_warnings.h"
#include "tools/answers/scene_record.h"

namespace camway::tools {
namespace {

using collision::CollisionInterval;

/// Largest number of missed keyframes to list; further ones are counted.
constexpr std::size_t kListedMisses = 10;

/// Size in tolerances below which a body may count as colliding where a person sees it free, and
/// its collision intervals end visibly late.
constexpr double kToleranceFits = 10.0;

/// Largest distance at which the path meets a keyframe: the interval tolerance of the request.
double met_within_m(const planning::PlanRequest& request) {
  return request.options.interval_tolerance_m;
}

planning::WitnessNames names_of(const CheckInput& input, const collision::Witness& witness) {
  return planning::describe_witness(input.snapshot->mesh, *input.body, witness);
}

/// Returns the object that an interval collides with, in words.
std::string culprit(const CheckInput& input, const CollisionInterval& interval) {
  if (!interval.witness) return "what could not be told apart";
  const collision::Witness& witness = *interval.witness;
  const planning::WitnessNames names = names_of(input, witness);
  if (collision::Obstacles::is_side(witness.triangle)) {
    return fmt::format("{} {}, {:.3g} m beyond it at {:.6f} s", names.object,
                       at_feature(names.feature), witness.depth_m, witness.time_s);
  }
  return fmt::format("{} (triangle {}) {}, {:.3g} m deep at {:.6f} s",
                     names.object.empty() ? "an unnamed object" : names.object, witness.triangle,
                     at_feature(names.feature), witness.depth_m, witness.time_s);
}

nlohmann::ordered_json interval_json(const CheckInput& input, const CollisionInterval& interval) {
  nlohmann::ordered_json json{{"t_begin", interval.t_begin_s}, {"t_end", interval.t_end_s}};
  if (!interval.witness) return json;
  const collision::Witness& witness = *interval.witness;
  const planning::WitnessNames names = names_of(input, witness);
  json["witness"] = {{"time", witness.time_s},
                     {"object", names.object},
                     {"triangle", collision::Obstacles::signed_number(witness.triangle)},
                     {"feature", names.feature},
                     {"depth_m", witness.depth_m},
                     {"point", {witness.point_W.x(), witness.point_W.y(), witness.point_W.z()}}};
  return json;
}

/// A keyframe that the path does not meet.
struct Miss {
  std::size_t keyframe;
  std::optional<double> by_m;  ///< nothing: the path does not exist at its time
};

/// The keyframes that the path meets and misses.
struct KeyframeReport {
  std::vector<Miss> missed;
  std::size_t outside = 0;  ///< missed ones whose time is outside of the path
  double largest_miss_m = 0.0;
};

/// Returns whether times agree as closely as poses at a join must: files of other programs have few
/// digits.
bool is_outside(const motion::Path& path, double time_s) {
  const double agreement_s = planning::kJoinAgreement * (path.end_s() - path.begin_s());
  return !(time_s >= path.begin_s() - agreement_s && time_s <= path.end_s() + agreement_s);
}

KeyframeReport look_for_keyframes(const CheckInput& input) {
  KeyframeReport report;
  const std::vector<double> misses_m =
      planning::keyframe_misses_m(input.path, input.keyframes, input.body->radius_m());
  for (std::size_t i = 0; i < misses_m.size(); ++i) {
    if (is_outside(input.path, input.keyframes[i].time_s)) {
      report.missed.push_back({i, std::nullopt});
      ++report.outside;
      continue;
    }
    report.largest_miss_m = std::max(report.largest_miss_m, misses_m[i]);
    if (misses_m[i] > met_within_m(input.request)) report.missed.push_back({i, misses_m[i]});
  }
  return report;
}

std::string miss_text(const CheckInput& input, const Miss& miss) {
  const std::string head = fmt::format("keyframe {} (at {:.6f} s) ", miss.keyframe,
                                       input.keyframes[miss.keyframe].time_s);
  if (miss.by_m) return head + fmt::format("is missed by {:.3g} m\n", *miss.by_m);
  return head + fmt::format("is missed: the path is from {:.6f} to {:.6f} s\n",
                            input.path.begin_s(), input.path.end_s());
}

std::string keyframes_text(const CheckInput& input) {
  const std::size_t count = input.keyframes.size();
  if (count == 0) return "keyframes met: not known, neither request nor response says when\n";
  const KeyframeReport report = look_for_keyframes(input);
  std::string text = fmt::format("keyframes met: {} of {}, largest miss {:.3g} m",
                                 count - report.missed.size(), count, report.largest_miss_m);
  if (report.outside > 0) text += fmt::format(", {} outside the path's time", report.outside);
  text += '\n';
  const std::size_t listed = std::min(report.missed.size(), kListedMisses);
  for (const Miss& miss : std::span(report.missed).first(listed)) text += miss_text(input, miss);
  if (listed < report.missed.size()) {
    text += fmt::format("and {} more\n", report.missed.size() - listed);
  }
  return text;
}

nlohmann::ordered_json keyframes_json(const CheckInput& input) {
  const std::size_t count = input.keyframes.size();
  if (count == 0) return nullptr;
  const KeyframeReport report = look_for_keyframes(input);
  nlohmann::ordered_json missed = nlohmann::ordered_json::array();
  for (const Miss& miss : report.missed) {
    nlohmann::ordered_json item{{"keyframe", miss.keyframe}, {"miss_m", nullptr}};
    if (miss.by_m) item["miss_m"] = *miss.by_m;
    missed.push_back(std::move(item));
  }
  return {{"count", count},
          {"met", count - report.missed.size()},
          {"outside", report.outside},
          {"largest_miss_m", report.largest_miss_m},
          {"missed", std::move(missed)}};
}

std::string_view verdict(const PathSearch& search) {
  if (!search.complete) return "timeout";
  return search.certificate.certified ? "free" : "collides";
}

}  // namespace

std::string at_feature(const std::string& feature) {
  if (feature == "inside") return "inside the near quadrilateral";
  return (feature == "surface" ? "at the " : "at ") + feature;
}

std::vector<std::string> check_warnings(const CheckInput& input, const PathSearch& search) {
  std::vector<std::string> warnings;
  const scene::Snapshot& snapshot = *input.snapshot;
  if (const std::string other =
          another_scene(input.response_file, input.made_for_digest, snapshot.name, snapshot.digest);
      !other.empty()) {
    warnings.push_back(other + "; what is said here holds in " + snapshot.name);
  }
  const double body_m = planning::body_size_m(*input.body);
  const double tolerance_m = input.request.options.interval_tolerance_m;
  if (input.near_scale < 1.0) {
    warnings.push_back(fmt::format(
        "{}: was made for a near distance of {:.4g} m, {:.3g} of the request's; what is said here "
        "holds for that",
        input.response_file, input.near_scale * input.request.camera.near_m, input.near_scale));
  }
  for (std::string& warning : scene::import_warnings(
           input.snapshot->report,
           scene::finest_length_m(tolerance_m, input.request.options.clearance_m))) {
    warnings.push_back(std::move(warning));
  }
  if (!search.collisions.empty() && body_m < kToleranceFits * tolerance_m) {
    warnings.push_back(fmt::format(
        "the body is only {:.3g} m large and collisions are told to {:.3g} m: what it passes "
        "nearer than a tenth of that counts as a collision; for a finer answer lower "
        "options.interval_tolerance_m to about {:.0e}",
        body_m, tolerance_m, std::max(body_m / 100.0, planning::kLeastIntervalTolerance_m)));
  }
  return warnings;
}

nlohmann::ordered_json check_json(const CheckInput& input, const PathSearch& search) {
  nlohmann::ordered_json json;
  json["verdict"] = verdict(search);
  json["certified"] = search.certificate.certified;
  json["clearance_lower_bound"] = search.certificate.clearance_lower_bound_m;
  json["searched_until"] = search.searched_until_s;
  json["collisions"] = nlohmann::ordered_json::array();
  for (const CollisionInterval& interval : search.collisions) {
    json["collisions"].push_back(interval_json(input, interval));
  }
  json["keyframes"] = keyframes_json(input);
  json["scene_digest"] = input.snapshot->digest;
  json["same_scene"] = nullptr;
  if (!input.made_for_digest.empty()) {
    json["same_scene"] = input.made_for_digest == input.snapshot->digest;
  }
  json["warnings"] = check_warnings(input, search);
  return json;
}

std::string check_text(const CheckInput& input, const PathSearch& search) {
  std::string text;
  if (search.certificate.certified) {
    text += fmt::format("free: proved, with a clearance of {:.6g} m or more\n",
                        search.certificate.clearance_lower_bound_m);
  }
  for (const CollisionInterval& interval : search.collisions) {
    text += fmt::format("collides from {:.6f} to {:.6f} s with {}\n", interval.t_begin_s,
                        interval.t_end_s, culprit(input, interval));
  }
  if (!search.complete) {
    text += fmt::format("time ran out: nothing is known from {:.6f} to {:.6f} s\n",
                        search.searched_until_s, input.path.end_s());
  }
  return text + keyframes_text(input);
}

}  // namespace camway::tools
