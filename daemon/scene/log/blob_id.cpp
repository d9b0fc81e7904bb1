// SPDX-License-Identifier: MIT
#include <sodium/crypto_hash_sha256.h>

#include "daemon/scene/log/blob_hasher.h"
#include "daemon/scene/log/scene_log.h"

namespace camway::scene {

static_assert(std::tuple_size_v<BlobId> == crypto_hash_sha256_BYTES);

struct BlobHasher::State {
  crypto_hash_sha256_state sha;
};

BlobHasher::BlobHasher() : state_(std::make_unique<State>()) {
  crypto_hash_sha256_init(&state_->sha);
}

BlobHasher::~BlobHasher() = default;

void BlobHasher::add(std::span<const std::byte> part) {
  crypto_hash_sha256_update(&state_->sha, reinterpret_cast<const unsigned char*>(part.data()),
                            part.size());
}

BlobId BlobHasher::finish() {
  BlobId id;
  crypto_hash_sha256_final(&state_->sha, reinterpret_cast<unsigned char*>(id.data()));
  return id;
}

BlobId blob_id_of(const Bytes& bytes) {
  BlobHasher hasher;
  hasher.add(bytes);
  return hasher.finish();
}

}  // namespace camway::scene
