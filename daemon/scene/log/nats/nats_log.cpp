// SPDX-License-Identifier: MIT
#include "daemon/scene/log/nats/nats_log.h"

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

#include "daemon/nats/jetstream_api.h"
#include "daemon/scene/log/nats/nats_log_parts.h"
#include "daemon/scene/log/removal_requests.h"

namespace camway::scene {
namespace {

using nats::StreamFault;

/// A process drops unused blobs this often while the grace of one of them runs.
constexpr int kDropsPerGrace = 4;
/// A blob that is held is named within a quarter of the grace and the patience of an append. The
/// process that drops it has read the log before that, within another patience, and what the first
/// one knew of the log was `kTrustedTime` old.
constexpr int kGracePatiences = 4;
constexpr std::chrono::seconds kGraceBeyondPatience{10};
/// Knowledge of the log tells whether a blob is needed for so long after it was read.
constexpr std::chrono::seconds kTrustedTime{5};
constexpr std::uint64_t kEndOfLog = std::numeric_limits<std::uint64_t>::max();
/// Reads of a scene before a missing change counts as lost.
constexpr int kMostReads = 3;
/// Subjects have to fit into a line of the protocol.
constexpr std::size_t kMostNameBytes = 1000;

std::span<const std::uint8_t> payload_of_text(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

bool is_plain(const std::string& name) {
  return !name.empty() && name.find_first_not_of(
                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWX"
                              "YZ0123456789_-") == std::string::npos;
}

/// A server whose disk was full answers to a ping, but its streams do not answer.
base::Failure not_opened(const nats::Connection& connection, const std::string& error) {
  if (!connection.is_connected() || !error.ends_with(nats::kNoAnswerInTime)) return {error};
  return {error +
          ", though it is connected. If its disk is or was full, make room there and restart it "
          "(SIGKILL if it does not end)"};
}

}  // namespace

base::Result<std::unique_ptr<NatsLog>> NatsLog::open(nats::Connection& connection,
                                                     const NatsLogOptions& options) {
  if (!is_plain(options.fleet)) {
    return base::Failure{"'" + options.fleet +
                         "' is no name of a fleet: letters, digits, - and _ are possible"};
  }
  nats::StreamConfig log{
      options.fleet + "_LOG", options.fleet + ".log.>", options.replicas, options.most_bytes, false,
      options.fleet + ".news"};
  nats::StreamConfig blobs{options.fleet + "_BLOBS",
                           options.fleet + ".blob.>",
                           options.replicas,
                           options.most_bytes,
                           true,
                           ""};
  auto stream = nats::Stream::ensure(connection, log, options.patience);
  if (!stream) return not_opened(connection, stream.error);
  auto blob_stream = nats::Stream::ensure(connection, blobs, options.patience);
  if (!blob_stream) return not_opened(connection, blob_stream.error);
  NatsLogOptions complete = options;
  if (!complete.blob_grace) {
    complete.blob_grace = kGracePatiences * options.patience + kGraceBeyondPatience;
  }
  return std::unique_ptr<NatsLog>(new NatsLog(std::make_unique<Parts>(
      connection, std::move(complete), *std::move(stream), *std::move(blob_stream))));
}

NatsLog::NatsLog(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
NatsLog::~NatsLog() = default;

AppendResult NatsLog::put_blob(const BlobId& id, const Blob& blob) {
  return parts_->put_blob(id, blob, parts_->patience_end());
}
bool NatsLog::has_blob(const BlobId& id) {
  return parts_->hold(id, parts_->patience_end()).held == NatsBlobs::Held::kHeld;
}
base::Result<Bytes> NatsLog::blob(const BlobId& id) {
  return parts_->blobs().read(id, parts_->patience_end());
}
AppendResult NatsLog::append(std::string_view scene, const LogEntry& entry) {
  return parts_->append(scene, entry);
}
AppendResult NatsLog::summarize(std::string_view scene, std::uint64_t revision,
                                const Bytes& summary, const std::vector<BlobId>& needs) {
  return parts_->summarize(scene, revision, summary, needs);
}
AppendResult NatsLog::remove(std::string_view scene, std::uint64_t revision,
                             std::string_view request) {
  return parts_->remove(scene, revision, request);
}
std::vector<std::string> NatsLog::removals() { return parts_->removals(); }
std::uint64_t NatsLog::highest_removed() { return parts_->highest_removed(); }
base::Result<std::vector<LoggedScene>> NatsLog::scenes() { return parts_->scenes(); }
std::string NatsLog::note(std::string_view key) { return parts_->note(key); }
AppendResult NatsLog::set_note(std::string_view key, std::string_view text) {
  return parts_->set_note(key, text);
}
AppendResult NatsLog::drop_unused_blobs() { return parts_->drop_unused_blobs(false); }
void NatsLog::on_lost_blob(LostBlob find) { parts_->on_lost_blob(std::move(find)); }
bool NatsLog::lacks_blobs_of(std::string_view scene) { return parts_->lacks_blobs_of(scene); }
base::Result<std::map<std::string, std::string>> NatsLog::notes(std::string_view prefix) {
  return parts_->notes(prefix);
}
bool NatsLog::catch_up(std::chrono::milliseconds patience) { return parts_->catch_up(patience); }
AppendResult NatsLog::drop(std::string_view scene) { return parts_->drop(scene); }
void NatsLog::follow(Take take) { parts_->follow(std::move(take)); }
void NatsLog::stop_following() { parts_->stop_following(); }
std::uint64_t NatsLog::followed() const { return parts_->followed(); }
std::uint64_t NatsLog::position_of(std::string_view scene) const {
  return parts_->position_of(scene);
}
bool NatsLog::is_in_touch() const { return parts_->is_in_touch(); }

NatsLog::Parts::Parts(nats::Connection& connection, NatsLogOptions options,
                      std::unique_ptr<nats::Stream> stream,
                      std::unique_ptr<nats::Stream> blob_stream)
    : connection_(connection),
      options_(std::move(options)),
      stream_(std::move(stream)),
      blobs_(connection, std::move(blob_stream),
             {options_.fleet + ".blob", options_.replicas == 1, *options_.blob_grace,
              options_.recent_time, options_.warn}),
      reserve_(*stream_, options_.fleet + ".log.reserve", options_.most_bytes),
      checked_generation_(connection.generation()) {
  reserve_.fill(patience_end());
}

NatsLog::Parts::~Parts() { stop_following(); }

std::string NatsLog::Parts::place() const { return "the log of fleet '" + options_.fleet + "'"; }

std::string NatsLog::Parts::scene_subject(std::string_view scene) const {
  return options_.fleet + ".log.scene." + token_of(scene);
}

std::string NatsLog::Parts::scene_filter() const { return options_.fleet + ".log.scene.>"; }

std::string NatsLog::Parts::note_filter() const { return options_.fleet + ".log.note.>"; }

std::string NatsLog::Parts::note_subject(std::string_view key) const {
  return options_.fleet + ".log.note." + token_of(key);
}

void NatsLog::Parts::warn(const std::string& sentence) const {
  if (options_.warn) options_.warn(sentence);
}

nats::StreamResult<std::uint64_t> NatsLog::Parts::read_chains(const std::string& filter,
                                                              std::uint64_t from, Chains& chains,
                                                              PatienceEnd end) {
  for (;;) {
    chains.clear();
    std::string fault;
    const auto take = [&](const nats::StoredMessage& stored) {
      const std::size_t dot = stored.subject.rfind('.');
      const auto scene = text_from_token(std::string_view(stored.subject).substr(dot + 1));
      auto message = log_message_from(std::as_bytes(std::span(stored.payload)));
      if (scene && message) {
        chains[*scene].take(*std::move(message), stored.sequence);
      } else if (fault.empty()) {
        fault = scene ? "scene '" + *scene + "', message " + std::to_string(stored.sequence) +
                            ": " + message.error
                      : "message " + std::to_string(stored.sequence) + " has no scene";
      }
    };
    const auto read = stream_->read(from, kEndOfLog, filter, take, rest_of(end));
    if (read && !fault.empty()) return {StreamFault::kRefused, fault};
    if (read.fault != StreamFault::kUnreachable || !pause_before_retry(end)) return read;
  }
}

nats::StreamResult<SceneChain> NatsLog::Parts::read_scene(const std::string& scene,
                                                          PatienceEnd end) {
  for (int reads = 1;; ++reads) {
    Chains chains;
    const auto read = read_chains(scene_subject(scene), 1, chains, end);
    if (!read) return {read.fault, read.error};
    SceneChain& chain = chains[scene];
    if (chain.is_whole() || reads == kMostReads || !pause_before_retry(end)) {
      return std::move(chain);
    }
  }
}

nats::StreamResult<std::uint64_t> NatsLog::Parts::read_all(Chains& chains, PatienceEnd end) {
  const auto read = read_chains(scene_filter(), 1, chains, end);
  if (!read) return read;
  for (auto& [scene, chain] : chains) {
    if (chain.is_whole()) continue;
    // A summary may have come while its entries were read, so that the last ones were gone.
    auto again = read_scene(scene, end);
    if (!again) return {again.fault, again.error};
    chain = *std::move(again);
  }
  return read;
}

bool NatsLog::Parts::adopt(const std::string& scene, const MessageId& newest, SceneChain chain) {
  const std::lock_guard lock(mutex_);
  SceneChain& known = chains_[scene];
  if (known.newest_id() != newest) return false;
  chain.mark_as_taken_in(known);
  known = std::move(chain);
  return true;
}

base::Result<std::vector<LoggedScene>> NatsLog::Parts::scenes() {
  const PatienceEnd end = patience_end();
  const std::string unchecked = check_tail(end);
  if (!unchecked.empty()) return base::Failure{place() + " cannot be read: " + unchecked};
  Chains known;
  {
    const std::lock_guard lock(mutex_);
    known = chains_;
  }
  Chains chains;
  const auto read = read_all(chains, end);
  if (!read && read.fault == StreamFault::kRefused) return damaged(read.error);
  if (!read) return base::Failure{place() + " cannot be read: " + read.error};
  std::vector<LoggedScene> list;
  for (auto& [name, chain] : chains) {
    if (!chain.is_whole()) return damaged("scene '" + name + "' " + chain.fault());
    if (chain.newest_revision() > 0) {
      base::Result<LoggedScene> scene = logged(name, chain, end);
      if (!scene) return base::Failure{std::move(scene.error)};
      list.push_back(*std::move(scene));
    }
    if (!follower_.joinable()) chain.mark_all_as_taken();
    adopt(name, known[name].newest_id(), std::move(chain));
  }
  if (!follower_.joinable()) {
    followed_ = *read;
    has_read_all_ = true;
  }
  return list;
}

base::Failure NatsLog::Parts::damaged(const std::string& what) const {
  return {place() + " is damaged: " + what + ". Restore backups of the streams " + options_.fleet +
          "_LOG and " + options_.fleet + "_BLOBS in NATS, or delete both to begin anew"};
}

base::Result<Bytes> NatsLog::Parts::record_of(const LogMessage& message, PatienceEnd end) {
  if (!message.blob) return message.record;
  base::Result<Bytes> record = blobs_.read(*message.blob, end);
  if (record) keep_record(*message.blob, *record);
  return record;
}

base::Result<LoggedScene> NatsLog::Parts::logged(const std::string& name, const SceneChain& chain,
                                                 PatienceEnd end) {
  LoggedScene scene{name, 0, {}, {}};
  for (const ChainLink& link : chain.links()) {
    const LogMessage& message = link.message;
    if (message.kind == LogMessage::Kind::kRemoval) continue;
    base::Result<Bytes> record = record_of(message, end);
    if (!record) {
      return damaged("scene '" + name + "', message " + std::to_string(link.sequence) + ": " +
                     record.error);
    }
    if (message.kind == LogMessage::Kind::kSummary) {
      scene.summary_revision = message.revision;
      scene.summary = *std::move(record);
    } else {
      scene.entries.push_back(
          {message.before, message.revision, *std::move(record), message.needs});
    }
  }
  return scene;
}

std::string NatsLog::Parts::note(std::string_view key) {
  if (key.size() > kMostNameBytes) return "";
  const PatienceEnd end = patience_end();
  for (;;) {
    const auto found = stream_->last(note_subject(key), rest_of(end));
    if (found && *found) return {(*found)->payload.begin(), (*found)->payload.end()};
    if (found || found.fault != StreamFault::kUnreachable || !pause_before_retry(end)) return "";
  }
}

base::Result<std::map<std::string, std::string>> NatsLog::Parts::notes(std::string_view prefix) {
  const PatienceEnd end = patience_end();
  for (;;) {
    std::map<std::string, std::string> found;
    const auto take = [&](const nats::StoredMessage& stored) {
      const std::size_t dot = stored.subject.rfind('.');
      const auto key = text_from_token(std::string_view(stored.subject).substr(dot + 1));
      if (!key || !key->starts_with(prefix)) return;
      // The last one of a key counts.
      found[*key] = std::string(stored.payload.begin(), stored.payload.end());
    };
    const auto read = stream_->read(1, kEndOfLog, note_filter(), take, rest_of(end));
    if (read) {
      std::erase_if(found, [](const auto& note) { return note.second.empty(); });
      return found;
    }
    if (read.fault != StreamFault::kUnreachable || !pause_before_retry(end)) {
      return base::Failure{place() + " cannot be read: " + read.error};
    }
  }
}

AppendResult NatsLog::Parts::set_note(std::string_view key, std::string_view text) {
  if (key.size() > kMostNameBytes) {
    return {AppendFault::kBroken, place() + " takes no note with a key of that size"};
  }
  const PatienceEnd end = patience_end();
  for (;;) {
    const auto done =
        stream_->publish(note_subject(key), payload_of_text(text), std::nullopt, rest_of(end));
    if (done) {
      {
        const std::lock_guard lock(mutex_);
        notes_[std::string(key)] = {std::string(text), *done};
      }
      // The notes before it are of no use; they are purged with the next one if this fails. A purge
      // up to the first message would be one of all.
      if (*done > 1) static_cast<void>(stream_->purge(note_subject(key), *done, rest_of(end)));
      return {};
    }
    if (done.fault != StreamFault::kUnreachable || !pause_before_retry(end)) {
      return append_fault(done.fault, done.error);
    }
  }
}

bool NatsLog::Parts::is_needed(const BlobId& id) const {
  const std::lock_guard lock(mutex_);
  // Others may have removed what needs it.
  if (read_all_at_ + kTrustedTime < std::chrono::steady_clock::now()) return false;
  for (const auto& [name, chain] : chains_) {
    for (const ChainLink& link : chain.links()) {
      if (link.message.blob == id || std::ranges::count(link.message.needs, id) > 0) return true;
    }
  }
  return false;
}

NatsBlobs::HoldResult NatsLog::Parts::hold(const BlobId& id, PatienceEnd end) {
  return blobs_.hold(
      id, [this](const BlobId& each) { return is_needed(each); }, end);
}

AppendResult NatsLog::Parts::drop_unused_blobs(bool is_urgent) {
  const auto now = std::chrono::steady_clock::now();
  {
    const std::lock_guard lock(mutex_);
    // The follower does it later.
    must_drop_ = true;
    if (!is_urgent && last_drop_ && now < *last_drop_ + *options_.blob_grace / kDropsPerGrace) {
      return {};
    }
    last_drop_ = now;
    must_drop_ = false;
  }
  const PatienceEnd end = patience_end();
  // What other processes have just appended may need blobs, too.
  Chains chains;
  const auto read = read_all(chains, end);
  if (!read) return append_fault(read.fault, read.error);
  std::set<BlobId> roots;
  for (const auto& [name, chain] : chains) {
    if (!chain.is_whole()) {
      return {AppendFault::kBroken, damaged("scene '" + name + "' " + chain.fault()).error};
    }
    add_needs(chain, roots);
  }
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(records_, [&](const auto& each) { return !roots.contains(each.first); });
  }
  return blobs_.drop_unused(roots, end);
}

std::uint64_t NatsLog::Parts::highest_removed() const {
  const std::lock_guard lock(mutex_);
  std::uint64_t highest = 0;
  for (const auto& [name, chain] : chains_) highest = std::max(highest, chain.removed());
  return highest;
}

std::vector<std::string> NatsLog::Parts::removals() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> requests;
  for (const auto& [name, chain] : chains_) {
    for (std::string& request : removals_in(removals_text(chain))) {
      requests.push_back(std::move(request));
    }
  }
  return requests;
}

std::uint64_t NatsLog::Parts::position_of(std::string_view scene) const {
  const std::lock_guard lock(mutex_);
  const auto found = chains_.find(scene);
  return found == chains_.end() ? 0 : found->second.last_sequence();
}

}  // namespace camway::scene
