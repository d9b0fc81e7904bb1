// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "daemon/cli_support/flag_checks.h"
#include "lcmtypes/wire/channels.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/replay/pack/packed_session.h"
#include "tools/camway/replay/selection.h"
#include "tools/camway/replay/selection_flags.h"
#include "tools/camway/session/session_pack.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

struct PackFlags {
  std::vector<std::string> sessions;
  std::string output;
  std::string prefix = "CAMWAY";
  std::string key_file;
  SceneSourceFlags sources;
  Selection selection;
};

ExitCode wrong_input(std::string_view message) {
  print_error(message);
  return ExitCode::kInvalidInput;
}

ExitCode write_session(const PackFlags& flags, const PackedSession& packed) {
  std::vector<PackedFile> files;
  std::uint64_t bytes = 0;
  std::error_code error;
  for (const auto& [name, file] : packed.members) {
    files.push_back({file, name});
    bytes += fs::file_size(file, error);
  }
  if (const std::string fault = write_pack(flags.output, files); !fault.empty()) {
    return wrong_input(fault);
  }
  for (const std::string& sentence : packed.left_out) print_error("left out: " + sentence);
  fmt::print("{}: {} files, {} bytes, packed into {}\n", flags.output, files.size(), bytes,
             fs::file_size(flags.output, error));
  return packed.is_damaged ? ExitCode::kInvalidInput : ExitCode::kSuccess;
}

ExitCode run_pack(const PackFlags& flags) {
  if (!wire::is_prefix(flags.prefix)) return wrong_input("--prefix: is no prefix");
  wire::MessageKeys::ReadResult keys;
  if (!flags.key_file.empty()) keys = wire::MessageKeys::from_file(flags.key_file);
  if (!keys.error.empty()) return wrong_input("--key-file " + keys.error);
  base::Result<SessionFiles> files = SessionFiles::open(flags.sessions);
  if (!files) return wrong_input(files.error);
  Session session = read_session(files->logs(), flags.prefix, keys.keys.get());
  if (!session.log.damage.empty()) print_error(session.log.damage);
  if (session.log.events == 0) return wrong_input("there is nothing to pack");
  const std::size_t read = session.requests.size();
  session.unwanted = select(flags.selection, session);
  if (!flags.selection.is_all() && session.requests.empty()) {
    return wrong_input(fmt::format("none of the {} requests is selected", read));
  }
  const base::Result<PackedSession> packed =
      collect_pack({.files = *files,
                    .session = session,
                    .is_selection = !flags.selection.is_all(),
                    .is_one_of_many = flags.sessions.size() > 1,
                    .prefix = flags.prefix,
                    .keys = keys.keys.get(),
                    .scenes = flags.sources});
  return packed ? write_session(flags, *packed) : wrong_input(packed.error);
}

}  // namespace

void add_pack_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<PackFlags>();
  CLI::App* command =
      app.add_subcommand("pack", "Pack a recorded session with its scenes into one file");
  command
      ->add_option("SESSION", flags->sessions,
                   "Folders or files of camwayd --record, logs of lcm-logger, or packed sessions")
      ->required();
  command->add_option("-o,--output", flags->output, "File to write, NAME.camway-session")
      ->required()
      ->type_name("FILE");
  command->add_option("--prefix", flags->prefix, "Prefix of the daemon's channels")
      ->capture_default_str();
  command
      ->add_option(
          "--key-file", flags->key_file,
          "Use only messages that were signed with a key of this file, for a selection and for "
          "the scenes of a plain log")
      ->type_name("FILE");
  add_scene_source_flags(*command, flags->sources);
  add_selection_flags(*command, flags->selection);
  command->footer(exit_code_help("") +
                  "\nThe file holds all messages and scenes in clear. A selection keeps only the "
                  "requests that it names, their answers, and the scenes that these need."
                  "\nWhere the session is damaged or a scene is not found, the rest is packed, a "
                  "line says what is left out and which requests cannot be replayed, and the "
                  "command ends with 2."
                  "\nExample: camway pack session.lcmlog --scene office=scenes/office.obj -o "
                  "bug.camway-session");
  command->callback([flags, &exit_code] { exit_code = run_pack(*flags); });
}

void add_unpack_command(CLI::App& app, ExitCode& exit_code) {
  struct Flags {
    std::string pack;
    std::string folder;
    std::uint64_t most_bytes = kMostUnpackedBytes;
  };
  const auto flags = std::make_shared<Flags>();
  CLI::App* command =
      app.add_subcommand("unpack", "Check a packed session, and unpack it into a folder");
  command->add_option("FILE", flags->pack, "File of camway pack")->required();
  command->add_option("DIR", flags->folder, "Folder to make")->required();
  command
      ->add_option("--most-bytes", flags->most_bytes,
                   "Refuse a pack that holds more bytes than this")
      ->check(cli_support::whole_number(1))
      ->capture_default_str();
  command->footer(exit_code_help("") +
                  "\nIf a member is missing or damaged, the command names it and leaves nothing. "
                  "It says what was left out when the session was packed."
                  "\nExample: camway unpack bug.camway-session bug");
  command->callback([flags, &exit_code] {
    const std::string fault = unpack(flags->pack, flags->folder, flags->most_bytes);
    exit_code = fault.empty() ? ExitCode::kSuccess : wrong_input(fault);
    if (!fault.empty()) return;
    for (const std::string& sentence : left_out_in(flags->folder)) {
      print_error("left out when it was packed: " + sentence);
    }
  });
}

}  // namespace camway::tools
