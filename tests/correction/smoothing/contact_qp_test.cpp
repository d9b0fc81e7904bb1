// SPDX-License-Identifier: MIT
#include "daemon/correction/smoothing/contact_qp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Dense>

#include "tests/support/gap_problems.h"

namespace camway::correction {
namespace {

using testing::Draw;

constexpr double kEarly_m = 1e-3;  // ends a solution early, as in planning

/// A random program. The Hessian is that of a sum of squares.
struct ProgramCase {
  StackedPoints unforced;  ///< variables at the unconstrained minimum
  std::vector<Terms> samples;
  BandMatrix hessian;
  std::vector<BoundConstraint> bounds;

  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(bounds.size()); }
  [[nodiscard]] const BoundConstraint& bound(Eigen::Index i) const {
    return bounds[static_cast<std::size_t>(i)];
  }
  /// Returns the minimum; the multipliers stay in the bounds.
  StackedPoints solve(double settled_m, int most_sweeps = kFewSweeps) {
    StackedPoints variables = unforced;
    const Responses responses = responses_of(samples, BandFactors(hessian));
    solve_qp(bounds, samples, responses, settled_m, most_sweeps, variables);
    return variables;
  }
};

Terms random_terms(Draw& draw, int variables) {
  Terms terms;
  const int first = draw.integer(0, std::max(0, variables - 1 - static_cast<int>(kBand)));
  for (int k = first; k < std::min(variables, first + 1 + static_cast<int>(kBand)); ++k) {
    terms.push_back({k, draw.uniform(-0.3, 1.0)});
  }
  return terms;
}

ProgramCase random_program(Draw& draw, int samples, int bounds_of_sample, double share_soft) {
  ProgramCase c;
  const int variables = draw.integer(1, samples + 2);
  c.unforced = draw.points(variables, 1.0);
  SumOfSquares squares(variables);
  for (int k = 0; k < variables; ++k) {
    squares.count(draw.uniform(0.2, 2.0), {{k, 1.0}}, StackedPoint::Zero());
    squares.count(draw.uniform(0.0, 2.0), random_terms(draw, variables), StackedPoint::Zero());
  }
  c.hessian = squares.hessian;
  for (int s = 0; s < samples; ++s) {
    c.samples.push_back(random_terms(draw, variables));
    for (int i = 0; i < bounds_of_sample; ++i) {
      BoundConstraint bound;
      bound.sample = static_cast<std::size_t>(s);
      bound.direction = draw.stacked(1.0);
      bound.bound_m =
          combined(c.samples.back(), c.unforced).dot(bound.direction) + draw.uniform(-0.5, 0.5);
      bound.compliance = draw.uniform(0.0, 1.0) < share_soft ? draw.uniform(0.2, 2.0) : 0.0;
      c.bounds.push_back(bound);
    }
  }
  return c;
}

Eigen::MatrixXd dense(const BandMatrix& band) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(band.rows(), band.rows());
  for (Eigen::Index i = 0; i < band.rows(); ++i) {
    for (Eigen::Index d = 0; d <= std::min(i, kBand); ++d) {
      matrix(i, i - d) = matrix(i - d, i) = band(i, d);
    }
  }
  return matrix;
}

/// Returns the place of each sample in terms of the variables, one per row.
Eigen::MatrixXd shares_of(const ProgramCase& c) {
  Eigen::MatrixXd shares =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(c.samples.size()), c.unforced.rows());
  for (std::size_t s = 0; s < c.samples.size(); ++s) {
    for (const Term& term : c.samples[s]) {
      shares(static_cast<Eigen::Index>(s), term.variable) = term.share;
    }
  }
  return shares;
}

/// Returns the response of each bound to a unit multiplier on each, compliance included.
Eigen::MatrixXd matrix_of(const ProgramCase& c) {
  const Eigen::MatrixXd shares = shares_of(c);
  const Eigen::MatrixXd response = shares * dense(c.hessian).ldlt().solve(shares.transpose());
  Eigen::MatrixXd matrix(c.size(), c.size());
  for (Eigen::Index i = 0; i < c.size(); ++i) {
    for (Eigen::Index j = 0; j < c.size(); ++j) {
      const auto a = static_cast<Eigen::Index>(c.bound(i).sample);
      const auto b = static_cast<Eigen::Index>(c.bound(j).sample);
      matrix(i, j) = response(a, b) * c.bound(i).direction.dot(c.bound(j).direction);
    }
  }
  for (Eigen::Index i = 0; i < c.size(); ++i) matrix(i, i) *= 1.0 + c.bound(i).compliance;
  return matrix;
}

Eigen::VectorXd missing_in(const ProgramCase& c) {
  Eigen::VectorXd missing(c.size());
  for (Eigen::Index i = 0; i < c.size(); ++i) {
    const StackedPoint place = combined(c.samples[c.bound(i).sample], c.unforced);
    missing[i] = c.bound(i).bound_m - place.dot(c.bound(i).direction);
  }
  return missing;
}

Eigen::VectorXd forces_of(const ProgramCase& c) {
  Eigen::VectorXd forces(c.size());
  for (Eigen::Index i = 0; i < c.size(); ++i) forces[i] = c.bound(i).multiplier;
  return forces;
}

/// Tries all active sets. Returns the one without negative multipliers and without a violated
/// bound.
std::optional<Eigen::VectorXd> exact_forces(const ProgramCase& c) {
  const Eigen::MatrixXd matrix = matrix_of(c);
  const Eigen::VectorXd missing = missing_in(c);
  const double rounding = 1e-9 * missing.cwiseAbs().maxCoeff();
  for (unsigned chosen = 0; chosen < 1U << c.size(); ++chosen) {
    std::vector<Eigen::Index> active;
    for (Eigen::Index i = 0; i < c.size(); ++i) {
      if ((chosen >> i & 1U) != 0) active.push_back(i);
    }
    Eigen::VectorXd forces = Eigen::VectorXd::Zero(c.size());
    if (!active.empty()) {
      const Eigen::VectorXd part = matrix(active, active).fullPivLu().solve(missing(active));
      if (!(part.minCoeff() >= 0.0)) continue;
      forces(active) = part;
    }
    if ((matrix * forces - missing).minCoeff() >= -rounding) return forces;
  }
  return std::nullopt;
}

/// Repeats the solution from the last result until nothing changes, because each call is bounded.
void find_until_settled(ProgramCase& c) {
  constexpr double kUnchanged = 1e-14;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::VectorXd before = forces_of(c);
    c.solve(0.0);
    const Eigen::VectorXd now = forces_of(c);
    if ((now - before).norm() <= kUnchanged * now.norm()) return;
  }
}

/// Returns the dual objective.
double dual_of(const ProgramCase& c, const Eigen::VectorXd& forces) {
  return missing_in(c).dot(forces) - 0.5 * forces.dot(matrix_of(c) * forces);
}

TEST(ContactForces, AreThoseOfTheBestActiveSet) {
  Draw draw(4201);
  int with_force = 0;
  for (int run = 0; run < 300; ++run) {
    ProgramCase c = random_program(draw, draw.integer(1, 4), draw.integer(1, 2), 0.4);
    const std::optional<Eigen::VectorXd> exact = exact_forces(c);
    ASSERT_TRUE(exact) << run;
    find_until_settled(c);
    // Multipliers may be large where bounds nearly exclude each other, so the test compares their
    // effect.
    const double size = 1.0 + exact->cwiseAbs().maxCoeff();
    EXPECT_LT((matrix_of(c) * (forces_of(c) - *exact)).norm(), 1e-6 * size) << run;
    EXPECT_NEAR(dual_of(c, forces_of(c)), dual_of(c, *exact), 1e-6 * size) << run;
    with_force += exact->maxCoeff() > 0.0 ? 1 : 0;
  }
  EXPECT_GT(with_force, 150);
}

TEST(ContactForces, MeetTheConditionsOfTheOptimumWhereThereAreMany) {
  Draw draw(4202);
  for (int run = 0; run < 20; ++run) {
    // Many hard bounds of one sample may exclude each other; soft ones cannot.
    ProgramCase c = random_program(draw, 30, 3, 1.0);
    find_until_settled(c);
    const Eigen::VectorXd forces = forces_of(c);
    const Eigen::VectorXd room = matrix_of(c) * forces - missing_in(c);
    EXPECT_GE(forces.minCoeff(), 0.0);
    EXPECT_GT(forces.maxCoeff(), 0.0);
    EXPECT_GE(room.minCoeff(), -1e-9) << "a bound does not hold";
    EXPECT_LT(forces.cwiseProduct(room).cwiseAbs().maxCoeff(), 1e-9) << "a force without contact";
  }
}

TEST(ContactForces, FromAnyGuessAreTheSame) {
  Draw draw(4203);
  for (int run = 0; run < 50; ++run) {
    ProgramCase cold = random_program(draw, 12, 2, 1.0);
    ProgramCase warm = cold;
    for (BoundConstraint& bound : warm.bounds)
      bound.multiplier = draw.integer(0, 1) * draw.uniform(0.0, 3.0);
    find_until_settled(cold);
    find_until_settled(warm);
    const double size = 1.0 + forces_of(cold).maxCoeff();
    EXPECT_LT((forces_of(cold) - forces_of(warm)).cwiseAbs().maxCoeff(), 1e-9 * size) << run;
  }
}

TEST(ContactForces, NeverGetWorseThanTheGuess) {
  Draw draw(4204);
  for (int run = 0; run < 300; ++run) {
    ProgramCase c = random_program(draw, draw.integer(1, 20), draw.integer(1, 3), 0.5);
    for (BoundConstraint& bound : c.bounds)
      bound.multiplier = draw.integer(0, 1) * draw.uniform(0.0, 1.0);
    const double before = dual_of(c, forces_of(c));
    c.solve(kEarly_m);
    const double after = dual_of(c, forces_of(c));
    EXPECT_GE(after, before - 1e-12 * (1.0 + std::abs(before))) << run;
    EXPECT_GE(forces_of(c).minCoeff(), 0.0);
  }
}

TEST(ContactForces, AreNearerToTheOptimumAfterMoreSweeps) {
  Draw draw(4207);
  int nearer = 0;
  for (int run = 0; run < 50; ++run) {
    const ProgramCase c = random_program(draw, 20, 2, 1.0);
    double last = -std::numeric_limits<double>::infinity();
    for (const int sweeps : {1, 3, 10, 40}) {
      ProgramCase swept = c;
      swept.solve(0.0, sweeps);
      const double dual = dual_of(swept, forces_of(swept));
      EXPECT_GE(dual, last - 1e-12 * (1.0 + std::abs(dual))) << run;
      nearer += dual > last ? 1 : 0;
      last = dual;
    }
  }
  EXPECT_GT(nearer, 175) << "of 200, the first of each run included";
}

// The forces move the variables by the inverse of the Hessian, by an independent solution of it.
TEST(ContactForces, MoveTheVariables) {
  Draw draw(4206);
  for (int run = 0; run < 100; ++run) {
    ProgramCase c = random_program(draw, draw.integer(1, 20), draw.integer(1, 3), 0.5);
    const StackedPoints found = c.solve(kEarly_m);
    Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(c.unforced.rows(), 7);
    const Eigen::MatrixXd shares = shares_of(c);
    for (const BoundConstraint& bound : c.bounds) {
      forces += bound.multiplier * shares.row(static_cast<Eigen::Index>(bound.sample)).transpose() *
                bound.direction.transpose();
    }
    const Eigen::MatrixXd expected = c.unforced + dense(c.hessian).ldlt().solve(forces);
    EXPECT_LT((found - expected).norm(), 1e-11 * (1.0 + expected.norm())) << run;
  }
}

// A single bound has a closed solution.
TEST(ContactForces, OfASoftBoundGiveWayAsTheySay) {
  ProgramCase c;
  c.unforced = StackedPoints::Zero(1, 7);
  c.samples = {{{0, 1.0}}};
  c.hessian = BandMatrix::Zero(1, kBand + 1);
  c.hessian(0, 0) = 0.25;
  for (const double compliance : {0.0, 1.0, 3.0}) {
    c.bounds = {{0, 0.5 * StackedPoint::Unit(2), 6.0, compliance, 0.0}};
    c.solve(0.0);
    EXPECT_DOUBLE_EQ(c.bounds[0].multiplier, 6.0 / (1.0 + compliance));  // 0.5² / 0.25 is 1
  }
  c.bounds = {{0, 0.5 * StackedPoint::Unit(2), -1.0, 0.0, 0.0}};
  c.solve(0.0);
  EXPECT_EQ(c.bounds[0].multiplier, 0.0) << "it holds already";
}

// No multiplier helps a sample that no variable moves, and it must not affect the others.
TEST(ContactForces, LeaveAloneWhatNoForceMoves) {
  Draw draw(4205);
  ProgramCase c = random_program(draw, 3, 1, 1.0);
  ProgramCase without = c;
  without.bounds.erase(without.bounds.begin() + 1);
  for (ProgramCase* changed : {&c, &without}) {
    changed->samples[1].clear();
    changed->bounds[0].bound_m += 2.0;
  }
  c.bounds[1].bound_m = 1.0;
  find_until_settled(c);
  find_until_settled(without);
  EXPECT_EQ(c.bounds[1].multiplier, 0.0);
  EXPECT_GT(c.bounds[0].multiplier, 0.0);
  EXPECT_DOUBLE_EQ(c.bounds[0].multiplier, without.bounds[0].multiplier);
  EXPECT_DOUBLE_EQ(c.bounds[2].multiplier, without.bounds[1].multiplier);
}

}  // namespace
}  // namespace camway::correction
