// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/planning/plan.h"
#include "daemon/scene/import/import.h"
#include "tools/json/json_request.h"
#include "tools/json/json_response.h"

/// The keyframes of an answer are the answer: a request with them, and with the answer's frame,
/// gets the same path, without a correction.
namespace camway::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using planning::PlanResult;

// The contract, in metres and radians.
constexpr double kSamePath = 1e-9;
constexpr int kSamples = 1000;

std::vector<fs::path> own_requests() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(CAMWAY_SCENES_FOLDER) / "requests"))
    files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

json document(const fs::path& file) {
  std::ifstream in(file);
  return json::parse(in);
}

RequestFile parsed(const json& request) {
  base::Result<RequestFile> read = parse_as<RequestFile>(request.dump(), "R.json");
  EXPECT_TRUE(read) << read.error;
  return read ? *std::move(read) : RequestFile{};
}

/// The scene of a request of this folder.
const scene::Snapshot& scene_of(const std::string& name) {
  static std::map<std::string, std::shared_ptr<const scene::Snapshot>> scenes;
  std::shared_ptr<const scene::Snapshot>& scene = scenes[name];
  if (!scene) {
    scene::ImportResult read =
        scene::import_mesh((fs::path(CAMWAY_SCENES_FOLDER) / "requests" / name).string(), {});
    EXPECT_TRUE(read.mesh) << read.error;
    scene = scene::make_snapshot(name, std::move(*read.mesh)).snapshot;
  }
  return *scene;
}

/// Returns `request` with what an answer, as a file, says of its path.
json again(json request, const json& answer) {
  request["keyframes"] = answer["keyframes"];
  if (answer.contains("frame")) request["frame"] = answer["frame"];
  if (answer.contains("near_scale")) {
    request["camera"]["near"] =
        request["camera"]["near"].get<double>() * answer["near_scale"].get<double>();
  }
  if (request.contains("options")) request["options"].erase("default_speed_m_per_s");
  return request;
}

void expect_same(const motion::Path& a, const motion::Path& b) {
  ASSERT_EQ(a.begin_s(), b.begin_s());
  ASSERT_EQ(a.end_s(), b.end_s());
  for (int i = 0; i <= kSamples; ++i) {
    const double time_s = a.begin_s() + (a.end_s() - a.begin_s()) * i / kSamples;
    const motion::Pose one = a.pose(time_s);
    const motion::Pose other = b.pose(time_s);
    ASSERT_LE((one.position - other.position).norm(), kSamePath) << "at " << time_s;
    const geometry::Quat turn = one.orientation.conjugate() * other.orientation;
    ASSERT_LE(2.0 * turn.vec().norm(), kSamePath) << "at " << time_s;
  }
}

/// Plans a request, then the keyframes of its answer. Returns whether the answer was corrected.
bool check_replanned(const json& request) {
  const RequestFile asked = parsed(request);
  const scene::Snapshot& scene = scene_of(asked.scene);
  const PlanResult first = planning::plan(scene, asked);
  if (first.status != planning::Status::kOk) return false;
  const base::Result<std::string> text = write_plan_response(first);
  EXPECT_TRUE(text) << text.error;
  const PlanResult second = planning::plan(scene, parsed(again(request, json::parse(*text))));
  EXPECT_EQ(second.status, planning::Status::kOk) << second.message;
  EXPECT_TRUE(second.certificate.certified);
  EXPECT_TRUE(second.collisions.empty());
  EXPECT_TRUE(second.corrections.empty());
  EXPECT_TRUE(second.keyframe_faults.empty());
  EXPECT_EQ(second.keyframes.size(), first.keyframes.size());
  EXPECT_EQ(second.frame.has_value(), first.frame.has_value());
  if (!second.path.empty()) expect_same(first.path, second.path);
  return first.frame.has_value();
}

TEST(Replan, TheKeyframesOfAnAnswerGiveItsPath) {
  int corrected = 0;
  for (const fs::path& file : own_requests()) {
    SCOPED_TRACE(file.filename());
    if (check_replanned(document(file))) ++corrected;
  }
  EXPECT_GE(corrected, 10);
}

TEST(Replan, AnAnswerAboutAnAnswerGivesItsPath) {
  const fs::path file = fs::path(CAMWAY_SCENES_FOLDER) / "requests/office-graze-column.json";
  const json request = document(file);
  const RequestFile asked = parsed(request);
  const PlanResult first = planning::plan(scene_of(asked.scene), asked);
  ASSERT_TRUE(first.frame);
  const json next = again(request, json::parse(*write_plan_response(first)));
  check_replanned(next);
  // Moved into the column: corrected again, and that correction replans, too.
  json edited = next;
  for (json& keyframe : edited["keyframes"]) {
    if (keyframe["origin"] == "inserted")
      keyframe["position"][0] = keyframe["position"][0].get<double>() + 0.02;
  }
  check_replanned(edited);
}

// Seconds since 1970: times are 2e-7 s apart.
TEST(Replan, AlsoHoldsFarFromTimeZero) {
  json request = document(fs::path(CAMWAY_SCENES_FOLDER) / "requests/office-graze-door.json");
  const RequestFile asked = parsed(request);
  PlanResult first = planning::plan(scene_of(asked.scene), asked);
  std::size_t at = 0;
  for (const motion::Keyframe& keyframe : first.keyframes) {
    if (keyframe.origin == motion::KeyframeOrigin::kInserted) continue;
    request["keyframes"][at++]["time"] = 1.76e9 + keyframe.time_s;
  }
  EXPECT_TRUE(check_replanned(request));
}

TEST(Replan, ASlowedPathHasNoFrame) {
  json request = document(fs::path(CAMWAY_SCENES_FOLDER) / "requests/office-graze-column.json");
  request["options"]["limits"] = {{"speed_m_per_s", 0.5}, {"retime", true}};
  const RequestFile asked = parsed(request);
  const PlanResult slowed = planning::plan(scene_of(asked.scene), asked);
  EXPECT_GT(slowed.time_scale, 1.0);
  EXPECT_FALSE(slowed.frame);
  for (const motion::Keyframe& keyframe : slowed.keyframes)
    EXPECT_EQ(keyframe.image, geometry::Vec4::Zero());
}

// docs/requests.md tells this way to edit a slowed answer.
TEST(Replan, AnAnswerThatIsSlowedLaterGivesTheSlowedPath) {
  constexpr double kSameTime = 1e-12;  // relative: the law is computed anew
  for (const char* const name : {"office-graze-column", "office-graze-door"}) {
    SCOPED_TRACE(name);
    json request =
        document(fs::path(CAMWAY_SCENES_FOLDER) / "requests" / (std::string(name) + ".json"));
    request["options"]["limits"] = {{"speed_m_per_s", 0.9}, {"acceleration_m_per_s2", 0.8}};
    const RequestFile asked = parsed(request);
    const scene::Snapshot& scene = scene_of(asked.scene);
    const PlanResult fast = planning::plan(scene, asked);
    EXPECT_EQ(fast.status, planning::Status::kPartial) << fast.message;
    EXPECT_TRUE(fast.certificate.certified);
    request["options"]["limits"]["retime"] = true;
    const PlanResult slowed = planning::plan(scene, parsed(request));
    EXPECT_GT(slowed.time_scale, 1.0);
    const PlanResult later =
        planning::plan(scene, parsed(again(request, json::parse(*write_plan_response(fast)))));
    ASSERT_EQ(later.status, planning::Status::kOk) << later.message;
    EXPECT_NEAR(later.time_scale, slowed.time_scale, kSameTime * slowed.time_scale);
    for (int i = 0; i <= kSamples; ++i) {
      const double share = static_cast<double>(i) / kSamples;
      const motion::Pose one = slowed.path.pose(share * slowed.path.end_s());
      const motion::Pose other = later.path.pose(share * later.path.end_s());
      ASSERT_LE((one.position - other.position).norm(), kSamePath) << share;
      const geometry::Quat turn = one.orientation.conjugate() * other.orientation;
      ASSERT_LE(2.0 * turn.vec().norm(), kSamePath) << share;
    }
  }
}

// Where a correction begins within a segment, the rest of it is another Bezier curve.
TEST(Replan, OutsideOfCorrectionsThePathIsAsInterpolated) {
  constexpr double kRounding = 1e-12;
  int whole = 0;
  int cut = 0;
  for (const fs::path& file : own_requests()) {
    SCOPED_TRACE(file.filename());
    json request = document(file);
    const RequestFile asked = parsed(request);
    const scene::Snapshot& scene = scene_of(asked.scene);
    const PlanResult corrected = planning::plan(scene, asked);
    if (!corrected.frame) continue;
    request["options"]["max_inserted_keyframes"] = 0;
    const PlanResult before = planning::plan(scene, parsed(request));
    for (const motion::Segment& segment : corrected.path.segments()) {
      const double middle_s = 0.5 * (segment.t0_s + segment.t1_s);
      const bool is_changed = std::ranges::any_of(corrected.corrections, [&](const auto& each) {
        return each.t_begin_s < middle_s && middle_s < each.t_end_s;
      });
      if (is_changed) continue;
      const motion::Segment& other = before.path.segments()[before.path.segment_index(middle_s)];
      const bool is_whole = segment.t0_s == other.t0_s && segment.t1_s == other.t1_s;
      ++(is_whole ? whole : cut);
      EXPECT_EQ(segment.position == other.position, is_whole);
      const motion::Pose pose = corrected.path.pose(middle_s);
      const motion::Pose old = before.path.pose(middle_s);
      EXPECT_LE((pose.position - old.position).norm(), kRounding);
      EXPECT_LE(2.0 * (pose.orientation.conjugate() * old.orientation).vec().norm(), kRounding);
    }
  }
  EXPECT_GE(whole, 2);
  EXPECT_GE(cut, 2);
}

/// A limit of turns that the answer keeps anyway may change it, but does not make it much worse.
TEST(LimitedTurns, CostLittleWhereTheAnswerKeepsTheLimit) {
  constexpr double kDegree = 0.017453292519943295;
  int turning = 0;
  for (const fs::path& file : own_requests()) {
    SCOPED_TRACE(file.filename());
    json request = document(file);
    const RequestFile asked = parsed(request);
    if (asked.options.orientation != correction::OrientationPolicy()) continue;
    const scene::Snapshot& scene = scene_of(asked.scene);
    const PlanResult free = planning::plan(scene, asked);
    double turned_rad = 0.0;
    double shift_rad = 0.0;
    for (const correction::Correction& each : free.corrections) {
      turned_rad = std::max(turned_rad, each.turned_rad);
      shift_rad = std::max(shift_rad, each.shift.mean_rad);
    }
    if (free.status != planning::Status::kOk || turned_rad < 2.0 * kDegree) continue;
    ++turning;
    request["options"]["orientation"] = {{"policy", "free"},
                                         {"max_turn_deg", turned_rad / kDegree + 10.0}};
    const PlanResult limited = planning::plan(scene, parsed(request));
    EXPECT_EQ(limited.status, planning::Status::kOk) << limited.message;
    for (const correction::Correction& each : limited.corrections) {
      EXPECT_LE(each.shift.mean_rad, 1.5 * shift_rad) << turned_rad / kDegree << " degrees";
    }
  }
  EXPECT_GE(turning, 1);
}

}  // namespace
}  // namespace camway::tools
