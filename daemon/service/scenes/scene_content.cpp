// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/scene_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

#include "daemon/messages/scene_names.h"
#include "daemon/scene/import/import.h"
#include "daemon/scene/import/upload_file.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "daemon/scene/voxels/map_scan.h"
#include "lcmtypes/wire/channels.h"

namespace camway::service {
namespace {

using geometry::Vec3;
using Request = scene_request_t;

bool is_extension(std::string_view text) {
  const auto is_plain = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
  return !text.empty() && text.size() <= 8 && std::ranges::all_of(text, is_plain);
}

Made<scene::UnknownSpace> unknown_space(const Request& request) {
  switch (request.unknown) {
    case Request::UNKNOWN_FREE:
      return scene::UnknownSpace::kFree;
    case Request::UNKNOWN_OCCUPIED:
      return scene::UnknownSpace::kOccupied;
    default:
      return base::Failure{fmt::format("unknown: {} is unknown", request.unknown)};
  }
}

Made<scene::ImportOptions> import_options(const Request& request, const SceneRules& rules) {
  scene::ImportOptions options;
  options.map_limits = rules.maps;
  if (request.scale != 0.0) options.scale = request.scale;
  if (!(options.scale > 0.0) || !std::isfinite(options.scale)) {
    return base::Failure{"scale: must be a number above 0"};
  }
  const Made<scene::UnknownSpace> unknown = unknown_space(request);
  if (!unknown) return base::Failure{unknown.error};
  options.unknown = *unknown;
  if (request.cell_m != 0.0) {
    if (!scene::VoxelGrid::valid_resolution(request.cell_m)) {
      return base::Failure{std::string("cell_m: ") + messages::kResolutionRule};
    }
    options.voxel_m = request.cell_m;
  }
  switch (request.up) {
    case Request::UP_AS_IN_FILE:
      break;
    case Request::UP_Z_TO_Y:
      options.up = scene::UpAxis::kZToY;
      break;
    case Request::UP_Y_TO_Z:
      options.up = scene::UpAxis::kYToZ;
      break;
    default:
      return base::Failure{fmt::format("up: {} is unknown", request.up)};
  }
  return options;
}

Made<Content> imported(const std::filesystem::path& file, const std::string& shown,
                       const scene::ImportOptions& options, const std::stop_token& stop) {
  scene::ImportResult result = scene::import_mesh(file, options, stop);
  if (result.mesh) {
    const scene::ObjectKind kind = result.map ? scene::ObjectKind::kMap : scene::ObjectKind::kMesh;
    return Content{kind, std::move(*result.mesh), std::move(result.report), result.map,
                   result.map_origin_m};
  }
  // The path on the daemon's disk is replaced by the name in the request: clients must not see it.
  std::string error = std::move(result.error);
  const std::string path = file.string();
  for (std::size_t at = error.find(path); at != std::string::npos;
       at = error.find(path, at + shown.size())) {
    error.replace(at, path.size(), shown);
  }
  return {base::Failure{std::move(error)}, result.limit};
}

Made<Content> of_shape(base::Result<scene::Mesh> shape, scene::ObjectKind kind) {
  if (!shape) return base::Failure{std::move(shape.error)};
  scene::ImportReport report = scene::report_of(*shape, scene::to_string(kind));
  return Content{kind, std::move(*shape), std::move(report)};
}

Made<scene::SensorModel> sensor_of(const Request& request) {
  scene::SensorModel sensor;
  const auto take = [](double asked, double& value) {
    if (asked != 0.0) value = asked;
  };
  take(request.hit_probability, sensor.hit_probability);
  take(request.miss_probability, sensor.miss_probability);
  take(request.least_probability, sensor.least_probability);
  take(request.most_probability, sensor.most_probability);
  take(request.max_range_m, sensor.max_range_m);
  std::string fault = scene::fault_in(sensor);
  if (!fault.empty()) return base::Failure{std::move(fault)};
  return sensor;
}

Made<Content> empty_map(const Request& request, const SceneRules& rules) {
  const Made<scene::UnknownSpace> unknown = unknown_space(request);
  if (!unknown) return base::Failure{unknown.error};
  const Made<scene::SensorModel> sensor = sensor_of(request);
  if (!sensor) return base::Failure{sensor.error};
  scene::VoxelMapResult built =
      scene::VoxelMap::build(request.cell_m, {}, {}, *unknown, rules.maps, *sensor);
  if (!built.map) return {base::Failure{"cell_m: the map " + built.error}, built.limit};
  return of_map(std::move(built.map));
}

}  // namespace

std::shared_ptr<const scene::ObjectSource> source_of(Content content,
                                                     const scene::ObjectOptions& options) {
  if (content.map) {
    return scene::make_map_source(std::move(content.map), std::move(content.report), options,
                                  content.map_origin_O);
  }
  return scene::make_source(content.kind, std::move(content.mesh), std::move(content.report),
                            options);
}

Vec3 vec3(const double (&values)[3]) { return {values[0], values[1], values[2]}; }

Made<Content> read_mesh(const Request& request, const UploadedBytes& upload,
                        const OperationContext& context) {
  const Made<scene::ImportOptions> options = import_options(request, context.rules);
  if (!options) return base::Failure{options.error};
  if (request.upload_bytes == 0) {
    const base::Result<std::filesystem::path> rooted = context.rules.roots.resolve(request.file);
    if (!rooted) return base::Failure{rooted.error};
    return imported(*rooted, wire::printable(request.file), *options, context.ticket.stop());
  }
  if (!upload) return base::Failure{"upload: is not complete, or was forgotten; send it again"};
  if (!is_extension(request.upload_format)) {
    return base::Failure{"upload_format: must be a file name extension of [a-z0-9]{1,8}"};
  }
  const scene::UploadFile file({upload->data(), upload->size()}, request.upload_format);
  if (!file.is_good()) return base::Failure{"upload: the daemon has no room for the file"};
  return imported(file.path(), "upload." + request.upload_format, *options, context.ticket.stop());
}

Made<std::vector<Vec3>> read_points(const UploadedBytes& upload) {
  static_assert(std::endian::native == std::endian::little, "as uploads are");
  constexpr std::size_t kPointBytes = 3 * sizeof(double);
  if (!upload) return base::Failure{"upload: is not complete, or was forgotten; send it again"};
  if (upload->size() % kPointBytes != 0) {
    return base::Failure{"upload: its size is no multiple of 24, the bytes of a point"};
  }
  std::vector<Vec3> points(upload->size() / kPointBytes);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(points[i].data(), upload->data() + i * kPointBytes, kPointBytes);
  }
  return points;
}

std::optional<scene::ObjectKind> kind_of(const Request& request) {
  switch (request.kind) {
    case Request::MESH:
      return scene::ObjectKind::kMesh;
    case Request::BOX:
      return scene::ObjectKind::kBox;
    case Request::SPHERE:
      return scene::ObjectKind::kSphere;
    case Request::CYLINDER:
      return scene::ObjectKind::kCylinder;
    case Request::POINTS:
      return scene::ObjectKind::kPointCloud;
    case Request::MAP:
      return scene::ObjectKind::kMap;
    default:
      return std::nullopt;
  }
}

Made<Content> of_map(std::shared_ptr<const scene::VoxelMap> map, const Vec3& origin_O) {
  if (!map->faces()) {
    return {
        base::Failure{fmt::format("the map has more than {} triangles", map->limits().triangles)},
        scene::Limit::kMapTriangles};
  }
  scene::ImportReport report = scene::report_of(*map, "OctoMap");
  if (!report.bounds_m.isEmpty()) report.bounds_m.translate(origin_O);
  return Content{scene::ObjectKind::kMap, {}, std::move(report), std::move(map), origin_O};
}

Made<Content> make_mesh(const Request& request, scene::ObjectKind kind, const UploadedBytes& upload,
                        const OperationContext& context) {
  const double chord_error_m = request.chord_error_m != 0.0
                                   ? request.chord_error_m
                                   : scene::kUsualChordShare * request.radius_m;
  switch (kind) {
    case scene::ObjectKind::kMesh:
      return read_mesh(request, upload, context);
    case scene::ObjectKind::kBox:
      return of_shape(scene::box_mesh(vec3(request.size_m)), kind);
    case scene::ObjectKind::kSphere:
      return of_shape(scene::sphere_mesh(request.radius_m, chord_error_m), kind);
    case scene::ObjectKind::kCylinder:
      return of_shape(scene::cylinder_mesh(request.radius_m, request.height_m, chord_error_m),
                      kind);
    case scene::ObjectKind::kMap:
      return empty_map(request, context.rules);
    case scene::ObjectKind::kPointCloud: {
      const Made<std::vector<Vec3>> points = read_points(upload);
      if (!points) return base::Failure{points.error};
      return of_shape(scene::cloud_mesh(*points, request.cell_m), kind);
    }
  }
  return base::Failure{"kind: is unknown"};
}

Made<scene::Placement> placement_of(const Request& request) {
  geometry::Quat orientation(request.orientation_wxyz[0], request.orientation_wxyz[1],
                             request.orientation_wxyz[2], request.orientation_wxyz[3]);
  if (orientation.coeffs().isZero(0.0)) orientation = geometry::Quat::Identity();
  std::string fault;
  const scene::Placement placement =
      scene::Placement::make(vec3(request.position_m), orientation, fault);
  if (!fault.empty()) return base::Failure{std::move(fault)};
  return placement;
}

}  // namespace camway::service
