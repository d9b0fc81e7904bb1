// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

/// Texts of messages, and of logs about them. Functions without state.
/// Thread-safe.
namespace camway::messages {

/// The name of a number that is no status.
inline constexpr std::string_view kUnknownStatus = "unknown status";

/// Returns the name of a status of any answer, for logs and metrics: "ok", "partial", ..., "limit",
/// "no_map". Returns `kUnknownStatus` for other numbers.
std::string_view status_name(std::int32_t wire_status);

/// Returns `text` as a message may carry it: without NUL and at most `max_bytes` long, cut between
/// characters of UTF-8.
std::string clipped(std::string_view text, std::size_t max_bytes);

}  // namespace camway::messages
