// SPDX-License-Identifier: MIT
#include "daemon/process/reloader.h"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "daemon/process/settings/daemon_settings.h"
#include "daemon/service/core/core.h"

namespace camway::process {
namespace {

constexpr std::string_view kFailed = "reload failed, all stays as it was";

/// Returns a value without the quotes that a text has in the file, since the log adds its own.
std::string_view unquoted(std::string_view value) {
  const bool is_text = value.size() >= 2 && value.front() == '"' && value.back() == '"';
  return is_text ? value.substr(1, value.size() - 2) : value;
}

}  // namespace

Reloader::Reloader(DaemonOptions running, Read read, ConfiguredScenes& scenes, ReloadRecord& record,
                   const ServiceManager& manager, std::shared_ptr<service::Log> log,
                   std::shared_ptr<wire::MessageAuth> auth, std::chrono::milliseconds look_every)
    : running_(std::move(running)),
      read_(std::move(read)),
      scenes_(scenes),
      record_(record),
      manager_(manager),
      log_(std::move(log)),
      auth_(std::move(auth)),
      look_every_(look_every),
      thread_([this](const std::stop_token& stop) { serve(stop); }) {}

void Reloader::request() {
  {
    const std::lock_guard lock(mutex_);
    requested_ = true;
    if (may_cancel_) work_.request_stop();
  }
  changed_.notify_one();
}

void Reloader::serve(const std::stop_token& stop) {
  const std::stop_callback end_work(stop, [this] {
    const std::lock_guard lock(mutex_);
    work_.request_stop();
  });
  bool was_called_off = false;
  while (wait(stop)) {
    manager_.reloading();
    const std::stop_token work = begin_work(stop, !was_called_off);
    try {
      reload(work);
    } catch (const std::exception& error) {
      log_->error(kFailed, {{"reason", error.what()}});
      record_.failed(service::utime_now(), error.what());
    }
    if (stop.stop_requested()) return;  // the manager is told that we stop
    was_called_off = work.stop_requested();
    if (!was_called_off) manager_.ready("serving");
  }
}

std::stop_token Reloader::begin_work(const std::stop_token& stop, bool may_cancel) {
  const std::lock_guard lock(mutex_);
  work_ = std::stop_source();
  may_cancel_ = may_cancel;
  if ((requested_ && may_cancel) || stop.stop_requested()) work_.request_stop();
  return work_.get_token();
}

bool Reloader::wait(const std::stop_token& stop) {
  const auto is_requested = [this] { return requested_; };
  while (!stop.stop_requested()) {
    {
      std::unique_lock lock(mutex_);
      const bool is_woken = scenes_.watches_files()
                                ? changed_.wait_for(lock, stop, look_every_, is_requested)
                                : changed_.wait(lock, stop, is_requested);
      if (is_woken) {
        requested_ = false;
        return true;
      }
    }
    look_at_files(begin_work(stop, /*may_cancel=*/true));
  }
  return false;
}

void Reloader::look_at_files(const std::stop_token& stop) {
  try {
    scenes_.look_at_files(stop);
  } catch (const std::exception& error) {
    log_->error("scene files cannot be looked at, all stays as it was", {{"reason", error.what()}});
  }
}

void Reloader::reload(const std::stop_token& stop) {
  ParsedOptions parsed = read_();
  for (const std::string& fault : parsed.faults) log_->error(kFailed, {{"reason", fault}});
  if (!parsed.options) {
    record_.failed(service::utime_now(), fmt::format("{}", fmt::join(parsed.faults, "; ")));
    return;
  }
  wire::MessageKeys::ReadResult keys;
  if (auth_) keys = wire::MessageKeys::from_file(running_.auth.key_file);
  if (!keys.error.empty()) {
    const std::string setting = running_.where("auth.key_file");
    log_->error(kFailed, {{"setting", setting}, {"reason", keys.error}});
    record_.failed(service::utime_now(), setting + ": " + keys.error);
    return;
  }
  if (!scenes_.update(parsed.options->scenes, stop)) {
    if (stop.stop_requested()) {
      log_->info("reload cancelled, all stays as it was");
      return;
    }
    log_->error("reload failed, not all scenes could be taken over, so no setting is",
                {{"reason", scenes_.fault()}});
    record_.failed(service::utime_now(), scenes_.fault());
    return;
  }
  if (keys.keys) {
    log_->info("reloaded keys, of which the first signs",
               {{"ids", fmt::format("{}", fmt::join(keys.keys->ids(), ","))}});
    auth_->set_keys(std::move(keys.keys));
  }
  take_over(*parsed.options);
  record_.succeeded();
}

void Reloader::take_over(const DaemonOptions& next) {
  for (const SettingChange& change : changes_between(running_, next)) {
    if (change.reloads) {
      log_->info("reloaded setting", {{"setting", change.key}, {"value", unquoted(change.after)}});
    } else {
      log_->warn("setting stays until the daemon is started again",
                 {{"setting", change.key},
                  {"value", unquoted(change.before)},
                  {"wanted", unquoted(change.after)}});
    }
  }
  running_.log_level = next.log_level;
  log_->info("reloaded", {{"configured_scenes", next.scenes.size()}});
  log_->set_level(next.log_level);
}

}  // namespace camway::process
