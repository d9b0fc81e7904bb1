// SPDX-License-Identifier: MIT
#include "tools/support/output_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

/// Returns the system's error, or 0.
int write_as_it_comes(const fs::path& file, std::string_view bytes, bool to_disk) {
  errno = 0;
  std::FILE* const out = std::fopen(file.c_str(), "wb");
  if (out == nullptr) return errno;
  // The view of nothing has no data, which fwrite requires even where it writes none.
  const std::size_t wrote = bytes.empty() ? 0 : std::fwrite(bytes.data(), 1, bytes.size(), out);
  const bool written =
      wrote == bytes.size() && std::fflush(out) == 0 && (!to_disk || ::fsync(::fileno(out)) == 0);
  const int why = written ? 0 : errno;
  if (std::fclose(out) != 0 && why == 0) return errno;
  return why;
}

fs::path unfinished_file(const fs::path& file) { return file.string() + ".unfinished"; }

int write_whole(const fs::path& file, std::string_view bytes) {
  const fs::path unfinished = unfinished_file(file);
  int why = write_as_it_comes(unfinished, bytes, /*to_disk=*/true);
  if (why == 0 && std::rename(unfinished.c_str(), file.c_str()) != 0) why = errno;
  if (why != 0) {
    std::error_code ignored;
    fs::remove(unfinished, ignored);
  }
  return why;
}

/// Returns whether a file may be replaced by another one: whether it is a regular file or missing.
bool is_ordinary(const fs::path& file) {
  std::error_code failed;
  const fs::file_type type = fs::symlink_status(file, failed).type();
  return type == fs::file_type::regular || type == fs::file_type::not_found;
}

std::string fault(const fs::path& file, int why) {
  if (why == 0) return {};
  return file.string() + ": cannot be written: " + std::generic_category().message(why);
}

}  // namespace

std::string write_file(const fs::path& file, std::string_view bytes) {
  return fault(file, is_ordinary(file) ? write_whole(file, bytes)
                                       : write_as_it_comes(file, bytes, /*to_disk=*/false));
}

std::string why_unwritable(const fs::path& file, const std::vector<std::string>& inputs) {
  // Commands that write a file to standard output ask nothing here.
  if (file == "-") return "-: is no file, and standard output has other text; ./- is one";
  std::error_code ignored;
  for (const std::string& input : inputs) {
    if (fs::equivalent(file, input, ignored)) {
      return file.string() + ": is read, so it is not written";
    }
  }
  if (fs::is_directory(file, ignored)) return fault(file, EISDIR);
  if (!is_ordinary(file)) {
    // Opening a pipe would wait for its reader. Writing to a dangling link makes its target.
    const bool may = ::access(file.c_str(), W_OK) == 0 || errno == ENOENT;
    return fault(file, may ? 0 : errno);
  }
  const fs::path unfinished = unfinished_file(file);
  const int why = write_as_it_comes(unfinished, {}, /*to_disk=*/false);
  fs::remove(unfinished, ignored);
  return fault(file, why);
}

}  // namespace camway::tools
