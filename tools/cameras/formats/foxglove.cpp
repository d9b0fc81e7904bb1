// SPDX-License-Identifier: MIT
#include "tools/cameras/formats/foxglove.h"

#include "tools/cameras/formats/camera_format.h"
#include "tools/json/json_text.h"

namespace camway::tools::foxglove {
namespace {

constexpr std::uint64_t kNanoseconds = 1'000'000'000;

Json object_schema(const Json& members) {
  return {{"type", "object"}, {"properties", members}, {"additionalProperties", true}};
}

Json vector_json(const geometry::Vec3& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }

/// The orientation of the optical frame.
Json rotation_json(const motion::Pose& pose) {
  const geometry::Quat q = with_other_axes(pose.orientation, CameraAxes::kCv);
  return {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}};
}

}  // namespace

Json schema_of(const char* title, const char* description, const Json& members) {
  const Json time = object_schema(
      {{"sec", {{"type", "integer"}, {"minimum", 0}}},
       {"nsec", {{"type", "integer"}, {"minimum", 0}, {"maximum", kNanoseconds - 1}}}});
  Json with_time{{"timestamp", time}};
  with_time.update(members);
  Json schema{{"title", title}, {"description", description}};
  schema.update(object_schema(with_time));
  return schema;
}

Json text_schema() { return {{"type", "string"}}; }

Json numbers_schema(const std::vector<const char*>& names) {
  Json members;
  for (const char* const name : names) members[name] = {{"type", "number"}};
  return object_schema(members);
}

Json transform_schema() {
  return schema_of("foxglove.FrameTransform", "A transform between two frames",
                   {{"parent_frame_id", text_schema()},
                    {"child_frame_id", text_schema()},
                    {"translation", numbers_schema({"x", "y", "z"})},
                    {"rotation", numbers_schema({"x", "y", "z", "w"})}});
}

Json poses_schema() {
  const Json pose = object_schema({{"position", numbers_schema({"x", "y", "z"})},
                                   {"orientation", numbers_schema({"x", "y", "z", "w"})}});
  return schema_of("foxglove.PosesInFrame", "Poses in a frame",
                   {{"frame_id", text_schema()}, {"poses", {{"type", "array"}, {"items", pose}}}});
}

Json calibration_schema() {
  const auto numbers = [](std::size_t least, std::size_t most) -> Json {
    return {{"type", "array"},
            {"items", {{"type", "number"}}},
            {"minItems", least},
            {"maxItems", most}};
  };
  const Json whole{{"type", "integer"}, {"minimum", 0}};
  return schema_of("foxglove.CameraCalibration", "The lens of a camera",
                   {{"frame_id", text_schema()},
                    {"width", whole},
                    {"height", whole},
                    {"distortion_model", text_schema()},
                    {"D", numbers(0, 0)},
                    {"K", numbers(9, 9)},
                    {"R", numbers(9, 9)},
                    {"P", numbers(12, 12)}});
}

Json log_schema() {
  return schema_of("foxglove.Log", "A line of a log",
                   {{"level", {{"type", "integer"}, {"minimum", 0}, {"maximum", 5}}},
                    {"message", text_schema()},
                    {"name", text_schema()}});
}

Json timestamp(std::uint64_t time_ns) {
  return {{"sec", time_ns / kNanoseconds}, {"nsec", time_ns % kNanoseconds}};
}

std::string transform_message(const motion::Pose& pose_W, std::uint64_t time_ns,
                              const std::string& frame) {
  return json_text(Json{{"timestamp", timestamp(time_ns)},
                        {"parent_frame_id", kWorldFrame},
                        {"child_frame_id", frame},
                        {"translation", vector_json(pose_W.position)},
                        {"rotation", rotation_json(pose_W)}});
}

std::string poses_message(const std::vector<motion::Pose>& poses_W, std::uint64_t time_ns) {
  Json poses = Json::array();
  for (const motion::Pose& pose : poses_W) {
    poses.push_back(
        {{"position", vector_json(pose.position)}, {"orientation", rotation_json(pose)}});
  }
  return Json{
      {"timestamp", timestamp(time_ns)}, {"frame_id", kWorldFrame}, {"poses", std::move(poses)}}
      .dump();
}

std::string log_message(LogLevel level, const std::string& sentence, const std::string& name,
                        std::uint64_t time_ns) {
  return json_text(Json{{"timestamp", timestamp(time_ns)},
                        {"level", static_cast<int>(level)},
                        {"message", sentence},
                        {"name", name}});
}

}  // namespace camway::tools::foxglove
