// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/keyframe_faults.h"

#include <algorithm>
#include <map>
#include <optional>

#include "daemon/correction/infeasibility/surface_sides.h"
#include "daemon/correction/search/free_pose.h"

namespace camway::planning {

namespace {

using base::Deadline;
using correction::FreePose;
using geometry::Vec3;
using motion::Keyframe;
using motion::Pose;
using scene::IndexSet;

// Distance that a free pose keeps, in tolerances, so that a path can leave it.
constexpr double kMargin = 10.0;
// A keyframe is moved up to this many times as far to be visible from its neighbours: most scenes
// are not closed edge for edge, and the space behind a wall or under a floor is free as well.
constexpr double kWorthTheView = 1.5;

/// Surfaces that a free pose must be inside of, and those that it may or may not be inside of.
struct Side {
  IndexSet inside;
  IndexSet either;
};

class Search {
 public:
  Search(const scene::Snapshot& snapshot, const collision::Query& query,
         const std::vector<Keyframe>& keyframes, const Deadline& deadline)
      : snapshot_(snapshot),
        space_(query),
        margin_m_(kMargin * query.options.tolerance_m),
        keyframes_(keyframes),
        deadline_(deadline),
        point_C_(query.body.point_C()) {}

  KeyframeFaults run() && {
    find_faults();
    if (!faults_.empty() && !deadline_.passed()) find_free_poses();
    const bool complete = checked_ == keyframes_.size() || faults_.size() >= kMostKeyframeFaults;
    return {std::move(faults_), complete};
  }

 private:
  void find_free_poses() {
    sides_.emplace(snapshot_.mesh, space_.obstacles().index);
    const bool any_free = faults_.size() < checked_;
    const Side usual = any_free ? Side{} : side_of_most();
    for (KeyframeFault& fault : faults_) {
      if (deadline_.passed()) break;
      const std::vector<std::size_t> neighbours = neighbours_of(fault.keyframe);
      const Side side = neighbours.empty() ? usual : side_of(neighbours);
      fault.free_pose = free_pose(fault.keyframe, side, neighbours);
    }
  }

  void find_faults() {
    for (; checked_ < keyframes_.size() && faults_.size() < kMostKeyframeFaults; ++checked_) {
      if (checked_ % kStepsPerDeadlineCheck == kStepsPerDeadlineCheck - 1 && deadline_.passed())
        return;
      const Pose& pose = keyframes_[checked_].pose;
      if (space_.gap_m(pose, space_.detect_options().tolerance_m) > 0.0) continue;
      // A contact takes longer to find than a gap. Late, the first one will do for the message.
      const bool is_late = !faults_.empty() && deadline_.passed();
      const std::optional<collision::Witness> contact =
          is_late ? std::nullopt : space_.contact(pose, 0.0);
      faults_.push_back({checked_, contact ? contact->depth_m : 0.0, std::nullopt});
      faults_.back().leaves_bounds = contact && collision::Obstacles::is_side(contact->triangle);
    }
  }

  [[nodiscard]] bool is_at_fault(std::size_t keyframe) const {
    return std::ranges::binary_search(faults_, keyframe, {}, &KeyframeFault::keyframe);
  }

  // Returns the same point of the body for every pose. On a free motion it stays on its side of
  // every surface.
  [[nodiscard]] Vec3 point_W(const Pose& pose) const {
    return pose.position + pose.orientation * point_C_;
  }

  [[nodiscard]] std::optional<IndexSet> around(const Pose& pose) const {
    return sides_->around(point_W(pose));
  }

  /// Returns the nearest free keyframes before and after, as far as there are any.
  [[nodiscard]] std::vector<std::size_t> neighbours_of(std::size_t keyframe) const {
    std::vector<std::size_t> neighbours;
    for (std::size_t i = keyframe; i-- > 0;) {
      if (is_at_fault(i)) continue;
      neighbours.push_back(i);
      break;
    }
    for (std::size_t i = keyframe + 1; i < checked_; ++i) {
      if (is_at_fault(i)) continue;
      neighbours.push_back(i);
      break;
    }
    return neighbours;
  }

  [[nodiscard]] Side side_of(const std::vector<std::size_t>& neighbours) const {
    std::vector<IndexSet> insides;
    for (const std::size_t i : neighbours) {
      if (std::optional<IndexSet> inside = around(keyframes_[i].pose)) {
        insides.push_back(std::move(*inside));
      }
    }
    if (insides.empty()) return {};
    return {insides.front(), scene::sum_mod_2(insides.front(), insides.back())};
  }

  [[nodiscard]] Side side_of_most() {
    std::size_t found = 0;
    std::map<std::uint32_t, std::size_t> votes;  // by surface, in order
    for (const KeyframeFault& fault : faults_) {
      if (deadline_.passed()) break;
      const std::optional<FreePose> free =
          nearest(fault.keyframe, [](const Pose&) { return true; });
      const std::optional<IndexSet> inside = free ? around(free->pose) : std::nullopt;
      if (!inside) continue;
      ++found;
      for (const std::uint32_t surface : *inside) ++votes[surface];
    }
    Side side;
    for (const auto& [surface, count] : votes) {
      if (2 * count > found) side.inside.push_back(surface);
    }
    return side;
  }

  std::optional<Pose> free_pose(std::size_t keyframe, const Side& side,
                                const std::vector<std::size_t>& neighbours) {
    const auto is_on_side = [&](const Pose& pose) {
      const std::optional<IndexSet> inside = around(pose);
      return inside && std::ranges::includes(side.either, scene::sum_mod_2(*inside, side.inside));
    };
    const auto is_seen = [&](const Pose& pose) {
      return std::ranges::any_of(neighbours, [&](std::size_t i) {
        return !space_.obstacles().index.closest_hit({point_W(keyframes_[i].pose), point_W(pose)});
      });
    };
    const std::optional<FreePose> any = nearest(keyframe, is_on_side);
    if (!any || neighbours.empty() || is_seen(any->pose)) return pose_of(any);
    const std::optional<FreePose> seen =
        nearest(keyframe, [&](const Pose& pose) { return is_on_side(pose) && is_seen(pose); });
    return pose_of(seen && seen->moved_m <= kWorthTheView * any->moved_m ? seen : any);
  }

  static std::optional<Pose> pose_of(const std::optional<FreePose>& found) {
    return found ? std::optional(found->pose) : std::nullopt;
  }

  std::optional<FreePose> nearest(std::size_t keyframe, const correction::PoseRule& will_do) {
    return correction::nearest_free_pose(space_, keyframes_[keyframe].pose, margin_m_, will_do,
                                         deadline_);
  }

  static constexpr std::size_t kStepsPerDeadlineCheck = 256;  // a step is a keyframe

  const scene::Snapshot& snapshot_;
  correction::FreeSpace space_;
  const double margin_m_;
  const std::vector<Keyframe>& keyframes_;
  const Deadline& deadline_;
  const Vec3 point_C_;
  std::optional<correction::SurfaceSides> sides_;
  std::vector<KeyframeFault> faults_;
  std::size_t checked_ = 0;  ///< number of keyframes that were checked; the others are unknown
};

}  // namespace

KeyframeFaults find_keyframe_faults(const scene::Snapshot& snapshot, const collision::Query& query,
                                    const std::vector<Keyframe>& keyframes,
                                    const Deadline& deadline) {
  return Search(snapshot, query, keyframes, deadline).run();
}

}  // namespace camway::planning
