// SPDX-License-Identifier: MIT
#include "daemon/service/scenes/uploads.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <random>

#include "lcmtypes/wire/checksum.h"
#include "lcmtypes/wire/layout.h"
#include "tests/support/random.h"

namespace camway::service {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kPage = wire::kUploadPageBytes;

Bytes some_bytes(std::size_t size, unsigned seed) {
  testing::Random random(seed);
  Bytes bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

/// Returns page `number` of `whole`; the page without bytes for a negative number.
upload_page_t page_of(const Bytes& whole, int number, const std::string& client = "tester") {
  upload_page_t page{};
  page.client_id = client;
  page.request_id = 7;
  page.total_bytes = static_cast<std::int64_t>(whole.size());
  page.checksum = wire::crc64(whole.data(), whole.size());
  if (number < 0) return page;
  const std::size_t begin = static_cast<std::size_t>(number) * kPage;
  const std::size_t size = std::min(kPage, whole.size() - begin);
  page.page = number;
  page.bytes.assign(whole.begin() + static_cast<std::ptrdiff_t>(begin),
                    whole.begin() + static_cast<std::ptrdiff_t>(begin + size));
  page.num_bytes = static_cast<std::int32_t>(size);
  page.page_checksum = wire::crc64(page.bytes.data(), size);
  return page;
}

UploadKey key_of(const Bytes& whole, const std::string& client = "tester") {
  const upload_page_t page = page_of(whole, -1, client);
  return {client, page.total_bytes, page.checksum};
}

const Uploads::Clock::time_point kNow{};

TEST(Checksum, IsThatOfTheStandard) {
  const std::string text = "123456789";
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  EXPECT_EQ(static_cast<std::uint64_t>(wire::crc64(bytes, 9)), 0x995DC9BBDF1939FAU);
  EXPECT_EQ(wire::crc64(bytes + 4, 5, wire::crc64(bytes, 4)), wire::crc64(bytes, 9));
  EXPECT_EQ(wire::crc64(bytes, 0), 0);
}

TEST(Checksum, JoinsThoseOfTwoParts) {
  testing::Random random(31);
  for (int round = 0; round < 200; ++round) {
    const Bytes whole = some_bytes(1 + random() % 3000, static_cast<unsigned>(random()));
    const std::size_t cut = random() % (whole.size() + 1);
    const std::size_t rest = whole.size() - cut;
    const std::int64_t joined = wire::Crc64Joint(rest)(wire::crc64(whole.data(), cut),
                                                       wire::crc64(whole.data() + cut, rest));
    ASSERT_EQ(joined, wire::crc64(whole.data(), whole.size())) << cut << " of " << whole.size();
  }
}

TEST(Uploads, ABeginningTakesNoMemoryForWhatHasNotCome) {
  const auto resident_pages = [] {
    std::ifstream statm("/proc/self/statm");
    std::size_t total = 0;
    std::size_t resident = 0;
    statm >> total >> resident;
    return resident;
  };
  Uploads::Limits limits;
  limits.bytes = limits.total_bytes = std::size_t{1} << 30;
  Uploads uploads(limits);
  upload_page_t question = page_of(some_bytes(kPage, 3), -1);
  question.total_bytes = static_cast<std::int64_t>(limits.bytes);
  const std::size_t before = resident_pages();
  EXPECT_EQ(uploads.take(question, kNow).status.status, upload_status_t::STATUS_OK);
  EXPECT_EQ(uploads.bytes(), limits.bytes);
  EXPECT_LT(resident_pages() - before, 10'000U) << "of 4 KiB, out of 262,144";
}

TEST(Uploads, PutsPagesTogetherInAnyOrder) {
  const Bytes whole = some_bytes(10 * kPage + 17, 1);
  std::vector<int> order;
  for (int i = 0; i < 11; ++i) order.insert(order.end(), {i, i});  // each comes twice
  testing::Random random(2);
  std::shuffle(order.begin(), order.end(), random);
  Uploads uploads({});
  std::size_t answers = 0;
  for (const int number : order) {
    EXPECT_EQ(uploads.find(key_of(whole)) != nullptr, answers > 0);
    const Uploads::Taken taken = uploads.take(page_of(whole, number), kNow);
    EXPECT_EQ(taken.status.status, upload_status_t::STATUS_OK) << taken.status.message;
    if (!taken.answer) continue;
    ++answers;
    EXPECT_EQ(taken.status.total_missing, 0) << "only the last page is answered";
  }
  EXPECT_EQ(answers, 1U);
  const UploadedBytes found = uploads.find(key_of(whole));
  EXPECT_TRUE(std::equal(whole.begin(), whole.end(), found->data(), found->data() + found->size()));
  EXPECT_EQ(uploads.find(key_of(whole, "other")), nullptr);
}

TEST(Uploads, SaysWhatIsMissing) {
  const Bytes whole = some_bytes(5 * kPage, 3);
  Uploads uploads({});
  static_cast<void>(uploads.take(page_of(whole, 1), kNow));
  static_cast<void>(uploads.take(page_of(whole, 4), kNow));
  const Uploads::Taken taken = uploads.take(page_of(whole, -1), kNow);
  EXPECT_TRUE(taken.answer);
  EXPECT_EQ(taken.status.request_id, 7);
  EXPECT_EQ(taken.status.total_missing, 3);
  EXPECT_EQ(taken.status.missing, (std::vector<std::int32_t>{0, 2, 3}));
  Uploads::Limits limits;
  limits.bytes = limits.total_bytes = std::size_t{1} << 30;
  upload_page_t question = page_of(whole, -1);
  question.total_bytes = static_cast<std::int64_t>((wire::kMaxMissingPages + 10) * kPage);
  const upload_status_t status = Uploads(limits).take(question, kNow).status;
  EXPECT_EQ(status.missing.size(), wire::kMaxMissingPages);
  EXPECT_EQ(status.num_missing, static_cast<std::int32_t>(wire::kMaxMissingPages));
  EXPECT_EQ(status.total_missing, static_cast<std::int32_t>(wire::kMaxMissingPages + 10));
}

TEST(Uploads, RefusesPagesThatAreWrong) {
  const Bytes whole = some_bytes(2 * kPage + 5, 5);
  Uploads uploads({});
  const auto refusal = [&](const upload_page_t& page) {
    const Uploads::Taken taken = uploads.take(page, kNow);
    EXPECT_TRUE(taken.answer);
    EXPECT_EQ(taken.status.status, upload_status_t::STATUS_INVALID);
    return taken.status.message;
  };
  upload_page_t page = page_of(whole, 1);
  page.bytes[3] ^= 1;
  EXPECT_THAT(refusal(page), HasSubstr("page_checksum"));
  page = page_of(whole, 2);
  page.page = 1;
  EXPECT_THAT(refusal(page), HasSubstr("num_bytes"));
  for (const std::int32_t number : {-1, 3, std::numeric_limits<std::int32_t>::max()}) {
    page = page_of(whole, 1);
    page.page = number;
    EXPECT_THAT(refusal(page), HasSubstr("page:"));
  }
  for (const std::int64_t size : {std::int64_t{0}, std::int64_t{-1}}) {
    page = page_of(whole, -1);
    page.total_bytes = size;
    EXPECT_THAT(refusal(page), HasSubstr("total_bytes"));
  }
  EXPECT_EQ(uploads.bytes(), 0U) << "what is refused takes no room";
  page = page_of(whole, 1);
  page.total_bytes = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(uploads.take(page, kNow).status.status, upload_status_t::STATUS_LIMIT);
}

TEST(Uploads, StartsAnewWhenTheWholeIsNotWhatWasSaid) {
  const Bytes whole = some_bytes(kPage + 1, 6);
  Uploads uploads({});
  const auto with_wrong_sum = [&](int number) {
    upload_page_t page = page_of(whole, number);
    page.checksum ^= 1;
    return page;
  };
  static_cast<void>(uploads.take(with_wrong_sum(0), kNow));
  const Uploads::Taken taken = uploads.take(with_wrong_sum(1), kNow);
  EXPECT_TRUE(taken.answer);
  EXPECT_THAT(taken.status.message, HasSubstr("checksum"));
  EXPECT_EQ(uploads.bytes(), 0U);
}

TEST(Uploads, KeepsWithinItsLimits) {
  Uploads::Limits limits;
  limits.uploads = 3;
  limits.bytes = 1000;
  limits.total_bytes = 2000;
  limits.idle = seconds(10);
  Uploads uploads(limits);
  const auto take = [&](const Bytes& whole, int at_s) {
    return uploads.take(page_of(whole, 0), kNow + seconds(at_s)).status;
  };
  const Bytes large = some_bytes(1001, 7);
  EXPECT_EQ(take(large, 0).status, upload_status_t::STATUS_LIMIT);
  EXPECT_THAT(take(large, 0).message, HasSubstr("1000"));
  const Bytes first = some_bytes(900, 8);
  const Bytes second = some_bytes(900, 9);
  const Bytes third = some_bytes(900, 10);
  static_cast<void>(take(first, 0));
  static_cast<void>(take(second, 1));
  static_cast<void>(take(first, 2));
  static_cast<void>(take(third, 3));
  EXPECT_LE(uploads.bytes(), limits.total_bytes);
  EXPECT_TRUE(uploads.find(key_of(first)));
  EXPECT_FALSE(uploads.find(key_of(second))) << "not touched for the longest";
  for (unsigned i = 0; i < 10; ++i) static_cast<void>(take(some_bytes(1 + i, 20 + i), 4));
  EXPECT_LE(uploads.bytes(), 3U * 10);
  static_cast<void>(take(some_bytes(5, 40), 100));
  EXPECT_EQ(uploads.bytes(), 5U) << "the idle ones are forgotten";
}

TEST(Uploads, WhoBeginsManyDrivesNobodyOut) {
  const Bytes whole = some_bytes(20 * kPage + 3, 11);
  Uploads::Limits limits;
  limits.bytes /= 16;  // a sanitizer marks every byte of a room
  limits.total_bytes /= 16;
  Uploads uploads(limits);
  upload_page_t question = page_of(whole, -1, "hostile");
  auto now = kNow;
  for (int number = 0; number <= 20; ++number) {
    static_cast<void>(uploads.take(page_of(whole, number), now += milliseconds(1)));
    for (int i = 0; i < 500; ++i) {  // 10,000 in all, each the largest that may be
      question.total_bytes = static_cast<std::int64_t>(limits.bytes);
      question.checksum = 1000 * number + i;
      static_cast<void>(uploads.take(question, now += milliseconds(1)));
      question.total_bytes = 1;
      static_cast<void>(uploads.take(question, now += milliseconds(1)));
    }
    ASSERT_LE(uploads.bytes(), limits.total_bytes);
  }
  EXPECT_TRUE(uploads.find(key_of(whole)));
}

TEST(Uploads, WhatIsReadCountsThoughItIsForgotten) {
  Uploads::Limits limits;
  limits.bytes = 1000;
  limits.total_bytes = 2500;
  Uploads uploads(limits);
  const Bytes first = some_bytes(900, 12);
  const Bytes second = some_bytes(900, 13);
  const Bytes third = some_bytes(900, 14);
  auto now = kNow;
  const auto take = [&](const Bytes& whole) {
    return uploads.take(page_of(whole, 0), now += seconds(1)).status.status;
  };
  static_cast<void>(take(first));
  UploadedBytes first_change = uploads.find(key_of(first));
  static_cast<void>(take(second));
  UploadedBytes second_change = uploads.find(key_of(second));
  // Dropping an upload that is being read frees no memory.
  EXPECT_EQ(take(third), upload_status_t::STATUS_LIMIT);
  EXPECT_THAT(uploads.take(page_of(third, 0), now).status.message, HasSubstr("all_uploads_bytes"));
  EXPECT_EQ(uploads.find(key_of(second)), second_change) << "nor is it";
  // By number it may be dropped, but it still counts.
  for (unsigned i = 0; i < 20; ++i) static_cast<void>(take(some_bytes(1 + i, 20 + i)));
  EXPECT_FALSE(uploads.find(key_of(first)));
  EXPECT_EQ(take(third), upload_status_t::STATUS_LIMIT);
  first_change.reset();
  second_change.reset();
  EXPECT_EQ(take(third), upload_status_t::STATUS_OK);
  EXPECT_TRUE(uploads.find(key_of(third)));
}

}  // namespace
}  // namespace camway::service
