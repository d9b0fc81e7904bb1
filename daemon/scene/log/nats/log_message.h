// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/result.h"
#include "daemon/scene/log/scene_log.h"

namespace camway::scene {

/// Names a message of the log, however often it is sent.
using MessageId = std::array<std::byte, 16>;
/// Returns an id that no other process and no other call returns.
MessageId new_message_id();

/// A message about a scene in the log of a fleet.
struct LogMessage {
  enum class Kind : std::uint8_t {
    kEntry,    ///< a change
    kSummary,  ///< takes the place of all messages before
    kRemoval   ///< removes the scene; takes the place of all messages before
  };
  Kind kind = Kind::kEntry;
  MessageId id{};
  MessageId after{};                ///< the message of the scene that it follows; zeros: none
  std::uint64_t before = 0;         ///< as in `LogEntry`; of an entry only
  std::uint64_t revision = 0;       ///< that is made, summarised or removed
  std::uint64_t removed = 0;        ///< highest revision at which this scene was removed; 0: never
  std::vector<MessageId> replaces;  ///< the last messages before a summary or a removal
  std::vector<BlobId> needs;        ///< blobs that the record names
  std::optional<BlobId> blob;       ///< holds the record, if it does not fit into a message
  Bytes record;                     ///< empty if `blob` is set
};

/// Number of messages that a summary or removal remembers: more than DurableScenes lets a scene
/// have.
inline constexpr std::size_t kMostReplaced = 512;

Bytes bytes_of(const LogMessage& message);
/// Reads a message, whatever the bytes are. Fails if they are none.
base::Result<LogMessage> log_message_from(std::span<const std::byte> bytes);

/// Content of the last message of a blob, its part 0.
struct BlobHead {
  std::uint64_t bytes = 0;  ///< size of the blob
  std::uint32_t parts = 0;  ///< messages that hold them; 0 if `content` does
  std::vector<BlobId> needs;
  Bytes content;  ///< of a small blob
};

Bytes bytes_of(const BlobHead& head);
/// Reads a head, whatever the bytes are. Fails if they are none.
base::Result<BlobHead> blob_head_from(std::span<const std::byte> bytes);

/// Returns a text as a part of a subject: its bytes in hexadecimal digits, "_" for none.
std::string token_of(std::string_view text);
/// Reads such a part. Nothing if it is none.
std::optional<std::string> text_from_token(std::string_view token);
std::string token_of(const BlobId& id);
std::optional<BlobId> blob_id_from_token(std::string_view token);

}  // namespace camway::scene
