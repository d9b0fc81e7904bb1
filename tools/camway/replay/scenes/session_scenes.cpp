// SPDX-License-Identifier: MIT
#include "tools/camway/replay/scenes/session_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "daemon/record/blob_reader.h"
#include "daemon/record/log_files.h"
#include "daemon/scene/log/durable_scenes.h"
#include "daemon/scene/snapshot/scene_store.h"
#include "lcmtypes/wire/channels.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

/// Rebuilt revisions that are kept. Requests of several clients, or on several threads, come a
/// little out of the order of revisions; one that is further behind costs a rebuilding of all.
constexpr std::size_t kKeptRevisions = 64;

/// A replay must hold all scenes of the daemon, whose limits it does not know.
scene::SceneStoreLimits no_limits() {
  scene::SceneStoreLimits limits;
  limits.scenes = limits.objects = std::numeric_limits<std::size_t>::max();
  limits.triangles = limits.occupancy_bytes = std::numeric_limits<std::uint64_t>::max();
  limits.history = {0, 0};
  return limits;
}

std::string name_of(const RecordedRequest& request, std::uint64_t revision) {
  return fmt::format("scene revision {} of '{}'", revision, wire::printable(request.scene));
}

}  // namespace

std::vector<fs::path> blob_folders_of(const std::vector<fs::path>& logs) {
  std::set<fs::path> folders;
  for (const fs::path& log : logs) folders.insert(log.parent_path() / record::kBlobFolder);
  return {folders.begin(), folders.end()};
}

/// The revisions of one scene in one recording. Walks forward, and begins anew to go back.
/// Not thread-safe.
class SessionScenes::Timeline {
 public:
  explicit Timeline(const std::vector<fs::path>& blob_folders) : blobs_(blob_folders) { rewind(); }

  void add(const record::SceneUpdate& change) { changes_.push_back(&change); }
  /// Sorts the changes by revision: one that another process of a fleet has made may be recorded
  /// after a later one of the daemon itself. To be called after all were added.
  void sort() {
    std::ranges::stable_sort(changes_, {}, [](const record::SceneUpdate* change) {
      return change->update.entry.revision;
    });
  }
  /// Notes that a request needs this revision.
  void need(std::uint64_t revision) { needed_.insert(revision); }

  /// Returns the snapshot of a revision; null if it cannot be rebuilt, with the reason in `fault`.
  std::shared_ptr<const scene::Snapshot> at(std::uint64_t revision, std::string& fault) {
    if (auto kept = find(revision)) return kept;
    if (revision < walked_to_) rewind();
    while (next_ < changes_.size() && changes_[next_]->update.entry.revision <= revision) step();
    auto found = find(revision);
    if (!found) fault = fault_;
    return found;
  }

 private:
  [[nodiscard]] std::shared_ptr<const scene::Snapshot> find(std::uint64_t revision) const {
    const auto kept = std::ranges::find(kept_, revision, &scene::Snapshot::revision);
    return kept == kept_.end() ? nullptr : *kept;
  }

  void rewind() {
    store_.reset();
    scenes_.emplace(blobs_);
    scenes_->leave_out_mirrors();  // planning does not use them
    store_.emplace(no_limits());
    next_ = 0;
    walked_to_ = 0;
    kept_.clear();
    fault_.clear();
  }

  /// Makes the next change.
  void step() {
    const record::SceneUpdate& change = *changes_[next_++];
    const std::string& name = change.update.scene;
    const scene::StoreResult result = store_->follow(name, [&](const scene::Snapshot* newest) {
      return scenes_->read(change.update, newest, no_limits().history);
    });
    walked_to_ = std::max(walked_to_, change.update.entry.revision);
    if (!result.error.empty()) {
      // The changes after it fail for want of this one.
      if (fault_.empty()) fault_ = result.error;
      return;
    }
    fault_.clear();
    const std::shared_ptr<const scene::Snapshot> made = store_->find(name);
    if (!made || made->revision != change.update.entry.revision || find(made->revision)) return;
    if (made->digest != change.digest) {
      fault_ = fmt::format("revision {} was rebuilt with other triangles", made->revision);
      return;
    }
    if (!needed_.contains(made->revision)) return;
    kept_.push_back(made);
    if (kept_.size() > kKeptRevisions) kept_.pop_front();
  }

  record::BlobReader blobs_;
  std::vector<const record::SceneUpdate*> changes_;
  std::set<std::uint64_t> needed_;
  std::optional<scene::DurableScenes> scenes_;
  std::optional<scene::SceneStore> store_;
  std::size_t next_ = 0;         ///< of `changes_`
  std::uint64_t walked_to_ = 0;  ///< revision of the last change that was made
  std::deque<std::shared_ptr<const scene::Snapshot>> kept_;
  std::string fault_;  ///< of the first change since a good one that could not be made
};

SessionScenes::SessionScenes(const Session& session, std::vector<fs::path> blob_folders)
    : blob_folders_(std::move(blob_folders)) {
  for (const RecordedUpdate& update : session.updates) {
    if (update.recording.empty()) continue;
    const std::string& name = update.change.update.scene;
    names_.insert(name);
    std::unique_ptr<Timeline>& timeline = timelines_[{update.recording, name}];
    if (!timeline) timeline = std::make_unique<Timeline>(blob_folders_);
    timeline->add(update.change);
  }
  for (const auto& [key, timeline] : timelines_) timeline->sort();
  for (const RecordedRequest& request : session.requests) {
    if (!request.answer) continue;
    const auto timeline = timelines_.find({request.answer->recording, request.scene});
    if (timeline != timelines_.end()) timeline->second->need(request.answer->scene_revision);
  }
}

SessionScenes::~SessionScenes() = default;

FoundScene SessionScenes::snapshot_of(const RecordedRequest& request) {
  if (scene_was_unknown(request)) return {};
  if (!request.answer) return {nullptr, "no answer in the log"};
  if (!request.answer->result) return {nullptr, "recorded: " + request.answer->status};
  const std::uint64_t revision = request.answer->scene_revision;
  const std::string name = name_of(request, revision);
  const std::lock_guard lock(mutex_);
  const auto timeline = timelines_.find({request.answer->recording, request.scene});
  if (timeline == timelines_.end()) return {nullptr, name + " is not in the log"};
  std::string fault;
  std::shared_ptr<const scene::Snapshot> snapshot = timeline->second->at(revision, fault);
  if (!snapshot && fault.empty()) return {nullptr, name + " is not in the log"};
  if (!snapshot) return {nullptr, name + " cannot be rebuilt: " + fault, true};
  if (snapshot->digest != request.answer->scene_digest) {
    return {nullptr, name + " has other triangles in the log than in the answer"};
  }
  return {std::move(snapshot), {}};
}

DigestScenes::DigestScenes(const Session& session, std::vector<fs::path> blob_folders)
    : blob_folders_(std::move(blob_folders)) {
  for (const RecordedUpdate& update : session.updates) {
    if (!update.recording.empty()) continue;
    names_.insert(update.change.update.scene);
    updates_.emplace(update.change.digest, &update.change);
  }
}

FoundScene DigestScenes::snapshot_of(const RecordedRequest& request) {
  if (scene_was_unknown(request)) return {};
  if (!request.answer) return {nullptr, "no answer in the log"};
  const std::string& digest = request.answer->scene_digest;
  const std::lock_guard lock(mutex_);
  const auto known = found_.find(digest);
  if (known != found_.end()) return known->second;
  const auto update = updates_.find(digest);
  const std::string name = name_of(request, request.answer->scene_revision);
  if (update == updates_.end()) return {nullptr, name + " is not in the log"};
  record::BlobReader blobs(blob_folders_);
  scene::DurableScenes scenes(blobs);
  scenes.leave_out_mirrors();
  scene::SceneStore store(no_limits());
  const scene::LogUpdate& change = update->second->update;
  const scene::StoreResult result = store.follow(change.scene, [&](const scene::Snapshot* newest) {
    return scenes.read(change, newest, no_limits().history);
  });
  FoundScene found{store.find(change.scene), {}};
  if (!found.snapshot || found.snapshot->digest != digest) {
    found = {nullptr,
             name + " cannot be rebuilt: " +
                 (result.error.empty() ? "it has other triangles" : result.error),
             true};
  }
  return found_.emplace(digest, std::move(found)).first->second;
}

}  // namespace camway::tools
