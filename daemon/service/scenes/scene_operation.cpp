// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/scene_operation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <sstream>
#include <utility>

#include "daemon/messages/plan.h"
#include "daemon/messages/scene.h"
#include "daemon/messages/scene_names.h"
#include "daemon/planning/request/request.h"
#include "daemon/scene/import/import_warnings.h"
#include "daemon/scene/voxels/map_scan.h"
#include "daemon/service/scenes/request_digest.h"
#include "daemon/service/scenes/scene_answers.h"
#include "daemon/service/scenes/scene_content.h"
#include "daemon/service/scenes/sent_mesh.h"
#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/checksum.h"
#include "lcmtypes/wire/layout.h"

namespace camway::service {
namespace {

using geometry::Vec3;
using scene::SceneChange;
using Request = scene_request_t;
using Answer = scene_response_t;

std::int32_t status_of(scene::StoreFault fault) {
  switch (fault) {
    case scene::StoreFault::kNone:
      return Answer::STATUS_OK;
    case scene::StoreFault::kUnknownScene:
      return Answer::STATUS_UNKNOWN_SCENE;
    case scene::StoreFault::kInvalid:
      return Answer::STATUS_INVALID;
    case scene::StoreFault::kLimit:
    case scene::StoreFault::kFull:
      return Answer::STATUS_LIMIT;
    case scene::StoreFault::kCancelled:
      return Answer::STATUS_CANCELLED;
    case scene::StoreFault::kNotKept:
    case scene::StoreFault::kOutrun:
      return Answer::STATUS_INTERNAL_ERROR;
  }
  return Answer::STATUS_INTERNAL_ERROR;
}

std::string warnings_of(const scene::ImportReport& report) {
  std::string text;
  for (const std::string& warning : scene::import_warnings(
           report, planning::PlanOptions{}.interval_tolerance_m, scene::kOfDefault)) {
    text += (text.empty() ? "warning: " : "; warning: ") + warning;
  }
  return text;
}

/// Returns whether a change may be refused only because this process has not read yet what another
/// one has made of the scene.
bool is_refused_for_its_scene(const Answer& answer) {
  return answer.status == Answer::STATUS_UNKNOWN_SCENE || answer.status == Answer::STATUS_INVALID ||
         answer.status == Answer::STATUS_NO_MAP;
}

/// Carries out one request.
class SceneOperation {
 public:
  SceneOperation(const Request& request, const UploadedBytes& upload,
                 const OperationContext& context)
      : request_(request),
        upload_(upload),
        context_(context),
        rules_(context.rules),
        scenes_(context.scenes) {}

  Answer run() {
    // Before the upload is looked for, which a daemon that was started anew does not have.
    if (const auto made = is_query(request_) ? nullptr : made_before()) {
      return answer_to({made, scene::StoreFault::kNone, ""}, "");
    }
    switch (request_.operation) {
      case Request::LOAD:
        return load();
      case Request::UNLOAD:
        return unload();
      case Request::LIST:
        return scene_list(request_, scenes_);
      case Request::DESCRIBE:
        return scene_description(request_, scenes_);
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
        return scene_history(request_, scenes_);
      case Request::RESTORE:
        return restore();
      case Request::TRIANGLES:
        return triangles();
      default:
        return invalid(fmt::format("operation: {} is unknown", request_.operation));
    }
  }

  /// Returns the map that is exported to the client.
  std::vector<std::uint8_t> take_map() { return std::move(map_); }

 private:
  /// Returns the scene if a repetition of this request has changed it already; else null.
  [[nodiscard]] std::shared_ptr<const scene::Snapshot> made_before() const {
    return scenes_.changed_by(target_of(request_), request_name(request_));
  }

  [[nodiscard]] Answer invalid(std::string_view reason) const {
    return plain_scene_answer(request_, Answer::STATUS_INVALID, reason);
  }

  /// Returns the answer to a request that failed, for whatever reason.
  [[nodiscard]] Answer refused(std::string_view reason, scene::Limit limit) const {
    if (limit == scene::Limit::kNone) return invalid(reason);
    return plain_scene_answer(request_, Answer::STATUS_LIMIT, with_setting(reason, limit));
  }

  /// Returns the entry about this change in the history of the scene.
  [[nodiscard]] scene::ChangeNote note(std::string object) const {
    return {.operation = operation_name(request_),
            .object = std::move(object),
            .client = request_.client_id,
            .request = request_name(request_)};
  }

  /// Returns the answer for the result of a change in the store.
  [[nodiscard]] Answer answer_to(const scene::StoreResult& result, std::string_view message) const {
    if (result.limit != scene::Limit::kNone) return refused(result.error, result.limit);
    Answer answer = plain_scene_answer(request_, status_of(result.fault),
                                       result.snapshot ? message : result.error);
    if (!result.snapshot) return answer;
    answer.scene = messages::scene_info_of(*result.snapshot);
    answer.total = static_cast<std::int32_t>(result.snapshot->objects.size());
    if (const scene::SceneObject* object = result.snapshot->find(request_.object)) {
      answer.objects = {messages::object_on_wire(*object)};
      answer.num_objects = 1;
    }
    return answer;
  }

  Answer load() {
    if (!messages::is_scene_name(request_.scene))
      return invalid("scene: must be of [A-Za-z0-9_.-]{1,128}");
    scene::ObjectOptions options;
    options.mirror_voxels = rules_.mirror_voxels;
    options.bounds = messages::from_wire(request_.body_bounds);
    if (const auto fault = geometry::fault_in(options.bounds))
      return invalid("body_bounds." + fault->field + ": " + fault->reason);
    if (request_.occupancy_resolution_m != 0.0) {
      options.occupancy_resolution_m = request_.occupancy_resolution_m;
    }
    if (request_.file.empty() && request_.upload_bytes == 0) {
      if (options.occupancy_resolution_m &&
          !scene::VoxelGrid::valid_resolution(*options.occupancy_resolution_m)) {
        return invalid(std::string("occupancy_resolution_m: ") + messages::kResolutionRule);
      }
      return answer_to(
          scenes_.put(scene::assemble(request_.scene, 1, {}, options), note(""), context_.ticket),
          "");
    }
    Made<Content> made = read_mesh(request_, upload_, context_);
    if (!made) return refused(made.error, made.limit);
    const std::string warnings = warnings_of(made->report);
    scene::ObjectResult placed =
        scene::place_object(request_.scene, source_of(*std::move(made), options), {}, options,
                            nullptr, context_.ticket.stop());
    if (!placed.object) return refused(placed.error, placed.limit);
    return answer_to(
        scenes_.put(scene::assemble(request_.scene, 1, {std::move(placed.object)}, options),
                    note(""), context_.ticket),
        warnings);
  }

  Answer unload() {
    const scene::StoreResult removed =
        scenes_.remove(request_.scene, context_.ticket, request_name(request_));
    if (removed.fault == scene::StoreFault::kUnknownScene) {
      return unknown_scene_answer(request_, scenes_);
    }
    return plain_scene_answer(request_, status_of(removed.fault), removed.error);
  }

  Answer restore() {
    const auto revision = static_cast<std::uint64_t>(std::max<std::int64_t>(request_.revision, 0));
    if (request_.restore_as.empty() || request_.restore_as == request_.scene) {
      return answer_to(scenes_.restore(request_.scene, revision, note(""), context_.ticket), "");
    }
    if (!messages::is_scene_name(request_.restore_as)) {
      return invalid("restore_as: must be of [A-Za-z0-9_.-]{1,128}");
    }
    return answer_to(scenes_.restore_as(request_.scene, revision, request_.restore_as, note(""),
                                        context_.ticket),
                     "");
  }

  Answer put() {
    const auto snapshot = scenes_.find(request_.scene);
    if (!snapshot) return unknown_scene_answer(request_, scenes_);
    if (!messages::is_scene_name(request_.object) ||
        request_.object.size() > wire::kMaxPutNameBytes) {
      return invalid("object: must be of [A-Za-z0-9_.-]{1,64}");
    }
    const std::optional<scene::ObjectKind> kind = kind_of(request_);
    if (!kind) return invalid(fmt::format("kind: {} is unknown", request_.kind));
    const Made<scene::Placement> placement = placement_of(request_);
    if (!placement) return invalid(placement.error);
    Made<Content> made = make_mesh(request_, *kind, upload_, context_);
    if (!made) return refused(made.error, made.limit);
    const std::string warnings = warnings_of(made->report);
    const auto source = source_of(*std::move(made), snapshot->options);
    return change({SceneChange::Kind::kPut, request_.object, source, *placement}, warnings);
  }

  Answer move() {
    const Made<scene::Placement> placement = placement_of(request_);
    if (!placement) return invalid(placement.error);
    return change({SceneChange::Kind::kMove, request_.object, nullptr, *placement}, "");
  }

  Answer scan() {
    if (!scenes_.find(request_.scene)) return unknown_scene_answer(request_, scenes_);
    const Made<std::vector<Vec3>> points = read_points(upload_);
    if (!points) return invalid(points.error);
    // Made from the map as it is when its turn has come: another scan may have changed it.
    const auto make = [&](const scene::Snapshot& newest) { return scanned(newest, *points); };
    return answer_to(scenes_.change(request_.scene, scene::ChangeMaker(make), note(request_.object),
                                    context_.ticket),
                     "");
  }

  /// Returns the change that adds the points, in the frame of the scene, to the map.
  [[nodiscard]] scene::MadeChange scanned(const scene::Snapshot& newest,
                                          std::vector<Vec3> points) const {
    const scene::SceneObject* const object = newest.find(request_.object);
    if (object == nullptr || !object->source->map_O) {
      return {{},
              fmt::format("object: '{}' is no occupancy map of scene '{}'", request_.object,
                          request_.scene)};
    }
    const scene::Placement& map_placement = object->parts_placement;
    for (Vec3& point : points) point = map_placement.to_object(point);
    const scene::Scan seen{map_placement.to_object(vec3(request_.position_m)), points};
    scene::VoxelMapResult next = scene::scanned(*object->source->map_O, seen, rules_.scan_voxels);
    if (!next.map) return {{}, std::move(next.error), next.limit};
    Made<Content> made = of_map(std::move(next.map), object->source->map_origin_O);
    if (!made) return {{}, std::move(made.error), made.limit};
    return {SceneChange{SceneChange::Kind::kPut, request_.object,
                        source_of(*std::move(made), newest.options), object->placement}};
  }

  Answer export_map() {
    const auto snapshot = scenes_.find(request_.scene);
    if (!snapshot) return unknown_scene_answer(request_, scenes_);
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
    answer.scene = messages::scene_info_of(*snapshot);
    answer.map_bytes = static_cast<std::int64_t>(bytes.size());
    answer.map_checksum =
        wire::crc64(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    if (request_.file.empty()) {
      map_.assign(bytes.begin(), bytes.end());
      return answer;
    }
    const std::lock_guard writing(context_.writing);
    if (!context_.ticket.try_commit()) {
      return plain_scene_answer(request_, Answer::STATUS_CANCELLED, "it was cancelled");
    }
    const std::string fault = rules_.roots.write(request_.file, ".bt", bytes);
    return fault.empty() ? answer : invalid(fault);
  }

  Answer triangles() {
    const auto snapshot = scenes_.find(request_.scene);
    if (!snapshot) return unknown_scene_answer(request_, scenes_);
    const auto object = std::ranges::find_if(
        snapshot->objects, [&](const auto& each) { return each->digest == request_.digest; });
    if (object == snapshot->objects.end()) {
      return invalid(fmt::format("digest: is of no object of scene '{}' now", request_.scene));
    }
    map_ = sent_mesh(**object);
    Answer answer = plain_scene_answer(request_, Answer::STATUS_OK, "");
    answer.scene = messages::scene_info_of(*snapshot);
    answer.total = static_cast<std::int32_t>(snapshot->objects.size());
    answer.objects = {messages::object_on_wire(**object)};
    answer.num_objects = 1;
    answer.map_bytes = static_cast<std::int64_t>(map_.size());
    answer.map_checksum = wire::crc64(map_.data(), map_.size());
    return answer;
  }

  Answer change(SceneChange change, std::string_view message) {
    const std::string object = change.object;
    return answer_to(
        scenes_.change(request_.scene, std::move(change), note(object), context_.ticket), message);
  }

  const Request& request_;
  const UploadedBytes& upload_;
  const OperationContext& context_;
  const SceneRules& rules_;
  scene::SceneStore& scenes_;
  std::vector<std::uint8_t> map_;
};

}  // namespace

bool is_query(const scene_request_t& request) {
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
    case scene_request_t::TRIANGLES:
      return "triangles";
    default:
      return "unknown";
  }
}

SceneReply execute(const scene_request_t& request, const UploadedBytes& upload,
                   const OperationContext& context) {
  const auto before = context.scenes.find(request.scene);
  SceneOperation operation(request, upload, context);
  Answer answer = operation.run();
  if (!is_query(request) && is_refused_for_its_scene(answer) && context.scenes.catch_up()) {
    const bool is_same_scene = context.scenes.find(request.scene) == before;
    // An unknown scene may have been removed by this very request, through another process.
    if (!is_same_scene || answer.status == Answer::STATUS_UNKNOWN_SCENE) answer = operation.run();
  }
  return {std::move(answer), operation.take_map()};
}

}  // namespace camway::service
