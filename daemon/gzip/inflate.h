// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "daemon/base/result.h"

namespace camway::gzip {

/// The most bytes that a compressed file may hold: one of 1 MB can hold 1 GB.
inline constexpr std::size_t kMostInflatedBytes = std::size_t{1} << 30;

/// Whether the bytes begin as gzip does (RFC 1952).
bool is_gzip(std::string_view bytes);

/// Decompresses gzip. Fails if the bytes are damaged or cut off, or hold more than `most_bytes`.
base::Result<std::string> inflated(std::string_view bytes,
                                   std::size_t most_bytes = kMostInflatedBytes);

}  // namespace camway::gzip
