// SPDX-License-Identifier: MIT
#include "tools/camway/plan/daemon_plan.h"

#include <chrono>
#include <future>

#include "tools/camway/common/daemon_failure.h"
#include "tools/camway/common/key_file.h"
#include "tools/support/client_request.h"

namespace camway::tools {

CLI::Option* add_daemon_flags(CLI::App& command, DaemonFlags& flags) {
  CLI::Option* const daemon =
      command
          .add_option("--daemon", flags.scene,
                      "Have a daemon plan, in its scene of this name; Ctrl-C cancels the request")
          ->type_name("SCENE");
  const auto needs_daemon = [&](CLI::Option* option) { option->needs(daemon); };
  needs_daemon(command.add_option("--url", flags.client.url,
                                  "LCM network [LCM_DEFAULT_URL, else multicast on this host]"));
  needs_daemon(
      command.add_option("--prefix", flags.client.prefix, "Prefix of the daemon's channels")
          ->capture_default_str());
  needs_daemon(add_key_file(command, flags.key_file));
  needs_daemon(add_timeout(command, flags.timeout_s));
  return daemon;
}

DaemonPlanner::DaemonPlanner(const DaemonFlags& flags) : flags_(flags) {
  ClientOptions options = flags.client;
  use_timeout(flags.timeout_s, options);
  error_ = use_key_file(flags.key_file, options);
  if (!error_.empty()) return;
  client_.emplace(options);
  error_ = client_->error();
  if (!client_->warning().empty()) print_error(client_->warning());
}

PlanResponse DaemonPlanner::plan(const planning::PlanRequest& request) {
  constexpr std::chrono::milliseconds kLook{50};  // for signals
  PendingPlan pending = client_->plan_async(to_client_request(request, flags_.scene));
  bool is_cancelled = false;
  while (pending.answer.wait_for(kLook) != std::future_status::ready) {
    if (!interruption_.came()) continue;
    if (is_cancelled) interruption_.end_process();
    client_->cancel(pending.request_id);
    is_cancelled = true;
  }
  return pending.answer.get();
}

ExitCode DaemonPlanner::report(const PlanResponse& response) const {
  return report_failure(response.status, response.error, flags_.key_file);
}

}  // namespace camway::tools
