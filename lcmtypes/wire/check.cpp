// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/check.h"

#include <algorithm>

#include "lcmtypes/wire/channels.h"

namespace camway::wire {
namespace {

using ByteSpan = std::span<const std::uint8_t>;

constexpr std::string_view kFingerprint = "fingerprint";

/// Reads big-endian numbers and skips bytes, never past the end.
class Reader {
 public:
  explicit Reader(ByteSpan bytes) : rest_(bytes) {}

  [[nodiscard]] std::size_t left() const { return rest_.size(); }

  /// Returns the next `count` bytes, or nothing if there are fewer.
  std::optional<ByteSpan> take(std::size_t count) {
    if (count > rest_.size()) return std::nullopt;
    const ByteSpan taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }

  template <class Integer>
  std::optional<Integer> integer() {
    const std::optional<ByteSpan> bytes = take(sizeof(Integer));
    if (!bytes) return std::nullopt;
    std::uint64_t value = 0;
    for (const std::uint8_t byte : *bytes) value = (value << 8) | byte;
    return static_cast<Integer>(value);
  }

 private:
  ByteSpan rest_;
};

Fault short_of(std::string_view field, std::size_t needed, std::size_t left) {
  return {std::string(field),
          "needs " + std::to_string(needed) + " bytes, only " + std::to_string(left) + " are left"};
}

std::optional<Fault> walk(std::span<const Field> fields, Reader& reader);

std::optional<Fault> check_fixed(const Field& field, Reader& reader) {
  const std::size_t left = reader.left();
  if (!reader.take(field.bytes)) return short_of(field.name, field.bytes, left);
  return std::nullopt;
}

std::optional<Fault> check_string(const Field& field, Reader& reader) {
  const std::optional<std::int32_t> length = reader.integer<std::int32_t>();
  if (!length) return short_of(field.name, sizeof(std::int32_t), reader.left());
  if (*length < 1) {
    return Fault{std::string(field.name), "length " + std::to_string(*length) + " is below 1"};
  }
  const auto size = static_cast<std::size_t>(*length);
  if (size - 1 > field.max_length) {
    return Fault{std::string(field.name), "length " + std::to_string(size - 1) + " is above " +
                                              std::to_string(field.max_length)};
  }
  const std::size_t left = reader.left();
  const std::optional<ByteSpan> text = reader.take(size);
  if (!text) return short_of(field.name, size, left);
  const auto nul = std::find(text->begin(), text->end(), std::uint8_t{0});
  if (nul != text->end() - 1) {
    return Fault{std::string(field.name),
                 nul == text->end() ? "does not end in a NUL" : "holds a NUL before its end"};
  }
  return std::nullopt;
}

std::optional<Fault> check_elements(const Field& field, std::size_t count, Reader& reader) {
  for (std::size_t i = 0; i < count; ++i) {
    if (std::optional<Fault> fault = walk(field.element, reader)) {
      fault->field =
          std::string(field.name) + "[" + std::to_string(i) + "]." + std::move(fault->field);
      return fault;
    }
  }
  return std::nullopt;
}

std::optional<Fault> check_list(const Field& field, Reader& reader) {
  const std::optional<std::int32_t> signed_count = reader.integer<std::int32_t>();
  if (!signed_count) return short_of(field.name, sizeof(std::int32_t), reader.left());
  if (*signed_count < 0) {
    return Fault{std::string(field.name),
                 "count " + std::to_string(*signed_count) + " is negative"};
  }
  const auto count = static_cast<std::size_t>(*signed_count);
  // An element takes at least a byte, so a count above the bytes left is wrong whatever the type.
  const std::size_t least_bytes = field.element.empty() ? field.bytes : 1;
  if (count > reader.left() / least_bytes) {
    return short_of(field.name, count * least_bytes, reader.left());
  }
  if (!field.element.empty()) return check_elements(field, count, reader);
  reader.take(count * field.bytes);
  return std::nullopt;
}

std::optional<Fault> check_field(const Field& field, Reader& reader) {
  switch (field.kind) {
    case Field::Kind::kFixed:
      return check_fixed(field, reader);
    case Field::Kind::kString:
      return check_string(field, reader);
    case Field::Kind::kList:
      return check_list(field, reader);
  }
  return Fault{std::string(field.name), "is of an unknown kind"};
}

std::optional<Fault> walk(std::span<const Field> fields, Reader& reader) {
  for (const Field& field : fields) {
    if (std::optional<Fault> fault = check_field(field, reader)) return fault;
  }
  return std::nullopt;
}

std::optional<Fault> check_fingerprint(const Layout& layout, Reader& reader) {
  const std::optional<std::int64_t> fingerprint = reader.integer<std::int64_t>();
  if (!fingerprint) return short_of("message", sizeof(std::int64_t), reader.left());
  if (*fingerprint != layout.fingerprint) {
    return Fault{std::string(kFingerprint),
                 "is not that of this type: other type or other version"};
  }
  return std::nullopt;
}

}  // namespace

std::string Fault::text(std::string_view type) const {
  std::string text(type);
  if (!field.empty()) text += "." + field;
  return text + ": " + reason;
}

bool is_other_version(const Fault& fault) { return fault.field == kFingerprint; }

std::optional<Fault> check(const Layout& layout, std::span<const std::uint8_t> bytes) {
  if (bytes.size() > layout.max_bytes) {
    return Fault{"", std::to_string(bytes.size()) + " bytes are more than a message may have (" +
                         std::to_string(layout.max_bytes) + ")"};
  }
  Reader reader(bytes);
  if (std::optional<Fault> fault = check_fingerprint(layout, reader)) return fault;
  if (std::optional<Fault> fault = walk(layout.fields, reader)) return fault;
  if (reader.left() > 0) {
    return Fault{"", std::to_string(reader.left()) + " bytes follow the end of the message"};
  }
  return std::nullopt;
}

std::optional<Sender> peek_sender(const Layout& layout, std::span<const std::uint8_t> bytes) {
  Reader reader(bytes);
  if (check_fingerprint(layout, reader)) return std::nullopt;
  const std::optional<std::int32_t> length = reader.integer<std::int32_t>();
  if (!length || *length < 1) return std::nullopt;
  if (static_cast<std::size_t>(*length) > kMaxClientIdLength + 1) return std::nullopt;
  const std::optional<ByteSpan> text = reader.take(static_cast<std::size_t>(*length));
  const std::optional<std::int64_t> request_id = reader.integer<std::int64_t>();
  if (!text || !request_id || text->back() != 0) return std::nullopt;
  std::string client_id(text->begin(), text->end() - 1);
  if (!is_client_id(client_id)) return std::nullopt;
  return Sender{std::move(client_id), *request_id};
}

}  // namespace camway::wire
