// SPDX-License-Identifier: MIT
#include "tools/cameras/files/glb_file.h"

#include <bit>
#include <cstdint>
#include <utility>

namespace camway::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

void append_number(std::string& bytes, std::uint32_t number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// A chunk of a `.glb`, filled up to four bytes.
void append_chunk(std::string& bytes, std::string content, std::string_view kind, char filler) {
  while (content.size() % 4 != 0) content += filler;
  append_number(bytes, static_cast<std::uint32_t>(content.size()));
  bytes.append(kind);
  bytes += content;
}

}  // namespace

std::string glb_file(std::string document, std::string buffer) {
  constexpr std::uint32_t kHeaderBytes = 12;
  std::string chunks;
  append_chunk(chunks, std::move(document), "JSON", ' ');
  if (!buffer.empty()) append_chunk(chunks, std::move(buffer), std::string_view("BIN\0", 4), '\0');
  std::string file = "glTF";
  append_number(file, 2);
  append_number(file, kHeaderBytes + static_cast<std::uint32_t>(chunks.size()));
  return file + chunks;
}

}  // namespace camway::tools
