// SPDX-License-Identifier: MIT
#include <string>

#include "lcmtypes/wire/auth/message_auth.h"
#include "lcmtypes/wire/auth/message_keys.h"
#include "tests/fuzz/targets.h"

namespace camway::testing {
namespace {

constexpr char kChannel[] = "CAMWAY_PLAN_REQUEST";
constexpr char kSaid[] = "what was said";

/// Returns an authentication with fixed keys and a fixed time.
wire::MessageAuth auth() {
  static const auto read = wire::MessageKeys::from_text(
      "1 " + std::string(64, '1') + "\n2 " + std::string(64, '2') + "\n", "keys");
  return {read.keys, {}, [] { return std::int64_t{1'800'000'000'000'000}; }};
}

bool exercise_envelope(std::span<const std::uint8_t> bytes) {
  const wire::MessageAuth::Opened opened = auth().open(kChannel, bytes);
  if (opened.message) {
    promise(as_text(*opened.message) == kSaid, "nothing is trusted but what was signed");
  }
  static const auto keys =
      wire::MessageKeys::from_text("1 " + std::string(64, '1') + "\n", "keys").keys;
  const wire::MessageAuth::Opened recorded = wire::open_recorded(*keys, kChannel, bytes);
  if (recorded.message) {
    promise(as_text(*recorded.message) == kSaid, "nor in a recording");
  }
  return opened.message.has_value();
}

std::vector<FuzzBytes> envelope_seeds() {
  std::vector<FuzzBytes> all;
  for (int i = 0; i < 10; ++i) all.push_back(auth().seal(kChannel, fuzz_bytes(kSaid)));
  all.push_back(fuzz_bytes(kSaid));
  return all;
}

bool exercise_key_file(std::span<const std::uint8_t> bytes) {
  const auto read = wire::MessageKeys::from_text(as_text(bytes), "fuzzed");
  promise((read.keys != nullptr) == read.error.empty(), "keys or a reason");
  return read.keys != nullptr;
}

std::vector<FuzzBytes> key_file_seeds() {
  const std::string digits = "0123456789abcdefABCDEF01234567890123456789abcdef0123456789abcdef";
  return {fuzz_bytes("1 " + digits + "\n"),
          fuzz_bytes("# old and new\n7 " + digits + "  # remark\n\n2147483647 " + digits),
          fuzz_bytes("-1 " + digits + "\n"), fuzz_bytes("1")};
}

}  // namespace

constinit const FuzzTarget kEnvelopeTarget{"envelope", exercise_envelope, envelope_seeds, 20'000};
constinit const FuzzTarget kKeyFileTarget{"key_file", exercise_key_file, key_file_seeds, 20'000};

}  // namespace camway::testing
