// SPDX-License-Identifier: MIT
#include "daemon/base/digest.h"

#include <xxhash.h>

#include <algorithm>

namespace camway::base {

void Digest::Free::operator()(XXH3_state_s* state) const { XXH3_freeState(state); }

Digest::Digest() : state_(XXH3_createState()) { XXH3_128bits_reset(state_.get()); }

void Digest::add(const void* bytes, std::size_t size) {
  XXH3_128bits_update(state_.get(), bytes, size);
}

Digest::Bytes Digest::bytes() const {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state_.get()));
  Bytes bytes{};
  std::ranges::copy(canonical.digest, bytes.begin());
  return bytes;
}

std::string Digest::text_of(const Bytes& bytes) {
  constexpr char kHexDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += kHexDigits[byte >> 4U];
    text += kHexDigits[byte & 15U];
  }
  return text;
}

}  // namespace camway::base
