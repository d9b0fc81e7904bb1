// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/kept_guide.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "daemon/correction/narrow/centering.h"
#include "daemon/correction/narrow/corridor.h"
#include "daemon/correction/narrow/hole_line.h"
#include "daemon/correction/narrow/hole_motion.h"
#include "daemon/correction/narrow/way_places.h"

namespace camway::correction {

namespace {

using geometry::Vec3;
using motion::SignedPose;

// Chosen by measurement; none changes what is proved.
constexpr std::array<double, 2> kHalfLengths = {0.5, 0.05};  // of lines, in radii of the ball
constexpr std::size_t kPlacesToGoal = 8;                     // from the last narrow place, at most
constexpr double kPulledBall = 0.04;  // ball for which a way is pulled tight, in radii of the ball
constexpr double kMarginBetween = 0.1;  // margin between narrow places, relative to that in them

class KeptPassage {
 public:
  /// `goals`: the poses at the ends of `way_W`. `middle`: a pose with the orientation between them.
  KeptPassage(FreeSpace& space, std::span<const Vec3> way_W, const CorridorGoals& goals,
              const SignedPose& middle, double margin_m, const base::Deadline& deadline)
      : space_(space),
        way_W_(way_W),
        along_W_((way_W.back() - way_W.front()).stableNormalized()),
        goals_(goals),
        middle_(middle),
        margin_m_(margin_m),
        deadline_(deadline),
        fitter_(space, deadline) {}

  std::optional<Guide> run() {
    for (const Vec3& middle_W : {way_W_[way_W_.size() / 2], tightest(space_, way_W_)}) {
      if (deadline_.passed()) return std::nullopt;
      const std::optional<HoleLine> line = widest_line(middle_W);
      const std::optional<motion::Pose> place = line ? best_place(*line) : std::nullopt;
      if (!place) continue;
      if (std::optional<Guide> found = from(*place)) return found;
    }
    return std::nullopt;
  }

 private:
  // The longest line about `middle_W` that has room somewhere beside it.
  [[nodiscard]] std::optional<HoleLine> widest_line(const Vec3& middle_W) const {
    for (const double half_length : kHalfLengths) {
      const HoleLine line = widened(space_, line_about(space_, middle_W, along_W_, half_length));
      if (room_m(space_, line) > 0.0) return line;
    }
    return std::nullopt;
  }

  // The place of the body on the line or beside it where the largest scaled-down body is free.
  [[nodiscard]] std::optional<motion::Pose> best_place(const HoleLine& line) {
    const std::vector<Side> sides = sides_of(space_, line);
    const geometry::Quat orientation = geometry::from_wxyz(middle_.orientation);
    std::optional<motion::Pose> best;
    double best_worth = -std::numeric_limits<double>::infinity();
    const auto look_at = [&](const Vec3& shift_W) {
      const motion::Pose pose = space_.pose_around(line.center_W() + shift_W, orientation);
      const double scale = fitter_.free_scale(pose);
      const double worth = scale - kBesideLine * shift_W.norm() / space_.ball_radius_m();
      if (scale == 0.0 || worth <= best_worth) return;
      best_worth = worth;
      best = pose;
    };
    look_at(Vec3::Zero());
    for (std::size_t i = 0; i < kSides / 4; ++i) {
      const Vec3& side_W = sides[i].to_middle_W;
      const Vec3& other_W = sides[i + kSides / 4].to_middle_W;
      look_at(side_W);
      look_at(other_W);
      look_at(side_W + other_W);
    }
    return best;
  }

  // A motion to both sides from where the body fits near `place`, if it leads along the way.
  [[nodiscard]] std::optional<Guide> from(const motion::Pose& place) {
    const std::optional<Centered> fitted = fitter_.fitted(place);
    if (!fitted) return std::nullopt;
    const double margin_m = std::min(margin_m_, kMarginOfGap * fitted->gap_m);
    const SignedPose middle = motion::signed_like(fitted->pose, middle_);
    std::optional<Guide> found = corridor(space_, middle, along_W_, margin_m, deadline_, &goals_);
    return found && leads_through(*found, way_W_, space_) ? std::move(found) : std::nullopt;
  }

  FreeSpace& space_;
  const std::span<const Vec3> way_W_;
  const Vec3 along_W_;
  const CorridorGoals goals_;
  const SignedPose middle_;
  const double margin_m_;
  const base::Deadline& deadline_;
  Fitter fitter_;
};

/// The poses of the body at the places, with the orientations of the interpolated path and signs
/// that go on from `from`.
std::vector<SignedPose> poses_at(std::span<const WayPlace> places, const FreeSpace& space,
                                 const SignedPose& from,
                                 std::span<const motion::Pose> interpolated) {
  std::vector<SignedPose> poses;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(places.size() - 1);
    const geometry::Quat orientation = pose_at_share(interpolated, share).orientation;
    const SignedPose& before = poses.empty() ? from : poses.back();
    poses.push_back(motion::signed_like(space.pose_around(places[i].at_W, orientation), before));
  }
  return poses;
}

/// A guide that grows by poses to which straight motions are free.
class GrowingGuide {
 public:
  GrowingGuide(FreeSpace& space, const SignedPose& from, double margin_m)
      : space_(space), margin_m_(margin_m), guide_{from} {}

  [[nodiscard]] bool add(std::span<const SignedPose> poses) {
    return std::ranges::all_of(poses, [&](const SignedPose& pose) {
      if (!space_.passes(guide_.back(), pose, margin_m_)) return false;
      guide_.push_back(pose);
      return true;
    });
  }
  /// Adds a motion that is known to be free, from where a straight motion leads to its beginning.
  [[nodiscard]] bool add_free(const Guide& motion) {
    if (!add({&motion.front(), 1})) return false;
    guide_.insert(guide_.end(), motion.begin() + 1, motion.end());
    return true;
  }
  [[nodiscard]] const Guide& guide() const { return guide_; }

 private:
  FreeSpace& space_;
  const double margin_m_;
  Guide guide_;
};

}  // namespace

std::optional<Guide> kept_guide(FreeSpace& space, std::span<const Vec3> way_W,
                                const SignedPose& from, const SignedPose& to,
                                std::span<const motion::Pose> interpolated, double margin_m,
                                const base::Deadline& deadline) {
  const double radius_m = space.ball_radius_m();
  const std::vector<Vec3> pulled_W = pulled_tight(space, way_W, kPulledBall * radius_m);
  const std::vector<WayPlace> places = places_on_way(pulled_W, radius_m);
  if (places.size() < 2) return std::nullopt;
  std::vector<SignedPose> poses = poses_at(places, space, from, interpolated);
  poses.front() = from;
  poses.back() = to;
  const auto is_narrow = [&](std::size_t place) {
    return !space.is_free(motion::unsigned_pose(poses[place]), margin_m);
  };
  GrowingGuide grown(space, from, kMarginBetween * margin_m);
  std::size_t last = 0;  // the place up to which the guide leads
  for (const PlaceRange& narrow : inner_ranges(places.size(), is_narrow)) {
    const std::size_t before = std::max(last, narrow.begin - std::min(narrow.begin, kPlacesToGoal));
    const std::size_t behind = std::min(narrow.end - 1 + kPlacesToGoal, places.size() - 1);
    const std::span<const SignedPose> all(poses);
    if (!grown.add(all.subspan(last + 1, before - last))) return std::nullopt;
    const std::vector<Vec3> stretch_W = with_neighbours_W(places, narrow);
    const SignedPose& middle = poses[(narrow.begin + narrow.end) / 2];
    const std::optional<Guide> passage =
        KeptPassage(space, stretch_W, {poses[before], poses[behind]}, middle, margin_m, deadline)
            .run();
    if (!passage || !grown.add_free(*passage) || !grown.add({&poses[behind], 1})) {
      return std::nullopt;
    }
    last = behind;
  }
  if (!grown.add(std::span<const SignedPose>(poses).subspan(last + 1))) return std::nullopt;
  return shortened(grown.guide(), space, kMarginBetween * margin_m);
}

}  // namespace camway::correction
