// SPDX-License-Identifier: MIT
#include "client/c/request.h"

#include <camway/camway.h>
#include <camway/client.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "client/c/sized.h"
#include "lcmtypes/wire/check.h"
#include "tests/client/c/c_client.h"
#include "tests/client/client_fixture.h"
#include "tests/client/fake_daemon.h"

namespace camway {
namespace {

using testing_support::answer_pages;
using testing_support::CClient;
using testing_support::CRequest;
using testing_support::encode_all;
using testing_support::FakeDaemon;
using testing_support::quick;
using testing_support::small_request;

using CRequestTest = testing_support::ClientTest;

/// A member of a request: how it is set in C and in C++.
struct Setting {
  std::string name;
  std::function<void(CRequest&)> in_c;
  std::function<void(PlanRequest&)> in_cxx;
};

const camway_path_frame kFrame = {
    {1, 2, 3, 4}, {{5, 6, 7}, {8, 9, 10, 11}}, {{12, 13, 14}, {15, 16, 17, 18}}};
const double kImages[] = {1, 2, 3, 4, 5, 6, 7, 8};

#define CAMWAY_SAME(member, value)                                                                 \
  {                                                                                                \
#member, [](CRequest & c) { c.member = value; }, [](PlanRequest & cxx) { cxx.member = value; } \
  }

std::vector<Setting> settings() {
  return {
      CAMWAY_SAME(scene, "hall"),
      CAMWAY_SAME(method, "ladder"),
      CAMWAY_SAME(clearance_m, 0.25),
      CAMWAY_SAME(deadline_s, 3.5),
      CAMWAY_SAME(default_speed_m_per_s, 1.25),
      CAMWAY_SAME(viewing_distance_m, 4.5),
      CAMWAY_SAME(interval_tolerance_m, 0.001),
      CAMWAY_SAME(max_shrink, 0.5),
      CAMWAY_SAME(progress_period_s, 0.75),
      CAMWAY_SAME(least_revision, 17),
      CAMWAY_SAME(seed, 99),
      CAMWAY_SAME(repair_keyframes, 1),
      CAMWAY_SAME(clearance_profile, 1),
      CAMWAY_SAME(max_inserted_keyframes, 0),
      {"fov_x_rad", [](CRequest& c) { c.fov_x_rad = 1.1; },
       [](PlanRequest& cxx) { cxx.camera.fov_x_rad = 1.1; }},
      {"fov_y_rad", [](CRequest& c) { c.fov_y_rad = 0.9; },
       [](PlanRequest& cxx) { cxx.camera.fov_y_rad = 0.9; }},
      {"near_m", [](CRequest& c) { c.near_m = 0.3; },
       [](PlanRequest& cxx) { cxx.camera.near_m = 0.3; }},
      {"max_speed_m_per_s", [](CRequest& c) { c.max_speed_m_per_s = 1.5; },
       [](PlanRequest& cxx) { cxx.limits.speed_m_per_s = 1.5; }},
      {"max_acceleration_m_per_s2", [](CRequest& c) { c.max_acceleration_m_per_s2 = 2.5; },
       [](PlanRequest& cxx) { cxx.limits.acceleration_m_per_s2 = 2.5; }},
      {"max_turn_rate_rad_per_s", [](CRequest& c) { c.max_turn_rate_rad_per_s = 3.5; },
       [](PlanRequest& cxx) { cxx.limits.turn_rate_rad_per_s = 3.5; }},
      {"may_retime", [](CRequest& c) { c.may_retime = 1; },
       [](PlanRequest& cxx) { cxx.limits.may_retime = true; }},
      {"bounds_min_m", [](CRequest& c) { c.bounds_min_m[1] = -2.0; },
       [](PlanRequest& cxx) { cxx.bounds.min_m[1] = -2.0; }},
      {"bounds_max_m", [](CRequest& c) { c.bounds_max_m[2] = 3.0; },
       [](PlanRequest& cxx) { cxx.bounds.max_m[2] = 3.0; }},
      {"frame", [](CRequest& c) { c.frame = &kFrame; },
       [](PlanRequest& cxx) {
         cxx.frame = {{1, 2, 3, 4}, {{5, 6, 7}, {8, 9, 10, 11}}, {{12, 13, 14}, {15, 16, 17, 18}}};
       }},
      {"images", [](CRequest& c) { c.images = kImages; },
       [](PlanRequest& cxx) {
         cxx.keyframes[0].image = {1, 2, 3, 4};
         cxx.keyframes[1].image = {5, 6, 7, 8};
       }},
      {"level",
       [](CRequest& c) {
         c.orientation = CAMWAY_ORIENTATION_LEVEL;
         c.up[2] = 2.0;
       },
       [](PlanRequest& cxx) {
         cxx.orientation = Orientation::level({0, 0, 2.0});
       }},
      {"target",
       [](CRequest& c) {
         c.orientation = CAMWAY_ORIENTATION_TARGET;
         c.target_m[0] = 5.0;
         c.cone_rad = 0.2;
       },
       [](PlanRequest& cxx) {
         cxx.orientation = Orientation::target({5.0, 0, 0}, 0.2);
       }},
      {"max_turn_rad", [](CRequest& c) { c.max_turn_rad = 0.0; },
       [](PlanRequest& cxx) { cxx.orientation.max_turn_rad = 0.0; }},
      {"objective", [](CRequest& c) { c.objective = CAMWAY_SAFEST; },
       [](PlanRequest& cxx) { cxx.objective = Objective::kSafest; }},
      {"priority", [](CRequest& c) { c.priority = -1; },
       [](PlanRequest& cxx) { cxx.priority = Priority::kLow; }},
      {"times",
       [](CRequest& c) {
         c.untimed = 0;
         c.given[1].time_s = 4.5;
       },
       [](PlanRequest& cxx) {
         cxx.keyframes[0].time_s = 0.0;
         cxx.keyframes[1].time_s = 4.5;
       }},
      {"poses",
       [](CRequest& c) {
         c.given[1] = {0.0, {1.0, 2.0, 3.0}, {0.5, 0.5, 0.5, -0.5}};
       },
       [](PlanRequest& cxx) {
         cxx.keyframes[1].position_m = {1.0, 2.0, 3.0};
         cxx.keyframes[1].orientation_wxyz = {0.5, 0.5, 0.5, -0.5};
       }},
  };
}

#undef CAMWAY_SAME

const double kVertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
const std::vector<Body::Point> kPoints = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
const std::int32_t kTriangles[] = {0, 1, 2, 1, 3, 2};
const std::uint32_t kPieces[] = {4, 1};

/// Bodies, in C and in C++.
std::vector<std::pair<camway_body, Body>> bodies() {
  camway_body body;
  camway_body_init(&body, sizeof body);
  body.center_m[1] = 0.5;
  body.size_m[0] = body.size_m[1] = body.size_m[2] = 2.0;
  body.radius_m = 0.75;
  body.vertices_m = kVertices;
  body.num_vertices = 5;
  body.triangles = kTriangles;
  body.num_triangles = 2;
  body.piece_sizes = kPieces;
  body.num_pieces = 2;
  std::vector<std::pair<camway_body, Body>> found;
  for (Body cxx : {Body{}, Body::box({2, 2, 2}, {0, 0.5, 0}), Body::sphere(0.75, {0, 0.5, 0}),
                   Body::convex({{kPoints.begin(), kPoints.begin() + 4}, {kPoints[4]}}),
                   Body::mesh(kPoints, {{0, 1, 2}, {1, 3, 2}}),
                   Body::solid_mesh(kPoints, {{0, 1, 2}, {1, 3, 2}})}) {
    body.shape = static_cast<int>(cxx.shape);
    found.emplace_back(body, std::move(cxx));
  }
  return found;
}

/// Sends requests of both clients, and compares the messages that the daemon gets but for ids and
/// times of sending.
class SentTwice {
 public:
  SentTwice() : cxx_(quick()) {
    daemon_.on_plan = [](const plan_request_t& asked) {
      return encode_all(answer_pages(asked, 1, 1));
    };
    daemon_.start();
  }

  void expect_same(const std::string& name, const CRequest& in_c, const PlanRequest& in_cxx) {
    camway_answer* answer = nullptr;
    EXPECT_EQ(camway_plan(c_.get(), &in_c, 10.0, &answer), CAMWAY_OK)
        << name << camway_last_error();
    camway_answer_free(answer);
    EXPECT_TRUE(cxx_.plan(in_cxx).ok()) << name;
    names_.push_back(name);
  }

  void compare() {
    daemon_.stop();
    std::vector<plan_request_t> sent = daemon_.plan_requests();
    ASSERT_EQ(sent.size(), 2 * names_.size());
    for (plan_request_t& request : sent) {
      request.client_id.clear();
      request.request_id = request.utime = 0;
    }
    for (std::size_t i = 0; i < names_.size(); ++i) {
      EXPECT_EQ(wire::encode(sent[2 * i]), wire::encode(sent[2 * i + 1])) << names_[i];
      if (i > 0) {
        EXPECT_NE(wire::encode(sent[2 * i]), wire::encode(sent[0])) << names_[i] << " is lost";
      }
    }
  }

 private:
  CClient c_;
  Client cxx_;
  FakeDaemon daemon_;
  std::vector<std::string> names_;
};

/// The request in C++ that a request in C is by default; it asks for progress reports, so that they
/// can be polled.
PlanRequest same_request() {
  PlanRequest request = small_request();
  request.progress_period_s = 0.5;
  return request;
}

TEST_F(CRequestTest, EveryMemberIsSentAsTheClientOfCxxSendsIt) {
  SentTwice sent;
  sent.expect_same("defaults", CRequest(), same_request());
  for (const Setting& setting : settings()) {
    CRequest in_c;
    PlanRequest in_cxx = same_request();
    setting.in_c(in_c);
    setting.in_cxx(in_cxx);
    sent.expect_same(setting.name, in_c, in_cxx);
  }
  sent.compare();
}

TEST_F(CRequestTest, EveryBodyIsSentAsTheClientOfCxxSendsIt) {
  SentTwice sent;
  for (const auto& [in_c, in_cxx] : bodies()) {
    CRequest request;
    request.body = &in_c;
    PlanRequest same = same_request();
    same.body = in_cxx;
    sent.expect_same("body " + std::to_string(in_c.shape), request, same);
  }
  sent.compare();
}

TEST(CRequestDefaults, SayNothingThatTheClientOfCxxDoesNotSay) {
  const CRequest request;
  const PlanRequest converted = c::request_of(&request);
  EXPECT_FALSE(converted.max_inserted_keyframes.has_value());
  EXPECT_FALSE(converted.orientation.max_turn_rad.has_value());
  EXPECT_FALSE(converted.bounds.min_m[0].has_value());
  EXPECT_EQ(request.bounds_max_m[0], std::numeric_limits<double>::infinity());
  EXPECT_TRUE(converted.method.empty());
  EXPECT_FALSE(converted.frame.has_value());
}

TEST(CRequestDefaults, ARequestOfAnOlderProgramEndsBeforeTheFrame) {
  CRequest request;
  // Bytes of the program behind its shorter struct.
  request.frame = &kFrame;
  request.images = kImages;
  request.struct_size = c::kFirstSize<camway_plan_request>;
  const PlanRequest converted = c::request_of(&request);
  EXPECT_FALSE(converted.frame.has_value());
  EXPECT_EQ(converted.keyframes[0].image[0], 0.0);
  request.struct_size = sizeof(camway_plan_request);
  EXPECT_TRUE(c::request_of(&request).frame.has_value());
}

}  // namespace
}  // namespace camway
