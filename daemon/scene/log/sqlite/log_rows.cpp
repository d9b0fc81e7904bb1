// SPDX-License-Identifier: MIT
#include "daemon/scene/log/sqlite/log_rows.h"

#include <map>
#include <optional>
#include <utility>

#include "daemon/scene/log/sqlite/commit_count.h"
#include "daemon/scene/log/sqlite/row_digest.h"
#include "daemon/scene/log/sqlite/sqlite_schema.h"

namespace camway::scene {
namespace {

using Scenes = std::map<std::string, LoggedScene>;

std::string scene_words(const std::string& scene) { return "scene '" + scene + "'"; }

std::string lost_revisions(const std::string& scene, std::uint64_t after, std::uint64_t until) {
  return scene_words(scene) + " lost its changes after revision " + std::to_string(after) +
         " until revision " + std::to_string(until);
}

std::string words_of_failure(const SqliteDatabase& database) {
  return database.failure() ? database.failure()->text : "a row has another type than it had";
}

/// Returns the rest of the ids that a query returns. Nothing on failure.
std::optional<std::vector<BlobId>> read_ids(SqliteQuery& query) {
  std::vector<BlobId> ids;
  while (query.next()) {
    const auto id = query.array<BlobId>(0);
    if (!id) return std::nullopt;
    ids.push_back(*id);
  }
  return query.has_failed() ? std::nullopt : std::optional(std::move(ids));
}

bool has_digest(const SqliteQuery& query, int column, const base::Digest::Bytes& digest) {
  return query.array<base::Digest::Bytes>(column) == digest;
}

/// Reads the heads, and returns them. A scene without a head must have no other rows.
std::map<std::string, std::uint64_t> read_heads(SqliteDatabase& database) {
  std::map<std::string, std::uint64_t> heads;
  SqliteQuery query = database.query("SELECT scene, revision FROM heads ORDER BY scene");
  while (query.next()) heads.emplace(query.text(0), query.number(1));
  return heads;
}

/// Adds the summaries to their scenes. Returns what is damaged; empty otherwise.
std::string read_summaries(SqliteDatabase& database, Scenes& scenes) {
  SqliteQuery rows =
      database.query("SELECT scene, revision, digest, record FROM summaries ORDER BY scene");
  while (rows.next()) {
    LoggedScene scene{rows.text(0), rows.number(1), rows.bytes(3), {}};
    SqliteQuery ids = database.query("SELECT blob FROM summary_needs WHERE scene=? ORDER BY place");
    const auto needs = read_ids(ids.with(std::string_view(scene.name)));
    if (!needs) return words_of_failure(database);
    if (!has_digest(rows, 2,
                    summary_digest(scene.name, scene.summary_revision, scene.summary, *needs))) {
      return scene_words(scene.name) + " has a damaged summary of revision " +
             std::to_string(scene.summary_revision);
    }
    const std::string name = scene.name;
    scenes.insert_or_assign(name, std::move(scene));
  }
  return rows.has_failed() ? words_of_failure(database) : "";
}

/// Adds the entries to their scenes. Returns what is damaged; empty otherwise.
std::string read_entries(SqliteDatabase& database, Scenes& scenes) {
  SqliteQuery rows = database.query(
      "SELECT scene, before, revision, digest, record FROM entries ORDER BY scene, revision");
  while (rows.next()) {
    const std::string name = rows.text(0);
    LogEntry entry{rows.number(1), rows.number(2), rows.bytes(4), {}};
    SqliteQuery ids =
        database.query("SELECT blob FROM entry_needs WHERE scene=? AND revision=? ORDER BY place");
    auto needs = read_ids(ids.with(std::string_view(name)).with(entry.revision));
    if (!needs) return words_of_failure(database);
    entry.needs = *std::move(needs);
    if (!has_digest(rows, 3, entry_digest(name, entry))) {
      return scene_words(name) + " has a damaged change to revision " +
             std::to_string(entry.revision);
    }
    LoggedScene& scene = scenes[name];
    scene.name = name;
    scene.entries.push_back(std::move(entry));
  }
  return rows.has_failed() ? words_of_failure(database) : "";
}

/// Returns where the changes of a scene do not follow each other up to its head.
std::string fault_of_chain(const LoggedScene& scene, std::uint64_t head) {
  std::uint64_t revision = scene.summary_revision;
  for (const LogEntry& entry : scene.entries) {
    if (entry.before != revision) return lost_revisions(scene.name, revision, entry.before);
    revision = entry.revision;
  }
  return revision == head ? "" : lost_revisions(scene.name, revision, head);
}

std::string fault_of_chains(const Scenes& scenes,
                            const std::map<std::string, std::uint64_t>& heads) {
  for (const auto& [name, head] : heads) {
    const auto scene = scenes.find(name);
    if (scene == scenes.end()) return lost_revisions(name, 0, head);
    std::string fault = fault_of_chain(scene->second, head);
    if (!fault.empty()) return fault;
  }
  for (const auto& [name, scene] : scenes) {
    if (!heads.contains(name)) return scene_words(name) + " lost the number of its newest revision";
  }
  return "";
}

/// Returns the first scene that needs a blob that is not there; empty if all are.
std::string fault_of_needs(SqliteDatabase& database) {
  SqliteQuery entry = database.query(
      "SELECT scene, revision FROM entry_needs WHERE blob NOT IN (SELECT id FROM blobs) LIMIT 1");
  if (entry.next()) {
    return scene_words(entry.text(0)) + " lost a mesh or map of revision " +
           std::to_string(entry.number(1));
  }
  SqliteQuery summary = database.query(
      "SELECT scene, revision FROM summary_needs JOIN summaries USING(scene) "
      "WHERE blob NOT IN (SELECT id FROM blobs) LIMIT 1");
  if (summary.next()) {
    return scene_words(summary.text(0)) + " lost a mesh or map of its summary of revision " +
           std::to_string(summary.number(1));
  }
  SqliteQuery blob =
      database.query("SELECT 1 FROM blob_needs WHERE blob NOT IN (SELECT id FROM blobs) LIMIT 1");
  if (blob.next()) return "a mesh or map lost another one that is needed to read it";
  return database.failure() ? database.failure()->text : "";
}

/// Returns which scene needs a blob, directly or through another one: ", which scene 'a' needs".
/// Empty if none does.
std::string words_of_user(SqliteDatabase& database, const BlobId& id) {
  SqliteQuery user = database.query(
      "WITH RECURSIVE users(id) AS (VALUES(?) UNION "
      "  SELECT blob_needs.owner FROM users JOIN blob_needs ON blob_needs.blob=users.id) "
      "SELECT scene FROM entry_needs JOIN users ON blob=users.id UNION "
      "SELECT scene FROM summary_needs JOIN users ON blob=users.id ORDER BY scene LIMIT 1");
  return user.with(id).next() ? ", which " + scene_words(user.text(0)) + " needs" : "";
}

std::string fault_of_rows(SqliteDatabase& database, Scenes& scenes) {
  const auto heads = read_heads(database);
  if (database.failure()) return database.failure()->text;
  std::string fault = read_summaries(database, scenes);
  if (fault.empty()) fault = read_entries(database, scenes);
  if (fault.empty()) fault = fault_of_chains(scenes, heads);
  if (fault.empty()) fault = fault_of_needs(database);
  return fault;
}

}  // namespace

base::Result<std::vector<LoggedScene>> read_logged_scenes(SqliteDatabase& database) {
  Scenes scenes;
  std::string fault = fault_of_rows(database, scenes);
  if (!fault.empty()) return base::Failure{std::move(fault)};
  std::vector<LoggedScene> list;
  list.reserve(scenes.size());
  for (auto& [name, scene] : scenes) list.push_back(std::move(scene));
  return list;
}

base::Result<Blob> read_blob(SqliteDatabase& database, const BlobId& id) {
  SqliteQuery row = database.query("SELECT number, size, digest FROM blobs WHERE id=?");
  if (!row.with(id).next()) {
    return base::Failure{row.has_failed() ? words_of_failure(database)
                                          : "a mesh or map is not there"};
  }
  SqliteQuery ids = database.query("SELECT blob FROM blob_needs WHERE owner=? ORDER BY place");
  auto needs = read_ids(ids.with(id));
  auto bytes = database.read_bytes("blobs", "bytes", row.number(0));
  if (!needs || !bytes) return base::Failure{words_of_failure(database)};
  Blob blob{*std::move(bytes), *std::move(needs)};
  if (row.number(1) != blob.bytes.size() || !has_digest(row, 2, blob_digest(id, blob))) {
    return base::Failure{"a mesh or map of " + std::to_string(row.number(1)) + " bytes is damaged"};
  }
  return blob;
}

std::string fault_of_blobs(SqliteDatabase& database) {
  SqliteQuery rows = database.query("SELECT id FROM blobs ORDER BY number");
  while (rows.next()) {
    const auto id = rows.array<BlobId>(0);
    if (!id) return "the name of a mesh or map is damaged";
    const base::Result<Blob> blob = read_blob(database, *id);
    if (!blob) return blob.error + words_of_user(database, *id);
    // The digest of the row is faster. It would not notice a name that was wrong from the start.
    if (blob_id_of(blob->bytes) != *id) {
      return "a mesh or map has other bytes than its name says" + words_of_user(database, *id);
    }
  }
  return rows.has_failed() ? words_of_failure(database) : "";
}

std::string fault_of_notes(SqliteDatabase& database) {
  SqliteQuery notes = database.query("SELECT key, text, digest FROM notes");
  while (notes.next()) {
    const std::string key = notes.text(0);
    if (!has_digest(notes, 2, note_digest(key, notes.text(1)))) {
      return "the note '" + key + "' is damaged";
    }
  }
  for (const auto& [key, what] :
       {std::pair{"highest_removed", "the highest revision of removed scenes"},
        std::pair{"commits", "the number of changes"}}) {
    SqliteQuery meta = database.query("SELECT value, digest FROM meta WHERE key=?");
    if (!notes.has_failed() && meta.with(std::string_view(key)).next() &&
        has_digest(meta, 1, meta_digest(key, meta.number(0)))) {
      continue;
    }
    return database.failure() ? database.failure()->text : std::string(what) + " is lost";
  }
  return "";
}

std::string fault_of_structure(SqliteDatabase& database, const std::string& pragma) {
  const std::string found = database.first_text("PRAGMA " + pragma + "(1)");
  if (database.failure()) return database.failure()->text;
  return found == "ok" ? "" : found;
}

std::uint64_t read_meta(SqliteDatabase& database, std::string_view key) {
  SqliteQuery row = database.query("SELECT value FROM meta WHERE key=?");
  return row.with(key).next() ? row.number(0) : 0;
}

std::string fault_of_commits(const std::filesystem::path& folder, SqliteDatabase& database) {
  // Read first, since a daemon may raise both meanwhile.
  const std::optional<std::uint64_t> answered = CommitCount::read(folder);
  const std::uint64_t commits = read_meta(database, "commits");
  if (!answered && commits > 0) {
    return std::string("the file ") + CommitCount::kFile +
           " is missing: the folder was not copied as a whole";
  }
  if (answered.value_or(0) <= commits) return "";
  return "the last " + std::to_string(*answered - commits) + " of " + std::to_string(*answered) +
         " changes that were answered are missing: the file " + kLogFile +
         "-wal is lost or damaged";
}

}  // namespace camway::scene
