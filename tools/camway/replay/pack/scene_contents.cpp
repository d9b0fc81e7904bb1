// SPDX-License-Identifier: MIT
#include "tools/camway/replay/pack/scene_contents.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>
#include <variant>

#include "daemon/record/blob_folder.h"
#include "daemon/record/session_events.h"
#include "daemon/scene/log/change_record.h"
#include "daemon/scene/log/source_record.h"
#include "lcmtypes/wire/channels.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;
using scene::BlobId;

/// A content that was read.
struct ReadContent {
  std::string fault;           ///< why it cannot be packed; empty if it can
  std::optional<BlobId> base;  ///< the content that it is a difference from
};

/// The objects that name contents in a record of a change.
std::map<std::string, BlobId> objects_in(const scene::Bytes& bytes) {
  std::map<std::string, BlobId> objects;
  const base::Result<scene::ChangeRecord> record = scene::change_record_from(bytes);
  if (!record) return objects;
  const auto add_changes = [&](const scene::RecordedRevision& revision) {
    for (const scene::RecordedChange& change : revision.changes) {
      if (change.source) objects[change.object] = *change.source;
    }
  };
  if (const auto* const whole = std::get_if<scene::RecordedScene>(&*record)) {
    for (const scene::RecordedObject& object : whole->objects) {
      objects[object.name] = object.source;
    }
    std::ranges::for_each(whole->revisions, add_changes);
  } else {
    add_changes(std::get<scene::RecordedRevision>(*record));
  }
  return objects;
}

/// The part of a scene that needs a content at fault: scene and object.
using NeedingObject = std::pair<std::string, std::string>;
/// First and last revision at which the log names it.
using Revisions = std::pair<std::uint64_t, std::uint64_t>;

class ContentReader {
 public:
  explicit ContentReader(const std::vector<fs::path>& folders) : folders_(folders) {}

  void add(const scene::LogUpdate& update) {
    for (const BlobId& id : update.entry.needs) {
      for (std::optional<BlobId> each = id; each;) each = add(*each);
    }
    if (needing_.empty()) return;
    for (const auto& [object, id] : objects_in(update.entry.record)) {
      for (std::optional<BlobId> each = id; each; each = read_.at(*each).base) {
        if (!read_.contains(*each)) break;
        if (!read_.at(*each).fault.empty()) note(*each, update, object);
      }
    }
  }

  SceneContents take() {
    for (const auto& [id, objects] : needing_) {
      std::string fault = "content " + record::hex_of(id);
      for (const auto& [object, revisions] : objects) {
        fault += fmt::format(
            " of object '{}' of scene '{}' in revision {}{},", wire::printable(object.second),
            wire::printable(object.first), revisions.first,
            revisions.first == revisions.second ? "" : fmt::format(" to {}", revisions.second));
      }
      contents_.faults.push_back(fault + " which " + read_.at(id).fault);
    }
    return std::move(contents_);
  }

 private:
  /// Reads a content, once. Returns the one that it is a difference from.
  std::optional<BlobId> add(const BlobId& id) {
    const auto [read, is_new] = read_.try_emplace(id);
    if (!is_new) return std::nullopt;
    ReadContent& content = read->second;
    content.fault = "is missing";
    for (const fs::path& folder : folders_) {
      const record::BlobFolder blobs(folder);
      std::error_code error;
      const base::Result<scene::Bytes> bytes = blobs.get(id);
      if (!bytes) {
        if (fs::exists(blobs.file_of(id), error)) content.fault = "is damaged";
        continue;
      }
      const auto base = scene::base_of_record(*bytes);
      content.fault = base ? "" : "cannot be read: " + base.error;
      if (base) content.base = *base;
      contents_.files["blobs/" + record::hex_of(id)] = blobs.file_of(id);
      break;
    }
    if (content.fault.empty()) return content.base;
    contents_.files.erase("blobs/" + record::hex_of(id));
    needing_[id];
    return std::nullopt;
  }

  void note(const BlobId& id, const scene::LogUpdate& update, const std::string& object) {
    const std::uint64_t revision = update.entry.revision;
    Revisions& revisions =
        needing_[id].try_emplace({update.scene, object}, revision, revision).first->second;
    revisions.first = std::min(revisions.first, revision);
    revisions.second = std::max(revisions.second, revision);
  }

  const std::vector<fs::path>& folders_;
  std::map<BlobId, ReadContent> read_;
  /// The contents at fault, with the objects that need them.
  std::map<BlobId, std::map<NeedingObject, Revisions>> needing_;
  SceneContents contents_;
};

}  // namespace

SceneContents scene_contents_of(const Session& session, const std::vector<fs::path>& folders) {
  ContentReader reader(folders);
  for (const RecordedUpdate& update : session.updates) reader.add(update.change.update);
  return reader.take();
}

}  // namespace camway::tools
