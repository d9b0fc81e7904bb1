// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <camway/scene_request_t.hpp>

#include "daemon/geometry/types.h"
#include "daemon/scene/import/record/import_report.h"
#include "daemon/scene/mesh/placement.h"
#include "daemon/scene/mesh/resource_limit.h"
#include "daemon/scene/snapshot/scene_object.h"
#include "daemon/scene/voxels/voxel_map.h"
#include "daemon/service/scenes/scene_context.h"
#include "daemon/service/scenes/uploads.h"

namespace camway::service {

/// What came of reading or making something, or what is wrong, by the name of the request's field.
template <class Value>
struct Made {
  std::optional<Value> value;
  std::string error;
  scene::Limit limit = scene::Limit::kNone;  ///< that the error is about
};

/// What an object will be made of.
struct Content {
  scene::ObjectKind kind;
  scene::Mesh mesh;  ///< of a map: none
  scene::ImportReport report;
  std::shared_ptr<const scene::VoxelMap> map = nullptr;
};

/// What an object of that content is, with all that is built for it. Costs what there is in it.
std::shared_ptr<const scene::ObjectSource> source_of(Content content,
                                                     const scene::ObjectOptions& options);

/// Nothing if the request's kind is none.
std::optional<scene::ObjectKind> kind_of(const scene_request_t& request);

/// Where the request wants an object; an orientation of zeros is none.
Made<scene::Placement> placement_of(const scene_request_t& request);

geometry::Vec3 vec3(const double (&values)[3]);

/// The mesh or map of the request's file or upload, read by the import process. `upload` is null if
/// what the request names is not there.
Made<Content> read_mesh(const scene_request_t& request, const UploadedBytes& upload,
                        const SceneContext& context);

/// What a new object of that kind is made of: read, or built from the request's numbers.
Made<Content> make_mesh(const scene_request_t& request, scene::ObjectKind kind,
                        const UploadedBytes& upload, const SceneContext& context);

/// Doubles of an upload of points; nothing, with an error, if its size is not that of any.
Made<std::vector<geometry::Vec3>> read_points(const UploadedBytes& upload);

/// The object that is a map.
Made<Content> of_map(std::shared_ptr<const scene::VoxelMap> map);

}  // namespace camway::service
