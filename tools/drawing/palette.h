// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

/// Colours of all drawings, which the page of `camway view` shares
/// (tools/view/page/src/model/palette.ts); a test compares the two. They are those of Okabe & Ito
/// (2008), which colour-blind people can distinguish. No drawing tells things apart by colour
/// alone.
namespace camway::draw {

struct Color {
  double red, green, blue;
  double alpha = 1.0;
};

/// Returns the colour with the sRGB value 0xRRGGBB.
constexpr Color rgb(std::uint32_t value) {
  constexpr double kMost = 255.0;
  return {(value >> 16U & 0xFFU) / kMost, (value >> 8U & 0xFFU) / kMost, (value & 0xFFU) / kMost};
}

/// Returns the same colour, seen through.
constexpr Color faded(const Color& color, double alpha) {
  return {color.red, color.green, color.blue, alpha};
}

namespace palette {
constexpr Color kBefore = rgb(0xE69F00);      ///< orange: the path as interpolated, dashed
constexpr Color kCollision = rgb(0xD55E00);   ///< vermillion: collisions
constexpr Color kAfter = rgb(0x0072B2);       ///< blue: the path
constexpr Color kCorrected = rgb(0x56B4E9);   ///< sky blue: corrected stretches
constexpr Color kInserted = rgb(0x009E73);    ///< bluish green: inserted keyframes
constexpr Color kInfeasible = rgb(0xCC79A7);  ///< reddish purple: what cannot be passed
constexpr Color kGiven = rgb(0x000000);       ///< black: given keyframes, on a light ground

// Colours of these drawings alone.
constexpr Color kInk = rgb(0x212121);
constexpr Color kMuted = rgb(0x6B6B6B);
constexpr Color kWall = rgb(0x737373);
constexpr Color kWallFill = rgb(0xC7C7C7);
constexpr Color kTop = rgb(0xF2F1ED);
constexpr Color kOutline = rgb(0xB3B0AB);
constexpr Color kGrid = rgb(0xDADADA);
}  // namespace palette

/// Names of the same things, as legends have them.
namespace names {
constexpr std::string_view kBefore = "path as interpolated";
constexpr std::string_view kCollision = "collision";
constexpr std::string_view kAfter = "path";
constexpr std::string_view kCorrected = "corrected";
constexpr std::string_view kInserted = "inserted keyframe";
constexpr std::string_view kGiven = "given keyframe";
constexpr std::string_view kInfeasible = "surface that cannot be passed";
}  // namespace names

}  // namespace camway::draw
