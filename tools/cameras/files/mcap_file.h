// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tools/cameras/files/mcap_records.h"

namespace camway::tools {

/// A topic of an MCAP file, with the name and the text of the schema of its messages.
struct McapChannel {
  std::string topic;
  std::string schema_name;
  std::string schema;  ///< JSON schema
  std::map<std::string, std::string> metadata;
};

/// Makes an MCAP file with messages in JSON: uncompressed chunks with their indexes, and a summary
/// that repeats schemas and channels. Checksums are those that the specification has.
class McapFile {
 public:
  explicit McapFile(const std::vector<McapChannel>& channels);

  /// Adds a message to the channel of this index. Requires that no earlier message is later.
  void add(std::size_t channel, std::uint64_t time_ns, std::string_view json);

  /// Returns the file. Call it once, at the end.
  std::string finish();

 private:
  /// An entry of an index: when a message was logged, and where its record begins in the chunk.
  struct Entry {
    std::uint64_t time_ns;
    std::uint64_t offset;
  };
  void flush_chunk();
  void add_statistics(McapBytes& summary) const;

  McapBytes file_;
  McapBytes schemas_;   ///< records of schemas, as in the first chunk and the summary
  McapBytes channels_;  ///< records of channels, as in the first chunk and the summary
  std::size_t channel_count_ = 0;
  McapBytes chunk_;
  std::map<std::uint16_t, std::vector<Entry>> chunk_entries_;
  McapBytes chunk_indexes_;  ///< records of the summary
  std::uint32_t chunks_ = 0;
  std::map<std::uint16_t, std::uint64_t> counts_;  ///< messages of each channel
  std::uint64_t begin_ns_ = 0;
  std::uint64_t end_ns_ = 0;
  std::uint64_t chunk_begin_ns_ = 0;
};

}  // namespace camway::tools
