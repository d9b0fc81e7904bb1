// SPDX-License-Identifier: MIT
#include "tools/output_file.h"

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
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size() &&
                       std::fflush(out) == 0 && (!to_disk || ::fsync(::fileno(out)) == 0);
  const int why = written ? 0 : errno;
  if (std::fclose(out) != 0 && why == 0) return errno;
  return why;
}

int write_whole(const fs::path& file, std::string_view bytes) {
  const fs::path unfinished = file.string() + ".unfinished";
  int why = write_as_it_comes(unfinished, bytes, /*to_disk=*/true);
  if (why == 0 && std::rename(unfinished.c_str(), file.c_str()) != 0) why = errno;
  if (why != 0) {
    std::error_code ignored;
    fs::remove(unfinished, ignored);
  }
  return why;
}

}  // namespace

std::string write_file(const fs::path& file, std::string_view bytes) {
  std::error_code failed;
  const fs::file_type type = fs::symlink_status(file, failed).type();
  const bool is_ordinary = type == fs::file_type::regular || type == fs::file_type::not_found;
  const int why =
      is_ordinary ? write_whole(file, bytes) : write_as_it_comes(file, bytes, /*to_disk=*/false);
  if (why == 0) return {};
  return file.string() + ": cannot be written: " + std::generic_category().message(why);
}

}  // namespace camway::tools
