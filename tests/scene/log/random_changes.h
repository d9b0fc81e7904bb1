// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <random>
#include <string>

#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "tests/support/random.h"

/// Random changes of two scenes, "room" and "attic".
namespace camway::testing {

inline std::shared_ptr<const scene::ObjectSource> random_box(Random& random) {
  std::uniform_real_distribution<double> size(0.1, 2.0);
  scene::Mesh mesh = *scene::box_mesh(geometry::Vec3(size(random), size(random), size(random)));
  const scene::ImportReport report = scene::report_of(mesh, "box");
  return scene::make_source(scene::ObjectKind::kBox, std::move(mesh), report, {});
}

inline scene::Placement random_placement(Random& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::string fault;
  return scene::Placement::make(5.0 * geometry::Vec3(unit(random), unit(random), unit(random)),
                                geometry::Quat(1.0, unit(random), unit(random), unit(random)),
                                fault);
}

inline void change_at_random(scene::SceneStore& store, Random& random, int step) {
  const auto below = [&](int end) {
    return std::uniform_int_distribution<int>(0, end - 1)(random);
  };
  const std::string name = below(2) == 0 ? "room" : "attic";
  const std::string object = "object" + std::to_string(below(4));
  const scene::ChangeNote note{.operation = "step",
                               .object = object,
                               .client = "tester",
                               .request = "tester/" + std::to_string(step)};
  const auto snapshot = store.find(name);
  if (!snapshot || below(40) == 0) {
    store.put(scene::assemble(name, 1, {}, {}), note);
  } else if (below(60) == 0) {
    store.remove(name);
  } else if (below(10) == 0) {
    store.restore(name, snapshot->revision - static_cast<std::uint64_t>(below(3)), note);
  } else if (below(3) == 0) {
    store.change(name, {scene::SceneChange::Kind::kMove, object, nullptr, random_placement(random)},
                 note);
  } else if (below(6) == 0) {
    store.change(name, {scene::SceneChange::Kind::kRemove, object, nullptr, {}}, note);
  } else {
    const auto source = random_box(random);
    store.change(name, {scene::SceneChange::Kind::kPut, object, source, random_placement(random)},
                 note);
  }
}

}  // namespace camway::testing
