// SPDX-License-Identifier: MIT
#include "daemon/correction/search/narrow_passage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "daemon/correction/path/orientation_rule.h"

namespace camway::correction {

namespace {

using geometry::Quat;
using geometry::Vec3;
using motion::SignedPose;

// Chosen by measurement; none changes what is proved. Lengths are shares of the ball's radius.
constexpr double kStep = 0.25;       // spacing of the places on a way that are checked
constexpr double kMostPlaces = 4e3;  // longer ways are skipped
constexpr double kApart = 2.0;       // narrow places closer to each other are one
constexpr double kHalfLength = 0.7;  // half length of the line on which a pose must fit
constexpr std::array<double, 3> kFirstHalfLengths = {kHalfLength, 0.2, 0.05};
constexpr double kGrowth = 1.5;  // factor of the length per iteration
constexpr double kLongest = 3.5;
constexpr std::array<double, 3> kMiddles = {0.5, 0.25, 0.75};  // places in a narrow range
constexpr double kFirstShift = 0.4;                            // shift of the ends of a line
constexpr double kLeastShift = 0.01;
constexpr double kMostTurn = 0.25;  // share of the length: shift of one end alone
constexpr int kMostShifts = 200;
constexpr double kWide = 0.9;  // room from which a line counts as not narrow
constexpr int kPlaces = 16;    // places on the line, to find the tightest
constexpr std::size_t kTurns =
    48;                         // orientations about the line in a full turn; a multiple of four
constexpr int kMostSteps = 32;  // to find the free space beside the line
constexpr std::size_t kMostTried = 24;  // fitting poses from which a motion is tried
constexpr double kFarthest = 3.0;       // motion to either side, unless the narrow place is longer
constexpr double kNearest = 1.05;       // least motion that leaves a thin wall

/// A line segment, shifted to where it has the most room.
struct Line {
  Vec3 begin_W;
  Vec3 end_W;

  [[nodiscard]] Vec3 center_W() const { return 0.5 * (begin_W + end_W); }
  [[nodiscard]] double length_m() const { return (end_W - begin_W).norm(); }
  [[nodiscard]] Vec3 direction_W() const { return (end_W - begin_W).normalized(); }
};

/// A direction across a line, and the vector from the line to the middle of the free space in that
/// direction.
struct Side {
  Vec3 direction_W;
  Vec3 to_middle_W;
};

class Threader {
 public:
  Threader(FreeSpace& space, const SignedPose& from, const SignedPose& to, double margin_m,
           const base::Deadline& deadline)
      : space_(space),
        from_(from),
        to_(to),
        margin_m_(margin_m),
        deadline_(deadline),
        radius_m_(space.ball_radius_m()) {}

  /// Returns a motion along the narrow place `way_W`.
  std::optional<NarrowPassage> through(std::span<const Vec3> way_W) {
    farthest_m_ = std::max(kFarthest * radius_m_, length_m(way_W));
    const Vec3 along_W = (way_W.back() - way_W.front()).stableNormalized();
    std::vector<Vec3> middles_W = {tightest(way_W)};
    for (const double share : kMiddles) {
      const auto at = static_cast<std::size_t>(share * static_cast<double>(way_W.size()));
      middles_W.push_back(way_W[at]);
    }
    for (const Vec3& middle_W : middles_W) {
      for (const double half_length : kFirstHalfLengths) {
        if (auto found = along_grown(middle_W, along_W, half_length)) return found;
      }
    }
    return std::nullopt;
  }

 private:
  static double length_m(std::span<const Vec3> way_W) {
    double sum_m = 0.0;
    for (std::size_t i = 1; i < way_W.size(); ++i) sum_m += (way_W[i] - way_W[i - 1]).norm();
    return sum_m;
  }

  static SignedPose moved(const SignedPose& pose, const Vec3& by_W) {
    return {pose.position + by_W, pose.orientation};
  }

  [[nodiscard]] Line line_about(const Vec3& center_W, const Vec3& along_W,
                                double half_length) const {
    const Vec3 half_W = half_length * radius_m_ * along_W;
    return {center_W - half_W, center_W + half_W};
  }

  /// Returns a motion along a line that is shifted to where it has room, and grows: a longer line
  /// shows better where a hole leads.
  std::optional<NarrowPassage> along_grown(Vec3 center_W, Vec3 along_W, double half_length) {
    for (; half_length < kLongest && !deadline_.passed(); half_length *= kGrowth) {
      Line line = line_about(center_W, along_W, half_length);
      if (!(room_m(line) > 0.0)) return std::nullopt;
      line = widened(line);
      if (room_m(line) > kWide * radius_m_) return std::nullopt;
      center_W = line.center_W();
      along_W = line.direction_W();
      if (half_length < kHalfLength) continue;
      const Vec3 place_W = tightest(places_on(line));
      if (auto found = along(line_about(place_W, along_W, kHalfLength))) return found;
    }
    return std::nullopt;
  }

  std::optional<NarrowPassage> along(const Line& line) {
    const Vec3 along_W = line.direction_W();
    for (const auto& [likeness, pose] : fitting(line)) {
      if (deadline_.passed()) return std::nullopt;
      const double back_m = freely_moved_m(pose, -along_W);
      if (back_m < kNearest * radius_m_) continue;
      const double forth_m = freely_moved_m(pose, along_W);
      if (forth_m < kNearest * radius_m_) continue;
      return NarrowPassage{moved(pose, -back_m * along_W), moved(pose, forth_m * along_W)};
    }
    return std::nullopt;
  }

  [[nodiscard]] Vec3 tightest(std::span<const Vec3> places_W) const {
    Vec3 place_W = places_W.front();
    double least_m = std::numeric_limits<double>::infinity();
    for (const Vec3& next_W : places_W) {
      const double room_m = room_about_m(next_W);
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

  [[nodiscard]] double room_about_m(const Vec3& place_W) const {
    return space_.way_gap_m(place_W, place_W, radius_m_);
  }
  [[nodiscard]] double room_m(const Line& line) const {
    return space_.way_gap_m(line.begin_W, line.end_W, radius_m_);
  }

  /// Shifts the ends of the line to where there is more room.
  [[nodiscard]] Line widened(Line line) const {
    double best_m = room_m(line);
    double shift_m = kFirstShift * radius_m_;
    const double most_turn_m = kMostTurn * line.length_m();
    for (int shifts = 0; shift_m > kLeastShift * radius_m_ && shifts < kMostShifts;) {
      const Vec3 along_W = line.direction_W();
      const Vec3 across_W = along_W.unitOrthogonal();
      const Vec3 other_W = along_W.cross(across_W);
      bool any = false;
      for (const Vec3& side_W : {across_W, Vec3(-across_W), other_W, Vec3(-other_W)}) {
        // Shift both ends, or one, which turns the line; a short line must not turn much. Shift no
        // farther than there is room: the space behind a wall may not be on the way.
        for (const auto& [begin, end] : {std::pair{1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}}) {
          ++shifts;
          const double by_m = std::min({shift_m, best_m, begin == end ? best_m : most_turn_m});
          const Line next{line.begin_W + begin * by_m * side_W, line.end_W + end * by_m * side_W};
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

  struct Fit {
    double likeness;  ///< cosine to the less similar end orientation
    SignedPose pose;
  };

  /// Free poses with an axis of the body along the line, on it or in the middle of the free space
  /// beside it; least turned first.
  [[nodiscard]] std::vector<Fit> fitting(const Line& line) {
    const std::vector<Side> sides = sides_of(line);
    const Vec3 along_W = line.direction_W();
    std::vector<Fit> fits;
    for (const auto& [first, second] : {std::pair{0, 1}, {1, 2}, {2, 0}}) {
      for (std::size_t i = 0; i < 2 * kTurns && !deadline_.passed(); ++i) {
        const Vec3 first_W = i < kTurns ? along_W : Vec3(-along_W);
        const Side& side = sides[i % kTurns];
        const Side& other = sides[(i + kTurns / 4) % kTurns];
        Eigen::Matrix3d axes_W;
        axes_W.col(first) = first_W;
        axes_W.col(second) = side.direction_W;
        axes_W.col(3 - first - second) = first_W.cross(side.direction_W);
        const std::optional<Vec3> place_W = fitting_place_W(line, Quat(axes_W), side, other);
        if (place_W) fits.push_back(signed_as_ends(space_.pose_around(*place_W, Quat(axes_W))));
      }
    }
    std::ranges::stable_sort(fits, std::greater(), &Fit::likeness);
    if (fits.size() > kMostTried) fits.resize(kMostTried);
    return fits;
  }

  [[nodiscard]] std::optional<Vec3> fitting_place_W(const Line& line, const Quat& orientation,
                                                    const Side& side, const Side& other) {
    const Vec3 both_W = side.to_middle_W + other.to_middle_W;
    for (const Vec3& shift_W : {Vec3(Vec3::Zero()), side.to_middle_W, other.to_middle_W, both_W}) {
      const std::array<Vec3, 3> places_W = {line.center_W() + shift_W, line.begin_W + shift_W,
                                            line.end_W + shift_W};
      const bool fits = std::ranges::all_of(places_W, [&](const Vec3& place_W) {
        return space_.is_free(space_.pose_around(place_W, orientation), margin_m_);
      });
      if (fits) return places_W.front();
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<Side> sides_of(const Line& line) const {
    const Vec3 across_W = line.direction_W().unitOrthogonal();
    std::array<Vec3, kTurns> directions_W;
    std::array<double, kTurns> free_m;
    for (std::size_t i = 0; i < kTurns; ++i) {
      const double angle_rad = 2.0 * std::numbers::pi * static_cast<double>(i) / kTurns;
      directions_W[i] = Eigen::AngleAxisd(angle_rad, line.direction_W()) * across_W;
      free_m[i] = free_way_m(line.center_W(), directions_W[i]);
    }
    std::vector<Side> sides;
    for (std::size_t i = 0; i < kTurns; ++i) {
      const double shift_m = 0.5 * (free_m[i] - free_m[(i + kTurns / 2) % kTurns]);
      sides.push_back({directions_W[i], shift_m * directions_W[i]});
    }
    return sides;
  }

  /// About the distance from a place to the scene in that direction, at most the body's diameter.
  [[nodiscard]] double free_way_m(const Vec3& place_W, const Vec3& direction_W) const {
    double way_m = 0.0;
    for (int i = 0; i < kMostSteps && way_m < 2.0 * radius_m_; ++i) {
      const double room_m = room_about_m(place_W + way_m * direction_W);
      if (room_m < kLeastShift * radius_m_) break;
      way_m += room_m;
    }
    return way_m;
  }

  [[nodiscard]] Fit signed_as_ends(const motion::Pose& pose) const {
    SignedPose result = motion::signed_pose(pose);
    const double from = result.orientation.dot(from_.orientation);
    const double to = result.orientation.dot(to_.orientation);
    if (from + to >= 0.0) return {std::min(from, to), result};
    result.orientation *= -1.0;
    return {std::min(-from, -to), result};
  }

  /// How far the body can move in that direction.
  [[nodiscard]] double freely_moved_m(const SignedPose& pose, const Vec3& direction_W) {
    const std::optional<double> hit =
        space_.first_hit(pose, moved(pose, farthest_m_ * direction_W), margin_m_);
    return farthest_m_ * (hit ? 0.9 * *hit : 1.0);
  }

  FreeSpace& space_;
  const SignedPose from_;
  const SignedPose to_;
  const double margin_m_;
  const base::Deadline& deadline_;
  const double radius_m_;
  double farthest_m_ = 0.0;  ///< largest motion to either side
};

/// A place on a way, and the index of the way's point before it.
struct WayPlace {
  Vec3 at_W;
  std::size_t leg;
};

/// Places on `way_W` at most `step_m` apart; empty if they were too many.
std::vector<WayPlace> places_of(std::span<const Vec3> way_W, double step_m) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < way_W.size(); ++i) length_m += (way_W[i] - way_W[i - 1]).norm();
  if (!(length_m <= kMostPlaces * step_m)) return {};
  std::vector<WayPlace> places = {{way_W.front(), 0}};
  for (std::size_t i = 1; i < way_W.size(); ++i) {
    const int parts = 1 + static_cast<int>((way_W[i] - way_W[i - 1]).norm() / step_m);
    for (int k = 1; k <= parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      places.push_back({(1.0 - share) * way_W[i - 1] + share * way_W[i], i - 1});
    }
  }
  return places;
}

/// A range of places, from `begin` to before `end`.
struct Narrow {
  std::size_t begin;
  std::size_t end;
};

/// Ranges where the ball does not fit. Leaves out those at the ends of the way: the body is there
/// already.
std::vector<Narrow> narrow_places(const FreeSpace& space, std::span<const WayPlace> places) {
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
                                           double margin_m, const base::Deadline& deadline) {
  if (way_W.size() < 2 || !space.may_turn() || is_limited(space.policy())) return {};
  const std::vector<WayPlace> places = places_of(way_W, kStep * space.ball_radius_m());
  Threader threader(space, from, to, margin_m, deadline);
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
