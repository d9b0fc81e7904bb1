// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace camway::base {

/// Largest number of threads that `chunk_threads` returns. With more, loops over large arrays are
/// limited by memory bandwidth.
inline constexpr unsigned kMaxChunkThreads = 8;

/// Number of threads to use if the caller asks for `asked`, where 0 means one per processor.
inline unsigned chunk_threads(unsigned asked) {
  return std::clamp(asked != 0 ? asked : std::thread::hardware_concurrency(), 1U, kMaxChunkThreads);
}

/// Calls `work(worker, chunk)` once for every chunk in [0, chunks) and returns when all are done.
/// Chunks are handed out in order to `workers` threads, the caller's included; which thread gets a
/// chunk is not deterministic, so the result of `work` must not depend on it. If `work` throws, no
/// more chunks are started and one of the exceptions is rethrown here. Requires workers >= 1.
template <class Work>
void for_each_chunk(unsigned workers, std::size_t chunks, const Work& work) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;  // guarded by mutex
  const auto take_chunks = [&](unsigned worker) {
    try {
      for (;;) {
        const std::size_t chunk = next.fetch_add(1, std::memory_order_relaxed);
        if (chunk >= chunks) return;
        work(worker, chunk);
      }
    } catch (...) {  // out of memory; no exception may leave a thread
      next.store(chunks, std::memory_order_relaxed);
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
    }
  };
  std::vector<std::jthread> helpers;
  helpers.reserve(workers);
  for (unsigned worker = 1; worker < workers && worker < chunks; ++worker) {
    try {
      helpers.emplace_back(take_chunks, worker);
    } catch (const std::system_error&) {
      break;  // the system has no more threads: the existing ones do the work
    }
  }
  take_chunks(0);
  helpers.clear();  // waits for them
  if (failure) std::rethrow_exception(failure);
}

}  // namespace camway::base
