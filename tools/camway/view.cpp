// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

#include "daemon/cli_support/flag_checks.h"
#include "tools/camway/common/browser.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/daemon_failure.h"
#include "tools/camway/common/interruption.h"
#include "tools/camway/common/key_file.h"
#include "tools/camway/common/scene_flags.h"
#include "tools/camway/door_request.h"
#include "tools/view/access/token.h"
#include "tools/view/daemon/planner_daemon.h"
#include "tools/view/door.h"
#include "tools/view/here/planner_here.h"
#include "tools/view/page/embed/embedded_page.h"

namespace camway::tools {
namespace {

struct ViewFlags {
  SceneFlags file;
  std::string request;
  std::string scene;  ///< name of a scene of the daemon
  ClientOptions client;
  std::string key_file;
  std::optional<double> timeout_s;
  int port = 0;
  bool is_read_only = false;
  bool opens_browser = false;
};

ExitCode invalid_view(const std::string& error) {
  print_error(error);
  return ExitCode::kInvalidInput;
}

base::Result<std::optional<DoorRequest>> read_first_request(const std::string& file) {
  if (file.empty()) return std::optional<DoorRequest>();
  base::Result<DoorRequest> request = read_door_request(file);
  if (!request) return base::Failure{request.error};
  return std::optional<DoorRequest>(*std::move(request));
}

/// Loads the scene of the flags, or that of the request. Returns what plans in it here.
base::Result<std::unique_ptr<view::Backend>> backend_here(const ViewFlags& flags,
                                                          const std::optional<DoorRequest>& first) {
  const std::string file =
      first ? flags.file.file_for(flags.request, first->request) : flags.file.file;
  if (file.empty()) {
    return base::Failure{"SCENE names a scene of a daemon, --scene a file to plan in without one"};
  }
  scene::SnapshotOptions options;
  options.import = flags.file.import_options(first ? first->request.reading : SceneReading{});
  const scene::SnapshotResult loaded =
      load_timed(place_name(file), file, options, user_cache(flags.file)).result;
  if (!loaded.snapshot) return base::Failure{loaded.error};
  return view::plan_here(loaded.snapshot, {.scene_reading = options.import});
}

base::Result<std::unique_ptr<view::Backend>> backend_daemon(ViewFlags flags) {
  if (std::string fault = use_key_file(flags.key_file, flags.client); !fault.empty()) {
    return base::Failure{std::move(fault)};
  }
  use_timeout(flags.timeout_s, flags.client);
  return view::plan_by_daemon(flags.scene, flags.client);
}

/// Begins to plan the request of the flags, for the first page. Returns it as the door takes it.
std::string plan_first(view::Backend& backend, const std::string& file, DoorRequest first) {
  view::PlanOrder order = plan_order(std::move(first), backend.scene());
  std::string text = *order.text;
  backend.plan(std::move(order), nullptr, [file](const view::Answer& answer) {
    if (!answer.error.empty()) print_error(file + ": " + answer.error);
  });
  return text;
}

/// Prints the address and serves until a signal to end comes.
ExitCode serve_door(const ViewFlags& flags, const Interruption& interruption,
                    const std::string& first_request, view::Backend& backend) {
  constexpr long kLongLookMs = 900;
  view::DoorOptions options;
  options.port = flags.port;
  options.is_read_only = flags.is_read_only;
  options.first_request = first_request;
  options.page = view::embedded_page();
  options.token = view::random_token();
  if (options.token.empty()) {
    print_error("the kernel gives no random bits for the token");
    return ExitCode::kOurFault;
  }
  const base::Result<std::unique_ptr<view::Door>> door = view::Door::open(options, backend);
  if (!door) return invalid_view(door.error);
  const std::string url = (*door)->url();
  fmt::print("{}\n", url);
  std::fflush(stdout);
  Browser browser;
  if (flags.opens_browser) {
    if (const std::string fault = browser.open(url); !fault.empty()) print_error(fault);
  }
  while (!interruption.came_within(kLongLookMs)) {
  }
  return ExitCode::kSuccess;
}

ExitCode run_view(const ViewFlags& flags) {
  base::Result<std::optional<DoorRequest>> first = read_first_request(flags.request);
  if (!first) return invalid_view(first.error);
  // Before any thread, all of which inherit the signal mask.
  const Interruption interruption;
  const base::Result<std::unique_ptr<view::Backend>> backend =
      flags.scene.empty() ? backend_here(flags, *first) : backend_daemon(flags);
  if (!backend) return invalid_view(backend.error);
  std::string request_text;
  if (*first) request_text = plan_first(**backend, flags.request, **std::move(first));
  return serve_door(flags, interruption, request_text, **backend);
}

constexpr char kViewFooter[] =
    "Prints one line with the address and its token, which is what lets programs and pages ask; it "
    "listens on\n127.0.0.1 alone. Ctrl-C ends it. docs/http.md says what it answers. A daemon is "
    "not needed to begin: requests\nare answered with 503 until one is heard.\n";

}  // namespace

void add_view_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<ViewFlags>();
  CLI::App* command = app.add_subcommand(
      "view",
      "Serve scenes and plans to browsers and programs of this machine: HTTP and WebSocket");
  CLI::Option* const daemon =
      command->add_option("SCENE", flags->scene, "Name of a scene in a daemon, which then plans");
  add_request_scene_flags(*command, flags->file);
  for (const char* const flag : {"--scene", "--scale", "--up", "--unknown", "--no-cache"}) {
    command->get_option(flag)->excludes(daemon);
  }
  command->add_option("--request", flags->request, "Request file to plan at first")
      ->type_name("FILE");
  command
      ->add_option("--url", flags->client.url,
                   "LCM network [LCM_DEFAULT_URL, else multicast on this host]")
      ->needs(daemon);
  command->add_option("--prefix", flags->client.prefix, "Prefix of the daemon's channels")
      ->capture_default_str()
      ->needs(daemon);
  add_key_file(*command, flags->key_file)->needs(daemon);
  add_timeout(*command, flags->timeout_s)->needs(daemon);
  constexpr std::int64_t kLargestPort = 65'535;
  command->add_option("--port", flags->port, "Port of 127.0.0.1 to listen on [any free one]")
      ->check(cli_support::whole_number(0, kLargestPort));
  command->add_flag("--read-only", flags->is_read_only, "Refuse changes of scenes");
  command->add_flag("--open", flags->opens_browser, "Open the address in a browser (xdg-open)");
  command->footer(std::string(kViewFooter) + exit_code_help("") +
                  "\nExample: camway view --scene scenes/office.obj --request "
                  "scenes/requests/office-graze-door.json");
  command->callback([flags, &exit_code] { exit_code = run_view(*flags); });
}

}  // namespace camway::tools
