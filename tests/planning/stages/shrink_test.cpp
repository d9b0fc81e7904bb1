// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/shrink.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stop_token>
#include <thread>
#include <vector>

#include "daemon/planning/stages/slowing.h"

namespace camway::planning {
namespace {

using base::Deadline;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

UnsentResult ended(Status status) {
  PlanResult result;
  result.status = status;
  result.message = "this is how it ended";
  if (status != Status::kOk) result.remaining_collisions = {{1, 2}};
  result.collisions = {{1, 2}};
  result.corrections = {{{1, 2}}};
  return {std::move(result)};
}

PlanResult plan_within(const PlanRequest& request, const Deadline& deadline,
                       const PlanAtSize& plan_at_size) {
  return plan_with_shrinking(request, deadline, plan_at_size).result;
}

struct Planned {
  std::vector<double> scales;  ///< in the order in which they were tried
  PlanResult result;
};

/// With a planner for which `fits` says at which scale all is free.
template <class Fits>
Planned planned(double max_shrink, const Fits& fits) {
  PlanRequest request;
  request.camera.near_m = 2.0;
  request.options.max_shrink = max_shrink;
  Planned planned;
  planned.result =
      plan_within(request, Deadline::never(), [&](const PlanRequest& asked, const Deadline&) {
        planned.scales.push_back(asked.camera.near_m / 2.0);
        return ended(fits(planned.scales.back()) ? Status::kOk : Status::kPartial);
      });
  return planned;
}

Planned planned_with(double max_shrink, Status status) {
  PlanRequest request;
  request.options.max_shrink = max_shrink;
  Planned planned;
  planned.result =
      plan_within(request, Deadline::never(), [&](const PlanRequest&, const Deadline&) {
        planned.scales.push_back(1.0);
        return ended(status);
      });
  return planned;
}

TEST(PlanWithShrinking, LeavesTheCameraAsItIsWhereItFits) {
  const Planned result = planned(0.7, [](double) { return true; });
  EXPECT_EQ(result.scales.size(), 1U);
  EXPECT_EQ(result.result.near_scale, 1.0);
}

// Between the steps of 0.85 below and above, whatever fits.
TEST(PlanWithShrinking, TakesTheLargestStepThatFits) {
  for (double limit = 0.3; limit < 1.0; limit += 0.01) {
    const Planned result = planned(0.7, [&](double scale) { return scale <= limit + 1e-12; });
    EXPECT_EQ(result.result.status, Status::kOk);
    EXPECT_LE(result.result.near_scale, limit + 1e-12);
    EXPECT_TRUE(result.result.near_scale > 0.85 * limit || result.result.near_scale < 0.301)
        << limit << " " << result.result.near_scale;
    EXPECT_LE(result.scales.size(), 6U);
    EXPECT_EQ(result.result.corrections[0].kind, correction::CorrectionKind::kShrink);
    EXPECT_THAT(result.result.message, HasSubstr(" m instead of 2 m"));
  }
}

TEST(PlanWithShrinking, TriesThemAllIfNotEvenTheSmallestFits) {
  const Planned one = planned(0.7, [](double scale) { return std::abs(scale - 0.7225) < 1e-9; });
  EXPECT_EQ(one.result.status, Status::kOk);
  EXPECT_NEAR(one.result.near_scale, 0.7225, 1e-9);
  const Planned none = planned(0.5, [](double) { return false; });
  EXPECT_EQ(none.result.status, Status::kPartial);
  EXPECT_THAT(none.result.message,
              HasSubstr("this is how it ended; nor was there a free path with the near distance "
                        "times 0.85, 0.72, 0.61, 0.52, 0.5"));
  EXPECT_THAT(none.result.message, Not(HasSubstr("deadline")));
  // The last step of 0.85 and the limit of the request are nearly the same.
  EXPECT_THAT(planned(0.9, [](double) { return false; }).result.message, EndsWith("0.12, 0.1"));
}

TEST(PlanWithShrinking, TriesNoMoreWhereTheSmallestIsShutIn) {
  PlanRequest request;
  request.camera.near_m = 1.0;
  request.options.max_shrink = 0.5;
  std::vector<double> tried;
  const PlanResult result =
      plan_within(request, Deadline::never(), [&](const PlanRequest& asked, const Deadline&) {
        tried.push_back(asked.camera.near_m);
        if (tried.size() == 1) return ended(Status::kTimeout);  // its half of the deadline is over
        UnsentResult shut_in = ended(Status::kPartial);
        shut_in.result.shut_in = {{1, {}}};
        return shut_in;
      });
  EXPECT_EQ(tried, (std::vector<double>{1.0, 0.5}));
  EXPECT_EQ(result.status, Status::kPartial) << "more time would not help";
  EXPECT_EQ(result.keyframe, 1U);
  EXPECT_THAT(result.message, HasSubstr("keyframe 1 seems shut in"));
}

// A search that ended at its limit does not show that a larger camera has no way out.
TEST(PlanWithShrinking, TriesOnWhereTheSearchOfTheSmallestEndedAtItsLimit) {
  const auto tried_sizes = [](bool is_complete) {
    PlanRequest request;
    request.camera.near_m = 1.0;
    request.options.max_shrink = 0.5;
    std::size_t tried = 0;
    plan_within(request, Deadline::never(), [&](const PlanRequest&, const Deadline&) {
      ++tried;
      UnsentResult shut_in = ended(Status::kPartial);
      shut_in.result.shut_in = {{.keyframe = 1, .region_W = {}, .is_complete = is_complete}};
      return shut_in;
    });
    return tried;
  };
  EXPECT_EQ(tried_sizes(true), 2U);
  EXPECT_GT(tried_sizes(false), 2U);
}

// The collisions are those of the camera that was asked for, at the times of the answered path,
// whichever of the two paths had to be slowed.
TEST(PlanWithShrinking, TellsOfCollisionsAtTheTimesOfTheSlowedPath) {
  PlanRequest request;
  request.camera.near_m = 1.0;
  request.options.max_shrink = 0.1;
  for (const double full_factor : {1.0, 5.0}) {
    for (const double small_factor : {1.0, 3.0}) {
      SCOPED_TRACE(::testing::Message() << full_factor << " " << small_factor);
      const auto plan_at_size = [&](const PlanRequest& asked, const Deadline&) {
        const bool is_full = asked.camera.near_m == 1.0;
        UnsentResult ends = ended(is_full ? Status::kPartial : Status::kOk);
        if (!is_full) ends.result.collisions = {{4, 5}, {6, 7}};
        if (!is_full) ends.result.corrections.clear();
        ends.origin = motion::TimeOrigin{100.0};
        const double factor = is_full ? full_factor : small_factor;
        if (factor == 1.0) return ends;
        ends.law = motion::TimeLaw::uniform({0, 10}, factor);
        move_times(*ends.law, ends.result);
        return ends;
      };
      const PlanResult result =
          with_sent_times(plan_with_shrinking(request, Deadline::never(), plan_at_size));
      EXPECT_EQ(result.status, Status::kOk);
      EXPECT_EQ(result.time_scale, small_factor);
      ASSERT_EQ(result.collisions.size(), 1U);
      EXPECT_DOUBLE_EQ(result.collisions[0].t_begin_s, 100.0 + small_factor);
      EXPECT_DOUBLE_EQ(result.collisions[0].t_end_s, 100.0 + 2.0 * small_factor);
      ASSERT_EQ(result.corrections.size(), 1U);
      EXPECT_EQ(result.corrections[0].kind, correction::CorrectionKind::kShrink);
      EXPECT_EQ(result.corrections[0].interval, result.collisions[0]);
    }
  }
}

// Each takes all of its time.
TEST(PlanWithShrinking, UsesTheWholeDeadlineAndNoMore) {
  PlanRequest request;
  request.options.max_shrink = 0.5;
  int tried = 0;
  const Deadline deadline = Deadline::after_s(0.2);
  const PlanResult result =
      plan_within(request, deadline, [&](const PlanRequest&, const Deadline& until) {
        ++tried;
        while (!until.passed()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return ended(Status::kTimeout);
      });
  EXPECT_GT(tried, 2);
  EXPECT_GT(deadline.elapsed_ms(), 180.0);
  EXPECT_EQ(result.status, Status::kTimeout);
  EXPECT_THAT(result.message, HasSubstr("0.5, as far as the deadline allowed"));
}

TEST(PlanWithShrinking, GivesThoseThatAreSmallerTheirShare) {
  PlanRequest request;
  request.camera.near_m = 1.0;
  request.options.max_shrink = 0.5;
  const PlanResult result = plan_within(
      request, Deadline::after_s(0.2), [&](const PlanRequest& asked, const Deadline& until) {
        if (asked.camera.near_m < 0.6) return ended(Status::kOk);
        while (!until.passed()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return ended(Status::kTimeout);
      });
  EXPECT_EQ(result.status, Status::kOk);
  EXPECT_GE(result.near_scale, 0.5);
  EXPECT_LT(result.near_scale, 0.6);
}

// A request that is not valid goes in, and comes out as the planner judges it.
TEST(PlanWithShrinking, DoesNotLookAtWhatIsNotValid) {
  for (const double max_shrink : {1.0, 7.0, std::nan("")}) {
    const Planned result = planned_with(max_shrink, Status::kInvalid);
    EXPECT_EQ(result.result.status, Status::kInvalid);
    EXPECT_EQ(result.scales.size(), 1U);
  }
}

TEST(PlanWithShrinking, StopsWhenItIsToldTo) {
  PlanRequest request;
  request.options.max_shrink = 0.5;
  std::stop_source stop;
  const Deadline deadline = Deadline::never().watched(stop.get_token(), nullptr);
  int tried = 0;
  plan_with_shrinking(request, deadline, [&](const PlanRequest&, const Deadline& until) {
    EXPECT_FALSE(until.passed());
    stop.request_stop();
    EXPECT_TRUE(until.passed());
    ++tried;
    return ended(Status::kTimeout);
  });
  EXPECT_EQ(tried, 1);
}

TEST(PlanWithShrinking, SaysSoWhereNoTimeWasLeftForIt) {
  PlanRequest request;
  request.options.max_shrink = 0.5;
  const PlanResult result =
      plan_within(request, Deadline::after_s(0.0),
                  [&](const PlanRequest&, const Deadline&) { return ended(Status::kTimeout); });
  EXPECT_EQ(result.status, Status::kTimeout);
  EXPECT_THAT(result.message, HasSubstr("left no time to make the near distance smaller"));
}

}  // namespace
}  // namespace camway::planning
