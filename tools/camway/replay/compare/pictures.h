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

/// Largest sum of the sizes of a page's pictures, in bytes.
inline constexpr std::size_t kMostPictureBytes = std::size_t{8} << 20;

/// Returns pictures of the requests whose answers differ, the worst verdicts first, at most `most`
/// of them and no more than `kMostPictureBytes`.
std::vector<RequestPicture> pictures_of(const std::vector<ComparedRequest>& compared,
                                        const SceneOf& scene_of, const ReportHead& head,
                                        std::size_t most);

}  // namespace camway::tools
