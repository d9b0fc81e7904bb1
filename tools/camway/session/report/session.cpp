// SPDX-License-Identifier: MIT
#include "tools/camway/replay/session.h"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "lcmtypes/wire/auth/message_keys.h"
#include "lcmtypes/wire/channels.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/session/report/session_mcap.h"
#include "tools/camway/session/report/session_table.h"
#include "tools/camway/session/session_files.h"
#include "tools/support/output_file.h"

namespace camway::tools {
namespace {

struct SessionFlags {
  std::string log;
  std::string prefix = "CAMWAY";
  std::string key_file;
  std::string csv;
  std::string mcap;
};

ExitCode refuse_session(const std::string& message) {
  print_error(message);
  return ExitCode::kInvalidInput;
}

ExitCode run_session(const SessionFlags& flags) {
  if (!wire::is_prefix(flags.prefix)) {
    return refuse_session("--prefix " + flags.prefix +
                          ": must be 1 to 11 letters, digits, '-' or '_'");
  }
  wire::MessageKeys::ReadResult keys;
  if (!flags.key_file.empty()) keys = wire::MessageKeys::from_file(flags.key_file);
  if (!keys.error.empty()) return refuse_session("--key-file " + keys.error);
  const bool is_printed = flags.csv == "-";
  for (const std::string& file : {is_printed ? "" : flags.csv, flags.mcap}) {
    if (file.empty()) continue;
    const std::string fault = why_unwritable(file, {flags.log, flags.key_file});
    if (!fault.empty()) return refuse_session(fault);
  }
  // A pack is unpacked until the end of the command.
  const base::Result<SessionFiles> files = SessionFiles::open(flags.log);
  if (!files) return refuse_session(files.error);
  Session session = read_session(files->logs(), flags.prefix, keys.keys.get());
  session.left_out = files->left_out();
  if (!session.log.damage.empty()) print_error(session.log.damage);
  if (session.log.events == 0) {
    return session.log.damage.empty() ? refuse_session(flags.log + ": is empty")
                                      : ExitCode::kInvalidInput;
  }
  // Standard output is either the table or the summary.
  std::string error;
  if (!flags.csv.empty() && !is_printed) error = write_file(flags.csv, session_csv(session));
  if (!flags.mcap.empty() && error.empty()) error = write_file(flags.mcap, session_mcap(session));
  if (!error.empty()) return refuse_session(error);
  fmt::print("{}", is_printed ? session_csv(session) : session_summary(session));
  return session.is_damaged() ? ExitCode::kInvalidInput : ExitCode::kSuccess;
}

}  // namespace

void add_session_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<SessionFlags>();
  CLI::App* command = app.add_subcommand(
      "session", "Show what a recorded session holds, or write it as CSV or MCAP");
  command
      ->add_option("LOG", flags->log,
                   "Log of lcm-logger, folder of a daemon's recordings, or packed session")
      ->required();
  command->add_option("--prefix", flags->prefix, "Prefix of the daemon's channels")
      ->capture_default_str();
  command
      ->add_option("--key-file", flags->key_file,
                   "Use only messages that were signed with a key of this file")
      ->type_name("FILE");
  command
      ->add_option("--csv", flags->csv,
                   "Write a line for each request, with the numbers of its answer; - is standard "
                   "output")
      ->type_name("FILE");
  command
      ->add_option("--mcap", flags->mcap,
                   "Write requests, paths and answers in schemas of Foxglove")
      ->type_name("FILE");
  command->footer(exit_code_help("") +
                  "\nA damaged log is read up to the damage and ends with 2."
                  "\nExample: camway session session.lcmlog --mcap session.mcap");
  command->callback([flags, &exit_code] { exit_code = run_session(*flags); });
}

}  // namespace camway::tools
