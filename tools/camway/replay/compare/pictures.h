// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "daemon/scene/snapshot/snapshot.h"
#include "tools/camway/replay/compare/report.h"

namespace camway::tools {

/// Returns the scene of a recorded request, or null if none is known.
using SceneOf =
    std::function<std::shared_ptr<const scene::Snapshot>(const RecordedRequest& request)>;

/// Returns a floor plan of the scene with both paths of a request, as an SVG document: the earlier
/// path as a dashed line, and the path now. Empty if no answer has a path.
std::string picture_of(const ComparedRequest& compared, const SceneOf& scene_of,
                       const ReportHead& head);

/// Bounds of the pictures of a page.
struct PictureLimits {
  std::size_t most = 0;        ///< largest number
  std::size_t most_bytes = 0;  ///< largest size of all together
};

struct Pictures {
  std::vector<RequestPicture> list;
  bool is_cut = false;  ///< whether the next one would have been too large
};

/// Returns pictures of the requests whose answers differ, the worst verdicts first.
Pictures pictures_of(const std::vector<ComparedRequest>& compared, const SceneOf& scene_of,
                     const ReportHead& head, const PictureLimits& limits);

}  // namespace camway::tools
