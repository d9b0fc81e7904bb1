// SPDX-License-Identifier: MIT
#include <array>
#include <limits>

#include "daemon/scene/index/scene_index.h"
#include "tests/fuzz/targets.h"
#include "tests/scene/cache/prepared_samples.h"

namespace camway::testing {
namespace {

using geometry::Vec3;

/// Asks tree and field everywhere about the scene.
void ask(const scene::PreparedScene& prepared) {
  const std::array parts = {prepared.indexed};
  const scene::SceneIndex index = scene::SceneIndex::of(parts);
  const geometry::Box& bounds = index.bounds();
  for (int i = 0; i < 27; ++i) {
    const Vec3 share(0.5 * (i % 3), 0.5 * (i / 3 % 3), 0.5 * (i / 9));
    const Vec3 at = bounds.min() + share.cwiseProduct(bounds.max() - bounds.min());
    const std::array<geometry::Triangle, 1> body = {
        geometry::Triangle{at, at + Vec3(0.1, 0, 0), at + Vec3(0, 0.1, 0.1)}};
    const auto nearest = index.nearest(body, std::numeric_limits<double>::infinity());
    promise(!nearest || nearest->triangle < index.size(), "the nearest triangle exists");
    const auto hit = index.closest_hit({at, bounds.max()});
    promise(!hit || hit->triangle < index.size(), "the triangle that is hit exists");
    promise(!index.intersects(body[0]) || index.first_intersection(body[0]),
            "what is touched is a triangle");
    if (prepared.field) {
      promise(prepared.field->clearance_at_least_m(at) >= 0.0, "a clearance is not negative");
    }
  }
}

/// The digests are computed anew, so that mutants come to the checks behind them.
bool exercise_cache_file(std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> sealed(bytes.begin(), bytes.end());
  reseal(sealed);
  const base::Result<scene::PreparedScene> read = read_bytes(sealed);
  if (!read) return false;
  const scene::Mesh& mesh = *read->indexed->mesh;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      promise(corner < mesh.vertices.size(), "corners are vertices");
    }
  }
  promise((read->field == nullptr) != read->why_no_field.empty(), "a field or a reason");
  ask(*read);
  return true;
}

std::vector<FuzzBytes> cache_file_seeds() {
  return {file_of(small_prepared(false)), file_of(small_prepared(true)), {}};
}

}  // namespace

constinit const FuzzTarget kCacheFileTarget{"cache_file", exercise_cache_file, cache_file_seeds,
                                            20'000};

}  // namespace camway::testing
