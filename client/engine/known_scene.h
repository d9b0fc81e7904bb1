// SPDX-License-Identifier: MIT
#pragma once

#include <camway/status.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

namespace camway {

/// Remembers what a client heard of the scene of a watched path, to find out whether a daemon that
/// was started anew has forgotten changes.
///
/// Revisions of a daemon that forgets are counted anew, so that an equal or larger one says
/// nothing: only an equal digest does. A digest comes with answers alone. If a newer revision than
/// that of the last answer was heard of, nothing tells whether a scene has what that one had.
class KnownScene {
 public:
  /// Takes the scene that an answer holds for.
  void take_answer(const DaemonStart& start, std::int64_t revision, std::string digest) {
    newest_revision_ = start.id == start_id_ ? std::max(newest_revision_, revision) : revision;
    start_id_ = start.id;
    answer_revision_ = revision;
    answer_digest_ = std::move(digest);
  }
  /// Takes a revision that a daemon was heard to have. Of other starts than that of the answer none
  /// counts.
  void hear(const DaemonStart& start, std::int64_t revision) {
    if (start.id == start_id_) newest_revision_ = std::max(newest_revision_, revision);
  }
  [[nodiscard]] std::int64_t newest_revision() const { return newest_revision_; }

  /// Returns whether the revisions of that daemon continue those of the answer.
  [[nodiscard]] bool is_continued_by(const DaemonStart& start) const {
    return start.durable || start.id == start_id_;
  }
  /// Returns whether the scene of another answer lacks nothing that was heard of.
  [[nodiscard]] bool has_all(const DaemonStart& start, const std::string& digest) const {
    return is_continued_by(start) ||
           (newest_revision_ == answer_revision_ && digest == answer_digest_);
  }

 private:
  std::int64_t start_id_ = 0;  ///< of the daemon that gave the answer
  std::int64_t newest_revision_ = 0;
  std::int64_t answer_revision_ = 0;
  std::string answer_digest_;
};

}  // namespace camway
