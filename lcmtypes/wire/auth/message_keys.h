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
  struct ReadResult {
    std::shared_ptr<const MessageKeys> keys;
    std::string error;  ///< names file and line; empty exactly when `keys` is set
  };
  /// Reads a file with a key on each line: an id from 0 to 2147483647, and 64 hexadecimal digits.
  /// `#` begins a remark. `sign` uses the first key; `verify` accepts every key.
  ///
  /// Requires a regular file that belongs to the user of this process and that nobody else may use;
  /// or a regular file that root owns, that only root may write, and that only root and the file's
  /// group may read. The second form is for a service whose user owns no files. (An access control
  /// list shows as rights of the group, so files of systemd's LoadCredential pass.)
  ///
  /// Returns an error for any other file, for one of more than 16 KiB, without a key, with more
  /// than `kMaxKeys` keys, with an id that occurs twice, or with a line of another form.
  static ReadResult from_file(const std::string& file);
  /// Reads the text of such a file, of any size. `file` is its name for messages.
  static ReadResult from_text(std::string_view text, const std::string& file);

  ~MessageKeys();
  MessageKeys(const MessageKeys&) = delete;
  MessageKeys& operator=(const MessageKeys&) = delete;

  /// Signs an envelope with the first key: sets `key_id` and `tag`. Requires all its other members
  /// to be set. The tag is the keyed BLAKE2b hash (libsodium's generichash) of a constant, the
  /// channel and all other members.
  void sign(std::string_view channel, envelope_t& envelope) const;

  enum class Verdict : std::uint8_t {
    kGood,
    kUnknownKey,  ///< no key has the envelope's `key_id`
    kAltered,     ///< the tag is not that of the channel and the other members
  };
  /// Returns whether the tag of an envelope that came in on `channel` is that which `sign` gives
  /// with the key `key_id`. Compares tags in constant time. Does not check `utime` and `counter`.
  [[nodiscard]] Verdict verify(std::string_view channel, const envelope_t& envelope) const;

  /// Returns the ids of the keys, in the order of the file.
  [[nodiscard]] std::vector<std::int32_t> ids() const;

  /// Returns a cryptographically secure random number, any value of std::int64_t.
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
