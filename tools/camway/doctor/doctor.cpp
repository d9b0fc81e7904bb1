// SPDX-License-Identifier: MIT
#include "tools/camway/doctor/doctor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "daemon/cli_support/flag_checks.h"
#include "daemon/process/settings/daemon_options.h"
#include "lcmtypes/wire/channels.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/common/key_file.h"
#include "tools/json/json_text.h"

namespace camway::tools {
namespace {

using OrderedJson = nlohmann::ordered_json;

struct DoctorFlags {
  DoctorOptions options;
  std::string key_file;
  bool json = false;
};

void print_text(const std::vector<Finding>& findings, std::ptrdiff_t problems) {
  for (const Finding& finding : findings) {
    fmt::print("{:<8} {:<16} {}\n", to_string(finding.severity), finding.check, finding.text);
    if (!finding.mend.empty()) fmt::print("{:<8} {:<16} mend: {}\n", "", "", finding.mend);
  }
  fmt::print("{}\n", problems == 0 ? "Camway works here." : "Camway does not work here yet.");
}

void print_json(const std::vector<Finding>& findings, std::ptrdiff_t problems) {
  OrderedJson list = OrderedJson::array();
  for (const Finding& finding : findings) {
    list.push_back({{"check", finding.check},
                    {"severity", to_string(finding.severity)},
                    {"text", finding.text},
                    {"mend", finding.mend}});
  }
  const OrderedJson json{{"problems", problems}, {"findings", std::move(list)}};
  fmt::print("{}\n", json_text(json, 2));
}

ExitCode run_doctor(DoctorFlags flags) {
  if (!wire::is_prefix(flags.options.prefix)) {
    print_error("--prefix: must be of 1 to 11 letters, digits, '_' and '-'");
    return ExitCode::kInvalidInput;
  }
  ClientOptions signing;
  if (const std::string fault = use_key_file(flags.key_file, signing); !fault.empty()) {
    print_error(fault);
    return ExitCode::kInvalidInput;
  }
  flags.options.authentication = signing.authentication;
  const std::vector<Finding> findings = diagnose(gather_facts(flags.options));
  const auto problems = std::count_if(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.severity == Severity::kProblem;
  });
  if (flags.json) {
    print_json(findings, problems);
  } else {
    print_text(findings, problems);
  }
  return problems == 0 ? ExitCode::kSuccess : ExitCode::kNegative;
}

}  // namespace

void add_doctor_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<DoctorFlags>();
  flags->options.url = process::default_options().lcm_url;
  CLI::App* command = app.add_subcommand(
      "doctor",
      "Say what keeps Camway from working on this machine, and the command that mends it");
  command->add_option("--url", flags->options.url, "LCM network [LCM_DEFAULT_URL]")
      ->capture_default_str();
  command->add_option("--prefix", flags->options.prefix, "Prefix of the daemon's channels")
      ->capture_default_str();
  command
      ->add_option("--config", flags->options.config_file,
                   "Configuration of a daemon, to be looked at with its scene files")
      ->type_name("FILE");
  add_key_file(*command, flags->key_file);
  command->add_flag("--other-hosts", flags->options.other_hosts,
                    "Daemon and clients are to be on several hosts");
  command
      ->add_option("--timeout-s", flags->options.timeout_s,
                   "How long to listen for a daemon, seconds")
      ->check(cli_support::between(0.0, 3600.0))
      ->capture_default_str();
  command->add_flag("--json", flags->json, "Print JSON, for machines");
  command->footer("Changes nothing. Notes and warnings are no problems.\n" +
                  exit_code_help("there are problems, as where no daemon is heard") +
                  "\nExample: camway doctor --config /etc/camway/camwayd.toml");
  command->callback([flags, &exit_code] { exit_code = run_doctor(*flags); });
}

}  // namespace camway::tools
