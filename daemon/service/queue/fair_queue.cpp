// SPDX-License-Identifier: MIT
#include "daemon/service/queue/fair_queue.h"

#include <algorithm>
#include <iterator>

namespace camway::service {
namespace {

/// Every job is charged something, so that clients with very short jobs take turns too.
constexpr double kLeastCharge_s = 1e-4;

double weight_of(Priority priority) {
  constexpr double kStep = 4.0;
  switch (priority) {
    case Priority::kHigh:
      return 1.0 / kStep;
    case Priority::kLow:
      return kStep;
    case Priority::kNormal:
      return 1.0;
  }
  return 1.0;
}

double seconds(FairQueue::Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

std::optional<FairQueue::Refused> FairQueue::push(Job job) {
  const Clients::iterator client = find_or_begin(job.client);
  std::optional<Refused> refused;
  if (const std::optional<Victim> victim = victim_for(client, job.priority)) {
    if (!victim->client) {
      link(client);
      return Refused{std::move(job), victim->why};
    }
    const Clients::iterator other = *victim->client;
    unlink(other);
    refused = Refused{take(other, std::prev(other->second.waiting.end())), victim->why};
    if (other != client) link(other);
  }
  unlink(client);
  const Place place{-static_cast<int>(job.priority), ++next_number_};
  const auto expiry = expiries_.emplace(job.expires, std::pair{job.client, place});
  client->second.waiting.emplace(place, Waiting{std::move(job), expiry});
  link(client);
  return refused;
}

FairQueue::Begun FairQueue::pop() {
  const Next next = *this->next();
  const Clients::iterator position = clients_.find(next.client);
  unlink(position);
  Client& client = position->second;
  now_s_ = std::max(now_s_, client.used_s);
  newcomers_s_ = std::max(newcomers_s_, now_s_);
  Begun begun{take(position, client.waiting.find(next.place)), 0.0, client.is_newcomer};
  if (!begun.job.strand.empty()) busy_strands_.insert(begun.job.strand);
  begun.charged_s = std::max(client.last_s, kLeastCharge_s) * weight_of(begun.job.priority);
  charge(client, begun.charged_s, begun.of_newcomer);
  client.turn = ++next_number_;
  ++client.running;
  ++running_;
  link(position);
  return begun;
}

void FairQueue::finish(const Begun& begun, Clock::duration took) {
  const Clients::iterator position = clients_.find(begun.job.client);
  unlink(position);
  Client& client = position->second;
  client.last_s = std::max(seconds(took), kLeastCharge_s);
  charge(client, client.last_s * weight_of(begun.job.priority) - begun.charged_s,
         begun.of_newcomer);
  known_.note_served(begun.job.client);
  busy_strands_.erase(begun.job.strand);
  client.is_newcomer = false;
  --client.running;
  --running_;
  link(position);
  forget_idle();
}

std::vector<Job> FairQueue::take_expired(Clock::time_point now) {
  std::vector<Job> expired;
  while (next_expiry() <= now && !empty()) {
    const auto [name, place] = expiries_.begin()->second;
    const Clients::iterator client = clients_.find(name);
    unlink(client);
    expired.push_back(take(client, client->second.waiting.find(place)));
    link(client);
  }
  return expired;
}

std::optional<Job> FairQueue::take(const std::string& client, std::int64_t id) {
  const Clients::iterator position = clients_.find(client);
  if (position == clients_.end()) return std::nullopt;
  auto& waiting = position->second.waiting;
  const auto found =
      std::ranges::find_if(waiting, [id](const auto& place) { return place.second.job.id == id; });
  if (found == waiting.end()) return std::nullopt;
  unlink(position);
  Job job = take(position, found);
  link(position);
  return job;
}

std::vector<Job> FairQueue::take_all() { return take_expired(Clock::time_point::max()); }

std::optional<std::size_t> FairQueue::ahead_of(const std::string& client, std::int64_t id) const {
  const auto own = clients_.find(client);
  if (own == clients_.end()) return std::nullopt;
  const auto& waiting = own->second.waiting;
  const auto found =
      std::ranges::find_if(waiting, [id](const auto& place) { return place.second.job.id == id; });
  if (found == waiting.end()) return std::nullopt;
  // Every other client has one turn for each turn of this one.
  const auto before = static_cast<std::size_t>(std::distance(waiting.begin(), found));
  std::size_t ahead = before;
  for (const auto& [name, other] : clients_) {
    if (name == client) continue;
    const bool is_first =
        std::tie(other.used_s, other.turn) < std::tie(own->second.used_s, own->second.turn);
    ahead += std::min(other.waiting.size(), before + (is_first ? 1 : 0));
  }
  return ahead;
}

FairQueue::Clock::time_point FairQueue::next_expiry() const {
  return empty() ? Clock::time_point::max() : expiries_.begin()->first;
}

FairQueue::Clients::iterator FairQueue::find_or_begin(const std::string& name) {
  const auto [position, is_new] = clients_.try_emplace(name);
  Client& client = position->second;
  if (is_new) {
    client.turn = ++next_number_;
    client.is_newcomer = !known_.contains(name);
  }
  // A client that was idle has no claim to the time that it did not use.
  if (client.waiting.empty() && client.running == 0) {
    unlink(position);
    client.used_s = std::max(client.used_s, now_s_);
  }
  return position;
}

std::optional<FairQueue::Place> FairQueue::next_of(const Client& client) const {
  if (client.running >= limits_.running_of_a_client) return std::nullopt;
  const auto found = std::ranges::find_if(client.waiting, [this](const auto& place) {
    return !busy_strands_.contains(place.second.job.strand);
  });
  return found == client.waiting.end() ? std::nullopt : std::optional(found->first);
}

std::optional<FairQueue::Next> FairQueue::next() const {
  auto other = ready_.begin();
  auto newcomer = newcomers_.begin();
  while (other != ready_.end() || newcomer != newcomers_.end()) {
    const auto is_newcomers_turn = [&] {
      if (other == ready_.end()) return true;
      if (newcomer == newcomers_.end()) return false;
      const bool have_their_part = newcomers_s_ > std::get<double>(*other);
      return !have_their_part && *newcomer < *other;
    };
    const Turn& turn = is_newcomers_turn() ? *newcomer++ : *other++;
    const std::string& client = std::get<std::string>(turn);
    if (const std::optional<Place> place = next_of(clients_.find(client)->second)) {
      return Next{client, *place};
    }
  }
  return std::nullopt;
}

void FairQueue::charge(Client& client, double charge_s, bool of_newcomer) {
  client.used_s += charge_s;
  if (of_newcomer) newcomers_s_ += charge_s / static_cast<double>(limits_.newcomers_count_as);
}

std::optional<FairQueue::Clients::iterator> FairQueue::crowd() {
  std::size_t jobs = 0;
  Clients::iterator longest = clients_.end();
  for (const Turn& turn : newcomers_) {
    const Clients::iterator client = clients_.find(std::get<std::string>(turn));
    const std::size_t waiting = client->second.waiting.size();
    jobs += waiting;
    // Among those with equally many, the last in turn.
    if (longest == clients_.end() || waiting >= longest->second.waiting.size()) longest = client;
  }
  return 2 * jobs > limits_.jobs ? std::optional(longest) : std::nullopt;
}

std::optional<FairQueue::Victim> FairQueue::victim_for(Clients::iterator client,
                                                       Priority priority) {
  const std::map<Place, Waiting>& own = client->second.waiting;
  const bool client_full = own.size() >= limits_.jobs_of_a_client;
  if (!client_full && size() < limits_.jobs) return std::nullopt;
  const Refusal why = client_full ? Refusal::kClientFull : Refusal::kQueueFull;
  if (!client_full) {
    const auto longest =
        std::max_element(clients_.begin(), clients_.end(), [](const auto& a, const auto& b) {
          return a.second.waiting.size() < b.second.waiting.size();
        });
    if (longest->second.waiting.size() > own.size() + 1) return Victim{why, longest};
    if (!client->second.is_newcomer) {
      if (const auto newcomer = crowd()) return Victim{why, *newcomer};
    }
  }
  if (!own.empty() && std::prev(own.end())->second.job.priority < priority) {
    return Victim{why, client};
  }
  return Victim{why, std::nullopt};
}

Job FairQueue::take(Clients::iterator client, std::map<Place, Waiting>::iterator position) {
  Job job = std::move(position->second.job);
  expiries_.erase(position->second.expiry);
  client->second.waiting.erase(position);
  return job;
}

/// Removes a client from the sorted sets. Required before any change of the values that these sort
/// by. `link` inserts it again, or erases it: then the iterator is not valid any more.
void FairQueue::unlink(Clients::iterator client) {
  const Turn turn{client->second.used_s, client->second.turn, client->first};
  ready_.erase(turn);
  newcomers_.erase(turn);
  idle_.erase(turn);
}

void FairQueue::link(Clients::iterator client) {
  const Turn turn{client->second.used_s, client->second.turn, client->first};
  if (!client->second.waiting.empty()) {
    (client->second.is_newcomer ? newcomers_ : ready_).insert(turn);
  } else if (client->second.running == 0) {
    if (client->second.used_s > now_s_) {
      idle_.insert(turn);
    } else {
      clients_.erase(client);
    }
  }
}

void FairQueue::forget_idle() {
  const bool all_idle = empty() && running_ == 0;
  while (!idle_.empty() && (all_idle || idle_.size() > limits_.remembered_clients ||
                            std::get<double>(*idle_.begin()) <= now_s_)) {
    clients_.erase(std::get<std::string>(*idle_.begin()));
    idle_.erase(idle_.begin());
  }
  if (all_idle) now_s_ = newcomers_s_ = 0.0;
}

}  // namespace camway::service
