// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace camway::scene {

/// A temporary file with the bytes of an upload, because the import process opens files by name.
/// The destructor removes it. The file is locked as long as this object lives, so that
/// `remove_left_upload_files` of other processes can distinguish it from a file that was left
/// behind.
class UploadFile {
 public:
  /// Writes the file into the folder for temporary files. Its name ends with `.extension`, which
  /// tells the importer the format.
  UploadFile(std::span<const std::uint8_t> bytes, const std::string& extension);
  ~UploadFile();
  UploadFile(const UploadFile&) = delete;
  UploadFile& operator=(const UploadFile&) = delete;

  /// Returns whether all bytes were written.
  [[nodiscard]] bool is_good() const { return is_good_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int file_ = -1;
  bool is_good_ = false;
};

/// Removes the upload files that killed processes of this user left behind, and no others. Returns
/// their number.
std::size_t remove_left_upload_files();

}  // namespace camway::scene
