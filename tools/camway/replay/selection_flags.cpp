// SPDX-License-Identifier: MIT
#include "tools/camway/replay/selection_flags.h"

#include <string>
#include <vector>

#include "daemon/cli_support/flag_checks.h"

namespace camway::tools {
namespace {

/// Adds an option whose text `read` turns into a value.
template <class Value, class Read>
CLI::Option* add_read(CLI::App& command, const std::string& flag, Value& value, const Read& read,
                      const std::string& description, const std::string& form) {
  const auto set = [&value, read](const std::string& text) { value = *read(text); };
  const auto check = [read, form](const std::string& text) {
    return read(text) ? std::string() : text + ": must be " + form;
  };
  return command.add_option_function<std::string>(flag, set, description)->check(check);
}

CLI::Option* add_words(CLI::App& command, const std::string& flag, std::vector<std::string>& words,
                       const std::string& description) {
  return command.add_option(flag, words, description)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace

void add_selection_flags(CLI::App& command, Selection& selection) {
  const std::string time_form =
      "seconds after the first event, or a time such as "
      "2026-11-27T08:30:00Z";
  add_read(command, "--from", selection.from, &log_time_of,
           "Only requests received at this time of the log or later: seconds after its first "
           "event, or a time of the clock, 2026-11-27T08:30:00Z",
           time_form)
      ->type_name("TIME");
  add_read(command, "--to", selection.to, &log_time_of,
           "Only requests received at this time or earlier", time_form)
      ->type_name("TIME");
  add_read(command, "--id", selection.ids, &id_ranges_of, "Only requests with these ids: 3,7..9",
           "ids and ranges such as 3,7..9")
      ->type_name("IDS");
  add_words(command, "--client", selection.clients,
            "Only requests of these clients, with ',' between them")
      ->type_name("CLIENT");
  add_words(command, "--scene-name", selection.scenes,
            "Only requests in scenes of these names, with ',' between them")
      ->type_name("NAME");
  add_words(
      command, "--status", selection.statuses,
      "Only requests with these recorded statuses, with ',' between them; none: without an answer")
      ->type_name("STATUS")
      ->check(cli_support::one_of(status_words()));
}

}  // namespace camway::tools
