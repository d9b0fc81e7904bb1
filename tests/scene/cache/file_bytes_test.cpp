// SPDX-License-Identifier: MIT
#include "daemon/scene/cache/file_bytes.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "daemon/base/file_descriptor.h"
#include "tests/support/random.h"
#include "tests/support/temporary_folder.h"

namespace camway::scene {
namespace {

base::FileDescriptor open_to_read(const std::string& file) {
  return base::FileDescriptor(open(file.c_str(), O_RDONLY | O_CLOEXEC));
}

std::string text_of(const FileBytes& bytes) {
  std::string text;
  for (const std::byte byte : bytes.bytes()) text += static_cast<char>(byte);
  return text;
}

TEST(FileBytes, AreTheSameMappedAndRead) {
  const testing::TemporaryFolder folder;
  testing::Random random(20261125);
  for (const std::size_t size : {1U, 63U, 4096U, 4097U, 5'000'000U}) {
    std::string text(size, ' ');
    std::ranges::generate(text, [&] { return static_cast<char>(random() % 256); });
    const base::FileDescriptor file = open_to_read(folder.write("file", text));
    for (const auto& bytes : {FileBytes::mapped(file.get()), FileBytes::read(file.get()),
                              FileBytes::of(file.get(), FileBytes::Use::kBrief),
                              FileBytes::of(file.get(), FileBytes::Use::kLong)}) {
      ASSERT_TRUE(bytes);
      EXPECT_TRUE(text_of(*bytes) == text) << size;
    }
  }
}

TEST(FileBytes, AreNoneOfWhatHasNone) {
  const testing::TemporaryFolder folder;
  const base::FileDescriptor empty = open_to_read(folder.write("empty", ""));
  const base::FileDescriptor none = open_to_read("/none");
  for (const int fd : {empty.get(), none.get()}) {
    EXPECT_FALSE(FileBytes::mapped(fd));
    EXPECT_FALSE(FileBytes::read(fd));
  }
}

}  // namespace
}  // namespace camway::scene
