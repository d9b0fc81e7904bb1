// SPDX-License-Identifier: MIT
#include "daemon/scene/cache/scene_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <ctime>
#include <new>
#include <string_view>
#include <system_error>
#include <utility>

#include "daemon/base/file_descriptor.h"
#include "daemon/scene/cache/cache_file.h"

namespace camway::scene {
namespace {

namespace fs = std::filesystem;
using base::FileDescriptor;

constexpr std::string_view kSuffix = ".scene";
constexpr std::string_view kUnfinished = ".unfinished-";
/// A file that is unfinished for longer was left behind by a process that ended.
constexpr std::time_t kLongestWrite_s = 3600;

std::string file_name(const SceneKey& key) { return key.text() + std::string(kSuffix); }

bool is_scene_name(std::string_view name) {
  constexpr std::size_t kDigits = 2 * base::Digest::kBytes;
  return name.size() == kDigits + kSuffix.size() && name.ends_with(kSuffix) &&
         name.find_first_not_of("0123456789abcdef") == kDigits;
}

/// Why a folder or file is not used; empty if nobody else can have written it.
std::string fault_in(const struct stat& status) {
  if (status.st_uid != geteuid()) return "belongs to another user";
  if ((status.st_mode & (S_IWGRP | S_IWOTH)) != 0) return "can be written by others";
  return {};
}

FileDescriptor open_folder(const fs::path& folder, std::string& fault) {
  FileDescriptor opened(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  struct stat status {};
  if (!opened.is_open()) {
    if (errno != ENOENT) fault = "cannot be opened: " + std::generic_category().message(errno);
    return opened;
  }
  fault = fstat(opened.get(), &status) == 0 ? fault_in(status) : "cannot be looked at";
  return fault.empty() ? std::move(opened) : FileDescriptor(-1);
}

/// Opens the folder; none if it is not there or is not used.
FileDescriptor open_folder(const fs::path& folder) {
  std::string fault;
  return open_folder(folder, fault);
}

/// Makes the folder and those above it, all for this user alone.
FileDescriptor make_folder(const fs::path& folder) {
  fs::path made;
  for (const fs::path& part : folder) {
    made /= part;
    if (mkdir(made.c_str(), S_IRWXU) != 0 && errno != EEXIST) break;
  }
  return open_folder(folder);
}

/// Why a folder that is not there cannot be made; empty if it can. Tries it with the first part
/// that is missing, which it removes again: permissions do not tell, as root has all of them in
/// /proc, too.
std::string fault_of_missing(const fs::path& folder) {
  std::error_code error;
  fs::path missing = fs::absolute(folder, error);
  while (missing.has_relative_path() && !fs::exists(missing.parent_path(), error)) {
    missing = missing.parent_path();
  }
  if (mkdir(missing.c_str(), S_IRWXU) == 0) {
    rmdir(missing.c_str());  // fails if another process has made its cache there by now
    return {};
  }
  const int reason = errno;
  if (reason == EEXIST && fs::is_directory(missing, error)) return {};
  return "cannot be made: " + std::generic_category().message(reason);
}

/// Opens a file of the cache; none if somebody else can have written it.
FileDescriptor open_file(const FileDescriptor& folder, const std::string& name,
                         struct stat& status) {
  FileDescriptor file(
      openat(folder.get(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK));
  if (!file.is_open() || fstat(file.get(), &status) != 0) return FileDescriptor(-1);
  const bool is_ours = S_ISREG(status.st_mode) && fault_in(status).empty();
  return is_ours ? std::move(file) : FileDescriptor(-1);
}

/// A file in the folder, of which nothing was read.
struct Found {
  std::string name;
  std::time_t last_used_s = 0;
  std::uint64_t bytes = 0;
};

/// The files of the cache in the folder, the one last used first.
std::vector<Found> files_in(const FileDescriptor& folder) {
  std::vector<Found> files;
  std::error_code error;
  // By its descriptor: the name could mean another folder by now.
  fs::directory_iterator entry("/proc/self/fd/" + std::to_string(folder.get()), error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!is_scene_name(name) && !name.starts_with(kUnfinished)) continue;
    struct stat status {};
    if (fstatat(folder.get(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0) continue;
    files.push_back({name, status.st_mtime, static_cast<std::uint64_t>(status.st_size)});
  }
  std::ranges::sort(files, std::ranges::greater{}, &Found::last_used_s);
  return files;
}

/// Removes what was used the longest ago until `bytes` more fit the limit.
void make_room(const FileDescriptor& folder, std::uint64_t bytes, std::uint64_t limit_bytes) {
  const std::time_t now_s = std::time(nullptr);
  std::uint64_t kept_bytes = bytes;
  for (const Found& file : files_in(folder)) {
    const bool is_unfinished = file.name.starts_with(kUnfinished);
    const bool is_left_behind = is_unfinished && now_s - file.last_used_s > kLongestWrite_s;
    const bool fits = file.bytes <= limit_bytes - std::min(kept_bytes, limit_bytes);
    if (is_left_behind || (!is_unfinished && !fits)) {
      unlinkat(folder.get(), file.name.c_str(), 0);
    } else {
      kept_bytes += file.bytes;
    }
  }
}

/// Removes a file, unless another process has put a new one in its place.
void remove_if_same(const FileDescriptor& folder, const std::string& name,
                    const struct stat& opened) {
  struct stat now {};
  if (fstatat(folder.get(), name.c_str(), &now, AT_SYMLINK_NOFOLLOW) != 0) return;
  if (now.st_ino != opened.st_ino || now.st_dev != opened.st_dev) return;
  unlinkat(folder.get(), name.c_str(), 0);
}

/// A name that no other thread or process uses.
std::string unfinished_name() {
  const char mark = 0;  // its address differs from thread to thread
  return std::string(kUnfinished) + std::to_string(getpid()) + "-" +
         std::to_string(reinterpret_cast<std::uintptr_t>(&mark)) + "-" +
         std::to_string(std::chrono::steady_clock::now().time_since_epoch().count());
}

const char* variable(const char* name) {
  return std::getenv(name);  // NOLINT(concurrency-mt-unsafe): never set by us
}

}  // namespace

std::string SceneCache::fault() const {
  std::string fault;
  const FileDescriptor folder = open_folder(folder_, fault);
  return folder.is_open() || !fault.empty() ? fault : fault_of_missing(folder_);
}

std::optional<PreparedScene> SceneCache::find(const SceneKey& key,
                                              const ImportOptions& options) const {
  const FileDescriptor folder = open_folder(folder_);
  struct stat status {};
  if (!folder.is_open()) return std::nullopt;
  const FileDescriptor file = open_file(folder, file_name(key), status);
  if (!file.is_open()) return std::nullopt;
  try {
    base::Result<PreparedScene> read = read_prepared(file.get(), key, options);
    if (!read) {
      remove_if_same(folder, file_name(key), status);
      return std::nullopt;
    }
    futimens(file.get(), nullptr);
    return *std::move(read);
  } catch (const std::bad_alloc&) {
    return std::nullopt;
  }
}

bool SceneCache::store(const SceneKey& key, const fs::path& scene_file,
                       const PreparedScene& prepared) const {
  if (prepared.indexed->mesh->triangles.size() < limits_.least_triangles) return false;
  std::error_code error;
  const fs::path whole = fs::absolute(scene_file, error);
  const std::string shown = (error ? scene_file : whole).string();
  const std::uint64_t bytes = prepared_bytes(shown, prepared);
  if (bytes > limits_.bytes) return false;
  const FileDescriptor folder = make_folder(folder_);
  if (!folder.is_open()) return false;
  make_room(folder, bytes, limits_.bytes);
  const std::string name = unfinished_name();
  const FileDescriptor file(openat(folder.get(), name.c_str(),
                                   O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                                   S_IRUSR | S_IWUSR));
  if (!file.is_open()) return false;
  // Without fsync: after a power failure the digests tell whether all of the file is there.
  const bool is_kept =
      write_prepared(file.get(), key, shown, prepared) &&
      renameat(folder.get(), name.c_str(), folder.get(), file_name(key).c_str()) == 0;
  if (!is_kept) unlinkat(folder.get(), name.c_str(), 0);
  return is_kept;
}

std::vector<CachedScene> SceneCache::scenes() const {
  std::vector<CachedScene> scenes;
  const FileDescriptor folder = open_folder(folder_);
  if (!folder.is_open()) return scenes;
  for (const Found& found : files_in(folder)) {
    struct stat status {};
    const FileDescriptor file = open_file(folder, found.name, status);
    if (!file.is_open() || !is_scene_name(found.name)) continue;
    base::Result<PreparedMetadata> metadata = read_prepared_metadata(file.get());
    if (!metadata) continue;
    CachedScene& scene = scenes.emplace_back();
    scene.key = found.name.substr(0, found.name.size() - kSuffix.size());
    scene.scene_file = std::move(metadata->scene_file);
    scene.scale = metadata->scale;
    scene.up = metadata->up;
    scene.triangles = metadata->triangles;
    scene.bytes = found.bytes;
    scene.last_used = std::chrono::system_clock::from_time_t(found.last_used_s);
    scene.is_of_this_build = metadata->build == scene_build();
  }
  return scenes;
}

std::size_t SceneCache::clear() const {
  std::size_t removed = 0;
  const FileDescriptor folder = open_folder(folder_);
  if (!folder.is_open()) return removed;
  for (const Found& file : files_in(folder)) {
    const bool is_gone = unlinkat(folder.get(), file.name.c_str(), 0) == 0;
    removed += is_gone && is_scene_name(file.name) ? 1U : 0U;
  }
  return removed;
}

fs::path cache_folder_of_environment() {
  if (const char* own = variable("CAMWAY_CACHE_DIR")) return own;
  const char* xdg = variable("XDG_CACHE_HOME");
  // The specification tells to ignore relative paths.
  if (xdg != nullptr && *xdg == '/') return fs::path(xdg) / "camway";
  const char* home = variable("HOME");
  if (home != nullptr && *home == '/') return fs::path(home) / ".cache/camway";
  return {};
}

UserCache cache_of_environment() {
  UserCache user;
  SceneCacheLimits limits;
  if (const char* bytes = variable("CAMWAY_CACHE_BYTES")) {
    const std::string_view text = bytes;
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size()) {
      limits.bytes = value;
    } else {
      user.fault = fmt::format(
          "CAMWAY_CACHE_BYTES is '{}'; it must be a whole number of bytes below 2^64", text);
    }
  }
  fs::path folder = cache_folder_of_environment();
  if (folder.empty()) {
    user.absence = variable("CAMWAY_CACHE_DIR") != nullptr
                       ? "CAMWAY_CACHE_DIR is empty"
                       : "none of CAMWAY_CACHE_DIR, XDG_CACHE_HOME and HOME names a folder";
  } else if (limits.bytes == 0) {
    user.absence = "CAMWAY_CACHE_BYTES is 0";
  } else {
    user.cache.emplace(std::move(folder), limits);
  }
  return user;
}

}  // namespace camway::scene
