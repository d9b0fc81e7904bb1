// SPDX-License-Identifier: MIT
#include "daemon/correction/narrow/way_places.h"

#include "daemon/correction/path/polyline.h"

namespace camway::correction {

namespace {

// Chosen by measurement. Lengths are shares of the radius of the ball about the body.
constexpr double kStep = 0.25;       // spacing of places
constexpr double kMostPlaces = 4e3;  // longer ways are skipped
constexpr double kApart = 2.0;       // ranges closer to each other are one

}  // namespace

std::vector<geometry::Vec3> pulled_tight(const FreeSpace& space,
                                         std::span<const geometry::Vec3> way_W, double radius_m) {
  std::vector<geometry::Vec3> points_W = {way_W.front()};
  for (std::size_t i = 0; i + 1 < way_W.size();) {
    std::size_t next = way_W.size() - 1;
    while (next > i + 1 && !space.ball_passes(way_W[i], way_W[next], radius_m)) --next;
    points_W.push_back(way_W[next]);
    i = next;
  }
  return points_W;
}

std::vector<WayPlace> places_on_way(std::span<const geometry::Vec3> way_W, double radius_m) {
  const double step_m = kStep * radius_m;
  if (!(length_m(way_W) <= kMostPlaces * step_m)) return {};
  std::vector<WayPlace> places = {{way_W.front(), 0}};
  for (std::size_t i = 1; i < way_W.size(); ++i) {
    const int parts = 1 + static_cast<int>((way_W[i] - way_W[i - 1]).norm() / step_m);
    for (int k = 1; k <= parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      places.push_back({(1.0 - share) * way_W[i - 1] + share * way_W[i], i - 1});
    }
  }
  return places;
}

std::vector<PlaceRange> inner_ranges(std::size_t places,
                                     const std::function<bool(std::size_t)>& is_narrow) {
  const auto apart = static_cast<std::size_t>(kApart / kStep);
  std::vector<PlaceRange> ranges;
  for (std::size_t i = 0; i < places; ++i) {
    if (!is_narrow(i)) continue;
    if (!ranges.empty() && i - ranges.back().end < apart) {
      ranges.back().end = i + 1;
    } else {
      ranges.push_back({i, i + 1});
    }
  }
  std::erase_if(ranges,
                [&](const PlaceRange& range) { return range.begin == 0 || range.end == places; });
  return ranges;
}

std::vector<geometry::Vec3> with_neighbours_W(std::span<const WayPlace> places,
                                              const PlaceRange& range) {
  std::vector<geometry::Vec3> points_W;
  for (std::size_t i = range.begin - 1; i <= range.end; ++i) points_W.push_back(places[i].at_W);
  return points_W;
}

}  // namespace camway::correction
