// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <camway/fleet_planner_t.hpp>
#include <camway/planner_status_t.hpp>

namespace camway::fleet {

/// The planners of a fleet as a front knows them, from their statuses and from its own jobs there.
/// A planner is alive if it was heard within `kSilence`.
/// Thread-safe.
class PlannerBoard {
 public:
  using Clock = std::chrono::steady_clock;
  using Now = std::function<Clock::time_point()>;

  static constexpr std::chrono::milliseconds kSilence{1000};
  /// A planner that was silent for this long is forgotten.
  static constexpr std::chrono::seconds kForgotten{60};
  static constexpr std::size_t kMostPlanners = 1024;

  /// `version`: planners of another version get no jobs, since other programs may plan differently;
  /// empty: all get some. `now`: the clock, or a substitute in tests.
  explicit PlannerBoard(std::string version = {}, Now now = Clock::now)
      : version_(std::move(version)), now_(std::move(now)) {}

  /// A start of a planner.
  struct Planner {
    std::string id;
    std::int64_t start_id = 0;

    auto operator<=>(const Planner&) const = default;
  };

  /// Takes in a status. One that is older than the newest of its planner counts for nothing.
  void note(const planner_status_t& status);
  /// Returns whether planners of this version get jobs.
  [[nodiscard]] bool takes_version(const std::string& version) const {
    return version_.empty() || version == version_;
  }

  enum class Outlook : std::uint8_t {
    kTaken,   ///< `Choice::planner` has a slot for the job
    kBusy,    ///< a planner is alive and has read enough, but none of them has a free slot
    kBehind,  ///< planners are alive, but none that is not to be avoided has read enough
    kNone     ///< no planner is alive that takes jobs
  };
  struct Choice {
    Outlook outlook = Outlook::kNone;
    Planner planner;
  };
  /// Takes a slot of a planner that is alive, does not leave and has read the log up to
  /// `least_position`: of the one with the most free slots, and of several, that of the lowest id.
  /// Requires a call of `give_back` for each planner that this returns.
  Choice take(std::int64_t least_position, const std::set<Planner>& avoided = {});

  enum class Return : std::uint8_t {
    kEnded,   ///< the job ended, or nothing more is expected of it
    kRefused  ///< the planner refused the job: it gets none before its next status
  };
  void give_back(const Planner& planner, Return why);

  /// Returns whether nothing can be expected of the planner: it is not alive, was started anew, or
  /// has ended.
  [[nodiscard]] bool is_lost(const Planner& planner) const;
  /// Returns whether this start of the planner has ended, by its own word or by a new start.
  [[nodiscard]] bool has_ended(const Planner& planner) const;

  /// Returns the slots that this front could take now, on planners that take jobs.
  [[nodiscard]] int free_slots() const;
  /// Returns how many jobs of this front can run at a time: the slots of the planners that take
  /// jobs, without those that other fronts use; at least 1 if there is such a planner, else 0.
  [[nodiscard]] int capacity() const;

  /// Returns how many planners are alive.
  [[nodiscard]] int alive() const;
  /// Returns whether any planner was heard within this time.
  [[nodiscard]] bool is_any_heard_within(std::chrono::milliseconds time) const;

  /// Returns the planners that are not forgotten, by id. `newest`: position of the log that the
  /// front has read.
  [[nodiscard]] std::vector<fleet_planner_t> planners(std::int64_t newest) const;

  /// Waits until something changes for those that wait for a slot, but for `longest` at most.
  void wait(std::chrono::milliseconds longest);

  /// Sets the listener, which is called with the capacity at once and whenever it has changed, on
  /// any thread but never on two at a time. It must not call `on_change`. Empty: none. When this
  /// returns, the old listener is not called any more.
  void on_change(std::function<void(int capacity)> listener);
  /// Looks which planners have become silent. To be called several times a second.
  void tick();

 private:
  struct Known {
    planner_status_t status;
    Clock::time_point heard;
    int own = 0;     ///< jobs of this front there
    int others = 0;  ///< slots that others had taken at the last status
    bool refuses = false;
  };
  using KnownMap = std::map<std::string, Known>;

  [[nodiscard]] bool is_alive(const Known& known, Clock::time_point now) const {
    return now - known.heard < kSilence;
  }
  [[nodiscard]] bool takes_jobs(const Known& known, Clock::time_point now) const {
    return is_alive(known, now) && known.status.is_leaving == 0 &&
           takes_version(known.status.version);
  }
  [[nodiscard]] int free_of(const Known& known) const;
  [[nodiscard]] bool is_newer(const Known& known, const planner_status_t& status,
                              Clock::time_point now) const;
  bool keep(const planner_status_t& status);
  void make_room(Clock::time_point now);
  [[nodiscard]] int capacity_locked() const;
  void tell();

  const std::string version_;
  const Now now_;
  mutable std::mutex mutex_;  ///< guards planners_ and changes_
  std::condition_variable changed_;
  std::uint64_t changes_ = 0;
  KnownMap planners_;

  std::mutex telling_;  ///< taken before mutex_; guards the next two
  std::function<void(int)> listener_;
  std::optional<int> told_;
};

}  // namespace camway::fleet
