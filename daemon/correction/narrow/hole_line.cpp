// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/hole_line.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <utility>

namespace camway::correction {

namespace {

using geometry::Vec3;

// Chosen by measurement; none changes what is proved. Lengths are shares of the ball's radius.
constexpr double kFirstShift = 0.4;  // shift of the ends of a line
constexpr double kLeastShift = 0.01;
constexpr double kMostTurn = 0.25;  // share of the length: shift of one end alone
constexpr int kMostShifts = 270;
constexpr int kPlaces = 16;           // places on the line
constexpr int kMostStepsBeside = 32;  // to find the free space beside the line

double room_about_m(const FreeSpace& space, const Vec3& place_W) {
  return space.way_gap_m(place_W, place_W, space.ball_radius_m());
}

/// About the distance from a place to the scene in that direction, at most the body's diameter.
double free_way_m(const FreeSpace& space, const Vec3& place_W, const Vec3& direction_W) {
  double way_m = 0.0;
  for (int i = 0; i < kMostStepsBeside && way_m < 2.0 * space.ball_radius_m(); ++i) {
    const double room_m = room_about_m(space, place_W + way_m * direction_W);
    if (room_m < kLeastShift * space.ball_radius_m()) break;
    way_m += room_m;
  }
  return way_m;
}

}  // namespace

HoleLine line_about(const FreeSpace& space, const Vec3& center_W, const Vec3& along_W,
                    double half_length) {
  const Vec3 half_W = half_length * space.ball_radius_m() * along_W;
  return {center_W - half_W, center_W + half_W};
}

double room_m(const FreeSpace& space, const HoleLine& line) {
  return space.way_gap_m(line.begin_W, line.end_W, space.ball_radius_m());
}

HoleLine widened(const FreeSpace& space, HoleLine line) {
  double best_m = room_m(space, line);
  double shift_m = kFirstShift * space.ball_radius_m();
  const double most_turn_m = kMostTurn * line.length_m();
  for (int shifts = 0; shift_m > kLeastShift * space.ball_radius_m() && shifts < kMostShifts;) {
    const Vec3 along_W = line.direction_W();
    const Vec3 across_W = along_W.unitOrthogonal();
    const Vec3 other_W = along_W.cross(across_W);
    bool any = false;
    for (const Vec3& side_W : {across_W, Vec3(-across_W), other_W, Vec3(-other_W)}) {
      // Shift both ends, or one, which turns the line; a short line must not turn much. A line that
      // leans in a slit lies between two of its edges, so it has to turn about its middle. Shift no
      // farther than there is room: the space behind a wall may not be on the way.
      for (const auto& [begin, end] : {std::pair{1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, -1.0}}) {
        ++shifts;
        const double by_m = std::min({shift_m, best_m, begin == end ? best_m : most_turn_m});
        const HoleLine next{line.begin_W + begin * by_m * side_W, line.end_W + end * by_m * side_W};
        const double next_m = room_m(space, next);
        if (!(next_m > best_m)) continue;
        line = next;
        best_m = next_m;
        any = true;
      }
    }
    if (!any) shift_m *= 0.5;
  }
  return line;
}

std::vector<Vec3> places_on(const HoleLine& line) {
  std::vector<Vec3> places_W;
  for (int i = 0; i <= kPlaces; ++i) {
    places_W.push_back(line.begin_W +
                       static_cast<double>(i) / kPlaces * (line.end_W - line.begin_W));
  }
  return places_W;
}

Vec3 tightest(const FreeSpace& space, std::span<const Vec3> places_W) {
  Vec3 place_W = places_W.front();
  double least_m = std::numeric_limits<double>::infinity();
  for (const Vec3& next_W : places_W) {
    const double room_m = room_about_m(space, next_W);
    if (room_m >= least_m) continue;
    least_m = room_m;
    place_W = next_W;
  }
  return place_W;
}

std::vector<Side> sides_of(const FreeSpace& space, const HoleLine& line) {
  const Vec3 across_W = line.direction_W().unitOrthogonal();
  std::array<Vec3, kSides> directions_W;
  std::array<double, kSides> free_m;
  for (std::size_t i = 0; i < kSides; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * static_cast<double>(i) / kSides;
    directions_W[i] = Eigen::AngleAxisd(angle_rad, line.direction_W()) * across_W;
    free_m[i] = free_way_m(space, line.center_W(), directions_W[i]);
  }
  std::vector<Side> sides;
  for (std::size_t i = 0; i < kSides; ++i) {
    const double shift_m = 0.5 * (free_m[i] - free_m[(i + kSides / 2) % kSides]);
    sides.push_back({directions_W[i], shift_m * directions_W[i]});
  }
  return sides;
}

}  // namespace camway::correction
