// SPDX-License-Identifier: MIT
#include "tools/camway/replay/compare/difference.h"

#include <camway/members.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "client/messages/plan.h"
#include "daemon/base/named_enum.h"
#include "daemon/messages/plan.h"
#include "daemon/planning/result/result_members.h"
#include "lcmtypes/wire/channels.h"
#include "tools/camway/replay/compare/path_distance.h"
#include "tools/json/json_angle.h"
#include "tools/support/client_response.h"

namespace camway::tools {
namespace {

using planning::FileName;
using planning::PlanResult;

/// Members that tell how an answer was found, and not what it is.
constexpr std::array<std::string_view, 3> kLeftOut{"message", "tried", "deadline_reached"};
/// Members that are times, which a slowed path has from its slowing.
constexpr std::array<std::string_view, 4> kTimes{"t_begin", "t_end", "changed", "time"};

/// The members that each stage leaves, by their paths; a part of a member goes before it. Members
/// without a stage are the answer's.
struct StageOfMember {
  std::string_view member;
  Stage stage;
};
constexpr std::array<StageOfMember, 19> kStages{{
    {"bounds", Stage::kRequest},
    {"keyframe_faults", Stage::kRequest},
    {"measures.before.clearance_lower_bound_m", Stage::kProof},
    {"measures.before", Stage::kInterpolation},
    {"collisions", Stage::kCollisions},
    {"corrections", Stage::kCorrection},
    {"viewing_distance_m", Stage::kCorrection},
    {"near_scale", Stage::kCorrection},
    {"time_scale", Stage::kTiming},
    {"slowed", Stage::kTiming},
    {"segments", Stage::kPath},
    {"keyframes", Stage::kPath},
    {"frame", Stage::kPath},
    {"remaining_collisions", Stage::kProof},
    {"certificate", Stage::kProof},
    {"clearance_profile", Stage::kProof},
    {"infeasibility", Stage::kProof},
    {"measures.after", Stage::kMeasures},
    {"status", Stage::kAnswer},
}};

std::string flag_text(bool is_set) { return is_set ? "present" : "absent"; }

template <class Mine, class Member>
std::string value_text(FileName name, const Member& value) {
  if constexpr (std::is_same_v<Member, std::string>) {
    constexpr std::size_t kMostBytes = 60;
    return wire::printable("'" + value.substr(0, kMostBytes) + "'");
  } else if constexpr (base::NamedEnum<Mine>) {
    const auto known = base::value_of<Mine>(value);
    return known ? std::string(base::name_of(*known)) : fmt::format("{}", value);
  } else if constexpr (std::is_same_v<Mine, bool>) {
    return value != 0 ? "true" : "false";
  } else if constexpr (std::is_same_v<Mine, std::optional<std::size_t>>) {
    return value < 0 ? "none" : fmt::format("{}", value);
  } else if constexpr (std::is_floating_point_v<Member>) {
    return fmt::format("{}", planning::is_angle(name.name) ? degrees(value) : value);
  } else {
    return fmt::format("{}", value);
  }
}

/// Finds the first member in which two messages differ. The lists of members
/// (`planning/result/result_members.h`) call it with each member of the second message's result, of
/// the first message and of the second.
/// Not thread-safe.
class MessageComparer {
 public:
  MessageComparer() = default;
  /// Compares only the members of a stage; if `without_times`, without their times.
  MessageComparer(Stage stage, bool without_times) : stage_(stage), without_times_(without_times) {}

  template <class Mine, class Member>
  void operator()(FileName name, const Mine& mine, const Member& then, const Member& now) {
    inside(name, [&] { compare(name, mine, then, now); });
  }
  /// Numbers of a file's array that are members of their own in messages.
  template <class Mine, class Member>
  void operator()(FileName name, const Mine&, const std::tuple<Member&, Member&>& then,
                  const std::tuple<Member&, Member&>& now) {
    inside(name, [&] {
      step("[0]", [&] { compare_leaf<double>(name, std::get<0>(then), std::get<0>(now)); });
      step("[1]", [&] { compare_leaf<double>(name, std::get<1>(then), std::get<1>(now)); });
    });
  }
  template <class List>
  void group(FileName name, int, const List& list) {
    inside(name, [&] { list(*this); });
  }
  template <class Mine, class List>
  void optional(FileName name, const std::optional<Mine>& mine, const List& list,
                const std::int8_t& had, const std::int8_t& has) {
    inside(name, [&] {
      if ((had != 0) != (has != 0)) {
        found(flag_text(had != 0), flag_text(has != 0));
      } else if (mine) {
        list(*this, *mine);
      }
    });
  }

  /// Has the path of the member, and its values; empty if all members have the same bits.
  [[nodiscard]] const Difference& difference() const { return difference_; }

 private:
  /// Calls `visit` where no difference was found yet, with `path_` extended by a name.
  template <class Visit>
  void inside(FileName name, const Visit& visit) {
    if (std::ranges::count(kLeftOut, name.name) > 0) return;
    if (without_times_ && std::ranges::count(kTimes, name.name) > 0) return;
    step((path_.empty() ? "" : ".") + std::string(name.name), [&] {
      if (is_of_stage()) visit();
    });
  }
  template <class Visit>
  void step(const std::string& name, const Visit& visit) {
    if (!difference_.member.empty()) return;
    const std::size_t size = path_.size();
    path_ += name;
    visit();
    path_.resize(size);
  }

  /// Whether the member at `path_` or one in it is of the stage that is compared.
  [[nodiscard]] bool is_of_stage() const {
    if (!stage_) return true;
    for (const StageOfMember& each : kStages) {
      if (each.stage == *stage_ && each.member.starts_with(path_ + '.')) return true;
    }
    for (const StageOfMember& each : kStages) {
      if (!path_.starts_with(each.member)) continue;
      const std::string_view rest = std::string_view(path_).substr(each.member.size());
      if (rest.empty() || rest[0] == '.' || rest[0] == '[') return each.stage == *stage_;
    }
    return *stage_ == Stage::kAnswer;
  }

  void found(std::string then, std::string now) {
    difference_.member = path_;
    difference_.then = std::move(then);
    difference_.now = std::move(now);
  }

  template <class Mine, class Member>
  void compare(FileName name, const Mine& mine, const Member& then, const Member& now) {
    if constexpr (requires { planning::members(*this, mine, then, now); }) {
      planning::members(*this, mine, then, now);
    } else if constexpr (requires(Member list) { list.emplace_back(); }) {
      if (then.size() != now.size()) {
        found(fmt::format("{}", then.size()), fmt::format("{}", now.size()));
        return;
      }
      for (std::size_t i = 0; i < now.size(); ++i) {
        step(fmt::format("[{}]", i), [&] { compare(name, mine[i], then[i], now[i]); });
      }
    } else {
      compare_leaf<Mine>(name, then, now);
    }
  }

  /// Compares members that have no list of members: numbers, texts, arrays, and structs of the wire
  /// that planning has as one value.
  template <class Mine, class Member>
  void compare_leaf(FileName name, const Member& then, const Member& now) {
    if constexpr (wire::Described<Member>) {
      wire::for_each_member<Member>([&](const auto& described) {
        step(fmt::format(".{}", described.name),
             [&] { compare_leaf<Mine>(name, then.*described.member, now.*described.member); });
      });
    } else if constexpr (std::is_array_v<Member>) {
      for (std::size_t i = 0; i < std::extent_v<Member>; ++i) {
        step(fmt::format("[{}]", i), [&] { compare_leaf<Mine>(name, then[i], now[i]); });
      }
    } else if constexpr (std::is_same_v<Member, std::string>) {
      if (then != now) found(value_text<Mine>(name, then), value_text<Mine>(name, now));
    } else {
      static_assert(std::is_arithmetic_v<Member>);
      // Files of earlier versions lack an optional number, which is 0 in messages.
      if (std::is_same_v<Mine, std::optional<double>> && (then == 0 || now == 0)) return;
      if (std::memcmp(&then, &now, sizeof(Member)) == 0) return;
      found(value_text<Mine>(name, then), value_text<Mine>(name, now));
    }
  }

  std::optional<Stage> stage_;
  bool without_times_ = false;
  std::string path_;  ///< of the member that is compared: "corrections[1].moved_m"
  Difference difference_;
};

using Message = plan_response_t;

/// Compares all members that the comparer wants.
Difference compare_members(MessageComparer io, const Message& then, const Message& now,
                           const PlanResult& result) {
  planning::head_members(io, result, then, now);
  io("keyframes", result.keyframes, then.keyframes, now.keyframes);
  io("segments", result.path.segments(), then.segments, now.segments);
  planning::report_members(io, result, then, now);
  return io.difference();
}

/// Returns the message with the given keyframes alone; if `without_times`, without their times.
Message with_given_keyframes(const Message& message, bool without_times) {
  Message given;
  std::ranges::copy_if(message.keyframes, std::back_inserter(given.keyframes),
                       [](const auto& each) { return each.origin != keyframe_t::ORIGIN_INSERTED; });
  for (keyframe_t& keyframe : given.keyframes) {
    std::ranges::fill(keyframe.image, 0.0);  // corrections choose it
    if (without_times) keyframe.time_s = 0.0;
  }
  return given;
}

Difference difference_of_given(const Message& then, const Message& now, bool without_times) {
  const Message before = with_given_keyframes(then, without_times);
  const Message after = with_given_keyframes(now, without_times);
  const std::vector<motion::Keyframe> keyframes(after.keyframes.size());
  MessageComparer io;
  io("keyframes", keyframes, before.keyframes, after.keyframes);
  return io.difference();
}

/// A status that says that nothing was planned.
bool is_refusal(std::int32_t status) {
  return status == Message::STATUS_INVALID || status == Message::STATUS_UNKNOWN_SCENE;
}

Difference difference_of_status(const Message& then, const Message& now, const PlanResult& result) {
  MessageComparer io;
  io("status", result.status, then.status, now.status);
  return io.difference();
}

Difference difference_of_sizes(const Message& then, const Message& now) {
  if (then.keyframes.size() == now.keyframes.size()) return {};
  Difference found;
  found.member = "keyframes";
  found.then = fmt::format("{}", then.keyframes.size());
  found.now = fmt::format("{}", now.keyframes.size());
  return found;
}

enum class TimesOfMembers { kCompared, kSkipped };

/// Compares the members that a stage leaves. The times of a slowed path follow from its slowing, so
/// stages before that can leave them out.
Difference difference_in(Stage stage, TimesOfMembers times, const Message& then, const Message& now,
                         const PlanResult& result) {
  const bool without_times = times == TimesOfMembers::kSkipped;
  Difference found;
  if (stage == Stage::kRequest && (is_refusal(then.status) || is_refusal(now.status))) {
    found = difference_of_status(then, now, result);
  }
  if (stage == Stage::kInterpolation) found = difference_of_given(then, now, without_times);
  if (found.has_same_bits()) {
    found = compare_members(MessageComparer(stage, without_times), then, now, result);
  }
  if (stage == Stage::kCorrection && found.has_same_bits()) found = difference_of_sizes(then, now);
  return found;
}

/// Returns the first difference of the slowing, and of the times that the stages before left out.
Difference difference_of_slowing(const Message& then, const Message& now,
                                 const PlanResult& result) {
  for (const Stage stage : {Stage::kTiming, Stage::kRequest, Stage::kInterpolation,
                            Stage::kCollisions, Stage::kCorrection}) {
    Difference found = difference_in(stage, TimesOfMembers::kCompared, then, now, result);
    if (!found.has_same_bits()) return found;
  }
  return {};
}

/// Finds the first stage in which two answers differ. Requires that they differ.
Difference first_stage_difference(const Message& then, const Message& now,
                                  const PlanResult& result) {
  const bool is_slowed = then.time_scale != 1.0 || now.time_scale != 1.0;
  Difference found;
  for (std::size_t i = 0; i < names_of(Stage{}).size() && found.has_same_bits(); ++i) {
    const auto stage = static_cast<Stage>(i);
    const auto times =
        is_slowed && stage < Stage::kTiming ? TimesOfMembers::kSkipped : TimesOfMembers::kCompared;
    found = stage == Stage::kTiming ? difference_of_slowing(then, now, result)
                                    : difference_in(stage, times, then, now, result);
    found.stage = stage;
  }
  return found;
}

bool has_same_path(const Message& then, const Message& now, const PlanResult& result) {
  MessageComparer io;
  io("segments", result.path.segments(), then.segments, now.segments);
  return io.difference().has_same_bits();
}

}  // namespace

std::string Difference::what() const {
  return member.empty() ? std::string() : fmt::format("{} {} -> {}", member, then, now);
}

planning::PlanResult result_of(const plan_response_t& message) {
  PlanResponse response;
  convert(message, response);
  PlanResult result = to_plan_result(response);
  result.path = messages::path_of(message.segments).value.value_or(motion::Path());
  return result;
}

Difference difference_of(const plan_response_t& then, const plan_response_t& now,
                         const Yardstick& yardstick) {
  const PlanResult result = result_of(now);
  if (compare_members({}, then, now, result).has_same_bits()) return {};
  Difference difference = first_stage_difference(then, now, result);
  if (has_same_path(then, now, result)) return difference;
  const auto before = messages::path_of(then.segments);
  const PathDistance distance =
      path_distance(before.value.value_or(motion::Path()), result.path, yardstick);
  difference.path_m = distance.path_m;
  difference.shift_rad = distance.shift_rad;
  return difference;
}

}  // namespace camway::tools
