// SPDX-License-Identifier: MIT
#include <algorithm>
#include <span>
#include <utility>

#include "daemon/scene/log/nats/nats_log_parts.h"

namespace camway::scene {
namespace {

std::span<const std::uint8_t> payload_of_note(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

void NatsLog::Parts::on_lost_blob(SceneLog::LostBlob find) {
  const std::lock_guard lock(lost_blob_mutex_);
  lost_blob_ = std::move(find);
}

bool NatsLog::Parts::lacks_blobs_of(std::string_view scene) const {
  const std::lock_guard lock(mutex_);
  return lost_.contains(scene);
}

void NatsLog::Parts::add_needs(const SceneChain& chain, std::set<BlobId>& needs) {
  for (const ChainLink& link : chain.links()) {
    needs.insert(link.message.needs.begin(), link.message.needs.end());
    if (link.message.blob) needs.insert(*link.message.blob);
  }
}

void NatsLog::Parts::keep_record(const BlobId& id, const Bytes& record) {
  const std::lock_guard lock(mutex_);
  auto& kept = records_[id];
  if (kept == nullptr) kept = std::make_shared<const Bytes>(record);
}

std::optional<Blob> NatsLog::Parts::blob_again(const BlobId& id) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = records_.find(id); found != records_.end()) {
      return Blob{*found->second, {}};
    }
  }
  const std::lock_guard lock(lost_blob_mutex_);
  return lost_blob_ ? lost_blob_(id) : std::nullopt;
}

nats::StreamResult<bool> NatsLog::Parts::repair_blobs(const std::set<BlobId>& roots,
                                                      BlobRepair& repair, PatienceEnd end) {
  bool are_whole = true;
  for (const BlobId& id : roots) {
    if (const auto known = repair.is_whole.find(id); known != repair.is_whole.end()) {
      are_whole = are_whole && known->second;
      continue;
    }
    std::optional<Blob> again;
    std::vector<BlobId> needs;
    bool is_whole = true;
    if (repair.there.contains(id)) {
      auto known = blobs_.needs_of(id, end);
      if (!known) return {known.fault, known.error};
      needs = *std::move(known);
    } else {
      again = blob_again(id);
      is_whole = again.has_value();
      if (again) needs = again->needs;
      if (!again) repair.lost.insert(id);
    }
    // Ends at a damaged blob that needs itself.
    repair.is_whole[id] = false;
    const auto rest = repair_blobs({needs.begin(), needs.end()}, repair, end);
    if (!rest) return rest;
    is_whole = is_whole && *rest;
    if (again) {
      const AppendResult put = blobs_.put(id, *again, end);
      if (put.fault != AppendFault::kNone) return {nats::StreamFault::kUnreachable, put.error};
      ++repair.repaired;
    }
    repair.is_whole[id] = is_whole;
    are_whole = are_whole && is_whole;
  }
  return are_whole;
}

std::string NatsLog::Parts::repair_contents(PatienceEnd end) {
  Chains known;
  {
    const std::lock_guard lock(mutex_);
    known = chains_;
  }
  const auto there = blobs_.all(end);
  if (!there) return there.error;
  BlobRepair repair{*there, {}, {}, 0};
  LostBlobs lost;
  for (const auto& [scene, chain] : known) {
    std::set<BlobId> needs;
    add_needs(chain, needs);
    const auto are_whole = repair_blobs(needs, repair, end);
    if (!are_whole) return are_whole.error;
    if (*are_whole) continue;
    lost[scene] = static_cast<std::size_t>(
        std::ranges::count_if(needs, [&](const BlobId& id) { return !repair.is_whole.at(id); }));
  }
  if (repair.repaired > 0) {
    warn("NATS had lost " + std::to_string(repair.repaired) +
         " meshes, maps or records, which were made again of the scenes here");
  }
  note_lost(lost);
  return repair_notes(end);
}

void NatsLog::Parts::note_lost(const LostBlobs& lost) {
  std::string scenes;
  std::size_t count = 0;
  for (const auto& [scene, number] : lost) {
    scenes += (scenes.empty() ? "'" : ", '") + scene + "' (" + std::to_string(number) + ")";
    count += number;
  }
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(lost_, lost) == lost) return;
  }
  if (lost.empty()) {
    warn("nothing that scenes need is missing in NATS any more");
    return;
  }
  warn("NATS has lost " + std::to_string(count) +
       " meshes or maps that this process has not, of these scenes: " + scenes +
       ". Processes that run go on, but none can be started: put these objects again, or unload "
       "the scenes");
}

std::string NatsLog::Parts::repair_notes(PatienceEnd end) {
  std::map<std::string, Note> notes;
  {
    const std::lock_guard lock(mutex_);
    notes = notes_;
  }
  for (const auto& [key, note] : notes) {
    const auto found = stream_->last(note_subject(key), rest_of(end));
    if (!found) return found.error;
    // A later one of another process counts.
    if (*found && (*found)->sequence >= note.sequence) continue;
    const auto done = stream_->publish(note_subject(key), payload_of_note(note.text),
                                       *found ? (*found)->sequence : 0, rest_of(end));
    if (done.fault == nats::StreamFault::kConflict) continue;
    if (!done) return done.error;
    const std::lock_guard lock(mutex_);
    if (notes_[key].text == note.text) notes_[key].sequence = *done;
  }
  return "";
}

}  // namespace camway::scene
