// SPDX-License-Identifier: MIT
#include "daemon/process/daemon_run.h"

#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "daemon/planning/plan.h"
#include "daemon/process/fleet_front.h"
#include "daemon/process/metrics/metrics_text.h"
#include "daemon/process/process_signals.h"
#include "daemon/process/recording.h"
#include "daemon/process/service_manager.h"
#include "daemon/record/recording_transport.h"
#include "daemon/scene/import/upload_file.h"
#include "daemon/service/service.h"
#include "daemon/service/transport/auth_transport.h"
#include "daemon/service/transport/lcm_transport.h"

namespace camway::process {
namespace {

constexpr int kExitLcm = 1;
constexpr int kExitMetrics = 1;
constexpr int kExitPrefix = 1;
constexpr int kExitFleet = 1;
constexpr int kExitBadInput = 2;
/// How long a start waits for an answer of another daemon with its prefix, which takes
/// milliseconds.
constexpr std::chrono::milliseconds kClaimWindow{250};

/// The last status, written by the loop and read by the page of metrics.
/// Thread-safe.
class LatestStatus {
 public:
  void set(const status_t& status) {
    const std::lock_guard lock(mutex_);
    status_ = status;
  }
  [[nodiscard]] status_t get() const {
    const std::lock_guard lock(mutex_);
    return status_;
  }

 private:
  mutable std::mutex mutex_;  ///< guards status_
  status_t status_{};
};

/// Writes the counts of distrusted messages into the status.
void add_distrusted(const service::AuthTransport::Distrusted& counts, status_t& status) {
  const auto count = [&](wire::Distrust why) { return counts.at(static_cast<std::size_t>(why)); };
  status.unsigned_messages = count(wire::Distrust::kUnsigned);
  status.broken_envelopes = count(wire::Distrust::kBroken);
  status.unknown_key_messages = count(wire::Distrust::kUnknownKey);
  status.altered_messages = count(wire::Distrust::kAltered);
  status.stale_messages = count(wire::Distrust::kStale);
  status.replayed_messages = count(wire::Distrust::kReplayed);
  status.crowded_messages = count(wire::Distrust::kCrowded);
}

/// Returns the signer and checker of messages; null without a key file.
base::Result<std::shared_ptr<wire::MessageAuth>> open_auth(const AuthOptions& options) {
  if (options.key_file.empty()) return std::shared_ptr<wire::MessageAuth>();
  wire::MessageKeys::ReadResult read = wire::MessageKeys::from_file(options.key_file);
  if (!read.keys) return base::Failure{std::move(read.error)};
  wire::ReplayGuard::Limits limits;
  limits.senders = options.senders;
  limits.window_us = std::chrono::microseconds(options.window).count();
  return std::make_shared<wire::MessageAuth>(std::move(read.keys), limits);
}

/// Opens the page for Prometheus; null if the options ask for none.
base::Result<std::unique_ptr<http::Server>> open_metrics(const DaemonOptions& options,
                                                         const LatestStatus& latest,
                                                         const record::Recorder* recorder,
                                                         const std::shared_ptr<service::Log>& log) {
  if (options.metrics.port == 0) return std::unique_ptr<http::Server>();
  HttpContent content;
  content.path = "/metrics";
  content.type = "text/plain; version=0.0.4; charset=utf-8";
  content.text = [&latest, recorder] {
    const std::string text = metrics_text(latest.get());
    return recorder != nullptr ? text + record_metrics(recorder->counts()) : text;
  };
  // Used by the page's thread alone, since limited logs are not thread-safe.
  const auto crowded = std::make_shared<service::LimitedLog>(log, service::LogLevel::kWarn,
                                                             "metrics", options.service.log_limits);
  content.on_full = [crowded, most = options.metrics_limits.connections] {
    crowded->write("the page of metrics has as many connections as it may",
                   {{"metrics.connections", most}});
  };
  return open_http_page(options.metrics, std::move(content), options.metrics_limits);
}

/// Returns the exit code for the outcome of a run.
int exit_code_of(service::RunOutcome outcome, const std::string& url, service::Log& log) {
  switch (outcome) {
    case service::RunOutcome::kDrained:
    case service::RunOutcome::kAbandoned:
      return EXIT_SUCCESS;
    case service::RunOutcome::kPrefixTaken:
      return kExitPrefix;
    case service::RunOutcome::kNotSubscribed:
      log.error("LCM takes no subscription", {{"url", url}, {"hint", service::multicast_hint()}});
      return kExitLcm;
    case service::RunOutcome::kTransportBroken:
      log.error("LCM failed", {{"url", url}});
      return kExitLcm;
  }
  return kExitLcm;
}

/// The parts of a daemon that serves, in the order in which they are made and needed.
class ServingDaemon {
 public:
  /// `recorder` may be null.
  ServingDaemon(const DaemonOptions& options, record::Recorder* recorder,
                const std::shared_ptr<service::Log>& log)
      : options_(options),
        recorder_(recorder),
        log_(log),
        manager_(ServiceManager::from_environment()) {}

  /// Opens the network, the keys and the page of metrics. Returns the exit code if one of them
  /// cannot be opened, after having logged why.
  std::optional<int> open() {
    std::optional<int> code = open_network();
    if (!code) code = open_keys();
    if (!code) code = open_page_of_metrics();
    return code;
  }

  /// Serves until a signal ends it. Returns the exit code. Requires that all is open.
  int run(Reloader::Read read_again, scene::SceneStore& scenes, ConfiguredScenes& configured,
          FleetMember* fleet, const std::function<bool()>& read_scenes) {
    if (const std::size_t files = scene::remove_left_upload_files(); files > 0) {
      log_->info("removed uploads that a daemon left behind", {{"files", files}});
    }
    here_ = std::make_shared<service::LocalAnswerer>(
        [](const scene::Snapshot& snapshot, const planning::PlanRequest& request,
           const base::Deadline& deadline) { return planning::plan(snapshot, request, deadline); },
        options_.service.deadline);
    if (fleet != nullptr) {
      front_ = FleetFront::open_or_log(options_, *fleet, scenes, *here_, log_);
      if (!front_) return kExitFleet;
    }
    service::Service service(transport(), scenes, service_config(),
                             front_ ? front_->answerer() : here_, log_, hooks());
    if (front_) {
      if (const auto end = service.look_for_rival()) {
        return exit_code_of(*end, options_.lcm_url, *log_);
      }
      if (!front_->claim_id_or_log(options_, *log_)) return kExitFleet;
      if (!read_scenes()) return kExitBadInput;
      front_->feed(service);
    }
    const int code = serve(service, std::move(read_again), configured);
    if (front_) front_->stop_feeding();
    return code;
  }

 private:
  [[nodiscard]] service::ServiceConfig service_config() const {
    service::ServiceConfig config = options_.service;
    config.is_durable = !options_.state.folder.empty() || front_ != nullptr;
    config.claim_window = options_.share_prefix ? std::chrono::milliseconds(0) : kClaimWindow;
    if (front_) config.most_jobs = static_cast<int>(options_.fleet.jobs);
    return config;
  }

  int serve(service::Service& service, Reloader::Read read_again, ConfiguredScenes& configured) {
    Reloader reloader(options_, std::move(read_again), configured, reloads_, manager_, log_, auth_);
    const SignalWaiter signals(
        [&](int signal) {
          log_->info("signal", {{"number", signal}});
          service.request_stop();
        },
        [&] { reloader.request(); });
    const service::RunOutcome outcome = service.run();
    if (recorder_ != nullptr) recorder_->finish();
    const int code = exit_code_of(outcome, options_.lcm_url, *log_);
    // The threads that still plan cannot be joined.
    if (outcome == service::RunOutcome::kAbandoned) std::_Exit(code);
    return code;
  }

  std::optional<int> open_network() {
    const std::string other = url_of_environment();
    if (!other.empty() && other != options_.lcm_url) {
      log_->warn("LCM_DEFAULT_URL is set, but does not count",
                 {{"LCM_DEFAULT_URL", other}, {"url", options_.lcm_url}});
    }
    base::Result<std::unique_ptr<service::Transport>> opened =
        service::open_lcm_transport(options_.lcm_url, [log = log_](const std::string& reason) {
          log->warn("what other hosts send is heard in spite of ttl 0", {{"reason", reason}});
        });
    if (!opened) {
      log_->error("LCM cannot be used", {{"reason", opened.error}});
      return kExitLcm;
    }
    network_ = *std::move(opened);
    if (recorder_ != nullptr) {
      recording_.emplace(*network_, *recorder_);
      log_->info("recording", {{"folder", options_.record.folder}});
    }
    return std::nullopt;
  }

  std::optional<int> open_keys() {
    base::Result<std::shared_ptr<wire::MessageAuth>> auth = open_auth(options_.auth);
    if (!auth) {
      log_->error("keys cannot be used",
                  {{"setting", options_.where("auth.key_file")}, {"reason", auth.error}});
      return kExitBadInput;
    }
    auth_ = *std::move(auth);
    if (!auth_) return std::nullopt;
    signing_.emplace(wire_side(), auth_, options_.auth.required,
                     service::LimitedLog(log_, service::LogLevel::kWarn, "distrusted",
                                         options_.service.log_limits));
    log_->info("messages are signed",
               {{"unsigned_ones", options_.auth.required ? "dropped" : "accepted"}});
    return std::nullopt;
  }

  std::optional<int> open_page_of_metrics() {
    base::Result<std::unique_ptr<http::Server>> page =
        open_metrics(options_, latest_, recorder_, log_);
    if (!page) {
      log_->error("there can be no page of metrics", {{"reason", page.error}});
      return kExitMetrics;
    }
    metrics_ = *std::move(page);
    if (metrics_) {
      log_->info("page of metrics", {{"address", options_.metrics.ip}, {"port", metrics_->port()}});
    }
    return std::nullopt;
  }

  /// The transport of messages as they are on the network.
  service::Transport& wire_side() {
    return recording_ ? static_cast<service::Transport&>(*recording_) : *network_;
  }

  service::Transport& transport() {
    return signing_ ? static_cast<service::Transport&>(*signing_) : wire_side();
  }

  service::ServiceHooks hooks() {
    service::ServiceHooks hooks;
    hooks.ready = [this] {
      log_serving();
      manager_.ready("serving");
    };
    hooks.stopping = [this] {
      if (front_) front_->leave();
      manager_.stopping();
    };
    hooks.alive = [this] { manager_.alive(); };
    hooks.status = [this](status_t& status) { complete(status); };
    hooks.alive_period = manager_.alive_period();
    return hooks;
  }

  /// The workers of a front plan only while no planner can.
  void log_serving() const {
    log_->info("serving",
               {{"url", options_.lcm_url},
                {"prefix", options_.service.prefix},
                {front_ ? "workers_without_planners" : "workers", options_.service.workers},
                {"scene_workers", options_.service.scene_workers},
                {"queue", options_.service.queue.jobs},
                {"client_queue", options_.service.queue.jobs_of_a_client}});
  }

  /// Adds to a status what the service itself does not know.
  void complete(status_t& status) {
    if (signing_) {
      add_distrusted(signing_->distrusted(), status);
      signing_->report_suppressed();
    }
    status.signed_only = signing_ && options_.auth.required ? 1 : 0;
    reloads_.add_to(status);
    if (recorder_ != nullptr) add_recording(options_, recorder_->counts(), status);
    if (front_) front_->add_to(status);
    if (metrics_) latest_.set(status);
  }

  const DaemonOptions& options_;
  record::Recorder* const recorder_;
  const std::shared_ptr<service::Log>& log_;
  std::unique_ptr<service::Transport> network_;
  std::optional<record::RecordingTransport> recording_;  ///< over the network, with a recorder
  std::shared_ptr<wire::MessageAuth> auth_;              ///< null without keys
  std::optional<service::AuthTransport> signing_;        ///< over the network, with keys
  LatestStatus latest_;
  std::unique_ptr<http::Server> metrics_;  ///< null if the options ask for none
  const ServiceManager manager_;
  ReloadRecord reloads_;
  std::shared_ptr<service::PlanAnswerer> here_;  ///< plans in this process
  std::unique_ptr<FleetFront> front_;            ///< null if this is not the front of a fleet
};

}  // namespace

int serve(const DaemonOptions& options, Reloader::Read read_again, scene::SceneStore& scenes,
          ConfiguredScenes& configured, FleetMember* fleet, record::Recorder* recorder,
          const std::function<bool()>& read_scenes, const std::shared_ptr<service::Log>& log) {
  ServingDaemon daemon(options, recorder, log);
  if (const std::optional<int> code = daemon.open()) return *code;
  return daemon.run(std::move(read_again), scenes, configured, fleet, read_scenes);
}

}  // namespace camway::process
