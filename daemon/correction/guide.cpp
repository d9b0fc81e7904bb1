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

CubicPoint scaled(const CubicPoint& offset, double share) {
  return {share * offset.position, share * offset.image};
}

/// Makes the sum of the bumps zero at the keyframe by the bump that stands there: of its neighbours
/// only the one inside the window is not zero.
CubicPoint holding(const CubicPoint& neighbour) {
  return scaled(neighbour, -motion::kBumpShoulder / motion::kBumpPeak);
}

bool is_none(const CubicPoint& offset) {
  return offset.position.isZero(0.0) && offset.image.isZero(0.0);
}

}  // namespace

SignedPose signed_pose_at(const motion::CubicPath& path, double time_s) {
  const CubicPoint point = path.at(time_s);
  const Vec4 q = motion::quaternion::multiply(
      path.reference, motion::quaternion::multiply(point.image, point.image));
  return {point.position, q / q.norm()};
}

std::optional<Offsets> offsets_to(const motion::CubicPath& path, const Guide& guide,
                                  const motion::KnotRow& knots, const FreeSpace& space) {
  const Travelled travelled(guide, space);
  Offsets offsets{knots, {}};
  Vec4 image = path.at(knots.begin_s).image;
  for (int k = 1; k < knots.count; ++k) {
    const CubicPoint old = path.at(knots.knot_s(k));
    const SignedPose wanted = travelled.at(static_cast<double>(k) / knots.count);
    image = motion::image_of(path.reference, wanted.orientation, image);
    offsets.at.push_back({wanted.position - old.position, image * old.image.norm() - old.image});
  }
  if (image.dot(path.at(knots.end_s).image) <= 0.0) return std::nullopt;
  return offsets;
}

Offsets pulled_back(const motion::CubicPath& path, const Offsets& offsets, double slope,
                    double margin_m, FreeSpace& space) {
  constexpr int kSteps = 10;
  std::vector<double> left(offsets.at.size(), 1.0);
  for (std::size_t i = 0; i < left.size(); ++i) {
    const CubicPoint old = path.at(offsets.knots.knot_s(static_cast<int>(i) + 1));
    for (int step = kSteps; step-- > 0;) {
      const double share = static_cast<double>(step) / kSteps;
      const CubicPoint less = scaled(offsets.at[i], share);
      const CubicPoint point{old.position + less.position, old.image + less.image};
      if (!space.is_free(motion::pose_of(path.reference, point), margin_m)) break;
      left[i] = share;
    }
  }
  for (std::size_t i = 1; i < left.size(); ++i) left[i] = std::max(left[i], left[i - 1] - slope);
  for (std::size_t i = left.size(); i-- > 1;) left[i - 1] = std::max(left[i - 1], left[i] - slope);
  Offsets result = offsets;
  for (std::size_t i = 0; i < left.size(); ++i) result.at[i] = scaled(offsets.at[i], left[i]);
  return result;
}

BumpRow bumps_for(const Offsets& offsets, Ends ends) {
  BumpRow row{offsets.knots, 1, offsets.at};
  if (ends == Ends::kFree) {
    row.bumps.push_back(holding(row.bumps.back()));
    row.bumps.insert(row.bumps.begin(), holding(row.bumps.front()));
    row.first = 0;
  } else {
    row.bumps.pop_back();
    row.bumps.erase(row.bumps.begin());
    row.first = 2;
  }
  // Bumps without a coefficient would only cut the path into pieces.
  while (!row.bumps.empty() && is_none(row.bumps.back())) row.bumps.pop_back();
  while (!row.bumps.empty() && is_none(row.bumps.front())) {
    row.bumps.erase(row.bumps.begin());
    ++row.first;
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
