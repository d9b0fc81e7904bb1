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

/// The keys that those share who may talk to each other, by id. Immutable, so safe from any thread;
/// the secrets are wiped when it goes.
class MessageKeys {
 public:
  static constexpr std::size_t kSecretBytes = 32;
  static constexpr std::size_t kMaxKeys = 64;

  /// Keys, or what is wrong with their file.
  struct Read {
    std::shared_ptr<const MessageKeys> keys;
    std::string error;  ///< names file and line; empty exactly when `keys` is set
  };
  /// Reads a file with a key on each line: its id, 0 to 2147483647, and 64 hexadecimal digits; `#`
  /// begins a remark. The first key signs, all of them are accepted. The file must be a regular one
  /// that belongs to who runs this process and that nobody else may read or write; or one of root's
  /// that at most its group may read, for a service whose user owns nothing. (An access list shows
  /// as the rights of the group, so what systemd's LoadCredential makes passes, too.)
  static Read from_file(const std::string& file);
  /// The same of the text of such a file; `file` is for messages.
  static Read from_text(std::string_view text, const std::string& file);

  ~MessageKeys();
  MessageKeys(const MessageKeys&) = delete;
  MessageKeys& operator=(const MessageKeys&) = delete;

  /// Sets `key_id` and `tag` of a message that is otherwise complete.
  void sign(std::string_view channel, envelope_t& envelope) const;

  enum class Verdict : std::uint8_t { kGood, kUnknownKey, kAltered };
  [[nodiscard]] Verdict verify(std::string_view channel, const envelope_t& envelope) const;

  [[nodiscard]] std::vector<std::int32_t> ids() const;

  /// That nobody can guess.
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
