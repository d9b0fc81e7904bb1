// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow_passage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "daemon/correction/orientation_rule.h"

namespace camway::correction {

namespace {

using geometry::Quat;
using geometry::Vec3;
using motion::SignedPose;

// Chosen by measurement; none changes what is proved. Lengths are shares of the ball's radius.
constexpr double kStep = 0.25;       // between the places of a way that are looked at
constexpr double kMostPlaces = 4e3;  // longer ways are not looked at
constexpr double kApart = 2.0;       // narrow places closer to each other are one
constexpr double kHalfLength = 0.7;  // of the line that is to have room
constexpr double kFirstShift = 0.4;  // of its ends
constexpr double kLeastShift = 0.01;
constexpr int kMostShifts = 200;
constexpr double kAsMuch = 0.9;         // of the room: not worth a difference
constexpr int kSides = 4;               // to which a line is centred
constexpr int kPlaces = 16;             // of the line, to find where it is tightest
constexpr int kTurns = 48;              // about the line, in a full turn
constexpr std::size_t kMostTried = 24;  // poses that fit, from which the body is moved
constexpr double kFarthest = 3.0;       // that it is moved to either side
constexpr double kNearest = 1.05;       // the least that takes it out of a thin wall

/// A line with as much room about it as was found.
struct Line {
  Vec3 begin_W;
  Vec3 end_W;

  [[nodiscard]] Vec3 center_W() const { return 0.5 * (begin_W + end_W); }
  [[nodiscard]] Vec3 direction_W() const { return (end_W - begin_W).normalized(); }
};

class Threader {
 public:
  Threader(FreeSpace& space, const SignedPose& from, const SignedPose& to, double margin_m)
      : space_(space),
        from_(from),
        to_(to),
        margin_m_(margin_m),
        radius_m_(space.ball_radius_m()) {}

  /// A motion through the middle of `way_W`, where that is narrow.
  std::optional<NarrowPassage> through(std::span<const Vec3> way_W) {
    const Line line = widest(way_W);
    const Vec3 along_W = line.direction_W();
    for (const auto& [likeness, pose] : fitting(line)) {
      const double back = freely_moved(pose, -along_W);
      if (back < kNearest) continue;
      const double forth = freely_moved(pose, along_W);
      if (forth < kNearest) continue;
      return NarrowPassage{moved(pose, -back * radius_m_ * along_W),
                           moved(pose, forth * radius_m_ * along_W)};
    }
    return std::nullopt;
  }

 private:
  static SignedPose moved(const SignedPose& pose, const Vec3& by_W) {
    return {pose.position + by_W, pose.orientation};
  }

  /// Through where the way has the least room; then each end is moved to where there is more.
  [[nodiscard]] Line widest(std::span<const Vec3> way_W) const {
    const Vec3 along_W = (way_W.back() - way_W.front()).stableNormalized();
    const Line line = centered(widened(line_about(tightest(way_W), along_W)));
    return line_about(tightest(places_on(line)), line.direction_W());
  }

  [[nodiscard]] Line line_about(const Vec3& center_W, const Vec3& along_W) const {
    const Vec3 half_W = kHalfLength * radius_m_ * along_W;
    return {center_W - half_W, center_W + half_W};
  }

  [[nodiscard]] Vec3 tightest(std::span<const Vec3> places_W) const {
    Vec3 place_W = places_W.front();
    double least_m = std::numeric_limits<double>::infinity();
    for (const Vec3& next_W : places_W) {
      const double room_m = space_.way_gap_m(next_W, next_W, radius_m_);
      if (room_m >= least_m) continue;
      least_m = room_m;
      place_W = next_W;
    }
    return place_W;
  }

  static std::vector<Vec3> places_on(const Line& line) {
    std::vector<Vec3> places_W;
    for (int i = 0; i <= kPlaces; ++i)
      places_W.push_back(line.begin_W +
                         static_cast<double>(i) / kPlaces * (line.end_W - line.begin_W));
    return places_W;
  }

  [[nodiscard]] double room_m(const Line& line) const {
    return space_.way_gap_m(line.begin_W, line.end_W, radius_m_);
  }

  [[nodiscard]] Line widened(Line line) const {
    double best_m = room_m(line);
    double shift_m = kFirstShift * radius_m_;
    for (int shifts = 0; shift_m > kLeastShift * radius_m_ && shifts < kMostShifts;) {
      const Vec3 along_W = line.direction_W();
      const Vec3 across_W = along_W.unitOrthogonal();
      const Vec3 other_W = along_W.cross(across_W);
      bool any = false;
      for (const Vec3& side_W : {across_W, Vec3(-across_W), other_W, Vec3(-other_W)}) {
        // Both ends, or one: that turns the line.
        for (const auto& [begin, end] : {std::pair{1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}}) {
          ++shifts;
          const Line next{line.begin_W + begin * shift_m * side_W,
                          line.end_W + end * shift_m * side_W};
          const double next_m = room_m(next);
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

  /// To the middle of where there is about as much room: a hole that is longer than wide has it on
  /// a stretch, and turned the body may need both of its ends.
  [[nodiscard]] Line centered(Line line) const {
    const double enough_m = kAsMuch * room_m(line);
    const Vec3 across_W = line.direction_W().unitOrthogonal();
    for (int i = 0; i < kSides; ++i) {
      const double angle_rad = std::numbers::pi * i / kSides;
      const Vec3 side_W = Eigen::AngleAxisd(angle_rad, line.direction_W()) * across_W;
      const double shift_m =
          0.5 * (room_beside_m(line, side_W, enough_m) - room_beside_m(line, -side_W, enough_m));
      line = shifted(line, shift_m * side_W);
    }
    return line;
  }

  static Line shifted(const Line& line, const Vec3& by_W) {
    return {line.begin_W + by_W, line.end_W + by_W};
  }

  /// How far the line can be shifted and still has `enough_m` about it, if that ends once.
  [[nodiscard]] double room_beside_m(const Line& line, const Vec3& side_W, double enough_m) const {
    double room_m = 0.0;
    for (double step_m = 0.5 * radius_m_; step_m > kLeastShift * radius_m_; step_m *= 0.5) {
      if (this->room_m(shifted(line, (room_m + step_m) * side_W)) >= enough_m) room_m += step_m;
    }
    return room_m;
  }

  struct Fit {
    double likeness;  ///< to the end that it is less like
    SignedPose pose;
  };

  /// Poses in the middle of the line that are free along it, those that are turned least first.
  [[nodiscard]] std::vector<Fit> fitting(const Line& line) {
    const Vec3 along_W = line.direction_W();
    std::vector<Fit> fits;
    for (const Vec3& axis_C : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
      for (int step = 0; step < 2 * kTurns; ++step) {
        const Vec3 signed_C = step < kTurns ? axis_C : Vec3(-axis_C);
        const double angle_rad = 2.0 * std::numbers::pi * (step % kTurns) / kTurns;
        const Quat orientation =
            Quat(Eigen::AngleAxisd(angle_rad, along_W)) * Quat::FromTwoVectors(signed_C, along_W);
        if (!fits_on(line, orientation)) continue;
        fits.push_back(signed_as_ends(space_.pose_around(line.center_W(), orientation)));
      }
    }
    std::ranges::stable_sort(fits, std::greater(), &Fit::likeness);
    if (fits.size() > kMostTried) fits.resize(kMostTried);
    return fits;
  }

  [[nodiscard]] bool fits_on(const Line& line, const Quat& orientation) {
    const std::array<Vec3, 3> places_W = {line.center_W(), line.begin_W, line.end_W};
    return std::ranges::all_of(places_W, [&](const Vec3& place_W) {
      return space_.is_free(space_.pose_around(place_W, orientation), margin_m_);
    });
  }

  [[nodiscard]] Fit signed_as_ends(const motion::Pose& pose) const {
    SignedPose result = motion::signed_pose(pose);
    const double from = result.orientation.dot(from_.orientation);
    const double to = result.orientation.dot(to_.orientation);
    if (from + to >= 0.0) return {std::min(from, to), result};
    result.orientation *= -1.0;
    return {std::min(-from, -to), result};
  }

  /// How far the body can be moved, in radii of the ball.
  [[nodiscard]] double freely_moved(const SignedPose& pose, const Vec3& direction_W) {
    const Vec3 way_W = kFarthest * radius_m_ * direction_W;
    const std::optional<double> hit = space_.first_hit(pose, moved(pose, way_W), margin_m_);
    return kFarthest * (hit ? 0.9 * *hit : 1.0);
  }

  FreeSpace& space_;
  const SignedPose from_;
  const SignedPose to_;
  const double margin_m_;
  const double radius_m_;
};

/// A place of a way, and the point of the way before it.
struct Place {
  Vec3 at_W;
  std::size_t leg;
};

/// Nothing where they would be too many.
std::vector<Place> places_of(std::span<const Vec3> way_W, double step_m) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < way_W.size(); ++i) length_m += (way_W[i] - way_W[i - 1]).norm();
  if (!(length_m <= kMostPlaces * step_m)) return {};
  std::vector<Place> places = {{way_W.front(), 0}};
  for (std::size_t i = 1; i < way_W.size(); ++i) {
    const int parts = 1 + static_cast<int>((way_W[i] - way_W[i - 1]).norm() / step_m);
    for (int k = 1; k <= parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      places.push_back({(1.0 - share) * way_W[i - 1] + share * way_W[i], i - 1});
    }
  }
  return places;
}

/// Places of a way, from `begin` to before `end`.
struct Narrow {
  std::size_t begin;
  std::size_t end;
};

/// What is narrow at either end is none of these: the body is there, as it is turned already.
std::vector<Narrow> narrow_places(const FreeSpace& space, std::span<const Place> places) {
  const double radius_m = space.ball_radius_m();
  const double comfort_m = kLeastShift * radius_m;
  const auto apart = static_cast<std::size_t>(kApart / kStep);
  std::vector<Narrow> narrow;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (space.ball_gap_m(places[i].at_W, radius_m, comfort_m) > 0.0) continue;
    if (!narrow.empty() && i - narrow.back().end < apart) {
      narrow.back().end = i + 1;
    } else {
      narrow.push_back({i, i + 1});
    }
  }
  std::erase_if(narrow, [&](const Narrow& stretch) {
    return stretch.begin == 0 || stretch.end == places.size();
  });
  return narrow;
}

}  // namespace

std::vector<NarrowPassage> narrow_passages(FreeSpace& space, std::span<const Vec3> way_W,
                                           const SignedPose& from, const SignedPose& to,
                                           double margin_m, const collision::Deadline& deadline) {
  if (way_W.size() < 2 || !space.may_turn() || is_limited(space.policy())) return {};
  const std::vector<Place> places = places_of(way_W, kStep * space.ball_radius_m());
  Threader threader(space, from, to, margin_m);
  std::vector<NarrowPassage> passages;
  for (const Narrow& narrow : narrow_places(space, places)) {
    if (deadline.passed()) return {};
    std::vector<Vec3> stretch_W;
    for (std::size_t i = narrow.begin - 1; i <= narrow.end; ++i)
      stretch_W.push_back(places[i].at_W);
    std::optional<NarrowPassage> found = threader.through(stretch_W);
    if (!found) return {};
    found->first = places[narrow.begin - 1].leg;
    found->last = places[narrow.end].leg + 1;
    passages.push_back(*found);
  }
  return passages;
}

}  // namespace camway::correction
