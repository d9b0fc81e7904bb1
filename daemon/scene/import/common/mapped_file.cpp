// SPDX-License-Identifier: MIT
#include "daemon/scene/import/common/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace camway::scene::import_process {

MappedFile::MappedFile(const std::string& file) : fd_(open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
  struct stat information {};
  if (fd_ < 0 || fstat(fd_, &information) != 0) return;
  size_ = static_cast<std::size_t>(information.st_size);
  void* const data = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, fd_, 0);
  if (data != MAP_FAILED) data_ = data;
}

MappedFile::~MappedFile() {
  if (is_open()) munmap(data_, size_);
  if (fd_ >= 0) close(fd_);
}

}  // namespace camway::scene::import_process
