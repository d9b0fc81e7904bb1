// SPDX-License-Identifier: MIT
#include "tools/cameras/export/written_lens.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

namespace camway::tools {
namespace {

/// Angles that are nearer, relatively, are the same: more than what texts of numbers round.
constexpr double kSame = 1e-6;

std::string angles_text(double fov_x_rad, double fov_y_rad) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  return fmt::format("{:.7g} x {:.7g} degrees", kDegrees * fov_x_rad, kDegrees * fov_y_rad);
}

/// The angle across, as `import` has it without flags; nothing where it would have to assume one.
std::optional<double> across_rad(const CameraTrack& track) {
  const std::optional<double> fov_x_rad = widest_fov_x_rad(track);
  const std::optional<double> fov_y_rad = widest_fov_y_rad(track);
  if (fov_x_rad || !fov_y_rad || !track.aspect) return fov_x_rad;
  return fov_across_rad(*fov_y_rad, *track.aspect);
}

/// Returns what a file leaves open that does not state both angles.
std::string open_angles(std::optional<double> fov_y_rad, const CameraFormat& format,
                        const CameraWriteOptions& options) {
  const std::string proved = angles_text(options.fov_x_rad, options.fov_y_rad);
  if (!fov_y_rad)
    return fmt::format("{} has no field of view: that of the path is {}", format.name, proved);
  return fmt::format(
      "{} has no shape of the picture: the field of view of the path is {}, {:.7g} times as wide "
      "as high",
      format.name, proved, std::tan(0.5 * options.fov_x_rad) / std::tan(0.5 * options.fov_y_rad));
}

}  // namespace

WrittenLens written_lens(const CameraTrack& read, const CameraFormat& format,
                         const CameraWriteOptions& options) {
  if (!options.has_lens()) return {};
  const std::optional<double> fov_x_rad = across_rad(read);
  const std::optional<double> fov_y_rad = widest_fov_y_rad(read);
  if (!fov_x_rad || !fov_y_rad) return {"", open_angles(fov_y_rad, format, options)};
  const double wider_x = *fov_x_rad / options.fov_x_rad - 1.0;
  const double wider_y = *fov_y_rad / options.fov_y_rad - 1.0;
  const std::string shown = angles_text(*fov_x_rad, *fov_y_rad);
  const std::string proved = angles_text(options.fov_x_rad, options.fov_y_rad);
  if (wider_x > kSame || wider_y > kSame) {
    return {
        fmt::format("would show {}, more than the field of view of the path, {}", shown, proved),
        ""};
  }
  if (wider_x >= -kSame && wider_y >= -kSame) return {};
  return {"",
          fmt::format("{} has square pixels, of which {} x {} show {} of the field of view of the "
                      "path, {} (--width, --height)",
                      format.name, options.width_px, height_px(options), shown, proved)};
}

}  // namespace camway::tools
