// SPDX-License-Identifier: MIT
#include "tools/camway/replay/compare/reviews.h"

#include <memory>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/request/validate.h"
#include "tools/camway/replay/compare/difference.h"
#include "tools/json/json_request.h"
#include "tools/json/json_response.h"
#include "tools/view/here/planner_here.h"
#include "tools/view/mesh_desk.h"
#include "tools/view/review/review_shelf.h"

namespace camway::tools {
namespace {

/// The last scene that was asked for, as reviews take it.
class SceneDesk {
 public:
  explicit SceneDesk(const SceneOf& scene_of) : scene_of_(scene_of) {}

  /// Returns whether the scene of a request is known; then the other functions are about it.
  bool open(const RecordedRequest& request) {
    std::shared_ptr<const scene::Snapshot> snapshot = scene_of_(request);
    if (!snapshot || snapshot == snapshot_) return snapshot != nullptr;
    meshes_.reset();
    backend_ = view::plan_here(snapshot);
    meshes_ = std::make_shared<view::MeshDesk>(*backend_);
    snapshot_ = std::move(snapshot);
    return true;
  }
  [[nodiscard]] const std::string& name() const { return snapshot_->name; }
  [[nodiscard]] view::Backend& backend() const { return *backend_; }
  [[nodiscard]] view::MeshDesk& meshes() const { return *meshes_; }

 private:
  const SceneOf& scene_of_;
  std::shared_ptr<const scene::Snapshot> snapshot_;
  std::unique_ptr<view::Backend> backend_;
  std::shared_ptr<view::MeshDesk> meshes_;  ///< destroyed first
};

base::Result<view::PlanOrder> order_of(const RecordedRequest& recorded, const std::string& scene) {
  if (!recorded.request) return base::Failure{recorded.error};
  if (const auto fault = planning::validate(*recorded.request))
    return base::Failure{fault->message};
  const base::Result<std::string> text = write_plan_request(*recorded.request);
  if (!text) return base::Failure{text.error};
  nlohmann::json document = nlohmann::json::parse(*text);
  document["scene"] = scene;
  RequestFile request;
  static_cast<planning::PlanRequest&>(request) = *recorded.request;
  return view::PlanOrder{scene, std::move(request),
                         std::make_shared<const std::string>(document.dump())};
}

bool has_result(const std::optional<RecordedAnswer>& answer) { return answer && answer->result; }

/// Returns an answer as JSON without spaces.
base::Result<std::string> json_of(const RecordedAnswer& answer, const std::string& scene,
                                  Times times) {
  ResponseFormat format;
  format.has_timing = times == Times::kShown;
  format.scene = scene;
  format.scene_digest = answer.scene_digest;
  const base::Result<std::string> text = write_plan_response(result_of(*answer.result), format);
  if (!text) return text;
  return nlohmann::json::parse(*text).dump();
}

base::Result<view::ReviewOrder> review_of(const ComparedRequest& compared, const std::string& scene,
                                          const ReportHead& head) {
  const std::optional<RecordedAnswer>& then = compared.recorded->answer;
  const std::optional<RecordedAnswer>& now = compared.now;
  if (!has_result(then) && !has_result(now)) return base::Failure{"there is no answer"};
  base::Result<view::PlanOrder> plan = order_of(*compared.recorded, scene);
  if (!plan) return base::Failure{plan.error};
  base::Result<std::string> answer = json_of(has_result(now) ? *now : *then, scene, head.times);
  if (!answer) return base::Failure{answer.error};
  view::ReviewOrder review{*std::move(plan), *std::move(answer)};
  if (!has_result(then) || !has_result(now) || compared.difference.has_same_bits()) return review;
  base::Result<std::string> other = json_of(*then, scene, head.times);
  if (!other) return base::Failure{other.error};
  review.compared = {head.now, head.then, *std::move(other)};
  return review;
}

/// Returns the requests to show, in the order in which they get room.
std::vector<std::size_t> wanted_of(const std::vector<ComparedRequest>& compared,
                                   Reviewed reviewed) {
  if (reviewed == Reviewed::kNone) return {};
  std::vector<std::size_t> wanted = worst_first(compared);
  if (reviewed == Reviewed::kDiffering) return wanted;
  const std::set<std::size_t> differing(wanted.begin(), wanted.end());
  for (std::size_t i = 0; i < compared.size(); ++i) {
    if (!differing.contains(i)) wanted.push_back(i);
  }
  return wanted;
}

/// Puts the review of a request onto the shelf.
view::ReviewShelf::Put put(std::size_t index, const ComparedRequest& compared,
                           const ReportHead& head, SceneDesk& scenes, view::ReviewShelf& shelf) {
  using view::code::kInvalid;
  if (!scenes.open(*compared.recorded))
    return {kInvalid, "its scene is not known (--scene, --root)"};
  const base::Result<view::ReviewOrder> review = review_of(compared, scenes.name(), head);
  if (!review) return {kInvalid, review.error};
  return shelf.put(index, *review, scenes.backend(), scenes.meshes());
}

}  // namespace

ShelvedReviews reviews_of(const std::vector<ComparedRequest>& compared, const SceneOf& scene_of,
                          const ReportHead& head, const ReviewsOptions& options) {
  ShelvedReviews reviews;
  view::ReviewShelf shelf(options.page, options.most_bytes);
  SceneDesk scenes(scene_of);
  for (const std::size_t index : wanted_of(compared, options.reviewed)) {
    ++reviews.wanted;
    if (!reviews.why_none.empty()) continue;
    view::ReviewShelf::Put done = put(index, compared[index], head, scenes, shelf);
    if (done.code == view::code::kOk) {
      reviews.shown.insert(index);
    } else if (done.code == view::code::kTooLarge) {
      ++reviews.too_large;
    } else if (done.code == view::code::kNotOffered) {
      reviews.why_none = std::move(done.error);
    } else if (++reviews.failed == 1) {
      reviews.first_failure = std::move(done.error);
    }
  }
  reviews.elements = shelf.elements();
  return reviews;
}

}  // namespace camway::tools
