// SPDX-License-Identifier: MIT
#include "tools/cameras/formats/chan_format.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "tools/cameras/files/text_rows.h"
#include "tools/cameras/formats/key_rows.h"

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;
/// Turns about X, Y and Z.
using Angles = std::array<double, 3>;

constexpr double kTurn_deg = 360.0;
constexpr double degrees_of_chan(double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; }
constexpr double radians_of_chan(double angle_deg) { return angle_deg * std::numbers::pi / 180.0; }

Quat from_angles(double x_deg, double y_deg, double z_deg) {
  return Quat(Eigen::AngleAxisd(radians_of_chan(y_deg), Vec3::UnitY()) *
              Eigen::AngleAxisd(radians_of_chan(x_deg), Vec3::UnitX()) *
              Eigen::AngleAxisd(radians_of_chan(z_deg), Vec3::UnitZ()));
}

/// The angles of an orientation with the turn about X within ±90°.
Angles angles_of(const Quat& orientation) {
  const Eigen::Matrix3d r = orientation.toRotationMatrix();
  const double sine_x = -r(1, 2);
  const double cosine_x = std::hypot(r(1, 0), r(1, 1));
  const double x = std::atan2(sine_x, cosine_x);
  // Straight up or down, only the sum or the difference of the others counts.
  constexpr double kUpright = 1e-9;
  if (cosine_x < kUpright) return {x, std::atan2(-r(2, 0), r(0, 0)), 0.0};
  return {x, std::atan2(r(0, 2), r(2, 2)), std::atan2(r(1, 0), r(1, 1))};
}

double nearest_turn(double angle_deg, double before_deg) {
  return angle_deg + kTurn_deg * std::round((before_deg - angle_deg) / kTurn_deg);
}

/// The angles, of the two that mean the orientation, that are nearest to those of the frame before.
Angles degrees_after(const Quat& orientation, const Angles* before_deg) {
  const Angles rad = angles_of(orientation);
  const Angles first = {degrees_of_chan(rad[0]), degrees_of_chan(rad[1]), degrees_of_chan(rad[2])};
  if (before_deg == nullptr) return first;
  Angles second = {180.0 - first[0], first[1] + 180.0, first[2] + 180.0};
  Angles nearest = first;
  double least = -1.0;
  for (Angles angles : {first, second}) {
    double distance = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      angles[k] = nearest_turn(angles[k], (*before_deg)[k]);
      distance += std::abs(angles[k] - (*before_deg)[k]);
    }
    if (least < 0.0 || distance < least) {
      least = distance;
      nearest = angles;
    }
  }
  return nearest;
}

}  // namespace

base::Result<CameraTrack> read_chan(const CameraFile& file, const CameraReadOptions& options) {
  CameraTrack track;
  track.fps = frame_rate(options, std::nullopt, track.notes);
  const CameraAxes axes = options.axes.value_or(CameraAxes::kGl);
  std::vector<double> n;
  std::optional<double> first_frame;
  KeyRows keys(track);
  for (const TextRow& row : rows_of(file.bytes)) {
    std::string fault = read_row(row, 7, 8, n);
    if (!fault.empty()) return base::Failure{std::move(fault)};
    if (!first_frame) first_frame = n[0];
    TrackKey key{(n[0] - *first_frame) / *track.fps,
                 {Vec3(n[1], n[2], n[3]), with_other_axes(from_angles(n[4], n[5], n[6]), axes)},
                 std::nullopt};
    if (n.size() > 7) key.fov_y_rad = radians_of_chan(n[7]);
    fault = keys.add(key, row.line);
    if (!fault.empty()) return base::Failure{std::move(fault)};
  }
  keys.finish();
  track.facts.first_frame = first_frame;
  return track;
}

base::Result<std::string> write_chan(const CameraTrack& track, const CameraWriteOptions& options) {
  std::string text;
  Angles before_deg{};
  for (std::size_t i = 0; i < track.keys.size(); ++i) {
    const TrackKey& key = track.keys[i];
    const Angles angles = degrees_after(key.pose_W.orientation, i == 0 ? nullptr : &before_deg);
    before_deg = angles;
    const Vec3& p = key.pose_W.position;
    const double frame = options.facts.first_frame.value_or(1.0) + static_cast<double>(i);
    text += number_text(frame) + '\t' +
            number_row(std::array{p.x(), p.y(), p.z(), angles[0], angles[1], angles[2]}, "\t");
    if (options.has_lens()) text += '\t' + number_text(degrees_of_chan(options.fov_y_rad));
    text += '\n';
  }
  return text;
}

}  // namespace camway::tools
