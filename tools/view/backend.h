// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/planning/result/result.h"
#include "daemon/scene/mesh/mesh.h"
#include "tools/view/answer.h"
#include "tools/view/orders.h"

namespace camway::view {

/// A plan or a proof that is under way.
class Job {
 public:
  virtual ~Job() = default;
  /// Ends it soon, with `code::kCancelled` unless it has an answer by then. Thread-safe.
  virtual void cancel() = 0;
};

/// Events of a watch. While it exists, events come; one may still be on its way after its end.
class Watch {
 public:
  virtual ~Watch() = default;
};

/// Takes a JSON object: progress of a plan, or an event of a watch. Called on any thread. Must
/// neither throw nor wait.
using Tell = std::function<void(std::string json)>;

/// The last path that was planned, to be drawn.
struct LastPlan {
  tools::RequestFile request;
  planning::PlanResult result;
  std::shared_ptr<const scene::Mesh> mesh;  ///< null if its triangles are not known here
  std::shared_ptr<const std::string> request_text = {};  ///< as JSON; null only in tests
  std::shared_ptr<const std::string> answer_text = {};   ///< as JSON; null only in tests
  std::string scene_digest = {};                         ///< of the scene of the path
};

/// An object's triangles in the frame of the object, or why there are none.
struct MeshAnswer {
  std::shared_ptr<const scene::Mesh> mesh;  ///< null exactly if there is an error
  std::int64_t scene_triangles = 0;         ///< of all objects of its scene together
  int code = code::kOk;
  std::string error = {};  ///< a sentence
};

/// Takes a mesh: called exactly once, on any thread. Must neither throw nor wait.
using MeshDone = std::function<void(MeshAnswer)>;

/// Plans and keeps the scenes: this process, or a daemon. Functions return at once, and answers
/// come on threads of the backend; `done` may also be called before the function returns. The
/// destructor ends what is under way, with answers that say so. Thread-safe.
class Backend {
 public:
  virtual ~Backend() = default;

  /// Returns the scene of requests that name none.
  [[nodiscard]] virtual std::string scene() const = 0;

  /// Plans. The answer is what `camway plan` writes. `progress` may be null.
  virtual std::shared_ptr<Job> plan(PlanOrder order, Tell progress, Done done) = 0;
  /// Proves a path. The answer is what `camway check --json` writes.
  virtual std::shared_ptr<Job> check(CheckOrder order, Done done) = 0;
  virtual void ask_scene(SceneOrder order, Done done) = 0;
  virtual void status(Done done) = 0;

  /// Returns the mesh of the object of `scene` whose digest is `digest` (`ObjectFacts::digest`).
  virtual void mesh(std::string scene, std::string digest, MeshDone done) = 0;
  /// Returns triangles of `scene` in the world, numbered as answers number them
  /// (`triangles_json`). Numbers that the scene does not have are left out.
  virtual void triangles(std::string scene, std::vector<std::int64_t> indices, Done done) = 0;

  /// Tells of changes of scenes, first of what there is. Null if that is not offered.
  virtual std::unique_ptr<Watch> watch_scenes(Tell event) = 0;
  /// Plans a path and tells when a change of its scene breaks it. Null if that is not offered.
  virtual std::unique_ptr<Watch> watch_path(PlanOrder order, Tell event) = 0;

  /// Returns the last path that was planned; null if there is none.
  [[nodiscard]] virtual std::shared_ptr<const LastPlan> last() const = 0;
};

}  // namespace camway::view
