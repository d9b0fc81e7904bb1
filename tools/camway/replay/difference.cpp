// SPDX-License-Identifier: MIT
#include "tools/camway/replay/difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "daemon/planning/result/witness_names.h"
#include "tools/camway/replay/member_walk.h"

namespace camway::tools {
namespace {

using motion::Path;
using motion::Segment;

/// Samples between two joins, where a path is a smooth curve of low degree.
constexpr int kSamplesPerPiece = 32;

/// Stores the words of an answer.
struct WordRecorder {
  void word(std::uint64_t word, const MemberPath&) { words.push_back(word); }
  void size(std::size_t size, const MemberPath&) { words.push_back(size); }

  std::vector<std::uint64_t> words;
};

/// Returns the name of a member: "corrections[1].moved_m".
std::string text_of(const MemberPath& path) {
  std::string text;
  for (const MemberStep& step : path) {
    if (step.name.empty()) {
      text += fmt::format("[{}]", step.index);
    } else {
      text += (text.empty() ? "" : ".") + std::string(step.name);
    }
  }
  return text;
}

/// Compares the words of an answer with those of a recorded one, and describes the first that
/// differs. Up to there both answers have the same lists, so there is a recorded word for each.
class WordComparer {
 public:
  explicit WordComparer(const std::vector<std::uint64_t>& recorded) : recorded_(recorded) {}

  void word(std::uint64_t word, const MemberPath& path) {
    if (take(word)) difference_ = text_of(path);
  }
  void size(std::size_t size, const MemberPath& path) {
    const std::size_t at = next_;
    if (take(size)) difference_ = fmt::format("{} {} -> {}", text_of(path), recorded_[at], size);
  }
  /// Empty if all words are equal.
  [[nodiscard]] const std::string& difference() const { return difference_; }

 private:
  /// Returns whether this is the first word that differs.
  bool take(std::uint64_t word) { return difference_.empty() && recorded_[next_++] != word; }

  const std::vector<std::uint64_t>& recorded_;
  std::size_t next_ = 0;
  std::string difference_;
};

/// Walks all members, but for times of planning.
template <class Sink>
void walk(Sink& sink, const planning::PlanResult& result) {
  MemberWalk io(sink);
  planning::head_members(io, result);
  io.need("keyframes", result.keyframes);
  io.need("segments", result.path.segments());
  planning::report_members(io, result);
}

template <class Sink>
void walk(Sink& sink, const Path& path) {
  MemberWalk(sink).need("segments", path.segments());
}

/// Returns the first difference of two answers, or of two paths; empty if their bits are the same.
template <class Walked>
std::string first_difference(const Walked& recorded, const Walked& now) {
  WordRecorder recorder;
  walk(recorder, recorded);
  WordComparer comparer(recorder.words);
  walk(comparer, now);
  return comparer.difference();
}

double pose_distance_m(const motion::Body& body, const motion::Pose& a, const motion::Pose& b) {
  const geometry::Vec3 moved = b.position - a.position;
  const Eigen::Matrix3d turned =
      b.orientation.toRotationMatrix() - a.orientation.toRotationMatrix();
  double largest = moved.norm();
  for (const geometry::Triangle& triangle : body.triangles_C()) {
    for (const geometry::Vec3& corner_C : triangle) {
      const geometry::Vec3 apart = moved + turned * corner_C;
      largest = std::max(largest, apart.norm());
    }
  }
  return largest;
}

double path_distance_m(const Path& a, const Path& b, const motion::Body& body) {
  if (same_bits(a, b)) return 0.0;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (a.empty() || b.empty()) return kInfinity;
  if (a.begin_s() != b.begin_s() || a.end_s() != b.end_s()) return kInfinity;
  std::vector<double> joins{a.begin_s()};
  for (const Path* path : {&a, &b}) {
    for (const Segment& segment : path->segments()) joins.push_back(segment.t1_s);
  }
  std::sort(joins.begin(), joins.end());
  double largest = 0.0;
  for (std::size_t i = 1; i < joins.size(); ++i) {
    for (int k = 0; k <= kSamplesPerPiece; ++k) {
      const double time_s = joins[i - 1] + (joins[i] - joins[i - 1]) * k / kSamplesPerPiece;
      const double distance_m = pose_distance_m(body, a.pose(time_s), b.pose(time_s));
      // A pose with NaN must not count as no difference.
      largest = distance_m >= 0.0 ? std::max(largest, distance_m) : kInfinity;
    }
  }
  // Different bits can round to the same samples, but only equal bits may give 0.
  return std::max(largest, std::numeric_limits<double>::denorm_min());
}

}  // namespace

bool same_bits(const Path& a, const Path& b) { return first_difference(a, b).empty(); }

Difference difference_of(const planning::PlanResult& recorded, const planning::PlanResult& now,
                         const motion::Body& body) {
  Difference difference{path_distance_m(recorded.path, now.path, body), {}};
  if (recorded.status == now.status) {
    difference.what = first_difference(recorded, now);
  } else {
    difference.what = fmt::format("status {} -> {}", planning::to_string(recorded.status),
                                  planning::to_string(now.status));
  }
  return difference;
}

}  // namespace camway::tools
