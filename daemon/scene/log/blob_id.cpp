// SPDX-License-Identifier: MIT
#include <sodium/crypto_hash_sha256.h>

#include "daemon/scene/log/scene_log.h"

namespace camway::scene {

BlobId blob_id_of(const Bytes& bytes) {
  static_assert(std::tuple_size_v<BlobId> == crypto_hash_sha256_BYTES);
  BlobId id;
  crypto_hash_sha256(reinterpret_cast<unsigned char*>(id.data()),
                     reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  return id;
}

}  // namespace camway::scene
