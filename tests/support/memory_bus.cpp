// SPDX-License-Identifier: MIT
#include "tests/support/memory_bus.h"

#include <algorithm>
#include <map>
#include <stop_token>
#include <thread>

namespace camway::testing {
namespace {

using BusClock = std::chrono::steady_clock;

/// How often a receiver looks whether its process goes on.
constexpr std::chrono::milliseconds kStallLook{2};

bool matches(const std::string& pattern, const std::string& subject) {
  if (!pattern.ends_with(">")) return pattern == subject;
  return subject.starts_with(pattern.substr(0, pattern.size() - 1));
}

}  // namespace

/// The messages on their way to one subscription, and the thread that hands them over.
class MemoryNetwork::Inbox {
 public:
  Inbox(const MemoryBus& owner, std::string pattern, nats::Bus::Handler handler)
      : pattern_(std::move(pattern)),
        owner_(owner),
        handler_(std::move(handler)),
        thread_([this](const std::stop_token& stop) { serve(stop); }) {}

  void put(const MemoryBus* sender, const std::string& subject, const MemoryBus::Bytes& bytes,
           BusClock::time_point due) {
    {
      const std::lock_guard lock(mutex_);
      BusClock::time_point& last = last_of_[sender];
      last = std::max(last, due);
      waiting_.emplace(std::pair{last, ++number_}, std::pair{subject, bytes});
    }
    changed_.notify_all();
  }

  const std::string pattern_;

 private:
  void serve(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (true) {
      if (!changed_.wait(lock, stop, [this] { return !waiting_.empty(); })) return;
      const BusClock::time_point due = waiting_.begin()->first.first;
      if (BusClock::now() < due || owner_.is_stalled_) {
        const auto look = BusClock::now() + kStallLook;
        changed_.wait_until(lock, stop, owner_.is_stalled_ ? look : due, [] { return false; });
        if (stop.stop_requested()) return;
        continue;
      }
      const auto message = std::move(waiting_.extract(waiting_.begin()).mapped());
      lock.unlock();
      if (!owner_.is_cut_) handler_(message.first, message.second);
      lock.lock();
    }
  }

  const MemoryBus& owner_;
  const nats::Bus::Handler handler_;
  std::mutex mutex_;  ///< guards all below but the thread
  std::condition_variable_any changed_;
  std::map<std::pair<BusClock::time_point, std::uint64_t>, std::pair<std::string, MemoryBus::Bytes>>
      waiting_;
  std::map<const MemoryBus*, BusClock::time_point> last_of_;
  std::uint64_t number_ = 0;
  std::jthread thread_;
};

/// Ends a subscription: removes its inbox, whose destructor waits for the handler.
class MemoryBus::Ticket final : public nats::Subscription {
 public:
  Ticket(MemoryNetwork& network, std::shared_ptr<MemoryNetwork::Inbox> inbox)
      : network_(network), inbox_(std::move(inbox)) {}
  ~Ticket() override { network_.remove(inbox_.get()); }
  Ticket(const Ticket&) = delete;
  Ticket& operator=(const Ticket&) = delete;

 private:
  MemoryNetwork& network_;
  std::shared_ptr<MemoryNetwork::Inbox> inbox_;
};

void MemoryNetwork::set_faults(const Faults& faults) {
  const std::lock_guard lock(mutex_);
  faults_ = faults;
}

int MemoryNetwork::sent_on(const std::string& subject) const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(std::ranges::count(sent_, subject));
}

void MemoryNetwork::add(const std::shared_ptr<Inbox>& inbox) {
  const std::lock_guard lock(mutex_);
  inboxes_.push_back(inbox);
}

void MemoryNetwork::remove(const Inbox* inbox) {
  const std::lock_guard lock(mutex_);
  std::erase_if(inboxes_, [inbox](const auto& other) { return other.get() == inbox; });
}

void MemoryNetwork::send(const MemoryBus* sender, const std::string& subject,
                         MemoryBus::Bytes bytes) {
  const std::lock_guard lock(mutex_);
  sent_.push_back(subject);
  for (const auto& inbox : inboxes_) {
    if (!matches(inbox->pattern_, subject) || random_.chance(faults_.lost)) continue;
    const int copies = random_.chance(faults_.doubled) ? 2 : 1;
    for (int copy = 0; copy < copies; ++copy) {
      const auto delay = std::chrono::microseconds(
          random_.integer(0, static_cast<int>(faults_.longest_delay.count())));
      inbox->put(sender, subject, bytes, BusClock::now() + delay);
    }
  }
}

bool MemoryBus::publish(const std::string& subject, std::span<const std::uint8_t> payload) {
  if (payload.size() > most_bytes()) ADD_FAILURE() << payload.size() << " bytes on " << subject;
  if (is_cut_) return false;
  Bytes bytes(payload.begin(), payload.end());
  {
    const std::lock_guard lock(mutex_);
    if (change_) change_(subject, bytes);
    if (is_stalled_) {
      held_.emplace_back(subject, std::move(bytes));
      return true;
    }
  }
  network_.send(this, subject, std::move(bytes));
  return true;
}

std::unique_ptr<nats::Subscription> MemoryBus::subscribe(const std::string& subject,
                                                         Handler handler) {
  auto inbox = std::make_shared<MemoryNetwork::Inbox>(*this, subject, std::move(handler));
  network_.add(inbox);
  return std::make_unique<Ticket>(network_, std::move(inbox));
}

void MemoryBus::stall() {
  const std::lock_guard lock(mutex_);
  is_stalled_ = true;
}

void MemoryBus::go_on() {
  std::vector<std::pair<std::string, Bytes>> held;
  {
    const std::lock_guard lock(mutex_);
    is_stalled_ = false;
    held.swap(held_);
  }
  for (auto& [subject, bytes] : held) network_.send(this, subject, std::move(bytes));
}

void MemoryBus::falsify(std::function<void(const std::string&, Bytes&)> change) {
  const std::lock_guard lock(mutex_);
  change_ = std::move(change);
}

}  // namespace camway::testing
