// SPDX-License-Identifier: MIT
#include "daemon/scene/cache/cache_file.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/base/parallel_chunks.h"
#include "daemon/scene/cache/cache_layout.h"
#include "daemon/scene/cache/file_bytes.h"
#include "daemon/scene/cache/mesh_check.h"
#include "daemon/scene/import/record/import_words.h"

namespace camway::scene {
namespace {

namespace layout = cache_layout;
using base::Failure;
using geometry::Box;
using geometry::Vec3;

static_assert(sizeof(Vec3) == 24 && sizeof(std::array<std::uint32_t, 3>) == 12);
static_assert(sizeof(IndexNode) == 96 && sizeof(ByteBoxes) == 48);

constexpr std::array<std::uint64_t, layout::kSectionCount> kElementBytes = {
    sizeof(layout::Metadata),
    1,
    sizeof(layout::Object),
    sizeof(Vec3),
    12,
    1,
    sizeof(IndexNode),
    4,
    4,
    sizeof(ByteBoxes)};

/// Smaller files are read by one thread: starting another one takes as long.
constexpr std::uint64_t kBytesForThreads = std::uint64_t{1} << 20;

std::array<double, 6> corners_of(const Box& box) {
  return {box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()};
}

Box box_of(const std::array<double, 6>& corners) {
  return {Vec3(corners[0], corners[1], corners[2]), Vec3(corners[3], corners[4], corners[5])};
}

base::Digest::Bytes digest_of(const void* bytes, std::size_t size) {
  base::Digest digest;
  digest.add(bytes, size);
  return digest.bytes();
}

base::Digest::Bytes digest_of(layout::Header header) {
  header.digest = {};
  return digest_of(&header, sizeof header);
}

/// The sections of a scene in memory.
class Sections {
 public:
  Sections(const std::string& scene_file, const PreparedScene& prepared) {
    const Mesh& mesh = *prepared.indexed->mesh;
    const IndexArrays& tree = prepared.indexed->tree.arrays();
    fill_metadata(prepared, tree.depth);
    add_texts(scene_file, prepared);
    for (const MeshObject& object : mesh.objects) {
      objects_.push_back({object.triangle_count, static_cast<std::uint32_t>(object.name.size())});
    }
    set(layout::kMetadata, std::span(&metadata_, 1));
    set(layout::kText, std::span(text_));
    set(layout::kObjects, std::span(objects_));
    set(layout::kVertices, std::span(mesh.vertices));
    set(layout::kTriangles, std::span(mesh.triangles));
    if (prepared.field) set(layout::kFieldCodes, std::span(prepared.field->codes()));
    set(layout::kNodes, std::span(tree.nodes));
    set(layout::kLeafBegin, std::span(tree.leaf_begin));
    set(layout::kReferences, std::span(tree.references));
    set(layout::kBoxes, std::span(tree.boxes));
  }
  Sections(const Sections&) = delete;  // refers to itself
  Sections& operator=(const Sections&) = delete;

  [[nodiscard]] std::span<const std::byte> bytes(std::size_t section) const {
    return bytes_[section];
  }

  /// The header without digests.
  [[nodiscard]] layout::Header places() const {
    layout::Header header;
    std::uint64_t end = sizeof header;
    for (std::size_t i = 0; i < layout::kSectionCount; ++i) {
      const std::uint64_t aligned = (end + layout::kAlignment - 1) & ~(layout::kAlignment - 1);
      header.sections[i].offset = aligned;
      header.sections[i].bytes = bytes_[i].size();
      end = aligned + bytes_[i].size();
    }
    return header;
  }

 private:
  template <class Value>
  void set(layout::SectionName section, std::span<Value> values) {
    bytes_[section] = std::as_bytes(values);
  }

  void fill_metadata(const PreparedScene& prepared, std::uint32_t depth) {
    const ImportReport& report = prepared.report;
    metadata_.scale = report.scale;
    metadata_.up = static_cast<std::uint64_t>(report.up);
    metadata_.degenerate_triangles = report.degenerate_triangles;
    metadata_.dropped_nonfinite = report.dropped_nonfinite;
    metadata_.dropped_bad_index = report.dropped_bad_index;
    metadata_.dropped_points_and_lines = report.dropped_points_and_lines;
    metadata_.dropped_freeform = report.dropped_freeform;
    metadata_.ignored_statements = report.ignored_statements;
    metadata_.single_precision = report.single_precision ? 1 : 0;
    metadata_.rounding_m = report.rounding_m;
    metadata_.surface_error_m = report.surface_error_m;
    metadata_.mesh_bounds_m = corners_of(report.bounds_m);
    metadata_.tree_bounds_m = corners_of(prepared.indexed->tree.bounds());
    metadata_.tree_depth = depth;
    if (!prepared.field) return;
    metadata_.field_resolution_m = prepared.field->statistics().resolution_m;
    metadata_.field_settled_share = prepared.field->statistics().settled_share;
  }

  void add_texts(const std::string& scene_file, const PreparedScene& prepared) {
    std::string names;
    for (const MeshObject& object : prepared.indexed->mesh->objects) names += object.name;
    metadata_.file_bytes = scene_file.size();
    metadata_.digest_bytes = prepared.digest.size();
    metadata_.format_bytes = prepared.report.format.size();
    metadata_.why_no_field_bytes = prepared.why_no_field.size();
    text_ = scene_file + prepared.digest + prepared.report.format + prepared.why_no_field + names;
  }

  layout::Metadata metadata_;
  std::string text_;
  std::vector<layout::Object> objects_;
  std::array<std::span<const std::byte>, layout::kSectionCount> bytes_;
};

bool write_at(int fd, std::span<const std::byte> bytes, std::uint64_t offset) {
  while (!bytes.empty()) {
    const ssize_t wrote = pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(wrote));
    offset += static_cast<std::uint64_t>(wrote);
  }
  return true;
}

/// The sections of a file: views of its bytes.
struct Content {
  std::shared_ptr<const FileBytes> file;
  layout::Header header;

  [[nodiscard]] std::span<const std::byte> section(std::size_t name) const {
    const layout::Section& section = header.sections[name];
    return file->bytes().subspan(section.offset, section.bytes);
  }
  /// Requires the type that the section has.
  template <class Value>
  [[nodiscard]] std::span<const Value> values(layout::SectionName name) const {
    const std::span<const std::byte> bytes = section(name);
    return {reinterpret_cast<const Value*>(bytes.data()), bytes.size() / sizeof(Value)};
  }
  template <class Value>
  [[nodiscard]] base::Array<Value> array(layout::SectionName name) const {
    return {file, values<Value>(name)};
  }
  [[nodiscard]] bool is_whole(std::size_t name) const {
    const std::span<const std::byte> bytes = section(name);
    return digest_of(bytes.data(), bytes.size()) == header.sections[name].digest;
  }
  [[nodiscard]] const layout::Metadata& metadata() const {
    return values<layout::Metadata>(layout::kMetadata).front();
  }
  [[nodiscard]] std::string_view text() const {
    const std::span<const char> text = values<char>(layout::kText);
    return {text.data(), text.size()};
  }
};

/// Whether the section begins where its values may and lies in the file.
bool is_placed_well(const layout::Section& section, std::uint64_t element_bytes,
                    std::uint64_t file_bytes) {
  return section.offset % layout::kAlignment == 0 && section.bytes % element_bytes == 0 &&
         section.offset <= file_bytes && section.bytes <= file_bytes - section.offset;
}

/// Returns the content if the header is whole, its sections lie in the file, and there is a
/// `Metadata`. The sections may be damaged.
base::Result<Content> open_content(int fd, FileBytes::Use use) {
  Content content{FileBytes::of(fd, use), {}};
  if (!content.file) return Failure{"the file cannot be read"};
  const std::span<const std::byte> bytes = content.file->bytes();
  if (bytes.size() < sizeof content.header) return Failure{"the file has no header"};
  std::memcpy(&content.header, bytes.data(), sizeof content.header);
  if (content.header.magic != layout::kMagic) return Failure{"the file is no prepared scene"};
  if (content.header.digest != digest_of(content.header)) return Failure{"the header is damaged"};
  for (std::size_t i = 0; i < layout::kSectionCount; ++i) {
    if (!is_placed_well(content.header.sections[i], kElementBytes[i], bytes.size())) {
      return Failure{"a section does not lie in the file"};
    }
  }
  if (content.values<layout::Metadata>(layout::kMetadata).size() != 1) {
    return Failure{"there are no facts"};
  }
  return content;
}

/// Copies a section.
template <class Value>
void copy(std::span<const Value> values, std::vector<Value>& copied) {
  copied.reserve(values.size());
  prepare_pages(copied.data(), values.size_bytes());
  copied.assign(values.begin(), values.end());
}

/// Compares the digests of all sections, and copies vertices and triangles, several at the same
/// time. Returns false if a section is damaged.
bool take_whole(const Content& content, unsigned threads, Mesh& mesh) {
  // The largest first, so that all threads end together.
  std::array<std::size_t, layout::kSectionCount> order{};
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, std::ranges::greater{},
                    [&](std::size_t i) { return content.header.sections[i].bytes; });
  std::array<bool, layout::kSectionCount> is_whole{};
  base::for_each_chunk(threads, order.size(), [&](unsigned, std::size_t i) {
    const std::size_t name = order[i];
    is_whole[name] = content.is_whole(name);
    if (!is_whole[name]) return;
    if (name == layout::kVertices) copy(content.values<Vec3>(layout::kVertices), mesh.vertices);
    if (name == layout::kTriangles) {
      copy(content.values<std::array<std::uint32_t, 3>>(layout::kTriangles), mesh.triangles);
    }
  });
  return std::ranges::all_of(is_whole, [](bool whole) { return whole; });
}

/// Divides the section of texts.
class TextReader {
 public:
  explicit TextReader(std::string_view text) : text_(text) {}

  /// Takes the next text. Returns false if it is longer than what is left, or not printable ASCII.
  bool take(std::uint64_t bytes, std::string& taken) {
    if (bytes > text_.size() - at_) return false;
    taken = text_.substr(at_, bytes);
    at_ += bytes;
    return std::ranges::all_of(taken, [](char c) { return c >= 0x20 && c <= 0x7e; });
  }
  [[nodiscard]] bool is_at_end() const { return at_ == text_.size(); }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

bool is_digest(const std::string& text) {
  return text.size() == 2 * base::Digest::kBytes &&
         text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// Sets texts and objects of the scene. Returns false if they are wrong.
bool take_texts(const Content& content, PreparedScene& prepared, Mesh& mesh) {
  const layout::Metadata& metadata = content.metadata();
  TextReader reader(content.text());
  std::string scene_file;
  if (!reader.take(metadata.file_bytes, scene_file) ||
      !reader.take(metadata.digest_bytes, prepared.digest) || !is_digest(prepared.digest) ||
      !reader.take(metadata.format_bytes, prepared.report.format) ||
      !reader.take(metadata.why_no_field_bytes, prepared.why_no_field)) {
    return false;
  }
  std::uint64_t first = 0;
  for (const layout::Object& object : content.values<layout::Object>(layout::kObjects)) {
    MeshObject& made = mesh.objects.emplace_back();
    made.first_triangle = static_cast<std::uint32_t>(first);
    made.triangle_count = object.triangles;
    first += object.triangles;
    if (object.triangles == 0 || first > mesh.triangles.size()) return false;
    if (!reader.take(object.name_bytes, made.name)) return false;
  }
  return first == mesh.triangles.size() && reader.is_at_end();
}

/// Sets the report. Returns false if a number in it is not valid.
bool take_report(const layout::Metadata& metadata, const Mesh& mesh, const ImportOptions& options,
                 ImportReport& report) {
  report.scale = options.scale;
  report.up = options.up;
  report.vertices = mesh.vertices.size();
  report.triangles = mesh.triangles.size();
  report.objects = mesh.objects.size();
  report.bounds_m = box_of(metadata.mesh_bounds_m);
  report.degenerate_triangles = metadata.degenerate_triangles;
  report.dropped_nonfinite = metadata.dropped_nonfinite;
  report.dropped_bad_index = metadata.dropped_bad_index;
  report.dropped_points_and_lines = metadata.dropped_points_and_lines;
  report.dropped_freeform = metadata.dropped_freeform;
  report.ignored_statements = metadata.ignored_statements;
  report.single_precision = metadata.single_precision != 0;
  report.rounding_m = metadata.rounding_m;
  report.surface_error_m = metadata.surface_error_m;
  return metadata.rounding_m >= 0.0 && std::isfinite(metadata.rounding_m) &&
         metadata.surface_error_m >= 0.0 && std::isfinite(metadata.surface_error_m);
}

/// Sets the field. Returns why it is wrong, or an empty text.
std::string take_field(const Content& content, PreparedScene& prepared) {
  const layout::Metadata& metadata = content.metadata();
  base::Array<std::uint8_t> codes = content.array<std::uint8_t>(layout::kFieldCodes);
  const bool has_field = !codes.empty();
  if (has_field != prepared.why_no_field.empty()) return "there is a field and no field";
  if (!has_field) return {};
  base::Result<std::shared_ptr<const DistanceField>> field =
      DistanceField::of_codes(prepared.report.bounds_m, metadata.field_resolution_m,
                              std::move(codes), metadata.field_settled_share);
  if (field) prepared.field = *std::move(field);
  return field.error;
}

base::Result<IndexTree> tree_of(const Content& content, std::size_t triangles) {
  const layout::Metadata& metadata = content.metadata();
  if (metadata.tree_depth > kMaxIndexDepth) return Failure{"the tree is too deep"};
  IndexArrays arrays{
      content.array<IndexNode>(layout::kNodes), content.array<std::uint32_t>(layout::kLeafBegin),
      content.array<std::uint32_t>(layout::kReferences), content.array<ByteBoxes>(layout::kBoxes),
      static_cast<std::uint32_t>(metadata.tree_depth)};
  return IndexTree::of_arrays(std::move(arrays), triangles, box_of(metadata.tree_bounds_m));
}

/// Makes the scene of what was read. Returns why it is wrong, or an empty text.
std::string assemble(const Content& content, const ImportOptions& options, unsigned threads,
                     Mesh mesh, PreparedScene& prepared) {
  const layout::Metadata& metadata = content.metadata();
  const base::Result<Box> bounds = checked_bounds(mesh, threads);
  if (!bounds) return bounds.error;
  const std::array<double, 6> corners = corners_of(*bounds);
  if (metadata.mesh_bounds_m != corners || metadata.tree_bounds_m != corners) {
    return "the bounds are not those of the triangles";
  }
  if (!take_texts(content, prepared, mesh)) return "the texts are wrong";
  if (!take_report(metadata, mesh, options, prepared.report)) return "the report is wrong";
  if (std::string fault = take_field(content, prepared); !fault.empty()) return fault;
  base::Result<IndexTree> tree = tree_of(content, mesh.triangles.size());
  if (!tree) return tree.error;
  auto indexed = std::make_shared<IndexedMesh>();
  indexed->tree = *std::move(tree);
  indexed->mesh = std::make_shared<const Mesh>(std::move(mesh));
  prepared.indexed = std::move(indexed);
  return {};
}

/// `scene_file` without what a list cannot show.
std::string printable(std::string text) {
  for (char& c : text) c = c >= 0x20 && c <= 0x7e ? c : '?';
  return text;
}

}  // namespace

std::uint64_t prepared_bytes(const std::string& scene_file, const PreparedScene& prepared) {
  const layout::Header header = Sections(printable(scene_file), prepared).places();
  return header.sections.back().offset + header.sections.back().bytes;
}

bool write_prepared(int fd, const SceneKey& key, const std::string& scene_file,
                    const PreparedScene& prepared) {
  const Sections sections(printable(scene_file), prepared);
  layout::Header header = sections.places();
  header.key = key.bytes;
  std::ranges::copy(scene_build(), header.build.begin());
  for (std::size_t i = 0; i < layout::kSectionCount; ++i) {
    const std::span<const std::byte> bytes = sections.bytes(i);
    header.sections[i].digest = digest_of(bytes.data(), bytes.size());
    if (!write_at(fd, bytes, header.sections[i].offset)) return false;
  }
  header.digest = digest_of(header);
  return write_at(fd, std::as_bytes(std::span(&header, 1)), 0);
}

base::Result<PreparedScene> read_prepared(int fd, const SceneKey& key,
                                          const ImportOptions& options) {
  const base::Result<Content> content = open_content(fd, FileBytes::Use::kLong);
  if (!content) return Failure{content.error};
  const std::array<char, 32>& build = content->header.build;
  if (content->header.key != key.bytes ||
      std::string_view(build.data(), build.size()) != scene_build()) {
    return Failure{"the file holds another scene, or is of another build"};
  }
  const bool is_small = content->file->bytes().size() < kBytesForThreads;
  const unsigned threads = is_small ? 1 : base::chunk_threads(0);
  Mesh mesh;
  if (!take_whole(*content, threads, mesh)) return Failure{"a section is damaged"};
  PreparedScene prepared;
  std::string fault = assemble(*content, options, threads, std::move(mesh), prepared);
  if (!fault.empty()) return Failure{std::move(fault)};
  return prepared;
}

base::Result<PreparedMetadata> read_prepared_metadata(int fd) {
  const base::Result<Content> content = open_content(fd, FileBytes::Use::kBrief);
  if (!content) return Failure{content.error};
  if (!content->is_whole(layout::kMetadata) || !content->is_whole(layout::kText)) {
    return Failure{"the facts are damaged"};
  }
  PreparedMetadata metadata;
  metadata.scale = content->metadata().scale;
  metadata.up = static_cast<UpAxis>(content->metadata().up);
  if (content->metadata().up >= names_of(UpAxis{}).size()) return Failure{"the facts are wrong"};
  if (!TextReader(content->text()).take(content->metadata().file_bytes, metadata.scene_file)) {
    return Failure{"the texts are wrong"};
  }
  metadata.triangles =
      content->section(layout::kTriangles).size() / kElementBytes[layout::kTriangles];
  metadata.build = printable({content->header.build.data(), content->header.build.size()});
  return metadata;
}

}  // namespace camway::scene
