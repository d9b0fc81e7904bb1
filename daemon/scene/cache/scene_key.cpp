// SPDX-License-Identifier: MIT
#include "daemon/scene/cache/scene_key.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <type_traits>
#include <vector>

#include "daemon/base/file_descriptor.h"
#include "daemon/scene/import/record/own_formats.h"

namespace camway::scene {
namespace {

/// Adds the bytes of a number or an enumeration.
template <class Value>
void add(base::Digest& digest, const Value& value) {
  static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>);
  digest.add(&value, sizeof value);
}

/// Returns the extension in lower case if the format has a reader of our own; else nothing.
std::optional<std::string> own_format(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (std::ranges::find(kOwnFormats, extension) == kOwnFormats.end()) return std::nullopt;
  return extension;
}

/// Adds the content of a file. Reads it: a mapped file that is cut meanwhile would end the process.
bool add_content(base::Digest& digest, const std::filesystem::path& path) {
  // A pipe would block.
  const base::FileDescriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (file.get() < 0 || fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  constexpr std::size_t kReadBytes = std::size_t{1} << 18;
  std::vector<std::byte> piece(std::min(kReadBytes, static_cast<std::size_t>(status.st_size) + 1));
  std::uint64_t size = 0;
  for (;;) {
    const ssize_t got = read(file.get(), piece.data(), piece.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return false;
    if (got == 0) break;
    digest.add(piece.data(), static_cast<std::size_t>(got));
    size += static_cast<std::uint64_t>(got);
  }
  add(digest, size);
  return true;
}

void add_options(base::Digest& digest, const PreparationOptions& options) {
  add(digest, options.import.scale);
  add(digest, options.import.up);
  add(digest, options.import.memory_limit_bytes);
  add(digest, options.index.threshold);
  add(digest, options.index.max_depth);
  add(digest, options.index.max_duplication);
  add(digest, options.field.has_value());
  if (options.field) add(digest, options.field->memory_limit_bytes);
}

}  // namespace

std::optional<SceneKey> scene_key(const std::filesystem::path& file,
                                  const PreparationOptions& options) {
  const std::optional<std::string> format = own_format(file);
  if (!format) return std::nullopt;
  base::Digest digest;
  if (!add_content(digest, file)) return std::nullopt;
  digest.add(format->data(), format->size());
  digest.add(scene_build().data(), scene_build().size());
  add_options(digest, options);
  return SceneKey{digest.bytes()};
}

}  // namespace camway::scene
