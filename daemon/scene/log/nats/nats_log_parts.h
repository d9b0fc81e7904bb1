// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "daemon/scene/log/nats/nats_blobs.h"
#include "daemon/scene/log/nats/nats_log.h"
#include "daemon/scene/log/nats/nats_reserve.h"
#include "daemon/scene/log/nats/scene_chain.h"

namespace camway::scene {

/// The scenes of a log, by name.
using SceneChains = std::map<std::string, SceneChain, std::less<>>;

/// Scenes of which blobs are lost, and how many.
using LostBlobs = std::map<std::string, std::size_t, std::less<>>;

/// Knowledge of blobs while they are repaired.
struct BlobRepair {
  std::set<BlobId> there;           ///< at the server
  std::map<BlobId, bool> is_whole;  ///< whether a blob and all that it needs are there
  std::set<BlobId> lost;
  std::size_t repaired = 0;
};

/// What is behind `NatsLog`: `nats_log.cpp` opens and reads, `nats_appends.cpp` appends,
/// `nats_follow.cpp` follows, `nats_repair.cpp` finds out after each loss of the connection whether
/// the server has lost changes, and `nats_lost.cpp` the same of blobs and notes. Thread-safe.
class NatsLog::Parts {
 public:
  Parts(nats::Connection& connection, NatsLogOptions options, std::unique_ptr<nats::Stream> stream,
        std::unique_ptr<nats::Stream> blob_stream);
  ~Parts();
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  [[nodiscard]] PatienceEnd patience_end() const {
    return std::chrono::steady_clock::now() + options_.patience;
  }
  NatsBlobs& blobs() { return blobs_; }

  // nats_log.cpp
  base::Result<std::vector<LoggedScene>> scenes();
  std::string note(std::string_view key);
  AppendResult set_note(std::string_view key, std::string_view text);
  base::Result<std::map<std::string, std::string>> notes(std::string_view prefix);
  /// Drops blobs if that is due; if `is_urgent`, in any case.
  AppendResult drop_unused_blobs(bool is_urgent);
  [[nodiscard]] std::uint64_t highest_removed() const;
  [[nodiscard]] std::vector<std::string> removals() const;
  [[nodiscard]] std::uint64_t position_of(std::string_view scene) const;
  [[nodiscard]] NatsBlobs::HoldResult hold(const BlobId& id, PatienceEnd end);

  // nats_appends.cpp
  AppendResult append(std::string_view scene, const LogEntry& entry);
  AppendResult summarize(std::string_view scene, std::uint64_t revision, const Bytes& summary,
                         const std::vector<BlobId>& needs);
  AppendResult remove(std::string_view scene, std::uint64_t revision, std::string_view request);
  AppendResult drop(std::string_view scene);
  AppendResult put_blob(const BlobId& id, const Blob& blob, PatienceEnd end);

  // nats_lost.cpp
  void on_lost_blob(SceneLog::LostBlob find);
  [[nodiscard]] bool lacks_blobs_of(std::string_view scene) const;

  // nats_follow.cpp
  void follow(SharedLog::Take take);
  void stop_following();
  [[nodiscard]] std::uint64_t followed() const { return followed_; }
  [[nodiscard]] bool is_in_touch() const;
  bool catch_up(std::chrono::milliseconds patience);

 private:
  using Chains = SceneChains;

  [[nodiscard]] std::string place() const;
  [[nodiscard]] std::string scene_subject(std::string_view scene) const;
  [[nodiscard]] std::string scene_filter() const;
  [[nodiscard]] std::string note_filter() const;
  [[nodiscard]] std::string note_subject(std::string_view key) const;
  void warn(const std::string& sentence) const;

  /// Reads messages of the log into chains. Returns the sequence up to which it has read. A message
  /// that is none makes the fault `kRefused`.
  nats::StreamResult<std::uint64_t> read_chains(const std::string& filter, std::uint64_t from,
                                                Chains& chains, PatienceEnd end);
  /// Reads a scene anew, as long as a change is missing that a purge may just have removed.
  nats::StreamResult<SceneChain> read_scene(const std::string& scene, PatienceEnd end);
  /// Reads all scenes; a chain that is not whole is damaged.
  nats::StreamResult<std::uint64_t> read_all(Chains& chains, PatienceEnd end);
  /// Puts what was read in the place of what is known, if `newest` is still the newest message that
  /// is known. Returns whether it was.
  bool adopt(const std::string& scene, const MessageId& newest, SceneChain chain);
  [[nodiscard]] base::Failure damaged(const std::string& what) const;
  base::Result<Bytes> record_of(const LogMessage& message, PatienceEnd end);
  base::Result<LoggedScene> logged(const std::string& name, const SceneChain& chain,
                                   PatienceEnd end);
  [[nodiscard]] bool is_needed(const BlobId& id) const;

  /// Facts about a scene that an append needs.
  struct Head {
    std::uint64_t revision = 0;
    std::uint64_t sequence = 0;
    std::uint64_t removed = 0;
    MessageId newest{};
    bool has_it = false;  ///< the message is there already
  };
  Head head_of(std::string_view scene, const MessageId& id) const;
  [[nodiscard]] std::vector<MessageId> known_ids(std::string_view scene) const;
  /// Appends a message to a scene whose newest revision is `expected`.
  AppendResult commit(std::string_view scene, std::uint64_t expected, LogMessage message,
                      PatienceEnd end);
  /// Verifies what an append requires, and puts the record into the message.
  AppendResult prepare(std::string_view scene, std::uint64_t expected, LogMessage& message,
                       const Bytes& record, PatienceEnd end);
  /// Appends a message that takes the place of all before, and purges those.
  AppendResult replace_all(std::string_view scene, LogMessage message, const Bytes& record);
  /// Releases a piece of the reserve if that helps a message that was refused. Returns whether to
  /// try again.
  bool may_make_room(const LogMessage& message, const AppendResult& fault, PatienceEnd end);
  AppendResult missing_need(const std::vector<BlobId>& needs, PatienceEnd end);
  /// Looks at the server for what it has of a scene that is not known.
  std::string refresh(const std::string& scene, PatienceEnd end);
  /// Sends a message that follows `head`.
  nats::StreamResult<std::uint64_t> send(std::string_view scene, const Head& head,
                                         LogMessage& message, PatienceEnd end);
  struct SendFault {
    nats::StreamFault fault = nats::StreamFault::kNone;
    std::string error;
  };
  /// Returns the result of an append whose message failed; nothing if it is to be sent again.
  std::optional<AppendResult> failure_of(const LogMessage& message, const SendFault& fault,
                                         bool& may_be_sent, PatienceEnd end);
  void purge_before_last(std::string_view scene, const MessageId& id, PatienceEnd end);
  [[nodiscard]] AppendResult conflict(std::string_view scene, std::uint64_t newest,
                                      std::uint64_t expected) const;
  /// The result of an append that got no answer, or none that counts.
  [[nodiscard]] AppendResult given_up(const std::string& reason, bool may_be_sent) const;
  /// Adds a message to what is known, unless the follower did.
  void take_own(std::string_view scene, LogMessage message, std::uint64_t sequence);

  /// Returns once the server has all that this process knows to be kept, or why that is not known.
  std::string check_tail(PatienceEnd end);
  [[nodiscard]] bool is_tail_checked() const;
  std::string check_now(PatienceEnd end);
  std::string repair(const std::string& scene, SceneChain known, SceneChain found, PatienceEnd end);
  /// Appends what the server lost, also to `found`. Sets `is_done` to false if another process was
  /// sooner.
  std::string append_again(const std::string& scene, const ChainRepair& repair,
                           const SceneChain& known, SceneChain& found, bool& is_done,
                           PatienceEnd end);

  /// The blobs that a chain names.
  static void add_needs(const SceneChain& chain, std::set<BlobId>& needs);
  /// Keeps a record that is a blob, since nobody else could make it again.
  void keep_record(const BlobId& id, const Bytes& record);
  /// A blob that this process has, or can make again.
  std::optional<Blob> blob_again(const BlobId& id);
  /// Puts the blobs and notes again that the server has lost. Returns why that is not possible now.
  std::string repair_contents(PatienceEnd end);
  /// Puts all blobs again that these need, as far as they are known here. Returns whether all are
  /// there then.
  nats::StreamResult<bool> repair_blobs(const std::set<BlobId>& roots, BlobRepair& repair,
                                        PatienceEnd end);
  /// Notes which blobs nobody has, and tells the user if that has changed.
  void note_lost(const LostBlobs& lost);
  std::string repair_notes(PatienceEnd end);
  /// Does the tasks that are due from time to time, once all is read.
  void keep_house();

  void run_follower();
  /// Reads what is new. Returns whether all was read.
  bool follow_once();
  void take_message(const nats::StoredMessage& stored);
  /// Calls `take_` if the update is new and its turn has come. Returns false if it has to come
  /// again.
  bool pass_on(const std::string& scene, LogMessage message, std::uint64_t sequence);
  void look_for_losses();
  /// Tells the user once that the server does not answer for its streams, and once that it does
  /// again. Returns whether it does.
  bool is_not_stalled();
  void warn_of_damage(const std::string& scene, const std::string& what);
  /// Returns false when the follower has to end.
  bool wait_for_news(std::chrono::milliseconds most);
  void wake_follower();
  std::uint64_t begin_pass();
  void end_pass(std::uint64_t pass, bool has_read_all);
  bool is_stopped();

  nats::Connection& connection_;
  const NatsLogOptions options_;
  const std::unique_ptr<nats::Stream> stream_;
  NatsBlobs blobs_;
  NatsReserve reserve_;

  mutable std::mutex mutex_;  ///< guards what follows; not held while a server is asked
  Chains chains_;
  std::optional<std::chrono::steady_clock::time_point> last_drop_;
  bool must_drop_ = false;
  std::chrono::steady_clock::time_point read_all_at_{};  ///< when the follower has read all
  std::map<BlobId, std::shared_ptr<const Bytes>> records_;
  struct Note {
    std::string text;
    std::uint64_t sequence = 0;
  };
  std::map<std::string, Note> notes_;  ///< that this process has set
  LostBlobs lost_;                     ///< scenes with blobs that nobody has, and how many

  std::mutex lost_blob_mutex_;  ///< guards lost_blob_, also while it runs
  SceneLog::LostBlob lost_blob_;

  std::mutex check_mutex_;  ///< guards is_checking_
  std::condition_variable check_done_;
  bool is_checking_ = false;  ///< one thread checks the tail: appends and the follower wait for it
  /// Number of the connection for which the tail was checked.
  std::atomic<std::uint64_t> checked_generation_;
  std::atomic<bool> must_check_ = false;

  std::atomic<std::uint64_t> followed_ = 0;
  std::atomic<bool> has_read_all_ = false;
  SharedLog::Take take_;
  std::mutex news_mutex_;  ///< guards what follows
  std::condition_variable news_;
  bool has_news_ = false;
  bool is_following_ = false;
  // The follower reads the log again and again, from where it is to the end.
  std::uint64_t passes_begun_ = 0;
  std::uint64_t last_whole_pass_ = 0;  ///< the last one that came to the end
  bool is_stopped_ = false;
  std::atomic<bool> must_read_again_ = false;  ///< from the first message on
  // The next ones belong to the follower's thread.
  std::uint64_t next_sequence_ = 1;
  bool is_interrupted_ = false;  ///< the next messages have to be read again
  std::chrono::steady_clock::time_point last_look_{};
  std::chrono::steady_clock::time_point last_care_{};
  bool was_stalled_ = false;       ///< the user was told
  std::set<std::string> gaps_;     ///< scenes with a change that does not follow the one before
  std::set<std::string> damaged_;  ///< scenes of which the user was told
  std::unique_ptr<nats::Subscription> subscription_;
  std::thread follower_;
};

}  // namespace camway::scene
