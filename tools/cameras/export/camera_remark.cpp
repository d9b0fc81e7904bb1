// SPDX-License-Identifier: MIT
#include "tools/cameras/export/camera_remark.h"

#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/base/named_enum.h"
#include "daemon/scene/import/record/import_words.h"

namespace camway::tools {
namespace {

using RemarkJson = nlohmann::json;
using OrderedRemark = nlohmann::ordered_json;

constexpr const char* kRemark = "_camera";

/// The member as a number above 0; nothing if it is none.
std::optional<double> positive_member(const RemarkJson& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  const double number = found->get<double>();
  return number > 0.0 && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::string text_in_remark(const RemarkJson& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

template <class Enum>
std::optional<Enum> choice_member(const RemarkJson& object, const char* key) {
  const std::string name = text_in_remark(object, key);
  for (const auto& [each, value] : base::named_values<Enum>()) {
    if (each == name) return value;
  }
  return std::nullopt;
}

FileFacts facts_in(const RemarkJson& camera) {
  FileFacts facts;
  if (const auto first = camera.find("first_frame");
      first != camera.end() && first->is_number() && std::isfinite(first->get<double>())) {
    facts.first_frame = first->get<double>();
  }
  set_size(positive_member(camera, "width_px").value_or(0.0),
           positive_member(camera, "height_px").value_or(0.0), facts);
  facts.time_units = positive_member(camera, "time_units").value_or(1.0);
  facts.length_units = positive_member(camera, "length_units").value_or(1.0);
  facts.is_euroc = text_in_remark(camera, "table") == "euroc";
  const auto images = camera.find("images");
  if (images == camera.end() || !images->is_array()) return facts;
  for (const RemarkJson& image : *images) {
    // Pictures have names all together, or none.
    if (!image.is_string()) return facts.images.clear(), facts;
    facts.images.push_back(image.get<std::string>());
  }
  return facts;
}

}  // namespace

CameraRemark camera_remark(const std::string& request_text) {
  const RemarkJson request = RemarkJson::parse(request_text, nullptr, false);
  CameraRemark remark;
  if (!request.is_object() || !request.contains(kRemark)) return remark;
  const RemarkJson& camera = request[kRemark];
  if (!camera.is_object()) return remark;
  remark.name = text_in_remark(camera, "name");
  remark.format = text_in_remark(camera, "format");
  remark.fps = positive_member(camera, "fps");
  const auto has_times = camera.find("has_times");
  remark.has_times =
      has_times == camera.end() || !has_times->is_boolean() || has_times->get<bool>();
  remark.axes = choice_member<CameraAxes>(camera, "camera_axes");
  remark.scale = positive_member(camera, "scale").value_or(1.0);
  remark.up = choice_member<scene::UpAxis>(camera, "up").value_or(scene::UpAxis::kAsInFile);
  remark.facts = facts_in(camera);
  return remark;
}

OrderedRemark remark_json(const CameraRemark& remark) {
  const FileFacts& facts = remark.facts;
  OrderedRemark json{{"name", remark.name}, {"format", remark.format}};
  if (remark.fps) json["fps"] = *remark.fps;
  if (!remark.has_times) json["has_times"] = false;
  if (remark.axes) json["camera_axes"] = base::name_of(*remark.axes);
  if (remark.scale != 1.0) json["scale"] = remark.scale;
  if (remark.up != scene::UpAxis::kAsInFile) json["up"] = base::name_of(remark.up);
  if (facts.first_frame) json["first_frame"] = *facts.first_frame;
  if (facts.width_px > 0) json["width_px"] = facts.width_px;
  if (facts.height_px > 0) json["height_px"] = facts.height_px;
  if (facts.time_units != 1.0) json["time_units"] = facts.time_units;
  if (facts.length_units != 1.0) json["length_units"] = facts.length_units;
  if (facts.is_euroc) json["table"] = "euroc";
  if (!facts.images.empty()) json["images"] = facts.images;
  return json;
}

}  // namespace camway::tools
