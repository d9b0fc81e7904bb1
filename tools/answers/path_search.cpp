// SPDX-License-Identifier: MIT
#include "tools/answers/path_search.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "daemon/planning/result/path_faults.h"
#include "daemon/planning/stages/path_check.h"

namespace camway::tools {
namespace {

using collision::CollisionInterval;

/// Number of parts that are searched in turn. They cost a few probes more than one search of the
/// whole path, and a deadline discards the result of at most one part.
constexpr int kParts = 100;

/// Sorts the intervals and merges those that touch, with the deepest witness.
void merge_touching(std::vector<CollisionInterval>& intervals) {
  std::ranges::stable_sort(intervals, {}, &CollisionInterval::t_begin_s);
  std::vector<CollisionInterval> merged;
  for (const CollisionInterval& next : intervals) {
    if (merged.empty() || next.t_begin_s > merged.back().t_end_s) {
      merged.push_back(next);
      continue;
    }
    CollisionInterval& before = merged.back();
    before.t_end_s = std::max(before.t_end_s, next.t_end_s);
    const bool deeper =
        next.witness && (!before.witness || next.witness->depth_m > before.witness->depth_m);
    if (deeper) before.witness = next.witness;
  }
  intervals = std::move(merged);
}

class Searcher {
 public:
  Searcher(const collision::Query& query, const motion::Path& path, const base::Deadline& deadline)
      : query_(query), path_(path), deadline_(deadline), bridges_(planning::bridges(path)) {}

  PathSearch run() {
    PathSearch search;
    search.searched_until_s = path_.begin_s();
    search.complete = true;
    for (int part = 1; part <= kParts && search.complete; ++part) {
      const double end_s = part_end_s(part);
      search.complete = search_part(search.searched_until_s, end_s, search.collisions) &&
                        search_bridges(end_s, search.collisions);
      if (search.complete) search.searched_until_s = end_s;
    }
    merge_touching(search.collisions);
    if (search.complete && search.collisions.empty()) search.certificate = certificate();
    return search;
  }

 private:
  [[nodiscard]] double part_end_s(int part) const {
    if (part == kParts) return path_.end_s();
    const double share = static_cast<double>(part) / kParts;
    return std::min(path_.begin_s() + share * (path_.end_s() - path_.begin_s()), path_.end_s());
  }

  // Returns false if the deadline came first.
  bool search_part(double begin_s, double end_s, std::vector<CollisionInterval>& found) const {
    const auto intervals = collision::detect_collisions(query_, path_, begin_s, end_s, deadline_);
    if (intervals) found.insert(found.end(), intervals->begin(), intervals->end());
    return intervals.has_value();
  }

  // Searches the bridges up to `end_s` that were not searched yet; false if the deadline came
  // first.
  bool search_bridges(double end_s, std::vector<CollisionInterval>& found) {
    for (; next_bridge_ < bridges_.size(); ++next_bridge_) {
      const planning::Bridge& bridge = bridges_[next_bridge_];
      if (bridge.time_s > end_s) return true;
      const auto hits = collision::detect_collisions(query_, bridge.path, bridge.path.begin_s(),
                                                     bridge.path.end_s(), deadline_);
      if (!hits) return false;
      if (!hits->empty()) found.push_back({bridge.time_s, bridge.time_s, hits->front().witness});
    }
    return true;
  }

  [[nodiscard]] planning::Certificate certificate() const {
    planning::Certificate all = planning::certificate_of_free(query_, path_, deadline_);
    for (const planning::Bridge& bridge : bridges_) {
      const planning::Certificate one =
          planning::certificate_of_free(query_, bridge.path, deadline_);
      all.clearance_lower_bound_m =
          std::min(all.clearance_lower_bound_m, one.clearance_lower_bound_m);
    }
    return all;
  }

  const collision::Query& query_;
  const motion::Path& path_;
  const base::Deadline& deadline_;
  const std::vector<planning::Bridge> bridges_;  ///< in order of time
  std::size_t next_bridge_ = 0;
};

}  // namespace

PathSearch search_path(const collision::Query& query, const motion::Path& path,
                       const base::Deadline& deadline) {
  return Searcher(query, path, deadline).run();
}

}  // namespace camway::tools
