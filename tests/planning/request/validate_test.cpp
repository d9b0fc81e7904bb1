// SPDX-License-Identifier: MIT
#include "daemon/planning/request/validate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "daemon/planning/request/option_table.h"
#include "daemon/planning/request/options.h"
#include "daemon/planning/request/request.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::planning {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

PlanRequest good_request() {
  PlanRequest request;
  request.camera = testing::small_camera();
  request.keyframes.resize(3);
  for (std::size_t i = 0; i < 3; ++i) {
    request.keyframes[i].time_s = static_cast<double>(i);
    request.keyframes[i].pose.position.x() = static_cast<double>(i);
  }
  request.has_times = true;
  return request;
}

PlanRequest framed_request() {
  PlanRequest request = good_request();
  request.frame.emplace();
  request.keyframes[1].image = {0.0, 0.0, 2.0, 0.0};
  return request;
}

struct Fault {
  const char* field;
  std::optional<std::size_t> keyframe;
  std::function<void(PlanRequest&)> make;
};

TEST(Validate, AGoodRequestPasses) { EXPECT_FALSE(validate(good_request())); }

TEST(Validate, NamesTheFieldAndTheKeyframeAtFault) {
  const Fault faults[] = {
      {"camera.fov_x", {}, [](PlanRequest& r) { r.camera.fov_x_rad = 0.0; }},
      {"camera.fov_x", {}, [](PlanRequest& r) { r.camera.fov_x_rad = kNaN; }},
      {"camera.fov_y", {}, [](PlanRequest& r) { r.camera.fov_y_rad = 3.5; }},
      {"camera.near", {}, [](PlanRequest& r) { r.camera.near_m = -0.1; }},
      {"camera.near", {}, [](PlanRequest& r) { r.camera.near_m = kInfinity; }},
      {"camera", {}, [](PlanRequest& r) { r.camera.near_m = 1e9, r.camera.fov_x_rad = 3.0; }},
      {"keyframes", {}, [](PlanRequest& r) { r.keyframes.clear(); }},
      {"keyframes", {}, [](PlanRequest& r) { r.keyframes.resize(1); }},
      {"keyframes", {}, [](PlanRequest& r) { r.keyframes.resize(kMaxKeyframes + 1); }},
      {"keyframes[1].position", 1, [](PlanRequest& r) { r.keyframes[1].pose.position.y() = kNaN; }},
      {"keyframes[2].position", 2, [](PlanRequest& r) { r.keyframes[2].pose.position.z() = -2e9; }},
      {"keyframes[0].orientation", 0,
       [](PlanRequest& r) { r.keyframes[0].pose.orientation.coeffs().setZero(); }},
      {"keyframes[0].orientation", 0,
       [](PlanRequest& r) { r.keyframes[0].pose.orientation.x() = kInfinity; }},
      {"keyframes[1].orientation", 1,
       [](PlanRequest& r) { r.keyframes[1].pose.orientation.coeffs().setConstant(1e300); }},
      {"keyframes[1].time", 1, [](PlanRequest& r) { r.keyframes[1].time_s = 0.0; }},
      {"keyframes[2].time", 2, [](PlanRequest& r) { r.keyframes[2].time_s = 0.5; }},
      {"keyframes[2].time", 2, [](PlanRequest& r) { r.keyframes[2].time_s = kNaN; }},
      {"keyframes[1].time", 1, [](PlanRequest& r) { r.keyframes[1].time_s = 1e-12; }},
      {"keyframes[1].time", 1,
       [](PlanRequest& r) {
         for (motion::Keyframe& keyframe : r.keyframes) keyframe.time_s *= 1e-300;
       }},
      {"options.deadline_s", {}, [](PlanRequest& r) { r.options.deadline_s = 0.0; }},
      {"options.chord_error_m", {}, [](PlanRequest& r) { r.options.chord_error_m = kNaN; }},
      {"options.interval_tolerance_m",
       {},
       [](PlanRequest& r) { r.options.interval_tolerance_m = -1.0; }},
      {"options.chord_error_m", {}, [](PlanRequest& r) { r.options.chord_error_m = 1e-9; }},
      {"options.clearance_m", {}, [](PlanRequest& r) { r.options.clearance_m = -0.01; }},
      {"options.clearance_m", {}, [](PlanRequest& r) { r.options.clearance_m = kNaN; }},
      {"options.clearance_m", {}, [](PlanRequest& r) { r.options.clearance_m = 2e9; }},
      {"body.size[1]",
       {},
       [](PlanRequest& r) {
         r.body = motion::BoxShape{geometry::Vec3::Zero(), {1.0, 0.0, 1.0}};
       }},
      {"body.center",
       {},
       [](PlanRequest& r) {
         r.body = motion::SphereShape{{0, kNaN, 0}, 1.0};
       }},
      {"body.radius_m",
       {},
       [](PlanRequest& r) {
         r.body = motion::SphereShape{geometry::Vec3::Zero(), kInfinity};
       }},
      {"body.points[0]",
       {},
       [](PlanRequest& r) {
         r.body = motion::ConvexShape{{{{0, 2e9, 0}}}};
       }},
      {"body.points",
       {},
       [](PlanRequest& r) {
         r.body = motion::ConvexShape{{{{0, 1, 0}, {0, 1, 0}}}};
       }},
      {"body.triangles[0][1]",
       {},
       [](PlanRequest& r) {
         r.body = motion::MeshShape{{{0, 0, 0}}, {{0, 1, 0}}};
       }},
      {"body", {}, [](PlanRequest& r) { r.body = motion::Camera{}; }},
      {"camera.near",
       {},
       [](PlanRequest& r) {
         r.body = motion::SphereShape{geometry::Vec3::Zero(), 1.0};
         r.camera.near_m = -1.0;
       }},
      {"options.max_inserted_keyframes",
       {},
       [](PlanRequest& r) { r.options.max_inserted_keyframes = -1; }},
      {"options.orientation.up", {}, [](PlanRequest& r) { r.options.orientation.up_W.setZero(); }},
      {"options.orientation.up", {}, [](PlanRequest& r) { r.options.orientation.up_W.x() = kNaN; }},
      {"options.orientation.up", {}, [](PlanRequest& r) { r.options.orientation.up_W *= 2.0; }},
      {"options.orientation.target",
       {},
       [](PlanRequest& r) { r.options.orientation.target_W.z() = kNaN; }},
      {"options.orientation.target",
       {},
       [](PlanRequest& r) { r.options.orientation.target_W.z() = -2e9; }},
      {"options.orientation.cone",
       {},
       [](PlanRequest& r) { r.options.orientation.cone_rad = 0.0; }},
      {"options.orientation.cone",
       {},
       [](PlanRequest& r) { r.options.orientation.cone_rad = 3.2; }},
      {"options.orientation.cone",
       {},
       [](PlanRequest& r) { r.options.orientation.cone_rad = kNaN; }},
      {"options.orientation.max_turn",
       {},
       [](PlanRequest& r) { r.options.orientation.max_turn_rad = -0.1; }},
      {"options.orientation.max_turn",
       {},
       [](PlanRequest& r) { r.options.orientation.max_turn_rad = 3.2; }},
      {"options.orientation.max_turn",
       {},
       [](PlanRequest& r) { r.options.orientation.max_turn_rad = kNaN; }},
      {"options.limits.speed_m_per_s",
       {},
       [](PlanRequest& r) { r.options.limits.speed_m_per_s = 0.0; }},
      {"options.limits.acceleration_m_per_s2",
       {},
       [](PlanRequest& r) { r.options.limits.acceleration_m_per_s2 = -1.0; }},
      {"options.limits.turn_rate",
       {},
       [](PlanRequest& r) { r.options.limits.turn_rate_rad_per_s = kNaN; }},
      {"options.limits.retime", {}, [](PlanRequest& r) { r.options.limits.may_retime = true; }},
      {"options.max_shrink", {}, [](PlanRequest& r) { r.options.max_shrink = -0.1; }},
      {"options.max_shrink", {}, [](PlanRequest& r) { r.options.max_shrink = 1.0; }},
      {"options.max_shrink", {}, [](PlanRequest& r) { r.options.max_shrink = kNaN; }},
      {"options.max_shrink",
       {},
       [](PlanRequest& r) {
         r.body = motion::SphereShape{geometry::Vec3::Zero(), 1.0};
         r.options.max_shrink = 0.5;
       }},
      {"options.seed", {}, [](PlanRequest& r) { r.options.seed = 0; }},
      {"options.default_speed_m_per_s",
       {},
       [](PlanRequest& r) { r.has_times = false, r.options.default_speed_m_per_s = 0.0; }},
      {"options.default_speed_m_per_s",
       {},
       [](PlanRequest& r) { r.has_times = false, r.options.default_speed_m_per_s = kNaN; }},
      {"options.default_speed_m_per_s",
       {},
       [](PlanRequest& r) { r.has_times = false, r.options.default_speed_m_per_s = 2e6; }},
      {"options.default_speed_m_per_s",
       {},
       [](PlanRequest& r) { r.options.default_speed_m_per_s = 1.0; }},
  };
  for (const Fault& fault : faults) {
    PlanRequest request = good_request();
    fault.make(request);
    const std::optional<InvalidRequest> found = validate(request);
    ASSERT_TRUE(found) << fault.field;
    EXPECT_EQ(found->field, fault.field);
    EXPECT_EQ(found->keyframe, fault.keyframe) << fault.field;
    EXPECT_EQ(found->message, std::string(fault.field) + ": " + found->reason);
    request.spelling = [](std::string_view path) { return "<" + std::string(path) + ">"; };
    EXPECT_EQ(validate(request)->message, "<" + found->field + ">: " + found->reason);
  }
}

TEST(Validate, NamesTheFieldOfAFrameAtFault) {
  const Fault faults[] = {
      {"frame", {}, [](PlanRequest& r) { r.has_times = false; }},
      {"frame", {}, [](PlanRequest& r) { r.options.method = Method::kKeyframeInsertion; }},
      {"frame.reference", {}, [](PlanRequest& r) { r.frame->reference.setZero(); }},
      {"frame.reference", {}, [](PlanRequest& r) { r.frame->reference[1] = kNaN; }},
      {"frame.begin.velocity_m_per_s",
       {},
       [](PlanRequest& r) { r.frame->begin.velocity_m_per_s.x() = kNaN; }},
      {"frame.begin.image_rate_per_s",
       {},
       [](PlanRequest& r) { r.frame->begin.image_rate_per_s[2] = kInfinity; }},
      {"frame.end.velocity_m_per_s",
       {},
       [](PlanRequest& r) { r.frame->end.velocity_m_per_s.y() = 2.0 * kMaxCoordinate_m; }},
      {"frame.end.image_rate_per_s",
       {},
       [](PlanRequest& r) { r.frame->end.image_rate_per_s[0] = -2.0 * kMostImageLength; }},
      {"keyframes[1].image", 1, [](PlanRequest& r) { r.frame.reset(); }},
      {"keyframes[2].image", 2, [](PlanRequest& r) { r.keyframes[2].image[0] = kNaN; }},
      {"keyframes[2].image", 2, [](PlanRequest& r) { r.keyframes[2].image[0] = 1e-4; }},
      {"keyframes[0].image", 0, [](PlanRequest& r) { r.keyframes[0].image[3] = -1e4; }},
  };
  ASSERT_FALSE(validate(framed_request()));
  for (const Fault& fault : faults) {
    PlanRequest request = framed_request();
    fault.make(request);
    const std::optional<InvalidRequest> found = validate(request);
    ASSERT_TRUE(found) << fault.field;
    EXPECT_EQ(found->field, fault.field);
    EXPECT_EQ(found->keyframe, fault.keyframe) << fault.field;
  }
}

TEST(Validate, TheEndsOfRangesPass) {
  PlanRequest request = good_request();
  request.options.orientation.cone_rad = std::numbers::pi;
  request.options.orientation.max_turn_rad = 0.0;
  request.options.limits.speed_m_per_s = std::numeric_limits<double>::denorm_min();
  request.options.limits.acceleration_m_per_s2 = kInfinity;
  request.options.max_shrink = std::nextafter(1.0, 0.0);
  request.options.seed = std::numeric_limits<std::uint64_t>::max();
  EXPECT_FALSE(validate(request));
  request.body = request.camera;
  EXPECT_FALSE(validate(request)) << "a camera of its own can shrink too";
}

// Every resulting direction passes `validate`, and normalising it again does not change it.
TEST(Validate, DirectionsOfAnyLengthBecomeUnitVectors) {
  constexpr unsigned kSeed = 7;
  testing::Random random(kSeed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-300, 300);
  for (int i = 0; i < 10'000; ++i) {
    const geometry::Vec3 given = geometry::Vec3(normal(random), normal(random), normal(random)) *
                                 std::pow(10.0, exponent(random));
    PlanRequest request = good_request();
    const geometry::Vec3 unit = direction_of(given);
    request.options.orientation.up_W = unit;
    EXPECT_FALSE(validate(request)) << "trial " << i;
    EXPECT_EQ(direction_of(unit), unit);
    const geometry::Vec3 scaled = given / given.cwiseAbs().maxCoeff();
    // Scaling, normalising and the product itself: 1 + 3.5 + 3 roundings of half an epsilon.
    EXPECT_LE(unit.cross(scaled).norm(),
              4 * std::numeric_limits<double>::epsilon() * scaled.norm());
    EXPECT_GT(unit.dot(scaled), 0.0);
  }
  const geometry::Vec3 zero = geometry::Vec3::Zero();
  EXPECT_EQ(direction_of(zero), zero);
}

// A unit quaternion keeps its bits, so that a keyframe of an answer is read as it was written.
TEST(Validate, QuaternionsOfAnyLengthBecomeUnitQuaternions) {
  EXPECT_EQ(direction_of(geometry::Vec4(0, 0, -3e200, 0)), geometry::Vec4(0, 0, -1, 0));
  EXPECT_EQ(direction_of(geometry::Vec4(0, 4e-300, 0, 3e-300)), geometry::Vec4(0, 0.8, 0, 0.6));
  const geometry::Vec4 unit(0.6, 0, 0, 0.8);
  EXPECT_EQ(direction_of(unit), unit);
}

TEST(Validate, TimesDoNotMatterWhereNoneWereGiven) {
  PlanRequest request = good_request();
  for (motion::Keyframe& keyframe : request.keyframes) keyframe.time_s = kNaN;
  request.has_times = false;
  EXPECT_FALSE(validate(request));
}

/// Returns the message about a request with this fault, in the names of files or of the wire.
std::string message_of(Spelling spelling, const std::function<void(PlanRequest&)>& make) {
  PlanRequest request = good_request();
  make(request);
  request.spelling = [spelling](std::string_view path) { return spell(path, spelling); };
  const std::optional<InvalidRequest> found = validate(request);
  return found ? found->message : "";
}

TEST(Validate, SaysValuesInTheUnitsOfTheSender) {
  struct Case {
    std::function<void(PlanRequest&)> make;
    const char* in_files;
    const char* on_the_wire;
  };
  const double degree = std::numbers::pi / 180.0;
  const Case cases[] = {
      {[=](PlanRequest& r) { r.camera.fov_x_rad = 180 * degree; },
       "camera.fov_x_deg: is 180 degrees; it must be above 0 and below 180 degrees",
       "camera.fov_x_rad: is 3.141592653589793 rad; it must be above 0 and below 3.14159 rad"},
      {[](PlanRequest& r) { r.camera.near_m = 2e9; },
       "camera.near: is 2000000000 m; it must be above 0 and at most 1e+09 m",
       "camera.near_m: is 2000000000 m; it must be above 0 and at most 1e+09 m"},
      {[=](PlanRequest& r) { r.options.limits.turn_rate_rad_per_s = -degree; },
       "options.limits.turn_rate_deg_per_s: is -1; it must be above 0",
       "options.limits.turn_rate_rad_per_s: is -0.017453292519943295; it must be above 0"},
      {[=](PlanRequest& r) { r.options.orientation.cone_rad = 200 * degree; },
       "options.orientation.cone_deg: is 200 degrees; it must be above 0 and at most 180 degrees",
       "options.orientation.cone_rad: is 3.490658503988659 rad; it must be above 0 and at most "
       "3.14159 rad"},
      {[](PlanRequest& r) { r.options.bounds.min_W.x() = kNaN; },
       "options.bounds.min[0]: is not a number", "options.bounds.min_m[0]: is not a number"},
      {[](PlanRequest& r) { r.options.max_inserted_keyframes = -1; },
       "options.max_inserted_keyframes: is -1; it must be at least 0",
       "options.max_inserted_keyframes: is -1; it must be at least 0"},
  };
  for (const Case& c : cases) {
    EXPECT_EQ(message_of(Spelling::kFile, c.make), c.in_files);
    EXPECT_EQ(message_of(Spelling::kWire, c.make), c.on_the_wire);
  }
}

TEST(Validate, TakesTimesAsCloseAsDoublesAllow) {
  for (const double first_s : {0.0, 1.76e9, -4e9}) {
    PlanRequest request = good_request();
    const auto set_gap = [&](double gap_s) {
      for (std::size_t i = 0; i < 3; ++i)
        request.keyframes[i].time_s = first_s + static_cast<double>(i) * gap_s;
    };
    set_gap(1e-3);
    EXPECT_FALSE(validate(request)) << "1 kHz from " << first_s;
    const double least_s = std::max(kLeastTimeStep_s, kLeastRelativeTimeStep * std::abs(first_s));
    set_gap(1.1 * least_s);
    EXPECT_FALSE(validate(request)) << first_s;
    set_gap(0.9 * least_s);
    const std::optional<InvalidRequest> found = validate(request);
    ASSERT_TRUE(found) << first_s;
    EXPECT_THAT(found->message,
                ::testing::HasSubstr("s after keyframe 0; times of that size must be"));
    set_gap(0.0);
    EXPECT_THAT(validate(request)->message, ::testing::HasSubstr("times must increase"));
  }
}

TEST(Validate, ABodyNeedsNoCamera) {
  PlanRequest request = good_request();
  request.camera = {};
  const std::optional<InvalidRequest> found = validate(request);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->field, "camera.fov_x");
  request.body = motion::SphereShape{geometry::Vec3::Zero(), 1.0};
  EXPECT_FALSE(validate(request));
  request.camera = testing::small_camera();
  EXPECT_FALSE(validate(request));
}

TEST(Validate, SaysWhatABodyMustBe) {
  PlanRequest request = good_request();
  request.body = motion::BoxShape{geometry::Vec3::Zero(), {1.0, -1.0, 1.0}};
  EXPECT_EQ(validate(request)->message,
            "body.size[1]: is -1 m; it must be above 0 and at most 1e+09 m");
}

TEST(Validate, AQuaternionNeedNotBeOfUnitLength) {
  PlanRequest request = good_request();
  request.keyframes[1].pose.orientation.coeffs() *= 7.0;
  EXPECT_FALSE(validate(request));
}

TEST(Method, NamesRoundTrip) {
  EXPECT_EQ(base::value_of<Method>(to_string(Method::kKeyframeInsertion)),
            Method::kKeyframeInsertion);
  EXPECT_FALSE(base::value_of<Method>("teleport"));
}

}  // namespace
}  // namespace camway::planning
