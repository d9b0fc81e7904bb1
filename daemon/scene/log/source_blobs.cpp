// SPDX-License-Identifier: MIT
#include "daemon/scene/log/source_blobs.h"

#include <utility>
#include <vector>

#include "daemon/base/parallel_chunks.h"
#include "daemon/scene/log/source_record.h"

namespace camway::scene {
namespace {

/// Differences in a row: a start reads all of them.
constexpr int kMostDifferences = 64;

}  // namespace

std::optional<SourceBlobs::Known> SourceBlobs::find(
    const std::shared_ptr<const ObjectSource>& source) {
  const std::lock_guard lock(mutex_);
  const auto found = known_.find(source.get());
  // Another content may have been made in the same place after the known one was dropped.
  if (found == known_.end() || found->second.source.lock() != source) return std::nullopt;
  return found->second;
}

void SourceBlobs::remember(const std::shared_ptr<const ObjectSource>& source, Known known) {
  const std::lock_guard lock(mutex_);
  known_.insert_or_assign(source.get(), std::move(known));
}

AppendResult SourceBlobs::keep(const std::shared_ptr<const ObjectSource>& source,
                               const std::shared_ptr<const ObjectSource>& before, BlobId& id) {
  if (const std::optional<Known> known = find(source); known && log_.has_blob(known->id)) {
    id = known->id;
    return {};
  }
  const std::optional<Known> base = before ? find(before) : std::nullopt;
  if (const std::optional<Blob> small = base ? difference(*source, *before, *base) : std::nullopt) {
    return put(source, *small, {source, {}, base->differences + 1, before}, id);
  }
  return put(source, {record_of(*source), {}}, {source, {}, 0, {}}, id);
}

AppendResult SourceBlobs::put(const std::shared_ptr<const ObjectSource>& source, const Blob& blob,
                              Known known, BlobId& id) {
  id = blob_id_of(blob.bytes);
  known.id = id;
  AppendResult done = log_.put_blob(id, blob);
  if (done.fault == AppendFault::kNone) remember(source, std::move(known));
  return done;
}

std::optional<Blob> SourceBlobs::blob_again(const BlobId& id) {
  std::shared_ptr<const ObjectSource> source;
  std::shared_ptr<const ObjectSource> before;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [place, known] : known_) {
      if (known.id != id) continue;
      source = known.source.lock();
      before = known.before.lock();
      if (source != nullptr) break;
    }
  }
  if (source == nullptr) return std::nullopt;
  Blob blob{record_of(*source), {}};
  if (blob_id_of(blob.bytes) == id) return blob;
  const std::optional<Known> base = before ? find(before) : std::nullopt;
  if (!base || source->map_O == nullptr || before->map_O == nullptr) return std::nullopt;
  std::optional<Bytes> difference = record_of_difference(*source, *before, base->id);
  if (!difference || blob_id_of(*difference) != id) return std::nullopt;
  return Blob{*std::move(difference), {base->id}};
}

std::optional<Blob> SourceBlobs::difference(const ObjectSource& source, const ObjectSource& before,
                                            const Known& base) {
  if (source.map_O == nullptr || before.map_O == nullptr) return std::nullopt;
  if (base.differences >= kMostDifferences || !log_.has_blob(base.id)) return std::nullopt;
  std::optional<Bytes> difference = record_of_difference(source, before, base.id);
  if (!difference) return std::nullopt;
  return Blob{*std::move(difference), {base.id}};
}

void SourceBlobs::add_known(const std::shared_ptr<const ObjectSource>& source, Read& read) {
  if (const std::optional<Known> known = find(source)) read.emplace(known->id, source);
}

base::Result<std::shared_ptr<const ObjectSource>> SourceBlobs::read(const BlobId& id,
                                                                    const ObjectOptions& options,
                                                                    Read& read) {
  // From the wanted record back to a whole one, or to one that was read before.
  std::vector<std::pair<BlobId, Bytes>> chain;
  std::optional<BlobId> next = id;
  while (next && !read.contains(*next)) {
    base::Result<Bytes> bytes = log_.blob(*next);
    if (!bytes) return base::Failure{std::move(bytes.error)};
    const base::Result<std::optional<BlobId>> base = base_of_record(*bytes);
    if (!base) return base::Failure{base.error};
    chain.emplace_back(*next, *std::move(bytes));
    if (chain.size() > kMostDifferences + 1) {
      return base::Failure{"the content of an object is damaged: it has too many parts"};
    }
    next = *base;
  }
  std::shared_ptr<const ObjectSource> source = next ? read.at(*next) : nullptr;
  const std::optional<Known> known = source ? find(source) : std::nullopt;
  int differences = known ? known->differences : -1;
  // Not std::views::reverse: Clang 14 cannot compile that of GCC 12's library.
  for (auto link = chain.rbegin(); link != chain.rend(); ++link) {
    const auto& [part, bytes] = *link;
    base::Result<std::shared_ptr<const ObjectSource>> made = source_from(bytes, source, options);
    if (!made) return base::Failure{std::move(made.error)};
    remember(*made, {*made, part, ++differences, source});
    source = *std::move(made);
    read.emplace(part, source);
  }
  return source;
}

void SourceBlobs::read_whole(std::span<const BlobId> ids, const ObjectOptions& options,
                             Read& read) {
  std::vector<std::shared_ptr<const ObjectSource>> made(ids.size());
  base::for_each_chunk(base::chunk_threads(0), ids.size(), [&](unsigned, std::size_t i) {
    const base::Result<Bytes> bytes = log_.blob(ids[i]);
    if (!bytes) return;
    const base::Result<std::optional<BlobId>> base = base_of_record(*bytes);
    if (!base || *base) return;
    auto source = source_from(*bytes, nullptr, options);
    if (source) made[i] = *std::move(source);
  });
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (made[i] == nullptr) continue;
    remember(made[i], {made[i], ids[i], 0, {}});
    read.emplace(ids[i], std::move(made[i]));
  }
}

void SourceBlobs::forget_unused() {
  const std::lock_guard lock(mutex_);
  std::erase_if(known_, [](const auto& each) { return each.second.source.expired(); });
}

}  // namespace camway::scene
