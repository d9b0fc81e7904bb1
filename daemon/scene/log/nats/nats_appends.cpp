// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>
#include <utility>

#include "daemon/scene/log/nats/nats_log_parts.h"
#include "daemon/scene/log/removal_requests.h"

namespace camway::scene {
namespace {

using Kind = LogMessage::Kind;
using nats::StreamFault;

/// Larger records are blobs.
constexpr std::size_t kMostRecordInMessage = std::size_t{128} << 10U;
/// Ids that a message holds beside its record: of blobs, and of messages that it replaces.
constexpr std::size_t kRoomBesideRecord = std::size_t{64} << 10U;
/// Subjects have to fit into a line of the protocol.
constexpr std::size_t kMostSceneNameBytes = 1000;

std::span<const std::uint8_t> payload_of_message(const Bytes& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

}  // namespace

AppendResult NatsLog::Parts::conflict(std::string_view scene, std::uint64_t newest,
                                      std::uint64_t expected) const {
  const std::string name(scene);
  if (expected == 0 && newest == 0) return {AppendFault::kConflict, "no scene has revision 0"};
  if (newest == 0) return {AppendFault::kConflict, "there is no scene '" + name + "'"};
  return {AppendFault::kConflict, "scene '" + name + "' is at revision " + std::to_string(newest) +
                                      ", not at " + std::to_string(expected)};
}

AppendResult NatsLog::Parts::given_up(const std::string& reason, bool may_be_sent) const {
  const std::string stall = connection_.stall();
  AppendResult result =
      append_fault(stall.empty() ? StreamFault::kUnreachable : StreamFault::kStalled, stall);
  if (stall.empty()) result.error = place() + " cannot be reached: " + reason;
  result.error += may_be_sent ? ". The change may still take effect: send the same "
                                "request again, or look at the history of the scene"
                              : "; nothing was changed";
  return result;
}

NatsLog::Parts::Head NatsLog::Parts::head_of(std::string_view scene, const MessageId& id) const {
  const std::lock_guard lock(mutex_);
  const auto found = chains_.find(scene);
  if (found == chains_.end()) return {};
  const SceneChain& chain = found->second;
  return {chain.newest_revision(), chain.last_sequence(), chain.removed(), chain.newest_id(),
          chain.contains(id)};
}

std::vector<MessageId> NatsLog::Parts::known_ids(std::string_view scene) const {
  const std::lock_guard lock(mutex_);
  const auto found = chains_.find(scene);
  return found == chains_.end() ? std::vector<MessageId>{} : found->second.ids();
}

AppendResult NatsLog::Parts::missing_need(const std::vector<BlobId>& needs, PatienceEnd end) {
  for (const BlobId& id : needs) {
    NatsBlobs::HoldResult result = hold(id, end);
    if (result.held == NatsBlobs::Held::kUnreachable) return std::move(result.fault);
    if (result.held == NatsBlobs::Held::kMissing) {
      return {AppendFault::kBroken, "a needed mesh or map is not in the log"};
    }
  }
  return {};
}

AppendResult NatsLog::Parts::put_blob(const BlobId& id, const Blob& blob, PatienceEnd end) {
  assert(blob_id_of(blob.bytes) == id);
  NatsBlobs::HoldResult held = hold(id, end);
  if (held.held == NatsBlobs::Held::kHeld) return {};
  if (held.held == NatsBlobs::Held::kUnreachable) return std::move(held.fault);
  AppendResult missing = missing_need(blob.needs, end);
  if (missing.fault != AppendFault::kNone) return missing;
  AppendResult done = blobs_.put(id, blob, end);
  if (done.fault != AppendFault::kFull || !connection_.stall().empty()) return done;
  const AppendResult dropped = drop_unused_blobs(true);
  return dropped.fault == AppendFault::kNone ? blobs_.put(id, blob, end) : done;
}

bool NatsLog::Parts::may_make_room(const LogMessage& message, const AppendResult& fault,
                                   PatienceEnd end) {
  // Deleted messages do not free room at once on a disk that is full.
  const bool is_limit = fault.fault == AppendFault::kFull && connection_.stall().empty() &&
                        fault.error.find("no space left") == std::string::npos;
  if (!is_limit) return false;
  if (message.kind != Kind::kEntry) return reserve_.release(0, end);
  const bool is_small = message.needs.empty() && !message.blob;
  return is_small && reserve_.release(NatsReserve::kLastPieces, end);
}

AppendResult NatsLog::Parts::prepare(std::string_view scene, std::uint64_t expected,
                                     LogMessage& message, const Bytes& record, PatienceEnd end) {
  if (scene.size() > kMostSceneNameBytes) {
    return {AppendFault::kBroken, place() + " takes no scene with a name of that size"};
  }
  const std::string unchecked = check_tail(end);
  if (!unchecked.empty()) return given_up(unchecked, /*may_be_sent=*/false);
  // This process may not know yet that another one has changed the scene; then the server says so.
  const std::uint64_t newest = head_of(scene, message.id).revision;
  if (newest != expected) return conflict(scene, newest, expected);
  AppendResult missing = missing_need(message.needs, end);
  if (missing.fault != AppendFault::kNone) return missing;
  const std::size_t room =
      connection_.most_bytes() - std::min(connection_.most_bytes(), kRoomBesideRecord);
  if (record.size() <= std::min(kMostRecordInMessage, room)) {
    message.record = record;
    return {};
  }
  message.blob = blob_id_of(record);
  AppendResult put = put_blob(*message.blob, {record, {}}, end);
  while (may_make_room(message, put, end)) put = put_blob(*message.blob, {record, {}}, end);
  if (put.fault == AppendFault::kNone) keep_record(*message.blob, record);
  return put;
}

AppendResult NatsLog::Parts::commit(std::string_view scene, std::uint64_t expected,
                                    LogMessage message, PatienceEnd end) {
  bool may_be_sent = false;
  for (;;) {
    const std::string unchecked = check_tail(end);
    if (!unchecked.empty()) return given_up(unchecked, may_be_sent);
    if (!connection_.is_connected()) {
      if (pause_before_retry(end)) continue;
      return given_up("there is no connection to NATS", may_be_sent);
    }
    const Head head = head_of(scene, message.id);
    if (head.has_it) return {};
    if (head.revision != expected) return conflict(scene, head.revision, expected);
    const auto done = send(scene, head, message, end);
    if (done && options_.replicas == 1) {
      take_own(scene, std::move(message), *done);
      return {};
    }
    // A cluster may have accepted two at once, of which the first one counts: see which that is.
    if (done || done.fault == StreamFault::kConflict) {
      may_be_sent = may_be_sent || done;
      const std::string fault = refresh(std::string(scene), end);
      if (!fault.empty()) return given_up(fault, may_be_sent);
      continue;
    }
    std::optional<AppendResult> failed =
        failure_of(message, {done.fault, done.error}, may_be_sent, end);
    if (failed) return *std::move(failed);
  }
}

nats::StreamResult<std::uint64_t> NatsLog::Parts::send(std::string_view scene, const Head& head,
                                                       LogMessage& message, PatienceEnd end) {
  const auto begin = std::chrono::steady_clock::now();
  message.after = head.newest;
  message.removed = head.removed;
  if (message.kind != Kind::kEntry) message.replaces = known_ids(scene);
  const Bytes bytes = bytes_of(message);
  auto done = stream_->publish(scene_subject(scene), payload_of_message(bytes), head.sequence,
                               rest_of(end));
  // This process was stopped for longer than a blob is kept that nobody names.
  if (!message.needs.empty() &&
      std::chrono::steady_clock::now() > begin + *options_.blob_grace / 2) {
    must_check_ = true;
  }
  return done;
}

std::optional<AppendResult> NatsLog::Parts::failure_of(const LogMessage& message,
                                                       const SendFault& fault, bool& may_be_sent,
                                                       PatienceEnd end) {
  if (fault.fault == StreamFault::kStalled) return given_up(fault.error, may_be_sent);
  if (fault.fault == StreamFault::kUnreachable) {
    may_be_sent = true;
    if (pause_before_retry(end)) return std::nullopt;
    return given_up(fault.error, may_be_sent);
  }
  AppendResult refused = append_fault(fault.fault, fault.error);
  if (may_make_room(message, refused, end)) return std::nullopt;
  // A refusal is not the answer to a message that was sent before.
  return may_be_sent ? given_up(fault.error, may_be_sent) : refused;
}

void NatsLog::Parts::take_own(std::string_view scene, LogMessage message, std::uint64_t sequence) {
  const std::lock_guard lock(mutex_);
  SceneChain& chain = chains_[std::string(scene)];
  if (sequence > chain.last_sequence()) chain.take(std::move(message), sequence);
}

std::string NatsLog::Parts::refresh(const std::string& scene, PatienceEnd end) {
  std::uint64_t last = 0;
  {
    const std::lock_guard lock(mutex_);
    last = chains_[scene].last_sequence();
  }
  Chains read;
  const auto done = read_chains(scene_subject(scene), last + 1, read, end);
  if (!done) return done.error;
  {
    const std::lock_guard lock(mutex_);
    SceneChain next = chains_[scene];
    // The follower may have brought some of them meanwhile.
    const std::uint64_t before = next.last_sequence();
    for (ChainLink& link : read[scene].links()) {
      if (link.sequence > before) next.take(std::move(link.message), link.sequence);
    }
    if (next.is_whole() && next.last_sequence() > last) {
      chains_[scene] = std::move(next);
      return "";
    }
  }
  // The server has less than this process knows, or what it has does not continue that.
  must_check_ = true;
  return pause_before_retry(end) ? "" : "another change is being made";
}

void NatsLog::Parts::purge_before_last(std::string_view scene, const MessageId& id,
                                       PatienceEnd end) {
  std::uint64_t sequence = 0;
  {
    const std::lock_guard lock(mutex_);
    const auto found = chains_.find(scene);
    const ChainLink* const link = found == chains_.end() ? nullptr : found->second.find(id);
    if (link != nullptr) sequence = link->sequence;
  }
  // If this fails, the rest is purged with the next summary; readers leave it out.
  if (sequence > 1) {
    static_cast<void>(stream_->purge(scene_subject(scene), sequence, rest_of(end)));
  }
}

AppendResult NatsLog::Parts::append(std::string_view scene, const LogEntry& entry) {
  if (entry.revision <= entry.before) {
    return {AppendFault::kBroken, "revision " + std::to_string(entry.revision) +
                                      " cannot follow revision " + std::to_string(entry.before)};
  }
  const PatienceEnd end = patience_end();
  LogMessage message;
  message.id = new_message_id();
  message.before = entry.before;
  message.revision = entry.revision;
  message.needs = entry.needs;
  AppendResult fault = prepare(scene, entry.before, message, entry.record, end);
  if (fault.fault != AppendFault::kNone) return fault;
  return commit(scene, entry.before, std::move(message), end);
}

AppendResult NatsLog::Parts::replace_all(std::string_view scene, LogMessage message,
                                         const Bytes& record) {
  const std::uint64_t revision = message.revision;
  if (revision == 0) return conflict(scene, 0, 0);
  const PatienceEnd end = patience_end();
  message.id = new_message_id();
  const MessageId id = message.id;
  AppendResult fault = prepare(scene, revision, message, record, end);
  if (fault.fault == AppendFault::kNone) fault = commit(scene, revision, std::move(message), end);
  if (fault.fault == AppendFault::kNone) purge_before_last(scene, id, end);
  if (fault.fault == AppendFault::kNone && reserve_.is_incomplete()) reserve_.fill(end);
  return fault;
}

AppendResult NatsLog::Parts::summarize(std::string_view scene, std::uint64_t revision,
                                       const Bytes& summary, const std::vector<BlobId>& needs) {
  LogMessage message;
  message.kind = Kind::kSummary;
  message.revision = revision;
  message.needs = needs;
  return replace_all(scene, std::move(message), summary);
}

AppendResult NatsLog::Parts::remove(std::string_view scene, std::uint64_t revision,
                                    std::string_view request) {
  LogMessage message;
  message.kind = Kind::kRemoval;
  message.revision = revision;
  std::string requests;
  {
    const std::lock_guard lock(mutex_);
    const auto found = chains_.find(scene);
    if (found != chains_.end()) requests = removals_text(found->second);
  }
  requests = with_removal(requests, request);
  const auto bytes = std::as_bytes(std::span<const char>(requests));
  return replace_all(scene, std::move(message), {bytes.begin(), bytes.end()});
}

AppendResult NatsLog::Parts::drop(std::string_view scene) {
  const PatienceEnd end = patience_end();
  const std::string unchecked = check_tail(end);
  if (!unchecked.empty()) return given_up(unchecked, /*may_be_sent=*/false);
  const std::string name(scene);
  auto chain = read_scene(name, end);
  if (!chain) return append_fault(chain.fault, chain.error);
  const std::uint64_t revision = chain->newest_revision();
  if (revision == 0) return conflict(scene, 0, 1);
  {
    const std::lock_guard lock(mutex_);
    chains_[name] = *std::move(chain);
  }
  return remove(scene, revision, "");
}

}  // namespace camway::scene
