// SPDX-License-Identifier: MIT
#include "daemon/fleet/fleet_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/support/random.h"

namespace camway::fleet {
namespace {

using testing::Random;

constexpr std::uint64_t kPartsSeed = 20261126;

/// A bus that keeps what is sent.
class KeepingBus final : public nats::Bus {
 public:
  explicit KeepingBus(std::size_t most) : most_(most) {}
  bool publish(const std::string&, std::span<const std::uint8_t> payload) override {
    sent.emplace_back(payload.begin(), payload.end());
    return true;
  }
  std::unique_ptr<nats::Subscription> subscribe(const std::string&, Handler) override {
    return nullptr;
  }
  [[nodiscard]] bool is_connected() const override { return true; }
  [[nodiscard]] std::size_t most_bytes() const override { return most_; }

  std::vector<Bytes> sent;

 private:
  std::size_t most_;
};

Bytes random_bytes(std::size_t size, Random& random) {
  Bytes bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

fleet_job_t head_of(std::int64_t number) {
  fleet_job_t head{};
  head.front_id = "front";
  head.job = number;
  return head;
}

TEST(FleetParts, WhatIsSplitIsJoinedInAnyOrder) {
  Random random(kPartsSeed);
  for (const std::size_t size : {0U, 1U, 100U, 5000U, 3'000'000U}) {
    for (const std::size_t most : {200U, 4096U, 1U << 20}) {
      if (size / most > 30'000) continue;
      KeepingBus bus(most);
      const Bytes whole = random_bytes(size, random);
      ASSERT_TRUE(publish_parts(bus, "s", head_of(7), whole));
      std::shuffle(bus.sent.begin(), bus.sent.end(), random);
      PartJoiner joiner;
      std::optional<Bytes> joined;
      for (const Bytes& sent : bus.sent) {
        ASSERT_FALSE(joined);
        ASSERT_LE(sent.size(), std::min(most, wire::kMaxFleetBytes));
        base::Result<fleet_job_t> part = read_job(sent);
        ASSERT_TRUE(part) << part.error;
        EXPECT_EQ(part->job, 7);
        joined = joiner.add({"front", 7}, part->part, part->num_parts, part->payload);
      }
      ASSERT_TRUE(joined) << size << " in " << most;
      EXPECT_EQ(*joined, whole);
      EXPECT_EQ(joiner.half_received(), 0U);
      EXPECT_EQ(joiner.bytes(), 0U);
    }
  }
}

TEST(FleetParts, ABusThatTakesTooLittleIsAnError) {
  KeepingBus bus(40);
  EXPECT_FALSE(publish_parts(bus, "s", head_of(7), Bytes(10)));
  KeepingBus small(64);
  EXPECT_FALSE(publish_parts(small, "s", head_of(7), Bytes(std::size_t{1} << 20)))
      << "more parts than a job may have";
  EXPECT_TRUE(small.sent.empty());
}

TEST(FleetParts, PartsOfSeveralJobsComeMixedDoubledAndLost) {
  Random random(kPartsSeed + 1);
  constexpr int kJobs = 40;
  struct Sent {
    std::int64_t job;
    std::int32_t part;
    std::int32_t num_parts;
  };
  std::vector<Sent> all;
  for (std::int64_t job = 0; job < kJobs; ++job) {
    const auto parts = static_cast<std::int32_t>(1 + random() % 6);
    for (std::int32_t part = 0; part < parts; ++part) {
      for (int copy = random.integer(1, 3); copy > 0; --copy) all.push_back({job, part, parts});
    }
  }
  std::shuffle(all.begin(), all.end(), random);
  const std::int64_t lost_job = all.front().job;
  const std::int32_t lost_part = all.front().part;
  PartJoiner joiner;
  std::map<std::int64_t, int> joined;
  for (const Sent& sent : all) {
    if (sent.job == lost_job && sent.part == lost_part) continue;
    const Bytes bytes{static_cast<std::uint8_t>(sent.job), static_cast<std::uint8_t>(sent.part)};
    const auto whole = joiner.add({"f", sent.job}, sent.part, sent.num_parts, bytes);
    if (!whole) continue;
    ++joined[sent.job];
    ASSERT_EQ(whole->size(), 2U * static_cast<std::size_t>(sent.num_parts));
    for (std::int32_t part = 0; part < sent.num_parts; ++part) {
      ASSERT_EQ((*whole)[2 * static_cast<std::size_t>(part)], sent.job);
      ASSERT_EQ((*whole)[2 * static_cast<std::size_t>(part) + 1], part);
    }
  }
  EXPECT_FALSE(joined.contains(lost_job));
  EXPECT_GE(joined.size(), static_cast<std::size_t>(kJobs - 1));
}

TEST(FleetParts, KeepsSendersApart) {
  PartJoiner joiner;
  EXPECT_FALSE(joiner.add({"a", 1}, 0, 2, {1}));
  EXPECT_FALSE(joiner.add({"b", 1}, 1, 2, {2}));
  EXPECT_EQ(joiner.add({"a", 1}, 1, 2, {3}), (Bytes{1, 3}));
  EXPECT_EQ(joiner.add({"b", 1}, 0, 2, {4}), (Bytes{4, 2}));
}

TEST(FleetParts, RefusesAnotherNumberOfParts) {
  PartJoiner joiner;
  EXPECT_FALSE(joiner.add({"a", 1}, 0, 2, {1}));
  EXPECT_FALSE(joiner.add({"a", 1}, 1, 3, {2}));
  EXPECT_FALSE(joiner.add({"a", 1}, 0, 1, {2}));
  EXPECT_EQ(joiner.add({"a", 1}, 1, 2, {3}), (Bytes{1, 3}));
  EXPECT_FALSE(joiner.add({"a", 1}, 0, 3, {1})) << "it begins anew";
  joiner.forget({"a", 1});
  EXPECT_EQ(joiner.half_received(), 0U);
}

TEST(FleetParts, HoldsNoMoreThanItsLimits) {
  Random random(kPartsSeed + 2);
  const PartJoiner::Limits limits{10'000, 20};
  PartJoiner joiner(limits);
  for (int i = 0; i < 20'000; ++i) {
    joiner.add({"f", random.integer(0, 200)}, random.integer(0, 999), 1000,
               Bytes(static_cast<std::size_t>(random.integer(0, 300))));
    ASSERT_LE(joiner.bytes(), limits.max_bytes);
    ASSERT_LE(joiner.half_received(), limits.max_payloads);
  }
  PartJoiner other(limits);
  EXPECT_FALSE(other.add({"f", 1}, 0, 2, Bytes(20'000)));
  EXPECT_EQ(other.half_received(), 0U) << "one that is too large goes at once";
  for (std::int64_t job = 0; job < 20; ++job) other.add({"f", job}, 0, 2, Bytes(100));
  other.add({"f", 0}, 0, 2, Bytes(100));  // it waits for a part again
  other.add({"f", 99}, 0, 2, Bytes(100));
  EXPECT_TRUE(other.add({"f", 0}, 1, 2, {})) << "the one that waited longest was dropped";
  EXPECT_FALSE(other.add({"f", 1}, 1, 2, {}));
}

}  // namespace
}  // namespace camway::fleet
