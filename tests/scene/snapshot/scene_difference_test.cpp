// SPDX-License-Identifier: MIT
#include "daemon/scene/snapshot/scene_difference.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "daemon/scene/snapshot/scene_store.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace camway::scene {
namespace {

using geometry::Quat;
using geometry::Vec3;
using ChangeKind = SceneChange::Kind;

Placement placed_at(const Vec3& position) {
  std::string fault;
  return Placement::make(position, Quat::Identity(), fault);
}

std::shared_ptr<const ObjectSource> box(double side_m) {
  Mesh mesh = *box_mesh(Vec3::Constant(side_m));
  const ImportReport report = report_of(mesh, "box");
  return make_source(ObjectKind::kBox, std::move(mesh), report, {});
}

/// Objects by name; their bounds distinguish them here, because no two have the same.
using Places = std::map<std::string, Vec3>;

Places places_of(const Snapshot& snapshot) {
  Places places;
  for (const auto& object : snapshot.objects) {
    places[object->name] = object->bounds_W.min();
  }
  return places;
}

std::multiset<double> firsts(const std::vector<Vec3>& points) {
  std::multiset<double> values;
  for (const Vec3& point : points) values.insert(point.x());
  return values;
}

TEST(SceneDifference, IsWhatComparingAllObjectsSays) {
  testing::Random random(5311);
  std::uniform_real_distribution<double> place(-10.0, 10.0);
  SceneStore store;
  store.put(assemble("room", 1, {}, {}));
  for (int round = 0; round < 50; ++round) {
    const auto before = store.find("room");
    for (int change = 0; change < 4; ++change) {
      const std::string name(1, static_cast<char>('a' + random() % 6));
      const ChangeKind kind = static_cast<ChangeKind>(random() % 3);
      store.change("room", {kind, name, kind == ChangeKind::kPut ? box(0.5) : nullptr,
                            placed_at({place(random), place(random), place(random)})});
    }
    const auto after = store.find("room");
    const SceneDifference found = difference(*before, *after);
    const Places old = places_of(*before);
    const Places now = places_of(*after);
    std::vector<Vec3> added;
    std::vector<Vec3> removed;
    for (const auto& [name, min] : now) {
      if (!old.contains(name) || old.at(name) != min) added.push_back(min);
    }
    for (const auto& [name, min] : old) {
      if (!now.contains(name) || now.at(name) != min) removed.push_back(min);
    }
    std::vector<Vec3> found_added;
    std::vector<Vec3> found_removed;
    for (const auto& come : found.added) found_added.push_back(come.min());
    EXPECT_EQ(found.index.size(), 12 * added.size());
    for (const auto& gone : found.removed) found_removed.push_back(gone.min());
    EXPECT_EQ(firsts(found_added), firsts(added));
    EXPECT_EQ(firsts(found_removed), firsts(removed));
  }
}

TEST(SceneDifference, OfARevisionToItselfIsNone) {
  SceneStore store;
  store.put(assemble("room", 1, {}, {}));
  store.change("room", {ChangeKind::kPut, "a", box(1.0), placed_at({0, 0, 0})});
  const auto snapshot = store.find("room");
  EXPECT_TRUE(difference(*snapshot, *snapshot).empty());
}

TEST(SceneDifference, AnotherSceneOfThatNameIsAllNew) {
  const auto make = [] {
    SceneStore store;
    store.put(assemble("room", 1, {}, {}));
    return store.change("room", {ChangeKind::kPut, "a", box(1.0), placed_at({0, 0, 0})}).snapshot;
  };
  const SceneDifference found = difference(*make(), *make());
  EXPECT_EQ(found.added.size(), 1U);
  EXPECT_EQ(found.removed.size(), 1U);
}

}  // namespace
}  // namespace camway::scene
