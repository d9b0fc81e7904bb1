// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/base/result.h"
#include "daemon/geometry/types.h"
#include "daemon/scene/import/record/import_options.h"
#include "tools/json/json_request.h"
#include "tools/json/json_response.h"

/// The orders of clients, read from JSON. The readers are strict, as those of files: an unknown
/// member is an error. They never throw for a bad document. Errors name the member.
namespace camway::view {

/// A path to plan.
struct PlanOrder {
  std::string scene;  ///< name of the scene
  tools::RequestFile request;
  std::shared_ptr<const std::string> text;  ///< the request as JSON; never null
};

/// A path to prove.
struct CheckOrder {
  std::string scene;  ///< name of the scene
  tools::RequestFile request;
  tools::PathFile path;
};

/// The form of an object. Lengths are metres.
struct BoxForm {
  geometry::Vec3 size_m = geometry::Vec3::Zero();
};
struct SphereForm {
  double radius_m = 0.0;
  double chord_error_m = 0.0;  ///< 0: a hundredth of the radius
};
struct CylinderForm {
  double radius_m = 0.0;
  double height_m = 0.0;
  double chord_error_m = 0.0;  ///< 0: a hundredth of the radius
};
/// A mesh in a format of scene files: a file below a root of the daemon, or its content.
struct MeshForm {
  std::string file;    ///< empty: `bytes`
  std::string bytes;   ///< content of a file
  std::string format;  ///< extension of `bytes`, [a-z0-9]+
  double scale = 1.0;  ///< metres per unit
  scene::UpAxis up = scene::UpAxis::kAsInFile;
  std::optional<double> voxel_m = {};  ///< edge of the voxels of a cloud of points
};
using Form = std::variant<BoxForm, SphereForm, CylinderForm, MeshForm>;

/// A question about scenes, or a change of one.
struct SceneOrder {
  enum class Kind : std::uint8_t { kList, kDescribe, kAdd, kMove, kRemove };
  Kind kind = Kind::kList;
  std::string scene;                          ///< empty for kList
  std::string object;                         ///< set for changes
  Form form;                                  ///< for kAdd
  std::optional<geometry::Vec3> position_m;   ///< nothing: as it is, or the origin
  std::optional<geometry::Quat> orientation;  ///< nothing: as it is, or not turned

  [[nodiscard]] bool is_change() const { return kind >= Kind::kAdd; }
};

/// Most triangles that may be asked for at once. Answers name far less.
inline constexpr std::size_t kMostIndices = 100'000;

/// A question about triangles of a scene.
struct TrianglesOrder {
  std::string scene;                  ///< name of the scene
  std::vector<std::int64_t> indices;  ///< numbers as in answers, kMostIndices at most
};

/// Returns the scene that a request names: the name of its file without folder and extension, so
/// that request files may be sent as they are. Empty if it names none.
std::string scene_of(const tools::RequestFile& request);

/// Reads a request. Refuses bodies that are files, and what `planning::validate` refuses. `scene`
/// of the order is `scene_of` the request.
base::Result<PlanOrder> read_plan(const nlohmann::json& document);
/// Reads `{"request": ..., "path": ...}`.
base::Result<CheckOrder> read_check_document(const nlohmann::json& document);

/// Reads `{"indices": [...]}`. The scene is not set.
base::Result<TrianglesOrder> read_triangles(const nlohmann::json& document);

/// Reads name, form and pose of an object that is to be added.
base::Result<SceneOrder> read_added(const nlohmann::json& document);
/// Reads the pose of an object that is to be moved.
base::Result<SceneOrder> read_moved(const nlohmann::json& document);

/// A message of a WebSocket.
struct Message {
  struct Cancel {};
  struct Status {};
  struct Version {};
  struct Fields {};
  struct Last {};
  struct Watch {
    std::optional<PlanOrder> order;  ///< nothing: the scenes
  };
  struct Unwatch {};
  struct Plan {
    PlanOrder order;
    bool wants_progress = false;
    std::string drag;  ///< name of the drag that this is the latest request of; empty: none
    /// Whether newer requests of its drag wait for its answer, once it is under way.
    bool may_finish = false;
  };
  /// A path to interpolate alone.
  struct Interpolate {
    PlanOrder order;
  };

  std::int64_t id = 0;
  std::variant<Cancel, Status, Version, Fields, Last, Watch, Unwatch, Plan, Interpolate, CheckOrder,
               TrianglesOrder, SceneOrder>
      what;
};

/// A message that cannot be read.
struct BadMessage {
  std::optional<std::int64_t> id;  ///< if that could be read
  std::string error;
  bool is_change = false;  ///< whether it asks for a change of a scene
};

/// Reads a message.
std::variant<Message, BadMessage> read_message(std::string_view text);

}  // namespace camway::view
