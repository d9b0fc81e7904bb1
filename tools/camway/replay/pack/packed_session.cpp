// SPDX-License-Identifier: MIT
#include "tools/camway/replay/pack/packed_session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "daemon/record/log_files.h"
#include "lcmtypes/wire/channels.h"
#include "tools/camway/replay/pack/plain_scenes.h"
#include "tools/camway/replay/pack/scene_contents.h"
#include "tools/camway/replay/pack/session_cut.h"
#include "tools/camway/replay/scenes/session_scenes.h"
#include "tools/camway/session/session_pack.h"
#include "tools/support/output_file.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

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

std::string name_of(const RecordedRequest& request) {
  return fmt::format("{}/{}", request.ids.client_id, request.ids.request_id);
}

std::string sentence_on(const std::vector<std::string>& requests) {
  return fmt::format("{} cannot be replayed: {}", requests.size() == 1 ? "a request" : "requests",
                     fmt::join(requests, ", "));
}

class Collector {
 public:
  explicit Collector(const PackSource& source) : source_(source) {}

  /// Returns an error, empty on success.
  std::string collect() {
    packed_.left_out = source_.files.left_out();
    packed_.is_damaged = source_.session.is_damaged();
    std::string fault = source_.is_selection ? cut_logs() : take_logs();
    if (fault.empty()) fault = add_contents();
    if (fault.empty()) fault = add_plain_scenes();
    if (fault.empty() && !packed_.left_out.empty()) fault = write_left_out();
    return fault;
  }
  PackedSession take() { return std::move(packed_); }

 private:
  void leave_out(std::string sentence) { packed_.left_out.push_back(std::move(sentence)); }
  void lack(std::string sentence) {
    packed_.is_damaged = true;
    leave_out(std::move(sentence));
  }

  /// Makes a folder that lives as long as the pack needs it.
  base::Result<fs::path> make_folder() {
    base::Result<ScratchFolder> folder = ScratchFolder::make("pack");
    if (!folder) return base::Failure{folder.error};
    packed_.made.push_back(std::make_shared<const ScratchFolder>(*std::move(folder)));
    return packed_.made.back()->path();
  }

  std::string take_logs() {
    logs_ = source_.files.logs();
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      packed_.members[member_name(logs_[i], i, source_.is_one_of_many)] = logs_[i];
    }
    return {};
  }

  std::string cut_logs() {
    const base::Result<fs::path> folder = make_folder();
    if (!folder) return folder.error;
    const CutPlan plan = plan_cut(source_.session);
    const std::vector<fs::path>& logs = source_.files.logs();
    for (std::size_t i = 0; i < logs.size(); ++i) {
      const std::string name = member_name(logs[i], i, source_.is_one_of_many);
      logs_.push_back(*folder / name);
      packed_.members[name] = logs_.back();
      if (std::string fault = cut_log(logs[i], source_.prefix, source_.keys, plan, logs_.back());
          !fault.empty()) {
        return fault;
      }
    }
    leave_out(fmt::format("{} of {} requests, and all messages about other things: not selected",
                          source_.session.unwanted,
                          source_.session.unwanted + source_.session.requests.size()));
    const record::LogSummary& log = source_.session.log;
    if (!log.damage.empty()) {
      leave_out(fmt::format("all behind the damage of a log: {} of {} bytes were read",
                            log.bytes_used, log.bytes));
    }
    if (source_.session.damaged_events > 0) {
      leave_out(fmt::format("{} events of the recording that cannot be read",
                            source_.session.damaged_events));
    }
    return {};
  }

  std::string add_contents() {
    const std::vector<fs::path> folders = blob_folders_of(source_.files.logs());
    std::optional<Session> cut;
    if (source_.is_selection) cut = read_session(logs_, source_.prefix, source_.keys);
    const Session& packed = cut ? *cut : source_.session;
    SceneContents contents = scene_contents_of(packed, folders);
    packed_.members.merge(contents.files);
    for (std::string& fault : contents.faults) lack(std::move(fault));
    if (contents.faults.empty() && has_all_revisions(packed)) return {};
    SessionScenes scenes(packed, folders);
    std::map<std::string, std::vector<std::string>> lost;  // requests by revision
    for (const RecordedRequest& request : source_.session.requests) {
      if (!needs_recorded(request) || scenes.snapshot_of(request).why_not.empty()) continue;
      lost[fmt::format("revision {} of scene '{}'", request.answer->scene_revision,
                       wire::printable(request.scene))]
          .push_back(name_of(request));
    }
    for (const auto& [revision, requests] : lost) lack(revision + ": " + sentence_on(requests));
    return {};
  }

  static bool needs_recorded(const RecordedRequest& request) {
    return request.answer && request.answer->result && !request.answer->recording.empty() &&
           !scene_was_unknown(request);
  }

  /// Whether a selection has each revision that it needs. What a whole recording lacks, replays of
  /// it say.
  [[nodiscard]] bool has_all_revisions(const Session& packed) const {
    if (!source_.is_selection) return true;
    std::set<std::pair<std::string, std::uint64_t>> made;
    for (const RecordedUpdate& update : packed.updates) {
      made.emplace(update.recording + '/' + update.change.update.scene,
                   update.change.update.entry.revision);
    }
    return std::ranges::all_of(source_.session.requests, [&](const RecordedRequest& request) {
      return !needs_recorded(request) ||
             made.contains(
                 {request.answer->recording + '/' + request.scene, request.answer->scene_revision});
    });
  }

  /// Adds the scenes that plain logs need as another log.
  std::string add_plain_scenes() {
    const auto sources = open_scene_sources(source_.scenes, source_.session, source_.files,
                                            source_.prefix, source_.keys);
    if (!sources) return sources.error;
    const PlainScenes scenes = plain_scenes_of(source_.session, **sources);
    for (const auto& [reason, requests] : scenes.missing) {
      std::vector<std::string> names;
      for (const RecordedRequest* request : requests) names.push_back(name_of(*request));
      lack(reason + "; " + sentence_on(names));
    }
    if (scenes.found.empty()) return {};
    const base::Result<fs::path> folder = make_folder();
    if (!folder) return folder.error;
    if (std::string fault =
            write_scenes(*folder, source_.prefix, source_.session.begin_utime, scenes.found);
        !fault.empty()) {
      return fault;
    }
    const base::Result<SessionFiles> written = SessionFiles::open(*folder);
    if (!written) return written.error;
    for (const fs::path& log : written->logs()) {
      packed_.members["scenes-" + log.filename().string()] = log;
    }
    packed_.members.merge(scene_contents_of(read_session(written->logs(), source_.prefix),
                                            blob_folders_of(written->logs()))
                              .files);
    return {};
  }

  std::string write_left_out() {
    const base::Result<fs::path> folder = make_folder();
    if (!folder) return folder.error;
    std::string text;
    for (const std::string& sentence : packed_.left_out) text += sentence + '\n';
    packed_.members[kLeftOutName] = *folder / kLeftOutName;
    return write_file(*folder / kLeftOutName, text);
  }

  const PackSource& source_;
  std::vector<fs::path> logs_;  ///< that are packed: those of the source, or parts of them
  PackedSession packed_;
};

}  // namespace

base::Result<PackedSession> collect_pack(const PackSource& source) {
  Collector collector(source);
  if (std::string fault = collector.collect(); !fault.empty()) {
    return base::Failure{std::move(fault)};
  }
  return collector.take();
}

}  // namespace camway::tools
