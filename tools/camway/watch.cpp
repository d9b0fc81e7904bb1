// SPDX-License-Identifier: MIT
#include <camway/client.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "daemon/cli_support/flag_checks.h"
#include "daemon/planning/request/validate.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/daemon_failure.h"
#include "tools/camway/common/interruption.h"
#include "tools/camway/common/key_file.h"
#include "tools/camway/common/request_file.h"
#include "tools/camway/common/scene_flags.h"
#include "tools/json/json_angle.h"
#include "tools/json/json_request.h"
#include "tools/json/json_text.h"
#include "tools/support/client_request.h"
#include "tools/support/watch_event_name.h"

namespace camway::tools {
namespace {

using OrderedJson = nlohmann::ordered_json;

struct WatchFlags {
  ClientOptions client;
  std::string key_file;
  std::string scene;
  std::string request;
  double for_s = 0.0;
  std::int64_t count = 0;
  std::optional<double> timeout_s;
  bool take_better = false;
  bool json = false;
};

/// Returns how near a path is to the one that was asked for. A path may turn and not move.
std::string nearness_text(const PathMeasures& measures) {
  constexpr double kLeastTold_m = 1e-6;  // below these, the two differ by rounding
  constexpr double kLeastTold_rad = 1e-6;
  if (measures.largest_deviation_m < kLeastTold_m && measures.largest_shift_rad < kLeastTold_rad) {
    return "as it was asked for";
  }
  std::string text =
      fmt::format("at most {:.4g} m from the one asked for", measures.largest_deviation_m);
  if (measures.largest_shift_rad > 0.0) {  // keyframe insertion does not measure it
    text += fmt::format(", from which the picture shifts by at most {:.3g}°",
                        degrees(measures.largest_shift_rad));
  }
  return text;
}

std::string text_of(const WatchEvent& event) {
  switch (event.kind) {
    case WatchEvent::Kind::kAnswer: {
      const std::size_t segments = event.answer->path.segments().size();
      return fmt::format("revision {}: {}, {} segment{}: {}", event.scene_revision,
                         to_string(event.answer->status), segments, segments == 1 ? "" : "s",
                         event.answer->message);
    }
    case WatchEvent::Kind::kBroken: {
      if (event.scene_revision == 0) return "the scene is gone";
      std::string text = fmt::format("revision {}: collides", event.scene_revision);
      std::string_view separator = " at ";
      for (const CollisionInterval& interval : event.broken) {
        text += fmt::format("{}{:.6g}-{:.6g} s", std::exchange(separator, ", "), interval.t_begin_s,
                            interval.t_end_s);
      }
      return text;
    }
    case WatchEvent::Kind::kFree:
      return fmt::format("revision {}: proved free again, as it was answered",
                         event.scene_revision);
    case WatchEvent::Kind::kWatched:
      return fmt::format("revision {}: watched again, what was said last holds",
                         event.scene_revision);
    case WatchEvent::Kind::kBetter:
      return fmt::format("revision {}: a better path is on offer, {:.4g} m long and {}",
                         event.scene_revision, event.answer->measures->length_m,
                         nearness_text(*event.answer->measures));
    case WatchEvent::Kind::kWithdrawn:
      return fmt::format(
          "revision {}: a change broke the better path, which is not on offer any more",
          event.scene_revision);
    case WatchEvent::Kind::kRestarted:
      return "the daemon was started anew, the path is asked for again";
    case WatchEvent::Kind::kLost:
    case WatchEvent::Kind::kEnded:
      return event.error;
  }
  return {};
}

OrderedJson json_of(const WatchEvent& event) {
  OrderedJson json{{"event", name_of(event.kind)}, {"scene_revision", event.scene_revision}};
  if (event.answer) {
    json["status"] = to_string(event.answer->status);
    json["message"] = event.answer->message;
    json["segments"] = event.answer->path.segments().size();
    if (const std::optional<PathMeasures>& measures = event.answer->measures) {
      json["length_m"] = measures->length_m;
      json["largest_deviation_m"] = measures->largest_deviation_m;
      json["largest_shift_deg"] = degrees(measures->largest_shift_rad);
      json["mean_shift_deg"] = degrees(measures->mean_shift_rad);
    }
  }
  if (event.kind == WatchEvent::Kind::kBroken) {
    json["broken"] = OrderedJson::array();
    for (const CollisionInterval& interval : event.broken) {
      json["broken"].push_back({{"t_begin", interval.t_begin_s}, {"t_end", interval.t_end_s}});
    }
  }
  if (!event.error.empty()) json["error"] = event.error;
  return json;
}

void print(const WatchEvent& event, bool as_json) {
  if (as_json) {
    fmt::print("{}\n", json_text(json_of(event)));
  } else {
    fmt::print("{:%H:%M:%S} {:<7} {}\n", fmt::localtime(std::time(nullptr)), name_of(event.kind),
               text_of(event));
  }
  std::fflush(stdout);
}

/// A queue of events from the client's thread.
class Events {
 public:
  void add(const WatchEvent& event) {
    {
      const std::lock_guard lock(mutex_);
      events_.push_back(event);
    }
    changed_.notify_one();
  }

  /// Returns the next event; nothing if `until` passes.
  std::optional<WatchEvent> take(std::chrono::steady_clock::time_point until) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_until(lock, until, [this] { return !events_.empty(); })) return std::nullopt;
    WatchEvent event = std::move(events_.front());
    events_.pop_front();
    return event;
  }

 private:
  std::mutex mutex_;  ///< guards events_
  std::condition_variable changed_;
  std::deque<WatchEvent> events_;
};

/// Prints events. An answer without a proved path waits for the next event: if that is the end of
/// the watch, it gives the same reason, and people read it once.
class Printer {
 public:
  explicit Printer(const WatchFlags& flags) : flags_(flags) {}

  void add(const WatchEvent& event) {
    if (event.kind == WatchEvent::Kind::kAnswer && !event.answer->certified) {
      waiting_ = event;
    } else {
      tell(event);
    }
  }

  /// Prints the answer that waits, if one does.
  void flush() {
    if (waiting_) tell(*std::exchange(waiting_, std::nullopt));
  }

  /// Prints the end of the watch. Returns its exit code.
  ExitCode end(const WatchEvent& event) {
    if (flags_.json) flush();
    return report_failure(event.status, event.error, flags_.key_file);
  }

  /// Returns whether as many events as the command line asks for were printed.
  [[nodiscard]] bool is_enough() const { return flags_.count != 0 && printed_ >= flags_.count; }

 private:
  void tell(const WatchEvent& event) {
    if (is_enough()) return;
    print(event, flags_.json);
    ++printed_;
  }

  const WatchFlags& flags_;
  std::int64_t printed_ = 0;
  std::optional<WatchEvent> waiting_;
};

/// The end of the watch.
struct Followed {
  ExitCode code;
  /// Time for the daemon to say that it heard of the end; nothing if no daemon is there.
  std::optional<double> farewell_s = 1.0;
};

/// `Followed::farewell_s` where it is not known whether a daemon is there.
constexpr double kShortFarewell_s = 0.3;

/// Says that the watch ended before a path was answered, and what the last event said of that.
ExitCode report_no_answer(const WatchFlags& flags, const std::optional<WatchEvent>& unheard) {
  const std::string end =
      flags.for_s > 0.0 ? fmt::format("within {:g} s", flags.for_s) : std::string("before the end");
  print_error("no answer came " + end + ": " +
              (unheard ? unheard->error
                       : std::string("the path is still being planned, or no daemon is there that "
                                     "has the same keys and answers")));
  return ExitCode::kNoDaemon;
}

/// Prints events until a flag or a signal ends it, or no daemon is heard at all.
Followed follow(const WatchFlags& flags, const Interruption& interruption, Events& events) {
  using Clock = std::chrono::steady_clock;
  constexpr double kForEver_s = 1e8;
  constexpr std::chrono::milliseconds kLook{100};  // for signals
  const std::chrono::duration<double> patience(flags.for_s > 0.0 ? flags.for_s : kForEver_s);
  const Clock::time_point begin = Clock::now();
  const Clock::time_point until = begin + std::chrono::duration_cast<Clock::duration>(patience);
  const std::chrono::duration<double> timeout(flags.timeout_s.value_or(0.0));
  const Clock::time_point wait_until = begin + std::chrono::duration_cast<Clock::duration>(timeout);
  std::optional<WatchEvent> unheard;  // the last event, if it says so
  bool is_answered = false;
  bool is_watched = false;
  Printer printer(flags);
  while (!printer.is_enough()) {
    const Clock::time_point now = Clock::now();
    if (interruption.came() || now >= until) break;
    if (unheard && now >= wait_until) {
      return {report_failure(unheard->status, unheard->error, flags.key_file), std::nullopt};
    }
    const std::optional<WatchEvent> event = events.take(std::min(until, now + kLook));
    if (event && event->kind == WatchEvent::Kind::kEnded) {
      return {printer.end(*event)};
    }
    printer.flush();
    if (!event) continue;
    const bool is_unheard =
        event->kind == WatchEvent::Kind::kLost && !is_answered &&
        (event->status == Status::kNoDaemon || event->status == Status::kNoAnswer);
    unheard = is_unheard ? event : std::nullopt;
    if (is_unheard) continue;
    printer.add(*event);
    is_watched =
        event->kind != WatchEvent::Kind::kLost && event->kind != WatchEvent::Kind::kRestarted;
    is_answered = is_answered || event->kind == WatchEvent::Kind::kAnswer;
  }
  printer.flush();
  if (!is_answered) return {report_no_answer(flags, unheard), kShortFarewell_s};
  return {is_watched ? ExitCode::kSuccess : ExitCode::kNegative};
}

constexpr char kEvents[] =
    "Events: answer (the first path, a corrected one, or one that was taken), broken (the path "
    "collides since a\nchange, and a corrected one is being planned), free (it is proved free "
    "again), better (what was in the way\nis gone, and a better path is on offer; --take-better "
    "takes it), withdrawn (it is not on offer any more),\nrestarted (the daemon was started anew; "
    "the next event has the result), "
    "lost (the daemon does not watch for "
    "now: it fell silent more than 3 s ago, or a limit of its [watch] is\nreached; we go on "
    "trying, and say so once), watched (it does again, and what was said before holds).\nAt the "
    "end, and when interrupted, the daemon is told to watch no more.\n";

ExitCode invalid_input(std::string_view message) {
  print_error(message);
  return ExitCode::kInvalidInput;
}

ExitCode run_watch(WatchFlags flags) {
  const base::Result<RequestFile> request = read_request(flags.request);
  if (!request) return invalid_input(request.error);
  // The daemon would refuse this, too, but with the names of the wire.
  if (const auto fault = planning::validate(*request)) {
    return invalid_input(source_of(flags.request) + ": " + fault->message);
  }
  warn_of_reading(source_of(flags.request), *request);
  if (const std::string fault = use_key_file(flags.key_file, flags.client); !fault.empty()) {
    return invalid_input(fault);
  }
  const Interruption interruption;
  Events events;
  Client client(flags.client);
  if (!client.good()) return invalid_input(client.error());
  if (!client.warning().empty()) print_error(client.warning());
  const auto take = [&](const WatchEvent& event) {
    events.add(event);
    if (flags.take_better && event.kind == WatchEvent::Kind::kBetter) {
      client.take_better(event.request_id);
    }
  };
  const std::int64_t id = client.watch(to_client_request(*request, flags.scene), take);
  const auto [code, farewell_s] = follow(flags, interruption, events);
  if (!farewell_s) return code;
  // Otherwise the daemon would watch and plan again until the lease is over.
  if (!client.unwatch(id, *farewell_s) && code == ExitCode::kSuccess) {
    print_error("the daemon did not say that it heard of the end; it watches on until --lease-s");
  }
  return code;
}

}  // namespace

void add_watch_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<WatchFlags>();
  CLI::App* command = app.add_subcommand(
      "watch", "Have a daemon plan a path and watch it: says when a change of the scene breaks it");
  command->add_option("SCENE", flags->scene, "Name of the scene in the daemon")->required();
  command->add_option("--request", flags->request, "Request file")->required();
  command->add_option("--url", flags->client.url,
                      "LCM network [LCM_DEFAULT_URL, else multicast on this host]");
  command->add_option("--prefix", flags->client.prefix, "Prefix of the daemon's channels")
      ->capture_default_str();
  add_key_file(*command, flags->key_file);
  command
      ->add_option("--lease-s", flags->client.watch_lease_s,
                   "How long the daemon goes on watching when it hears nothing of us, seconds")
      ->check(cli_support::between(1.0, 86'400.0))
      ->capture_default_str();
  command->add_option("--for-s", flags->for_s, "End after so many seconds [when interrupted]")
      ->check(cli_support::between(0.0, 1e7));
  command->add_option("--count", flags->count, "End after so many events")
      ->check(cli_support::whole_number(1, std::int64_t{1} << 53));
  command
      ->add_option("--timeout-s", flags->timeout_s,
                   "How long to wait for a daemon to be heard at first, seconds [3.25]")
      ->check(cli_support::between(0.01, 86'400.0));
  command->add_flag("--take-better", flags->take_better,
                    "Take each better path that the daemon offers");
  command->add_flag("--json", flags->json, "Print JSON, for machines: a line for each event");
  command->footer(
      kEvents +
      exit_code_help("no path was proved, so there is nothing to watch; or nobody watched it at "
                     "the end",
                     /*asks_daemon=*/true) +
      "\nExample: camway watch office --request "
      "scenes/requests/office-free-door.json");
  command->callback([flags, &exit_code] { exit_code = run_watch(*flags); });
}

}  // namespace camway::tools
