// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/way_places.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/correction/search_scene.h"

namespace camway::correction {
namespace {

using geometry::Vec3;

const std::vector<Vec3> kWay_W = {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {1, 2, 0.1}};

/// A plate in the plane z = 0 over which the ways lead.
testing_search::SearchScene plate() {
  scene::Mesh mesh;
  testing::add_cuboid(mesh, {-0.5, -0.5, -0.1}, {0.5, 0.5, 0.1});
  return testing_search::SearchScene(mesh);
}

TEST(PulledTight, LeavesOutWhatTheBallCanSkip) {
  const testing_search::SearchScene scene = plate();
  const FreeSpace space = scene.space();
  const std::vector<Vec3> up_and_down_W = {{-2, 0, 1},  {-1.5, 0, 1.4}, {-1, 0, 0.6},
                                           {0, 0, 1.2}, {1, 0, 0.7},    {2, 0, 1}};
  EXPECT_EQ(pulled_tight(space, up_and_down_W, 0.2),
            (std::vector<Vec3>{up_and_down_W.front(), up_and_down_W.back()}));
  const std::vector<Vec3> over_W = {{-2, 0, 0}, {-1, 0, 0.3}, {0, 0, 0.5}, {1, 0, 0.3}, {2, 0, 0}};
  const std::vector<Vec3> pulled_W = pulled_tight(space, over_W, 0.2);
  EXPECT_EQ(pulled_W, (std::vector<Vec3>{over_W[0], over_W[2], over_W[4]}));
  for (std::size_t i = 1; i < pulled_W.size(); ++i)
    EXPECT_TRUE(space.ball_passes(pulled_W[i - 1], pulled_W[i], 0.2));
}

TEST(PulledTight, KeepsStepsThatTheBallCannotPass) {
  const testing_search::SearchScene scene = plate();
  const std::vector<Vec3> through_W = {{0, 0, -2}, {0, 0, -1}, {0, 0, 1}, {0, 0, 2}};
  EXPECT_EQ(pulled_tight(scene.space(), through_W, 0.2), through_W);
  EXPECT_EQ(pulled_tight(scene.space(), {through_W.begin(), 1}, 0.2).size(), 1U);
}

TEST(PlacesOnWay, AreEveryQuarterOfTheRadiusAndAtItsPoints) {
  for (const double radius_m : {0.1, 0.7, 5.0}) {
    const std::vector<WayPlace> places = places_on_way(kWay_W, radius_m);
    EXPECT_EQ(places.front().at_W, kWay_W.front());
    EXPECT_EQ(places.back().at_W, kWay_W.back());
    for (const Vec3& point_W : kWay_W) {
      EXPECT_TRUE(std::ranges::any_of(
          places, [&](const WayPlace& place) { return place.at_W == point_W; }));
    }
    for (std::size_t i = 1; i < places.size(); ++i) {
      EXPECT_LE((places[i].at_W - places[i - 1].at_W).norm(), 0.25 * radius_m + 1e-12);
      const Vec3 leg_W = kWay_W[places[i].leg + 1] - kWay_W[places[i].leg];
      EXPECT_LE((places[i].at_W - kWay_W[places[i].leg]).norm(), leg_W.norm() + 1e-12);
      EXPECT_GE(places[i].leg, places[i - 1].leg);
    }
  }
}

TEST(PlacesOnWay, AreNoneWhereTheyWouldBeTooMany) {
  EXPECT_TRUE(places_on_way(kWay_W, 1e-3).empty());
}

std::vector<std::pair<std::size_t, std::size_t>> ranges(const std::set<std::size_t>& narrow) {
  constexpr std::size_t kPlaces = 40;
  std::vector<std::pair<std::size_t, std::size_t>> result;
  for (const PlaceRange& range :
       inner_ranges(kPlaces, [&](std::size_t i) { return narrow.contains(i); })) {
    result.emplace_back(range.begin, range.end);
  }
  return result;
}

using Ranges = std::vector<std::pair<std::size_t, std::size_t>>;

TEST(InnerRanges, AreOneWhereTheyAreLessThanTheDiameterApart) {
  EXPECT_EQ(ranges({}), Ranges{});
  EXPECT_EQ(ranges({10}), (Ranges{{10, 11}}));
  EXPECT_EQ(ranges({10, 11, 18}), (Ranges{{10, 19}}));
  EXPECT_EQ(ranges({10, 11, 20}), (Ranges{{10, 12}, {20, 21}}));
}

TEST(InnerRanges, LeaveOutTheEndsOfTheWay) {
  EXPECT_EQ(ranges({0, 1, 20, 38, 39}), (Ranges{{20, 21}}));
}

TEST(WithNeighbours, AreThePlacesOfTheRangeAndOneMoreOnEitherSide) {
  const std::vector<WayPlace> places = places_on_way(kWay_W, 1.0);
  const std::vector<Vec3> points_W = with_neighbours_W(places, {2, 4});
  ASSERT_EQ(points_W.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(points_W[i], places[i + 1].at_W);
}

}  // namespace
}  // namespace camway::correction
