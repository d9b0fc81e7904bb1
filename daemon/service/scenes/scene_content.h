// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <camway/scene_request_t.hpp>

#include "daemon/base/result.h"
#include "daemon/geometry/types.h"
#include "daemon/scene/import/record/import_report.h"
#include "daemon/scene/mesh/placement.h"
#include "daemon/scene/mesh/resource_limit.h"
#include "daemon/scene/snapshot/scene_object.h"
#include "daemon/scene/voxels/voxel_map.h"
#include "daemon/service/scenes/operation_context.h"
#include "daemon/service/scenes/uploads.h"

namespace camway::service {

/// A value, or an error that begins with the name of the request's member.
template <class Value>
struct Made : base::Result<Value> {
  scene::Limit limit = scene::Limit::kNone;  ///< limit that the error is about

  using base::Result<Value>::Result;
  Made(base::Failure failure, scene::Limit about)
      : base::Result<Value>(std::move(failure)), limit(about) {}
};

/// The content of an object that is to be made.
struct Content {
  scene::ObjectKind kind;
  scene::Mesh mesh;  ///< empty if the content is a map
  scene::ImportReport report;
  std::shared_ptr<const scene::VoxelMap> map = nullptr;
  geometry::Vec3 map_origin_O = geometry::Vec3::Zero();  ///< `scene::ObjectSource::map_origin_O`
};

/// Returns the source of an object with that content; takes time proportional to the content.
std::shared_ptr<const scene::ObjectSource> source_of(Content content,
                                                     const scene::ObjectOptions& options);

/// Returns the kind of the request's object; nothing if it is unknown.
std::optional<scene::ObjectKind> kind_of(const scene_request_t& request);

/// Returns the placement that the request asks for. An orientation of zeros means not turned.
Made<scene::Placement> placement_of(const scene_request_t& request);

geometry::Vec3 vec3(const double (&values)[3]);

/// Reads the mesh or map of the request's file or upload, in the import process. `upload` is null
/// if the upload that the request names is not there.
Made<Content> read_mesh(const scene_request_t& request, const UploadedBytes& upload,
                        const OperationContext& context);

/// Makes the content of a new object: reads it, or builds it from the numbers of the request.
Made<Content> make_mesh(const scene_request_t& request, scene::ObjectKind kind,
                        const UploadedBytes& upload, const OperationContext& context);

/// Reads the points of an upload of doubles. An error if its size is not that of whole points.
Made<std::vector<geometry::Vec3>> read_points(const UploadedBytes& upload);

/// Returns the content of an object that is this map, which begins at `origin_O` in it.
Made<Content> of_map(std::shared_ptr<const scene::VoxelMap> map,
                     const geometry::Vec3& origin_O = geometry::Vec3::Zero());

}  // namespace camway::service
