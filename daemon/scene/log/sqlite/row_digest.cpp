// SPDX-License-Identifier: MIT
#include "daemon/scene/log/sqlite/row_digest.h"

#include <array>

namespace camway::scene {
namespace {

/// Adds values with their sizes, so that different rows have different bytes.
class RowDigest {
 public:
  explicit RowDigest(std::string_view table) { add(table); }

  RowDigest& add(std::uint64_t number) {
    std::array<std::uint8_t, 8> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      bytes[i] = static_cast<std::uint8_t>(number >> (8 * i));
    }
    digest_.add(bytes.data(), bytes.size());
    return *this;
  }
  RowDigest& add(std::string_view text) {
    add(std::uint64_t{text.size()});
    digest_.add(text.data(), text.size());
    return *this;
  }
  RowDigest& add(const Bytes& bytes) {
    add(std::uint64_t{bytes.size()});
    digest_.add(bytes.data(), bytes.size());
    return *this;
  }
  RowDigest& add(const std::vector<BlobId>& ids) {
    add(std::uint64_t{ids.size()});
    for (const BlobId& id : ids) digest_.add(id.data(), id.size());
    return *this;
  }

  [[nodiscard]] base::Digest::Bytes bytes() const { return digest_.bytes(); }

 private:
  base::Digest digest_;
};

}  // namespace

base::Digest::Bytes entry_digest(std::string_view scene, const LogEntry& entry) {
  return RowDigest("entry")
      .add(scene)
      .add(entry.before)
      .add(entry.revision)
      .add(entry.record)
      .add(entry.needs)
      .bytes();
}

base::Digest::Bytes summary_digest(std::string_view scene, std::uint64_t revision,
                                   const Bytes& summary, const std::vector<BlobId>& needs) {
  return RowDigest("summary").add(scene).add(revision).add(summary).add(needs).bytes();
}

base::Digest::Bytes blob_digest(const BlobId& id, const Blob& blob) {
  return RowDigest("blob").add(std::vector{id}).add(blob.bytes).add(blob.needs).bytes();
}

base::Digest::Bytes note_digest(std::string_view key, std::string_view text) {
  return RowDigest("note").add(key).add(text).bytes();
}

base::Digest::Bytes meta_digest(std::string_view key, std::uint64_t value) {
  return RowDigest("meta").add(key).add(value).bytes();
}

}  // namespace camway::scene
