// SPDX-License-Identifier: MIT
#include "tools/camway/replay/pack/session_cut.h"

#include <fstream>
#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include "daemon/record/event_log.h"
#include "daemon/scene/log/change_record.h"
#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/check.h"
#include "tools/camway/replay/scenes/replay_scenes.h"
#include "tools/camway/replay/signed_event.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;
using record::LogEvent;

constexpr char kNotSelected[] = "not selected for the pack";

/// The newest state of a scene in a log, and the revision that the last change made.
class SceneState {
 public:
  /// Makes a change. Returns the scene after it, without its history; nothing if the change cannot
  /// be read, or if one before it is missing.
  std::optional<scene::RecordedScene> make(const scene::LogUpdate& update) {
    if (update.kind == scene::LogUpdate::Kind::kRemoval) {
      newest_.reset();
      return std::nullopt;
    }
    base::Result<scene::ChangeRecord> record = scene::change_record_from(update.entry.record);
    if (!record) return std::nullopt;
    std::optional<scene::RecordedScene> made;
    if (auto* const whole = std::get_if<scene::RecordedScene>(&*record)) {
      made = std::move(*whole);
    } else if (newest_ && newest_->newest_revision() == update.entry.before) {
      made = newest_;
      made->revisions.push_back(std::get<scene::RecordedRevision>(*std::move(record)));
    } else {
      return std::nullopt;
    }
    made->forget_before(made->newest_revision());
    if (made->newest_revision() != update.entry.revision) return std::nullopt;
    // A change of another process may be recorded after a later one.
    if (!newest_ || newest_->newest_revision() <= made->newest_revision()) newest_ = made;
    return made;
  }

 private:
  std::optional<scene::RecordedScene> newest_;
};

/// Decides for each event of one log what is kept of it.
class EventFilter {
 public:
  using Keep = std::function<void(const LogEvent&)>;

  EventFilter(const std::string& prefix, const wire::MessageKeys* keys, const CutPlan& plan)
      : plan_(plan),
        keys_(keys),
        request_channel_(wire::Channels{prefix}.plan_request()),
        response_channels_(wire::Channels{prefix}.plan_response("")),
        session_channel_(record::session_channel(prefix)) {}

  [[nodiscard]] bool is_of_session(const LogEvent& event) const {
    return event.channel == session_channel_;
  }

  /// Calls `keep` with the event, or with another one in its place, or not at all.
  void filter(const LogEvent& event, const Keep& keep) {
    if (is_of_session(event)) {
      filter_session_event(event, keep);
    } else if (event.channel == request_channel_) {
      if (is_wanted<plan_request_t>(event)) keep(event);
    } else if (event.channel.starts_with(response_channels_)) {
      if (is_wanted<plan_response_t>(event)) keep(event);
    }
  }

 private:
  template <class Message>
  [[nodiscard]] bool is_wanted(LogEvent event) const {
    if (open_event(keys_, event)) return false;
    const wire::Decoded<Message> page = wire::decode<Message>(event.data);
    return page.message &&
           plan_.requests.contains({page.message->client_id, page.message->request_id});
  }

  void filter_session_event(const LogEvent& event, const Keep& keep) {
    const base::Result<record::SessionEvent> read = record::session_event_from(event.data);
    if (!read) return;
    if (const auto* const change = std::get_if<record::SceneUpdate>(&*read)) {
      return filter_change(event, *change, keep);
    }
    if (const auto* const begin = std::get_if<record::FileBegin>(&*read)) {
      recording_ = begin->recording;
    }
    keep(event);
  }

  void filter_change(const LogEvent& event, const record::SceneUpdate& change, const Keep& keep) {
    const std::string& name = change.update.scene;
    const std::optional<scene::RecordedScene> scene = scenes_[name].make(change.update);
    const auto needed = plan_.revisions.find({recording_, name});
    const std::uint64_t revision = change.update.entry.revision;
    if (!scene || needed == plan_.revisions.end() || !needed->second.contains(revision)) return;
    if (!kept_.emplace(name, revision).second) return;
    record::SceneUpdate whole{{scene::LogUpdate::Kind::kEntry,
                               name,
                               {revision, revision, change_record_of(*scene), scene->needs()},
                               0},
                              change.digest};
    keep({event.number, event.utime, event.channel, record::bytes_of(std::move(whole))});
  }

  const CutPlan& plan_;
  const wire::MessageKeys* keys_;
  std::string request_channel_;
  std::string response_channels_;
  std::string session_channel_;
  std::string recording_;  ///< that the log belongs to; empty for a plain log
  std::map<std::string, SceneState> scenes_;
  std::set<std::pair<std::string, std::uint64_t>> kept_;  ///< revisions of scenes
};

bool wants_all(std::string_view /*channel*/) { return true; }

/// Returns the omission for all that a log loses.
record::Omission omission_of(const fs::path& log, EventFilter filter) {
  record::Omission omission;
  omission.reason = kNotSelected;
  bool is_first = true;
  std::uint64_t changes = 0;
  std::uint64_t messages = 0;
  record::read_event_log(log, wants_all, [&](LogEvent&& event) {
    if (is_first) omission.from_utime = event.utime;
    is_first = false;
    omission.to_utime = event.utime;
    ++(filter.is_of_session(event) ? changes : messages);
    filter.filter(
        event, [&](const LogEvent& kept) { --(filter.is_of_session(kept) ? changes : messages); });
  });
  omission.messages = messages;
  omission.changes = changes;
  return omission;
}

}  // namespace

CutPlan plan_cut(const Session& session) {
  CutPlan plan;
  for (const RecordedRequest& request : session.requests) {
    plan.requests.emplace(request.ids.client_id, request.ids.request_id);
    if (!request.answer || !request.answer->result || scene_was_unknown(request)) continue;
    plan.revisions[{request.answer->recording, request.scene}].insert(
        request.answer->scene_revision);
  }
  return plan;
}

std::string cut_log(const fs::path& log, const std::string& prefix, const wire::MessageKeys* keys,
                    const CutPlan& plan, const fs::path& file) {
  const record::Omission omission = omission_of(log, EventFilter(prefix, keys, plan));
  std::ofstream out(file, std::ios::binary);
  std::vector<std::uint8_t> bytes;
  const EventFilter::Keep write = [&](const LogEvent& event) {
    bytes.clear();
    record::append_event(event.number, event.utime, event.channel, event.data, bytes);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
  };
  const LogEvent left_out{0, omission.from_utime, record::session_channel(prefix),
                          record::bytes_of(omission)};
  EventFilter filter(prefix, keys, plan);
  bool has_begun = false;
  record::read_event_log(log, wants_all, [&](LogEvent&& event) {
    // The beginning of a file of a recording is its first event.
    if (!has_begun && !filter.is_of_session(event)) write(left_out);
    filter.filter(event, write);
    if (!has_begun && filter.is_of_session(event)) write(left_out);
    has_begun = true;
  });
  out.close();
  return out ? "" : file.string() + ": cannot be written";
}

}  // namespace camway::tools
