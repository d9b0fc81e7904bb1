// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

/// Timing, statistics and reports of all benchmarks.
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

/// Returns the wall-clock time of one call, for work on several threads. [Units: seconds]
template <class Work>
double timed_s(const Work& work) {
  const Stopwatch watch;
  work();
  return watch.seconds();
}

/// Returns the processor time of the calling thread. On a busy machine the scheduler interrupts a
/// run of milliseconds often and one of microseconds rarely, so wall-clock time would favour the
/// faster contender. [Units: seconds]
double thread_seconds();

/// Work shorter than this runs once untimed first, so that its time does not depend on the caches
/// that the contender before has filled. Longer work warms the caches itself.
inline constexpr double kWarmsItself_s = 5e-3;

/// Returns the thread time of one call: the least of three in a row, after an untimed one. Work of
/// `kWarmsItself_s` or longer runs once only. [Units: seconds]
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

/// Returns the value below which the fraction `share` of the values lies; 0 for no values.
/// [Limit: 0 <= share <= 1]
double quantile(std::vector<double> values, double share);
inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

/// A table in Markdown for the screen.
class Table {
 public:
  explicit Table(std::vector<std::string> head) : head_(std::move(head)) {}

  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  void print() const;

 private:
  std::vector<std::string> head_;
  std::vector<std::vector<std::string>> rows_;
};

/// Returns a duration with three significant digits and a unit: "18.2 µs", "2.51 ms", "1.2 s"; "-"
/// for a value below zero.
std::string duration_text(double seconds);
/// Returns a ratio, such as "31.4×"; "-" for a value that is not finite.
std::string ratio_text(double ratio);

/// Writes `document` to `file`; does nothing if `file` is empty. Returns an error text, empty on
/// success.
std::string write_json(const std::string& file, const nlohmann::json& document);

/// Returns the conditions of a result: processor, threads, compiler, build type.
nlohmann::json machine();

}  // namespace camway::bench
