// SPDX-License-Identifier: MIT
#include "tools/camway/cameras/log_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <span>
#include <utility>

#include "daemon/base/named_enum.h"
#include "daemon/record/event_log.h"
#include "lcmtypes/wire/channels.h"
#include "tools/camway/cameras/log_types.h"
#include "tools/lcm_types/message_reader.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;
using base::Failure;

constexpr std::array<unsigned char, 4> kLogBegin = {0xED, 0xA1, 0xDA, 0x01};
/// Farthest that the length of a quaternion may be from 1: three digits are enough for a pose.
constexpr double kMostQuaternionError = 1e-2;
constexpr std::array<std::string_view, 2> kTimeNames = {"utime", "timestamp"};

double seconds_in(TimeUnit unit) {
  constexpr std::array<double, 4> kSeconds = {1.0, 1e-3, 1e-6, 1e-9};
  return kSeconds[static_cast<std::size_t>(unit)];
}

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// The last letter of a name: "w" of "pose.q.w" and of "qw".
char component_of(std::string_view name) { return name.empty() ? '\0' : name.back(); }

/// Returns whether members are x, y, z, or w, x, y, z, in any order.
bool is_named(const std::vector<std::string>& members) {
  std::string letters;
  for (const std::string& name : members) letters += component_of(name);
  return std::ranges::is_permutation(letters,
                                     std::string_view(members.size() == 4 ? "wxyz" : "xyz"));
}

/// The selectors of a struct's members: as w, x, y, z or x, y, z if these are their names, else in
/// the order of the struct.
std::vector<std::string> members_in_order(const std::string& of, std::vector<std::string> members) {
  const auto rank = [](const std::string& name) {
    return std::string_view("wxyz").find(component_of(name));
  };
  if (is_named(members)) std::ranges::sort(members, {}, rank);
  for (std::string& name : members) name.insert(0, of + ".");
  return members;
}

/// The order of quaternions that the names of four numbers say; nothing if they say none.
std::optional<QuaternionOrder> order_of(const std::vector<std::string>& names) {
  if (names.size() != 4) return std::nullopt;
  if (component_of(names.front()) == 'w') return QuaternionOrder::kWxyz;
  if (component_of(names.back()) == 'w') return QuaternionOrder::kXyzw;
  return std::nullopt;
}

/// The numbers of one message: positions, orientations and times, one after the other.
struct PoseNumbers {
  std::vector<double> positions;
  std::vector<double> orientations;
  std::vector<double> times;
};

/// Reads the poses of messages of one struct.
class PoseReader {
 public:
  static base::Result<PoseReader> make(const LcmTypes& types, const std::string& type,
                                       const LogTrackOptions& options) {
    auto message = LcmMessageReader::make(types, type);
    if (!message) return Failure{message.error};
    PoseReader reader(*std::move(message));
    std::string fault = reader.select(types, "--position", options.position, reader.position_, 3);
    if (fault.empty() && !options.orientation.empty()) {
      fault = reader.select(types, "--orientation", options.orientation, reader.orientation_, 4);
    }
    reader.is_usual_time_ = options.time.empty();
    const std::string time = reader.is_usual_time_ ? reader.usual_time() : options.time;
    if (fault.empty() && !time.empty()) {
      fault = reader.select(types, "--time", time, reader.time_, 1);
    }
    if (!fault.empty()) return Failure{fault};
    reader.choose_order(options.order);
    return reader;
  }

  [[nodiscard]] bool has_time() const { return time_.count > 0; }
  /// The order of the numbers of a quaternion, and whether nobody said it.
  [[nodiscard]] QuaternionOrder order() const { return order_; }
  [[nodiscard]] bool is_order_assumed() const { return is_order_assumed_; }

  /// Leaves out times of the usual member if there is not one for each pose: a planned path has the
  /// time when it was sent.
  [[nodiscard]] base::Result<PoseNumbers> read(std::span<const std::uint8_t> message) const {
    auto numbers = message_.read(message, selectors_);
    if (!numbers) return Failure{numbers.error};
    PoseNumbers result{interleaved(*numbers, position_), interleaved(*numbers, orientation_),
                       interleaved(*numbers, time_)};
    const std::size_t poses = result.positions.size() / 3;
    if (poses == 0 || result.positions.size() % 3 != 0) {
      return Failure{
          fmt::format("--position has {} numbers, not three for a pose", result.positions.size())};
    }
    if (orientation_.count > 0 && result.orientations.size() != 4 * poses) {
      return Failure{fmt::format("--orientation has {} numbers for {} poses, not four for each",
                                 result.orientations.size(), poses)};
    }
    if (is_usual_time_ && result.times.size() != poses) {
      result.times.clear();
    } else if (has_time() && result.times.size() != poses) {
      return Failure{fmt::format("--time has {} numbers for {} poses, not one for each",
                                 result.times.size(), poses)};
    }
    return result;
  }

 private:
  /// The selectors of one flag.
  struct Selected {
    std::size_t first = 0;
    std::size_t count = 0;
  };

  explicit PoseReader(LcmMessageReader message) : message_(std::move(message)) {}

  [[nodiscard]] std::string usual_time() const {
    for (const std::string_view name : kTimeNames) {
      const auto& members = message_.type().members;
      const auto found = std::ranges::find_if(members, [&](const LcmMember& member) {
        return member.name == name && member.sizes.empty();
      });
      if (found != members.end()) return found->name;
    }
    return "";
  }

  std::string select(const LcmTypes& types, std::string_view flag, const std::string& text,
                     Selected& selected, std::size_t components) {
    std::vector<std::string> names = split(text);
    if (names.size() != 1 && names.size() != components) {
      return fmt::format("{} {}: name one array, or {} numbers", flag, text, components);
    }
    const bool is_list = names.size() > 1;
    if (!is_list) {
      const std::vector<std::string> members =
          lcm_number_members(types, message_.type().name, text);
      if (members.size() == components) names = members_in_order(text, members);
    }
    if (components == 4) {
      named_order_ = order_of(names);
      is_in_order_ = !is_list && is_named(names);
    }
    selected = {selectors_.size(), names.size()};
    for (const std::string& name : names) {
      auto selector = LcmSelector::make(types, message_.type().name, name);
      if (!selector) return fmt::format("{} {}", flag, selector.error);
      selectors_.push_back(*std::move(selector));
    }
    return "";
  }

  /// Chooses the order of quaternions: that of a struct's names, else the given one, else that of
  /// the names in --orientation.
  void choose_order(std::optional<QuaternionOrder> given) {
    is_order_assumed_ = orientation_.count > 0 && !given && !named_order_;
    const QuaternionOrder named = named_order_.value_or(QuaternionOrder::kWxyz);
    order_ = is_in_order_ ? named : given.value_or(named);
  }

  /// The first numbers of all selectors, then the second ones, and so on.
  static std::vector<double> interleaved(const std::vector<std::vector<double>>& numbers,
                                         const Selected& selected) {
    if (selected.count == 0) return {};
    if (selected.count == 1) return numbers[selected.first];
    std::vector<double> result;
    for (std::size_t i = 0; i < numbers[selected.first].size(); ++i) {
      for (std::size_t k = 0; k < selected.count; ++k) {
        const std::vector<double>& part = numbers[selected.first + k];
        if (i < part.size()) result.push_back(part[i]);
      }
    }
    return result;
  }

  LcmMessageReader message_;
  std::vector<LcmSelector> selectors_;
  Selected position_;
  Selected orientation_;
  Selected time_;
  bool is_usual_time_ = false;
  std::optional<QuaternionOrder> named_order_;
  bool is_in_order_ = false;  ///< whether the quaternion is a struct with the names w, x, y, z
  QuaternionOrder order_ = QuaternionOrder::kWxyz;
  bool is_order_assumed_ = false;
};

/// A pose of the log, with its two times.
struct LoggedPose {
  geometry::Vec3 position;
  std::array<double, 4> orientation = {1.0, 0.0, 0.0, 0.0};  ///< as in the message
  double time = 0.0;                                         ///< in the unit of the message
  double received_s = 0.0;                                   ///< on the clock of the logger
};

/// Collects the poses of one channel.
class PoseCollector {
 public:
  PoseCollector(const LogTypes& types, const LogTrackOptions& options)
      : types_(types), options_(options) {}

  void take(const record::LogEvent& event) {
    ++channels_[event.channel];
    const bool is_wanted =
        options_.channel.empty() ? channels_.size() == 1 : event.channel == options_.channel;
    if (!is_wanted || !fault_.empty()) return;
    if (!reader_ && !choose_type(event.data)) return;
    const auto numbers = reader_->read(event.data);
    if (numbers) {
      add(*numbers, static_cast<double>(event.utime) * 1e-6);
    } else if (unread_++ == 0) {
      why_unread_ = numbers.error;
    }
  }

  [[nodiscard]] const std::string& fault() const { return fault_; }
  [[nodiscard]] const std::map<std::string, std::size_t>& channels() const { return channels_; }
  [[nodiscard]] const std::vector<LoggedPose>& poses() const { return poses_; }
  /// Returns whether all poses have a time of their messages.
  [[nodiscard]] bool has_time() const { return reader_ && reader_->has_time() && untimed_ == 0; }
  /// Returns whether messages have a time that is not one for each of their poses.
  [[nodiscard]] bool has_unfit_time() const {
    return reader_ && reader_->has_time() && untimed_ > 0;
  }
  [[nodiscard]] QuaternionOrder order() const {
    return reader_ ? reader_->order() : QuaternionOrder::kWxyz;
  }
  [[nodiscard]] bool is_order_assumed() const { return reader_ && reader_->is_order_assumed(); }
  [[nodiscard]] bool has_lists() const { return has_lists_; }
  [[nodiscard]] std::size_t unread() const { return unread_; }
  [[nodiscard]] const std::string& why_unread() const { return why_unread_; }

 private:
  bool choose_type(std::span<const std::uint8_t> message) {
    std::string known;
    for (const auto& [name, type] : types_.structs) {
      const auto fingerprint = lcm_fingerprint(types_.structs, name);
      known += fmt::format("\n  {}: {}", name,
                           fingerprint ? fmt::format("{:016x}", *fingerprint) : fingerprint.error);
      if (!fingerprint || lcm_fingerprint_of(message) != *fingerprint) continue;
      auto reader = PoseReader::make(types_.structs, name, options_);
      if (reader) reader_ = *std::move(reader);
      if (!reader) fault_ = reader.error;
      return reader_.has_value();
    }
    const auto found = lcm_fingerprint_of(message);
    fault_ = fmt::format(
        "its messages are of none of the structs of --type, or of another version "
        "of one: they have the fingerprint {}, but{}",
        found ? fmt::format("{:016x}", *found) : "of none", known);
    for (const std::string& missing : types_.missing) fault_ += "\n  " + missing;
    return false;
  }

  void add(const PoseNumbers& numbers, double received_s) {
    const std::size_t count = numbers.positions.size() / 3;
    has_lists_ = has_lists_ || count > 1;
    if (numbers.times.empty()) ++untimed_;
    for (std::size_t i = 0; i < count; ++i) {
      LoggedPose pose;
      pose.position = geometry::Vec3(numbers.positions[3 * i], numbers.positions[3 * i + 1],
                                     numbers.positions[3 * i + 2]);
      for (std::size_t k = 0; k < 4 && !numbers.orientations.empty(); ++k) {
        pose.orientation[k] = numbers.orientations[4 * i + k];
      }
      if (!numbers.times.empty()) pose.time = numbers.times[i];
      pose.received_s = received_s;
      poses_.push_back(pose);
    }
  }

  const LogTypes& types_;
  const LogTrackOptions& options_;
  std::optional<PoseReader> reader_;
  std::map<std::string, std::size_t> channels_;
  std::vector<LoggedPose> poses_;
  std::string fault_;
  std::string why_unread_;
  std::size_t unread_ = 0;
  std::size_t untimed_ = 0;  ///< messages without a time for each pose
  bool has_lists_ = false;
};

std::string channels_text(const std::map<std::string, std::size_t>& channels) {
  std::string text;
  for (const auto& [name, count] : channels) {
    text += fmt::format("\n  {}: {} {}", wire::printable(name), count,
                        count == 1 ? "message" : "messages");
  }
  return text;
}

/// The unit in which the poses take as long as their messages took to arrive.
TimeUnit unit_of(const std::vector<LoggedPose>& poses) {
  const double span = poses.back().time - poses.front().time;
  const double received_s = poses.back().received_s - poses.front().received_s;
  TimeUnit best = TimeUnit::kMicroseconds;
  if (!(span > 0.0) || !(received_s > 0.0)) return best;
  const auto error = [&](TimeUnit unit) {
    return std::abs(std::log(span * seconds_in(unit) / received_s));
  };
  for (const TimeUnit unit :
       {TimeUnit::kSeconds, TimeUnit::kMilliseconds, TimeUnit::kNanoseconds}) {
    if (error(unit) < error(best)) best = unit;
  }
  return best;
}

/// The orientation of a pose, of unit length; nothing if its numbers are none.
std::optional<geometry::Quat> orientation_of(const LoggedPose& pose, QuaternionOrder order,
                                             const LogTrackOptions& options) {
  const std::array<double, 4>& q = pose.orientation;
  const bool is_given = !options.orientation.empty();
  const geometry::Quat quat = is_given && order == QuaternionOrder::kXyzw
                                  ? geometry::Quat(q[3], q[0], q[1], q[2])
                                  : geometry::Quat(q[0], q[1], q[2], q[3]);
  if (!(std::abs(quat.norm() - 1.0) <= kMostQuaternionError)) return std::nullopt;
  return with_other_axes(quat.normalized(), options.axes);
}

/// Adds the poses as keys. Returns the fault of the first bad one; empty without a fault.
std::string add_keys(const PoseCollector& collected, const LogTrackOptions& options,
                     CameraTrack& track) {
  const std::vector<LoggedPose>& poses = collected.poses();
  const TimeUnit unit = options.unit.value_or(unit_of(poses));
  const bool has_own_times = collected.has_time() || !collected.has_lists();
  track.has_times = has_own_times || options.fps.has_value();
  std::size_t late = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto orientation = orientation_of(poses[i], collected.order(), options);
    if (!orientation) {
      return fmt::format(
          "pose {} of its channel: the orientation is not of length 1 "
          "(--orientation, --quaternion)",
          i);
    }
    double time_s = static_cast<double>(track.keys.size()) / options.fps.value_or(1.0);
    if (has_own_times) {
      time_s = collected.has_time() ? poses[i].time * seconds_in(unit) : poses[i].received_s;
    }
    if (!track.keys.empty() && !(time_s > track.keys.back().time_s)) {
      ++late;
      continue;
    }
    track.keys.push_back({time_s, {poses[i].position, *orientation}, std::nullopt});
  }
  if (late > 0) {
    track.notes.push_back(fmt::format(
        "{} of its {} poses are not later than one before and are left out", late, poses.size()));
  }
  if (collected.has_time() && !options.unit) {
    track.notes.push_back(fmt::format(
        "its times are taken as {}, as they fit the log's (--time-unit)", base::name_of(unit)));
  }
  return "";
}

void add_notes(const PoseCollector& collected, const record::LogSummary& log,
               const LogTrackOptions& options, CameraTrack& track) {
  if (collected.unread() > 0) {
    track.notes.push_back(fmt::format("{} of its messages cannot be read and are left out: {}",
                                      collected.unread(), collected.why_unread()));
  }
  if (!collected.has_time()) {
    const char* const lists = collected.has_unfit_time()
                                  ? "its messages have one time for a list of poses, which is not "
                                    "taken (--time, or --fps)"
                                  : "its lists of poses have no times (--time, or --fps)";
    track.notes.emplace_back(
        collected.has_lists()
            ? lists
            : "its messages have no time: that of their receipt is taken (--time)");
  }
  if (collected.is_order_assumed()) {
    track.notes.emplace_back(
        "its quaternions are taken in the order w, x, y, z (--quaternion wxyz, or xyzw)");
  }
  if (options.orientation.empty()) track.notes.emplace_back("it is never turned (--orientation)");
  if (!log.damage.empty()) track.notes.push_back(log.damage);
}

}  // namespace

bool is_event_log(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::array<char, kLogBegin.size()> begin{};
  return stream.read(begin.data(), begin.size()) &&
         std::ranges::equal(begin, kLogBegin, {},
                            [](char c) { return static_cast<unsigned char>(c); });
}

base::Result<CameraTrack> read_log_track(const std::string& file, const LogTrackOptions& options) {
  const auto types = read_log_types(options.types);
  if (!types) return Failure{types.error};
  PoseCollector collected(*types, options);
  const record::LogSummary log =
      record::read_event_log(file, [&](record::LogEvent&& event) { collected.take(event); });
  const auto fail = [&](const std::string& reason) { return Failure{file + ": " + reason}; };
  if (log.events == 0) return Failure{log.damage.empty() ? file + ": is empty" : log.damage};
  const bool is_missing =
      !options.channel.empty() && !collected.channels().contains(options.channel);
  if (is_missing || (options.channel.empty() && collected.channels().size() > 1)) {
    return fail((is_missing ? "has no channel '" + options.channel + "'; its channels are"
                            : "has several channels; --channel names one:") +
                channels_text(collected.channels()));
  }
  const std::string channel =
      options.channel.empty() ? collected.channels().begin()->first : options.channel;
  if (!collected.fault().empty()) return fail("channel " + channel + ": " + collected.fault());
  if (collected.poses().empty()) {
    return fail(fmt::format("channel {}: none of its {} messages can be read: {}", channel,
                            collected.unread(), collected.why_unread()));
  }
  CameraTrack track;
  track.name = channel;
  if (std::string fault = add_keys(collected, options, track); !fault.empty()) return fail(fault);
  add_notes(collected, log, options, track);
  if (std::string fault = fault_of(track); !fault.empty()) return fail(fault);
  return track;
}

}  // namespace camway::tools
