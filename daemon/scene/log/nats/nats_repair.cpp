// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "daemon/scene/log/nats/nats_log_parts.h"

namespace camway::scene {
namespace {

using nats::StreamFault;

std::span<const std::uint8_t> payload_of_link(const Bytes& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

std::string changes_words(std::size_t count) {
  return count == 1 ? "the last change" : "the last " + std::to_string(count) + " changes";
}

}  // namespace

bool NatsLog::Parts::is_tail_checked() const {
  return !must_check_ && checked_generation_ == connection_.generation();
}

std::string NatsLog::Parts::check_tail(PatienceEnd end) {
  if (is_tail_checked()) return "";
  {
    std::unique_lock lock(check_mutex_);
    const bool is_my_turn = check_done_.wait_for(lock, end - std::chrono::steady_clock::now(),
                                                 [this] { return !is_checking_; });
    if (!is_my_turn) return "its last changes are still being verified";
    if (is_tail_checked()) return "";
    is_checking_ = true;
  }
  std::string fault;
  do {
    fault = check_now(end);
  } while ((!fault.empty() || !is_tail_checked()) && connection_.stall().empty() &&
           pause_before_retry(end));
  if (fault.empty() && !is_tail_checked()) fault = "the connection to NATS was lost";
  const std::lock_guard lock(check_mutex_);
  is_checking_ = false;
  check_done_.notify_all();
  return fault;
}

std::string NatsLog::Parts::check_now(PatienceEnd end) {
  // Set anew if this fails, or by anyone who finds a reason meanwhile.
  must_check_ = false;
  const std::uint64_t generation = connection_.generation();
  std::string fault = stream_->ensure_again(rest_of(end));
  if (fault.empty()) fault = blobs_.repair(end);
  // Before the changes that need them, so that nobody finds those without.
  if (fault.empty()) fault = repair_contents(end);
  Chains known;
  {
    const std::lock_guard lock(mutex_);
    known = chains_;
  }
  Chains found;
  if (fault.empty()) {
    const auto read = read_all(found, end);
    if (!read) fault = read.error;
  }
  for (const auto& [scene, chain] : found) known.try_emplace(scene);
  for (auto& [scene, chain] : known) {
    if (fault.empty()) fault = repair(scene, std::move(chain), std::move(found[scene]), end);
  }
  // Others may have made changes that this process did not know.
  if (fault.empty()) fault = repair_contents(end);
  if (!fault.empty()) {
    must_check_ = true;
    return fault;
  }
  checked_generation_ = generation;
  must_read_again_ = true;
  wake_follower();
  return "";
}

std::string NatsLog::Parts::repair(const std::string& scene, SceneChain known, SceneChain found,
                                   PatienceEnd end) {
  for (;;) {
    const ChainRepair repair = repair_of(known, found);
    if (repair.kind == ChainRepair::Kind::kDiverged) {
      warn("NATS has lost changes of scene '" + scene + "' up to revision " +
           std::to_string(known.newest_revision()) +
           ", and others were made in their place, which count now");
    }
    if (repair.kind == ChainRepair::Kind::kNone && !found.is_whole()) {
      warn(damaged("scene '" + scene + "' " + found.fault()).error);
    }
    bool is_done = true;
    if (repair.kind == ChainRepair::Kind::kAppend || repair.kind == ChainRepair::Kind::kRewrite) {
      std::string fault = append_again(scene, repair, known, found, is_done, end);
      if (!fault.empty()) return fault;
    }
    if (is_done && adopt(scene, known.newest_id(), found)) return "";
    // Another process repairs the same, or this one has made a change meanwhile.
    if (!pause_before_retry(end)) return "scene '" + scene + "' is being repaired";
    {
      const std::lock_guard lock(mutex_);
      known = chains_[scene];
    }
    auto again = read_scene(scene, end);
    if (!again) return again.error;
    found = *std::move(again);
  }
}

std::string NatsLog::Parts::append_again(const std::string& scene, const ChainRepair& repair,
                                         const SceneChain& known, SceneChain& found, bool& is_done,
                                         PatienceEnd end) {
  if (repair.kind == ChainRepair::Kind::kRewrite) {
    const auto purged =
        stream_->purge(scene_subject(scene), found.last_sequence() + 1, rest_of(end));
    if (!purged) return purged.error;
    found = {};
  }
  const std::vector<ChainLink>& links = known.links();
  for (std::size_t i = repair.first; i < links.size(); ++i) {
    const Bytes bytes = bytes_of(links[i].message);
    const auto done = stream_->publish(scene_subject(scene), payload_of_link(bytes),
                                       found.last_sequence(), rest_of(end));
    if (done.fault == StreamFault::kUnreachable) return done.error;
    if (done.fault == StreamFault::kConflict) {
      is_done = false;
      return "";
    }
    if (!done) {
      warn("NATS has lost changes of scene '" + scene + "' after revision " +
           std::to_string(found.newest_revision()) + ", which cannot be kept again: " + done.error);
      return "";
    }
    found.take(links[i].message, *done);
  }
  // A cluster may have accepted what another process has appended at once.
  is_done = options_.replicas == 1;
  warn("NATS had lost " + changes_words(links.size() - repair.first) + " of scene '" + scene +
       "', up to revision " + std::to_string(known.newest_revision()) + ", kept again now");
  return "";
}

}  // namespace camway::scene
