// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/scene/log/scene_log.h"

namespace camway::scene {

inline Bytes log_bytes(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

inline std::string log_text(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A blob with its id.
struct SampleBlob {
  explicit SampleBlob(std::string_view text, std::vector<BlobId> needs = {})
      : blob{log_bytes(text), std::move(needs)}, id(blob_id_of(blob.bytes)) {}
  Blob blob;
  BlobId id;
};

inline LogEntry sample_entry(std::uint64_t before, std::uint64_t revision, std::string_view record,
                             std::vector<BlobId> needs = {}) {
  return {before, revision, log_bytes(record), std::move(needs)};
}

/// Returns all that scenes say, as a text that can be compared.
inline std::string text_of_scenes(const std::vector<LoggedScene>& scenes) {
  std::string text;
  for (const LoggedScene& scene : scenes) {
    text += scene.name + " at " + std::to_string(scene.summary_revision) + ": " +
            log_text(scene.summary) + "\n";
    for (const LogEntry& entry : scene.entries) {
      text += "  " + std::to_string(entry.before) + " -> " + std::to_string(entry.revision) + ": " +
              log_text(entry.record);
      for (const BlobId& id : entry.needs) text += " needs " + std::to_string(int(id[0]));
      text += "\n";
    }
  }
  return text;
}

}  // namespace camway::scene
