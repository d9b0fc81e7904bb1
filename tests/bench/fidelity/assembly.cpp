// SPDX-License-Identifier: MIT
#include "tests/bench/fidelity/assembly.h"

#include <algorithm>
#include <vector>

#include "daemon/motion/spline/path_frame.h"

namespace camway::bench {

using motion::CubicPath;
using motion::Keyframe;

CubicPath assembled(const CubicPath& interpolated, std::span<const Keyframe> given,
                    std::span<const PathPart> parts) {
  std::vector<Keyframe> joints = motion::keyframes_of(interpolated, given);
  motion::PathFrame frame = motion::frame_of(interpolated);
  for (const PathPart& part : parts) {
    const auto is_within = [&](const Keyframe& joint) {
      return part.range.begin_s <= joint.time_s && joint.time_s <= part.range.end_s;
    };
    std::erase_if(joints, is_within);
    for (const Keyframe& joint : motion::keyframes_of(*part.path, given)) {
      if (is_within(joint)) joints.push_back(joint);
    }
    const motion::PathFrame changed = motion::frame_of(*part.path);
    if (part.range.begin_s <= interpolated.begin_s()) frame.begin = changed.begin;
    if (part.range.end_s >= interpolated.end_s()) frame.end = changed.end;
  }
  std::ranges::sort(joints, {}, &Keyframe::time_s);
  return motion::interpolate_cubic(joints, frame);
}

}  // namespace camway::bench
