// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "daemon/scene/log/nats/log_message.h"

namespace camway::scene {

/// A message of a scene, and where it stands in the log.
struct ChainLink {
  LogMessage message;
  std::uint64_t sequence = 0;
  bool is_taken = false;  ///< `follow` has passed it on, or `scenes` has returned it
};

/// How a message stands to those before it.
enum class ChainFit : std::uint8_t {
  kFollows,  ///< it follows the newest one, or takes the place of messages that are not there
  kVoid,     ///< another message has followed the same one sooner, so this one does not count
  kGap       ///< one that is not there has to come before
};

/// The messages of one scene that count: from the last summary, removal or beginning on.
///
/// Each message names the one that it follows; of several that follow the same one, the first in
/// the log counts. A server alone would not accept the others, but a cluster of NATS 2.9 does now
/// and then, if they come at once (nats-server issue 4320). A value type. Not thread-safe.
class SceneChain {
 public:
  /// Adds the next message of the log, if it counts. Messages that a summary or removal replaces
  /// may come before it, in part only, since the server may have purged them or lost that it did.
  void take(LogMessage message, std::uint64_t sequence);
  [[nodiscard]] ChainFit fit_of(const LogMessage& message) const;

  /// Where a change does not follow the one before; empty if the chain is whole.
  [[nodiscard]] std::string fault() const;
  [[nodiscard]] bool is_whole() const { return is_whole_; }
  /// The newest revision; 0 if there is no scene, because there is no message or it was removed.
  [[nodiscard]] std::uint64_t newest_revision() const;
  /// Sequence of the last message, also of one that does not count; 0 if there is none.
  [[nodiscard]] std::uint64_t last_sequence() const { return last_sequence_; }
  /// Highest revision at which the scene was removed; 0: never.
  [[nodiscard]] std::uint64_t removed() const { return removed_; }

  [[nodiscard]] const std::vector<ChainLink>& links() const { return links_; }
  [[nodiscard]] std::vector<ChainLink>& links() { return links_; }
  /// Id of the last message that counts; zeros if there is none.
  [[nodiscard]] MessageId newest_id() const {
    return links_.empty() ? MessageId{} : links_.back().message.id;
  }
  /// Whether a message is there, or was replaced by the first one.
  [[nodiscard]] bool contains(const MessageId& id) const;
  [[nodiscard]] ChainLink* find(const MessageId& id);
  [[nodiscard]] const ChainLink* find(const MessageId& id) const;
  /// The ids of all messages, and of those that the first one has replaced, for the message that
  /// replaces them. At most `kMostReplaced`.
  [[nodiscard]] std::vector<MessageId> ids() const;
  /// Marks the messages that `other` has marked, too.
  void mark_as_taken_in(const SceneChain& other);
  void mark_all_as_taken();
  /// Whether `follow` has passed on everything that comes before `link`, which is one of `links()`.
  [[nodiscard]] bool is_next(const ChainLink& link) const;

 private:
  std::vector<ChainLink> links_;
  bool is_whole_ = true;
  std::uint64_t last_sequence_ = 0;
  std::uint64_t removed_ = 0;
};

/// Returns the requests of the removals of a scene (`removal_requests.h`), as the removal that
/// begins the chain has them; empty if none does.
std::string removals_text(const SceneChain& chain);

/// Action if the log of a server differs from what this process has kept.
struct ChainRepair {
  enum class Kind : std::uint8_t {
    kNone,     ///< all that is known is there
    kAppend,   ///< the server lost the links from `first` on
    kRewrite,  ///< the same, and what it has of the scene is of no use
    kDiverged  ///< another change was made in the place of a lost one
  };
  Kind kind = Kind::kNone;
  std::size_t first = 0;  ///< number of a link
};
ChainRepair repair_of(const SceneChain& known, const SceneChain& found);

}  // namespace camway::scene
