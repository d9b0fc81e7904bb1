// SPDX-License-Identifier: MIT
#include "tools/view/mesh_desk.h"

#include <fmt/format.h>

#include <cstddef>
#include <future>
#include <utility>

#include "tools/view/display/display_glb.h"

namespace camway::view {
namespace {

/// A scene that is shown whole has a few megabytes.
constexpr std::size_t kCacheBytes = std::size_t{64} << 20;

/// Two, so that a large mesh does not keep small ones waiting.
constexpr int kMakers = 2;

}  // namespace

MeshDesk::MeshDesk(Backend& backend) : backend_(backend), cache_(kCacheBytes), pool_(kMakers) {}

void MeshDesk::ask(const std::string& scene, const std::string& digest, GlbDone done) {
  backend_.mesh(scene, digest,
                [self = weak_from_this(), digest, done = std::move(done)](MeshAnswer answer) {
                  const std::shared_ptr<MeshDesk> desk = self.lock();
                  if (!desk) return;
                  // The pool ends with the desk, so that its jobs need not keep it.
                  desk->pool_.post([desk = desk.get(), digest, done, answer = std::move(answer)] {
                    done(desk->made(digest, answer));
                  });
                });
}

GlbAnswer MeshDesk::wait_for(const std::string& scene, const std::string& digest) {
  const auto promise = std::make_shared<std::promise<MeshAnswer>>();
  backend_.mesh(scene, digest,
                [promise](MeshAnswer answer) { promise->set_value(std::move(answer)); });
  return made(digest, promise->get_future().get());
}

GlbAnswer MeshDesk::made(const std::string& digest, const MeshAnswer& answer) {
  if (!answer.mesh) return {nullptr, answer.code, answer.error};
  const auto triangles = static_cast<std::int64_t>(answer.mesh->triangles.size());
  const std::size_t most = triangles_to_show(triangles, answer.scene_triangles);
  std::string key = fmt::format("{} {}", digest, most);
  std::shared_ptr<const std::string> glb = cache_.find(key);
  if (!glb) {
    glb = std::make_shared<const std::string>(mesh_glb(*answer.mesh, most));
    cache_.put(std::move(key), glb);
  }
  return {std::move(glb)};
}

}  // namespace camway::view
