// SPDX-License-Identifier: MIT
#include "daemon/service/queue/known_clients.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <string>

#include "tests/support/random.h"

namespace camway::service {
namespace {

constexpr std::uint64_t kClientsSeed = 20061112;

std::string id_of(const char* kind, int number) { return kind + std::to_string(number); }

TEST(KnownClients, AFloodOfIdsForgetsOnlyThoseThatCameOnce) {
  KnownClients known(8);
  for (int i = 0; i < 4; ++i) {
    for (const char* const kind : {"regular", "once"}) known.note_served(id_of(kind, i));
    known.note_served(id_of("regular", i));
  }
  for (int i = 0; i < 10'000; ++i) {
    known.note_served(id_of("invented", i));
    ASSERT_LE(known.size(), 8U);
  }
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(known.contains(id_of("regular", i)));
    EXPECT_FALSE(known.contains(id_of("once", i)));
    EXPECT_TRUE(known.contains(id_of("invented", 9'999 - i)));
  }
}

/// Compares with two lists that are searched linearly.
TEST(KnownClients, AgreesWithTheRuleWrittenOut) {
  testing::Random random(kClientsSeed);
  constexpr std::size_t kHalf = 5;
  KnownClients known(2 * kHalf);
  std::deque<std::string> once;  // the newest first
  std::deque<std::string> again;
  for (int step = 0; step < 20'000; ++step) {
    const std::string id = id_of("client", static_cast<int>(random() % 25));
    known.note_served(id);
    const bool was_known = std::ranges::count(once, id) + std::ranges::count(again, id) > 0;
    std::erase(once, id);
    std::erase(again, id);
    (was_known ? again : once).push_front(id);
    if (again.size() > kHalf) {
      once.push_front(again.back());
      again.pop_back();
    }
    if (once.size() > kHalf) once.pop_back();
    ASSERT_EQ(known.size(), once.size() + again.size());
    for (int i = 0; i < 25; ++i) {
      const std::string other = id_of("client", i);
      ASSERT_EQ(known.contains(other),
                std::ranges::count(once, other) + std::ranges::count(again, other) > 0)
          << "step " << step;
    }
  }
}

}  // namespace
}  // namespace camway::service
