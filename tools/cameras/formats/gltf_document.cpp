// SPDX-License-Identifier: MIT
#include "tools/cameras/formats/gltf_document.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

#include "daemon/base/base64.h"
#include "daemon/base/percent.h"
#include "tools/json/json_document.h"

namespace camway::tools {
namespace {

using nlohmann::json;

constexpr std::string_view kGlbMagic = "glTF";
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

/// A number of `glTF` at `at`, little-endian as this machine. Requires that it is there.
template <class Number>
Number number_at(std::string_view bytes, std::size_t at) {
  Number number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

struct Chunks {
  std::string_view json;
  std::string_view binary;
};

/// Splits a `.glb`. Returns why that is not possible.
std::string split_glb(std::string_view bytes, Chunks& chunks) {
  constexpr std::size_t kHeader = 12;
  constexpr std::size_t kChunkHeader = 8;
  if (bytes.size() < kHeader || number_at<std::uint32_t>(bytes, 4) != 2) {
    return "is no glTF of version 2";
  }
  for (std::size_t at = kHeader; at + kChunkHeader <= bytes.size();) {
    const auto size = number_at<std::uint32_t>(bytes, at);
    const auto kind = number_at<std::uint32_t>(bytes, at + 4);
    at += kChunkHeader;
    if (size > bytes.size() - at) return "ends within a chunk";
    if (kind == kJsonChunk && chunks.json.empty()) chunks.json = bytes.substr(at, size);
    if (kind == kBinaryChunk && chunks.binary.empty()) chunks.binary = bytes.substr(at, size);
    at += size;
  }
  return chunks.json.empty() ? "has no JSON" : "";
}

/// Opens the file of a relative URI (glTF 2.0, section 2.8). Programs that do not encode names
/// write those with '%' as they are.
base::Result<std::string> open_uri(const CameraFile& file, const std::string& uri) {
  const std::string name = base::percent_decoded(uri);
  base::Result<std::string> read = file.open_beside(name);
  return read || name == uri ? read : file.open_beside(uri);
}

base::Result<std::string> buffer_bytes(const json& buffer, const CameraFile& file,
                                       std::string_view binary) {
  const auto uri = buffer.find("uri");
  if (uri == buffer.end()) return std::string(binary);
  if (!uri->is_string()) return base::Failure{"has a buffer whose uri is no text"};
  const auto& text = uri->get_ref<const std::string&>();
  if (!text.starts_with("data:")) {
    if (!file.open_beside) return base::Failure{"needs the file " + text};
    base::Result<std::string> read = open_uri(file, text);
    if (!read) return base::Failure{"needs " + text + ", which " + read.error};
    return read;
  }
  const std::size_t comma = text.find(',');
  const auto bytes = comma == std::string::npos
                         ? std::nullopt
                         : base::decode_base64(std::string_view(text).substr(comma + 1));
  if (!bytes) return base::Failure{"has a buffer that is not written in base64"};
  return *bytes;
}

struct ComponentType {
  std::size_t bytes = 0;
  double (*read)(std::string_view, std::size_t) = nullptr;
};

/// As a fraction of the largest value, as glTF defines it for animations.
template <class Integer>
double fraction_at(std::string_view bytes, std::size_t at) {
  const double fraction = static_cast<double>(number_at<Integer>(bytes, at)) /
                          static_cast<double>(std::numeric_limits<Integer>::max());
  return fraction < -1.0 ? -1.0 : fraction;
}

ComponentType component_type(std::size_t code) {
  switch (code) {
    case 5120:
      return {1, fraction_at<std::int8_t>};
    case 5121:
      return {1, fraction_at<std::uint8_t>};
    case 5122:
      return {2, fraction_at<std::int16_t>};
    case 5123:
      return {2, fraction_at<std::uint16_t>};
    case 5126:
      return {4, [](std::string_view bytes, std::size_t at) {
                return static_cast<double>(number_at<float>(bytes, at));
              }};
    default:
      return {};
  }
}

constexpr std::array<std::string_view, 5> kTypeNames = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};

}  // namespace

std::optional<std::size_t> gltf_index(const json& object, const char* key) {
  if (!object.is_object()) return std::nullopt;
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_unsigned()) return std::nullopt;
  return found->get<std::size_t>();
}

std::optional<double> gltf_number(const json& object, const char* key) {
  if (!object.is_object()) return std::nullopt;
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

base::Result<GltfDocument> GltfDocument::parse(const CameraFile& file) {
  Chunks chunks{file.bytes, {}};
  if (file.bytes.starts_with(kGlbMagic)) {
    chunks.json = {};
    std::string fault = split_glb(file.bytes, chunks);
    if (!fault.empty()) return base::Failure{std::move(fault)};
  }
  base::Result<json> parsed = parse_document(chunks.json, file.name);
  if (!parsed) return base::Failure{parsed.error.substr(file.name.size() + 2)};
  GltfDocument document;
  document.root_ = *std::move(parsed);
  if (!document.root_.is_object() || !document.root_.contains("asset")) {
    return base::Failure{"is no glTF: it has no 'asset'"};
  }
  const auto buffers = document.root_.find("buffers");
  if (buffers == document.root_.end() || !buffers->is_array()) return document;
  for (const json& buffer : *buffers) {
    base::Result<std::string> bytes = buffer_bytes(buffer, file, chunks.binary);
    if (!bytes) return base::Failure{std::move(bytes.error)};
    document.buffers_.push_back(*std::move(bytes));
  }
  return document;
}

const json& GltfDocument::element(const char* array, std::size_t index) const {
  static const json kNone = json::object();
  const auto found = root_.find(array);
  if (found == root_.end() || !found->is_array() || index >= found->size()) return kNone;
  return (*found)[index];
}

base::Result<std::vector<double>> GltfDocument::values(std::size_t accessor,
                                                       std::size_t components) const {
  const json& description = element("accessors", accessor);
  const std::string name = "accessor " + std::to_string(accessor);
  const auto view_index = gltf_index(description, "bufferView");
  const auto count = gltf_index(description, "count");
  const auto type = description.find("type");
  const ComponentType component =
      component_type(gltf_index(description, "componentType").value_or(0));
  if (!view_index || !count || component.read == nullptr || type == description.end() ||
      *type != kTypeNames[components] || description.contains("sparse")) {
    return base::Failure{name + " is not of the kind that animations have"};
  }
  const json& view = element("bufferViews", *view_index);
  if (view.contains("extensions")) {
    return base::Failure{name + " is compressed (" + view["extensions"].begin().key() +
                         "), which is not read: write the file without compression"};
  }
  const std::size_t buffer = gltf_index(view, "buffer").value_or(buffers_.size());
  if (buffer >= buffers_.size()) return base::Failure{name + " has no buffer"};
  const std::string_view bytes = buffers_[buffer];
  const std::size_t element_bytes = component.bytes * components;
  const std::size_t stride = gltf_index(view, "byteStride").value_or(element_bytes);
  const std::size_t begin = gltf_index(view, "byteOffset").value_or(0);
  const std::size_t offset = gltf_index(description, "byteOffset").value_or(0);
  // Each difference is taken after it is known not to be negative.
  if (begin > bytes.size() || offset > bytes.size() - begin || stride < element_bytes ||
      *count > (bytes.size() - begin - offset + stride - element_bytes) / stride) {
    return base::Failure{name + " reaches beyond its buffer"};
  }
  std::vector<double> numbers;
  numbers.reserve(*count * components);
  for (std::size_t i = 0; i < *count; ++i) {
    for (std::size_t k = 0; k < components; ++k) {
      numbers.push_back(component.read(bytes, begin + offset + i * stride + k * component.bytes));
    }
  }
  return numbers;
}

}  // namespace camway::tools
