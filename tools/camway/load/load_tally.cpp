// SPDX-License-Identifier: MIT
#include "tools/camway/load/load_tally.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

namespace camway::tools {
namespace {

bool same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

template <class Expected, class Got>
bool same_numbers(const Expected& expected, const Got& got) {
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    if (!same(expected[i], got[static_cast<std::size_t>(i)])) return false;
  }
  return true;
}

bool same_segment(const motion::Segment& expected, const Segment& got) {
  if (!same(expected.t0_s, got.t0_s) || !same(expected.t1_s, got.t1_s)) return false;
  for (std::size_t i = 0; i < expected.position.size(); ++i) {
    if (!same_numbers(expected.position[i], got.position_m[i])) return false;
  }
  for (std::size_t i = 0; i < expected.orientation.size(); ++i) {
    if (!same_numbers(expected.orientation[i], got.orientation_wxyz[i])) return false;
  }
  return true;
}

bool same_interval(const collision::CollisionInterval& expected, const CollisionInterval& got) {
  return same(expected.t_begin_s, got.t_begin_s) && same(expected.t_end_s, got.t_end_s);
}

bool same_keyframe(const motion::Keyframe& expected, const PathKeyframe& got) {
  return same(expected.time_s, got.time_s) &&
         same_numbers(expected.pose.position, got.position_m) &&
         (expected.origin == motion::KeyframeOrigin::kInserted) == got.inserted;
}

double median_mb(std::vector<MemorySample>::const_iterator begin,
                 std::vector<MemorySample>::const_iterator end) {
  std::vector<double> values;
  for (; begin != end; ++begin) values.push_back(begin->resident_mb);
  std::ranges::sort(values);
  return values[values.size() / 2];
}

}  // namespace

bool is_expected(const planning::PlanResult& expected, const PlanResponse& answer) {
  return to_string(expected.status) == to_string(answer.status) &&
         std::ranges::equal(expected.path.segments(), answer.path.segments(), same_segment) &&
         std::ranges::equal(expected.keyframes, answer.keyframes, same_keyframe) &&
         std::ranges::equal(expected.collisions, answer.collisions, same_interval) &&
         std::ranges::equal(expected.remaining_collisions, answer.remaining, same_interval) &&
         expected.certificate.certified == answer.certified &&
         same(expected.certificate.clearance_lower_bound_m, answer.clearance_lower_bound_m);
}

void LoadTally::add(const LoadRequest& sent, const PlanResponse& answer) {
  ++asked;
  ++by_status[to_string(answer.status)];
  retries += std::max(0, answer.tries - 1);
  if (answer.status == Status::kInvalid) invalid.emplace(sent.name, answer.error);
  const auto complain = [&](const std::string& what) {
    if (complaints.size() < kMostComplaints) {
      complaints.push_back(fmt::format("{}, request {}: {}", sent.name, answer.request_id, what));
    }
  };
  const bool from_daemon = static_cast<int>(answer.status) < 100;
  if (!from_daemon) {
    ++lost;
    complain(answer.error);
  } else if (is_expected(sent.expected, answer)) {
    ++answered;
    const double elapsed_ms = 1e3 * answer.elapsed_s;
    latency_ms.push_back(static_cast<float>(elapsed_ms));
    overhead_ms.push_back(static_cast<float>(elapsed_ms - answer.timing.total_ms));
  } else if (answer.status == Status::kOverloaded || answer.status == Status::kTimeout ||
             answer.deadline_reached) {
    ++refused;
  } else {
    ++wrong;
    complain(fmt::format("the daemon's answer ({}) is not what planning here gives ({})",
                         to_string(answer.status), to_string(sent.expected.status)));
  }
}

void LoadTally::add(const LoadTally& other) {
  asked += other.asked;
  answered += other.answered;
  refused += other.refused;
  wrong += other.wrong;
  lost += other.lost;
  retries += other.retries;
  for (const auto& [status, count] : other.by_status) by_status[status] += count;
  invalid.insert(other.invalid.begin(), other.invalid.end());
  latency_ms.insert(latency_ms.end(), other.latency_ms.begin(), other.latency_ms.end());
  overhead_ms.insert(overhead_ms.end(), other.overhead_ms.begin(), other.overhead_ms.end());
  for (const std::string& complaint : other.complaints) {
    if (complaints.size() < kMostComplaints) complaints.push_back(complaint);
  }
}

double resident_mb(int pid) {
  std::ifstream statm("/proc/" + std::to_string(pid) + "/statm");
  double total_pages = 0.0;
  double resident_pages = 0.0;
  statm >> total_pages >> resident_pages;
  return statm ? 1e-6 * resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) : 0.0;
}

double memory_growth(const std::vector<MemorySample>& samples, double warm_up_s) {
  const auto first = std::ranges::find_if(
      samples, [&](const MemorySample& sample) { return sample.time_s >= warm_up_s; });
  const std::ptrdiff_t tenth = (samples.end() - first) / 10;
  if (tenth < 1) return 0.0;
  return median_mb(samples.end() - tenth, samples.end()) / median_mb(first, first + tenth) - 1.0;
}

Percentiles percentiles(std::vector<float> values) {
  if (values.empty()) return {};
  std::ranges::sort(values);
  const auto at = [&](double share) {
    const double rank = std::ceil(share * static_cast<double>(values.size()));
    return static_cast<double>(values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1]);
  };
  return {at(0.5), at(0.99), at(0.999), static_cast<double>(values.back())};
}

}  // namespace camway::tools
