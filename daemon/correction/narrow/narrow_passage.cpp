// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/narrow_passage.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <utility>

#include "daemon/correction/narrow/centering.h"
#include "daemon/correction/narrow/corridor.h"
#include "daemon/correction/narrow/hole_line.h"
#include "daemon/correction/narrow/hole_motion.h"
#include "daemon/correction/narrow/least_turn.h"
#include "daemon/correction/narrow/way_places.h"
#include "daemon/correction/path/polyline.h"

namespace camway::correction {

namespace {

using geometry::Quat;
using geometry::Vec3;
using motion::SignedPose;

// Chosen by measurement; none changes what is proved. Lengths are shares of the ball's radius.
constexpr double kHalfLength = 0.7;  // half length of the line on which a pose must fit
constexpr std::array<double, 3> kFirstHalfLengths = {kHalfLength, 0.2, 0.05};
constexpr double kGrowth = 1.5;  // factor of the length per iteration
constexpr double kLongest = 3.5;
constexpr std::array<double, 3> kMiddles = {0.5, 0.25, 0.75};  // places in a narrow range
constexpr double kLeastRoom = 0.01;                            // of the ball where it fits
constexpr double kWide = 0.9;               // room from which a line counts as not narrow
constexpr std::size_t kMostTried = 24;      // fitting poses from which a motion is tried
constexpr std::size_t kMostThinTried = 24;  // poses of scaled-down bodies that grow
constexpr double kFarthest = 3.0;  // motion to either side, unless the narrow place is longer

class Threader {
 public:
  Threader(FreeSpace& space, const SignedPose& from, const SignedPose& to,
           std::span<const motion::Pose> interpolated, double margin_m,
           const base::Deadline& deadline)
      : space_(space),
        from_(from),
        to_(to),
        margin_m_(margin_m),
        deadline_(deadline),
        radius_m_(space.ball_radius_m()),
        least_turn_(space, from_, to_, interpolated, margin_m, deadline) {}

  /// Returns a motion along the narrow place `way_W`.
  std::optional<NarrowPassage> through(std::span<const Vec3> way_W) {
    way_W_ = way_W;
    farthest_m_ = std::max(kFarthest * radius_m_, length_m(way_W));
    const Vec3 along_W = (way_W.back() - way_W.front()).stableNormalized();
    std::vector<Vec3> middles_W = {tightest(space_, way_W)};
    for (const double share : kMiddles) {
      const auto at = static_cast<std::size_t>(share * static_cast<double>(way_W.size()));
      middles_W.push_back(way_W[at]);
    }
    // A motion along a wall beside the narrow place does not lead through it.
    std::optional<Guide> beside;
    for (const Vec3& middle_W : middles_W) {
      for (const double half_length : kFirstHalfLengths) {
        std::optional<Guide> found = along_grown(middle_W, along_W, half_length);
        if (!found) continue;
        if (leads_through(*found, way_W, space_)) return NarrowPassage{*std::move(found)};
        if (!beside) beside = std::move(found);
      }
    }
    std::optional<Guide> found =
        fitted_in(line_about(space_, middles_W.front(), along_W, kHalfLength));
    if (!found) found = std::move(beside);
    return found ? std::optional(NarrowPassage{*std::move(found)}) : std::nullopt;
  }

 private:
  /// Returns a motion along a line that is shifted to where it has room, and grows: a longer line
  /// shows better where a hole leads.
  std::optional<Guide> along_grown(Vec3 center_W, Vec3 along_W, double half_length) {
    for (; half_length < kLongest && !deadline_.passed(); half_length *= kGrowth) {
      HoleLine line = line_about(space_, center_W, along_W, half_length);
      if (!(room_m(space_, line) > 0.0)) return std::nullopt;
      line = widened(space_, line);
      if (room_m(space_, line) > kWide * radius_m_) return std::nullopt;
      center_W = line.center_W();
      along_W = line.direction_W();
      if (half_length < kHalfLength) continue;
      const Vec3 place_W = tightest(space_, places_on(line));
      if (auto found = along(line_about(space_, place_W, along_W, kHalfLength))) return found;
    }
    return std::nullopt;
  }

  std::optional<Guide> along(const HoleLine& line) {
    const std::vector<Side> sides = sides_of(space_, line);
    const LinePlace place{line, shifts_of(sides.front(), sides[kSides / 4]), way_W_, farthest_m_};
    if (std::optional<Guide> unturned = least_turn_.unturned(place)) return unturned;
    for (const SignedLikeEnds& fit : fitting(line, sides)) {
      if (deadline_.passed()) return std::nullopt;
      std::optional<Guide> found =
          straight_passage(space_, fit.pose, line.direction_W(), farthest_m_, margin_m_);
      if (!found) continue;
      if (!leads_through(*found, way_W_, space_)) return found;
      return least_turn_.reduced(place, *std::move(found));
    }
    return std::nullopt;
  }

  /// Returns a motion through the narrow place in which the middle of `line` is, from a pose that
  /// fits only if the body is turned more finely than `fitting` does.
  std::optional<Guide> fitted_in(const HoleLine& line) {
    Fitter fitter(space_, deadline_);
    for (const ThinFit& fit : thin_fits(widened(space_, line), fitter)) {
      if (deadline_.passed()) return std::nullopt;
      const std::optional<Centered> found = fitter.fitted(fit.pose);
      if (!found) continue;
      const SignedPose pose = signed_as_ends(found->pose, from_, to_).pose;
      const double margin_m = std::min(margin_m_, kMarginOfGap * found->gap_m);
      std::optional<Guide> poses = corridor(space_, pose, line.direction_W(), margin_m, deadline_);
      if (poses && leads_through(*poses, way_W_, space_)) return poses;
    }
    return std::nullopt;
  }

  struct ThinFit {
    double worth;     ///< scale of the body that is free at the pose, less a share of the distance
    double likeness;  ///< cosine to the less similar end orientation
    motion::Pose pose;
  };

  /// The poses at which scaled-down bodies are free, the largest first.
  [[nodiscard]] std::vector<ThinFit> thin_fits(const HoleLine& line, Fitter& fitter) {
    std::vector<ThinFit> fits;
    const std::vector<Side> sides = sides_of(space_, line);
    for_each_orientation(
        line, sides, [&](const Quat& orientation, const Side& side, const Side& other) {
          ThinFit best{0.0, 0.0, {}};
          for (const Vec3& shift_W : shifts_of(side, other)) {
            const motion::Pose pose = space_.pose_around(line.center_W() + shift_W, orientation);
            // Where the body is free, `fitting` has been there.
            const double scale = fitter.free_scale(pose);
            if (scale == 1.0) continue;
            const double worth = scale - kBesideLine * shift_W.norm() / radius_m_;
            if (scale == 0.0 || worth <= best.worth) continue;
            best = {worth, signed_as_ends(pose, from_, to_).likeness, pose};
          }
          if (best.worth > 0.0) fits.push_back(best);
        });
    std::ranges::stable_sort(fits, [](const ThinFit& a, const ThinFit& b) {
      return a.worth != b.worth ? a.worth > b.worth : a.likeness > b.likeness;
    });
    if (fits.size() > kMostThinTried) fits.resize(kMostThinTried);
    return fits;
  }

  /// Free poses with an axis of the body along the line, on it or in the middle of the free space
  /// beside it; least turned first.
  [[nodiscard]] std::vector<SignedLikeEnds> fitting(const HoleLine& line,
                                                    std::span<const Side> sides) {
    std::vector<SignedLikeEnds> fits;
    for_each_orientation(
        line, sides, [&](const Quat& orientation, const Side& side, const Side& other) {
          const std::optional<Vec3> place_W = fitting_place_W(line, orientation, side, other);
          if (!place_W) return;
          fits.push_back(signed_as_ends(space_.pose_around(*place_W, orientation), from_, to_));
        });
    std::ranges::stable_sort(fits, std::greater(), &SignedLikeEnds::likeness);
    if (fits.size() > kMostTried) fits.resize(kMostTried);
    return fits;
  }

  /// Calls `use` for orientations with an axis of the body along the line: each axis, either way,
  /// rotated about the line step by step. `side` and `other` are across the line.
  template <class Use>
  void for_each_orientation(const HoleLine& line, std::span<const Side> sides,
                            const Use& use) const {
    const Vec3 along_W = line.direction_W();
    for (const auto& [first, second] : {std::pair{0, 1}, {1, 2}, {2, 0}}) {
      for (std::size_t i = 0; i < 2 * kSides && !deadline_.passed(); ++i) {
        const Vec3 first_W = i < kSides ? along_W : Vec3(-along_W);
        const Side& side = sides[i % kSides];
        const Side& other = sides[(i + kSides / 4) % kSides];
        Eigen::Matrix3d axes_W;
        axes_W.col(first) = first_W;
        axes_W.col(second) = side.direction_W;
        axes_W.col(3 - first - second) = first_W.cross(side.direction_W);
        use(Quat(axes_W), side, other);
      }
    }
  }

  [[nodiscard]] std::optional<Vec3> fitting_place_W(const HoleLine& line, const Quat& orientation,
                                                    const Side& side, const Side& other) {
    for (const Vec3& shift_W : shifts_of(side, other)) {
      const std::array<Vec3, 3> places_W = {line.center_W() + shift_W, line.begin_W + shift_W,
                                            line.end_W + shift_W};
      const bool fits = std::ranges::all_of(places_W, [&](const Vec3& place_W) {
        return space_.is_free(space_.pose_around(place_W, orientation), margin_m_);
      });
      if (fits) return places_W.front();
    }
    return std::nullopt;
  }

  FreeSpace& space_;
  const SignedPose from_;
  const SignedPose to_;
  const double margin_m_;
  const base::Deadline& deadline_;
  const double radius_m_;
  LeastTurn least_turn_;
  std::span<const Vec3> way_W_;  ///< the way through the narrow place
  double farthest_m_ = 0.0;      ///< largest motion to either side
};

/// Ranges where the ball does not fit. Leaves out those at the ends of the way: the body is there
/// already.
std::vector<PlaceRange> narrow_places(const FreeSpace& space, std::span<const WayPlace> places) {
  const double radius_m = space.ball_radius_m();
  const double comfort_m = kLeastRoom * radius_m;
  return inner_ranges(places.size(), [&](std::size_t place) {
    return !(space.ball_gap_m(places[place].at_W, radius_m, comfort_m) > 0.0);
  });
}

}  // namespace

std::vector<NarrowPassage> narrow_passages(FreeSpace& space, std::span<const Vec3> way_W,
                                           const SignedPose& from, const SignedPose& to,
                                           std::span<const motion::Pose> interpolated,
                                           double margin_m, const base::Deadline& deadline) {
  if (way_W.size() < 2 || is_limited(space.policy())) return {};
  const std::vector<WayPlace> places = places_on_way(way_W, space.ball_radius_m());
  Threader threader(space, from, to, interpolated, margin_m, deadline);
  std::vector<NarrowPassage> passages;
  for (const PlaceRange& narrow : narrow_places(space, places)) {
    if (deadline.passed()) return {};
    std::optional<NarrowPassage> found = threader.through(with_neighbours_W(places, narrow));
    if (!found) return {};
    found->first = places[narrow.begin - 1].leg;
    found->last = places[narrow.end].leg + 1;
    passages.push_back(*found);
  }
  return passages;
}

}  // namespace camway::correction
