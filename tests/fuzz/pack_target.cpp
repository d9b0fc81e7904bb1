// SPDX-License-Identifier: MIT
#include <archive.h>
#include <archive_entry.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/fuzz/targets.h"
#include "tests/support/temporary_folder.h"
#include "tools/camway/session/session_files.h"
#include "tools/camway/session/session_pack.h"

namespace camway::testing {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostBytes = 1 << 16;

/// Checks what was unpacked: plain files with the names of members, within the limit.
void check_unpacked(const fs::path& folder) {
  std::uint64_t bytes = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const fs::file_status status = entry.symlink_status();
    if (fs::is_directory(status)) continue;
    promise(fs::is_regular_file(status), "a pack makes plain files");
    promise(tools::is_pack_name(fs::relative(entry.path(), folder).string()),
            "files have the names of members");
    bytes += entry.file_size();
  }
  promise(bytes <= kMostBytes, "a pack makes no more than it may");
  for (const std::string& sentence : tools::left_out_in(folder)) {
    promise(sentence.find('\x1b') == std::string::npos, "sentences are printable");
  }
}

bool exercise_pack(std::span<const std::uint8_t> bytes) {
  const MemoryFile file(bytes);
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  const std::string fault = tools::unpack(file.path(), out, kMostBytes);
  promise(fs::exists(out) == fault.empty(), "a folder or a reason");
  promise(fault.empty() || fault.starts_with(file.path()), "the reason names the file");
  if (fault.empty()) check_unpacked(out);
  fs::remove_all(out);
  promise(fs::is_empty(folder.path()), "nothing is left beside the folder");
  return fault.empty();
}

/// Returns the tar archive in a pack: its reader takes it as it is, and damage of a compressed one
/// seldom comes further than to the library.
FuzzBytes uncompressed(const fs::path& pack) {
  archive* const reader = archive_read_new();
  archive_read_support_filter_zstd(reader);
  archive_read_support_format_raw(reader);
  archive_entry* entry = nullptr;
  promise(archive_read_open_filename(reader, pack.c_str(), 4096) == ARCHIVE_OK &&
              archive_read_next_header(reader, &entry) == ARCHIVE_OK,
          "the seed can be read");
  FuzzBytes bytes;
  std::array<std::uint8_t, 4096> chunk{};
  for (la_ssize_t got = 1; got > 0;) {
    got = archive_read_data(reader, chunk.data(), chunk.size());
    if (got > 0) bytes.insert(bytes.end(), chunk.begin(), chunk.begin() + got);
  }
  archive_read_free(reader);
  return bytes;
}

std::vector<FuzzBytes> pack_seeds() {
  const TemporaryFolder folder;
  const std::vector<tools::PackedFile> files{
      {folder.write("log", "a log"), "a.lcmlog"},
      {folder.write("blob", "abc"),
       "blobs/ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"},
      {folder.write("sentence", "one request\n"), tools::kLeftOutName}};
  const fs::path pack = folder.path() / "pack";
  promise(tools::write_pack(pack, files).empty(), "the seed can be written");
  std::ifstream stream(pack, std::ios::binary);
  const FuzzBytes compressed{std::istreambuf_iterator<char>(stream), {}};
  const FuzzBytes plain = uncompressed(pack);
  return {plain, plain, plain, compressed, {}};
}

}  // namespace

constinit const FuzzTarget kPackTarget{"pack", exercise_pack, pack_seeds, 1'000};

}  // namespace camway::testing
