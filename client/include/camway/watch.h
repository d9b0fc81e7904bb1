// SPDX-License-Identifier: MIT
#pragma once

#include <camway/plan.h>
#include <camway/status.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace camway {

/// An event of a path that the daemon watches.
struct WatchEvent {
  enum class Kind {
    /// A new answer: the first, a corrected one, or one after a restart of the daemon. Check its
    /// status.
    kAnswer,
    /// A change of the scene makes the watched path collide, as `broken` says. The event comes
    /// again only if `broken` differs, or after kLost. An answer without a proved path leaves the
    /// path watched and broken.
    kBroken,
    kFree,  ///< a broken path is proved free again, unchanged
    /// The path is not watched for now; `status` and `error` say why. This event comes once. If the
    /// daemon falls silent, it comes within 3.5 s. The client keeps trying; the next event of this
    /// path has the result. With `kOldScene`, a daemon that was started anew has forgotten changes
    /// of the scene: the path stays lost unless the scene gets the content that it had. Make the
    /// changes again, and watch the path anew.
    kLost,
    kWatched,  ///< after kLost: watched again; the last event before kLost still holds
    /// The watch has ended. `error` has the reason: for example, the answer has no proved path.
    kEnded,
    /// An obstacle is gone at least in part, and `answer` has a path that is better by the
    /// request's objective. The present path stays watched; `Client::take_better` changes over.
    kBetter,
    kWithdrawn,  ///< the better path is no longer offered: a change of the scene broke it
    /// The daemon was started anew. The path is asked for again, and the next event has the result:
    /// kAnswer, or kLost with `kOldScene` if the daemon has forgotten changes of the scene.
    kRestarted,
  };
  Kind kind = Kind::kLost;
  std::int64_t request_id = 0;
  std::int64_t scene_revision = 0;        ///< revision that the event holds for; 0: scene is gone
  std::vector<CollisionInterval> broken;  ///< kBroken: all collisions, without witnesses
  std::optional<PlanResponse> answer;     ///< set with kAnswer and kBetter
  /// kLost: `kNoDaemon` if no daemon is heard, otherwise the refusal, such as `kLimit` or
  /// `kOverloaded`. kEnded: the status of the answer without a proved path, or the reason if the
  /// request could not be sent. All other events: kOk.
  Status status = Status::kOk;
  std::string error;  ///< kLost, kEnded: the reason
};

/// Callback of `Client::watch`. It runs on the client's own thread, so it must be quick and must
/// not call a blocking member of the client. Exceptions are ignored there.
using WatchHandler = std::function<void(const WatchEvent&)>;

}  // namespace camway
