// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/auth/message_keys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "tests/support/temporary_folder.h"

namespace camway::wire {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kOne(64, '1');
const std::string kTwo(64, 'a');

std::string error_of(const std::string& text) {
  const MessageKeys::ReadResult read = MessageKeys::from_text(text, "keys");
  EXPECT_EQ(read.keys == nullptr, !read.error.empty());
  return read.error;
}

TEST(MessageKeys, ReadsIdsKeysAndRemarks) {
  const MessageKeys::ReadResult read = MessageKeys::from_text(
      "# old and new\n\n 7 " + kOne + "\r\n2147483647\t" + kTwo + " # b", "k");
  ASSERT_TRUE(read.keys) << read.error;
  EXPECT_THAT(read.keys->ids(), ElementsAre(7, 2147483647));
}

TEST(MessageKeys, NamesTheLineThatIsWrongAndNeverTheSecret) {
  EXPECT_EQ(error_of(""), "keys: holds no key");
  EXPECT_EQ(error_of("\n1\n"), "keys:2: the key is not of 64 hexadecimal digits");
  for (const std::string& line :
       {"1 " + kOne.substr(1), "1 " + kOne + "1", "1 " + kOne.substr(1) + "g", "x " + kOne,
        "-1 " + kOne, "2147483648 " + kOne, "1 " + kOne + " 2", "1" + kOne, "1x " + kOne}) {
    const std::string error = error_of(line);
    EXPECT_THAT(error, HasSubstr("keys:1: ")) << line;
    EXPECT_EQ(error.find("1111"), std::string::npos) << error;
  }
  EXPECT_EQ(error_of("1 " + kOne + "\n1 " + kTwo), "keys:2: id 1 is there twice");
  std::string many;
  for (int i = 0; i < 65; ++i) many += std::to_string(i) + " " + kOne + "\n";
  EXPECT_EQ(error_of(many), "keys:65: more than 64 keys");
}

/// Gives the process the rights of another user during its lifetime, who is still in root's group.
class AsSomebody {
 public:
  static constexpr uid_t kUser = 65534;
  AsSomebody() { EXPECT_EQ(seteuid(kUser), 0); }
  ~AsSomebody() { EXPECT_EQ(seteuid(0), 0); }
  AsSomebody(const AsSomebody&) = delete;
  AsSomebody& operator=(const AsSomebody&) = delete;
};

/// A key file with this owner and mode, in root's group.
class OwnedFile {
 public:
  OwnedFile() : name_(folder_.write("keys", "1 " + kOne + "\n")) {
    chmod(folder_.path().c_str(), 0711);
  }
  [[nodiscard]] MessageKeys::ReadResult read(mode_t mode) const {
    chmod(name_.c_str(), mode);
    return MessageKeys::from_file(name_);
  }
  [[nodiscard]] MessageKeys::ReadResult read_as_somebody(uid_t owner, mode_t mode) const {
    EXPECT_EQ(chown(name_.c_str(), owner, 0), 0);
    chmod(name_.c_str(), mode);
    const AsSomebody rights;
    return MessageKeys::from_file(name_);
  }

 private:
  const testing::TemporaryFolder folder_;
  const std::string name_;
};

TEST(MessageKeys, AFileThatOthersMayReadIsRefused) {
  const OwnedFile file;
  for (const mode_t mode : {0604U, 0620U, 0602U, 0610U, 0601U, 0666U}) {
    EXPECT_THAT(file.read(mode).error, HasSubstr("chmod 600")) << mode;
  }
  for (const mode_t mode : {0600U, 0400U}) EXPECT_TRUE(file.read(mode).keys) << mode;
}

TEST(MessageKeys, AFileOfRootsMayBeReadByItsGroup) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can be somebody else";
  const OwnedFile file;
  for (const mode_t mode : {0640U, 0440U}) {
    EXPECT_TRUE(file.read_as_somebody(0, mode).keys) << mode;
    EXPECT_TRUE(file.read(mode).keys) << mode << ": nor does root need another one";
  }
  for (const mode_t mode : {0660U, 0650U, 0644U, 0642U, 0641U}) {
    EXPECT_THAT(file.read_as_somebody(0, mode).error, HasSubstr("chmod 600 or 640")) << mode;
  }
  EXPECT_THAT(file.read_as_somebody(AsSomebody::kUser, 0640).error, HasSubstr("(chmod 600)"));
  EXPECT_THAT(file.read_as_somebody(1, 0640).error, HasSubstr("belongs to another user"));
}

TEST(MessageKeys, WhatIsNoFileIsRefusedWithoutWaiting) {
  const testing::TemporaryFolder folder;
  EXPECT_THAT(MessageKeys::from_file((folder.path() / "none").string()).error,
              HasSubstr("No such file"));
  EXPECT_THAT(MessageKeys::from_file(folder.path().string()).error, HasSubstr("no regular file"));
  const std::string pipe = (folder.path() / "pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(MessageKeys::from_file(pipe).error, HasSubstr("no regular file"));
  const std::string large = folder.write("large", std::string(20'000, '#'));
  chmod(large.c_str(), 0600);
  EXPECT_THAT(MessageKeys::from_file(large).error, HasSubstr("longer than any key file"));
}

/// The tag is keyed BLAKE2b of the bytes that README.md lists, assembled independently here.
TEST(MessageKeys, TheTagIsWhatIsDocumented) {
  const MessageKeys::ReadResult read = MessageKeys::from_text("258 " + kOne, "keys");
  ASSERT_TRUE(read.keys) << read.error;
  envelope_t envelope{};
  envelope.sender = -2;
  envelope.counter = 3;
  envelope.utime = 4;
  envelope.payload = {9, 8, 7};
  read.keys->sign("CHANNEL", envelope);
  EXPECT_EQ(envelope.key_id, 258);

  const auto number = [](std::uint64_t value) {
    std::string bytes;
    for (int shift = 56; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xFFU);
    return bytes;
  };
  const std::string signed_text = number(17) + "camway envelope 1" + number(7) + "CHANNEL" +
                                  number(258) + number(~std::uint64_t{1}) + number(3) + number(4) +
                                  number(3) + "\x09\x08\x07";
  const std::string secret(32, '\x11');
  unsigned char tag[32];
  crypto_generichash(tag, sizeof tag, reinterpret_cast<const unsigned char*>(signed_text.data()),
                     signed_text.size(), reinterpret_cast<const unsigned char*>(secret.data()),
                     secret.size());
  EXPECT_THAT(envelope.tag, ::testing::ElementsAreArray(tag));
}

}  // namespace
}  // namespace camway::wire
