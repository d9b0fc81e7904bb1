// SPDX-License-Identifier: MIT
#include "daemon/scene/log/nats/scene_chain.h"

#include <algorithm>
#include <utility>

namespace camway::scene {
namespace {

using Kind = LogMessage::Kind;

/// The revision of a scene after a message.
std::uint64_t revision_after(const LogMessage& message) {
  return message.kind == Kind::kRemoval ? 0 : message.revision;
}

}  // namespace

void SceneChain::take(LogMessage message, std::uint64_t sequence) {
  last_sequence_ = std::max(last_sequence_, sequence);
  const ChainFit fit = fit_of(message);
  if (fit == ChainFit::kVoid) return;
  if (ChainLink* const known = find(message.id)) {
    known->sequence = sequence;
    return;
  }
  removed_ = std::max(removed_, message.removed);
  if (message.kind == Kind::kRemoval) removed_ = std::max(removed_, message.revision);
  if (message.kind != Kind::kEntry) {
    links_.clear();
    is_whole_ = true;
  }
  if (fit == ChainFit::kGap) is_whole_ = false;
  links_.push_back({std::move(message), sequence, false});
}

ChainFit SceneChain::fit_of(const LogMessage& message) const {
  if (find(message.id) != nullptr) return ChainFit::kFollows;
  const bool is_entry = message.kind == Kind::kEntry;
  if (message.after == newest_id()) {
    return !is_entry || message.before == newest_revision() ? ChainFit::kFollows : ChainFit::kGap;
  }
  // The beginning has been followed if there is anything.
  if (contains(message.after) || (message.after == MessageId{} && !links_.empty())) {
    return ChainFit::kVoid;
  }
  return is_entry ? ChainFit::kGap : ChainFit::kFollows;
}

std::string SceneChain::fault() const {
  if (is_whole_) return "";
  const LogMessage* last = nullptr;
  for (const ChainLink& link : links_) {
    const LogMessage& message = link.message;
    const std::uint64_t revision = last == nullptr ? 0 : revision_after(*last);
    const MessageId id = last == nullptr ? MessageId{} : last->id;
    if (message.kind == Kind::kEntry && (message.after != id || message.before != revision)) {
      return "lost its changes after revision " + std::to_string(revision) + " until revision " +
             std::to_string(message.before) + ", before message " + std::to_string(link.sequence);
    }
    last = &message;
  }
  return "lost changes";
}

std::uint64_t SceneChain::newest_revision() const {
  return links_.empty() ? 0 : revision_after(links_.back().message);
}

bool SceneChain::contains(const MessageId& id) const {
  if (find(id) != nullptr) return true;
  return !links_.empty() && std::ranges::count(links_.front().message.replaces, id) > 0;
}

ChainLink* SceneChain::find(const MessageId& id) {
  return const_cast<ChainLink*>(std::as_const(*this).find(id));
}

const ChainLink* SceneChain::find(const MessageId& id) const {
  const auto found =
      std::ranges::find_if(links_, [&](const ChainLink& link) { return link.message.id == id; });
  return found == links_.end() ? nullptr : &*found;
}

std::vector<MessageId> SceneChain::ids() const {
  std::vector<MessageId> ids;
  if (!links_.empty()) ids = links_.front().message.replaces;
  for (const ChainLink& link : links_) ids.push_back(link.message.id);
  const std::size_t too_many = ids.size() - std::min(ids.size(), kMostReplaced);
  ids.erase(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(too_many));
  return ids;
}

void SceneChain::mark_as_taken_in(const SceneChain& other) {
  std::set<MessageId> taken;
  for (const ChainLink& link : other.links_) {
    if (link.is_taken) taken.insert(link.message.id);
  }
  for (ChainLink& link : links_) link.is_taken = link.is_taken || taken.contains(link.message.id);
}

void SceneChain::mark_all_as_taken() {
  for (ChainLink& link : links_) link.is_taken = true;
}

bool SceneChain::is_next(const ChainLink& link) const {
  return &link == links_.data() || (&link - 1)->is_taken;
}

std::string removals_text(const SceneChain& chain) {
  if (chain.links().empty()) return "";
  const LogMessage& first = chain.links().front().message;
  if (first.kind != LogMessage::Kind::kRemoval) return "";
  const auto* const text = reinterpret_cast<const char*>(first.record.data());
  return {text, first.record.size()};
}

ChainRepair repair_of(const SceneChain& known, const SceneChain& found) {
  using Repair = ChainRepair::Kind;
  const std::vector<ChainLink>& links = known.links();
  if (links.empty() || !known.is_whole()) return {};
  if (found.is_whole() && found.contains(links.back().message.id)) return {};
  if (found.links().empty()) return {Repair::kAppend, 0};
  if (!found.is_whole()) return {Repair::kRewrite, 0};
  const MessageId& head = found.links().back().message.id;
  const auto at =
      std::ranges::find_if(links, [&](const ChainLink& link) { return link.message.id == head; });
  if (at != links.end()) {
    return {Repair::kAppend, static_cast<std::size_t>(at - links.begin()) + 1};
  }
  // The server has lost all that is known, back to what a summary or removal has replaced.
  if (known.contains(head)) return {Repair::kAppend, 0};
  return {Repair::kDiverged, 0};
}

}  // namespace camway::scene
