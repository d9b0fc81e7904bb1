// SPDX-License-Identifier: MIT
#include "tools/camway/replay/difference.h"

#include <camway/members.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "daemon/messages/plan.h"
#include "daemon/messages/text.h"
#include "daemon/planning/result/result_members.h"

namespace camway::tools {
namespace {

using motion::Path;
using motion::Segment;
using planning::FileName;
using planning::PlanResult;

/// Samples between two joins, where a path is a smooth curve of low degree.
constexpr int kSamplesPerPiece = 32;

/// Members that tell how an answer was found, and not what it is.
constexpr std::array<std::string_view, 3> kLeftOut{"message", "tried", "deadline_reached"};

/// Returns whether two members of messages have the same bits.
template <class Member>
bool has_same_bits(const Member& then, const Member& now) {
  if constexpr (wire::Described<Member>) {
    bool same = true;
    wire::for_each_member<Member>([&](const auto& described) {
      same = same && has_same_bits(then.*described.member, now.*described.member);
    });
    return same;
  } else if constexpr (std::is_same_v<Member, std::string>) {
    return then == now;
  } else {
    static_assert(std::is_arithmetic_v<std::remove_all_extents_t<Member>>);
    return std::memcmp(&then, &now, sizeof(Member)) == 0;
  }
}
template <class Member>
bool has_same_bits(const std::tuple<Member&, Member&>& then,
                   const std::tuple<Member&, Member&>& now) {
  return has_same_bits(std::get<0>(then), std::get<0>(now)) &&
         has_same_bits(std::get<1>(then), std::get<1>(now));
}

/// Finds the first member in which a recorded message differs from the message of a new result. The
/// lists of members (`planning/result/result_members.h`) call it with each member of the result, of
/// the recorded message and of the new one.
/// Not thread-safe.
class MessageComparer {
 public:
  template <class Mine, class Member>
  void operator()(FileName name, const Mine& mine, const Member& then, const Member& now) {
    inside(name, [&] { compare(mine, then, now); });
  }
  template <class List>
  void group(FileName name, int, const List& list) {
    inside(name, [&] { list(*this); });
  }
  template <class Mine, class List>
  void optional(FileName name, const std::optional<Mine>& mine, const List& list,
                const std::int8_t& had, const std::int8_t& has) {
    inside(name, [&] {
      if (had != has) {
        difference_ = path_;
      } else if (mine) {
        list(*this, *mine);
      }
    });
  }

  /// Returns the name of the member, with the sizes of lists whose sizes differ; empty if all
  /// members have the same bits.
  [[nodiscard]] const std::string& difference() const { return difference_; }

 private:
  /// Calls `visit` where no difference was found yet, with `path_` extended by a name.
  template <class Visit>
  void inside(FileName name, const Visit& visit) {
    if (std::ranges::count(kLeftOut, name.name) > 0) return;
    step((path_.empty() ? "" : ".") + std::string(name.name), visit);
  }
  template <class Visit>
  void step(const std::string& name, const Visit& visit) {
    if (!difference_.empty()) return;
    const std::size_t size = path_.size();
    path_ += name;
    visit();
    path_.resize(size);
  }

  template <class Mine, class Member>
  void compare(const Mine& mine, const Member& then, const Member& now) {
    if constexpr (requires { planning::members(*this, mine, then, now); }) {
      planning::members(*this, mine, then, now);
    } else if constexpr (requires(Member list) { list.emplace_back(); }) {
      if (then.size() != now.size()) {
        difference_ = fmt::format("{} {} -> {}", path_, then.size(), now.size());
        return;
      }
      for (std::size_t i = 0; i < now.size(); ++i) {
        step(fmt::format("[{}]", i), [&] { compare(mine[i], then[i], now[i]); });
      }
    } else if (!has_same_bits(then, now)) {
      difference_ = path_;
    }
  }

  std::string path_;  ///< of the member that is compared: "corrections[1].moved_m"
  std::string difference_;
};

bool has_same_path(const plan_response_t& recorded, const PlanResult& now,
                   const plan_response_t& message) {
  MessageComparer io;
  io("segments", now.path.segments(), recorded.segments, message.segments);
  return io.difference().empty();
}

/// Returns the first difference of the answers; empty if there is none.
std::string first_difference(const plan_response_t& recorded, const PlanResult& now,
                             const plan_response_t& message) {
  MessageComparer io;
  planning::head_members(io, now, recorded, message);
  io("keyframes", now.keyframes, recorded.keyframes, message.keyframes);
  io("segments", now.path.segments(), recorded.segments, message.segments);
  planning::report_members(io, now, recorded, message);
  return io.difference();
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

/// Returns the distance of paths that differ in a bit at least.
double path_distance_m(const Path& a, const Path& b, const motion::Body& body) {
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

Difference difference_of(const plan_response_t& recorded, const PlanResult& now,
                         const motion::Body& body) {
  const plan_response_t message = messages::to_wire(now, {});
  Difference difference;
  if (!has_same_path(recorded, now, message)) {
    const base::Result<Path> path = messages::path_of(recorded.segments);
    difference.path_m = path_distance_m(path.value.value_or(Path()), now.path, body);
  }
  if (recorded.status == message.status) {
    difference.what = first_difference(recorded, now, message);
  } else {
    difference.what = fmt::format("status {} -> {}", messages::status_name(recorded.status),
                                  messages::status_name(message.status));
  }
  return difference;
}

}  // namespace camway::tools
