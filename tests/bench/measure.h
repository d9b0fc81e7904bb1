// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

/// How every benchmark times, summarises and reports.
namespace camway::bench {

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Seconds of one call, by the wall: for what uses several threads.
template <class Work>
double timed_s(const Work& work) {
  const Stopwatch watch;
  work();
  return watch.seconds();
}

/// Processor time of the calling thread, seconds. On a busy machine a run of milliseconds is put
/// aside for others again and again, one of microseconds is not: wall-clock time would flatter
/// whoever is fast.
double thread_seconds();

/// What takes less than this is run once untimed before, every time, so that nobody pays for the
/// caches that the contender before has filled; what takes longer warms itself.
inline constexpr double kWarmsItself_s = 5e-3;

/// Thread time of one call: the least of three in a row, after one untimed.
template <class Work>
double warm_s(const Work& work) {
  const auto once_s = [&] {
    const double begin_s = thread_seconds();
    work();
    return thread_seconds() - begin_s;
  };
  double best_s = once_s();
  if (best_s >= kWarmsItself_s) return best_s;
  best_s = once_s();
  for (int i = 0; i < 2; ++i) best_s = std::min(best_s, once_s());
  return best_s;
}

/// The value with `share` of the others below it; 0 for none. [Limit: 0 <= share <= 1]
double quantile(std::vector<double> values, double share);
inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

/// A table for the screen; Markdown, so that it can be pasted as it is.
class Table {
 public:
  explicit Table(std::vector<std::string> head) : head_(std::move(head)) {}

  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  void print() const;

 private:
  std::vector<std::string> head_;
  std::vector<std::vector<std::string>> rows_;
};

/// Three significant digits and a unit: "18.2 µs", "2.51 ms", "1.2 s"; "-" for a value below zero.
std::string duration_text(double seconds);
/// "31.4×"; "-" for what is not finite.
std::string ratio_text(double ratio);

/// Writes `document` to `file`; nothing if `file` is empty. Returns an error text, empty on
/// success.
std::string write_json(const std::string& file, const nlohmann::json& document);

/// What a result depends on beside the code: processor, threads, compiler, build type.
nlohmann::json machine();

}  // namespace camway::bench
