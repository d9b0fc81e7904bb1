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

/// What became of a path that the daemon watches.
struct WatchEvent {
  enum class Kind {
    kAnswer,  ///< an answer came: the first, a corrected one, or one after a restart of the daemon
    kBroken,  ///< a change of the scene: the path of the last answer collides now, as `broken` says
    kFree,    ///< the path that was broken is proved free again, as it was answered
    /// Nobody watches for now, as `status` and `error` say: told once, within 3.5 s after the
    /// daemon fell silent. The client goes on trying, and the next event says what came of it.
    kLost,
    kWatched,  ///< after kLost: watched again, and what was said last before that holds still
    kEnded,    ///< the answer before proves no path, so there is nothing to watch
    /// What a path was broken by is gone, wholly or in part, and `answer` has a better one by the
    /// request's own objective. The one before is watched on until `Client::take_better`, whose
    /// outcome is kAnswer.
    kBetter,
    kWithdrawn,  ///< the better path is not on offer any more: a change of the scene broke it
  };
  Kind kind = Kind::kLost;
  std::int64_t request_id = 0;
  std::int64_t scene_revision = 0;        ///< that it holds for; 0 if the scene is gone
  std::vector<CollisionInterval> broken;  ///< without witnesses
  std::optional<PlanResponse> answer;     ///< with kAnswer, look at its status; and with kBetter
  /// With kLost, why: `kNoDaemon` if no daemon is heard, else e.g. `kLimit` or `kOverloaded`.
  Status status = Status::kOk;
  std::string error;
};

/// Called on the client's own thread: quick things, that do not wait for the client.
using WatchHandler = std::function<void(const WatchEvent&)>;

}  // namespace camway
