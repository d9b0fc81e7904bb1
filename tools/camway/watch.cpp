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

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "daemon/service/command_line.h"
#include "tools/camway/commands.h"
#include "tools/camway/interruption.h"
#include "tools/camway/key_file.h"
#include "tools/camway/scene_flags.h"
#include "tools/client_request.h"
#include "tools/json_io.h"

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
  bool json = false;
};

const char* name_of(WatchEvent::Kind kind) {
  switch (kind) {
    case WatchEvent::Kind::kAnswer:
      return "answer";
    case WatchEvent::Kind::kBroken:
      return "broken";
    case WatchEvent::Kind::kFree:
      return "free";
    case WatchEvent::Kind::kLost:
      return "lost";
    case WatchEvent::Kind::kWatched:
      return "watched";
    case WatchEvent::Kind::kEnded:
      return "ended";
  }
  return "unknown";
}

std::string text_of(const WatchEvent& event) {
  switch (event.kind) {
    case WatchEvent::Kind::kAnswer:
      return fmt::format("revision {}: {}, {} segments: {}", event.scene_revision,
                         to_string(event.answer->status), event.answer->path.segments().size(),
                         event.answer->message);
    case WatchEvent::Kind::kBroken: {
      std::string text = event.scene_revision == 0
                             ? std::string("the scene is gone")
                             : fmt::format("revision {}: collides", event.scene_revision);
      for (const CollisionInterval& interval : event.broken) {
        text += fmt::format(" {:.6g}-{:.6g} s", interval.t_begin_s, interval.t_end_s);
      }
      return text;
    }
    case WatchEvent::Kind::kFree:
      return fmt::format("revision {}: proved free again, as it was answered",
                         event.scene_revision);
    case WatchEvent::Kind::kWatched:
      return fmt::format("revision {}: watched again, what was said last holds",
                         event.scene_revision);
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
    fmt::print("{}\n", json_of(event).dump(-1, ' ', false, OrderedJson::error_handler_t::replace));
  } else {
    fmt::print("{:%H:%M:%S} {:<7} {}\n", fmt::localtime(std::time(nullptr)), name_of(event.kind),
               text_of(event));
  }
  std::fflush(stdout);
}

/// Events on their way from the client's thread.
class Events {
 public:
  void add(const WatchEvent& event) {
    {
      const std::lock_guard lock(mutex_);
      events_.push_back(event);
    }
    changed_.notify_one();
  }

  /// The next; nothing if `until` passes.
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

/// Prints events until the flags or a signal end it.
ExitCode follow(const WatchFlags& flags, const Interruption& interruption, Events& events) {
  using Clock = std::chrono::steady_clock;
  constexpr double kForEver_s = 1e8;
  constexpr std::chrono::milliseconds kLook{100};  // for signals
  const std::chrono::duration<double> patience(flags.for_s > 0.0 ? flags.for_s : kForEver_s);
  const Clock::time_point until =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(patience);
  bool is_answered = false;
  bool is_watched = false;
  for (std::int64_t heard = 0; flags.count == 0 || heard < flags.count;) {
    const Clock::time_point now = Clock::now();
    if (interruption.came() || now >= until) break;
    const std::optional<WatchEvent> event = events.take(std::min(until, now + kLook));
    if (!event) continue;
    if (event->kind == WatchEvent::Kind::kEnded) {
      print_error(event->error);
      return ExitCode::kNegative;
    }
    print(*event, flags.json);
    ++heard;
    is_watched = event->kind != WatchEvent::Kind::kLost;
    is_answered = is_answered || event->kind == WatchEvent::Kind::kAnswer;
  }
  if (!is_answered) return ExitCode::kNoDaemon;
  return is_watched ? ExitCode::kSuccess : ExitCode::kNegative;
}

ExitCode invalid_input(std::string_view message) {
  print_error(message);
  return ExitCode::kInvalidInput;
}

ExitCode run_watch(WatchFlags flags) {
  const Parsed<RequestFile> request = read_plan_request(flags.request);
  if (!request.value) return invalid_input(request.error);
  // The daemon would say so, too, in the names of the wire.
  if (const auto fault = planning::validate(*request.value)) {
    return invalid_input(flags.request + ": " + fault->message);
  }
  warn_of_reading(flags.request, *request.value);
  if (const std::string fault = use_key_file(flags.key_file, flags.client); !fault.empty()) {
    return invalid_input(fault);
  }
  const Interruption interruption;
  Events events;
  Client client(flags.client);
  if (!client.good()) return invalid_input(client.error());
  if (!client.warning().empty()) print_error(client.warning());
  const std::int64_t id = client.watch(to_client_request(*request.value, flags.scene),
                                       [&](const WatchEvent& event) { events.add(event); });
  const ExitCode code = follow(flags, interruption, events);
  // Else it would watch, and plan again, until the lease is over.
  constexpr double kFarewell_s = 3.0;
  if (!client.unwatch(id, kFarewell_s) && code == ExitCode::kSuccess) {
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
      ->check(service::between(1.0, 86'400.0))
      ->capture_default_str();
  command->add_option("--for-s", flags->for_s, "End after so many seconds [when interrupted]")
      ->check(service::between(0.0, 1e7));
  command->add_option("--count", flags->count, "End after so many events")
      ->check(service::whole_number(1, std::int64_t{1} << 53));
  command->add_flag("--json", flags->json, "Print JSON, for machines: a line for each event");
  command->footer(
      "Events: answer (the first path, or a corrected one), broken (the path collides since a "
      "change,\nand a corrected one is being planned), free (it is proved free again), lost (the "
      "daemon does not\nwatch for now, perhaps as a limit of its [watch] is reached; we go on "
      "trying in silence), watched\n(it does again, and what was said before holds).\nAt the end, and when interrupted, the daemon is told to watch no more.\n" +
      exit_code_help("no path was proved, so there is nothing to watch; or nobody watched it at "
                     "the end",
                     /*asks_daemon=*/true) +
      "\nExample: camway watch office --request request.json");
  command->callback([flags, &exit_code] { exit_code = run_watch(*flags); });
}

}  // namespace camway::tools
