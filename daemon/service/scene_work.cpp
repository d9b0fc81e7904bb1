// SPDX-License-Identifier: MIT
#include "daemon/service/scene_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>
#include <sstream>
#include <utility>

#include "daemon/planning/request.h"
#include "daemon/scene/import_warnings.h"
#include "daemon/scene/map_scan.h"
#include "daemon/scene/shape_mesh.h"
#include "daemon/scene/stoppable_load.h"
#include "daemon/service/scene_argument.h"
#include "daemon/service/upload_file.h"
#include "daemon/service/wire_convert.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/checksum.h"
#include "lcmtypes/wire_layout.h"

namespace camway::service {
namespace {

using geometry::Vec3;
using scene::SceneChange;
using Request = scene_request_t;
using Answer = scene_response_t;

/// What came of reading or making something, or what is wrong.
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

std::shared_ptr<const scene::ObjectSource> source_of(Content content,
                                                     const scene::ObjectOptions& options) {
  if (content.map) {
    return scene::make_map_source(std::move(content.map), std::move(content.report), options);
  }
  return scene::make_source(content.kind, std::move(content.mesh), std::move(content.report),
                            options);
}

Vec3 vec3(const double (&values)[3]) { return {values[0], values[1], values[2]}; }

bool is_extension(std::string_view text) {
  const auto is_plain = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
  return !text.empty() && text.size() <= 8 && std::ranges::all_of(text, is_plain);
}

Made<scene::UnknownSpace> unknown_space(const Request& request) {
  switch (request.unknown) {
    case Request::UNKNOWN_FREE:
      return {scene::UnknownSpace::kFree, {}};
    case Request::UNKNOWN_OCCUPIED:
      return {scene::UnknownSpace::kOccupied, {}};
    default:
      return {std::nullopt, fmt::format("unknown: {} is unknown", request.unknown)};
  }
}

Made<scene::ImportOptions> import_options(const Request& request, const SceneRules& rules) {
  scene::ImportOptions options;
  options.map_limits = rules.maps;
  if (request.scale != 0.0) options.scale = request.scale;
  if (!(options.scale > 0.0) || !std::isfinite(options.scale)) {
    return {std::nullopt, "scale: must be a number above 0"};
  }
  const Made<scene::UnknownSpace> unknown = unknown_space(request);
  if (!unknown.value) return {std::nullopt, unknown.error};
  options.unknown = *unknown.value;
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
      return {std::nullopt, fmt::format("up: {} is unknown", request.up)};
  }
  return {options, {}};
}

Made<Content> imported(const std::filesystem::path& file, const std::string& shown,
                       const scene::ImportOptions& options, const std::stop_token& stop) {
  scene::ImportResult result = scene::import_mesh(file, options, stop);
  if (result.mesh) {
    const scene::ObjectKind kind = result.map ? scene::ObjectKind::kMap : scene::ObjectKind::kMesh;
    return {Content{kind, std::move(*result.mesh), std::move(result.report), result.map}, {}};
  }
  // Where the daemon keeps things is nobody's business: the name is that of the request.
  std::string error = std::move(result.error);
  if (const std::size_t at = error.find(file.string()); at != std::string::npos) {
    error.replace(at, file.string().size(), shown);
  }
  return {std::nullopt, std::move(error), result.limit};
}

Made<Content> read_mesh(const Request& request, const UploadedBytes& upload,
                        const SceneContext& context) {
  const Made<scene::ImportOptions> options = import_options(request, context.rules);
  if (!options.value) return {std::nullopt, options.error};
  if (request.upload_bytes == 0) {
    const RootedFile rooted = context.rules.roots.resolve(request.file);
    if (!rooted.error.empty()) return {std::nullopt, rooted.error};
    return imported(rooted.file, wire::printable(request.file), *options.value, context.stop);
  }
  if (!upload) return {std::nullopt, "upload: is not complete, or was forgotten; send it again"};
  if (!is_extension(request.upload_format)) {
    return {std::nullopt, "upload_format: must be a file name extension of [a-z0-9]{1,8}"};
  }
  const UploadFile file(*upload, request.upload_format);
  if (!file.is_good()) return {std::nullopt, "upload: the daemon has no room for the file"};
  return imported(file.path(), "upload." + request.upload_format, *options.value, context.stop);
}

/// Doubles of an upload of points; empty, with an error, if its size is not that of any.
Made<std::vector<Vec3>> read_points(const UploadedBytes& upload) {
  static_assert(std::endian::native == std::endian::little, "as uploads are");
  constexpr std::size_t kPointBytes = 3 * sizeof(double);
  if (!upload) return {std::nullopt, "upload: is not complete, or was forgotten; send it again"};
  if (upload->size() % kPointBytes != 0) {
    return {std::nullopt, "upload: its size is no multiple of 24, the bytes of a point"};
  }
  std::vector<Vec3> points(upload->size() / kPointBytes);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(points[i].data(), upload->data() + i * kPointBytes, kPointBytes);
  }
  return {std::move(points), {}};
}

Made<Content> of_shape(scene::ShapeMesh shape, scene::ObjectKind kind) {
  if (!shape.mesh) return {std::nullopt, std::move(shape.error)};
  scene::ImportReport report = scene::report_of(*shape.mesh, scene::to_string(kind));
  return {Content{kind, std::move(*shape.mesh), std::move(report)}, {}};
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
  if (!fault.empty()) return {std::nullopt, std::move(fault)};
  return {sensor, {}};
}

/// The object that is a map.
Made<Content> of_map(std::shared_ptr<const scene::VoxelMap> map) {
  if (!map->skin()) {
    return {std::nullopt,
            fmt::format("the map has more than {} triangles", map->limits().triangles),
            scene::Limit::kMapTriangles};
  }
  scene::ImportReport report = scene::report_of(*map, "OctoMap");
  return {Content{scene::ObjectKind::kMap, {}, std::move(report), std::move(map)}, {}};
}

Made<Content> empty_map(const Request& request, const SceneRules& rules) {
  const Made<scene::UnknownSpace> unknown = unknown_space(request);
  if (!unknown.value) return {std::nullopt, unknown.error};
  const Made<scene::SensorModel> sensor = sensor_of(request);
  if (!sensor.value) return {std::nullopt, sensor.error};
  scene::VoxelMapResult built =
      scene::VoxelMap::build(request.cell_m, {}, {}, *unknown.value, rules.maps, *sensor.value);
  if (!built.map) return {std::nullopt, "cell_m: the map " + built.error, built.limit};
  return of_map(std::move(built.map));
}

Made<Content> make_mesh(const Request& request, scene::ObjectKind kind, const UploadedBytes& upload,
                        const SceneContext& context) {
  constexpr double kDefaultChordShare = 0.01;
  const double chord_error_m =
      request.chord_error_m != 0.0 ? request.chord_error_m : kDefaultChordShare * request.radius_m;
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
      if (!points.value) return {std::nullopt, points.error};
      return of_shape(scene::cloud_mesh(*points.value, request.cell_m), kind);
    }
  }
  return {std::nullopt, "kind: is unknown"};
}

Made<scene::Placement> placement_of(const Request& request) {
  geometry::Quat orientation(request.orientation_wxyz[0], request.orientation_wxyz[1],
                             request.orientation_wxyz[2], request.orientation_wxyz[3]);
  if (orientation.coeffs().isZero(0.0)) orientation = geometry::Quat::Identity();
  Made<scene::Placement> made;
  const scene::Placement placement =
      scene::Placement::make(vec3(request.position_m), orientation, made.error);
  if (made.error.empty()) made.value = placement;
  return made;
}

scene_object_t object_on_wire(const scene::SceneObject& object) {
  scene_object_t wire{};
  wire.name = clipped(object.name, wire::kMaxObjectNameBytes);
  wire.kind = scene::to_string(object.source->kind);
  wire.digest = object.digest;
  wire.num_triangles = static_cast<std::int64_t>(object.triangles);
  std::copy_n(object.placement.position_W().data(), 3, wire.position_m);
  std::copy_n(geometry::wxyz(object.placement.orientation_WO()).data(), 4, wire.orientation_wxyz);
  if (const geometry::Box& bounds = object.bounds_W; !bounds.isEmpty()) {
    std::copy_n(bounds.min().data(), 3, wire.bounds_min_m);
    std::copy_n(bounds.max().data(), 3, wire.bounds_max_m);
  }
  return wire;
}

/// Appends what fits a message, from element `first` on.
template <class Elements, class List, class Convert>
std::int32_t put_list(const Elements& elements, std::int32_t first, const Convert& convert,
                      const Answer& answer, List& list) {
  auto size = static_cast<std::size_t>(answer.getEncodedSize());
  for (std::size_t i = static_cast<std::size_t>(std::max(first, 0)); i < elements.size(); ++i) {
    auto element = convert(elements[i]);
    size += static_cast<std::size_t>(element._getEncodedSizeNoHash());
    if (size > wire::kMaxMessageBytes) break;
    list.push_back(std::move(element));
  }
  return static_cast<std::int32_t>(list.size());
}

scene_change_t change_on_wire(const scene::KeptRevision& kept) {
  using std::chrono::microseconds;
  scene_change_t wire{};
  wire.revision = static_cast<std::int64_t>(kept.revision);
  wire.utime = std::chrono::duration_cast<microseconds>(kept.note.when.time_since_epoch()).count();
  wire.operation = clipped(kept.note.operation, wire::kMaxOperationBytes);
  wire.object = clipped(kept.note.object, wire::kMaxObjectNameBytes);
  wire.client_id = kept.note.client;
  wire.restored_revision = static_cast<std::int64_t>(kept.note.restored_revision);
  return wire;
}

std::int32_t status_of(scene::StoreFault fault) {
  switch (fault) {
    case scene::StoreFault::kNone:
      return Answer::STATUS_OK;
    case scene::StoreFault::kUnknownScene:
      return Answer::STATUS_UNKNOWN_SCENE;
    case scene::StoreFault::kInvalid:
      return Answer::STATUS_INVALID;
    case scene::StoreFault::kLimit:
      return Answer::STATUS_LIMIT;
  }
  return Answer::STATUS_INTERNAL_ERROR;
}

std::string warnings_of(const scene::ImportReport& report) {
  std::string text;
  for (const std::string& warning :
       scene::import_warnings(report, planning::PlanOptions{}.interval_tolerance_m)) {
    text += (text.empty() ? "warning: " : "; warning: ") + warning;
  }
  return text;
}

/// One request on its way.
class Work {
 public:
  Work(const Request& request, const UploadedBytes& upload, const SceneContext& context)
      : request_(request),
        upload_(upload),
        context_(context),
        rules_(context.rules),
        scenes_(context.scenes) {}

  Answer run() {
    switch (request_.operation) {
      case Request::LOAD:
        return load();
      case Request::UNLOAD:
        return unload();
      case Request::LIST:
        return list();
      case Request::DESCRIBE:
        return describe();
      case Request::PUT:
        return put();
      case Request::MOVE:
        return move();
      case Request::REMOVE:
        return change({SceneChange::Kind::kRemove, request_.object, nullptr, {}}, "");
      case Request::SCAN:
        return scan();
      case Request::EXPORT:
        return export_map();
      case Request::HISTORY:
        return history();
      case Request::RESTORE:
        return restore();
      default:
        return invalid(fmt::format("operation: {} is unknown", request_.operation));
    }
  }

  /// What is exported to the client.
  std::vector<std::uint8_t> take_map() { return std::move(map_); }

 private:
  [[nodiscard]] Answer invalid(std::string_view reason) const {
    return plain_scene_answer(request_, Answer::STATUS_INVALID, reason);
  }

  /// What could not be made, for whatever reason.
  [[nodiscard]] Answer refused(std::string_view reason, scene::Limit limit) const {
    if (limit == scene::Limit::kNone) return invalid(reason);
    return plain_scene_answer(request_, Answer::STATUS_LIMIT, with_setting(reason, limit));
  }

  [[nodiscard]] Answer unknown() const {
    return plain_scene_answer(
        request_, Answer::STATUS_UNKNOWN_SCENE,
        fmt::format("scene: '{}' is unknown; {}", request_.scene, scenes_.summary()));
  }

  /// What the scene's history says of this.
  [[nodiscard]] scene::ChangeNote note(std::string object) const {
    return {operation_name(request_), std::move(object), request_.client_id, 0, {}};
  }

  /// What the store made of a change.
  [[nodiscard]] Answer answer_to(const scene::StoreResult& result, std::string_view message) const {
    if (result.limit != scene::Limit::kNone) return refused(result.error, result.limit);
    Answer answer = plain_scene_answer(request_, status_of(result.fault),
                                       result.snapshot ? message : result.error);
    if (!result.snapshot) return answer;
    answer.scene = scene_info_of(*result.snapshot);
    answer.total = static_cast<std::int32_t>(result.snapshot->objects.size());
    if (const scene::SceneObject* object = result.snapshot->find(request_.object)) {
      answer.objects = {object_on_wire(*object)};
      answer.num_objects = 1;
    }
    return answer;
  }

  Answer load() {
    if (!is_scene_name(request_.scene)) return invalid("scene: must be of [A-Za-z0-9_.-]{1,128}");
    scene::ObjectOptions options;
    options.mirror_voxels = rules_.mirror_voxels;
    if (request_.occupancy_resolution_m != 0.0) {
      options.occupancy_resolution_m = request_.occupancy_resolution_m;
    }
    if (request_.file.empty() && request_.upload_bytes == 0) {
      if (options.occupancy_resolution_m &&
          !scene::VoxelGrid::valid_resolution(*options.occupancy_resolution_m)) {
        return invalid(std::string("occupancy_resolution_m: ") + kResolutionRule);
      }
      return answer_to(scenes_.put(scene::assemble(request_.scene, 1, {}, options), note("")), "");
    }
    Made<Content> made = read_mesh(request_, upload_, context_);
    if (!made.value) return refused(made.error, made.limit);
    const std::string warnings = warnings_of(made.value->report);
    scene::ObjectResult placed = scene::place_object(
        request_.scene, source_of(*std::move(made.value), options), {}, options);
    if (!placed.object) return refused(placed.error, placed.limit);
    return answer_to(
        scenes_.put(scene::assemble(request_.scene, 1, {std::move(placed.object)}, options),
                    note("")),
        warnings);
  }

  Answer unload() {
    if (!scenes_.remove(request_.scene)) return unknown();
    return plain_scene_answer(request_, Answer::STATUS_OK, "");
  }

  Answer list() {
    Answer answer = plain_scene_answer(request_, Answer::STATUS_OK, "");
    const auto scenes = scenes_.list();
    answer.first = request_.first;
    answer.total = static_cast<std::int32_t>(scenes.size());
    answer.num_scenes = put_list(
        scenes, request_.first, [](const auto& scene) { return scene_info_of(*scene); }, answer,
        answer.scenes);
    return answer;
  }

  Answer describe() {
    const auto snapshot = scenes_.find(request_.scene);
    if (!snapshot) return unknown();
    Answer answer = plain_scene_answer(request_, Answer::STATUS_OK, "");
    answer.scene = scene_info_of(*snapshot);
    answer.first = request_.first;
    answer.total = static_cast<std::int32_t>(snapshot->objects.size());
    answer.num_objects = put_list(
        snapshot->objects, request_.first,
        [](const auto& object) { return object_on_wire(*object); }, answer, answer.objects);
    return answer;
  }

  Answer history() {
    const scene::SceneStore::Kept kept = scenes_.kept(request_.scene);
    if (!kept.newest) return unknown();
    Answer answer = plain_scene_answer(request_, Answer::STATUS_OK, "");
    answer.scene = scene_info_of(*kept.newest);
    answer.first = request_.first;
    answer.total = static_cast<std::int32_t>(kept.revisions.size());
    answer.num_changes =
        put_list(kept.revisions, request_.first, change_on_wire, answer, answer.changes);
    return answer;
  }

  Answer restore() {
    const auto revision = static_cast<std::uint64_t>(std::max<std::int64_t>(request_.revision, 0));
    if (request_.restore_as.empty() || request_.restore_as == request_.scene) {
      return answer_to(scenes_.restore(request_.scene, revision, note("")), "");
    }
    if (!is_scene_name(request_.restore_as)) {
      return invalid("restore_as: must be of [A-Za-z0-9_.-]{1,128}");
    }
    return answer_to(scenes_.restore_as(request_.scene, revision, request_.restore_as, note("")),
                     "");
  }

  Answer put() {
    const auto snapshot = scenes_.find(request_.scene);
    if (!snapshot) return unknown();
    if (!is_scene_name(request_.object) || request_.object.size() > wire::kMaxPutNameBytes) {
      return invalid("object: must be of [A-Za-z0-9_.-]{1,64}");
    }
    const std::optional<scene::ObjectKind> kind = kind_of(request_);
    if (!kind) return invalid(fmt::format("kind: {} is unknown", request_.kind));
    const Made<scene::Placement> placement = placement_of(request_);
    if (!placement.value) return invalid(placement.error);
    Made<Content> made = make_mesh(request_, *kind, upload_, context_);
    if (!made.value) return refused(made.error, made.limit);
    const std::string warnings = warnings_of(made.value->report);
    const auto source = source_of(*std::move(made.value), snapshot->options);
    return change({SceneChange::Kind::kPut, request_.object, source, *placement.value}, warnings);
  }

  Answer move() {
    const Made<scene::Placement> placement = placement_of(request_);
    if (!placement.value) return invalid(placement.error);
    return change({SceneChange::Kind::kMove, request_.object, nullptr, *placement.value}, "");
  }

  Answer scan() {
    const auto snapshot = scenes_.find(request_.scene);
    if (!snapshot) return unknown();
    const scene::SceneObject* const object = snapshot->find(request_.object);
    if (object == nullptr || !object->source->map_O) {
      return invalid(fmt::format("object: '{}' is no occupancy map of scene '{}'", request_.object,
                                 request_.scene));
    }
    Made<std::vector<Vec3>> points = read_points(upload_);
    if (!points.value) return invalid(points.error);
    const scene::Placement placement = object->placement;
    for (Vec3& point : *points.value) point = placement.to_object(point);
    const scene::Scan seen{placement.to_object(vec3(request_.position_m)), *points.value};
    scene::VoxelMapResult next = scene::scanned(*object->source->map_O, seen, rules_.scan_voxels);
    if (!next.map) return refused(next.error, next.limit);
    Made<Content> made = of_map(std::move(next.map));
    if (!made.value) return refused(made.error, made.limit);
    return change({SceneChange::Kind::kPut, request_.object,
                   source_of(*std::move(made.value), snapshot->options), placement},
                  "");
  }

  Answer export_map() {
    const auto snapshot = scenes_.find(request_.scene);
    if (!snapshot) return unknown();
    if (!snapshot->occupancy) {
      return plain_scene_answer(request_, Answer::STATUS_NO_MAP,
                                "scene: it was loaded without an occupancy resolution");
    }
    if (!request_.file.empty() && !rules_.write_maps) {
      return invalid("file: the daemon writes no files for clients (scenes.write_maps is false)");
    }
    std::ostringstream out;
    snapshot->occupancy->write_bt(out);
    const std::string_view bytes = out.view();
    Answer answer = plain_scene_answer(request_, Answer::STATUS_OK, "");
    answer.scene = scene_info_of(*snapshot);
    answer.map_bytes = static_cast<std::int64_t>(bytes.size());
    answer.map_checksum =
        wire::crc64(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    if (request_.file.empty()) {
      map_.assign(bytes.begin(), bytes.end());
      return answer;
    }
    const std::lock_guard writing(context_.writing);
    const std::string fault = rules_.roots.write(request_.file, ".bt", bytes);
    return fault.empty() ? answer : invalid(fault);
  }

  Answer change(SceneChange change, std::string_view message) {
    const std::string object = change.object;
    return answer_to(scenes_.change(request_.scene, std::move(change), note(object)), message);
  }

  const Request& request_;
  const UploadedBytes& upload_;
  const SceneContext& context_;
  const SceneRules& rules_;
  scene::SceneStore& scenes_;
  std::vector<std::uint8_t> map_;
};

}  // namespace

scene_info_t scene_info_of(const scene::Snapshot& snapshot) {
  scene_info_t info{};
  info.name = clipped(snapshot.name, wire::kMaxSceneNameBytes);
  info.revision = static_cast<std::int64_t>(snapshot.revision);
  info.digest = clipped(snapshot.digest, wire::kMaxDigestBytes);
  info.num_triangles = static_cast<std::int64_t>(snapshot.index.size());
  if (!snapshot.index.bounds().isEmpty()) {
    std::copy_n(snapshot.index.bounds().min().data(), 3, info.bounds_min_m);
    std::copy_n(snapshot.index.bounds().max().data(), 3, info.bounds_max_m);
  }
  if (snapshot.occupancy) info.occupancy_resolution_m = snapshot.occupancy->resolution_m();
  return info;
}

scene_response_t plain_scene_answer(const scene_request_t& request, std::int32_t status,
                                    std::string_view message) {
  scene_response_t answer{};
  answer.client_id = request.client_id;
  answer.request_id = request.request_id;
  answer.status = status;
  answer.message = clipped(message, wire::kMaxTextBytes);
  return answer;
}

bool only_looks(const scene_request_t& request) {
  return request.operation == scene_request_t::LIST ||
         request.operation == scene_request_t::DESCRIBE ||
         request.operation == scene_request_t::HISTORY;
}

const std::string& target_of(const scene_request_t& request) {
  const bool makes_another =
      request.operation == scene_request_t::RESTORE && !request.restore_as.empty();
  return makes_another ? request.restore_as : request.scene;
}

const char* operation_name(const scene_request_t& request) {
  switch (request.operation) {
    case scene_request_t::LOAD:
      return "load";
    case scene_request_t::UNLOAD:
      return "unload";
    case scene_request_t::LIST:
      return "list";
    case scene_request_t::DESCRIBE:
      return "describe";
    case scene_request_t::PUT:
      return "put";
    case scene_request_t::MOVE:
      return "move";
    case scene_request_t::REMOVE:
      return "remove";
    case scene_request_t::SCAN:
      return "scan";
    case scene_request_t::EXPORT:
      return "export";
    case scene_request_t::HISTORY:
      return "history";
    case scene_request_t::RESTORE:
      return "restore";
    default:
      return "unknown";
  }
}

Performed perform(const scene_request_t& request, const UploadedBytes& upload,
                  const SceneContext& context) {
  Work work(request, upload, context);
  Performed performed{work.run(), work.take_map()};
  performed.is_called_off =
      context.stop.stop_requested() && performed.answer.status == Answer::STATUS_INVALID;
  return performed;
}

}  // namespace camway::service
