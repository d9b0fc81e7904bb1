// SPDX-License-Identifier: MIT
#include "daemon/scene/log/nats/nats_blobs.h"

#include <algorithm>
#include <cassert>
#include <thread>
#include <utility>

namespace camway::scene {
namespace {

using nats::StreamFault;
using std::chrono::milliseconds;

/// After this time a request to a server counts as lost.
constexpr milliseconds kRequestWait{2000};
constexpr milliseconds kRetryPause{30};
/// Headers of a message, and what else is not part of its payload.
constexpr std::size_t kMessageOverhead = 4096;
constexpr std::size_t kMostPartBytes = std::size_t{512} << 10U;
/// A blob of up to this size is in part 0: one message, not two.
constexpr std::size_t kMostContentInHead = std::size_t{64} << 10U;
constexpr std::size_t kMostRecentBytes = std::size_t{512} << 20U;

std::span<const std::uint8_t> payload_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

std::uint32_t parts_of(std::size_t bytes, std::size_t part_bytes) {
  return static_cast<std::uint32_t>((bytes + part_bytes - 1) / part_bytes);
}

base::Failure damaged_blob(const std::string& why) {
  return {"a mesh or map in the log of the fleet is damaged: " + why};
}

}  // namespace

milliseconds rest_of(PatienceEnd end) {
  const auto rest =
      std::chrono::duration_cast<milliseconds>(end - std::chrono::steady_clock::now());
  return std::clamp(rest, milliseconds(0), kRequestWait);
}

bool pause_before_retry(PatienceEnd end) {
  if (std::chrono::steady_clock::now() + kRetryPause >= end) return false;
  std::this_thread::sleep_for(kRetryPause);
  return true;
}

AppendResult append_fault(StreamFault fault, const std::string& error) {
  switch (fault) {
    case StreamFault::kNone:
      return {};
    case StreamFault::kConflict:
      return {AppendFault::kConflict, "another change was sooner"};
    case StreamFault::kFull:
      return {AppendFault::kFull, "the log of the fleet has no room left (" + error +
                                      "): make room on the disks of NATS, or raise its limits"};
    case StreamFault::kStalled:
      return {AppendFault::kFull, "the log of the fleet cannot be written: " + error};
    case StreamFault::kUnreachable:
    case StreamFault::kRefused:
      break;
  }
  return {AppendFault::kBroken, "the log of the fleet cannot be written: " + error};
}

NatsBlobs::NatsBlobs(nats::Connection& connection, std::unique_ptr<nats::Stream> stream,
                     Options options)
    : connection_(connection), stream_(std::move(stream)), options_(std::move(options)) {}

std::string NatsBlobs::subject(const BlobId& id, std::uint32_t part) const {
  return options_.prefix + "." + token_of(id) + "." + std::to_string(part);
}

std::size_t NatsBlobs::part_bytes() const {
  const std::size_t most = connection_.most_bytes();
  return std::min(kMostPartBytes, most > 2 * kMessageOverhead ? most - kMessageOverhead : most / 2);
}

bool NatsBlobs::is_held(const BlobId& id) {
  const std::lock_guard lock(mutex_);
  const auto found = held_.find(id);
  return found != held_.end() && Clock::now() < found->second + options_.grace / 4;
}

void NatsBlobs::set_held(const BlobId& id) {
  const std::lock_guard lock(mutex_);
  held_[id] = Clock::now();
}

void NatsBlobs::remember(Recent recent) {
  const std::lock_guard lock(mutex_);
  recent_bytes_ += recent.bytes();
  recent_.push_back(std::move(recent));
  const bool is_too_much = recent_bytes_ > kMostRecentBytes;
  while (!recent_.empty() && (recent_bytes_ > kMostRecentBytes ||
                              recent_.front().when + options_.recent_time < Clock::now())) {
    recent_bytes_ -= recent_.front().bytes();
    recent_.pop_front();
  }
  if (is_too_much && !has_warned_) {
    has_warned_ = true;
    warn(
        "more meshes and maps were kept within five minutes than can be repaired if the "
        "machine of NATS loses power now");
  }
}

void NatsBlobs::forget(const BlobId& id) {
  const std::lock_guard lock(mutex_);
  held_.erase(id);
  needs_.erase(id);
  std::erase_if(recent_, [&](const Recent& each) {
    if (each.id != id) return false;
    recent_bytes_ -= each.bytes();
    return true;
  });
}

NatsBlobs::Published NatsBlobs::publish(const BlobId& id, std::uint32_t part,
                                        std::span<const std::byte> bytes,
                                        std::optional<std::uint64_t> expected, PatienceEnd end) {
  for (;;) {
    Published done = stream_->publish(subject(id, part), payload_of(bytes), expected, rest_of(end));
    if (done.fault != StreamFault::kUnreachable || !pause_before_retry(end)) return done;
    // The first one may have been stored, which looks like a conflict, but is none.
    if (expected) return done;
  }
}

NatsBlobs::Published NatsBlobs::write(const Recent& recent, PatienceEnd end) {
  for (;;) {
    const std::uint64_t generation = connection_.generation();
    const std::size_t size = recent.content ? recent.content->size() : 0;
    const std::size_t each = part_bytes();
    for (std::uint32_t part = 0; part < parts_of(size, each); ++part) {
      const std::size_t begin = part * each;
      const auto bytes =
          std::span<const std::byte>(*recent.content).subspan(begin, std::min(each, size - begin));
      Published done = publish(recent.id, part + 1, bytes, std::nullopt, end);
      if (!done) return done;
    }
    Published done = publish(recent.id, 0, recent.head, std::nullopt, end);
    // If the server was another one meanwhile, it may not have the first parts.
    if (!done || connection_.generation() == generation) return done;
  }
}

AppendResult NatsBlobs::put(const BlobId& id, const Blob& blob, PatienceEnd end) {
  BlobHead head{blob.bytes.size(), 0, blob.needs, {}};
  Recent recent{id, Clock::now(), {}, nullptr};
  if (blob.bytes.size() <= std::min(kMostContentInHead, part_bytes() / 2)) {
    head.content = blob.bytes;
  } else {
    head.parts = parts_of(blob.bytes.size(), part_bytes());
    recent.content = std::make_shared<const Bytes>(blob.bytes);
  }
  recent.head = bytes_of(head);
  // Before it is written: if the server loses it right after that, it is known already.
  remember(recent);
  const Published done = write(recent, end);
  if (!done) {
    forget(id);
    return append_fault(done.fault, done.error);
  }
  set_held(id);
  const std::lock_guard lock(mutex_);
  needs_[id] = blob.needs;
  return {};
}

nats::StreamResult<nats::Stream::Found> NatsBlobs::last(const std::string& subject,
                                                        PatienceEnd end) {
  for (;;) {
    auto found = stream_->last(subject, rest_of(end));
    if (found || found.fault != StreamFault::kUnreachable || !pause_before_retry(end)) {
      return found;
    }
  }
}

NatsBlobs::HoldResult NatsBlobs::hold(const BlobId& id, const IsNeeded& is_needed,
                                      PatienceEnd end) {
  if (is_held(id)) return {Held::kHeld, {}};
  for (;;) {
    const auto found = last(subject(id, 0), end);
    if (!found) return {Held::kUnreachable, append_fault(found.fault, found.error)};
    if (!*found) return {Held::kMissing, {}};
    const nats::StoredMessage& message = **found;
    const auto bytes = std::as_bytes(std::span(message.payload));
    const Bytes head(bytes.begin(), bytes.end());
    if (!is_needed(id)) {
      // A server that crashed may have dropped the parts, but have part 0 again.
      const auto there =
          stream_->subjects(options_.prefix + "." + token_of(id) + ".>", rest_of(end));
      if (!there) return {Held::kUnreachable, append_fault(there.fault, there.error)};
      const Recent recent{id, Clock::now(), head, nullptr};
      if (!has_parts(recent, *there)) return {Held::kMissing, {}};
      const Published done = publish(id, 0, head, message.sequence, end);
      const bool is_unclear = done.fault == StreamFault::kUnreachable && pause_before_retry(end);
      if (is_unclear || done.fault == StreamFault::kConflict) continue;
      if (!done) return {Held::kUnreachable, append_fault(done.fault, done.error)};
      remember(recent);
    }
    set_held(id);
    return {Held::kHeld, {}};
  }
}

base::Result<Bytes> NatsBlobs::read(const BlobId& id, PatienceEnd end) {
  const auto found = find_part(id, 0, end);
  if (!found) return base::Failure{"the log of the fleet cannot be read: " + found.error};
  if (!*found)
    return base::Failure{
        "its mesh or map is not in the log of the fleet any more. Put it again or unload the "
        "scene with a front that runs, or start a front with --fleet-drop SCENE, which removes the "
        "scene from the fleet"};
  base::Result<BlobHead> head = blob_head_from(std::as_bytes(std::span((*found)->payload)));
  if (!head) return damaged_blob(head.error);
  base::Result<Bytes> bytes =
      head->parts == 0 ? std::move(head->content) : read_parts(id, *head, end);
  if (!bytes) return bytes;
  if (blob_id_of(*bytes) != id) return damaged_blob("it has other bytes than its name says");
  return bytes;
}

nats::StreamResult<nats::Stream::Found> NatsBlobs::find_part(const BlobId& id, std::uint32_t part,
                                                             PatienceEnd end) {
  auto found = stream_->last_of_any_server(subject(id, part), rest_of(end));
  // Another server than the leader may not have it yet.
  return found && *found ? found : last(subject(id, part), end);
}

base::Result<Bytes> NatsBlobs::read_parts(const BlobId& id, const BlobHead& head, PatienceEnd end) {
  Bytes bytes;
  for (std::uint32_t part = 1; part <= head.parts; ++part) {
    const auto found = find_part(id, part, end);
    if (!found) return base::Failure{"the log of the fleet cannot be read: " + found.error};
    if (!*found) return damaged_blob("a part of it is lost");
    const auto more = std::as_bytes(std::span((*found)->payload));
    if (bytes.size() + more.size() > head.bytes) return damaged_blob("it has too many bytes");
    bytes.insert(bytes.end(), more.begin(), more.end());
  }
  return bytes;
}

nats::StreamResult<std::vector<BlobId>> NatsBlobs::needs_of(const BlobId& id, PatienceEnd end) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = needs_.find(id); known != needs_.end()) return known->second;
  }
  const auto found = last(subject(id, 0), end);
  if (!found) return {found.fault, found.error};
  if (!*found) return std::vector<BlobId>{};
  base::Result<BlobHead> head = blob_head_from(std::as_bytes(std::span((*found)->payload)));
  if (!head) return {StreamFault::kRefused, head.error};
  const std::lock_guard lock(mutex_);
  return needs_[id] = std::move(head->needs);
}

nats::StreamResult<std::set<BlobId>> NatsBlobs::all(PatienceEnd end) {
  const auto subjects = stream_->subjects(options_.prefix + ".*.0", rest_of(end));
  if (!subjects) return {subjects.fault, subjects.error};
  std::set<BlobId> ids;
  for (const auto& [subject, count] : *subjects) {
    const std::size_t begin = options_.prefix.size() + 1;
    const std::size_t dot = std::min(subject.find('.', begin), subject.size());
    const auto id = blob_id_from_token(std::string_view(subject).substr(begin, dot - begin));
    if (id) ids.insert(*id);
  }
  return ids;
}

bool NatsBlobs::has_marks() {
  const std::lock_guard alone(drop_mutex_);
  return !marks_.empty();
}

std::string NatsBlobs::use(const BlobId& id, std::set<BlobId>& used, PatienceEnd end) {
  std::vector<BlobId> next{id};
  while (!next.empty()) {
    const BlobId each = next.back();
    next.pop_back();
    if (!used.insert(each).second) continue;
    const auto needs = needs_of(each, end);
    if (!needs) return needs.error;
    next.insert(next.end(), needs->begin(), needs->end());
  }
  return "";
}

AppendResult NatsBlobs::drop_unused(const std::set<BlobId>& roots, PatienceEnd end) {
  const std::lock_guard alone(drop_mutex_);
  std::set<BlobId> used;
  for (const BlobId& id : roots) {
    const std::string fault = use(id, used, end);
    if (!fault.empty()) return append_fault(StreamFault::kRefused, fault);
  }
  const auto subjects = stream_->subjects(options_.prefix + ".>", rest_of(end));
  if (!subjects) return append_fault(subjects.fault, subjects.error);
  struct Parts {
    std::uint32_t last = 0;
    bool has_head = false;
  };
  std::map<BlobId, Parts> unused;
  for (const auto& [subject, count] : *subjects) {
    const std::size_t begin = options_.prefix.size() + 1;
    const std::size_t dot = std::min(subject.find('.', begin), subject.size());
    const auto id = blob_id_from_token(std::string_view(subject).substr(begin, dot - begin));
    if (!id || used.contains(*id) || dot == subject.size()) continue;
    Parts& parts = unused[*id];
    const auto part = static_cast<std::uint32_t>(std::strtoul(&subject[dot + 1], nullptr, 10));
    parts.last = std::max(parts.last, part);
    parts.has_head = parts.has_head || part == 0;
  }
  std::erase_if(marks_, [&](const auto& mark) { return !unused.contains(mark.first); });
  for (const auto& [id, parts] : unused) {
    AppendResult dropped = drop(id, parts.last, parts.has_head, end);
    if (dropped.fault != AppendFault::kNone) return dropped;
  }
  return {};
}

AppendResult NatsBlobs::drop(const BlobId& id, std::uint32_t last_part, bool is_whole,
                             PatienceEnd end) {
  const auto found = last(subject(id, is_whole ? 0 : last_part), end);
  if (!found) return append_fault(found.fault, found.error);
  if (!*found) return {};
  const std::uint64_t sequence = (*found)->sequence;
  const auto [mark, is_new] = marks_.try_emplace(id, Mark{sequence, Clock::now()});
  if (mark->second.sequence != sequence) mark->second = {sequence, Clock::now()};
  if (Clock::now() < mark->second.since + options_.grace) return {};
  forget(id);
  marks_.erase(mark);
  if (is_whole) {
    // By its sequence: if another process has just written part 0 again, it is another message. In
    // a cluster, the other parts are dropped later, as those of a blob without part 0: a cluster
    // may accept a part 0 that another process has sent before it knows that this one is gone.
    const auto removed = stream_->remove(sequence, rest_of(end));
    if (!removed) return append_fault(removed.fault, removed.error);
    if (!*removed || !options_.is_alone) return {};
    // A process that writes the blob again now writes all of its parts, later than its part 0 was.
    const auto parts =
        stream_->purge(options_.prefix + "." + token_of(id) + ".>", sequence, rest_of(end));
    return parts ? AppendResult{} : append_fault(parts.fault, parts.error);
  }
  // Parts that another process writes meanwhile come later.
  const auto purged =
      stream_->purge(options_.prefix + "." + token_of(id) + ".>", sequence + 1, rest_of(end));
  return purged ? AppendResult{} : append_fault(purged.fault, purged.error);
}

std::string NatsBlobs::repair(PatienceEnd end) {
  std::string fault = stream_->ensure_again(rest_of(end));
  if (!fault.empty()) return fault;
  std::vector<Recent> recent;
  {
    const std::lock_guard lock(mutex_);
    held_.clear();
    for (const Recent& each : recent_) {
      if (each.when + options_.recent_time >= Clock::now()) recent.push_back(each);
    }
  }
  if (recent.empty()) return "";
  const auto there = stream_->subjects(options_.prefix + ".>", rest_of(end));
  if (!there) return there.error;
  std::size_t repaired = 0;
  std::string lost;
  for (const Recent& each : recent) {
    const bool has_rest = has_parts(each, *there);
    const bool can_repair = each.content != nullptr || has_rest;
    if (!can_repair || (has_rest && there->contains(subject(each.id, 0)))) continue;
    const Published done = write(each, end);
    if (done.fault == StreamFault::kUnreachable) return done.error;
    if (done) {
      ++repaired;
    } else {
      lost = done.error;
    }
  }
  if (repaired > 0) {
    warn("NATS had lost meshes or maps, of which " + std::to_string(repaired) + " were kept again");
  }
  if (!lost.empty()) warn("NATS has lost a mesh or map that cannot be kept again: " + lost);
  return "";
}

void NatsBlobs::warn(const std::string& sentence) const {
  if (options_.warn) options_.warn(sentence);
}

bool NatsBlobs::has_parts(const Recent& recent, const Subjects& there) const {
  const base::Result<BlobHead> head = blob_head_from(recent.head);
  if (!head) return false;
  for (std::uint32_t part = 1; part <= head->parts; ++part) {
    if (!there.contains(subject(recent.id, part))) return false;
  }
  return true;
}

}  // namespace camway::scene
