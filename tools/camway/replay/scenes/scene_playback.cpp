// SPDX-License-Identifier: MIT
#include "tools/camway/replay/scenes/scene_playback.h"

#include <fmt/format.h>

#include <limits>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include <camway/scene_request_t.hpp>
#include <camway/scene_response_t.hpp>
#include <camway/upload_page_t.hpp>

#include "daemon/record/event_log.h"
#include "daemon/service/scenes/scene_operation.h"
#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/check.h"
#include "tools/camway/replay/signed_event.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;
using Key = std::pair<std::string, std::int64_t>;  // client and request id

/// Largest uploads of a log, so that one that lies about their sizes takes no more.
constexpr service::Uploads::Limits kUploads{
    .uploads = 256, .bytes = std::size_t{1} << 30, .total_bytes = std::size_t{4} << 30};

scene::SceneStoreLimits playback_limits() {
  scene::SceneStoreLimits limits;
  limits.scenes = limits.objects = std::numeric_limits<std::size_t>::max();
  limits.triangles = limits.occupancy_bytes = std::numeric_limits<std::uint64_t>::max();
  return limits;
}

class Playback {
 public:
  Playback(const std::string& prefix, const wire::MessageKeys* keys, const Scenes& first,
           const std::vector<fs::path>& roots, std::set<std::string> wanted)
      : channels_{prefix},
        keys_(keys),
        store_(playback_limits()),
        uploads_(kUploads),
        wanted_(std::move(wanted)) {
    if (auto opened = service::SceneRoots::make(roots)) rules_.roots = *std::move(opened);
    for (const auto& [name, snapshot] : first) {
      auto named = std::make_shared<scene::Snapshot>(*snapshot);
      named->name = name;
      store_.put(named);
      keep(name);
    }
  }

  [[nodiscard]] bool wants(std::string_view channel) const {
    return channel == channels_.scene_request() || channel == channels_.upload() ||
           channel.starts_with(channels_.scene_response(""));
  }

  void add(record::LogEvent event) {
    if (open_event(keys_, event)) return;
    if (event.channel == channels_.upload()) {
      const auto page = wire::decode<upload_page_t>(event.data);
      if (page.message) uploads_.take(*page.message, service::Uploads::Clock::now());
    } else if (event.channel == channels_.scene_request()) {
      auto request = wire::decode<scene_request_t>(event.data);
      if (!request.message || !changes_scene(*request.message)) return;
      const Key key(request.message->client_id, request.message->request_id);
      asked_.try_emplace(key, *std::move(request.message));
    } else {
      const auto answer = wire::decode<scene_response_t>(event.data);
      if (answer.message) take(*answer.message);
    }
  }

  PlayedBack finish() { return std::move(made_); }

 private:
  /// Makes the change that an answer confirms, once.
  void take(const scene_response_t& answer) {
    const auto asked = asked_.find({answer.client_id, answer.request_id});
    if (asked == asked_.end() || answer.status != scene_response_t::STATUS_OK) return;
    scene_request_t request = std::move(asked->second);
    asked_.erase(asked);
    const std::string fault = make(request, answer);
    if (fault.empty()) return;
    made_.faults.push_back(
        fmt::format("revision {} of scene '{}' cannot be made again ({} by {}): {}",
                    answer.scene.revision, wire::printable(service::target_of(request)),
                    service::operation_name(request), wire::printable(answer.client_id), fault));
  }

  std::string make(scene_request_t& request, const scene_response_t& answer) {
    if (request.operation == scene_request_t::RESTORE) {
      const auto ours = revisions_.find({request.scene, request.revision});
      if (ours == revisions_.end()) return "the revision to restore is not in the log";
      request.revision = ours->second;
    }
    const std::string name = service::target_of(request);
    const service::UploadedBytes upload =
        uploads_.find({request.client_id, request.upload_bytes, request.upload_checksum});
    const service::OperationContext context{rules_, store_, writing_, {}};
    const scene_response_t again = service::execute(request, upload, context).answer;
    if (again.status != scene_response_t::STATUS_OK) return again.message;
    if (request.operation == scene_request_t::UNLOAD) return {};
    if (again.scene.digest != answer.scene.digest) return "it has other triangles now";
    revisions_[{name, answer.scene.revision}] = again.scene.revision;
    keep(name);
    return {};
  }

  /// Keeps the newest revision of a scene, if an answer names it.
  void keep(const std::string& name) {
    const auto snapshot = store_.find(name);
    if (snapshot && wanted_.contains(snapshot->digest)) {
      made_.scenes.emplace(snapshot->digest, snapshot);
    }
  }

  wire::Channels channels_;
  const wire::MessageKeys* keys_;
  scene::SceneStore store_;
  service::SceneRules rules_;
  service::Uploads uploads_;
  std::mutex writing_;
  std::set<std::string> wanted_;
  std::map<Key, scene_request_t> asked_;
  /// Revisions here, by scene and revision in the log.
  std::map<std::pair<std::string, std::int64_t>, std::int64_t> revisions_;
  PlayedBack made_;
};

}  // namespace

bool changes_scene(const scene_request_t& request) {
  return !service::is_query(request) && request.operation != scene_request_t::EXPORT &&
         request.operation != scene_request_t::TRIANGLES;
}

PlayedBack play_back_changes(const Session& session, const std::vector<fs::path>& logs,
                             const std::string& prefix, const wire::MessageKeys* keys,
                             const Scenes& first, const std::vector<fs::path>& roots) {
  Playback playback(prefix, keys, first, roots, digests_of(session));
  for (const fs::path& log : logs) {
    // Damage was reported when the session was read.
    record::read_event_log(
        log, [&](std::string_view channel) { return playback.wants(channel); },
        [&](record::LogEvent&& event) { playback.add(std::move(event)); });
  }
  return playback.finish();
}

}  // namespace camway::tools
