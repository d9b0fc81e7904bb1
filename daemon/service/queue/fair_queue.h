// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "daemon/service/queue/known_clients.h"

namespace camway::service {

enum class Priority : std::int8_t { kLow = -1, kNormal = 0, kHigh = 1 };

/// Reason why a job is not run.
enum class Refusal {
  kQueueFull,   ///< the queue is full, and this client has its share of it
  kClientFull,  ///< this client has as many waiting jobs as it may
  kExpired,     ///< its deadline passed while it waited
  kCancelled,   ///< it was cancelled
  kStopping,    ///< no more jobs are begun
};

/// A job for a worker.
struct Job {
  using Clock = std::chrono::steady_clock;

  std::function<void()> run;             ///< called by a worker; must not throw
  std::function<void(Refusal)> abandon;  ///< called instead of `run`, after removal from the queue
  std::string client;                    ///< client that its time is charged to
  std::optional<std::int64_t> id = {};   ///< identifies it among the jobs of the client
  Priority priority = Priority::kNormal;
  Clock::time_point expires = Clock::time_point::max();  ///< not worth running from then on
  /// Jobs of one strand are begun one after the other, each when the one before is done; those of
  /// one client in the order of their arrival. Empty: no strand.
  std::string strand = {};
};

/// Waiting jobs, ordered so that every client gets the same time of the workers, whatever the
/// others ask for: start-time fair queueing (Goyal, Vin and Cheng, 1997). Deviation: a job is
/// charged the time of its client's last one until its own time is known. The jobs of one client
/// are ordered by priority, then by arrival; one of high priority is charged a quarter of its time,
/// one of low priority four times its time. A client whose next job cannot start (its strand is
/// busy, or its quota of workers is used) is skipped and keeps its turn.
///
/// Ids are free, so a client that invents many of them would have as many turns. A *newcomer* is a
/// client none of whose jobs is remembered as finished. Newcomers take turns like all others. But
/// all newcomers together get no more time than `newcomers_count_as` clients and, if others want
/// places in a full queue, no more than half of them. Not thread-safe.
class FairQueue {
 public:
  using Clock = Job::Clock;

  struct Limits {
    std::size_t jobs = 256;             ///< waiting jobs [Limit: 1 <= value]
    std::size_t jobs_of_a_client = 64;  ///< waiting jobs of one client [Limit: 1 <= value]
    /// Clients that are remembered, and so are not newcomers. [Limit: 2 <= value]
    std::size_t remembered_clients = 1024;
    /// Number of clients that all newcomers together count as. [Limit: 1 <= value]
    std::size_t newcomers_count_as = 8;
    /// Jobs of one client that run at a time. [Limit: 1 <= value]
    std::size_t running_of_a_client = std::numeric_limits<std::size_t>::max();
  };

  explicit FairQueue(const Limits& limits) : limits_(limits), known_(limits.remembered_clients) {}

  struct Refused {
    Job job;
    Refusal why;
  };
  /// Queues `job`. Returns the job for which there is no room then, if any: `job` itself, or an
  /// older one of lower priority or of the client with the most waiting jobs.
  std::optional<Refused> push(Job job);

  struct Begun {
    Job job;
    double charged_s = 0.0;
    bool of_newcomer = false;
  };
  /// Returns whether a job may begin now. Checks the clients in turn until one has such a job. If
  /// no job has a strand, that is the first client.
  [[nodiscard]] bool can_begin() const { return next().has_value(); }
  /// Removes and returns the next job. Requires `can_begin`.
  Begun pop();
  /// Records how long a popped job took. Requires exactly one call for each popped job.
  void finish(const Begun& begun, Clock::duration took);

  /// Removes and returns the jobs that have expired by `now`.
  std::vector<Job> take_expired(Clock::time_point now);
  /// Removes and returns that job, if it waits.
  std::optional<Job> take(const std::string& client, std::int64_t id);
  /// Removes and returns all jobs.
  std::vector<Job> take_all();

  [[nodiscard]] bool empty() const { return expiries_.empty(); }
  [[nodiscard]] std::size_t size() const { return expiries_.size(); }
  /// Returns about how many jobs are begun before this waiting one. The number is exact if all jobs
  /// take the same time and no more arrive. Returns nothing if the job does not wait.
  [[nodiscard]] std::optional<std::size_t> ahead_of(const std::string& client,
                                                    std::int64_t id) const;
  /// Returns the time at which the next job expires; the end of time if none does.
  [[nodiscard]] Clock::time_point next_expiry() const;

 private:
  /// Highest priority first, then order of arrival. The number is unique.
  using Place = std::pair<int, std::uint64_t>;
  using Expiries = std::multimap<Clock::time_point, std::pair<std::string, Place>>;
  struct Waiting {
    Job job;
    Expiries::iterator expiry;
  };
  struct Client {
    std::map<Place, Waiting> waiting;
    std::size_t running = 0;
    double used_s = 0.0;  ///< weighted time, on the scale of `now_s_`
    double last_s = 0.0;  ///< time that its last job took
    std::uint64_t turn = 0;
    bool is_newcomer = true;
  };
  using Clients = std::map<std::string, Client>;
  /// Least time used first, then the client that waited longest for its turn.
  using Turn = std::tuple<double, std::uint64_t, std::string>;

  Clients::iterator find_or_begin(const std::string& name);
  /// Returns the job of the client that may begin now, if any.
  [[nodiscard]] std::optional<Place> next_of(const Client& client) const;
  /// The client that has the next turn, and its job.
  struct Next {
    std::string client;
    Place place;
  };
  [[nodiscard]] std::optional<Next> next() const;
  void charge(Client& client, double charge_s, bool of_newcomer);
  /// The client that has to drop a waiting job for a new one; none if there is no room.
  struct Victim {
    Refusal why;
    std::optional<Clients::iterator> client;
  };
  std::optional<Victim> victim_for(Clients::iterator client, Priority priority);
  /// Returns the newcomer with most jobs, if newcomers have more than half of the places.
  std::optional<Clients::iterator> largest_newcomer();
  Job take(Clients::iterator client, std::map<Place, Waiting>::iterator position);
  void unlink(Clients::iterator client);
  void link(Clients::iterator client);
  void forget_idle();

  Limits limits_;
  Clients clients_;
  KnownClients known_;
  std::set<Turn> ready_;      ///< clients with waiting jobs, except newcomers
  std::set<Turn> newcomers_;  ///< newcomers with waiting jobs
  std::set<Turn> idle_;       ///< clients without any job that used more time than others
  Expiries expiries_;         ///< expiry of all waiting jobs
  std::set<std::string> busy_strands_;
  std::size_t running_ = 0;
  std::uint64_t next_number_ = 0;
  double now_s_ = 0.0;        ///< time used by the client that was served last
  double newcomers_s_ = 0.0;  ///< time used by newcomers, for each client that they count as
};

}  // namespace camway::service
