// SPDX-License-Identifier: MIT
#include "tools/camway/session/session_pack.h"

#include <archive.h>
#include <archive_entry.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/digest.h"
#include "daemon/record/session_events.h"
#include "tests/support/random.h"
#include "tests/tools/camway/replay/log_builder.h"
#include "tools/camway/session/session_files.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::AnyOf;
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

using NamedText = std::pair<std::string, std::string>;
/// Makes something else of the entry of a member.
using Disguise = std::function<void(archive_entry*)>;

/// Returns the list of a pack of these members.
std::string list_of(const std::vector<NamedText>& members) {
  std::string list = R"({"format": 1, "members": [)";
  for (const auto& [name, content] : members) {
    base::Digest digest;
    digest.add(content.data(), content.size());
    if (list.back() == '}') list += ',';
    list += R"({"name": ")" + name + R"(", "bytes": )" + std::to_string(content.size()) +
            R"(, "xxh128": ")" + digest.text() + "\"}";
  }
  return list + "]}";
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
  std::string unpack_of(const std::vector<NamedText>& members, const std::vector<NamedText>& listed,
                        const Disguise& disguise = {}) {
    std::vector<NamedText> all = members;
    all.insert(all.begin(), {"session.json", list_of(listed)});
    return unpack_raw(all, disguise);
  }

  /// The same with any members from the first on.
  std::string unpack_raw(const std::vector<NamedText>& all, const Disguise& disguise = {},
                         std::uint64_t most_bytes = kMostUnpackedBytes) {
    const std::string file = folder_.file("made.camway-session");
    archive* const out = archive_write_new();
    archive_write_set_format_pax_restricted(out);
    archive_write_add_filter_zstd(out);
    archive_write_open_filename(out, file.c_str());
    for (const auto& [name, content] : all) {
      archive_entry* const entry = archive_entry_new();
      archive_entry_set_pathname(entry, name.c_str());
      archive_entry_set_filetype(entry, AE_IFREG);
      if (name != "session.json" && disguise) disguise(entry);
      archive_entry_set_size(entry, static_cast<la_int64_t>(content.size()));
      archive_write_header(out, entry);
      archive_write_data(out, content.data(), content.size());
      archive_entry_free(entry);
    }
    archive_write_close(out);
    archive_write_free(out);
    const auto outside = files_below(folder_.file(""));
    std::string fault = unpack(file, folder_.file("out"), most_bytes);
    EXPECT_FALSE(fs::exists(folder_.file("out"))) << "nothing is left";
    EXPECT_FALSE(fs::exists(folder_.file("out.unfinished")));
    EXPECT_EQ(files_below(folder_.file("")), outside) << "nothing was written anywhere";
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

TEST_F(SessionPack, IsNoneOfItsFiles) {
  const std::string log = folder_.write("a.lcmlog", "a log");
  EXPECT_THAT(write_pack(log, {{log, "a.lcmlog"}}), HasSubstr("is read, so it is not written"));
  EXPECT_EQ(read_all(log), "a log");
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
  EXPECT_FALSE(fs::exists(folder_.file("a.lcmlog")));
  EXPECT_TRUE(is_pack_name("left-out.txt"));
}

TEST_F(SessionPack, RefusesWhatIsNoPlainFile) {
  const std::string target = folder_.write("target", "of links");
  const std::vector<std::pair<std::string, Disguise>> disguises{
      {"a symbolic link",
       [&](archive_entry* entry) {
         archive_entry_set_filetype(entry, AE_IFLNK);
         archive_entry_set_symlink(entry, target.c_str());
       }},
      {"a hard link",
       [&](archive_entry* entry) { archive_entry_set_hardlink(entry, target.c_str()); }},
      {"a hard link to another member",
       [](archive_entry* entry) { archive_entry_set_hardlink(entry, "session.json"); }},
      {"a folder", [](archive_entry* entry) { archive_entry_set_filetype(entry, AE_IFDIR); }},
      {"a pipe", [](archive_entry* entry) { archive_entry_set_filetype(entry, AE_IFIFO); }},
      {"a device", [](archive_entry* entry) { archive_entry_set_filetype(entry, AE_IFCHR); }},
  };
  for (const auto& [what, disguise] : disguises) {
    SCOPED_TRACE(what);
    EXPECT_THAT(unpack_of({{"a.lcmlog", ""}}, {{"a.lcmlog", ""}}, disguise),
                AnyOf(HasSubstr("a.lcmlog: is no file"),
                      HasSubstr("'a.lcmlog/': is not in the list")));  // a folder
  }
  EXPECT_EQ(read_all(target), "of links");
}

/// Packs that unpack to more than anybody wants.
TEST_F(SessionPack, RefusesBombs) {
  const std::string zeros(std::size_t{4} << 20, '\0');
  const std::vector<NamedText> bomb{{"a.lcmlog", zeros}};
  const std::vector<NamedText> whole{{"session.json", list_of(bomb)}, bomb.front()};
  EXPECT_THAT(unpack_raw(whole, {}, zeros.size() - 1), HasSubstr("holds more than 4194303 bytes"));
  const std::string two = list_of({{"a.lcmlog", zeros}, {"b.lcmlog", zeros}});
  EXPECT_THAT(unpack_raw({{"session.json", two}}, {}, 2 * zeros.size() - 1),
              HasSubstr("holds more than"));
  EXPECT_THAT(unpack_raw({{"session.json", two}}, {}, 2 * zeros.size()), HasSubstr("is missing"));
  EXPECT_THAT(unpack_of({{"a.lcmlog", zeros}}, {{"a.lcmlog", "small"}}),
              HasSubstr("a.lcmlog: is larger than it may be"));
  EXPECT_THAT(unpack_raw({{"session.json", std::string(std::size_t{17} << 20, ' ')}}),
              HasSubstr("session.json: is larger than it may be"));
  // Sums of sizes that overflow, and sizes beyond every disk.
  for (const std::string bytes : {"18446744073709551615", "9223372036854775807", "-1", "1e300"}) {
    const std::string member = R"("bytes": )" + bytes + R"(, "xxh128": ""})";
    EXPECT_THAT(
        unpack_raw({{"session.json", R"({"format": 1, "members": [{"name": "a.lcmlog", )" + member +
                                         R"(, {"name": "b.lcmlog", )" + member + "]}"}}),
        AnyOf(HasSubstr("holds more than"), HasSubstr("its size in the list is none"),
              HasSubstr("is missing")))
        << bytes;
  }
  EXPECT_THAT(unpack_raw({{"session.json", std::string(1'000'000, '[')}}),
              HasSubstr("session.json"));
  EXPECT_THAT(unpack_raw({{"session.json", R"({"format": 1, "members": [[[1]]]})"}}),
              HasSubstr("is damaged"));
}

TEST_F(SessionPack, SentencesAboutWhatIsLeftOutAreShownPrintable) {
  folder_.write("left-out.txt", "one\n\ntwo\x1b[31m\n");
  EXPECT_EQ(left_out_in(folder_.file("")), (std::vector<std::string>{"one", "two?[31m"}));
  EXPECT_TRUE(left_out_in(folder_.file("none")).empty());
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
