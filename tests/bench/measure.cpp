// SPDX-License-Identifier: MIT
#include "tests/bench/measure.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <thread>

namespace camway::bench {

namespace {

// Returns the width in characters, not bytes: "µs" and "×" have more bytes in UTF-8.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U;
  }));
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const std::size_t low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
}

void Table::print() const {
  std::vector<std::size_t> widths;
  for (const std::string& cell : head_) widths.push_back(width(cell));
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  }
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text = "|";
    for (std::size_t i = 0; i < cells.size(); ++i) {
      text += " " + cells[i] + std::string(widths[i] - width(cells[i]), ' ') + " |";
    }
    std::puts(text.c_str());
  };
  line(head_);
  std::vector<std::string> rule;
  for (const std::size_t columns : widths) rule.emplace_back(columns, '-');
  line(rule);
  for (const auto& row : rows_) line(row);
  std::fflush(stdout);
}

std::string duration_text(double seconds) {
  if (!(seconds >= 0.0)) return "-";
  if (seconds < 1e-3) return fmt::format("{:.3g} µs", 1e6 * seconds);
  if (seconds < 1.0) return fmt::format("{:.3g} ms", 1e3 * seconds);
  return fmt::format("{:.3g} s", seconds);
}

std::string ratio_text(double ratio) {
  if (!std::isfinite(ratio)) return "-";
  return ratio < 100.0 ? fmt::format("{:.3g}×", ratio) : fmt::format("{:.0f}×", ratio);
}

std::string write_json(const std::string& file, const nlohmann::json& document) {
  if (file.empty()) return {};
  std::ofstream out(file);
  out << document.dump(1) << '\n';
  out.flush();
  return out ? std::string() : "cannot write " + file;
}

nlohmann::json machine() {
#ifdef NDEBUG
  constexpr bool kAsserts = false;
#else
  constexpr bool kAsserts = true;
#endif
  return {{"processor", processor()},
          {"hardware_threads", std::thread::hardware_concurrency()},
          {"compiler", __VERSION__},
          {"asserts", kAsserts}};
}

}  // namespace camway::bench
