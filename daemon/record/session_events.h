// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/scene/log/scene_log.h"
#include "daemon/scene/log/shared_log.h"

/// The events that a recording has beside the messages: the daemon and its settings, the scenes,
/// and omissions. They have a channel of their own, which is never on the network.
namespace camway::record {

/// Returns the channel of these events: "CAMWAY_SESSION" for the prefix "CAMWAY".
std::string session_channel(std::string_view prefix);

/// Begins each file. The scenes follow as they are then, so that a file needs no other one.
struct FileBegin {
  std::string recording;   ///< its id: chosen at random at each start of the daemon
  std::uint64_t part = 1;  ///< number of the file in the recording
  std::string version;     ///< build of the daemon
  /// Settings by their keys, and the arguments of configured scenes, for people. No secrets.
  std::map<std::string, std::string> settings = {};
};

/// A change of a scene; comes before all answers that name its revision.
struct SceneUpdate {
  scene::LogUpdate update;
  std::string digest;  ///< of the scene after the change; empty for a removal
};

/// Events that are missing in the recording.
struct Omission {
  std::int64_t from_utime = 0;  ///< time of the first message that is missing
  std::int64_t to_utime = 0;    ///< time of the last message that is missing
  std::uint64_t messages = 0;
  std::uint64_t changes = 0;  ///< of scenes; all scenes follow, as they are afterwards
  std::string reason;
};

using SessionEvent = std::variant<FileBegin, SceneUpdate, Omission>;

std::vector<std::uint8_t> bytes_of(const SessionEvent& event);
/// Reads an event, whatever the bytes are. Fails if they are none.
base::Result<SessionEvent> session_event_from(std::span<const std::uint8_t> bytes);

/// Returns a digest as 64 hexadecimal digits, which is the name of the file of a blob.
std::string hex_of(const scene::BlobId& id);
/// Returns whether a name is that of the file of a blob.
bool is_blob_name(std::string_view name);

}  // namespace camway::record
