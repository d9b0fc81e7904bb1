// SPDX-License-Identifier: MIT
#include "tools/cameras/files/mcap_file.h"

#include <utility>

namespace camway::tools {
namespace {

/// A reader that seeks loads whole chunks, so they are not large.
constexpr std::uint64_t kChunkBytes = std::uint64_t{1} << 20;

/// Channels and schemas count from 1: schema 0 is none.
std::uint16_t id_of(std::size_t channel) { return static_cast<std::uint16_t>(channel + 1); }

}  // namespace

McapFile::McapFile(const std::vector<McapChannel>& channels) : channel_count_(channels.size()) {
  file_.raw(kMcapMagic);
  McapBytes header;
  header.text("");  // profile: none
  header.text("Camway");
  file_.record(McapOpcode::kHeader, header);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    McapBytes schema;
    schema.u16(id_of(i));
    schema.text(channels[i].schema_name);
    schema.text("jsonschema");
    schema.text(channels[i].schema);
    schemas_.record(McapOpcode::kSchema, schema);
    McapBytes channel;
    channel.u16(id_of(i));
    channel.u16(id_of(i));
    channel.text(channels[i].topic);
    channel.text("json");
    channel.texts(channels[i].metadata);
    channels_.record(McapOpcode::kChannel, channel);
  }
  chunk_.raw(schemas_.bytes());
  chunk_.raw(channels_.bytes());
}

void McapFile::add(std::size_t channel, std::uint64_t time_ns, std::string_view json) {
  const std::uint16_t id = id_of(channel);
  if (counts_.empty()) begin_ns_ = time_ns;
  if (chunk_entries_.empty()) chunk_begin_ns_ = time_ns;
  end_ns_ = time_ns;
  chunk_entries_[id].push_back({time_ns, chunk_.size()});
  McapBytes message;
  message.u16(id);
  message.u32(static_cast<std::uint32_t>(counts_[id]++));
  message.u64(time_ns);  // logged
  message.u64(time_ns);  // published
  message.raw(json);
  chunk_.record(McapOpcode::kMessage, message);
  if (chunk_.size() >= kChunkBytes) flush_chunk();
}

void McapFile::flush_chunk() {
  if (chunk_entries_.empty()) return;
  const std::uint64_t chunk_offset = file_.size();
  McapBytes chunk;
  chunk.u64(chunk_begin_ns_);
  chunk.u64(end_ns_);
  chunk.u64(chunk_.size());
  chunk.u32(crc32_of(chunk_.bytes()));
  chunk.text("");  // compression: none
  chunk.u64(chunk_.size());
  chunk.raw(chunk_.bytes());
  file_.record(McapOpcode::kChunk, chunk);
  const std::uint64_t chunk_length = file_.size() - chunk_offset;

  McapBytes offsets;
  const std::uint64_t indexes_offset = file_.size();
  for (const auto& [id, entries] : chunk_entries_) {
    offsets.u16(id);
    offsets.u64(file_.size());
    McapBytes list;
    for (const Entry& entry : entries) {
      list.u64(entry.time_ns);
      list.u64(entry.offset);
    }
    McapBytes index;
    index.u16(id);
    index.text(list.bytes());
    file_.record(McapOpcode::kMessageIndex, index);
  }

  McapBytes index;
  index.u64(chunk_begin_ns_);
  index.u64(end_ns_);
  index.u64(chunk_offset);
  index.u64(chunk_length);
  index.text(offsets.bytes());
  index.u64(file_.size() - indexes_offset);
  index.text("");
  index.u64(chunk_.size());  // compressed
  index.u64(chunk_.size());
  chunk_indexes_.record(McapOpcode::kChunkIndex, index);
  ++chunks_;
  chunk_ = {};
  chunk_entries_.clear();
}

void McapFile::add_statistics(McapBytes& summary) const {
  McapBytes statistics;
  McapBytes counts;
  std::uint64_t messages = 0;
  for (const auto& [id, count] : counts_) {
    counts.u16(id);
    counts.u64(count);
    messages += count;
  }
  statistics.u64(messages);
  statistics.u16(static_cast<std::uint16_t>(channel_count_));  // schemas
  statistics.u32(static_cast<std::uint32_t>(channel_count_));
  statistics.u32(0);  // attachments
  statistics.u32(0);  // metadata
  statistics.u32(chunks_);
  statistics.u64(begin_ns_);
  statistics.u64(end_ns_);
  statistics.text(counts.bytes());
  summary.record(McapOpcode::kStatistics, statistics);
}

std::string McapFile::finish() {
  flush_chunk();
  McapBytes data_end;
  data_end.u32(crc32_of(file_.bytes()));
  file_.record(McapOpcode::kDataEnd, data_end);

  const std::uint64_t summary_start = file_.size();
  McapBytes statistics;
  add_statistics(statistics);
  McapBytes summary;
  McapBytes summary_offsets;
  const std::pair<McapOpcode, const McapBytes*> groups[] = {
      {McapOpcode::kSchema, &schemas_},
      {McapOpcode::kChannel, &channels_},
      {McapOpcode::kStatistics, &statistics},
      {McapOpcode::kChunkIndex, &chunk_indexes_}};
  for (const auto& [opcode, records] : groups) {
    if (records->size() == 0) continue;
    McapBytes offset;
    offset.raw(std::string(1, static_cast<char>(opcode)));
    offset.u64(summary_start + summary.size());
    offset.u64(records->size());
    summary_offsets.record(McapOpcode::kSummaryOffset, offset);
    summary.raw(records->bytes());
  }
  const std::uint64_t offsets_start = summary_start + summary.size();
  summary.raw(summary_offsets.bytes());

  // The checksum of the summary ends after the footer's own two offsets.
  constexpr std::uint64_t kFooterBytes = 20;
  summary.raw(std::string(1, static_cast<char>(McapOpcode::kFooter)));
  summary.u64(kFooterBytes);
  summary.u64(summary_start);
  summary.u64(offsets_start);
  summary.u32(crc32_of(summary.bytes()));
  file_.raw(summary.bytes());
  file_.raw(kMcapMagic);
  return file_.bytes();
}

}  // namespace camway::tools
