// SPDX-License-Identifier: MIT
#include "daemon/correction/guide.h"

#include <algorithm>
#include <cmath>

#include "daemon/motion/quaternion.h"

namespace camway::correction {

namespace {

using geometry::Vec4;
using motion::BumpRow;
using motion::CubicPoint;
using motion::SignedPose;

/// A guide by the distance travelled on it.
class Travelled {
 public:
  Travelled(const Guide& guide, const FreeSpace& space) : guide_(guide), so_far_m_(1, 0.0) {
    for (std::size_t i = 1; i < guide.size(); ++i) {
      so_far_m_.push_back(so_far_m_.back() + space.distance_m(guide[i - 1], guide[i]));
    }
  }

  /// After `share` of the whole way.
  [[nodiscard]] SignedPose at(double share) const {
    const double at_m = share * so_far_m_.back();
    const auto next = std::ranges::upper_bound(so_far_m_, at_m);
    if (next == so_far_m_.end()) return guide_.back();
    const auto i = static_cast<std::size_t>(next - so_far_m_.begin());
    const double step_m = so_far_m_[i] - so_far_m_[i - 1];
    return motion::between(guide_[i - 1], guide_[i], (at_m - so_far_m_[i - 1]) / step_m);
  }

 private:
  const Guide& guide_;
  std::vector<double> so_far_m_;
};

/// Less than half a turn by far: the straight motion between them is what is meant.
bool turns_little(const SignedPose& a, const SignedPose& b) {
  constexpr double kLeastDot = 0.3;
  return a.orientation.dot(b.orientation) > kLeastDot;
}

/// Makes the sum of the bumps zero at the keyframe by the bump that stands there: of its neighbours
/// only the one inside the window is not zero.
CubicPoint holding(const CubicPoint& neighbour) {
  const double share = -motion::kBumpShoulder / motion::kBumpPeak;
  return {share * neighbour.position, share * neighbour.image};
}

}  // namespace

SignedPose signed_pose_at(const motion::CubicPath& path, double time_s) {
  const CubicPoint point = path.at(time_s);
  const Vec4 q = motion::quaternion::multiply(
      path.reference, motion::quaternion::multiply(point.image, point.image));
  return {point.position, q / q.norm()};
}

std::optional<BumpRow> drawn_towards(const motion::CubicPath& path, const Guide& guide,
                                     const Window& window, int count, const FreeSpace& space) {
  const Travelled travelled(guide, space);
  BumpRow row{{window.begin_s, window.end_s, count}, 1, {}};
  Vec4 image = path.at(window.begin_s).image;
  for (int k = 1; k < count; ++k) {
    const CubicPoint old = path.at(row.knots.knot_s(k));
    const SignedPose wanted = travelled.at(static_cast<double>(k) / count);
    image = motion::image_of(path.reference, wanted.orientation, image);
    row.bumps.push_back({wanted.position - old.position, image * old.image.norm() - old.image});
  }
  if (image.dot(path.at(window.end_s).image) <= 0.0) return std::nullopt;
  if (window.is_keyframe_at_end) row.bumps.push_back(holding(row.bumps.back()));
  if (window.is_keyframe_at_begin) {
    row.bumps.insert(row.bumps.begin(), holding(row.bumps.front()));
    row.first = 0;
  }
  return row;
}

Guide shortened(const Guide& guide, FreeSpace& space, double margin_m) {
  Guide result = {guide.front()};
  for (std::size_t i = 0; i + 1 < guide.size();) {
    // Doubles the leap while it is free, then halves what is left of it.
    std::size_t reached = i + 1;
    for (std::size_t leap = 2; leap > 0;) {
      const std::size_t next = std::min(reached + leap, guide.size() - 1);
      const bool grows = next > reached && turns_little(guide[i], guide[next]) &&
                         !space.first_hit(guide[i], guide[next], margin_m);
      if (grows) reached = next;
      leap = grows && next + 1 < guide.size() ? 2 * leap : leap / 2;
      if (reached + 1 == guide.size()) break;
    }
    result.push_back(guide[reached]);
    i = reached;
  }
  return result;
}

}  // namespace camway::correction
