// SPDX-License-Identifier: MIT
#include "daemon/scene/log/change_record.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>
#include <variant>

#include <nlohmann/json.hpp>

namespace camway::scene {
namespace {

using geometry::Vec3;
using nlohmann::json;

/// Thrown and caught here only, beside the exceptions of the JSON library.
struct NoRecord {};

// The clock of the notes counts nanoseconds on every platform, so that files do not differ.
using Nanoseconds = std::chrono::nanoseconds;

json json_of(const BlobId& id) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(id.data());
  return json::binary({bytes, bytes + id.size()});
}

BlobId blob_id_from(const json& value) {
  const json::binary_t& bytes = value.get_binary();
  BlobId id;
  if (bytes.size() != id.size()) throw NoRecord{};
  std::ranges::transform(bytes, id.begin(), [](std::uint8_t byte) { return std::byte{byte}; });
  return id;
}

json json_of(const Vec3& point) { return {point.x(), point.y(), point.z()}; }

Vec3 point_from(const json& value) {
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

json json_of(const Placement& placement) {
  if (placement.is_identity()) return nullptr;
  const geometry::Quat& q = placement.orientation_WO();
  const Vec3& p = placement.position_W();
  return {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
}

Placement placement_from(const json& value) {
  if (value.is_null()) return {};
  const geometry::Quat orientation(value.at(3).get<double>(), value.at(4).get<double>(),
                                   value.at(5).get<double>(), value.at(6).get<double>());
  std::string fault;
  Placement::make(point_from(value), orientation, fault);
  if (!fault.empty()) throw NoRecord{};
  return Placement::of_unit(point_from(value), orientation);
}

json json_of(const KeptRevision& kept) {
  const ChangeNote& note = kept.note;
  const auto when = std::chrono::duration_cast<Nanoseconds>(note.when.time_since_epoch());
  return {{"revision", kept.revision},
          {"operation", note.operation},
          {"object", note.object},
          {"client", note.client},
          {"request", note.request},
          {"when_ns", when.count()},
          {"restored_revision", note.restored_revision}};
}

KeptRevision kept_revision_from(const json& value) {
  KeptRevision kept;
  kept.revision = value.at("revision").get<std::uint64_t>();
  kept.note.operation = value.at("operation").get<std::string>();
  kept.note.object = value.at("object").get<std::string>();
  kept.note.client = value.at("client").get<std::string>();
  kept.note.request = value.at("request").get<std::string>();
  kept.note.restored_revision = value.at("restored_revision").get<std::uint64_t>();
  const Nanoseconds when(value.at("when_ns").get<std::int64_t>());
  kept.note.when += std::chrono::duration_cast<std::chrono::system_clock::duration>(when);
  return kept;
}

json json_of(const ObjectOptions& options) {
  json value{{"index_threshold", options.index.threshold},
             {"index_depth", options.index.max_depth},
             {"index_duplication", options.index.max_duplication},
             {"mirror_voxels", options.mirror_voxels},
             {"min_m", json_of(options.bounds.min_W)},
             {"max_m", json_of(options.bounds.max_W)}};
  if (options.field) value["field_bytes"] = options.field->memory_limit_bytes;
  if (options.occupancy_resolution_m) value["voxel_m"] = *options.occupancy_resolution_m;
  return value;
}

/// Largest distance field to accept, of the options of a record.
constexpr std::size_t kMostFieldBytes = std::size_t{1} << 30;

bool are_possible(const ObjectOptions& options) {
  const bool has_voxels =
      !options.occupancy_resolution_m ||
      (std::isfinite(*options.occupancy_resolution_m) && *options.occupancy_resolution_m > 0.0);
  return options.index.threshold >= 1 && options.index.max_depth <= kMaxIndexDepth &&
         options.index.max_duplication >= 0.0 && has_voxels &&
         (!options.field || options.field->memory_limit_bytes <= kMostFieldBytes);
}

ObjectOptions object_options_from(const json& value) {
  ObjectOptions options;
  options.index.threshold = value.at("index_threshold").get<std::uint32_t>();
  options.index.max_depth = value.at("index_depth").get<std::uint32_t>();
  options.index.max_duplication = value.at("index_duplication").get<double>();
  options.mirror_voxels = value.at("mirror_voxels").get<std::uint64_t>();
  options.bounds = {point_from(value.at("min_m")), point_from(value.at("max_m"))};
  options.field.reset();
  if (value.contains("field_bytes")) {
    options.field.emplace();
    options.field->memory_limit_bytes = value.at("field_bytes").get<std::size_t>();
  }
  if (value.contains("voxel_m")) options.occupancy_resolution_m = value.at("voxel_m").get<double>();
  if (!are_possible(options)) throw NoRecord{};
  return options;
}

json json_of(const RecordedRevision& revision) {
  json changes = json::array();
  for (const RecordedChange& change : revision.changes) {
    changes.push_back({static_cast<int>(change.kind), change.object,
                       change.source ? json_of(*change.source) : json(),
                       json_of(change.placement)});
  }
  return {{"made", json_of(revision.made)}, {"changes", std::move(changes)}};
}

RecordedChange recorded_change_from(const json& value) {
  const auto kind = value.at(0).get<std::uint8_t>();
  if (kind > static_cast<std::uint8_t>(SceneChange::Kind::kRemove)) throw NoRecord{};
  RecordedChange change{static_cast<SceneChange::Kind>(kind), value.at(1).get<std::string>(),
                        std::nullopt, placement_from(value.at(3))};
  if (!value.at(2).is_null()) change.source = blob_id_from(value.at(2));
  if (change.source.has_value() != (change.kind == SceneChange::Kind::kPut)) throw NoRecord{};
  return change;
}

RecordedRevision recorded_revision_from(const json& value) {
  RecordedRevision revision{kept_revision_from(value.at("made")), {}};
  for (const json& change : value.at("changes")) {
    revision.changes.push_back(recorded_change_from(change));
  }
  return revision;
}

RecordedScene recorded_scene_from(const json& value) {
  RecordedScene scene{
      object_options_from(value.at("options")), kept_revision_from(value.at("oldest")), {}, {}};
  for (const json& object : value.at("objects")) {
    scene.objects.push_back({object.at(0).get<std::string>(), blob_id_from(object.at(1)),
                             placement_from(object.at(2))});
  }
  const auto is_not_before = [](const RecordedObject& a, const RecordedObject& b) {
    return a.name >= b.name;
  };
  if (std::ranges::adjacent_find(scene.objects, is_not_before) != scene.objects.end()) {
    throw NoRecord{};
  }
  for (const json& revision : value.at("revisions")) {
    scene.revisions.push_back(recorded_revision_from(revision));
  }
  return scene;
}

/// Records nest less deep.
constexpr std::size_t kMostLevels = 16;

// An item of CBOR (RFC 8949, section 3) begins with a byte: its kind in the upper bits, and in the
// lower ones a number below 24, or how many bytes the number has that follows.
constexpr unsigned kKindShift = 5;
constexpr unsigned kNumberBits = 31;
constexpr unsigned kOneByteFollows = 24;
constexpr unsigned kEightBytesFollow = 27;

/// Returns whether items of CBOR nest deeper than a record, or are of kinds that it has not. The
/// JSON library calls itself for each level, so bytes of a stranger could use up the stack.
bool nests_too_deep(const Bytes& bytes) {
  std::vector<std::uint64_t> left;  // items that each level still has
  std::size_t at = 0;
  while (at < bytes.size()) {
    const auto first = std::to_integer<unsigned>(bytes[at++]);
    const unsigned kind = first >> kKindShift;
    std::uint64_t value = first & kNumberBits;
    if (value > kEightBytesFollow) return true;
    if (value >= kOneByteFollows) {
      const std::size_t count = std::size_t{1} << (value - kOneByteFollows);
      value = 0;
      for (std::size_t i = 0; i < count && at < bytes.size(); ++i) {
        value = value << 8 | std::to_integer<std::uint64_t>(bytes[at++]);
      }
    }
    if (!left.empty()) --left.back();
    constexpr unsigned kBytes = 2;
    constexpr unsigned kText = 3;
    constexpr unsigned kArray = 4;
    constexpr unsigned kMap = 5;
    constexpr unsigned kTag = 6;
    if (kind == kTag) return true;
    if (kind == kBytes || kind == kText) {
      at += static_cast<std::size_t>(std::min<std::uint64_t>(value, bytes.size() - at));
    } else if (kind == kArray || kind == kMap) {
      if (value > bytes.size() || left.size() == kMostLevels) return true;
      left.push_back(kind == kMap ? 2 * value : value);
    }
    while (!left.empty() && left.back() == 0) left.pop_back();
  }
  return false;
}

Bytes cbor_of(const json& value) {
  const std::vector<std::uint8_t> cbor = json::to_cbor(value);
  Bytes bytes(cbor.size());
  std::ranges::transform(cbor, bytes.begin(), [](std::uint8_t byte) { return std::byte{byte}; });
  return bytes;
}

std::vector<RecordedObject>::iterator place_of_object(const std::string& name,
                                                      std::vector<RecordedObject>& objects) {
  return std::ranges::lower_bound(objects, name, {}, &RecordedObject::name);
}

void apply_change(const RecordedChange& change, std::vector<RecordedObject>& objects) {
  const auto place = place_of_object(change.object, objects);
  const bool is_there = place != objects.end() && place->name == change.object;
  if (is_there && change.kind == SceneChange::Kind::kRemove) {
    objects.erase(place);
  } else if (is_there) {
    if (change.source) place->source = *change.source;
    place->placement = change.placement;
  } else if (change.source) {
    objects.insert(place, {change.object, *change.source, change.placement});
  }
}

}  // namespace

std::vector<BlobId> RecordedScene::needs() const {
  std::set<BlobId> ids;
  for (const RecordedObject& object : objects) ids.insert(object.source);
  for (const RecordedRevision& revision : revisions) {
    for (const RecordedChange& change : revision.changes) {
      if (change.source) ids.insert(*change.source);
    }
  }
  return {ids.begin(), ids.end()};
}

void RecordedScene::forget_before(std::uint64_t revision) {
  auto first = revisions.begin();
  for (; first != revisions.end() && first->made.revision <= revision; ++first) {
    for (const RecordedChange& change : first->changes) apply_change(change, objects);
    oldest = std::move(first->made);
  }
  revisions.erase(revisions.begin(), first);
}

Bytes change_record_of(const RecordedScene& scene) {
  json objects = json::array();
  for (const RecordedObject& object : scene.objects) {
    objects.push_back({object.name, json_of(object.source), json_of(object.placement)});
  }
  json revisions = json::array();
  for (const RecordedRevision& revision : scene.revisions) revisions.push_back(json_of(revision));
  return cbor_of({{"scene",
                   {{"options", json_of(scene.options)},
                    {"oldest", json_of(scene.oldest)},
                    {"objects", std::move(objects)},
                    {"revisions", std::move(revisions)}}}});
}

Bytes change_record_of(const RecordedRevision& revision) {
  return cbor_of({{"revision", json_of(revision)}});
}

base::Result<ChangeRecord> change_record_from(const Bytes& bytes) {
  const auto* const begin = reinterpret_cast<const std::uint8_t*>(bytes.data());
  if (nests_too_deep(bytes)) {
    return base::Failure{"a record of a change is damaged: it nests too deep"};
  }
  try {
    const json value = json::from_cbor(begin, begin + bytes.size());
    if (value.contains("scene")) return ChangeRecord(recorded_scene_from(value.at("scene")));
    return ChangeRecord(recorded_revision_from(value.at("revision")));
  } catch (const json::exception& error) {
    return base::Failure{std::string("a record of a change is damaged: ") + error.what()};
  } catch (const NoRecord&) {
    return base::Failure{"a record of a change is damaged"};
  }
}

base::Failure damaged_scene(const std::string& name, const std::string& reason) {
  return {"scene '" + name + "' is not whole in the log: " + reason};
}

base::Result<RecordedScene> recorded_scene_of(const LoggedScene& logged) {
  std::optional<RecordedScene> scene;
  const auto take = [&](const Bytes& bytes, std::uint64_t revision) -> std::string {
    base::Result<ChangeRecord> record = change_record_from(bytes);
    if (!record) return record.error;
    if (auto* const whole = std::get_if<RecordedScene>(&*record)) {
      scene = std::move(*whole);
    } else if (scene) {
      scene->revisions.push_back(std::get<RecordedRevision>(*std::move(record)));
    } else {
      return "its first entry is missing";
    }
    return scene->newest_revision() == revision ? "" : "a record is of another revision";
  };
  std::string fault;
  if (logged.summary_revision > 0) fault = take(logged.summary, logged.summary_revision);
  for (const LogEntry& entry : logged.entries) {
    if (fault.empty()) fault = take(entry.record, entry.revision);
  }
  if (fault.empty() && !scene) fault = "it has no entry";
  if (!fault.empty()) return damaged_scene(logged.name, fault);
  return *std::move(scene);
}

}  // namespace camway::scene
