// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/view/backend.h"
#include "tools/view/mesh_desk.h"

namespace camway::view {

/// Another answer to the request of a review, which is compared with the answer of the review. The
/// names are for people.
struct ComparedAnswer {
  std::string name;        ///< of the answer of the review
  std::string other_name;  ///< of the other one
  std::string other;       ///< as JSON
};

/// A plan that is to be shown without a door.
struct ReviewOrder {
  PlanOrder plan;
  std::string answer;  ///< to that request, as JSON
  std::optional<ComparedAnswer> compared = {};
};

/// A scene as reviews show it.
struct ReviewScene {
  /// A mesh of an object. Objects that were moved have the same key and other digests.
  struct Mesh {
    std::string digest;  ///< by which a backend knows it (`Backend::mesh`)
    std::string key;
  };
  std::string description;   ///< as JSON, with all objects
  std::vector<Mesh> meshes;  ///< each digest once
};

/// Collects the parts of reviews from a backend, and waits for it, so it is not for threads of
/// that. A function that fails returns nothing; then `failed` says why. Not thread-safe.
class ReviewSource {
 public:
  /// Keeps references to both.
  ReviewSource(Backend& backend, MeshDesk& meshes) : backend_(backend), meshes_(meshes) {}

  [[nodiscard]] std::optional<ReviewScene> scene(const std::string& name);
  /// Returns a mesh of a scene as `.glb` in base64.
  [[nodiscard]] std::optional<std::string> mesh(const std::string& scene,
                                                const std::string& digest);
  /// Returns the members of a review but for `scene` and `meshes`, as JSON without braces.
  [[nodiscard]] std::optional<std::string> plan_members(const ReviewOrder& order);

  [[nodiscard]] const Answer& failed() const { return failed_; }

 private:
  std::nullopt_t fail(int code, std::string error);
  /// Returns the triangles that the answers of a review name.
  [[nodiscard]] std::optional<std::string> triangles(const ReviewOrder& order);

  Backend& backend_;
  MeshDesk& meshes_;
  Answer failed_;
};

/// Returns JSON that can stand in an element of HTML: nothing in it begins a tag.
std::string json_for_html(std::string_view json);

}  // namespace camway::view
