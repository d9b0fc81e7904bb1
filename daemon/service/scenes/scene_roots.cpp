// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/scene_roots.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "daemon/base/file_descriptor.h"
#include "lcmtypes/wire/channels.h"

namespace camway::service {
namespace {

namespace fs = std::filesystem;

using base::FileDescriptor;

/// Compares component by component, so that /scenes2 is not below /scenes. Requires canonical
/// paths.
bool is_below(const fs::path& file, const fs::path& folder) {
  const auto [in_folder, in_file] =
      std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return in_folder == folder.end() && in_file != file.end();
}

/// Returns the real path of the open folder, whatever its name led to when it was opened.
fs::path place_of(const FileDescriptor& folder) {
  std::error_code failed;
  return fs::read_symlink("/proc/self/fd/" + std::to_string(folder.get()), failed);
}

bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// Writes under another name first, so that no reader sees half of the file. Returns an error or an
/// empty text.
std::string write_in(const FileDescriptor& folder, const std::string& name,
                     std::string_view bytes) {
  const std::string unfinished = "." + name + ".unfinished";
  unlinkat(folder.get(), unfinished.c_str(), 0);
  const FileDescriptor file(openat(folder.get(), unfinished.c_str(),
                                   O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644));
  const bool done = file.is_open() && write_all(file.get(), bytes) && fsync(file.get()) == 0 &&
                    renameat(folder.get(), unfinished.c_str(), folder.get(), name.c_str()) == 0;
  if (done) return {};
  std::string why = std::generic_category().message(errno);
  unlinkat(folder.get(), unfinished.c_str(), 0);
  return why;
}

}  // namespace

base::Result<SceneRoots> SceneRoots::make(const std::vector<fs::path>& folders) {
  SceneRoots roots;
  for (const fs::path& folder : folders) {
    std::error_code failed;
    fs::path canonical = fs::canonical(folder, failed);
    if (failed || !fs::is_directory(canonical, failed)) {
      return base::Failure{"scene root '" + folder.string() + "' is not a folder that can be read"};
    }
    roots.folders_.push_back(std::move(canonical));
  }
  return roots;
}

base::Result<fs::path> SceneRoots::resolve(std::string_view asked) const {
  const std::string shown = wire::printable(std::string(asked));
  const auto refuse = [&](const std::string& reason) {
    return base::Failure{"file: '" + shown + "' " + reason};
  };
  if (folders_.empty()) return refuse("cannot be read: the daemon has no scene roots");
  const fs::path wanted(asked);
  if (asked.empty() || asked.find('\0') != std::string_view::npos) return refuse("names no file");
  if (std::find(wanted.begin(), wanted.end(), "..") != wanted.end()) {
    return refuse("must not contain '..'");
  }
  bool leads_out = false;
  for (const fs::path& folder : folders_) {
    std::error_code failed;
    fs::path file = fs::canonical(folder / wanted, failed);
    if (failed) continue;
    if (!is_below(file, folder)) {
      leads_out = true;
      continue;
    }
    if (fs::is_regular_file(file, failed)) return file;
  }
  return refuse(leads_out ? "leads out of the scene roots"
                          : "is no file below a scene root, to which its path is relative");
}

std::string SceneRoots::write(std::string_view asked, std::string_view extension,
                              std::string_view bytes) const {
  constexpr std::size_t kLongestName = 200;
  const std::string shown = wire::printable(std::string(asked));
  const auto refuse = [&](const std::string& reason) { return "file: '" + shown + "' " + reason; };
  if (folders_.empty()) return refuse("cannot be written: the daemon has no scene roots");
  const fs::path wanted(asked);
  const std::string name = wanted.filename().string();
  if (asked.find('\0') != std::string_view::npos || name.size() <= extension.size() ||
      name.size() > kLongestName || !name.ends_with(extension) || name.front() == '.') {
    return refuse("must end with " + std::string(extension) + " and not begin with '.'");
  }
  if (std::find(wanted.begin(), wanted.end(), "..") != wanted.end()) {
    return refuse("must not contain '..'");
  }
  for (const fs::path& root : folders_) {
    const FileDescriptor folder(
        open((root / wanted).parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!folder.is_open()) continue;
    const fs::path place = place_of(folder);
    if (place != root && !is_below(place, root)) continue;
    const std::string why = write_in(folder, name, bytes);
    return why.empty() ? "" : refuse("cannot be written: " + why);
  }
  return refuse("is in no folder below a scene root");
}

}  // namespace camway::service
