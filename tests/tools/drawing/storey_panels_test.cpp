// SPDX-License-Identifier: MIT
#include "tools/drawing/storey_panels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "daemon/motion/spline/interpolate.h"
#include "daemon/planning/request/request.h"
#include "daemon/planning/request/validate.h"
#include "daemon/scene/import/import.h"
#include "tests/support/random.h"
#include "tests/tools/drawing/drawn_house.h"
#include "tools/json/json_request.h"

namespace camway::draw {
namespace {

using geometry::Vec3;
using motion::KeyframeOrigin;
using ::testing::DoubleNear;
using ::testing::HasSubstr;
using ::testing::Pointwise;

/// Returns a plan with keyframes on both storeys of the house, some of them inserted.
FloorPlan through_both_storeys(testing::Random& random) {
  FloorPlan plan;
  plan.mesh = small_house();
  plan.corners_C = motion::near_corners_C({1.2, 0.9, 0.2});
  const int count = random.integer(3, 9);
  for (int i = 0; i < count; ++i) {
    const bool is_inserted = i > 0 && i + 1 < count && random.chance(0.4);
    const double floor_m = 2 * i < count ? 0.0 : 3.0;
    plan.keyframes.push_back(
        {static_cast<double>(i),
         {{random.uniform(1, 5), floor_m + random.uniform(1, 2), random.uniform(1, 3)},
          geometry::Quat::Identity()},
         is_inserted ? KeyframeOrigin::kInserted : KeyframeOrigin::kGiven});
  }
  plan.after = sample(motion::interpolate(plan.keyframes), 400);
  plan.before = plan.after;
  return plan;
}

/// Messages name a keyframe by its index in the request, and so does the picture.
TEST(KeyframeNumbers, AreThoseOfMessages) {
  testing::Random random(kDrawSeed);
  for (int trial = 0; trial < 50; ++trial) {
    const FloorPlan plan = through_both_storeys(random);
    planning::PlanRequest request;
    request.camera = {1.2, 0.9, 0.2};
    std::vector<std::string> numbers;
    const std::vector<std::string> all = keyframe_numbers(plan.keyframes);
    ASSERT_EQ(all.size(), plan.keyframes.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(all[i].empty(), plan.keyframes[i].origin == KeyframeOrigin::kInserted);
      if (all[i].empty()) continue;
      request.keyframes.push_back(plan.keyframes[i]);
      numbers.push_back(all[i]);
    }
    const auto broken =
        static_cast<std::size_t>(random.integer(0, static_cast<int>(numbers.size()) - 1));
    request.keyframes[broken].pose.position.x() = std::numeric_limits<double>::quiet_NaN();
    const auto fault = planning::validate(request);
    ASSERT_TRUE(fault);
    EXPECT_EQ(std::to_string(fault->keyframe.value()), numbers[broken]);
    EXPECT_THAT(fault->message, HasSubstr("keyframes[" + numbers[broken] + "]"));
  }
}

/// Every keyframe and every part of the path is on one panel, and the path has no gap on any.
TEST(StoreyPanels, ShareEverythingOut) {
  testing::Random random(kDrawSeed);
  for (int trial = 0; trial < 50; ++trial) {
    FloorPlan plan = through_both_storeys(random);
    plan.collisions = {{0.1, 0.2}, {1.1, 1.3}};
    const std::vector<Panel> panels = storey_panels(plan);
    ASSERT_EQ(panels.size(), 2U);
    EXPECT_EQ(panels[0].section.floor_m, 0.0);
    EXPECT_EQ(panels[1].section.floor_m, 3.0);
    std::size_t keyframes = 0;
    std::size_t collisions = 0;
    double here_s = 0.0;
    for (const Panel& panel : panels) {
      keyframes += panel.keyframes.size();
      collisions += panel.collisions.size();
      double all_s = 0.0;
      for (const auto* pieces : {&panel.after.here, &panel.after.elsewhere}) {
        for (const SampledPath& piece : *pieces) {
          const double piece_s = piece.back().time_s - piece.front().time_s;
          all_s += piece_s;
          if (pieces == &panel.after.here) here_s += piece_s;
        }
      }
      EXPECT_NEAR(all_s, plan.after.back().time_s, 1e-9);
      EXPECT_GT(panel.section.height_m, panel.section.floor_m);
      EXPECT_LT(panel.section.height_m, panel.section.floor_m + 2.0);
    }
    EXPECT_EQ(keyframes, plan.keyframes.size());
    EXPECT_EQ(collisions, plan.collisions.size());
    EXPECT_NEAR(here_s, plan.after.back().time_s, 0.1) << "but for a step at each change";
  }
}

/// Heights are written where they differ, once for all where they do not.
TEST(StoreyPanels, KeyframesHaveTheirHeights) {
  testing::Random random(kDrawSeed);
  FloorPlan plan = through_both_storeys(random);
  for (const Panel& panel : storey_panels(plan)) {
    for (const PanelKeyframe& keyframe : panel.keyframes) {
      if (keyframe.is_inserted) continue;
      char height[40];
      std::snprintf(height, sizeof height, "%.2f m", keyframe.pose.position.y());
      EXPECT_EQ(keyframe.remark, height);
    }
  }
  for (motion::Keyframe& keyframe : plan.keyframes) keyframe.pose.position.y() = 1.6;
  EXPECT_TRUE(are_level(plan.keyframes, plan.up));
  const std::vector<Panel> panels = storey_panels(plan);
  ASSERT_FALSE(panels.empty());
  for (const PanelKeyframe& keyframe : panels[0].keyframes) {
    EXPECT_EQ(keyframe.remark, "");
  }
}

/// A plan of the own keyframes of a request of the repository.
FloorPlan plan_of_request(const std::string& name) {
  const std::filesystem::path file =
      std::filesystem::path(CAMWAY_SCENES_FOLDER) / "requests" / (name + ".json");
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  const base::Result<tools::RequestFile> request =
      tools::parse_as<tools::RequestFile>(text.str(), file.string());
  EXPECT_TRUE(request) << request.error;
  FloorPlan plan;
  plan.keyframes = request->keyframes;
  for (std::size_t i = 0; i < plan.keyframes.size(); ++i) {
    plan.keyframes[i].time_s = static_cast<double>(i);
  }
  plan.before = sample(motion::interpolate(plan.keyframes), 1500);
  const scene::ImportResult read =
      scene::import_mesh((std::filesystem::path(CAMWAY_SCENES_FOLDER) / "office.obj").string(), {});
  EXPECT_TRUE(read.mesh) << read.error;
  plan.mesh = *read.mesh;
  return plan;
}

/// The own request that climbs stairs is drawn on the storeys that it is on, cut at the heights of
/// its keyframes; requests that stay on one storey are drawn on that one.
TEST(StoreyPanels, OfTheOfficeRequestsAreTheirStoreys) {
  constexpr double kStorey_m = 3.6;
  const auto floors_of = [](const std::vector<Panel>& panels) {
    std::vector<double> floors_m;
    for (const Panel& panel : panels) floors_m.push_back(panel.section.floor_m);
    return floors_m;
  };
  const std::vector<Panel> stairs = storey_panels(plan_of_request("office-free-stairs"));
  ASSERT_THAT(floors_of(stairs), Pointwise(DoubleNear(1e-6), std::vector{0.0, kStorey_m}));
  EXPECT_EQ(stairs[0].before.here.size(), 1U) << "one change";
  EXPECT_EQ(stairs[0].keyframes.front().number, "0");
  EXPECT_EQ(stairs[1].keyframes.back().number, "10");
  EXPECT_GE(stairs[1].keyframes.size(), 3U);
  EXPECT_LT(stairs[0].section.height_m, 3.3) << "below the ceiling";
  EXPECT_NEAR(stairs[1].section.height_m, 5.2, 1e-9);
  const std::vector<std::pair<std::string, double>> level{
      {"office-free-corridor", 0.0},    {"office-free-timed", kStorey_m},
      {"office-wall-rooms", kStorey_m}, {"office-wall-tour", 2 * kStorey_m},
      {"office-free-atrium", 0.0},      {"office-graze-steps", 0.0}};
  for (const auto& [name, floor_m] : level) {
    EXPECT_THAT(floors_of(storey_panels(plan_of_request(name))),
                Pointwise(DoubleNear(1e-6), std::vector{floor_m}))
        << name;
  }
}

TEST(StoreyPanels, ThereIsOneWithoutAnything) { EXPECT_EQ(storey_panels({}).size(), 1U); }

}  // namespace
}  // namespace camway::draw
