// SPDX-License-Identifier: MIT
#include "tools/camway/replay/pack/plain_scenes.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "daemon/record/event_log.h"
#include "daemon/record/log_files.h"
#include "daemon/record/session_events.h"
#include "daemon/record/update_log.h"
#include "daemon/scene/log/durable_scenes.h"
#include "lcmtypes/wire/channels.h"

namespace camway::tools {

PlainScenes plain_scenes_of(const Session& session, ReplayScenes& sources) {
  PlainScenes scenes;
  std::map<std::string, std::string> reasons;  // of digests that were not found
  for (const RecordedRequest& request : session.requests) {
    if (!request.answer || !request.answer->recording.empty()) continue;
    const std::string& digest = request.answer->scene_digest;
    if (digest.empty() || scenes.found.contains(digest)) continue;
    const auto [reason, is_new] = reasons.try_emplace(digest);
    if (is_new) {
      FoundScene found = sources.snapshot_of(request);
      if (found.snapshot && found.snapshot->digest == digest) {
        scenes.found.emplace(digest, std::move(found.snapshot));
        reasons.erase(reason);
        continue;
      }
      const std::string why =
          found.snapshot ? "the scene at hand has other triangles" : found.why_not;
      reason->second =
          fmt::format("revision {} of scene '{}', digest {}: {}", request.answer->scene_revision,
                      wire::printable(request.scene), wire::printable(digest), why);
    }
    scenes.missing[reason->second].push_back(&request);
  }
  return scenes;
}

std::string write_scenes(
    const std::filesystem::path& folder, const std::string& prefix, std::int64_t utime,
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
    record::append_event(0, utime, record::session_channel(prefix), bytes, events);
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

}  // namespace camway::tools
