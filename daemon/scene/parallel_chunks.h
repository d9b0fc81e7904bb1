// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <system_error>
#include <thread>
#include <vector>

namespace camway::scene {

/// More threads than this do not make the passes over a scene faster: they wait for memory.
inline constexpr unsigned kMaxChunkThreads = 8;

/// How many threads to use where `asked` is what the caller wants, 0 for one a processor.
inline unsigned chunk_threads(unsigned asked) {
  return std::clamp(asked != 0 ? asked : std::thread::hardware_concurrency(), 1U, kMaxChunkThreads);
}

/// Calls `work(worker, chunk)` once for every chunk in [0, chunks) and returns when all are done.
/// Chunks are handed out in order to `workers` threads, the caller's included; who gets which is
/// chance, so `work` must give the same for any. Preconditions: workers >= 1; `work` does not
/// throw.
template <class Work>
void for_each_chunk(unsigned workers, std::size_t chunks, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto take_chunks = [&](unsigned worker) {
    for (;;) {
      const std::size_t chunk = next.fetch_add(1, std::memory_order_relaxed);
      if (chunk >= chunks) return;
      work(worker, chunk);
    }
  };
  std::vector<std::jthread> helpers;
  helpers.reserve(workers);
  for (unsigned worker = 1; worker < workers && worker < chunks; ++worker) {
    try {
      helpers.emplace_back(take_chunks, worker);
    } catch (const std::system_error&) {
      break;  // the system has no more threads: those that there are do all of it
    }
  }
  take_chunks(0);
}

}  // namespace camway::scene
