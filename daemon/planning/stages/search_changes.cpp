// SPDX-License-Identifier: MIT
#include "daemon/planning/stages/search_changes.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace camway::planning {

namespace {

using collision::CollisionInterval;
using motion::Segment;

bool are_same(const Segment& a, const Segment& b) {
  return a.t0_s == b.t0_s && a.t1_s == b.t1_s && a.position == b.position &&
         a.orientation == b.orientation;
}

/// Returns for each of `segments` whether `known` has it too. Both are in order of time.
std::vector<bool> known_segments(std::span<const Segment> segments,
                                 std::span<const Segment> known) {
  std::vector<bool> is_known;
  is_known.reserve(segments.size());
  auto next = known.begin();
  for (const Segment& segment : segments) {
    while (next != known.end() && next->t0_s < segment.t0_s) ++next;
    is_known.push_back(next != known.end() && are_same(*next, segment));
  }
  return is_known;
}

/// Intervals in order of time; those that touch become one.
class Intervals {
 public:
  void add(const CollisionInterval& interval) {
    if (all_.empty() || all_.back().t_end_s < interval.t_begin_s) {
      all_.push_back(interval);
      return;
    }
    CollisionInterval& last = all_.back();
    last.t_end_s = std::max(last.t_end_s, interval.t_end_s);
    if (!last.witness) last.witness = interval.witness;
  }

  /// Adds the parts of `collisions` that lie between the two times.
  void add_between(const std::vector<CollisionInterval>& collisions, double begin_s, double end_s) {
    auto next = std::ranges::lower_bound(collisions, begin_s, {}, &CollisionInterval::t_end_s);
    for (; next != collisions.end() && next->t_begin_s <= end_s; ++next) {
      CollisionInterval part = *next;
      part.t_begin_s = std::max(part.t_begin_s, begin_s);
      part.t_end_s = std::min(part.t_end_s, end_s);
      // A range that is free up to its end, or from its beginning, is free at that instant too.
      const bool only_touches = part.t_begin_s == part.t_end_s && next->t_begin_s < next->t_end_s;
      if (only_touches) continue;
      const auto& witness = part.witness;
      if (witness && (witness->time_s < part.t_begin_s || witness->time_s > part.t_end_s))
        part.witness.reset();
      add(part);
    }
  }

  std::vector<CollisionInterval> take() && { return std::move(all_); }

 private:
  std::vector<CollisionInterval> all_;
};

}  // namespace

collision::FoundCollisions search_changes(const collision::Query& query, const motion::Path& path,
                                          const SearchedPath& known,
                                          const collision::FoundCollisions& begun,
                                          const base::Deadline& deadline) {
  const std::span<const Segment> segments = path.segments();
  const std::vector<bool> is_known = known_segments(segments, known.path.segments());
  std::size_t first = path.segment_index(begun.until_s);
  while (first > 0 && is_known[first - 1] == is_known[first]) --first;
  Intervals found;
  found.add_between(begun.collisions, path.begin_s(), segments[first].t0_s);
  for (std::size_t last = first; first < segments.size(); first = last) {
    while (last < segments.size() && is_known[last] == is_known[first]) ++last;
    const double begin_s = segments[first].t0_s;
    const double end_s = segments[last - 1].t1_s;
    if (is_known[first]) {
      found.add_between(known.collisions, begin_s, end_s);
      continue;
    }
    const std::span<const Segment> run = segments.subspan(first, last - first);
    const motion::Path changed(std::vector<Segment>(run.begin(), run.end()));
    const double from_s = std::max(begun.until_s, begin_s);
    const collision::FoundCollisions part =
        collision::search_collisions(query, changed, from_s, end_s, deadline);
    if (!part.complete) {
      found.add_between(known.collisions, begin_s, path.end_s());
      return {false, std::move(found).take(), begin_s};
    }
    found.add_between(begun.collisions, begin_s, from_s);
    found.add_between(part.collisions, from_s, end_s);
  }
  return {true, std::move(found).take(), path.end_s()};
}

motion::CubicPath with_rest_of(motion::CubicPath path, const motion::CubicPath& rest,
                               double from_s) {
  std::erase_if(path.pieces, [&](const motion::CubicPiece& piece) { return piece.t0_s >= from_s; });
  const auto first = std::ranges::lower_bound(rest.pieces, from_s, {}, &motion::CubicPiece::t0_s);
  path.pieces.insert(path.pieces.end(), first, rest.pieces.end());
  return path;
}

}  // namespace camway::planning
