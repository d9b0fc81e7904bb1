// SPDX-License-Identifier: MIT
#include <algorithm>
#include <variant>

#include "daemon/nats/jetstream_api.h"
#include "daemon/scene/log/change_record.h"
#include "daemon/scene/log/nats/log_message.h"
#include "daemon/scene/log/nats/scene_chain.h"
#include "daemon/scene/log/source_record.h"
#include "daemon/scene/snapshot/shape_mesh.h"
#include "tests/fuzz/targets.h"

namespace camway::testing {
namespace {

using geometry::Vec3;

scene::Bytes log_bytes_of(std::span<const std::uint8_t> bytes) {
  scene::Bytes result(bytes.size());
  std::ranges::transform(bytes, result.begin(), [](std::uint8_t byte) { return std::byte{byte}; });
  return result;
}

FuzzBytes fuzz_bytes_of(const scene::Bytes& bytes) {
  FuzzBytes result(bytes.size());
  std::ranges::transform(bytes, result.begin(), std::to_integer<std::uint8_t>);
  return result;
}

scene::Bytes encoded(const scene::ChangeRecord& record) {
  return std::visit([](const auto& each) { return change_record_of(each); }, record);
}

bool exercise_change_record(std::span<const std::uint8_t> bytes) {
  base::Result<scene::ChangeRecord> record = scene::change_record_from(log_bytes_of(bytes));
  if (!record) return false;
  const scene::Bytes again = encoded(*record);
  const base::Result<scene::ChangeRecord> reread = scene::change_record_from(again);
  promise(static_cast<bool>(reread), "what was read can be written and read again");
  promise(encoded(*reread) == again, "and stays the same");
  if (auto* const scene = std::get_if<scene::RecordedScene>(&*record)) {
    const std::uint64_t newest = scene->newest_revision();
    scene->forget_before(newest);
    promise(scene->newest_revision() == newest, "forgetting keeps the newest revision");
  }
  return true;
}

std::vector<FuzzBytes> change_record_seeds() {
  scene::RecordedScene scene;
  scene.options.occupancy_resolution_m = 0.1;
  scene.oldest = {3, {.operation = "load", .client = "tester", .request = "tester/1/ab"}};
  std::string fault;
  const scene::Placement aside =
      scene::Placement::make(Vec3(1, 2, 3), geometry::Quat(1, 0.2, 0.3, 0.4), fault);
  scene.objects.push_back({"crate", scene::blob_id_of({}), aside});
  using Kind = scene::SceneChange::Kind;
  const scene::RecordedRevision revision{
      {4, {.operation = "restore", .restored_revision = 2}},
      {{Kind::kPut, "ball", scene::blob_id_of({std::byte{1}}), {}},
       {Kind::kMove, "crate", std::nullopt, aside},
       {Kind::kRemove, "ball", std::nullopt, {}}}};
  scene.revisions.push_back(revision);
  return {fuzz_bytes_of(change_record_of(scene)), fuzz_bytes_of(change_record_of(revision)), {}};
}

scene::Bytes encoded_message(const std::variant<scene::LogMessage, scene::BlobHead>& message) {
  return std::visit([](const auto& each) { return bytes_of(each); }, message);
}

/// A message of a fleet's log or the head of a blob: each has one form, which begins with another
/// byte.
bool exercise_fleet_message(std::span<const std::uint8_t> bytes) {
  const scene::Bytes all = log_bytes_of(bytes);
  const base::Result<scene::LogMessage> message = scene::log_message_from(all);
  const base::Result<scene::BlobHead> head = scene::blob_head_from(all);
  promise(!message || !head, "bytes are one of both at most");
  if (message) promise(encoded_message(*message) == all, "a message has one form");
  if (head) promise(encoded_message(*head) == all, "a head has one form");
  scene::SceneChain chain;
  if (message) {
    chain.take(*message, 1);
    chain.take(*message, 2);
    promise(chain.links().size() <= 1 && chain.last_sequence() == 2, "it is there once");
    promise(chain.is_whole() || !chain.fault().empty(), "damage has a reason");
  }
  return message || head;
}

std::vector<FuzzBytes> fleet_message_seeds() {
  scene::LogMessage entry;
  entry.id = {std::byte{1}};
  entry.revision = 7;
  entry.needs = {scene::blob_id_of({std::byte{1}}), scene::blob_id_of({})};
  entry.record = {std::byte{1}, std::byte{2}};
  scene::LogMessage summary;
  summary.kind = scene::LogMessage::Kind::kSummary;
  summary.id = {std::byte{2}};
  summary.after = entry.id;
  summary.revision = 7;
  summary.removed = 3;
  summary.replaces = {entry.id};
  summary.blob = scene::blob_id_of({});
  scene::LogMessage removal = summary;
  removal.kind = scene::LogMessage::Kind::kRemoval;
  removal.blob.reset();
  const scene::BlobHead small{2, 0, entry.needs, entry.record};
  const scene::BlobHead large{1'000'000, 2, {}, {}};
  return {fuzz_bytes_of(bytes_of(entry)),   fuzz_bytes_of(bytes_of(summary)),
          fuzz_bytes_of(bytes_of(removal)), fuzz_bytes_of(bytes_of(small)),
          fuzz_bytes_of(bytes_of(large)),   {}};
}

bool exercise_stream_answer(std::span<const std::uint8_t> bytes) {
  const auto answer = nats::api_answer_from(as_text(bytes));
  if (!answer) {
    promise(!answer.error.empty(), "a refusal has a reason");
    return false;
  }
  const auto message = nats::stored_message_from(*answer);
  promise(message || !message.error.empty(), "no message without a reason");
  return static_cast<bool>(message);
}

std::vector<FuzzBytes> stream_answer_seeds() {
  return {
      fuzz_bytes(R"({"message":{"subject":"a.b","seq":3,"hdrs":"Zg==","data":"Zm9v","time":"x"}})"),
      fuzz_bytes(R"({"message":{"subject":"a.b","seq":18446744073709551615}})"),
      fuzz_bytes(R"({"error":{"code":404,"err_code":10037,"description":"no message found"}})"),
      fuzz_bytes(R"({"stream":"T","seq":5})"),
      {}};
}

scene::ObjectOptions without_structures() {
  scene::ObjectOptions options;
  options.field.reset();
  return options;
}

bool exercise_source_record(std::span<const std::uint8_t> bytes) {
  // Unknown space that counts as occupied may be large, whatever the number of bytes.
  constexpr scene::VoxelMapLimits kLargestMap{.voxels = 100'000, .triangles = 100'000};
  const scene::Bytes record = log_bytes_of(bytes);
  const auto source = scene::source_from(record, nullptr, without_structures(), kLargestMap);
  if (!source) {
    promise(!source.error.empty(), "a refusal has a reason");
    return false;
  }
  promise(scene::record_of(**source) == record, "a record has one form");
  return true;
}

std::vector<FuzzBytes> source_record_seeds() {
  scene::Mesh box = *scene::box_mesh(Vec3(1, 2, 3));
  const scene::ImportReport report = scene::report_of(box, "box");
  const auto shape =
      scene::make_source(scene::ObjectKind::kBox, std::move(box), report, without_structures());
  scene::VoxelSet occupied;
  for (int i = 0; i < 20; ++i) occupied.insert(scene::Voxel{i, 2 * i, -i});
  scene::VoxelSet free;
  free.insert(scene::Voxel{1, 1, 1});
  const auto map = scene::VoxelMap::build(0.1, std::move(occupied), std::move(free),
                                          scene::UnknownSpace::kFree, {100'000, 100'000});
  const auto of_map = scene::make_map_source(map.map, scene::report_of(*map.map, "map"),
                                             without_structures(), geometry::Vec3::Zero());
  return {fuzz_bytes_of(scene::record_of(*shape)), fuzz_bytes_of(scene::record_of(*of_map)), {}};
}

}  // namespace

constinit const FuzzTarget kChangeRecordTarget{"change_record", exercise_change_record,
                                               change_record_seeds, 20'000};
constinit const FuzzTarget kLogMessageTarget{"log_message", exercise_fleet_message,
                                             fleet_message_seeds, 100'000};
constinit const FuzzTarget kStreamAnswerTarget{"stream_answer", exercise_stream_answer,
                                               stream_answer_seeds, 100'000};
constinit const FuzzTarget kSourceRecordTarget{"source_record", exercise_source_record,
                                               source_record_seeds, 20'000};

}  // namespace camway::testing
