// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/cameras/files/mcap_records.h"
#include "tools/cameras/formats/mcap_formats.h"
#include "tools/json/json_document.h"

namespace camway::tools {
namespace {

using geometry::Quat;
using geometry::Vec3;

struct McapTopic {
  std::string name;
  std::string encoding;  ///< of its messages
  std::uint16_t schema = 0;
  std::map<std::string, std::string> metadata;
};

struct McapMessage {
  std::uint16_t channel = 0;
  std::uint64_t time_ns = 0;
  std::string_view data;
};

/// The contents of a file. Views are into its bytes.
struct McapContent {
  std::map<std::uint16_t, std::string> schemas;  ///< names
  std::map<std::uint16_t, McapTopic> channels;
  std::vector<McapMessage> messages;
  std::set<std::string> compressions;  ///< of chunks that were left out
};

bool read_message(std::string_view bytes, McapContent& content) {
  McapCursor cursor(bytes);
  McapMessage message;
  message.channel = cursor.u16();
  cursor.u32();  // number in its channel
  message.time_ns = cursor.u64();
  cursor.u64();  // time of publication
  message.data = cursor.rest();
  content.messages.push_back(message);
  return !cursor.failed();
}

/// Reads a record that may stand in a chunk. Returns why that is not possible.
std::string read_record(McapOpcode opcode, std::string_view bytes, McapContent& content) {
  McapCursor cursor(bytes);
  if (opcode == McapOpcode::kSchema) {
    const std::uint16_t id = cursor.u16();
    content.schemas[id] = cursor.text();
  } else if (opcode == McapOpcode::kChannel) {
    const std::uint16_t id = cursor.u16();
    McapTopic topic;
    topic.schema = cursor.u16();
    topic.name = cursor.text();
    topic.encoding = cursor.text();
    topic.metadata = cursor.texts();
    content.channels[id] = std::move(topic);
  } else if (opcode == McapOpcode::kMessage) {
    return read_message(bytes, content) ? "" : "ends within a message";
  }
  return cursor.failed() ? "ends within a record" : "";
}

/// Calls `use(opcode, content)` for each record, until it returns an error or the footer comes.
template <class Use>
std::string for_each_record(std::string_view bytes, const Use& use) {
  McapCursor cursor(bytes);
  while (!cursor.rest().empty()) {
    const auto opcode = static_cast<McapOpcode>(cursor.u8());
    const std::string_view content = cursor.raw(cursor.u64());
    if (cursor.failed()) return "ends within a record";
    if (opcode == McapOpcode::kFooter) return "";
    std::string error = use(opcode, content);
    if (!error.empty()) return error;
  }
  return "";
}

std::string read_chunk(std::string_view bytes, McapContent& content) {
  McapCursor cursor(bytes);
  cursor.u64();  // earliest message
  cursor.u64();  // latest message
  cursor.u64();  // size without compression
  const std::uint32_t crc = cursor.u32();
  const std::string compression(cursor.text());
  const std::string_view records = cursor.raw(cursor.u64());
  if (cursor.failed()) return "ends within a chunk";
  if (!compression.empty()) {
    content.compressions.insert(compression);
    return "";
  }
  if (crc != 0 && crc != crc32_of(records)) return "a chunk does not have its checksum";
  return for_each_record(records, [&](McapOpcode opcode, std::string_view record) {
    return read_record(opcode, record, content);
  });
}

std::string read_content(std::string_view bytes, McapContent& content) {
  if (!bytes.starts_with(kMcapMagic)) return "is no MCAP file of version 0";
  bytes.remove_prefix(kMcapMagic.size());
  return for_each_record(bytes, [&](McapOpcode opcode, std::string_view record) {
    return opcode == McapOpcode::kChunk ? read_chunk(record, content)
                                        : read_record(opcode, record, content);
  });
}

/// The names, the first few of them.
std::string listed(const std::set<std::string>& names) {
  constexpr std::size_t kMost = 4;
  std::string text;
  std::size_t count = 0;
  for (const std::string& name : names) {
    if (count++ == kMost) return text + ", ...";
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

/// Returns why no message of the file can be read; empty if some can.
std::string unreadable(const McapContent& content) {
  std::set<std::string> encodings;
  std::set<std::string> schemas;
  for (const auto& [id, channel] : content.channels) {
    encodings.insert(channel.encoding);
    const auto schema = content.schemas.find(channel.schema);
    if (schema != content.schemas.end()) schemas.insert(schema->second);
  }
  if (!encodings.empty() && !encodings.contains("json")) {
    return "its messages are in the encoding " + listed(encodings) +
           (schemas.empty() ? "" : " (" + listed(schemas) + ")") + "; only json is read";
  }
  if (!content.compressions.empty()) {
    return "its chunks are compressed by " + listed(content.compressions) +
           "; only chunks without compression are read";
  }
  return "";
}

/// The camera paths of a file by their names, and lenses by the names of their frames.
struct McapCameras {
  std::vector<std::string> names;  ///< in the order of the file
  std::map<std::string, std::vector<TrackKey>> keys;
  std::map<std::string, std::pair<double, double>> fovs_rad;
  std::map<std::string, FileFacts> facts;  ///< the size of the picture
  std::map<std::string, std::uint16_t> channels;
  std::map<std::string, std::string> parents;
};

/// Reads `{"x": ..., "y": ..., ...}`; nothing if a member is no number.
template <std::size_t Count>
std::optional<std::array<double, Count>> numbers_in(const nlohmann::json& object,
                                                    std::string_view names) {
  std::array<double, Count> numbers{};
  for (std::size_t i = 0; i < Count; ++i) {
    const auto member = object.find(names.substr(i, 1));
    if (member == object.end() || !member->is_number()) return std::nullopt;
    numbers[i] = member->template get<double>();
  }
  return numbers;
}

/// The member if it is an object; an empty object otherwise.
const nlohmann::json& object_in(const nlohmann::json& object, const char* key) {
  static const nlohmann::json kNone = nlohmann::json::object();
  const auto member = object.find(key);
  return member != object.end() && member->is_object() ? *member : kNone;
}

/// The pose of a message, of whichever type it is.
std::optional<motion::Pose> pose_in_message(const nlohmann::json& message) {
  const nlohmann::json& stamped = object_in(message, "transform");
  const nlohmann::json& transform = stamped.empty() ? message : stamped;
  const nlohmann::json& pose = object_in(message, "pose");
  const bool is_pose = !pose.empty();
  const nlohmann::json& position =
      is_pose ? object_in(pose, "position") : object_in(transform, "translation");
  const nlohmann::json& orientation =
      is_pose ? object_in(pose, "orientation") : object_in(transform, "rotation");
  const auto p = numbers_in<3>(position, "xyz");
  const auto q = numbers_in<4>(orientation, "xyzw");
  if (!p || !q) return std::nullopt;
  const Quat turn((*q)[3], (*q)[0], (*q)[1], (*q)[2]);
  return motion::Pose{Vec3((*p)[0], (*p)[1], (*p)[2]),
                      turn.norm() > 0.0 ? turn.normalized() : turn};
}

std::string text_in_message(const nlohmann::json& object, const char* key) {
  const auto member = object.find(key);
  return member != object.end() && member->is_string() ? member->get<std::string>() : "";
}

/// Takes the angles of view of a calibration, if the message is one.
void take_lens(const nlohmann::json& message, McapCameras& cameras) {
  const auto k = message.find("K");
  const auto width = message.find("width");
  const auto height = message.find("height");
  if (k == message.end() || width == message.end() || height == message.end()) return;
  if (!k->is_array() || k->size() != 9 || !width->is_number() || !height->is_number()) return;
  if (!(*k)[0].is_number() || !(*k)[4].is_number()) return;
  const double across = 0.5 * width->get<double>() / (*k)[0].get<double>();
  const double upwards = 0.5 * height->get<double>() / (*k)[4].get<double>();
  if (!(across > 0.0 && upwards > 0.0)) return;
  set_size(width->get<double>(), height->get<double>(),
           cameras.facts[text_in_message(message, "frame_id")]);
  cameras.fovs_rad[text_in_message(message, "frame_id")] = {2.0 * std::atan(across),
                                                            2.0 * std::atan(upwards)};
}

void take_message(const McapContent& content, const McapMessage& each,
                  const nlohmann::json& message, McapCameras& cameras) {
  if (!message.is_object()) return;
  const std::optional<motion::Pose> pose = pose_in_message(message);
  if (!pose) return take_lens(message, cameras);
  std::string name = text_in_message(message, "child_frame_id");
  if (name.empty()) name = content.channels.at(each.channel).name;
  std::vector<TrackKey>& keys = cameras.keys[name];
  if (keys.empty()) {
    cameras.names.push_back(name);
    cameras.channels[name] = each.channel;
    cameras.parents[name] = text_in_message(message, "parent_frame_id");
  }
  constexpr double kNanosecondsInSecond = 1e9;
  keys.push_back({static_cast<double>(each.time_ns) / kNanosecondsInSecond, *pose, {}});
}

/// Reads the messages in JSON. Returns why that is not possible.
std::string read_messages(McapContent& content, McapCameras& cameras) {
  std::ranges::stable_sort(content.messages, {}, &McapMessage::time_ns);
  for (const McapMessage& each : content.messages) {
    const auto channel = content.channels.find(each.channel);
    if (channel == content.channels.end() || channel->second.encoding != "json") continue;
    const base::Result<nlohmann::json> message =
        parse_document(each.data, "a message of " + channel->second.name);
    if (!message) return message.error;
    take_message(content, each, *message, cameras);
  }
  return "";
}

std::optional<double> positive_in(const std::map<std::string, std::string>& metadata,
                                  const std::string& key) {
  const auto found = metadata.find(key);
  if (found == metadata.end()) return std::nullopt;
  const std::string& text = found->second;
  double number = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  if (read.ec != std::errc() || !(number > 0.0) || !std::isfinite(number)) return std::nullopt;
  return number;
}

CameraTrack mcap_track(const McapContent& content, McapCameras& cameras, const std::string& name,
                       const CameraReadOptions& options) {
  const McapTopic& topic = content.channels.at(cameras.channels.at(name));
  CameraTrack track;
  track.name = name == topic.name ? "" : name;
  track.keys = std::move(cameras.keys.at(name));
  for (TrackKey& key : track.keys) {
    key.pose_W.orientation =
        with_other_axes(key.pose_W.orientation, options.axes.value_or(CameraAxes::kCv));
  }
  track.fps = options.fps ? options.fps : positive_in(topic.metadata, "fps");
  track.near_m = positive_in(topic.metadata, "near_m");
  if (const auto fov = cameras.fovs_rad.find(name); fov != cameras.fovs_rad.end()) {
    std::tie(track.fov_x_rad, track.fov_y_rad) = fov->second;
    track.facts = cameras.facts[name];
  }
  const std::string& parent = cameras.parents.at(name);
  if (!parent.empty() && parent != "world") {
    track.notes.push_back("poses are those in the frame '" + parent + "'");
  }
  return track;
}

}  // namespace

base::Result<CameraTrack> read_mcap(const CameraFile& file, const CameraReadOptions& options) {
  McapContent content;
  McapCameras cameras;
  std::string error = read_content(file.bytes, content);
  if (error.empty()) error = unreadable(content);
  if (error.empty()) error = read_messages(content, cameras);
  if (!error.empty()) return base::Failure{std::move(error)};
  if (cameras.names.empty()) return base::Failure{"no message has a pose"};
  const std::string name = options.camera.empty() ? cameras.names.front() : options.camera;
  if (!cameras.keys.contains(name)) {
    return base::Failure{"has no camera '" + name +
                         "': " + listed({cameras.names.begin(), cameras.names.end()})};
  }
  return mcap_track(content, cameras, name, options);
}

}  // namespace camway::tools
