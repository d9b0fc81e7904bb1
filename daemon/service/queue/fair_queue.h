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

/// Why a job is not run.
enum class Refusal {
  kQueueFull,   ///< as many wait as may, and this client has its part of them
  kClientFull,  ///< as many of this client wait as may
  kExpired,     ///< its deadline passed while it waited
  kCancelled,   ///< it is not wanted any more
  kStopping,    ///< no more jobs are begun
};

/// A job on its way to a worker.
struct Job {
  using Clock = std::chrono::steady_clock;

  std::function<void()> run;             ///< by a worker; must not throw
  std::function<void(Refusal)> abandon;  ///< instead of `run`, by whoever took it out of the queue
  std::string client;                    ///< whom its time is charged to
  std::optional<std::int64_t> id = {};   ///< among the jobs of the client, to find it again
  Priority priority = Priority::kNormal;
  Clock::time_point expires = Clock::time_point::max();  ///< not worth running from then on
  /// Jobs of one strand are begun one after the other, each when the one before is done; those of a
  /// client in the order in which they came. Empty: of none.
  std::string strand = {};
};

/// Jobs that wait, dealt so that every client gets the same time of the workers, whatever the
/// others ask for: start-time fair queueing (Goyal, Vin and Cheng, 1997), where a job is charged
/// with what its client's last one took until its own time is known. A client's own jobs go by
/// priority, then first come first served; one of high priority is charged a quarter of its time,
/// one of low priority four times. Who may not begin now, for his strand or his part of the
/// workers, lets others go before, and is next as soon as he may.
///
/// An id costs nothing, so who invents many would have as many turns. Therefore newcomers, of whom
/// no job was finished as far as is remembered, take turns like all others, but together they get
/// no more time than a few clients, and when the queue is full no more than half of its places if
/// others want them. For one thread at a time.
class FairQueue {
 public:
  using Clock = Job::Clock;

  struct Limits {
    std::size_t jobs = 256;             ///< that wait [Limit: 1 <= value]
    std::size_t jobs_of_a_client = 64;  ///< likewise
    /// Clients that are remembered, and so are no newcomers. [Limit: 2 <= value]
    std::size_t remembered_clients = 1024;
    /// So many clients all newcomers together count as. [Limit: 1 <= value]
    std::size_t newcomers_count_as = 8;
    /// Jobs of a client that run at a time. [Limit: 1 <= value]
    std::size_t running_of_a_client = std::numeric_limits<std::size_t>::max();
  };

  explicit FairQueue(const Limits& limits) : limits_(limits), known_(limits.remembered_clients) {}

  struct Refused {
    Job job;
    Refusal why;
  };
  /// Queues `job`; returns the job for which there is no room then, if any: it may be an older one,
  /// of lower priority or of the client with the most of them, that has to make way.
  std::optional<Refused> push(Job job);

  struct Begun {
    Job job;
    double charged_s = 0.0;
    bool of_newcomer = false;
  };
  /// Whether there is a job that may begin now. Looks at the jobs of clients in turn, until it
  /// finds one: at once, where none has a strand.
  [[nodiscard]] bool can_begin() const { return next().has_value(); }
  /// The job that is next. Precondition: `can_begin`.
  Begun pop();
  /// To be told once for each popped job: how long it took.
  void finish(const Begun& begun, Clock::duration took);

  /// Takes out the jobs that have expired by `now`.
  std::vector<Job> take_expired(Clock::time_point now);
  /// Takes out that job, if it waits.
  std::optional<Job> take(const std::string& client, std::int64_t id);
  /// Takes out all jobs.
  std::vector<Job> take_all();

  [[nodiscard]] bool empty() const { return expiries_.empty(); }
  [[nodiscard]] std::size_t size() const { return expiries_.size(); }
  /// About how many jobs are begun before that one, which waits: exactly, if all take the same time
  /// and no more come. Nothing if it does not wait.
  [[nodiscard]] std::optional<std::size_t> ahead_of(const std::string& client,
                                                    std::int64_t id) const;
  /// When the next job expires; the end of time if none does.
  [[nodiscard]] Clock::time_point next_expiry() const;

 private:
  /// Highest priority first, then first come. The number is unique.
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
    double last_s = 0.0;  ///< what its last job took
    std::uint64_t turn = 0;
    bool is_newcomer = true;
  };
  using Clients = std::map<std::string, Client>;
  /// Least time used first, then who had to wait for his turn longest.
  using Turn = std::tuple<double, std::uint64_t, std::string>;

  Clients::iterator find_or_begin(const std::string& name);
  /// Which of the client's jobs may begin now, if any.
  [[nodiscard]] std::optional<Place> next_of(const Client& client) const;
  /// Who has the next turn, and with which job.
  struct Next {
    std::string client;
    Place place;
  };
  [[nodiscard]] std::optional<Next> next() const;
  void charge(Client& client, double charge_s, bool of_newcomer);
  /// Who has to make way for a job of `client`: a job that waits, or nobody, then there is no room.
  struct Victim {
    Refusal why;
    std::optional<Clients::iterator> client;
  };
  std::optional<Victim> victim_for(Clients::iterator client, Priority priority);
  /// A newcomer with most jobs, if newcomers have more than half of the places.
  std::optional<Clients::iterator> crowd();
  Job take(Clients::iterator client, std::map<Place, Waiting>::iterator position);
  void unlink(Clients::iterator client);
  void link(Clients::iterator client);
  void forget_idle();

  Limits limits_;
  Clients clients_;
  KnownClients known_;
  std::set<Turn> ready_;      ///< clients with jobs that wait, but newcomers
  std::set<Turn> newcomers_;  ///< newcomers with jobs that wait
  std::set<Turn> idle_;       ///< clients without any job that used more than others
  Expiries expiries_;         ///< of all jobs that wait
  std::set<std::string> busy_strands_;
  std::size_t running_ = 0;
  std::uint64_t next_number_ = 0;
  double now_s_ = 0.0;        ///< the time used by the client that was served last
  double newcomers_s_ = 0.0;  ///< by newcomers, each of the clients that they count as
};

}  // namespace camway::service
