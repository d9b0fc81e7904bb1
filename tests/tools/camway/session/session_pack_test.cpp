// SPDX-License-Identifier: MIT
#include "tools/camway/session/session_pack.h"

#include <archive.h>
#include <archive_entry.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/digest.h"
#include "daemon/record/session_events.h"
#include "tests/support/random.h"
#include "tests/tools/camway/replay/log_builder.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string blob_name(const std::string& bytes) {
  scene::Bytes copy;
  for (const char c : bytes) copy.push_back(static_cast<std::byte>(c));
  return "blobs/" + record::hex_of(scene::blob_id_of(copy));
}

std::map<std::string, std::string> files_below(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      files[fs::relative(entry.path(), folder).string()] = read_all(entry.path().string());
    }
  }
  return files;
}

class SessionPack : public ::testing::Test {
 protected:
  SessionPack() {
    testing::Random random(3);
    std::string log(20'000, ' ');
    for (char& c : log) c = static_cast<char>(random() % 50);
    contents_ = {{"a.lcmlog", log}, {"b.lcmlog", ""}, {blob_name("content"), "content"}};
    std::vector<PackedFile> files;
    int i = 0;
    for (const auto& [name, content] : contents_) {
      files.push_back({folder_.write("file" + std::to_string(i++), content), name});
    }
    EXPECT_EQ(write_pack(pack_, files), "");
  }

  /// Returns the error of unpacking a pack of these members, of which the list says `listed`.
  std::string unpack_of(const std::vector<std::pair<std::string, std::string>>& members,
                        const std::vector<std::pair<std::string, std::string>>& listed,
                        unsigned type = AE_IFREG) {
    std::string list = R"({"format": 1, "members": [)";
    for (const auto& [name, content] : listed) {
      base::Digest digest;
      digest.add(content.data(), content.size());
      if (list.back() == '}') list += ',';
      list += R"({"name": ")" + name + R"(", "bytes": )" + std::to_string(content.size()) +
              R"(, "xxh128": ")" + digest.text() + "\"}";
    }
    list += "]}";
    auto all = members;
    all.insert(all.begin(), {"session.json", list});
    const std::string file = folder_.file("made.camway-session");
    archive* const out = archive_write_new();
    archive_write_set_format_pax_restricted(out);
    archive_write_add_filter_zstd(out);
    archive_write_open_filename(out, file.c_str());
    for (const auto& [name, content] : all) {
      archive_entry* const entry = archive_entry_new();
      const bool is_list = name == "session.json";
      archive_entry_set_pathname(entry, name.c_str());
      archive_entry_set_filetype(entry, is_list ? unsigned{AE_IFREG} : type);
      if (!is_list && type == unsigned{AE_IFLNK}) archive_entry_set_symlink(entry, "/etc/passwd");
      archive_entry_set_size(entry, static_cast<la_int64_t>(content.size()));
      archive_write_header(out, entry);
      archive_write_data(out, content.data(), content.size());
      archive_entry_free(entry);
    }
    archive_write_close(out);
    archive_write_free(out);
    std::string fault = unpack(file, folder_.file("out"));
    EXPECT_FALSE(fs::exists(folder_.file("out"))) << "nothing is left";
    EXPECT_FALSE(fs::exists(folder_.file("out.unfinished")));
    return fault;
  }

  TemporaryFolder folder_;
  std::map<std::string, std::string> contents_;
  const std::string pack_ = folder_.file("bug.camway-session");
};

TEST_F(SessionPack, GivesBackWhatItPacked) {
  EXPECT_TRUE(looks_like_pack(pack_));
  ASSERT_EQ(unpack(pack_, folder_.file("out")), "");
  EXPECT_EQ(files_below(folder_.file("out")), contents_);
  EXPECT_THAT(unpack(pack_, folder_.file("out")), HasSubstr("is there already"));
}

TEST_F(SessionPack, RefusesNamesThatLeadElsewhere) {
  for (const std::string name :
       {"../a.lcmlog", "/tmp/a.lcmlog", "a/../../b.lcmlog", "x/a.lcmlog", ".hidden.lcmlog",
        "blobs/../a.lcmlog", "blobs/ABC", "a.txt", "", "..", "a\nb.lcmlog"}) {
    EXPECT_FALSE(is_pack_name(name)) << name;
  }
  EXPECT_THAT(unpack_of({{"../a.lcmlog", "x"}}, {{"../a.lcmlog", "x"}}),
              AllOf(HasSubstr("'../a.lcmlog'"), HasSubstr("is no name of a member")));
  EXPECT_THAT(unpack_of({{"/tmp/a.lcmlog", "x"}}, {}), HasSubstr("is not in the list"));
  EXPECT_THAT(unpack_of({{"a.lcmlog", ""}}, {{"a.lcmlog", ""}}, AE_IFLNK),
              HasSubstr("a.lcmlog: is no file"));
  EXPECT_FALSE(fs::exists(folder_.file("a.lcmlog")));
}

TEST_F(SessionPack, NamesWhatIsMissingOrDamaged) {
  EXPECT_THAT(unpack_of({}, {{"a.lcmlog", "x"}}), HasSubstr("a.lcmlog: is missing"));
  EXPECT_THAT(unpack_of({{"a.lcmlog", "y"}}, {{"a.lcmlog", "x"}}),
              HasSubstr("a.lcmlog: is damaged"));
  EXPECT_THAT(unpack_of({{"a.lcmlog", "xy"}}, {{"a.lcmlog", "x"}}),
              HasSubstr("a.lcmlog: is larger"));
  EXPECT_THAT(unpack_of({{"a.lcmlog", "x"}, {"a.lcmlog", "x"}}, {{"a.lcmlog", "x"}}),
              HasSubstr("a.lcmlog: is there twice"));
  const std::string name = blob_name("content");
  EXPECT_THAT(unpack_of({{name, "another"}}, {{name, "another"}}),
              AllOf(HasSubstr(name), HasSubstr("another digest than its name")));
}

TEST_F(SessionPack, DamageIsToldOrHarmless) {
  const std::string good = read_all(pack_);
  static unsigned repetition = 0;
  testing::Random random(++repetition);
  const auto look = [&](const std::string& bytes) {
    const std::string file = folder_.write("bad", bytes);
    const std::string fault = unpack(file, folder_.file("out"));
    if (fault.empty()) {
      EXPECT_EQ(files_below(folder_.file("out")), contents_);
    }
    EXPECT_EQ(fs::exists(folder_.file("out")), fault.empty());
    fs::remove_all(folder_.file("out"));
    return fault;
  };
  EXPECT_EQ(look(good), "");
  for (std::size_t length = 0; length < good.size(); length += 1 + random() % 400) {
    look(good.substr(0, length));
  }
  for (int i = 0; i < 100; ++i) {
    std::string bytes = good;
    char& byte = bytes[random() % bytes.size()];
    byte = static_cast<char>(byte ^ (1 << random() % 8));
    look(bytes);
  }
}

}  // namespace
}  // namespace camway::tools
