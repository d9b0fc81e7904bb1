// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "daemon/collision/clearance.h"
#include "daemon/collision/near_quad.h"
#include "daemon/planning/plan.h"
#include "daemon/scene/import/import.h"
#include "tests/support/random.h"
#include "tools/json/json_request.h"

/// The profile of an answer against distances at samples of its path, in the office.
namespace camway::tools {
namespace {

namespace fs = std::filesystem;
using collision::ClearanceStretch;
using planning::PlanResult;

constexpr std::uint64_t kProfileSeed = 2107;
constexpr int kProfileRequests = 60;
constexpr int kSamplesOfAProfile = 1500;
constexpr double kFarTime_s = 1.76e9;  // seconds since 1970

std::shared_ptr<const scene::Snapshot> office() {
  scene::ImportResult read =
      scene::import_mesh((fs::path(CAMWAY_SCENES_FOLDER) / "office.obj").string(), {});
  EXPECT_TRUE(read.mesh) << read.error;
  return scene::make_snapshot("office", std::move(*read.mesh)).snapshot;
}

std::vector<RequestFile> office_requests() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(CAMWAY_SCENES_FOLDER) / "requests")) {
    if (entry.path().filename().string().starts_with("office")) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<RequestFile> requests;
  for (const fs::path& file : files) {
    std::ifstream in(file);
    std::stringstream text;
    text << in.rdbuf();
    auto read = parse_as<RequestFile>(text.str(), file.string());
    EXPECT_TRUE(read) << read.error;
    // Others bodies than cameras need another oracle.
    if (read && std::holds_alternative<motion::Camera>(planning::body_shape(*read, 1.0))) {
      requests.push_back(*std::move(read));
    }
  }
  return requests;
}

/// Moves keyframes a little, so that some collide more and others less, and draws options.
RequestFile varied(RequestFile request, testing::Random& random) {
  std::uniform_real_distribution<double> place(-0.05, 0.05);
  for (motion::Keyframe& keyframe : request.keyframes)
    keyframe.pose.position += geometry::Vec3(place(random), place(random), place(random));
  if (!request.has_times && random() % 2 == 0) {
    request.has_times = true;
    request.options.default_speed_m_per_s.reset();
    for (std::size_t i = 0; i < request.keyframes.size(); ++i)
      request.keyframes[i].time_s = kFarTime_s + 1.7 * static_cast<double>(i);
  }
  if (random() % 3 == 0) request.options.clearance_m = 0.02;
  if (random() % 3 == 0) request.options.max_inserted_keyframes = 0;
  if (random() % 3 == 0) {
    request.options.limits.speed_m_per_s = 0.8;
    request.options.limits.may_retime = true;
  }
  request.options.repair_keyframes = true;
  return request;
}

const ClearanceStretch& stretch_at(const std::vector<ClearanceStretch>& profile, double time_s) {
  const auto found = std::ranges::lower_bound(profile, time_s, {}, &ClearanceStretch::t_end_s);
  return found == profile.end() ? profile.back() : *found;
}

void expect_covers(const PlanResult& result) {
  const std::vector<ClearanceStretch>& profile = result.clearance_profile;
  ASSERT_FALSE(profile.empty());
  EXPECT_LE(profile.size(), collision::kMostProfileStretches);
  EXPECT_EQ(profile.front().t_begin_s, result.path.begin_s());
  EXPECT_EQ(profile.back().t_end_s, result.path.end_s());
  for (std::size_t i = 0; i < profile.size(); ++i) {
    EXPECT_LT(profile[i].t_begin_s, profile[i].t_end_s);
    if (i > 0) {
      EXPECT_EQ(profile[i].t_begin_s, profile[i - 1].t_end_s);
    }
  }
  const auto least = std::ranges::min_element(profile, {}, &ClearanceStretch::clearance_m);
  EXPECT_EQ(least->clearance_m, result.certificate.clearance_lower_bound_m);
  for (const collision::CollisionInterval& collision : result.remaining_collisions) {
    EXPECT_EQ(stretch_at(profile, 0.5 * (collision.t_begin_s + collision.t_end_s)).clearance_m,
              0.0);
  }
}

/// Compares with the distance at samples; returns the mean share of it that is proved.
double expect_holds(const scene::Snapshot& scene, const RequestFile& request,
                    const PlanResult& result, testing::Random& random) {
  motion::Camera camera = request.camera;
  camera.near_m *= result.near_scale;
  const motion::Corners corners_C = motion::near_corners_C(camera);
  std::vector<double> times_s;
  for (const ClearanceStretch& stretch : result.clearance_profile) {
    times_s.insert(times_s.end(), {stretch.t_begin_s, stretch.t_end_s});
  }
  std::uniform_real_distribution<double> place(result.path.begin_s(), result.path.end_s());
  while (times_s.size() < kSamplesOfAProfile) times_s.push_back(place(random));
  double shares = 0.0;
  int counted = 0;
  for (const double time_s : times_s) {
    const double true_m = collision::clearance_m(scene.index, corners_C, result.path.pose(time_s),
                                                 collision::kLargestClearance_m)
                              .value_or(collision::kLargestClearance_m);
    const double bound_m = stretch_at(result.clearance_profile, time_s).clearance_m;
    EXPECT_LE(bound_m, true_m) << "at " << time_s;
    if (true_m < 0.01) continue;
    shares += bound_m / true_m;
    ++counted;
  }
  return counted > 0 ? shares / counted : 1.0;
}

TEST(ClearanceProfile, IsNeverAboveTheDistanceAndCoversThePath) {
  const std::shared_ptr<const scene::Snapshot> scene = office();
  const std::vector<RequestFile> requests = office_requests();
  ASSERT_GT(requests.size(), 10u);
  testing::Random random(kProfileSeed);
  int free = 0;
  int colliding = 0;
  int slowed = 0;
  double shares = 0.0;
  for (int i = 0; i < kProfileRequests; ++i) {
    RequestFile request = varied(requests[random() % requests.size()], random);
    const PlanResult without = planning::plan(*scene, request, base::Deadline::never());
    EXPECT_TRUE(without.clearance_profile.empty());
    request.options.clearance_profile = true;
    const PlanResult result = planning::plan(*scene, request, base::Deadline::never());
    EXPECT_EQ(result.status, without.status);
    EXPECT_EQ(result.message, without.message);
    EXPECT_EQ(result.certificate.clearance_lower_bound_m,
              without.certificate.clearance_lower_bound_m);
    if (result.path.empty()) continue;
    expect_covers(result);
    shares += expect_holds(*scene, request, result, random);
    ++(result.certificate.certified ? free : colliding);
    slowed += result.slowed.empty() ? 0 : 1;
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(free, 10);
  EXPECT_GT(colliding, 5);
  EXPECT_GT(slowed, 2);
  // A curve of the clearance is of use only if it is near the clearance.
  EXPECT_GT(shares / (free + colliding), 0.6);
}

TEST(ClearanceProfile, IsTheSameEachTime) {
  const std::shared_ptr<const scene::Snapshot> scene = office();
  for (RequestFile request : office_requests()) {
    request.options.clearance_profile = true;
    const PlanResult one = planning::plan(*scene, request, base::Deadline::never());
    const PlanResult other = planning::plan(*scene, request, base::Deadline::never());
    EXPECT_EQ(one.clearance_profile, other.clearance_profile);
  }
}

TEST(ClearanceProfile, JoinsSmallBoundsLast) {
  std::vector<ClearanceStretch> profile;
  for (int i = 0; i < 200; ++i) profile.push_back({i * 1.0, i + 1.0, 5.0 + i % 3});
  for (int i = 200; i < 240; ++i) profile.push_back({i * 1.0, i + 1.0, 0.05 + 0.05 * (i % 2)});
  const std::vector<ClearanceStretch> all = profile;
  collision::join_neighbours(50, profile);
  ASSERT_LE(profile.size(), 50u);
  EXPECT_GE(std::ranges::count_if(profile, [](const auto& each) { return each.clearance_m < 1; }),
            40);
  for (const ClearanceStretch& each : all) {
    EXPECT_LE(stretch_at(profile, 0.5 * (each.t_begin_s + each.t_end_s)).clearance_m,
              each.clearance_m);
  }
  collision::join_neighbours(1, profile);
  ASSERT_EQ(profile.size(), 1u);
  EXPECT_EQ(profile.front().t_begin_s, 0.0);
  EXPECT_EQ(profile.front().t_end_s, 240.0);
}

TEST(ClearanceProfile, GivesRoundedTimesToTheSmallerBound) {
  // Times to whole seconds: the boundary at 1.5 goes to 2, and that at 2.5 to 2 as well.
  std::vector<ClearanceStretch> profile = {{0.0, 1.5, 1.0}, {1.5, 2.5, 9.0}, {2.5, 4.0, 0.5}};
  collision::move_times({[](double time_s) { return std::round(time_s); },
                         [](double time_s) { return std::floor(time_s); },
                         [](double time_s) { return std::ceil(time_s); }},
                        profile);
  const std::vector<ClearanceStretch> expected = {{0.0, 2.0, 0.5}, {2.0, 4.0, 0.5}};
  EXPECT_EQ(profile, expected);
}

}  // namespace
}  // namespace camway::tools
