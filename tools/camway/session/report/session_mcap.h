// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "tools/camway/replay/session.h"

namespace camway::tools {

/// Returns a session as MCAP, for Foxglove: `/camway/requested` has the keyframes of each request,
/// `/camway/keyframes` and `/camway/path` those of the answer and its path, 24 poses a second and
/// at most `kMostSessionPoses` (`foxglove.PosesInFrame`); `/camway/log` has the answers' sentences
/// (`foxglove.Log`); `/camway/answers` has the numbers of `session_csv`, to be plotted. Times are
/// those of the log, and count from its begin where they are none since 1970.
std::string session_mcap(const Session& session);

/// A path of more has as many poses, evenly in time.
inline constexpr int kMostSessionPoses = 1000;

}  // namespace camway::tools
