// SPDX-License-Identifier: MIT
#include "tools/cameras/frame_rate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace camway::tools {
namespace {

/// Those that come first are preferred.
constexpr std::array<double, 10> kUsualRates = {
    24.0, 25.0, 30.0, 24000.0 / 1001.0, 30000.0 / 1001.0,
    48.0, 50.0, 60.0, 60000.0 / 1001.0, 120.0};
/// A rate whose times are off by less is as good as the best one. Files with more digits tell 24
/// and 23.976 frames a second apart at the first frame.
constexpr double kSameError_s = 1e-6;
/// A rate whose times are off by this much more than those of the best one is as good as it.
constexpr double kSameErrorRatio = 2.0;
/// A measured rate this share away from a whole one is that.
constexpr double kNearlyWhole = 0.002;

/// Fewer times, or slower ones, that are equally far apart are keyframes, not frames.
constexpr std::size_t kFewestFrames = 8;
constexpr double kSlowestFrames = 5.0;

/// How far the times are from frames; infinite if one is on none, if two are on the same, or if
/// there is a frame between two that has to have a time.
double error_s(std::span<const double> times_s, double fps, bool is_each_frame) {
  double largest_s = 0.0;
  double frame_before = -1.0;
  for (const double time_s : times_s) {
    const double frame = std::round((time_s - times_s.front()) * fps);
    const double off_s = std::abs(time_s - times_s.front() - frame / fps);
    const bool is_next = is_each_frame ? frame == frame_before + 1.0 : frame > frame_before;
    if (!(off_s * fps <= kOnFrame) || !is_next) {
      return std::numeric_limits<double>::infinity();
    }
    largest_s = std::max(largest_s, off_s);
    frame_before = frame;
  }
  return largest_s;
}

std::optional<double> rate_of_equal_steps(std::span<const double> times_s) {
  if (times_s.size() < 3) return std::nullopt;
  const double steps = static_cast<double>(times_s.size() - 1);
  const double fps = steps / (times_s.back() - times_s.front());
  if (!std::isfinite(fps)) return std::nullopt;
  for (const double rate : {std::round(fps), fps}) {
    if (!(rate > 0.0) || std::abs(rate - fps) > kNearlyWhole * fps) continue;
    if (std::isfinite(error_s(times_s, rate, true))) return rate;
  }
  return std::nullopt;
}

std::optional<double> usual_rate(std::span<const double> times_s, bool is_each_frame) {
  std::array<double, kUsualRates.size()> errors_s{};
  std::ranges::transform(kUsualRates, errors_s.begin(),
                         [&](double fps) { return error_s(times_s, fps, is_each_frame); });
  const double least_s = *std::ranges::min_element(errors_s);
  if (!std::isfinite(least_s)) return std::nullopt;
  const double most_s = std::max(kSameErrorRatio * least_s, kSameError_s);
  const auto best = std::ranges::find_if(errors_s, [&](double each) { return each <= most_s; });
  return kUsualRates[static_cast<std::size_t>(best - errors_s.begin())];
}

}  // namespace

std::optional<double> rate_of_times(std::span<const double> times_s) {
  if (times_s.size() < 2) return std::nullopt;
  if (const auto each = usual_rate(times_s, true)) return each;
  const std::optional<double> equal = rate_of_equal_steps(times_s);
  if (equal && *equal >= kSlowestFrames && times_s.size() >= kFewestFrames) return equal;
  const std::optional<double> some = usual_rate(times_s, false);
  return some ? some : equal;
}

}  // namespace camway::tools
