// SPDX-License-Identifier: MIT
#include "tools/camway/replay/published_session.h"

#include <algorithm>
#include <variant>

#include <camway/plan_request_t.hpp>
#include <camway/scene_request_t.hpp>
#include <camway/scene_response_t.hpp>
#include <camway/upload_page_t.hpp>

#include "daemon/record/session_events.h"
#include "daemon/service/scenes/scene_operation.h"
#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/check.h"
#include "tools/camway/replay/scenes/scene_playback.h"
#include "tools/camway/replay/signed_event.h"
#include "tools/camway/session/session_files.h"

namespace camway::tools {
namespace {

using Key = std::pair<std::string, std::int64_t>;  // client and request id

class PublishedReader {
 public:
  PublishedReader(const std::string& prefix, const std::optional<RequestKeys>& wanted,
                  const wire::MessageKeys* keys)
      : channels_{prefix},
        session_channel_(record::session_channel(prefix)),
        wanted_(wanted),
        keys_(keys) {}

  [[nodiscard]] bool wants(std::string_view channel) const {
    return channel == channels_.plan_request() || channel == channels_.occupancy_request() ||
           channel == channels_.scene_request() || channel == channels_.upload() ||
           channel == session_channel_ || channel.starts_with(channels_.scene_response(""));
  }

  /// Each file says for itself in which recording it stands.
  void begin_file() { recording_.clear(); }

  void add(record::LogEvent event) {
    if (event.channel == session_channel_) return add_session_event(event);
    const bool is_answer = event.channel.starts_with(channels_.scene_response(""));
    if (open_event(keys_, event)) {
      session_.distrusted += is_answer ? 0 : 1;
    } else if (is_answer) {
      const auto answer = wire::decode<scene_response_t>(event.data);
      if (answer.message) take_answer(*answer.message);
    } else if (event.channel == channels_.scene_request()) {
      add_change(std::move(event));
    } else if (event.channel == channels_.upload()) {
      if (!wanted_) add_page(std::move(event));
    } else if (is_wanted(event)) {
      session_.events.push_back(std::move(event));
    }
  }

  PublishedSession take(std::string damage) {
    session_.damage = std::move(damage);
    std::set<Revision> unsent = told_;
    std::size_t unanswered = 0;
    std::set<std::size_t> left_out;
    for (const auto& [key, change] : changes_) {
      const bool is_sent = can_be_sent(change);
      if (!is_sent) left_out.insert(change.event);
      if (change.made && is_sent) unsent.erase(*change.made);
      if (change.made && !is_sent) unsent.insert(*change.made);
      if (!change.made && !is_sent && !change.is_refused) ++unanswered;
      if (is_sent && change.request.operation == scene_request_t::UNLOAD) {
        const std::string& unloaded = change.request.scene;
        std::erase_if(unsent, [&](const Revision& each) {
          return each.is_removal && each.scene == unloaded;
        });
      }
    }
    session_.unsent_changes = unsent.size() + unanswered;
    drop(left_out);
    return std::move(session_);
  }

 private:
  /// A revision of a scene in a recording.
  struct Revision {
    std::string recording;
    std::string scene;
    std::uint64_t revision = 0;
    bool is_removal = false;
    auto operator<=>(const Revision&) const = default;
  };
  /// A change that a client asked for.
  struct Change {
    scene_request_t request;
    std::size_t event = 0;         ///< index of its message
    bool is_refused = false;       ///< the daemon did not make it
    std::optional<Revision> made;  ///< the daemon's answer
  };

  [[nodiscard]] bool is_wanted(const record::LogEvent& event) const {
    if (!wanted_) return true;
    if (event.channel != channels_.plan_request()) return false;
    const auto sender = wire::peek_sender(wire::layout_of<plan_request_t>(), event.data);
    return sender && wanted_->contains({sender->client_id, sender->request_id});
  }

  void add_session_event(const record::LogEvent& event) {
    base::Result<record::SessionEvent> read = record::session_event_from(event.data);
    if (!read) return;
    if (const auto* const begin = std::get_if<record::FileBegin>(&*read)) {
      recording_ = begin->recording;
    } else if (const auto* const update = std::get_if<record::SceneUpdate>(&*read)) {
      const bool is_removal = update->update.kind == scene::LogUpdate::Kind::kRemoval;
      const std::string& name = update->update.scene;
      // The first state of a scene is no change. Each file of a recording has the scenes again.
      const bool is_first = known_.emplace(recording_, name).second;
      const Revision revision{recording_, name, update->update.entry.revision, is_removal};
      if (is_first) {
        first_.insert(revision);
      } else if (!first_.contains(revision)) {
        told_.insert(revision);
      }
    }
  }

  void add_change(record::LogEvent event) {
    auto request = wire::decode<scene_request_t>(event.data);
    if (!request.message || !changes_scene(*request.message)) return;
    const Key key(request.message->client_id, request.message->request_id);
    const auto [change, is_new] = changes_.try_emplace(key);
    // A repetition would get the answer of the first one.
    if (!is_new) return;
    change->second.request = *std::move(request.message);
    change->second.event = session_.events.size();
    session_.events.push_back(std::move(event));
  }

  void take_answer(const scene_response_t& answer) {
    const auto change = changes_.find({answer.client_id, answer.request_id});
    if (change == changes_.end() || change->second.made) return;
    change->second.is_refused = answer.status != scene_response_t::STATUS_OK;
    if (change->second.is_refused) return;
    change->second.made = {recording_, service::target_of(change->second.request),
                           static_cast<std::uint64_t>(answer.scene.revision)};
  }

  void add_page(record::LogEvent event) {
    const auto page = wire::decode<upload_page_t>(event.data);
    if (!page.message || page.message->num_bytes == 0) return;
    const UploadKey key(page.message->client_id, page.message->total_bytes, page.message->checksum);
    const auto [at, is_new] =
        session_.uploads[key].try_emplace(page.message->page, session_.events.size());
    if (is_new) session_.events.push_back(std::move(event));
  }

  /// Whether a change is sent. A restored revision has another number in another daemon.
  [[nodiscard]] bool can_be_sent(const Change& change) const {
    const scene_request_t& request = change.request;
    if (wanted_ || change.is_refused || request.operation == scene_request_t::RESTORE) return false;
    if (request.upload_bytes <= 0) return true;
    const auto pages =
        session_.uploads.find({request.client_id, request.upload_bytes, request.upload_checksum});
    const auto page_bytes = static_cast<std::int64_t>(wire::kUploadPageBytes);
    const std::int64_t needed = (request.upload_bytes - 1) / page_bytes + 1;
    return pages != session_.uploads.end() &&
           static_cast<std::int64_t>(pages->second.size()) == needed;
  }

  /// Removes events, and brings the indices of the pages up to date.
  void drop(const std::set<std::size_t>& left_out) {
    std::vector<record::LogEvent> kept;
    std::vector<std::size_t> new_index;
    for (std::size_t i = 0; i < session_.events.size(); ++i) {
      new_index.push_back(kept.size());
      if (!left_out.contains(i)) kept.push_back(std::move(session_.events[i]));
    }
    session_.events = std::move(kept);
    for (auto& [key, pages] : session_.uploads) {
      for (auto& [page, index] : pages) index = new_index[index];
    }
  }

  const wire::Channels channels_;
  const std::string session_channel_;
  const std::optional<RequestKeys>& wanted_;
  const wire::MessageKeys* keys_;
  std::string recording_;  ///< that the present file belongs to; empty for a plain log
  std::set<std::pair<std::string, std::string>> known_;  ///< recordings and scenes in them
  std::set<Revision> first_;  ///< states of the scenes with which recordings begin
  std::set<Revision> told_;   ///< changes that events of the session tell of
  std::map<Key, Change> changes_;
  PublishedSession session_;
};

}  // namespace

PublishedSession read_published(const std::filesystem::path& log, const std::string& prefix,
                                const std::optional<RequestKeys>& wanted,
                                const wire::MessageKeys* keys) {
  const base::Result<SessionFiles> files = SessionFiles::open(log);
  if (!files) return {.events = {}, .uploads = {}, .damage = files.error};
  PublishedReader reader(prefix, wanted, keys);
  std::string damage;
  for (const std::filesystem::path& file : files->logs()) {
    reader.begin_file();
    record::LogSummary summary = record::read_event_log(
        file, [&](std::string_view channel) { return reader.wants(channel); },
        [&](record::LogEvent&& event) { reader.add(std::move(event)); });
    if (damage.empty()) damage = std::move(summary.damage);
  }
  return reader.take(std::move(damage));
}

}  // namespace camway::tools
