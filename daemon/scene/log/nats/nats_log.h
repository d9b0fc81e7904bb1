// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/nats/connection.h"
#include "daemon/scene/log/shared_log.h"

namespace camway::scene {

struct NatsLogOptions {
  std::string fleet = "camway";  ///< begins the names of streams and subjects [Limit: a plain name]
  /// Servers of a cluster that keep each message; the same in all processes. [Limit: 1, 3 or 5]
  int replicas = 1;
  std::uint64_t most_bytes = 0;  ///< of each of the two streams; 0: as the server allows
  /// How long an append waits for the server, through lost connections, before it gives up.
  std::chrono::milliseconds patience{5'000};
  /// Blobs that nothing names are kept for this long, because another process may be about to name
  /// them. Unset: four times the patience and ten seconds, which is longer than a change may take.
  std::optional<std::chrono::milliseconds> blob_grace;
  /// Blobs that were put are kept here for this long, because the server may lose them until it has
  /// synced its files.
  std::chrono::milliseconds recent_time{5 * 60'000};
  /// Called when the log repairs or cannot repair something, with a sentence for the user. May be
  /// empty. Called on any thread.
  std::function<void(const std::string&)> warn;
};

/// The log of a fleet, in two streams of NATS JetStream (docs/design/scenes.md).
///
/// Stream `<fleet>_LOG`, subjects `<fleet>.log.scene.<hex of the name>`: the entries, summaries and
/// removals of a scene, in order. An append expects the last sequence of its subject, and names the
/// message that it follows, so two processes cannot both append to one revision. A summary is
/// appended, and what stands before it is purged. `<fleet>.log.note.<hex of the key>`: notes, the
/// last one counts. `<fleet>.news.>` tells that a message was stored.
///
/// Stream `<fleet>_BLOBS`, one message for each subject: `<fleet>.blob.<SHA-256>.<part>`. Part 0
/// says what the blob needs and how many parts there are, or holds a small blob; it is written
/// last, so a blob with part 0 is whole. Records that do not fit into a message are blobs, too.
///
/// A server that syncs its files every two minutes only (NATS 2.9) loses the last changes if its
/// machine loses power. So each process keeps the entries since the last summary, the blobs of the
/// last five minutes that it put, and the notes that it set; other blobs it makes again of the
/// scenes that it has (`on_lost_blob`). When it finds that the log has lost some of that, it puts
/// them there again. Then positions may be lower than before.
///
/// `<fleet>.log.reserve.<piece>` are messages that are deleted where a limit is reached, so that
/// removals and summaries are possible (`nats_reserve.h`).
class NatsLog final : public SharedLog {
 public:
  /// Makes the streams, or uses those that are there. `connection` must outlive it. Fails if the
  /// server has no JetStream, refuses, or has streams of another layout.
  static base::Result<std::unique_ptr<NatsLog>> open(nats::Connection& connection,
                                                     const NatsLogOptions& options);
  ~NatsLog() override;

  AppendResult put_blob(const BlobId& id, const Blob& blob) override;
  [[nodiscard]] bool has_blob(const BlobId& id) override;
  base::Result<Bytes> blob(const BlobId& id) override;
  AppendResult append(std::string_view scene, const LogEntry& entry) override;
  AppendResult summarize(std::string_view scene, std::uint64_t revision, const Bytes& summary,
                         const std::vector<BlobId>& needs) override;
  AppendResult remove(std::string_view scene, std::uint64_t revision,
                      std::string_view request = {}) override;
  [[nodiscard]] std::uint64_t highest_removed() override;
  /// Those of a scene are forgotten with the first summary of a later scene of its name.
  [[nodiscard]] std::vector<std::string> removals() override;
  base::Result<std::vector<LoggedScene>> scenes() override;
  [[nodiscard]] std::string note(std::string_view key) override;
  AppendResult set_note(std::string_view key, std::string_view text) override;
  base::Result<std::map<std::string, std::string>> notes(std::string_view prefix) override;
  bool catch_up(std::chrono::milliseconds patience) override;
  AppendResult drop_unused_blobs() override;
  void on_lost_blob(LostBlob find) override;
  [[nodiscard]] bool lacks_blobs_of(std::string_view scene) override;

  AppendResult drop(std::string_view scene) override;
  void follow(Take take) override;
  void stop_following() override;
  [[nodiscard]] std::uint64_t followed() const override;
  [[nodiscard]] std::uint64_t position_of(std::string_view scene) const override;
  [[nodiscard]] bool is_in_touch() const override;

 private:
  class Parts;
  explicit NatsLog(std::unique_ptr<Parts> parts);

  const std::unique_ptr<Parts> parts_;
};

}  // namespace camway::scene
