// SPDX-License-Identifier: MIT
#include "daemon/motion/spline/knot_row.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "daemon/motion/path/bezier.h"

namespace camway::motion {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kPointRoundings = 4.0;  // rounding of a control point, in epsilons of its size
constexpr double kMostMoved = 0.125;     // largest shift of a knot, as a share of a step

}  // namespace

double least_piece_s(double interval_s, double travelled_m, double size_m) {
  const double noise_m = 24.0 * kPointRoundings * kEpsilon * size_m;
  const double share = std::sqrt(noise_m / (kAccelerationNoise * travelled_m));
  return interval_s * (share < 1.0 ? share : 1.0);  // also where nothing moves, and 0/0
}

double KnotPlaces::place_s(double time_s, double spacing_s) const {
  const double reach_s = std::min(same_s, kMostMoved * spacing_s);
  const auto next = std::ranges::lower_bound(taken_s, time_s);
  const bool has_next = next != taken_s.end();
  const bool has_last = next != taken_s.begin();
  const double after_s = has_next ? *next - time_s : std::numeric_limits<double>::infinity();
  const double before_s =
      has_last ? time_s - *std::prev(next) : std::numeric_limits<double>::infinity();
  if (std::min(before_s, after_s) > reach_s) return origin.nearest_s(time_s);
  return before_s < after_s ? *std::prev(next) : *next;
}

KnotRow KnotRow::about(double middle_s, double spacing_s,
                       std::shared_ptr<const KnotPlaces> places) {
  double begin_s = middle_s - 2.0 * spacing_s;
  double end_s = middle_s + 2.0 * spacing_s;
  if (places) {
    begin_s = places->place_s(begin_s, spacing_s);
    end_s = places->place_s(end_s, spacing_s);
  }
  return {begin_s, end_s, 4, std::move(places)};
}

KnotRow KnotRow::at(const std::vector<double>& times_s, std::shared_ptr<const KnotPlaces> places) {
  std::vector<double> placed_s = times_s;
  for (std::size_t i = 0; places && i < times_s.size(); ++i) {
    const double before_s = times_s[i] - times_s[i > 0 ? i - 1 : 0];
    const double after_s = times_s[i + 1 < times_s.size() ? i + 1 : i] - times_s[i];
    const bool is_end = i == 0 || i + 1 == times_s.size();
    const double step_s = is_end ? before_s + after_s : std::min(before_s, after_s);
    placed_s[i] = places->place_s(times_s[i], step_s);
  }
  KnotRow row(placed_s.front(), placed_s.back(), static_cast<int>(times_s.size()) - 1,
              std::move(places));
  row.given_s = std::make_shared<const std::vector<double>>(std::move(placed_s));
  return row;
}

double KnotRow::knot_s(int index) const {
  if (index == 0) return begin_s;
  if (index == count) return end_s;
  if (given_s && index > 0 && index < count) return (*given_s)[static_cast<std::size_t>(index)];
  const double time_s = begin_s + (end_s - begin_s) * (static_cast<double>(index) / count);
  return places ? places->place_s(time_s, spacing_s()) : time_s;
}

bool KnotRow::fits() const {
  const TimeOrigin origin = places ? places->origin : TimeOrigin{};
  const double finest_s = std::max(origin.resolution_s(begin_s), origin.resolution_s(end_s));
  double shortest_s = spacing_s();
  for (std::size_t i = 1; given_s && i < given_s->size(); ++i) {
    shortest_s = std::min(shortest_s, (*given_s)[i] - (*given_s)[i - 1]);
  }
  return shortest_s >= kLeastTimesAStep * finest_s;
}

KnotBump KnotRow::bump(int index) const {
  return KnotBump(
      {knot_s(index - 2), knot_s(index - 1), knot_s(index), knot_s(index + 1), knot_s(index + 2)});
}

double KnotRow::bump_at_knot(int bump, int knot) const {
  const int place = knot - bump + 2;
  if (place <= 0 || place >= 4) return 0.0;
  return this->bump(bump).pieces[static_cast<std::size_t>(place)][0];
}

KnotBump::KnotBump(const std::array<double, 5>& knots)
    : knots_s(knots), pieces(b_spline_pieces(knots)) {}

std::optional<std::pair<std::size_t, double>> KnotBump::place_of(double time_s) const {
  if (time_s <= knots_s.front() || time_s >= knots_s.back()) return std::nullopt;
  const auto next = std::ranges::upper_bound(knots_s, time_s);
  const auto piece = static_cast<std::size_t>(next - knots_s.begin()) - 1;
  return std::pair{piece, (time_s - knots_s[piece]) / (knots_s[piece + 1] - knots_s[piece])};
}

double KnotBump::value(double time_s) const {
  const auto place = place_of(time_s);
  return place ? bezier::value_at(pieces[place->first], place->second) : 0.0;
}

double KnotBump::first_derivative(double time_s) const {
  const auto place = place_of(time_s);
  if (!place) return 0.0;
  const auto& [piece, u] = *place;
  const std::array<double, 4>& b = pieces[piece];
  const std::array<double, 3> steps = {b[1] - b[0], b[2] - b[1], b[3] - b[2]};
  return 3.0 * bezier::value_at(steps, u) / (knots_s[piece + 1] - knots_s[piece]);
}

double KnotBump::second_derivative(double time_s) const {
  const auto place = place_of(time_s);
  if (!place) return 0.0;
  const auto& [piece, u] = *place;
  const std::array<double, 4>& b = pieces[piece];
  const double step_s = knots_s[piece + 1] - knots_s[piece];
  const double bent = (1.0 - u) * (b[0] - 2.0 * b[1] + b[2]) + u * (b[1] - 2.0 * b[2] + b[3]);
  return 6.0 * bent / (step_s * step_s);
}

// The blossom b of the spline is 1 at the three inner knots, and 0 at the three first and the three
// last of the five knots, and at those before and after. Each other value lies between two of these
// values, by the ratio of knots.
std::array<std::array<double, 4>, 4> b_spline_pieces(const std::array<double, 5>& knots) {
  const auto [a, b, c, d, e] = knots;
  const double bbc = (b - a) / (d - a);
  const double bcc = (c - a) / (d - a);
  const double ccd = (e - c) / (e - b);
  const double cdd = (e - d) / (e - b);
  const double bbb = (b - a) / (c - a) * bbc;
  const double ccc = ((d - c) * bcc + (c - b) * ccd) / (d - b);
  const double ddd = (e - d) / (e - c) * cdd;
  return {{{0.0, 0.0, 0.0, bbb}, {bbb, bbc, bcc, ccc}, {ccc, ccd, cdd, ddd}, {ddd, 0.0, 0.0, 0.0}}};
}

}  // namespace camway::motion
