// SPDX-License-Identifier: MIT
#include "tools/json/json_io.h"

#include <cmath>

#include "daemon/scene/import/record/import_words.h"
#include "tools/json/json_body.h"
#include "tools/json/json_options.h"
#include "tools/json/json_reader.h"

namespace camway::tools {
namespace {

using motion::Keyframe;

geometry::Vec4 read_numbers(const Field& field) {
  geometry::Vec4 numbers = geometry::Vec4::Zero();
  read_value(field, numbers);
  return numbers;
}

/// Returns the unit quaternion in the direction of `wxyz`. Divides by the largest coefficient
/// first, so that squares neither overflow nor underflow.
geometry::Quat unit_quaternion(const Field& field, const geometry::Vec4& wxyz) {
  const double largest = wxyz.cwiseAbs().maxCoeff();
  if (largest == 0.0) {
    field.fail("has length zero, which is no orientation");
    return geometry::Quat::Identity();
  }
  if (std::abs(wxyz.squaredNorm() - 1.0) <= kUnitQuaternionError) return geometry::from_wxyz(wxyz);
  const geometry::Vec4 scaled = wxyz / largest;
  return geometry::from_wxyz(scaled / scaled.norm());
}

/// Reads the time of keyframe `index`, which must have one exactly if the first keyframe has one.
void read_time(const Field& item, std::size_t index, RequestFile& request, Keyframe& keyframe) {
  const std::optional<Field> time = item.optional_member("time");
  if (time) keyframe.time_s = time->number();
  if (index == 0) request.has_times = time.has_value();
  if (time.has_value() == request.has_times) return;
  item.fail(std::string(time ? "has a time and keyframe 0 has none"
                             : "has no time and keyframe 0 has one") +
            ": time stands in all keyframes or in none");
}

/// Reads the quaternion, in either order of its numbers.
geometry::Quat read_orientation(const Field& item, RequestFile& request) {
  const std::optional<Field> xyzw_field = item.optional_member("orientation_xyzw");
  if (!xyzw_field) {
    const Field orientation = item.member("orientation");
    return unit_quaternion(orientation, read_numbers(orientation));
  }
  if (item.optional_member("orientation")) {
    item.fail("has both orientation and orientation_xyzw; leave one out");
  }
  request.says_xyzw = true;
  const geometry::Vec4 xyzw = read_numbers(*xyzw_field);
  return unit_quaternion(*xyzw_field, {xyzw[3], xyzw[0], xyzw[1], xyzw[2]});
}

void read_keyframes(const Field& list, RequestFile& request) {
  const std::size_t count = list.size();
  if (count > planning::kMaxKeyframes) {
    list.fail("has " + std::to_string(count) + " keyframes, more than the " +
              std::to_string(planning::kMaxKeyframes) + " that a request may hold");
    return;
  }
  request.keyframes.reserve(count);
  for (std::size_t i = 0; i < count && !list.failed(); ++i) {
    const Field item = list.element(i);
    // Keyframes copied from a response have an origin, which is then "given".
    item.allow_only(
        {"time", "position", "orientation", "orientation_xyzw", "origin", "repaired", "image"});
    Keyframe keyframe;
    read_time(item, i, request, keyframe);
    read_value(item.member("position"), keyframe.pose.position);
    keyframe.pose.orientation = read_orientation(item, request);
    if (const auto image = item.optional_member("image")) read_value(*image, keyframe.image);
    request.keyframes.push_back(keyframe);
  }
}

motion::PathFrame read_frame(const Field& field) {
  field.allow_only({"reference", "begin", "end"});
  for (const std::string_view end : {"begin", "end"}) {
    field.member(end).allow_only({"velocity_m_per_s", "image_rate_per_s"});
  }
  motion::PathFrame frame;
  read_value(field, frame);
  return frame;
}

SceneReading read_reading(const Field& root) {
  SceneReading reading;
  if (const auto scale = root.optional_member("scale")) {
    reading.scale = scale->number();
    if (!(*reading.scale > 0.0)) scale->fail_number("be above 0");
  }
  if (const auto up = root.optional_member("up")) reading.up = named(*up, scene::kUpAxes);
  if (const auto unknown = root.optional_member("unknown")) {
    reading.unknown = named(*unknown, scene::kUnknownSpaces);
  }
  return reading;
}

RequestFile read_request(const Field& root) {
  root.allow_only(
      {"scene", "scale", "up", "unknown", "camera", "body", "keyframes", "frame", "options"});
  RequestFile request;
  if (const auto scene = root.optional_member("scene")) request.scene = scene->text();
  request.reading = read_reading(root);
  if (const auto body = root.optional_member("body")) request.body = read_body(*body);
  if (!request.body || root.optional_member("camera")) {
    request.camera = read_camera(root.member("camera"));
  }
  read_keyframes(root.member("keyframes"), request);
  if (const auto frame = root.optional_member("frame")) request.frame = read_frame(*frame);
  if (const auto options = root.optional_member("options")) {
    request.options = read_options(*options);
  }
  request.spelling = json_spelling(root);
  return request;
}

}  // namespace

base::Result<RequestFile> parse_plan_request(std::string_view text, std::string_view source) {
  return parse_as(read_request, text, source);
}

base::Result<RequestFile> read_plan_request(const std::string& file) {
  return read_as(read_request, file);
}

}  // namespace camway::tools
