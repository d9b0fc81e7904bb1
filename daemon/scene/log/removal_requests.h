// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// The requests that removed scenes, as a text: a client that sends one of them again gets the
/// answer that it had, though nothing else of the scene is left. Functions without state.
/// Thread-safe.
namespace camway::scene {

/// Requests that a text remembers; an older one that is sent again counts as a new one.
inline constexpr std::size_t kRememberedRemovals = 256;

/// Returns the text with one more request, without the oldest ones if they are too many. An empty
/// request, or one of several lines, is none.
std::string with_removal(std::string_view text, std::string_view request);

/// Returns the requests of a text, oldest first, whatever it holds.
std::vector<std::string> removals_in(std::string_view text);

}  // namespace camway::scene
