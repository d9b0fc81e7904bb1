// SPDX-License-Identifier: MIT
#include "tools/camway/session/session_pack.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string_view>
#include <system_error>

#include <nlohmann/json.hpp>

#include "daemon/base/digest.h"
#include "daemon/base/result.h"
#include "daemon/record/blob_folder.h"
#include "daemon/record/log_files.h"
#include "daemon/record/session_events.h"
#include "daemon/scene/log/blob_hasher.h"
#include "lcmtypes/wire/channels.h"
#include "tools/json/json_document.h"
#include "tools/support/output_file.h"

namespace camway::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr char kListName[] = "session.json";
constexpr int kFormat = 1;
constexpr std::size_t kChunkBytes = std::size_t{1} << 20;
/// Longest list to accept: of some 100,000 members, each with three values.
constexpr std::uint64_t kMostListBytes = std::uint64_t{16} << 20;
constexpr std::size_t kMostListValues = 1'000'000;
constexpr std::array<char, 4> kZstdMagic{'\x28', '\xB5', '\x2F', '\xFD'};
constexpr std::string_view kBlobsBegin = "blobs/";
constexpr char kNoSession[] = "is damaged, or no session: ";

/// Size and digest of a member.
struct Member {
  std::uint64_t bytes = 0;
  std::string digest;
};
using Members = std::map<std::string, Member>;

struct FreeWriter {
  void operator()(archive* each) const { archive_write_free(each); }
};
struct FreeReader {
  void operator()(archive* each) const { archive_read_free(each); }
};
struct FreeEntry {
  void operator()(archive_entry* each) const { archive_entry_free(each); }
};

std::string text_of(archive* each) {
  const char* const text = archive_error_string(each);
  return text != nullptr ? wire::printable(text) : "it is no session";
}

/// Reads a file in chunks. Returns an error, empty on success.
template <class Take>
std::string read_chunks(const fs::path& file, Take take) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> chunk(kChunkBytes);
  while (stream) {
    stream.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    const auto got = static_cast<std::size_t>(stream.gcount());
    if (got > 0 && !take(std::string_view(chunk.data(), got))) return {};
  }
  return stream.eof() ? "" : file.string() + ": cannot be read";
}

class PackWriter {
 public:
  explicit PackWriter(const fs::path& file) : file_(file), archive_(archive_write_new()) {
    archive_write_set_format_pax_restricted(archive_.get());
    archive_write_add_filter_zstd(archive_.get());
    note(archive_write_open_filename(archive_.get(), file.c_str()));
  }

  void add(const std::string& name, std::uint64_t bytes) {
    const std::unique_ptr<archive_entry, FreeEntry> entry(archive_entry_new());
    constexpr unsigned kMode = 0644;
    archive_entry_set_pathname(entry.get(), name.c_str());
    archive_entry_set_size(entry.get(), static_cast<la_int64_t>(bytes));
    archive_entry_set_filetype(entry.get(), AE_IFREG);
    archive_entry_set_perm(entry.get(), kMode);
    note(archive_write_header(archive_.get(), entry.get()));
  }
  bool write(std::string_view bytes) {
    if (!fault_.empty()) return false;
    const la_ssize_t wrote = archive_write_data(archive_.get(), bytes.data(), bytes.size());
    note(wrote < 0 ? ARCHIVE_FATAL : ARCHIVE_OK);
    return fault_.empty();
  }
  /// Returns an error, empty on success.
  std::string close() {
    note(archive_write_close(archive_.get()));
    return fault_;
  }

 private:
  void note(int outcome) {
    if (outcome < ARCHIVE_WARN && fault_.empty()) {
      fault_ = file_.string() + ": cannot be written: " + text_of(archive_.get());
    }
  }

  fs::path file_;
  std::unique_ptr<archive, FreeWriter> archive_;
  std::string fault_;
};

/// Returns the list of the members; fails if a file cannot be read.
base::Result<json> list_of(const std::vector<PackedFile>& files) {
  json members = json::array();
  for (const PackedFile& each : files) {
    base::Digest digest;
    std::uint64_t bytes = 0;
    const std::string fault = read_chunks(each.file, [&](std::string_view chunk) {
      digest.add(chunk.data(), chunk.size());
      bytes += chunk.size();
      return true;
    });
    if (!fault.empty()) return base::Failure{fault};
    members.push_back({{"name", each.name}, {"bytes", bytes}, {"xxh128", digest.text()}});
  }
  return json{{"format", kFormat}, {"members", std::move(members)}};
}

std::string write_members(PackWriter& writer, const json& list,
                          const std::vector<PackedFile>& files) {
  const std::string text = list.dump(1) + '\n';
  if (text.size() > kMostListBytes) return "the session has more files than a pack may hold";
  writer.add(kListName, text.size());
  writer.write(text);
  for (std::size_t i = 0; i < files.size(); ++i) {
    // A recording may have grown since: the rest is for another pack.
    auto left = list.at("members").at(i).at("bytes").get<std::uint64_t>();
    writer.add(files[i].name, left);
    const std::string fault = read_chunks(files[i].file, [&](std::string_view chunk) {
      chunk =
          chunk.substr(0, static_cast<std::size_t>(std::min<std::uint64_t>(chunk.size(), left)));
      left -= chunk.size();
      return writer.write(chunk) && left > 0;
    });
    if (!fault.empty()) return fault;
  }
  return writer.close();
}

/// Reads the list, whatever the text is.
base::Result<Members> members_from(const std::string& text) {
  const base::Result<json> parsed = parse_document(text, kListName, kMostListValues);
  if (!parsed) return base::Failure{parsed.error};
  try {
    const json& list = *parsed;
    if (list.at("format") != json(kFormat)) {
      return base::Failure{"is a session of another version of camway"};
    }
    Members members;
    for (const json& each : list.at("members")) {
      const auto name = each.at("name").get<std::string>();
      if (!is_pack_name(name)) {
        return base::Failure{"'" + wire::printable(name) +
                             "': is no name of a member of a session"};
      }
      // A conversion of other numbers may be undefined.
      if (!each.at("bytes").is_number_unsigned()) {
        return base::Failure{name + ": its size in the list is none"};
      }
      const Member member{each.at("bytes").get<std::uint64_t>(),
                          each.at("xxh128").get<std::string>()};
      if (!members.emplace(name, member).second) return base::Failure{name + ": is listed twice"};
    }
    return members;
  } catch (const json::exception&) {
    return base::Failure{std::string(kListName) + ": is damaged"};
  }
}

class PackReader {
 public:
  PackReader(const fs::path& file, const fs::path& folder, std::uint64_t most_bytes)
      : folder_(folder), most_bytes_(most_bytes), archive_(archive_read_new()) {
    archive_read_support_filter_zstd(archive_.get());
    archive_read_support_format_tar(archive_.get());
    is_open_ = archive_read_open_filename(archive_.get(), file.c_str(), kChunkBytes) == ARCHIVE_OK;
  }

  /// Unpacks all members. Returns an error without the name of the pack, empty on success.
  std::string unpack_all() {
    if (!is_open_) return kNoSession + text_of(archive_.get());
    std::string fault = read_list();
    archive_entry* entry = nullptr;
    while (fault.empty()) {
      const int outcome = archive_read_next_header(archive_.get(), &entry);
      if (outcome == ARCHIVE_EOF) break;
      fault = is_good(outcome) ? unpack_member(entry) : "is damaged: " + text_of(archive_.get());
    }
    if (fault.empty() && seen_.size() != members_.size()) {
      const auto missing = std::ranges::find_if(
          members_, [&](const auto& member) { return !seen_.contains(member.first); });
      fault = missing->first + ": is missing";
    }
    return fault;
  }

 private:
  /// `ARCHIVE_RETRY` stands for a damaged header, behind which the library would look for another.
  static bool is_good(int outcome) { return outcome == ARCHIVE_OK || outcome == ARCHIVE_WARN; }

  std::string read_list() {
    archive_entry* entry = nullptr;
    if (!is_good(archive_read_next_header(archive_.get(), &entry))) {
      return kNoSession + text_of(archive_.get());
    }
    const char* const name = archive_entry_pathname(entry);
    if (name == nullptr || std::string_view(name) != kListName) {
      return "is no session: it does not begin with " + std::string(kListName);
    }
    std::string text;
    std::string fault = read_data([&](std::string_view chunk) {
      text += chunk;
      return text.size() <= kMostListBytes;
    });
    if (!fault.empty()) return std::string(kListName) + ": " + fault;
    base::Result<Members> members = members_from(text);
    if (!members) return members.error;
    members_ = *std::move(members);
    return why_no_room();
  }

  /// Returns why the members must not be unpacked; empty if they may.
  [[nodiscard]] std::string why_no_room() const {
    std::uint64_t all = 0;
    for (const auto& [name, member] : members_) {
      if (member.bytes > most_bytes_ - all) {
        return fmt::format("holds more than {} bytes, the limit of camway unpack --most-bytes",
                           most_bytes_);
      }
      all += member.bytes;
    }
    std::error_code error;
    const fs::space_info space = fs::space(folder_, error);
    if (error || all <= space.available) return {};
    return fmt::format("{} has no room for its {} bytes", folder_.string(), all);
  }

  std::string unpack_member(archive_entry* entry) {
    const char* const path = archive_entry_pathname(entry);
    const std::string name = path != nullptr ? path : "";
    const auto member = members_.find(name);
    if (member == members_.end()) {
      return "'" + wire::printable(name) + "': is not in the list of the session";
    }
    if (archive_entry_filetype(entry) != AE_IFREG || archive_entry_hardlink(entry) != nullptr) {
      return name + ": is no file";
    }
    if (!seen_.insert(name).second) return name + ": is there twice";
    return unpack_file(name, member->second);
  }

  std::string unpack_file(const std::string& name, const Member& member) {
    const fs::path file = folder_ / name;
    std::error_code ignored;
    fs::create_directories(file.parent_path(), ignored);
    std::ofstream out(file, std::ios::binary);
    base::Digest digest;
    const bool is_blob = name.starts_with(kBlobsBegin);
    scene::BlobHasher hasher;
    std::uint64_t bytes = 0;
    const std::string fault = read_data([&](std::string_view chunk) {
      bytes += chunk.size();
      digest.add(chunk.data(), chunk.size());
      if (is_blob) hasher.add(std::as_bytes(std::span(chunk)));
      out.write(chunk.data(), static_cast<std::streamsize>(chunk.size()));
      return bytes <= member.bytes && out.good();
    });
    out.close();
    if (!out) return file.string() + ": cannot be written";
    if (!fault.empty()) return name + ": " + fault;
    if (bytes != member.bytes || digest.text() != member.digest) return name + ": is damaged";
    if (is_blob && record::hex_of(hasher.finish()) != name.substr(kBlobsBegin.size())) {
      return name + ": has another digest than its name";
    }
    return {};
  }

  /// Reads the data of the present member. Returns an error, empty on success.
  template <class Take>
  std::string read_data(Take take) {
    std::vector<char> chunk(kChunkBytes);
    while (true) {
      const la_ssize_t got = archive_read_data(archive_.get(), chunk.data(), chunk.size());
      if (got == 0) return {};
      if (got < 0) return "is damaged: " + text_of(archive_.get());
      if (!take(std::string_view(chunk.data(), static_cast<std::size_t>(got)))) {
        return "is larger than it may be";
      }
    }
  }

  fs::path folder_;
  std::uint64_t most_bytes_;
  std::unique_ptr<archive, FreeReader> archive_;
  bool is_open_ = false;
  Members members_;
  std::set<std::string> seen_;
};

}  // namespace

bool is_pack_name(const std::string& name) {
  if (name == kLeftOutName) return true;
  if (name.starts_with(kBlobsBegin)) return record::is_blob_name(name.substr(kBlobsBegin.size()));
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  };
  constexpr std::size_t kMostCharacters = 200;
  return name.ends_with(record::kLogEnding) && name.size() <= kMostCharacters && name[0] != '.' &&
         std::ranges::all_of(name, is_plain);
}

bool looks_like_pack(const fs::path& file) {
  std::array<char, kZstdMagic.size()> begin{};
  std::ifstream stream(file, std::ios::binary);
  return stream.read(begin.data(), begin.size()) && begin == kZstdMagic;
}

std::string write_pack(const fs::path& pack, const std::vector<PackedFile>& files) {
  std::vector<std::string> inputs;
  for (const PackedFile& file : files) inputs.push_back(file.file.string());
  if (std::string fault = why_unwritable(pack, inputs); !fault.empty()) return fault;
  const base::Result<json> list = list_of(files);
  if (!list) return list.error;
  const fs::path unfinished = pack.string() + ".unfinished";
  std::string fault;
  {
    PackWriter writer(unfinished);
    fault = write_members(writer, *list, files);
  }
  std::error_code error;
  if (fault.empty()) {
    fs::rename(unfinished, pack, error);
    if (error) fault = pack.string() + ": cannot be written: " + error.message();
  }
  if (!fault.empty()) fs::remove(unfinished, error);
  return fault;
}

std::string unpack(const fs::path& pack, const fs::path& folder, std::uint64_t most_bytes) {
  std::error_code error;
  if (!fs::is_regular_file(pack, error)) {
    return pack.string() + ": " + (fs::exists(pack, error) ? "is no file" : "does not exist");
  }
  if (fs::exists(fs::symlink_status(folder, error))) return folder.string() + ": is there already";
  const fs::path unfinished = folder.string() + ".unfinished";
  if (!fs::create_directories(unfinished, error)) {
    return unfinished.string() + ": " +
           (error ? "cannot be made: " + error.message() : "is there already");
  }
  std::string fault = PackReader(pack, unfinished, most_bytes).unpack_all();
  if (!fault.empty()) fault = pack.string() + ": " + fault;
  if (fault.empty()) {
    fs::rename(unfinished, folder, error);
    if (error) fault = folder.string() + ": cannot be made: " + error.message();
  }
  if (!fault.empty()) fs::remove_all(unfinished, error);
  return fault;
}

}  // namespace camway::tools
