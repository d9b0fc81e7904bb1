// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

namespace camway::tools {

/// Returns the rate of frames on which all times are, counted from the first: a usual one of film
/// and video that has a time for each frame, else the one of equal steps, if these can be frames,
/// else a usual one of whose frames some have no time; nothing if there is none. Files round times,
/// so that several rates may fit: the slowest counts, and one of whole frames a second before one
/// of NTSC. Requires increasing times.
std::optional<double> rate_of_times(std::span<const double> times_s);

/// Times this share of a frame away from one are on it.
inline constexpr double kOnFrame = 0.02;

}  // namespace camway::tools
