// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/drawing/floor_plan.h"

/// The panels of a picture: a floor plan, storey by storey.
namespace camway::draw {

/// A keyframe as drawn.
struct PanelKeyframe {
  motion::Pose pose;
  bool is_inserted = false;
  std::string number;  ///< as in messages; empty for an inserted keyframe
  std::string remark;  ///< its height where they differ, its side of a barrier; may be empty
};

/// A collision as drawn: the poses from its begin to its end.
struct PanelCollision {
  SampledPath path;
  double middle_s = 0.0;
  bool remains = false;
};

/// A path in pieces: those on the storey of a panel, and those on other ones.
struct PanelPath {
  std::vector<SampledPath> here;
  std::vector<SampledPath> elsewhere;
};

/// The content of one panel.
struct Panel {
  FloorSection section;
  std::vector<PanelKeyframe> keyframes;
  PanelPath before;
  PanelPath after;
  std::vector<SampledPath> corrected;
  std::vector<PanelCollision> collisions;
  std::vector<SectionLine> barrier;
};

/// Returns the number of each keyframe, as messages count: given keyframes from 0; nothing for
/// inserted ones.
std::vector<std::string> keyframe_numbers(const std::vector<motion::Keyframe>& keyframes);

/// Whether the given keyframes are about equally high, so that one height says it for all.
bool are_level(const std::vector<motion::Keyframe>& keyframes, SceneUp up);

/// Returns a panel for each storey that the path or a keyframe of the plan is on, lowest first; at
/// least one, and six at most.
std::vector<Panel> storey_panels(const FloorPlan& plan);

/// Returns the sample of `path` nearest in time to `time_s`. Requires a path that is not empty.
const PathSample& sample_at(const SampledPath& path, double time_s);

/// Returns the samples of `path` from `begin_s` to `end_s`, its nearest ones to both ends included.
SampledPath part_of(const SampledPath& path, double begin_s, double end_s);

}  // namespace camway::draw
