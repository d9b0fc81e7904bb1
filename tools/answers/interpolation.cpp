// SPDX-License-Identifier: MIT
#include "tools/answers/interpolation.h"

#include "daemon/planning/stages/keyframe_times.h"
#include "daemon/planning/stages/prepare.h"
#include "tools/json/json_response.h"

namespace camway::tools {

base::Result<std::string> interpolated_text(const planning::PlanRequest& request) {
  const planning::PreparedKeyframes prepared = planning::prepared_keyframes(request);
  const motion::CubicPath path =
      planning::interpolated_path(request, prepared.keyframes, prepared.origin);
  return write_path(planning::to_sent_times(prepared.origin, path.path()));
}

}  // namespace camway::tools
