// SPDX-License-Identifier: MIT
#include "daemon/scene/snapshot/scene_change.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/scene/snapshot/shape_mesh.h"
#include "tests/scene/index/index_oracle.h"
#include "tests/scene/test_meshes.h"

namespace camway::scene {
namespace {

using geometry::Quat;
using geometry::RandomTriangles;
using geometry::Triangle;
using geometry::Vec3;
using ::testing::HasSubstr;
using ChangeKind = SceneChange::Kind;

ObjectOptions mirrored() {
  ObjectOptions options;
  options.occupancy_resolution_m = 0.25;
  return options;
}

std::shared_ptr<const ObjectSource> box(const Vec3& size_m) {
  Mesh mesh = *box_mesh(size_m);
  const ImportReport report = report_of(mesh, "box");
  return make_source(ObjectKind::kBox, std::move(mesh), report, mirrored());
}

Placement at(const Vec3& position, const Quat& orientation = Quat::Identity()) {
  std::string fault;
  return Placement::make(position, orientation, fault);
}

std::shared_ptr<const Snapshot> empty_scene(const ObjectOptions& options = mirrored()) {
  return assemble("room", 1, {}, options);
}

std::shared_ptr<const Snapshot> after(const Snapshot& before, const SceneChange& change) {
  SnapshotResult result = changed(before, change, before.revision + 1);
  EXPECT_TRUE(result.snapshot) << result.error;
  return result.snapshot;
}

/// Returns a possible change of one of a few objects of `scene`.
SceneChange random_change(RandomTriangles& random, const Snapshot& scene) {
  SceneChange change;
  change.object = std::string(1, static_cast<char>('a' + random.integer(0, 5)));
  const bool is_there = scene.find(change.object) != nullptr;
  const int kind = random.integer(0, 5);
  change.kind = !is_there || kind == 0 ? ChangeKind::kPut
                : kind == 1            ? ChangeKind::kRemove
                                       : ChangeKind::kMove;
  if (change.kind == ChangeKind::kPut)
    change.source = box(Vec3(0.2, 0.2, 0.2) + random.in_cube(0.1));
  change.placement = at(random.in_cube(2.0), Quat(1, random.uniform(-1, 1), 0, 0.3));
  return change;
}

/// Expects that everything visible of two equal scenes is equal.
void expect_same(const Snapshot& a, const Snapshot& b) {
  EXPECT_EQ(a.digest, b.digest);
  EXPECT_EQ(a.mesh->vertices, b.mesh->vertices);
  EXPECT_EQ(a.mesh->triangles, b.mesh->triangles);
  EXPECT_TRUE(a.index.has_same_trees_as(b.index));
  EXPECT_EQ(a.index.statistics(), b.index.statistics());
  EXPECT_EQ(a.occupancy->statistics().occupied_voxels, b.occupancy->statistics().occupied_voxels);
  EXPECT_EQ(a.field == nullptr, b.field == nullptr);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    EXPECT_EQ(a.objects[i]->name, b.objects[i]->name);
    EXPECT_EQ(a.objects[i]->digest, b.objects[i]->digest);
  }
}

TEST(SceneChange, SharesWhatDidNotChange) {
  const auto one =
      after(*empty_scene(), {ChangeKind::kPut, "wall", box(Vec3(4, 1, 0.1)), at(Vec3(0, 0, 3))});
  const auto two = after(*one, {ChangeKind::kPut, "ball", box(Vec3(1, 1, 1)), {}});
  const auto three = after(*two, {ChangeKind::kMove, "ball", nullptr, at(Vec3(0, 5, 0))});
  EXPECT_EQ(three->revision, 4U);
  EXPECT_EQ(three->find("wall"), one->find("wall"));
  EXPECT_EQ(three->find("ball")->source, two->find("ball")->source);
  EXPECT_NE(three->digest, two->digest);
  EXPECT_EQ(two->mesh->bounds().min().z(), -0.5) << "what was there stays as it was";
  EXPECT_EQ(three->index.bounds().max().y(), 5.5);
  EXPECT_EQ(three->mesh.object_name(0), "ball") << "in order of name";
  EXPECT_EQ(three->mesh.object_name(12), "wall");
}

// Index, field and mirror of a changed scene are compared with those of a scene built from the same
// triangles.
TEST(SceneChange, LeavesASceneAsIfBuiltAtOnce) {
  RandomTriangles random(1501);
  std::shared_ptr<const Snapshot> scene = empty_scene();
  for (int step = 0; step < 120; ++step) {
    scene = after(*scene, random_change(random, *scene));
    if (scene->objects.empty() || step % 4 != 0) continue;
    SnapshotOptions options;
    options.occupancy_resolution_m = 0.25;
    const auto flat = make_snapshot("flat", *scene->mesh, options).snapshot;
    for (int i = 0; i < 60; ++i) {
      const Vec3 p = random.in_cube(3.0);
      const std::array<Triangle, 1> body = {
          Triangle{p, p + random.in_cube(0.3), p + random.in_cube(0.3)}};
      expect_equal(scene->index.nearest(body, kInfinity), flat->index.nearest(body, kInfinity));
      ASSERT_EQ(scene->index.first_intersection(body[0]), flat->index.first_intersection(body[0]));
      ASSERT_EQ(scene->occupancy->occupied_at(p), flat->occupancy->occupied_at(p));
      ASSERT_EQ(scene->occupancy->distance_m(p, 2.0), flat->occupancy->distance_m(p, 2.0));
    }
    ASSERT_FALSE(HasFailure()) << "step " << step;
  }
}

TEST(SceneChange, DependsOnWhatIsThereAndNotOnHowItCame) {
  const auto source = box(Vec3(1, 2, 3));
  const auto first =
      after(*after(*empty_scene(), {ChangeKind::kPut, "a", source, at(Vec3(1, 0, 0))}),
            {ChangeKind::kPut, "b", source, at(Vec3(9, 0, 0))});
  auto second = after(*empty_scene(), {ChangeKind::kPut, "b", source, {}});
  second = after(*second, {ChangeKind::kPut, "c", source, {}});
  second = after(*second, {ChangeKind::kPut, "a", source, at(Vec3(1, 0, 0))});
  second = after(*second, {ChangeKind::kRemove, "c", nullptr, {}});
  second = after(*second, {ChangeKind::kMove, "b", nullptr, at(Vec3(9, 0, 0))});
  expect_same(*first, *second);
}

TEST(SceneChange, OfASingleObjectHasItsDigest) {
  const Mesh mesh = mesh_of_triangles({{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}});
  EXPECT_EQ(make_snapshot("room", mesh).snapshot->digest, mesh_digest(mesh));
  EXPECT_EQ(empty_scene()->digest, mesh_digest(Mesh()));
}

TEST(SceneChange, SaysWhatCannotBeDone) {
  const auto scene = after(*empty_scene(), {ChangeKind::kPut, "a", box(Vec3(1, 1, 1)), {}});
  EXPECT_THAT(changed(*scene, {ChangeKind::kMove, "b", nullptr, {}}, 3).error, HasSubstr("'b'"));
  EXPECT_THAT(changed(*scene, {ChangeKind::kRemove, "b", nullptr, {}}, 3).error,
              HasSubstr("'room'"));
  // 32768 voxels of 0.25 m.
  const SceneChange far{ChangeKind::kMove, "a", nullptr, at(Vec3(8193, 0, 0))};
  const std::string error = changed(*scene, far, 3).error;
  EXPECT_THAT(error, HasSubstr("a: "));
  EXPECT_THAT(error, HasSubstr("8192.5"));
  EXPECT_THAT(error, HasSubstr("0.25 m"));
  ObjectOptions plain;
  const auto unmirrored = changed(
      *empty_scene(plain), {ChangeKind::kPut, "a", box(Vec3(1, 1, 1)), at(Vec3(1e9, 0, 0))}, 2);
  EXPECT_THAT(unmirrored.error, HasSubstr("1e9 m"));
}

TEST(SceneHistory, BuildsEveryRevisionAgain) {
  RandomTriangles random(1502);
  std::vector<std::shared_ptr<const Snapshot>> revisions{empty_scene()};
  SceneHistory history(*revisions.front(), {.changes = 30});
  for (int i = 0; i < 50; ++i) {
    SceneChange change = random_change(random, *revisions.back());
    revisions.push_back(after(*revisions.back(), change));
    history.add({std::move(change)}, {revisions.back()->revision, {}});
  }
  EXPECT_EQ(history.entries().size(), 30U);
  EXPECT_EQ(history.oldest_revision(), revisions.back()->revision - 30);
  for (const auto& revision : revisions) {
    const auto again = history.rebuild(revision->revision);
    ASSERT_EQ(again != nullptr, revision->revision >= history.oldest_revision());
    if (again) expect_same(*again, *revision);
    if (HasFailure()) return;
  }
  EXPECT_EQ(history.rebuild(revisions.back()->revision + 1), nullptr);
}

TEST(SceneHistory, GoesBackToEveryRevisionThatItKeeps) {
  RandomTriangles random(1503);
  std::vector<std::shared_ptr<const Snapshot>> revisions{empty_scene()};
  SceneHistory history(*revisions.front(), {.changes = 20});
  for (int i = 0; i < 60; ++i) {
    SceneChanges changes;
    if (i % 3 == 2) {
      const std::uint64_t first = history.oldest_revision();
      const std::uint64_t back =
          first + static_cast<std::uint64_t>(i * 7) % (revisions.back()->revision - first + 1);
      changes = history.changes_back_to(back).value();
      const auto now = changed(*revisions.back(), changes, revisions.back()->revision + 1).snapshot;
      ASSERT_TRUE(now);
      const Snapshot& then = **std::ranges::find(revisions, back, &Snapshot::revision);
      EXPECT_EQ(now->digest, then.digest);
      expect_same(*history.rebuild(back), then);
      revisions.push_back(now);
    } else {
      changes = {random_change(random, *revisions.back())};
      revisions.push_back(after(*revisions.back(), changes.front()));
    }
    history.add(std::move(changes), {revisions.back()->revision, {}});
    expect_same(*history.rebuild(revisions.back()->revision), *revisions.back());
    if (HasFailure()) return;
  }
  EXPECT_TRUE(history.changes_back_to(revisions.back()->revision)->empty());
  EXPECT_FALSE(history.changes_back_to(history.oldest_revision() - 1));
  EXPECT_FALSE(history.changes_back_to(revisions.back()->revision + 1));
}

TEST(SceneHistory, KeepsWithinItsBytes) {
  std::shared_ptr<const Snapshot> scene = empty_scene();
  SceneHistory history(*scene, {.changes = 1000, .bytes = 3 * box(Vec3(1, 1, 1))->memory_bytes()});
  for (int i = 0; i < 10; ++i) {
    const SceneChange change{ChangeKind::kPut, "a", box(Vec3(1, 1, 1)), at(Vec3(i, 0, 0))};
    scene = after(*scene, change);
    history.add({change}, {scene->revision, {}});
  }
  EXPECT_EQ(history.entries().size(), 3U);
  expect_same(*history.rebuild(scene->revision), *scene);
}

}  // namespace
}  // namespace camway::scene
