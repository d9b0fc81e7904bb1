// SPDX-License-Identifier: MIT
#pragma once

namespace camway::testing {

/// Whether the tests are built with a sanitizer, under which they take ten times as long or more.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

/// Returns how often a costly property is tried: `all` times, or a quarter of that under a
/// sanitizer, which looks for other faults than the property does.
constexpr int runs(int all) { return kIsSanitized ? (all + 3) / 4 : all; }

}  // namespace camway::testing
