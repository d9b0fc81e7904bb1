// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <camway/envelope_t.hpp>

namespace camway::wire {

/// The keys that the programs of one system share, by id. The destructor wipes the secrets from
/// memory. Immutable and therefore thread-safe.
class MessageKeys {
 public:
  static constexpr std::size_t kSecretBytes = 32;
  static constexpr std::size_t kMaxKeys = 64;

  /// Keys, or the fault of their file.
  struct Read {
    std::shared_ptr<const MessageKeys> keys;
    std::string error;  ///< names file and line; empty exactly when `keys` is set
  };
  /// Reads a file with a key on each line: an id from 0 to 2147483647, and 64 hexadecimal digits.
  /// `#` begins a remark. The first key signs; every key is accepted.
  ///
  /// Requires a regular file that belongs to the user of this process and that nobody else may use;
  /// or a file of root's that at most its group may read, for a service whose user owns no files.
  /// (An access control list shows as rights of the group, so files of systemd's LoadCredential
  /// pass.)
  static Read from_file(const std::string& file);
  /// Reads the text of such a file. `file` is its name for messages.
  static Read from_text(std::string_view text, const std::string& file);

  ~MessageKeys();
  MessageKeys(const MessageKeys&) = delete;
  MessageKeys& operator=(const MessageKeys&) = delete;

  /// Sets `key_id` and `tag` of an envelope. Requires all its other members to be set.
  void sign(std::string_view channel, envelope_t& envelope) const;

  enum class Verdict : std::uint8_t { kGood, kUnknownKey, kAltered };
  [[nodiscard]] Verdict verify(std::string_view channel, const envelope_t& envelope) const;

  [[nodiscard]] std::vector<std::int32_t> ids() const;

  /// Returns a cryptographically secure random number.
  static std::int64_t random_number();

 private:
  using Secret = std::array<std::uint8_t, kSecretBytes>;
  using Tag = std::array<std::uint8_t, sizeof(envelope_t::tag)>;
  struct Key {
    std::int32_t id = 0;
    Secret secret{};
  };

  MessageKeys() = default;
  static Tag tag_of(const Secret& secret, std::string_view channel, const envelope_t& envelope);
  std::string add_line(std::string_view line);

  std::vector<Key> keys_;
};

}  // namespace camway::wire
