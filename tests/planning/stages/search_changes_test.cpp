// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/search_changes.h"

#include <gtest/gtest.h>

#include <set>

#include "daemon/motion/spline/interpolate.h"
#include "tests/support/scenes.h"

namespace camway::planning {
namespace {

using base::Deadline;
using collision::CollisionInterval;
using collision::FoundCollisions;
using geometry::Quat;

constexpr int kPosts = 5;

// A straight flight of ten seconds past posts, one every two seconds, with keyframes at full
// seconds.
class SearchChanges : public ::testing::Test {
 protected:
  SearchChanges() {
    scene::Mesh mesh;
    for (int i = 0; i < kPosts; ++i)
      testing::add_cuboid(mesh, {2.0 * i + 0.49, -1, -0.4}, {2.0 * i + 0.51, 1, 0.4});
    index_ = scene::SceneIndex::build(mesh);
    before_ = flight();
    changed_ = before_;
    collisions_ = *collision::detect_collisions({collision::Obstacles(index_), body_},
                                                before_.path(), 0.0, 10.0, Deadline::never());
  }

  // Moves the part of one second from `first` on aside.
  void move_aside(int first) {
    motion::CubicPath part = changed_.around(1.0 * first, first + 1.0);
    for (motion::CubicPiece& piece : part.pieces) {
      piece.position[1].z() += 2.0;
      piece.position[2].z() += 2.0;
    }
    changed_.replace(part);
  }

  static motion::CubicPath flight() {
    std::vector<motion::Keyframe> keyframes;
    for (int i = 0; i <= 2 * kPosts; ++i)
      keyframes.push_back({1.0 * i, {{1.0 * i, 0, 0}, Quat::Identity()}});
    return motion::interpolate_cubic(keyframes);
  }

  FoundCollisions search(const FoundCollisions& begun, const Deadline& deadline) const {
    const motion::Path before = before_.path();
    return search_changes({collision::Obstacles(index_), body_}, changed_.path(),
                          {before, collisions_}, begun, deadline);
  }
  FoundCollisions search() const { return search({false, {}, 0.0}, Deadline::never()); }

  scene::SceneIndex index_;
  motion::Body body_ = motion::Body(testing::small_camera());
  motion::CubicPath before_;
  motion::CubicPath changed_;
  std::vector<CollisionInterval> collisions_;
};

TEST_F(SearchChanges, WhatIsUnchangedIsAsItWasKnownToBe) {
  ASSERT_EQ(collisions_.size(), static_cast<std::size_t>(kPosts));
  const FoundCollisions found = search({false, {}, 0.0}, Deadline::after_s(0.0));
  EXPECT_TRUE(found.complete);
  EXPECT_EQ(found.until_s, 10.0);
  EXPECT_EQ(found.collisions, collisions_);
}

TEST_F(SearchChanges, WhatIsChangedIsSearched) {
  move_aside(2);
  move_aside(6);
  const std::vector<CollisionInterval> left = {collisions_[0], collisions_[2], collisions_[4]};
  EXPECT_EQ(search().collisions, left);
  before_ = changed_;
  collisions_ = left;
  changed_ = flight();
  const FoundCollisions back = search();
  ASSERT_EQ(back.collisions.size(), static_cast<std::size_t>(kPosts));
  EXPECT_NEAR(back.collisions[1].t_begin_s, 2.4, 0.1);
}

// Known parts are not searched again, and changed parts are no longer known.
TEST_F(SearchChanges, KnowsNoMoreThanItWasTold) {
  move_aside(2);
  collisions_ = {{1.2, 1.4}, {2.1, 2.9}, {7.9, 8.3}};
  const std::vector<CollisionInterval> left = {{1.2, 1.4}, {7.9, 8.3}};
  EXPECT_EQ(search().collisions, left);
}

TEST_F(SearchChanges, CutsWhatReachesIntoTheChange) {
  move_aside(2);
  collisions_ = {{1.5, 2.0}, {2.5, 3.5}, {4.5, 4.5}};
  const std::vector<CollisionInterval> left = {{1.5, 2.0}, {3.0, 3.5}, {4.5, 4.5}};
  EXPECT_EQ(search().collisions, left);
}

TEST_F(SearchChanges, GoesOnWhereASearchWasGivenUp) {
  move_aside(2);
  move_aside(6);
  for (const double until_s : {1.5, 2.0, 2.5, 3.0, 5.5, 6.5, 9.5}) {
    FoundCollisions begun{false, {}, until_s};
    for (const CollisionInterval& collision : search().collisions)
      if (collision.t_begin_s < until_s) begun.collisions.push_back(collision);
    EXPECT_EQ(search(begun, Deadline::never()).collisions, search().collisions) << until_s;
  }
}

// If the search is cut short anywhere, the collisions are those of the path that is put back from
// there on.
TEST_F(SearchChanges, WhereTheDeadlineStrikesThePathIsToBePutBack) {
  move_aside(2);
  move_aside(6);
  std::set<double> cuts_s;
  for (int looks = 0;; ++looks) {
    const FoundCollisions found = search({false, {}, 0.0}, Deadline::after_looks(looks));
    if (found.complete) break;
    cuts_s.insert(found.until_s);
    const motion::CubicPath mixed = with_rest_of(changed_, before_, found.until_s);
    EXPECT_EQ(mixed.pieces.size(), before_.pieces.size());
    const auto all = collision::detect_collisions({collision::Obstacles(index_), body_},
                                                  mixed.path(), 0.0, 10.0, Deadline::never());
    ASSERT_EQ(found.collisions.size(), all->size()) << looks;
    for (std::size_t i = 0; i < all->size(); ++i)
      EXPECT_NEAR(found.collisions[i].t_begin_s, (*all)[i].t_begin_s, 0.01) << looks;
  }
  EXPECT_EQ(cuts_s, (std::set<double>{2.0, 6.0}));
}

}  // namespace
}  // namespace camway::planning
