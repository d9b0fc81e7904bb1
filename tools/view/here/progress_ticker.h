// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "daemon/base/deadline.h"
#include "tools/view/backend.h"

namespace camway::view {

/// Tells of the progress of plans: at once when a plan begins, and then each time that it has
/// changed, at most ten times a second. Thread-safe.
class ProgressTicker {
 public:
  ProgressTicker();
  ProgressTicker(const ProgressTicker&) = delete;
  ProgressTicker& operator=(const ProgressTicker&) = delete;
  ~ProgressTicker();

  /// A plan of which is told. Nothing is told after its end.
  class Entry {
   public:
    Entry(ProgressTicker* ticker, std::uint64_t key) : ticker_(ticker), key_(key) {}
    ~Entry();
    Entry(const Entry&) = delete;
    Entry& operator=(const Entry&) = delete;

   private:
    ProgressTicker* const ticker_;  ///< null if nobody wants to be told
    const std::uint64_t key_;
  };

  /// Tells that a plan begins. `tell` may be null.
  [[nodiscard]] Entry enter(const Tell& tell, const std::shared_ptr<const base::Progress>& state,
                            const base::Deadline& deadline, double deadline_s);

 private:
  struct Told {
    Tell tell;
    std::shared_ptr<const base::Progress> state;
    base::Deadline deadline;
    double deadline_s;
    int last = 0;  ///< a number that differs where the progress does
  };

  void run();
  static void tell_if_changed(Told& told);

  std::mutex mutex_;  ///< guards what is below; held while progress is told
  std::condition_variable changed_;
  std::map<std::uint64_t, Told> plans_;
  std::uint64_t last_key_ = 0;
  bool has_ended_ = false;
  std::jthread thread_;
};

}  // namespace camway::view
