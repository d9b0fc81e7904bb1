// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "daemon/service/scenes/uploads.h"

namespace camway::service {

/// An upload as a file of our own, as the import process opens files by name; it goes when this
/// does. As long as its process lives the file is locked, so that who finds it knows whose it is.
class UploadFile {
 public:
  /// In the folder for temporary files. The name ends with `.extension`, which tells the importer
  /// the format.
  UploadFile(const UploadRoom& bytes, const std::string& extension);
  ~UploadFile();
  UploadFile(const UploadFile&) = delete;
  UploadFile& operator=(const UploadFile&) = delete;

  /// Whether all bytes are in it.
  [[nodiscard]] bool is_good() const { return is_good_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int file_ = -1;
  bool is_good_ = false;
};

/// Removes the files of uploads that processes of this user left behind when they were killed, and
/// no others. How many it were.
std::size_t remove_left_upload_files();

}  // namespace camway::service
