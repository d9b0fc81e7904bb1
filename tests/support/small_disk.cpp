// SPDX-License-Identifier: MIT
#include "tests/support/small_disk.h"

#include <fcntl.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "daemon/base/file_descriptor.h"

namespace camway::testing {

SmallDisk::SmallDisk(std::size_t kibibytes) {
  std::filesystem::create_directory(folder_.path() / "disk");
  const std::string script = "mount -t tmpfs -o size=" + std::to_string(kibibytes) +
                             "k tmpfs \"$0\" && echo mounted && exec sleep 3600";
  holder_ = std::make_unique<integration::Process>(
      std::vector<std::string>{"/usr/bin/unshare", "--mount", "--propagation", "private", "/bin/sh",
                               "-c", script, (folder_.path() / "disk").string()},
      (folder_.path() / "output").string());
  integration::eventually([&] {
    is_there_ = holder_->output().find("mounted") != std::string::npos;
    return is_there_ || !holder_->running();
  });
}

std::filesystem::path SmallDisk::path() const {
  return "/proc/" + std::to_string(holder_->pid()) + "/root" + (folder_.path() / "disk").string();
}

void SmallDisk::fill() const {
  const base::FileDescriptor file(
      ::open((path() / "fill").c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600));
  const std::vector<char> block(4096, 'x');
  while (::write(file.get(), block.data(), block.size()) > 0) {
  }
}

void SmallDisk::make_room() const { std::filesystem::remove(path() / "fill"); }

}  // namespace camway::testing
