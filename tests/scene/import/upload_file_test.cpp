// SPDX-License-Identifier: MIT
#include "daemon/scene/import/upload_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tests/support/temporary_folder.h"

namespace camway::scene {
namespace {

namespace fs = std::filesystem;

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

class UploadFileTest : public ::testing::Test {
 protected:
  UploadFileTest() {
    if (const char* const before = std::getenv("TMPDIR")) before_ = before;
    setenv("TMPDIR", folder_.path().c_str(), 1);
  }
  ~UploadFileTest() override {
    before_ ? setenv("TMPDIR", before_->c_str(), 1) : unsetenv("TMPDIR");
  }

  [[nodiscard]] auto files() const {
    return std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator());
  }

  const testing::TemporaryFolder folder_;

 private:
  std::optional<std::string> before_;
};

TEST_F(UploadFileTest, HoldsTheBytesAndGoes) {
  {
    const UploadFile file(bytes_of("v 0 0 0\n"), "obj");
    ASSERT_TRUE(file.is_good());
    EXPECT_EQ(file.path().parent_path(), folder_.path());
    EXPECT_EQ(file.path().extension(), ".obj");
    std::ifstream in(file.path());
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "v 0 0 0\n");
    EXPECT_EQ(remove_left_upload_files(), 0U) << "of a process that lives";
    EXPECT_TRUE(fs::exists(file.path()));
  }
  EXPECT_EQ(files(), 0);
}

TEST_F(UploadFileTest, WhatAKilledProcessLeftIsRemovedAndNothingElse) {
  const pid_t child = fork();
  if (child == 0) {
    const UploadFile file(bytes_of("v 0 0 0\n"), "obj");
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_EQ(files(), 1);
  const UploadFile own(bytes_of("v 0 0 0\n"), "off");
  folder_.write("upload.obj", "of somebody");
  fs::create_directory(folder_.path() / "camway_upload_folder");
  fs::create_symlink("upload.obj", folder_.path() / "camway_upload_link.obj");
  EXPECT_EQ(remove_left_upload_files(), 1U);
  EXPECT_EQ(files(), 4);
  EXPECT_TRUE(fs::exists(own.path()));
  EXPECT_EQ(remove_left_upload_files(), 0U);
}

TEST_F(UploadFileTest, IsNotGoodWithoutAFolder) {
  setenv("TMPDIR", "/nowhere", 1);
  EXPECT_FALSE(UploadFile(bytes_of("x"), "obj").is_good());
  EXPECT_EQ(remove_left_upload_files(), 0U);
}

}  // namespace
}  // namespace camway::scene
