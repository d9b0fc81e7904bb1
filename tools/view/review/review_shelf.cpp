// SPDX-License-Identifier: MIT
#include "tools/view/review/review_shelf.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace camway::view {
namespace {

/// Returns an element of a page that holds JSON (`json_for_html`).
std::string element(std::string_view id, std::string_view json) {
  return fmt::format("<script type=\"application/json\" id=\"review-{}\">{}</script>\n", id, json);
}

std::string mesh_member(const std::string& key, const std::string& mesh) {
  return fmt::format(R"({}:"{}")", json_for_html(json_string(key)), mesh);
}

}  // namespace

ReviewShelf::ReviewShelf(const PageFiles& page, std::size_t most_bytes) : most_bytes_(most_bytes) {
  if (page.script.text.empty()) return;
  const std::optional<ReviewFrame> frame = review_frame(page);
  if (!frame) return;
  const std::string parts =
      fmt::format("[{},{}]", json_string(frame->begin), json_string(frame->end));
  page_element_ = element("page", json_for_html(parts));
  bytes_ = page_element_.size() + element("scenes", "[]").size() + element("meshes", "{}").size();
}

ReviewShelf::Put ReviewShelf::put(std::size_t number, const ReviewOrder& order, Backend& backend,
                                  MeshDesk& meshes) {
  if (page_element_.empty()) return {code::kNotOffered, kNoPage};
  const Put too_large{code::kTooLarge, "the file of the reviews would be too large"};
  ReviewSource source(backend, meshes);
  std::optional<ReviewScene> scene = source.scene(order.plan.scene);
  if (!scene) return {source.failed().code, source.failed().error};
  scene->description = json_for_html(scene->description);
  if (too_large_.contains(scene->description)) return too_large;
  const std::string description = scene->description;
  std::optional<Added> added = added_by(order.plan.scene, *std::move(scene), source);
  if (!added) return {source.failed().code, source.failed().error};
  if (!has_room(added->bytes)) {
    too_large_.insert(description);
    return too_large;
  }
  const std::optional<std::string> members = source.plan_members(order);
  if (!members) return {source.failed().code, source.failed().error};
  std::string review =
      element(fmt::format("{}", number),
              json_for_html(fmt::format(R"({{{},"scene":{}}})", *members, added->scene)));
  if (!has_room(added->bytes + review.size())) return too_large;
  bytes_ += added->bytes + review.size();
  if (added->scene == scenes_.size()) scenes_.push_back(std::move(added->description));
  meshes_.merge(std::move(added->meshes));
  reviews_.emplace(number, std::move(review));
  return {};
}

std::optional<ReviewShelf::Added> ReviewShelf::added_by(const std::string& name, ReviewScene scene,
                                                        ReviewSource& source) const {
  Added added;
  const auto same = std::ranges::find(scenes_, scene.description);
  added.scene = static_cast<std::size_t>(same - scenes_.begin());
  if (same != scenes_.end()) return added;
  added.bytes = scene.description.size() + (scenes_.empty() ? 0U : 1U);
  added.description = std::move(scene.description);
  for (const ReviewScene::Mesh& each : scene.meshes) {
    if (meshes_.contains(each.key) || added.meshes.contains(each.key)) continue;
    std::optional<std::string> mesh = source.mesh(name, each.digest);
    if (!mesh) return std::nullopt;
    added.bytes +=
        mesh_member(each.key, *mesh).size() + (meshes_.empty() && added.meshes.empty() ? 0U : 1U);
    added.meshes.emplace(each.key, *std::move(mesh));
    // One object more would not fit either, and large scenes have many.
    if (!has_room(added.bytes)) break;
  }
  return added;
}

std::string ReviewShelf::elements() const {
  if (reviews_.empty()) return {};
  std::string meshes;
  for (const auto& [key, mesh] : meshes_) {
    meshes += (meshes.empty() ? "" : ",") + mesh_member(key, mesh);
  }
  std::string all = page_element_ +
                    element("scenes", fmt::format("[{}]", fmt::join(scenes_, ","))) +
                    element("meshes", fmt::format("{{{}}}", meshes));
  for (const auto& [number, review] : reviews_) all += review;
  return all;
}

}  // namespace camway::view
