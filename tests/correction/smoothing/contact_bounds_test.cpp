// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/contact_bounds.h"

#include <gtest/gtest.h>

#include <vector>

#include "daemon/correction/smoothing/objective_cost.h"
#include "tests/support/gap_problems.h"

namespace camway::correction {
namespace {

using testing::Draw;

constexpr double kBallRadius_m = 0.5;
constexpr double kReply = 0.3;

Contact contact(const StackedPoint& direction, double room_m, std::uint32_t triangle,
                std::size_t vertex) {
  return {{direction, room_m, triangle, vertex}};
}

/// Returns the contacts of two triangles with three vertices each, at the distances `rooms_m`.
std::vector<Contact> contacts(Draw& draw, const std::vector<double>& rooms_m) {
  std::vector<Contact> all;
  for (std::size_t i = 0; i < rooms_m.size(); ++i)
    all.push_back(contact(draw.stacked(1.0), rooms_m[i], static_cast<std::uint32_t>(i / 3), i % 3));
  return all;
}

constexpr double kViewingDistance_m = 6.0;
constexpr double kPrice = 30.0;
constexpr double kSettled_m = 1e-12;  // of the solver; multipliers are off by it over a response
constexpr double kForceRounding = 1e-9;

/// Returns the distance of the vertex beyond the plane at which the bound is tight.
double room_at(const BoundConstraint& bound, const Contact& contact, const StackedPoint& moved) {
  return contact.row.room_m + bound.bound_m - bound.direction.dot(moved);
}

/// Solves for the bounds of one sample, which is the only variable. `response`: its displacement
/// per unit force.
void solve_one_sample(ContactBounds& bounds, double response, double settled_m) {
  const std::vector<Terms> samples = {{{0, 1.0}}};
  StackedPoints variables = StackedPoints::Zero(1, 7);
  solve_qp(bounds.bounds(), samples, Responses::Constant(1, 1, response), settled_m, kFewSweeps,
           variables);
}

TEST(ContactBounds, KeepAGapHardWhereThereIsRoomAndElseMostOfIt) {
  Draw draw(6201);
  for (const auto& [objective, makes_room] :
       {std::pair(Objective::kClosest, false), std::pair(Objective::kClosest, true),
        std::pair(Objective::kShortest, false), std::pair(Objective::kSmoothest, true)}) {
    ContactBounds bounds(objective, kBallRadius_m, kViewingDistance_m);
    if (makes_room) bounds.set_price_of_room(kPrice);
    const std::size_t bounds_a_contact = makes_room ? 2 : 1;
    const StackedPoint moved = draw.stacked(1.0);
    std::vector<Contact> near = contacts(draw, {2.0, 0.01, -0.02});
    bounds.add(4, moved, kReply, near);
    ASSERT_EQ(bounds.bounds().size(), 1 + 2 * bounds_a_contact);
    for (const BoundConstraint& bound : bounds.bounds()) EXPECT_EQ(bound.sample, 4U);
    const auto& all = bounds.bounds();
    EXPECT_NEAR(room_at(all[0], near[0], moved), bounds.wanted_m(), 1e-12);
    EXPECT_EQ(all[0].compliance, 0.0);
    for (const std::size_t i : {1U, 2U}) {
      const BoundConstraint& hard = all[1 + (i - 1) * bounds_a_contact];
      EXPECT_EQ(hard.compliance, 0.0);
      EXPECT_LE(room_at(hard, near[i], moved), std::max(0.01, near[i].row.room_m));
      EXPECT_GE(room_at(hard, near[i], moved), near[i].row.room_m - 0.01);
      if (!makes_room) continue;
      const BoundConstraint& soft = all[2 * i];
      EXPECT_GT(soft.compliance, 0.0);
      EXPECT_NEAR(room_at(soft, near[i], moved), bounds.wanted_m(), 1e-12);
    }
  }
}

// The minimum of (x/response)·x/2 + price·m²/2 over the gap: the force is the price of what is
// still missing, so a stiff path buys less.
TEST(ContactBounds, BuyRoomUntilItCostsMoreThanItsPrice) {
  for (const double response : {0.01, 0.1, 1.0, 100.0}) {
    ContactBounds bounds(Objective::kClosest, kBallRadius_m, kViewingDistance_m);
    bounds.set_price_of_room(kPrice);
    StackedPoint along = StackedPoint::Zero();
    along[1] = 1.0;
    std::vector<Contact> near = {contact(along, 0.06, 0, 0)};
    bounds.add(0, StackedPoint::Zero(), response, near);
    solve_one_sample(bounds, response, kSettled_m);
    bounds.remember();
    const double missing_m = bounds.wanted_m() - 0.06 - response * near[0].soft_multiplier;
    EXPECT_NEAR(near[0].soft_multiplier, kPrice * missing_m, kForceRounding) << response;
  }
}

// A body that all but touches gets its first room at a multiple of the price.
TEST(ContactBounds, PayMoreForTheFirstPartOfAGap) {
  const auto force_at = [](double room_m) {
    ContactBounds bounds(Objective::kClosest, kBallRadius_m, kViewingDistance_m);
    bounds.set_price_of_room(kPrice);
    StackedPoint along = StackedPoint::Zero();
    along[1] = 1.0;
    std::vector<Contact> near = {contact(along, room_m, 0, 0)};
    // So stiff that the force moves nothing.
    constexpr double kResponse = 1e-6;
    bounds.add(0, StackedPoint::Zero(), kResponse, near);
    solve_one_sample(bounds, kResponse, kSettled_m);
    bounds.remember();
    return near[0].soft_multiplier / (bounds.wanted_m() - room_m);
  };
  EXPECT_GT(force_at(0.0001), 5.0 * kPrice);
  EXPECT_GT(force_at(0.005), 2.0 * kPrice);
  EXPECT_NEAR(force_at(0.03), kPrice, 0.01 * kPrice);
}

TEST(ContactBounds, WantAShareOfTheRadiusWhereThatShiftsThePictureLittle) {
  EXPECT_DOUBLE_EQ(ContactBounds(Objective::kClosest, 0.1, 100.0).wanted_m(), 0.07);
  EXPECT_DOUBLE_EQ(ContactBounds(Objective::kClosest, 1.0, 2.0).wanted_m(), 0.04);
}

// A measure of the curve alone is the better, the less room is kept.
TEST(ContactBounds, WantLittleForAMeasureOfTheCurveAlone) {
  for (const Objective objective : {Objective::kShortest, Objective::kSmoothest}) {
    EXPECT_DOUBLE_EQ(ContactBounds(objective, 0.1, 100.0).wanted_m(), 0.003);
    EXPECT_DOUBLE_EQ(ContactBounds(objective, 1.0, 1.0).wanted_m(), 0.02);
  }
}

TEST(ContactBounds, OfSafestPushOneVertexOfEachTriangleAndDoNotTurnForIt) {
  Draw draw(6202);
  ContactBounds bounds(Objective::kSafest, kBallRadius_m, kViewingDistance_m);
  EXPECT_EQ(bounds.wanted_m(), kComfort * kBallRadius_m);
  bounds.keep(0.05);
  const StackedPoint moved = draw.stacked(1.0);
  // Only near contacts are hard: at the distance to keep, or at their own if that is less.
  std::vector<Contact> near = contacts(draw, {1.2, 0.9, 1.1, 0.2, 0.03, 3.0});
  bounds.add(0, moved, kReply, near);
  std::vector<BoundConstraint> hard;
  std::vector<BoundConstraint> soft;
  for (const BoundConstraint& bound : bounds.bounds())
    (bound.compliance > 0.0 ? soft : hard).push_back(bound);
  ASSERT_EQ(hard.size(), 2U);
  EXPECT_NEAR(room_at(hard[0], near[3], moved), 0.05, 1e-12);
  EXPECT_NEAR(room_at(hard[1], near[4], moved), 0.03, 1e-12);
  ASSERT_EQ(soft.size(), 2U);
  EXPECT_NEAR(room_at(soft[0], near[1], moved), bounds.wanted_m(), 1e-12);
  EXPECT_NEAR(room_at(soft[1], near[4], moved), bounds.wanted_m(), 1e-12);
  for (const BoundConstraint& bound : soft) EXPECT_TRUE(bound.direction.tail<4>().isZero(0.0));
  EXPECT_EQ(soft[0].direction.head<3>(), near[1].row.direction.head<3>());
}

// The weight of a gap does not depend on the path's compliance: a stiff path moves less.
TEST(ContactBounds, OfSafestMoveAStiffPathLess) {
  Draw draw(6203);
  const auto moved_m = [](double response) {
    ContactBounds bounds(Objective::kSafest, kBallRadius_m, kViewingDistance_m);
    StackedPoint along = StackedPoint::Zero();
    along[0] = 1.0;
    std::vector<Contact> near = {contact(along, 0.6, 0, 0)};
    bounds.add(0, StackedPoint::Zero(), response, near);
    solve_one_sample(bounds, response, kSettled_m);
    bounds.remember();
    EXPECT_EQ(near[0].soft_multiplier, bounds.bounds()[0].multiplier);
    return response * near[0].soft_multiplier;
  };
  EXPECT_LT(moved_m(0.01), 0.5 * moved_m(0.1));
  EXPECT_LT(moved_m(0.1), 0.5 * moved_m(1.0));
  const double missing_m = kComfort * kBallRadius_m - 0.6;
  EXPECT_LT(moved_m(100.0), missing_m);
  EXPECT_GT(moved_m(100.0), 0.95 * missing_m);
}

TEST(ContactBounds, RememberForcesForTheNextTime) {
  Draw draw(6204);
  ContactBounds bounds(Objective::kClosest, kBallRadius_m, kViewingDistance_m);
  bounds.set_price_of_room(kPrice);
  std::vector<Contact> near = contacts(draw, {0.01, 0.2});
  bounds.add(0, StackedPoint::Zero(), kReply, near);
  double force = 1.0;
  for (BoundConstraint& bound : bounds.bounds()) bound.multiplier = force++;
  bounds.remember();
  EXPECT_EQ(near[0].hard_multiplier, 1.0);
  EXPECT_EQ(near[0].soft_multiplier, 2.0);
  EXPECT_EQ(near[1].hard_multiplier, 3.0);
  bounds.clear();
  EXPECT_TRUE(bounds.bounds().empty());
  bounds.add(0, StackedPoint::Zero(), kReply, near);
  EXPECT_EQ(bounds.bounds()[1].multiplier, 2.0);
}

}  // namespace
}  // namespace camway::correction
