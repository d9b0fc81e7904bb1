// SPDX-License-Identifier: MIT
#include "daemon/scene/log/nats/log_message.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <random>
#include <utility>

#include "daemon/scene/log/byte_stream.h"

namespace camway::scene {
namespace {

/// The first byte of messages and heads; a later layout has another one.
constexpr std::uint8_t kMessageLayout = 0xC1;
constexpr std::uint8_t kHeadLayout = 0xC2;
constexpr const char* kEmptyToken = "_";
constexpr const char* kHexDigits = "0123456789abcdef";

std::uint64_t random_number() {
  std::random_device source;
  return (std::uint64_t{source()} << 32U) ^ source();
}

template <class Id>
void put_ids(ByteWriter& writer, const std::vector<Id>& ids) {
  writer.put_count(ids.size());
  for (const Id& id : ids) writer.put_array(std::span<const std::byte>(id));
}

template <class Id>
Id get_id(ByteReader& reader) {
  Id id{};
  reader.get_array(std::span<std::byte>(id));
  return id;
}

template <class Id>
std::vector<Id> get_ids(ByteReader& reader) {
  std::vector<Id> ids(reader.get_count(sizeof(Id)));
  for (Id& id : ids) id = get_id<Id>(reader);
  return ids;
}

void put_bytes(ByteWriter& writer, const Bytes& bytes) {
  writer.put_count(bytes.size());
  writer.put_array(std::span<const std::byte>(bytes));
}

Bytes get_bytes(ByteReader& reader) {
  Bytes bytes(reader.get_count(1));
  reader.get_array(std::span<std::byte>(bytes));
  return bytes;
}

/// Returns whether the members of a message fit together.
bool is_sound(const LogMessage& message) {
  const bool is_entry = message.kind == LogMessage::Kind::kEntry;
  if (message.id == MessageId{} || message.id == message.after) return false;
  if (message.revision == 0 || message.replaces.size() > kMostReplaced) return false;
  if (is_entry ? message.before >= message.revision : message.before != 0) return false;
  return !message.blob || message.record.empty();
}

int hex_value(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
  return -1;
}

std::string hex_of(std::span<const std::byte> bytes) {
  std::string text;
  text.reserve(2 * bytes.size());
  for (const std::byte byte : bytes) {
    text += kHexDigits[std::to_integer<unsigned>(byte >> 4U)];
    text += kHexDigits[std::to_integer<unsigned>(byte & std::byte{15})];
  }
  return text;
}

/// Returns whether a text has the digits of exactly these bytes, and sets them.
bool read_hex(std::string_view text, std::span<char> bytes) {
  if (text.size() != 2 * bytes.size()) return false;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const int high = hex_value(text[2 * i]);
    const int low = hex_value(text[2 * i + 1]);
    if (high < 0 || low < 0) return false;
    bytes[i] = static_cast<char>(16 * high + low);
  }
  return true;
}

}  // namespace

MessageId new_message_id() {
  static const std::uint64_t kProcess = random_number();
  static std::atomic<std::uint64_t> count = 0;
  const std::array<std::uint64_t, 2> parts{kProcess, ++count};
  MessageId id;
  static_assert(sizeof id == sizeof parts);
  std::memcpy(id.data(), parts.data(), sizeof id);
  return id;
}

Bytes bytes_of(const LogMessage& message) {
  ByteWriter writer;
  writer.put(kMessageLayout);
  writer.put(static_cast<std::uint8_t>(message.kind));
  writer.put_array(std::span<const std::byte>(message.id));
  writer.put_array(std::span<const std::byte>(message.after));
  writer.put(message.before);
  writer.put(message.revision);
  writer.put(message.removed);
  put_ids(writer, message.replaces);
  put_ids(writer, message.needs);
  writer.put_flag(message.blob.has_value());
  if (message.blob) {
    writer.put_array(std::span<const std::byte>(*message.blob));
  } else {
    put_bytes(writer, message.record);
  }
  return std::move(writer).take();
}

base::Result<LogMessage> log_message_from(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  LogMessage message;
  if (reader.get<std::uint8_t>() != kMessageLayout) reader.fail();
  const auto kind = reader.get<std::uint8_t>();
  if (kind > static_cast<std::uint8_t>(LogMessage::Kind::kRemoval)) reader.fail();
  message.kind = static_cast<LogMessage::Kind>(kind);
  message.id = get_id<MessageId>(reader);
  message.after = get_id<MessageId>(reader);
  message.before = reader.get<std::uint64_t>();
  message.revision = reader.get<std::uint64_t>();
  message.removed = reader.get<std::uint64_t>();
  message.replaces = get_ids<MessageId>(reader);
  message.needs = get_ids<BlobId>(reader);
  if (reader.get_flag()) {
    message.blob = get_id<BlobId>(reader);
  } else {
    message.record = get_bytes(reader);
  }
  if (!reader.is_at_end() || !is_sound(message)) {
    return base::Failure{"a message is damaged, or a newer camwayd wrote it"};
  }
  return message;
}

Bytes bytes_of(const BlobHead& head) {
  ByteWriter writer;
  writer.put(kHeadLayout);
  writer.put(head.bytes);
  writer.put(head.parts);
  put_ids(writer, head.needs);
  put_bytes(writer, head.content);
  return std::move(writer).take();
}

base::Result<BlobHead> blob_head_from(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  BlobHead head;
  if (reader.get<std::uint8_t>() != kHeadLayout) reader.fail();
  head.bytes = reader.get<std::uint64_t>();
  head.parts = reader.get<std::uint32_t>();
  head.needs = get_ids<BlobId>(reader);
  head.content = get_bytes(reader);
  const bool is_whole = head.parts == 0 ? head.content.size() == head.bytes
                                        : head.content.empty() && head.parts <= head.bytes;
  if (!reader.is_at_end() || !is_whole) {
    return base::Failure{"a mesh or map is damaged, or a newer camwayd wrote it"};
  }
  return head;
}

std::string token_of(std::string_view text) {
  return text.empty() ? kEmptyToken : hex_of(std::as_bytes(std::span(text)));
}

std::optional<std::string> text_from_token(std::string_view token) {
  if (token == kEmptyToken) return "";
  std::string text(token.size() / 2, ' ');
  if (token.empty() || !read_hex(token, text)) return std::nullopt;
  return text;
}

std::string token_of(const BlobId& id) { return hex_of(id); }

std::optional<BlobId> blob_id_from_token(std::string_view token) {
  BlobId id{};
  const std::span<char> bytes(reinterpret_cast<char*>(id.data()), id.size());
  return read_hex(token, bytes) ? std::optional(id) : std::nullopt;
}

}  // namespace camway::scene
