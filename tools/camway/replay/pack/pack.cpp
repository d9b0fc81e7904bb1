// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "daemon/record/blob_reader.h"
#include "daemon/record/log_files.h"
#include "daemon/record/update_log.h"
#include "daemon/scene/log/durable_scenes.h"
#include "daemon/scene/log/source_record.h"
#include "lcmtypes/wire/channels.h"
#include "tools/camway/common/commands.h"
#include "tools/camway/replay/scenes/scene_sources.h"
#include "tools/camway/replay/scenes/session_scenes.h"
#include "tools/camway/replay/session.h"
#include "tools/camway/session/session_pack.h"
#include "tools/support/scratch_folder.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

struct PackFlags {
  std::vector<std::string> sessions;
  std::string output;
  std::string prefix = "CAMWAY";
  std::string key_file;
  SceneSourceFlags sources;
};

ExitCode wrong_input(std::string_view message) {
  print_error(message);
  return ExitCode::kInvalidInput;
}

/// Adds the contents that changes of scenes name, and those that these need. Fails if one is
/// missing or damaged.
std::string add_blobs(const Session& session, const std::vector<fs::path>& folders,
                      std::map<std::string, fs::path>& members) {
  record::BlobReader blobs(folders);
  std::vector<scene::BlobId> wanted;
  for (const RecordedUpdate& update : session.updates) {
    const auto& needs = update.change.update.entry.needs;
    wanted.insert(wanted.end(), needs.begin(), needs.end());
  }
  std::set<scene::BlobId> seen;
  while (!wanted.empty()) {
    const scene::BlobId id = wanted.back();
    wanted.pop_back();
    if (!seen.insert(id).second) continue;
    const base::Result<scene::Bytes> bytes = blobs.blob(id);
    if (!bytes) return bytes.error;
    const base::Result<std::optional<scene::BlobId>> base = scene::base_of_record(*bytes);
    if (!base) return record::hex_of(id) + ": " + base.error;
    if (*base) wanted.push_back(**base);
    std::error_code error;
    for (const fs::path& folder : folders) {
      const fs::path file = folder / record::hex_of(id);
      if (fs::exists(file, error)) members["blobs/" + record::hex_of(id)] = file;
    }
  }
  return {};
}

/// Writes scenes into a folder in the form of a recording, each once by its digest. Returns an
/// error, empty on success.
std::string write_recording(
    const fs::path& folder, const std::string& prefix,
    const std::map<std::string, std::shared_ptr<const scene::Snapshot>>& scenes) {
  /// One file, however large.
  constexpr record::RecordLimits kAll{
      .file_bytes = SIZE_MAX, .file_time = std::chrono::hours(24), .most_bytes = SIZE_MAX};
  base::Result<record::LogFiles> files = record::LogFiles::open(folder, "scenes", kAll);
  if (!files) return files.error;
  std::vector<std::uint8_t> events;
  std::string digest;
  record::UpdateLog updates(*files, [&](scene::LogUpdate update) {
    const auto bytes = record::bytes_of(record::SceneUpdate{std::move(update), digest});
    record::append_event(0, 0, record::session_channel(prefix), bytes, events);
  });
  scene::DurableScenes recorded(updates);
  for (const auto& [each, snapshot] : scenes) {
    digest = each;
    const scene::Keeping kept = recorded.keep_scene(*snapshot, snapshot->revision, {});
    if (!kept.error.empty()) return kept.error;
  }
  scene::AppendResult done = files->begin_next();
  if (done.error.empty()) done = files->append(events);
  return done.error;
}

/// Returns the scenes of answers in plain logs, by their digests. Prints those that are not found.
std::map<std::string, std::shared_ptr<const scene::Snapshot>> scenes_of_plain_answers(
    const Session& session, ReplayScenes& sources) {
  std::map<std::string, std::shared_ptr<const scene::Snapshot>> scenes;
  std::set<std::string> said;
  for (const RecordedRequest& request : session.requests) {
    if (!request.answer || !request.answer->recording.empty()) continue;
    const std::string& digest = request.answer->scene_digest;
    if (digest.empty() || scenes.contains(digest)) continue;
    FoundScene found = sources.snapshot_of(request);
    if (found.snapshot && found.snapshot->digest == digest) {
      scenes.emplace(digest, std::move(found.snapshot));
    } else if (said.insert(digest).second) {
      print_error(fmt::format(
          "scene revision {} of '{}' is not packed: {}", request.answer->scene_revision,
          wire::printable(request.scene),
          found.why_not.empty() ? "the scene at hand has other triangles" : found.why_not));
    }
  }
  return scenes;
}

/// Returns a name for a log in the pack that is free, and sorts as the logs are given.
std::string member_name(const fs::path& log, std::size_t index, bool is_one_of_many) {
  std::string name = log.filename();
  for (char& c : name) {
    if (!wire::is_plain_name(std::string_view(&c, 1), 1) && c != '.') c = '_';
  }
  if (!name.ends_with(record::kLogEnding)) name += record::kLogEnding;
  if (is_one_of_many || !is_pack_name(name)) name = fmt::format("{:04}-{}", index, name);
  return name;
}

/// Adds the scenes that plain logs need as another log, in a folder that `extra` keeps. Returns an
/// error, empty on success.
std::string add_extra_scenes(const Session& session, ReplayScenes& sources,
                             const std::string& prefix, std::optional<ScratchFolder>& extra,
                             std::map<std::string, fs::path>& members) {
  const auto scenes = scenes_of_plain_answers(session, sources);
  if (scenes.empty()) return {};
  base::Result<ScratchFolder> folder = ScratchFolder::make("pack");
  if (!folder) return folder.error;
  extra.emplace(*std::move(folder));
  if (std::string fault = write_recording(extra->path(), prefix, scenes); !fault.empty()) {
    return fault;
  }
  const base::Result<SessionFiles> written = SessionFiles::open(extra->path());
  if (!written) return written.error;
  for (const fs::path& log : written->logs()) members["scenes" + log.filename().string()] = log;
  return add_blobs(read_session(written->logs(), prefix), blob_folders_of(written->logs()),
                   members);
}

ExitCode write_session(const PackFlags& flags, const std::map<std::string, fs::path>& members) {
  std::vector<PackedFile> files;
  std::uint64_t bytes = 0;
  std::error_code error;
  for (const auto& [name, file] : members) {
    files.push_back({file, name});
    bytes += fs::file_size(file, error);
  }
  if (const std::string fault = write_pack(flags.output, files); !fault.empty()) {
    return wrong_input(fault);
  }
  fmt::print("{}: {} files, {} bytes, packed into {}\n", flags.output, files.size(), bytes,
             fs::file_size(flags.output, error));
  return ExitCode::kSuccess;
}

ExitCode run_pack(const PackFlags& flags) {
  if (!wire::is_prefix(flags.prefix)) return wrong_input("--prefix: is no prefix");
  wire::MessageKeys::ReadResult keys;
  if (!flags.key_file.empty()) keys = wire::MessageKeys::from_file(flags.key_file);
  if (!keys.error.empty()) return wrong_input("--key-file " + keys.error);
  base::Result<SessionFiles> files = SessionFiles::open(flags.sessions);
  if (!files) return wrong_input(files.error);
  const Session session = read_session(files->logs(), flags.prefix, keys.keys.get());
  if (!session.log.damage.empty()) print_error(session.log.damage);
  if (session.log.events == 0) return wrong_input("there is nothing to pack");
  std::map<std::string, fs::path> members;
  for (std::size_t i = 0; i < files->logs().size(); ++i) {
    members[member_name(files->logs()[i], i, flags.sessions.size() > 1)] = files->logs()[i];
  }
  if (const std::string fault = add_blobs(session, blob_folders_of(files->logs()), members);
      !fault.empty()) {
    return wrong_input(fault);
  }
  auto sources = open_scene_sources(flags.sources, session, *files, flags.prefix, keys.keys.get());
  if (!sources) return wrong_input(sources.error);
  std::optional<ScratchFolder> extra;
  if (const std::string fault = add_extra_scenes(session, **sources, flags.prefix, extra, members);
      !fault.empty()) {
    return wrong_input(fault);
  }
  return write_session(flags, members);
}

}  // namespace

void add_pack_command(CLI::App& app, ExitCode& exit_code) {
  const auto flags = std::make_shared<PackFlags>();
  CLI::App* command =
      app.add_subcommand("pack", "Pack a recorded session with its scenes into one file");
  command
      ->add_option("SESSION", flags->sessions,
                   "Folders or files of camwayd --record, or logs of lcm-logger")
      ->required();
  command->add_option("-o,--output", flags->output, "File to write, NAME.camway-session")
      ->required()
      ->type_name("FILE");
  command->add_option("--prefix", flags->prefix, "Of the daemon's channels")->capture_default_str();
  command
      ->add_option("--key-file", flags->key_file,
                   "For scenes of a plain log: use only messages that were signed with these keys")
      ->type_name("FILE");
  add_scene_source_flags(*command, flags->sources);
  command->footer(exit_code_help("") +
                  "\nThe file holds all messages and scenes in clear."
                  "\nExample: camway pack session.lcmlog --scene office=scenes/office.obj -o "
                  "bug.camway-session");
  command->callback([flags, &exit_code] { exit_code = run_pack(*flags); });
}

void add_unpack_command(CLI::App& app, ExitCode& exit_code) {
  struct Flags {
    std::string pack;
    std::string folder;
  };
  const auto flags = std::make_shared<Flags>();
  CLI::App* command =
      app.add_subcommand("unpack", "Check a packed session, and unpack it into a folder");
  command->add_option("FILE", flags->pack, "File of camway pack")->required();
  command->add_option("DIR", flags->folder, "Folder to make")->required();
  command->footer(exit_code_help("") +
                  "\nIf a member is missing or damaged, names it, and leaves nothing."
                  "\nExample: camway unpack bug.camway-session bug");
  command->callback([flags, &exit_code] {
    const std::string fault = unpack(flags->pack, flags->folder);
    exit_code = fault.empty() ? ExitCode::kSuccess : wrong_input(fault);
  });
}

}  // namespace camway::tools
