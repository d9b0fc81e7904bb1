// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/motion/path/keyframe.h"

/// Messages in the schemas of Foxglove, as JSON. Times are nanoseconds, positions metres, and
/// cameras have the axes of an optical frame (+Z forward, +Y down).
namespace camway::tools::foxglove {

using Json = nlohmann::ordered_json;

/// The world's frame.
inline constexpr const char* kWorldFrame = "world";

/// Schemas with the members that Camway writes. A reader may know more, so others are allowed.
Json schema_of(const char* title, const char* description, const Json& members);
Json text_schema();
Json numbers_schema(const std::vector<const char*>& names);

Json transform_schema();
Json poses_schema();
Json calibration_schema();
Json log_schema();

Json timestamp(std::uint64_t time_ns);

/// The pose of a camera's optical frame, in the world.
std::string transform_message(const motion::Pose& pose_W, std::uint64_t time_ns,
                              const std::string& frame);
std::string poses_message(const std::vector<motion::Pose>& poses_W, std::uint64_t time_ns);

/// The levels of `foxglove.Log`.
enum class LogLevel { kInfo = 2, kWarning = 3, kError = 4 };
/// `name` is the process or part that the sentence comes from.
std::string log_message(LogLevel level, const std::string& sentence, const std::string& name,
                        std::uint64_t time_ns);

}  // namespace camway::tools::foxglove
