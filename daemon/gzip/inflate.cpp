// SPDX-License-Identifier: MIT
#include "daemon/gzip/inflate.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace camway::gzip {
namespace {

constexpr int kGzipOnly = 16 + MAX_WBITS;  ///< zlib's way to ask for the header of gzip
constexpr std::size_t kChunkBytes = 1 << 18;

/// zlib's state of one decompression.
class Inflation {
 public:
  Inflation() : is_ready_(inflateInit2(&stream_, kGzipOnly) == Z_OK) {}
  ~Inflation() { inflateEnd(&stream_); }
  Inflation(const Inflation&) = delete;
  Inflation& operator=(const Inflation&) = delete;

  base::Result<std::string> all(std::string_view bytes, std::size_t most_bytes) {
    if (!is_ready_) return base::Failure{"cannot be decompressed: zlib does not start"};
    std::string text;
    std::vector<Bytef> chunk(kChunkBytes);
    // zlib does not write to its input, but takes no pointer to const.
    auto* next = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    std::size_t left = bytes.size();
    while (true) {
      const auto given = static_cast<uInt>(std::min<std::size_t>(left, kChunkBytes));
      stream_.next_in = next;
      stream_.avail_in = given;
      stream_.next_out = chunk.data();
      stream_.avail_out = static_cast<uInt>(chunk.size());
      const int code = inflate(&stream_, Z_NO_FLUSH);
      const std::size_t used = given - stream_.avail_in;
      next += used;
      left -= used;
      const std::size_t made = chunk.size() - stream_.avail_out;
      if (made > most_bytes - text.size()) {
        return base::Failure{"holds more than " + std::to_string(most_bytes >> 20U) +
                             " MiB when decompressed"};
      }
      text.append(reinterpret_cast<const char*>(chunk.data()), made);
      if (code == Z_STREAM_END) {
        // A file may be several of gzip, one after the other.
        if (!is_gzip({reinterpret_cast<const char*>(next), left})) return text;
        if (inflateReset(&stream_) != Z_OK) break;
      } else if (code != Z_OK || (used == 0 && made == 0)) {
        break;
      }
    }
    return base::Failure{"is compressed with gzip, and damaged or cut off"};
  }

 private:
  z_stream stream_{};
  bool is_ready_;
};

}  // namespace

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

base::Result<std::string> inflated(std::string_view bytes, std::size_t most_bytes) {
  return Inflation().all(bytes, most_bytes);
}

}  // namespace camway::gzip
