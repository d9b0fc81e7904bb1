// SPDX-License-Identifier: MIT
#include "daemon/record/session_events.h"

#include <algorithm>
#include <utility>

#include "daemon/scene/log/byte_stream.h"

namespace camway::record {
namespace {

using scene::BlobId;
using scene::ByteReader;
using scene::ByteWriter;

constexpr std::uint8_t kFormat = 1;
/// Longest texts to accept; a daemon writes shorter ones. [Units: bytes]
constexpr std::size_t kMostNameBytes = 4096;
constexpr std::size_t kMostTextBytes = std::size_t{1} << 20;

// The kind of an event is the index in the variant.

void put(const FileBegin& begin, ByteWriter& writer) {
  writer.put_text(begin.recording);
  writer.put<std::uint64_t>(begin.part);
  writer.put_text(begin.version);
  writer.put_count(begin.settings.size());
  for (const auto& [key, value] : begin.settings) {
    writer.put_text(key);
    writer.put_text(value);
  }
}

void get(FileBegin& begin, ByteReader& reader) {
  begin.recording = reader.get_text(kMostNameBytes);
  begin.part = reader.get<std::uint64_t>();
  begin.version = reader.get_text(kMostNameBytes);
  constexpr std::size_t kLeastSettingBytes = 2 * sizeof(std::uint64_t);
  for (std::size_t left = reader.get_count(kLeastSettingBytes); left > 0; --left) {
    std::string key = reader.get_text(kMostNameBytes);
    begin.settings[std::move(key)] = reader.get_text(kMostTextBytes);
  }
}

void put(const SceneUpdate& change, ByteWriter& writer) {
  const scene::LogUpdate& update = change.update;
  writer.put(static_cast<std::uint8_t>(update.kind));
  writer.put_text(update.scene);
  writer.put<std::uint64_t>(update.entry.before);
  writer.put<std::uint64_t>(update.entry.revision);
  writer.put_text(change.digest);
  writer.put_count(update.entry.record.size());
  writer.put_array(std::span<const std::byte>(update.entry.record));
  writer.put_count(update.entry.needs.size());
  for (const BlobId& id : update.entry.needs) writer.put_array(std::span<const std::byte>(id));
}

void get(SceneUpdate& change, ByteReader& reader) {
  scene::LogUpdate& update = change.update;
  const auto kind = reader.get<std::uint8_t>();
  if (kind > static_cast<std::uint8_t>(scene::LogUpdate::Kind::kRemoval)) reader.fail();
  update.kind = static_cast<scene::LogUpdate::Kind>(kind);
  update.scene = reader.get_text(kMostNameBytes);
  update.entry.before = reader.get<std::uint64_t>();
  update.entry.revision = reader.get<std::uint64_t>();
  change.digest = reader.get_text(kMostNameBytes);
  update.entry.record.resize(reader.get_count(1));
  reader.get_array(std::span<std::byte>(update.entry.record));
  update.entry.needs.resize(reader.get_count(sizeof(BlobId)));
  for (BlobId& id : update.entry.needs) reader.get_array(std::span<std::byte>(id));
}

void put(const Omission& omission, ByteWriter& writer) {
  writer.put<std::int64_t>(omission.from_utime);
  writer.put<std::int64_t>(omission.to_utime);
  writer.put<std::uint64_t>(omission.messages);
  writer.put<std::uint64_t>(omission.changes);
  writer.put_text(omission.reason);
}

void get(Omission& omission, ByteReader& reader) {
  omission.from_utime = reader.get<std::int64_t>();
  omission.to_utime = reader.get<std::int64_t>();
  omission.messages = reader.get<std::uint64_t>();
  omission.changes = reader.get<std::uint64_t>();
  omission.reason = reader.get_text(kMostTextBytes);
}

/// Reads an event of this kind.
template <class Event>
base::Result<SessionEvent> event_of(ByteReader& reader) {
  Event event;
  get(event, reader);
  if (!reader.is_at_end()) return base::Failure{"an event of the session is damaged"};
  return SessionEvent(std::move(event));
}

}  // namespace

std::string session_channel(std::string_view prefix) { return std::string(prefix) + "_SESSION"; }

std::vector<std::uint8_t> bytes_of(const SessionEvent& event) {
  ByteWriter writer;
  writer.put(kFormat);
  writer.put(static_cast<std::uint8_t>(event.index()));
  std::visit([&](const auto& each) { put(each, writer); }, event);
  const scene::Bytes bytes = std::move(writer).take();
  const auto* const begin = reinterpret_cast<const std::uint8_t*>(bytes.data());
  return {begin, begin + bytes.size()};
}

base::Result<SessionEvent> session_event_from(std::span<const std::uint8_t> bytes) {
  ByteReader reader(std::as_bytes(bytes));
  const auto format = reader.get<std::uint8_t>();
  const auto kind = reader.get<std::uint8_t>();
  if (reader.has_failed()) return base::Failure{"an event of the session is damaged"};
  if (format != kFormat) {
    return base::Failure{"an event of the session is of format " + std::to_string(format) +
                         ", which this version does not know"};
  }
  switch (kind) {
    case 0:
      return event_of<FileBegin>(reader);
    case 1:
      return event_of<SceneUpdate>(reader);
    case 2:
      return event_of<Omission>(reader);
    default:
      return base::Failure{"an event of the session is of an unknown kind"};
  }
}

std::string hex_of(const BlobId& id) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string hex;
  for (const std::byte byte : id) {
    hex += kDigits[std::to_integer<std::size_t>(byte >> 4)];
    hex += kDigits[std::to_integer<std::size_t>(byte & std::byte{15})];
  }
  return hex;
}

bool is_blob_name(std::string_view name) {
  return name.size() == 2 * sizeof(BlobId) && std::ranges::all_of(name, [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

}  // namespace camway::record
