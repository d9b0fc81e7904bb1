// SPDX-License-Identifier: MIT
#pragma once

/// When a watching client counts a silent daemon as gone.
namespace camway {

/// A daemon sends a heartbeat once a second, or as often as its status.period_s says. When one is
/// missing, the client asks the daemon for a sign of life, so that neither lost messages nor a
/// longer period count as silence. Without any for the time of three heartbeats the daemon counts
/// as gone.
inline constexpr double kPingAfter_s = 1.3;
inline constexpr double kPingAgain_s = 0.4;
inline constexpr double kSilence_s = 3.25;

/// Longest time between two steps of the engine, which are at most 1 s apart. Any longer time was
/// spent in a handler or while the process was suspended, and does not count as silence.
inline constexpr double kLongestStep_s = 1.2;

}  // namespace camway
