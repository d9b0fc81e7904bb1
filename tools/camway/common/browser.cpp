// SPDX-License-Identifier: MIT
#include "tools/camway/common/browser.h"

#include <fmt/format.h>
#include <spawn.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <filesystem>

namespace camway::tools {

Browser::~Browser() {
  if (!file_.empty()) ::unlink(file_.c_str());
}

std::string Browser::open(const std::string& url) {
  constexpr char kExtension[] = ".html";
  std::error_code failed;
  std::string name =
      (std::filesystem::temp_directory_path(failed) / "camway_view_XXXXXX.html").string();
  const int file = ::mkstemps(name.data(), static_cast<int>(std::strlen(kExtension)));  // mode 0600
  if (failed || file < 0) return "no browser can be opened: there is no folder for a file";
  file_ = name;
  const std::string page = fmt::format(
      "<!DOCTYPE html><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" content=\"0; "
      "url={0}\"><a href=\"{0}\">Camway</a>\n",
      url);
  const bool is_written =
      ::write(file, page.data(), page.size()) == static_cast<ssize_t>(page.size());
  ::close(file);
  if (!is_written) return "no browser can be opened: " + name + " cannot be written";
  std::string program = "xdg-open";
  const std::array<char*, 3> arguments{program.data(), name.data(), nullptr};
  // Otherwise the browser would not end by signals that are blocked here.
  posix_spawnattr_t attributes;
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  pid_t child = 0;
  const int error =
      ::posix_spawnp(&child, program.c_str(), nullptr, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  return error == 0 ? ""
                    : std::string("no browser can be opened: xdg-open: ") + std::strerror(error);
}

}  // namespace camway::tools
