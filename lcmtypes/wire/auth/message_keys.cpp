// SPDX-License-Identifier: MIT
#include "lcmtypes/wire/auth/message_keys.h"

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <iterator>

namespace camway::wire {
namespace {

/// The first part of all signed data, so that a tag is not valid in any other context.
constexpr std::string_view kDomain = "camway envelope 1";
constexpr std::size_t kMaxFileBytes = 16'384;
constexpr mode_t kOthers = S_IRWXG | S_IRWXO;
/// Rights that must be off in files of root's: their group may read.
constexpr mode_t kOthersOfRoots = S_IWGRP | S_IXGRP | S_IRWXO;

static_assert(MessageKeys::kSecretBytes >= crypto_generichash_KEYBYTES_MIN &&
              MessageKeys::kSecretBytes <= crypto_generichash_KEYBYTES_MAX);
static_assert(sizeof(envelope_t::tag) == crypto_generichash_BYTES);

/// A file descriptor that the destructor closes.
class File {
 public:
  // Without O_NONBLOCK, opening a pipe would wait.
  explicit File(const std::string& name)
      : fd_(open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK)) {}
  ~File() {
    if (fd_ >= 0) close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

/// Returns why an open file cannot be trusted; empty if it can.
std::string fault_of(int fd) {
  struct stat information {};
  if (fstat(fd, &information) != 0) return std::strerror(errno);
  if (!S_ISREG(information.st_mode)) return "is no regular file";
  const bool is_of_root = information.st_uid == 0;
  if (!is_of_root && information.st_uid != geteuid()) {
    return "belongs to another user (chown it to who runs this program, or to root)";
  }
  if (!is_of_root && (information.st_mode & kOthers) != 0) {
    return "may be used by others than its owner (chmod 600)";
  }
  if ((information.st_mode & kOthersOfRoots) != 0) {
    return "may be used by others than root and who its group lets read (chmod 600 or 640)";
  }
  if (information.st_size > static_cast<off_t>(kMaxFileBytes)) return "is longer than any key file";
  return {};
}

/// Returns false if the file cannot be read, or grew longer than a key file may be.
bool read_text(int fd, std::string& text) {
  text.resize(kMaxFileBytes + 1);
  std::size_t size = 0;
  while (size < text.size()) {
    const ssize_t got = read(fd, text.data() + size, text.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return false;
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
  }
  const bool complete = size <= kMaxFileBytes;
  text.resize(size);
  return complete;
}

/// Adds a number as it is on the wire, big-endian.
void update(crypto_generichash_state& state, std::uint64_t number) {
  std::array<std::uint8_t, sizeof number> bytes{};
  for (auto byte = bytes.rbegin(); byte != bytes.rend(); ++byte) {
    *byte = static_cast<std::uint8_t>(number);
    number >>= 8U;
  }
  crypto_generichash_update(&state, bytes.data(), bytes.size());
}

void update(crypto_generichash_state& state, std::string_view text) {
  update(state, std::uint64_t{text.size()});
  crypto_generichash_update(&state, reinterpret_cast<const unsigned char*>(text.data()),
                            text.size());
}

std::string_view next_word(std::string_view& text) {
  constexpr std::string_view kSpace = " \t\r";
  text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kSpace));
  text.remove_prefix(word.size());
  return word;
}

}  // namespace

MessageKeys::ReadResult MessageKeys::from_file(const std::string& file) {
  const File opened(file);
  if (opened.get() < 0) return {nullptr, file + ": " + std::strerror(errno)};
  if (const std::string fault = fault_of(opened.get()); !fault.empty()) {
    return {nullptr, file + ": " + fault};
  }
  std::string text;
  const bool complete = read_text(opened.get(), text);
  ReadResult result =
      complete ? from_text(text, file) : ReadResult{nullptr, file + ": cannot be read whole"};
  sodium_memzero(text.data(), text.size());
  return result;
}

MessageKeys::ReadResult MessageKeys::from_text(std::string_view text, const std::string& file) {
  if (sodium_init() < 0) return {nullptr, "libsodium does not work here"};
  const std::shared_ptr<MessageKeys> keys(new MessageKeys);
  keys->keys_.reserve(kMaxKeys);  // so that no copy of a secret is left behind
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (const std::string fault = keys->add_line(line.substr(0, line.find('#'))); !fault.empty()) {
      return {nullptr, file + ":" + std::to_string(number) + ": " + fault};
    }
  }
  if (keys->keys_.empty()) return {nullptr, file + ": holds no key"};
  return {keys, {}};
}

MessageKeys::~MessageKeys() {
  for (Key& key : keys_) sodium_memzero(key.secret.data(), key.secret.size());
}

/// Adds the key of a line without its remark. Returns the fault of the line, without the secret.
std::string MessageKeys::add_line(std::string_view line) {
  const std::string_view id = next_word(line);
  if (id.empty()) return {};
  const std::string_view secret = next_word(line);
  if (!next_word(line).empty()) return "must be an id and a key, and nothing else";
  if (keys_.size() == kMaxKeys) return "more than " + std::to_string(kMaxKeys) + " keys";
  Key key;
  const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), key.id);
  if (error != std::errc{} || end != id.data() + id.size() || key.id < 0) {
    return "the id is not a whole number from 0 to 2147483647";
  }
  const std::vector<std::int32_t> known = ids();
  if (std::find(known.begin(), known.end(), key.id) != known.end()) {
    return "id " + std::to_string(key.id) + " is there twice";
  }
  std::size_t size = 0;
  const bool good = secret.size() == 2 * kSecretBytes &&
                    sodium_hex2bin(key.secret.data(), key.secret.size(), secret.data(),
                                   secret.size(), nullptr, &size, nullptr) == 0 &&
                    size == kSecretBytes;
  if (good) keys_.push_back(key);
  sodium_memzero(key.secret.data(), key.secret.size());
  return good ? ""
              : "the key is not of " + std::to_string(2 * kSecretBytes) + " hexadecimal digits";
}

MessageKeys::Tag MessageKeys::tag_of(const Secret& secret, std::string_view channel,
                                     const envelope_t& envelope) {
  Tag tag{};
  crypto_generichash_state state;
  crypto_generichash_init(&state, secret.data(), secret.size(), tag.size());
  update(state, kDomain);
  update(state, channel);
  update(state, static_cast<std::uint64_t>(envelope.key_id));
  update(state, static_cast<std::uint64_t>(envelope.sender));
  update(state, static_cast<std::uint64_t>(envelope.counter));
  update(state, static_cast<std::uint64_t>(envelope.utime));
  update(state, std::uint64_t{envelope.payload.size()});
  crypto_generichash_update(&state, envelope.payload.data(), envelope.payload.size());
  crypto_generichash_final(&state, tag.data(), tag.size());
  return tag;
}

void MessageKeys::sign(std::string_view channel, envelope_t& envelope) const {
  envelope.key_id = keys_.front().id;
  const Tag tag = tag_of(keys_.front().secret, channel, envelope);
  std::copy(tag.begin(), tag.end(), std::begin(envelope.tag));
}

MessageKeys::Verdict MessageKeys::verify(std::string_view channel,
                                         const envelope_t& envelope) const {
  const auto key = std::find_if(keys_.begin(), keys_.end(),
                                [&](const Key& k) { return k.id == envelope.key_id; });
  if (key == keys_.end()) return Verdict::kUnknownKey;
  const Tag tag = tag_of(key->secret, channel, envelope);
  // Compares in constant time.
  const bool same = sodium_memcmp(tag.data(), envelope.tag, tag.size()) == 0;
  return same ? Verdict::kGood : Verdict::kAltered;
}

std::int64_t MessageKeys::random_number() {
  std::int64_t number = 0;
  randombytes_buf(&number, sizeof number);
  return number;
}

std::vector<std::int32_t> MessageKeys::ids() const {
  std::vector<std::int32_t> ids;
  for (const Key& key : keys_) ids.push_back(key.id);
  return ids;
}

}  // namespace camway::wire
