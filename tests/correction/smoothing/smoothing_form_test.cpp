// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/smoothing_form.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "daemon/correction/smoothing/objective_cost.h"
#include "tests/support/gap_problems.h"

namespace camway::correction {
namespace {

using motion::BumpRow;
using motion::CubicPath;
using motion::CubicPoint;
using motion::KnotRow;
using testing::Draw;

constexpr double kEps = std::numeric_limits<double>::epsilon();
// Bound on the rounding of some hundred sums and products of numbers up to 10.
constexpr double kFormRounding = 1e-12;
constexpr double kFormLever_m = 0.4;
const Closeness kCloseness{
    .viewing_distance_m = 2.0, .turn_lever_m = kFormLever_m / 4.0, .acceleration_m_per_s2 = 0.8};

/// An interval of a random tour: at its beginning, at its end, between others, or alone.
struct FormCase {
  Problem problem;
  KnotRow knots;
};

FormCase random_form(Draw& draw) {
  const std::vector<motion::Keyframe> keyframes =
      testing::random_keyframes(draw, draw.integer(2, 6));
  const auto leg =
      static_cast<std::size_t>(draw.integer(0, static_cast<int>(keyframes.size()) - 2));
  FormCase c{testing::problem_of_leg(keyframes, leg), {}};
  c.knots = {c.problem.leg_begin_s(), c.problem.leg_end_s(), draw.integer(4, 24)};
  // A path other than the original.
  motion::BumpRow row{{c.problem.path.begin_s(), c.problem.path.end_s(), 9}, -1, {}};
  for (int k = -1; k <= 10; ++k) row.bumps.push_back({draw.in_cube(0.5), draw.image(0.1)});
  c.problem.path = motion::with_bumps(c.problem.path, std::vector{row});
  return c;
}

/// Runs `check` on many cases and both kinds of ends. The cases include every position of an
/// interval in a tour.
template <class Check>
void for_many(Draw& draw, int count, const Check& check) {
  int first = 0;
  int last = 0;
  int inner = 0;
  for (int i = 0; i < count; ++i) {
    const FormCase c = random_form(draw);
    const std::size_t leg = c.problem.leg;
    const bool is_last = leg + 2 == c.problem.keyframes_s.size();
    first += leg == 0 ? 1 : 0;
    last += is_last ? 1 : 0;
    inner += leg > 0 && !is_last ? 1 : 0;
    for (const Ends ends : {Ends::kFree, Ends::kFixed}) {
      check(c, ends, FreeCoefficients(c.problem, c.knots, ends));
      if (::testing::Test::HasFatalFailure()) return;
    }
  }
  EXPECT_GT(std::min({first, last, inner}), count / 10);
}

TEST(FreeCoefficients, AreWhatTheRowOfBumpsAdds) {
  Draw draw(4101);
  for_many(draw, 150, [&](const FormCase& c, Ends ends, const FreeCoefficients& free) {
    const StackedPoints variables = draw.points(free.size(), 1.0);
    const Offsets offsets = free.offsets_of(variables, kFormLever_m);
    const CubicPath after =
        motion::with_bumps(c.problem.path, std::vector{bumps_for(offsets, ends)});
    for (int i = 0; i < 60; ++i) {
      const double time_s = draw.uniform(c.problem.path.begin_s(), c.problem.path.end_s());
      const StackedPoint added = combined(free.at(time_s), variables);
      const StackedPoint now = stacked(after.at(time_s), kFormLever_m);
      const StackedPoint before = stacked(c.problem.path.at(time_s), kFormLever_m);
      ASSERT_LT((before + added - now).norm(), kFormRounding) << "at " << time_s;
    }
  });
}

TEST(FreeCoefficients, LeaveKeyframesWhereTheyAre) {
  Draw draw(4102);
  int without_room = 0;
  for_many(draw, 500, [&](const FormCase& c, Ends ends, const FreeCoefficients& free) {
    const StackedPoints variables = draw.points(free.size(), 1.0);
    double largest = 0.0;
    for (const double time_s : c.problem.keyframes_s) {
      const double moved = combined(free.at(time_s), variables).norm();
      const bool is_of_leg = time_s == c.knots.begin_s || time_s == c.knots.end_s;
      if (is_of_leg) {
        ASSERT_LT(moved, kFormRounding);
      }
      largest = std::max(largest, moved);
    }
    const bool fits = ends == Ends::kFixed || fits_free_ends(c.problem, c.knots);
    without_room += fits ? 0 : 1;
    ASSERT_EQ(largest < kFormRounding, fits) << "those beyond";
  });
  EXPECT_GT(without_room, 5);
}

TEST(FreeCoefficients, FixedEndsChangeNothingBeyondNorTheSlopeThere) {
  Draw draw(4103);
  for_many(draw, 100, [&](const FormCase& c, Ends ends, const FreeCoefficients& free) {
    if (ends == Ends::kFree) return;
    const StackedPoints variables = draw.points(free.size(), 1.0);
    const auto size_at = [&](double time_s) { return combined(free.at(time_s), variables).norm(); };
    const double span_s = c.knots.end_s - c.knots.begin_s;
    for (const double share : {1e-9, 0.1, 3.0}) {
      ASSERT_EQ(size_at(c.knots.begin_s - share * span_s), 0.0);
      ASSERT_EQ(size_at(c.knots.end_s + share * span_s), 0.0);
    }
    // A cubic with a triple zero at the keyframe, of at most 4 coefficients of size 3.
    const double step = 1e-3;
    ASSERT_LT(size_at(c.knots.begin_s + step * c.knots.spacing_s()), 4 * 3 * step * step * step);
    ASSERT_LT(size_at(c.knots.end_s - step * c.knots.spacing_s()), 4 * 3 * step * step * step);
  });
}

// Also if the adjacent keyframes are an integer number of knots away, up to rounding.
TEST(FreeCoefficients, DoNotReachBeyondTheNextKeyframe) {
  Draw draw(4104);
  int reaching = 0;
  for (int run = 0; run < 2000; ++run) {
    std::vector<motion::Keyframe> keyframes = testing::random_keyframes(draw, 4);
    const int count = draw.integer(4, 24);
    const double spacing_s = (keyframes[2].time_s - keyframes[1].time_s) / count;
    if (run % 2 == 0) {
      keyframes[0].time_s = keyframes[1].time_s - draw.integer(3, 12) * spacing_s;
      keyframes[3].time_s = keyframes[2].time_s + draw.integer(3, 12) * spacing_s;
    }
    const Problem problem = testing::problem_of_leg(keyframes, 1);
    const KnotRow knots{problem.leg_begin_s(), problem.leg_end_s(), count};
    if (!fits_free_ends(problem, knots)) continue;
    const FreeCoefficients free(problem, knots, Ends::kFree);
    ASSERT_GE(knots.knot_s(free.first() - 2), problem.keyframes_s[0]) << run;
    ASSERT_LE(knots.knot_s(free.last() + 2), problem.keyframes_s[3]) << run;
    reaching += free.first() < 0 ? 1 : 0;
    // They reach as far as they may, up to rounding.
    if (free.first() > -count / 2) {
      ASSERT_LT(knots.knot_s(free.first() - 3), problem.keyframes_s[0] + 1e-9 * spacing_s) << run;
    }
  }
  EXPECT_GT(reaching, 500);
}

TEST(FreeCoefficients, VariablesAndOffsetsAreTheSame) {
  Draw draw(4105);
  for_many(draw, 100, [&](const FormCase& c, Ends, const FreeCoefficients& free) {
    const StackedPoints variables = draw.points(free.size(), 1.0);
    const Offsets offsets = free.offsets_of(variables, kFormLever_m);
    ASSERT_EQ(offsets.first, free.first());
    ASSERT_EQ(offsets.last(), free.last());
    const StackedPoints back = free.variables_of(offsets, kFormLever_m);
    // Divided and multiplied by the lever arm.
    ASSERT_LE((back - variables).cwiseAbs().maxCoeff(), 2.0 * kEps);
    // The fixed coefficients keep the keyframe.
    for (int k = free.first(); k <= free.last(); ++k) {
      if (!free.is_held(k)) continue;
      const CubicPoint held = holding(c.knots, k, offsets(k - 1), offsets(k + 1));
      ASSERT_LT((offsets(k).position - held.position).norm(), 8.0 * kEps);
      ASSERT_LT((offsets(k).image - held.image).norm(), 8.0 * kEps / kFormLever_m);
    }
  });
}

/// Returns the path, extended straight beyond its ends.
StackedPoint on(const CubicPath& path, double time_s) {
  const double inside_s = std::clamp(time_s, path.begin_s(), path.end_s());
  const StackedPoint there = stacked(path.at(inside_s), kFormLever_m);
  if (inside_s == time_s) return there;
  const bool is_before = time_s < inside_s;
  const motion::CubicPiece& piece = is_before ? path.pieces.front() : path.pieces.back();
  const std::size_t i = is_before ? 0 : 2;
  const CubicPoint slope{piece.position[i + 1] - piece.position[i],
                         piece.image[i + 1] - piece.image[i]};
  return there +
         3.0 / (piece.t1_s - piece.t0_s) * (time_s - inside_s) * stacked(slope, kFormLever_m);
}

/// Returns the objective `kSafest` from single control points; its weight is part of the
/// computation.
double value_of(const FormCase& c, const Offsets& offsets, int first, int last) {
  const double bend = std::pow(0.2 * c.knots.count, 4.0);
  const auto control_point = [&](int k) -> StackedPoint {
    return on(c.problem.path, c.knots.knot_s(k)) + stacked(offsets(k), kFormLever_m);
  };
  double sum = 0.0;
  for (int k = first - 2; k <= last + 2; ++k) {
    const double time_s = c.knots.knot_s(k);
    if (time_s < c.problem.path.begin_s() || time_s > c.problem.path.end_s()) continue;
    const StackedPoint here = control_point(k);
    const StackedPoint before = control_point(k - 1);
    const StackedPoint after = control_point(k + 1);
    sum += 0.5 * (here - on(c.problem.original, time_s)).squaredNorm() +
           0.5 * bend * (before - 2.0 * here + after).squaredNorm();
  }
  return sum;
}

constexpr std::array kFormObjectives = {Objective::kClosest, Objective::kShortest,
                                        Objective::kSmoothest, Objective::kSafest};

template <class Check>
void for_many_forms(Draw& draw, int count, const Check& check) {
  for_many(draw, count, [&](const FormCase& c, Ends, const FreeCoefficients& free) {
    const StackedPoints about = draw.points(free.size(), 1.0);
    for (const Objective objective : kFormObjectives) {
      check(c, free, objective,
            SmoothingForm(c.problem, free, objective, kFormLever_m, kCloseness, about));
    }
  });
}

TEST(SmoothingForm, OfSafestIsTheSumOfSquaresOfControlPoints) {
  Draw draw(4106);
  for_many_forms(draw, 60,
                 [&](const FormCase& c, const FreeCoefficients& free, Objective objective,
                     const SmoothingForm& form) {
                   if (objective != Objective::kSafest) return;
                   const StackedPoints variables = draw.points(free.size(), 1.0);
                   const double expected = value_of(c, free.offsets_of(variables, kFormLever_m),
                                                    free.first(), free.last());
                   ASSERT_NEAR(form.value(variables), expected, kFormRounding * expected);
                 });
}

CubicPath path_with(const FormCase& c, Ends ends, const FreeCoefficients& free,
                    const StackedPoints& variables) {
  const BumpRow row = bumps_for(free.offsets_of(variables, kFormLever_m), ends);
  return motion::with_bumps(c.problem.path, std::vector{row});
}

// The form is the energy that an answer reports, although the path has knots between two of the
// row. Orientations have no part in it.
TEST(SmoothingForm, OfSmoothestIsTheBendingEnergy) {
  constexpr double kSumRounding = 1e-10;  // share of the energy, which cancels in the difference
  Draw draw(4112);
  for_many(draw, 60, [&](const FormCase& c, Ends ends, const FreeCoefficients& free) {
    const StackedPoints none = StackedPoints::Zero(free.size(), 7);
    const SmoothingForm form(c.problem, free, Objective::kSmoothest, kFormLever_m, kCloseness,
                             none);
    StackedPoints variables = draw.points(free.size(), 1.0);
    variables.rightCols<4>().setZero();
    const double before = bending_energy(c.problem.path);
    const double after = bending_energy(path_with(c, ends, free, variables));
    ASSERT_NEAR(form.value(variables) - form.value(none), 0.5 * (after - before),
                kSumRounding * (before + after));
    ASSERT_EQ(form.bounded_value(variables), form.value(variables));
  });
}

/// Length of the eye's curve from `begin_s` to `end_s`, by many chords.
double chords_m(const CubicPath& path, double begin_s, double end_s) {
  constexpr int kChords = 4000;
  double sum_m = 0.0;
  for (int i = 0; i < kChords; ++i) {
    const double from_s = std::lerp(begin_s, end_s, static_cast<double>(i) / kChords);
    const double to_s = std::lerp(begin_s, end_s, static_cast<double>(i + 1) / kChords);
    sum_m += (path.at(to_s).position - path.at(from_s).position).norm();
  }
  return sum_m;
}

TEST(SmoothingForm, OfShortestBoundsTheLengthAndALittleBending) {
  constexpr double kRounded = 0.03;  // share of the interval: its weight is part of the computation
  Draw draw(4113);
  for_many(draw, 30, [&](const FormCase& c, Ends ends, const FreeCoefficients& free) {
    const StackedPoints none = StackedPoints::Zero(free.size(), 7);
    const SmoothingForm form(c.problem, free, Objective::kShortest, kFormLever_m, kCloseness, none);
    const double begin_s = std::max(c.knots.knot_s(free.first() - 2), c.problem.path.begin_s());
    const double end_s = std::min(c.knots.knot_s(free.last() + 2), c.problem.path.end_s());
    const double speed =
        std::max(chords_m(c.problem.path, begin_s, end_s), kFormLever_m) / (end_s - begin_s);
    const double rounded_s = kRounded * (c.knots.end_s - c.knots.begin_s);
    StackedPoints variables = draw.points(free.size(), 1.0);
    variables.rightCols<4>().setZero();
    const CubicPath after = path_with(c, ends, free, variables);
    const double expected =
        0.5 * (chords_m(after, begin_s, end_s) - chords_m(c.problem.path, begin_s, end_s)) +
        0.5 * rounded_s * rounded_s / speed *
            (bending_energy(after) - bending_energy(c.problem.path));
    // Gauss's rule is not exact for lengths.
    const double size = form.bounded_value(variables) + form.bounded_value(none);
    ASSERT_NEAR(form.bounded_value(variables) - form.bounded_value(none), expected, 0.01 * size);
  });
}

// Majorisation: the form touches what it bounds, and is nowhere below it, up to what rounds
// velocities off at 0.
TEST(SmoothingForm, OfShortestIsNowhereBelowWhatItBounds) {
  constexpr double kRoundedShare = 0.05;
  Draw draw(4114);
  for_many(draw, 60, [&](const FormCase& c, Ends, const FreeCoefficients& free) {
    const StackedPoints about = draw.points(free.size(), 0.5);
    const SmoothingForm form(c.problem, free, Objective::kShortest, kFormLever_m, kCloseness,
                             about);
    const auto form_less_bounded = [&](const StackedPoints& variables) {
      return form.value(variables) - form.bounded_value(variables);
    };
    // ½·|v|²/|v| is ½·|v|, so the bound lacks ½·|v| as a constant.
    const double constant = form_less_bounded(about);
    const double slack = kRoundedShare * form.bounded_value(about);
    for (const double size : {0.01, 0.1, 1.0}) {
      ASSERT_GE(form_less_bounded(about + draw.points(free.size(), size)), constant - slack);
    }
  });
}

/// Half of ∫ d² + 2·w·D·(d''/a)² dt over the row, by Simpson's rule on many steps between two
/// knots.
double integral_of_offset(const FormCase& c, const FreeCoefficients& free, const CubicPath& path) {
  constexpr int kSteps = 64;
  const auto integrand = [&](double time_s) {
    const CubicPoint now = path.at(time_s);
    const CubicPoint was = c.problem.original.at(time_s);
    const CubicPoint bent = path.second_derivative(time_s);
    const CubicPoint was_bent = c.problem.original.second_derivative(time_s);
    const StackedPoint d = stacked(now, kFormLever_m) - stacked(was, kFormLever_m);
    const StackedPoint dd = stacked(bent, kFormLever_m) - stacked(was_bent, kFormLever_m);
    const double a = kCloseness.acceleration_m_per_s2;
    const double bend = 2.0 * kAccelerationWeight_rad * kCloseness.viewing_distance_m / (a * a);
    return d.squaredNorm() + bend * dd.squaredNorm();
  };
  double sum = 0.0;
  for (int k = free.first() - 2; k < free.last() + 2; ++k) {
    const double begin_s = std::max(c.knots.knot_s(k), path.begin_s());
    const double end_s = std::min(c.knots.knot_s(k + 1), path.end_s());
    if (!(begin_s < end_s)) continue;
    // The second derivative of the original jumps at its knots, which are knots of the row.
    const double inset_s = 1e-9 * (end_s - begin_s);
    for (int i = 0; i <= kSteps; ++i) {
      const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
      const double share = static_cast<double>(i) / kSteps;
      sum += weight * (end_s - begin_s) / (3.0 * kSteps) *
             integrand(std::lerp(begin_s + inset_s, end_s - inset_s, share));
    }
  }
  return 0.5 * sum;
}

// About no offset at all, all times have the same weight.
TEST(SmoothingForm, OfTheClosestPathIsTheIntegralOfTheOffsetAndItsBending) {
  Draw draw(4109);
  for_many(draw, 40, [&](FormCase c, Ends ends, const FreeCoefficients& free) {
    c.problem.path = c.problem.original;
    const SmoothingForm form(c.problem, free, Objective::kClosest, kFormLever_m, kCloseness,
                             StackedPoints::Zero(free.size(), 7));
    const StackedPoints variables = draw.points(free.size(), 1.0);
    const BumpRow row = bumps_for(free.offsets_of(variables, kFormLever_m), ends);
    const double expected =
        integral_of_offset(c, free, motion::with_bumps(c.problem.path, std::vector{row}));
    // Simpson's rule is of fourth order: 1/64^4 is 6e-8; the insets weigh 1e-9.
    ASSERT_NEAR(form.value(variables), expected, 1e-6 * expected);
  });
}

// The form bounds the cost from above, up to the share that rounds the shift off at 0.
TEST(SmoothingForm, OfTheClosestPathFallsOnlyWhereTheCostFalls) {
  constexpr double kRoundedShare = 0.05;
  Draw draw(4111);
  int falling = 0;
  for_many(draw, 60, [&](FormCase c, Ends ends, const FreeCoefficients& free) {
    if (free.size() == 0) return;
    c.problem.path = c.problem.original;
    const auto moves = [&](double size_m) {
      StackedPoints points = draw.points(free.size(), size_m);
      points.rightCols<4>().setZero();
      return points;
    };
    const auto path_of = [&](const StackedPoints& variables) {
      const BumpRow row = bumps_for(free.offsets_of(variables, kFormLever_m), ends);
      return motion::with_bumps(c.problem.path, std::vector{row});
    };
    const StackedPoints about = moves(0.5);
    const SmoothingForm form(c.problem, free, Objective::kClosest, kFormLever_m, kCloseness, about);
    const CubicPath path = path_of(about);
    const double cost = closeness_cost(path, c.problem.original, kCloseness);
    double largest_m = 0.0;
    for (Eigen::Index i = 0; i < about.rows(); ++i)
      largest_m = std::max(largest_m, about.row(i).norm());
    const double slack =
        kRoundedShare * largest_m * (path.end_s() - path.begin_s()) / kCloseness.viewing_distance_m;
    for (const double share : {0.1, 0.5, 1.0}) {
      const StackedPoints next = about + share * (form.minimum() - about) + moves(0.05);
      const double gained = form.value(about) - form.value(next);
      const double now = closeness_cost(path_of(next), c.problem.original, kCloseness);
      falling += gained > 0.0 ? 1 : 0;
      ASSERT_LE(now, cost - gained / kCloseness.viewing_distance_m + slack);
    }
  });
  EXPECT_GT(falling, 100);
}

// A row about a keyframe keeps it: the coefficient there follows from its neighbours.
TEST(FreeCoefficients, KeepAKeyframeWithinARowWithFixedEnds) {
  Draw draw(4110);
  for (int run = 0; run < 50; ++run) {
    const std::vector<motion::Keyframe> keyframes = testing::random_keyframes(draw, 3);
    const Problem problem = testing::problem_of_leg(keyframes, 1);
    const double keyframe_s = keyframes[1].time_s;
    const double before_s = (keyframe_s - keyframes[0].time_s) / draw.integer(3, 6);
    const double after_s = (keyframes[2].time_s - keyframe_s) / draw.integer(4, 8);
    const KnotRow knots =
        KnotRow::at({keyframe_s - 2 * before_s, keyframe_s - before_s, keyframe_s,
                     keyframe_s + after_s, keyframe_s + 2 * after_s, keyframe_s + 3 * after_s},
                    nullptr);
    const FreeCoefficients free(problem, knots, Ends::kFixed);
    ASSERT_EQ(free.size(), 1);
    ASSERT_TRUE(free.is_held(2));
    const StackedPoints variables = draw.points(1, 1.0);
    const StackedPoint moved = combined(free.at(keyframe_s), variables);
    ASSERT_LT(moved.norm(), kFormRounding);
    ASSERT_GT(combined(free.at(keyframe_s + after_s), variables).norm(), 0.01 * variables.norm());
    const CubicPath after = motion::with_bumps(
        problem.path, std::vector{bumps_for(free.offsets_of(variables, 1.0), Ends::kFixed)});
    const double middle_s = keyframe_s + 0.7 * after_s;
    const StackedPoint added = combined(free.at(middle_s), variables);
    const StackedPoint is =
        stacked(after.at(middle_s), 1.0) - stacked(problem.path.at(middle_s), 1.0);
    ASSERT_LT((added - is).norm(), kFormRounding);
  }
}

// Difference quotients of a quadratic are exact up to the rounding of the value, which is large
// compared with the change of a small step.
TEST(SmoothingForm, IsLeastWhereItSays) {
  Draw draw(4107);
  for_many_forms(
      draw, 30,
      [&](const FormCase&, const FreeCoefficients& free, Objective, const SmoothingForm& form) {
        const StackedPoints& minimum = form.minimum();
        const double least = form.value(minimum);
        const double size = form.value(StackedPoints::Zero(free.size(), 7));
        for (int i = 0; i < 20; ++i) {
          StackedPoints step = draw.points(free.size(), 1.0);
          const double up = form.value(minimum + step) - least;
          const double down = form.value(minimum - step) - least;
          ASSERT_GT(up, 0.0);
          ASSERT_NEAR(up, down, 1e-9 * (up + size)) << "slope";
        }
      });
}

TEST(SmoothingForm, HasAPositiveHessianOfWhichItKnowsTheFactors) {
  Draw draw(4108);
  for_many_forms(
      draw, 20,
      [&](const FormCase&, const FreeCoefficients& free, Objective, const SmoothingForm& form) {
        Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(free.size(), free.size());
        form.factors().solve_in_place(inverse);
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(inverse, Eigen::EigenvaluesOnly);
        ASSERT_GT(eigen.eigenvalues().minCoeff(), 0.0);
        ASSERT_TRUE(std::isfinite(eigen.eigenvalues().maxCoeff()));
        // x'Hx from values, where x is the inverse times any vector; in every dimension.
        const double least = form.value(form.minimum());
        const double size = form.value(StackedPoints::Zero(free.size(), 7));
        for (Eigen::Index dimension = 0; dimension < 7; ++dimension) {
          const Eigen::VectorXd any = draw.points(free.size(), 1.0).col(0);
          const double expected = 0.5 * any.dot(inverse * any);
          const double scale = std::sqrt((1.0 + size) / expected);  // to be large beside rounding
          StackedPoints step = StackedPoints::Zero(free.size(), 7);
          step.col(dimension) = scale * inverse * any;
          const double rise = form.value(form.minimum() + step) - least;
          ASSERT_NEAR(rise, scale * scale * expected, 1e-6 * rise);
        }
      });
}

}  // namespace
}  // namespace camway::correction
