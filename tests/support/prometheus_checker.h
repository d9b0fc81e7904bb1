// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace camway::testing {

/// A reader of Prometheus' text format (exposition_formats.md, version 0.0.4), without time stamps,
/// which the daemon does not write.
class PrometheusChecker {
 public:
  explicit PrometheusChecker(const std::string& text) {
    if (text.empty() || text.back() != '\n') fault("does not end with a line feed");
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) take(line);
    for (const auto& [name, type] : types_) {
      if (type == "histogram") check_histogram(name);
      if (families_with_samples_.count(name) == 0) fault(name + " has no samples");
    }
  }

  /// Returns the faults of the text; empty if there are none.
  [[nodiscard]] const std::string& faults() const { return faults_; }
  /// Returns the value of a sample with name and labels as written: `a_total{kind="plan"}`.
  [[nodiscard]] std::optional<double> value(const std::string& sample) const {
    const auto found = samples_.find(sample);
    return found == samples_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  void fault(const std::string& what) { faults_ += what + "\n"; }

  void take(const std::string& line) {
    static const std::regex kHelp("# HELP ([a-zA-Z_:][a-zA-Z0-9_:]*) .+");
    static const std::regex kType("# TYPE ([a-zA-Z_:][a-zA-Z0-9_:]*) (counter|gauge|histogram)");
    static const std::regex kSample(
        "(([a-zA-Z_:][a-zA-Z0-9_:]*)(\\{[a-zA-Z_][a-zA-Z0-9_]*=\"([^\"\\\\]|\\\\[\\\\n\"])*\""
        "(,[a-zA-Z_][a-zA-Z0-9_]*=\"([^\"\\\\]|\\\\[\\\\n\"])*\")*\\})?) (\\S+)");
    std::smatch match;
    if (std::regex_match(line, match, kHelp)) {
      if (!helps_.insert(match[1]).second) fault("a second HELP: " + line);
    } else if (std::regex_match(line, match, kType)) {
      if (!types_.emplace(match[1], match[2]).second) fault("a second TYPE: " + line);
      if (helps_.count(match[1]) == 0) fault("no HELP before: " + line);
      family_ = match[1];
    } else if (std::regex_match(line, match, kSample)) {
      take_sample(match[1], match[2], match[7], line);
    } else {
      fault("cannot be read: " + line);
    }
  }

  void take_sample(const std::string& sample, const std::string& name, const std::string& number,
                   const std::string& line) {
    const std::string& type = types_[family_];
    const bool belongs =
        type == "histogram"
            ? name == family_ + "_bucket" || name == family_ + "_sum" || name == family_ + "_count"
            : name == family_;
    if (!belongs) fault("not below its own TYPE: " + line);
    if (type == "counter" && !std::regex_search(name, std::regex("_total$"))) {
      fault("a counter without _total: " + line);
    }
    std::size_t used = 0;
    double value = std::nan("");
    try {
      value = std::stod(number, &used);
    } catch (const std::exception&) {
    }
    if (used != number.size() || std::isnan(value)) fault("no number: " + line);
    if (type != "gauge" && value < 0.0) fault("negative: " + line);
    if (!samples_.emplace(sample, value).second) fault("twice: " + line);
    families_with_samples_.insert(family_);
    if (name == family_ + "_bucket") buckets_[family_].push_back(sample);
  }

  void check_histogram(const std::string& name) {
    double bound = -1.0;
    double below = 0.0;
    static const std::regex kBound("\\{le=\"([^\"]+)\"\\}$");
    for (const std::string& bucket : buckets_[name]) {
      std::smatch match;
      if (!std::regex_search(bucket, match, kBound)) {
        fault("no bound: " + bucket);
        continue;
      }
      const double next =
          match[1] == "+Inf" ? std::numeric_limits<double>::infinity() : std::stod(match[1]);
      if (!(next > bound)) fault("bounds do not rise: " + bucket);
      if (samples_[bucket] < below) fault("buckets fall: " + bucket);
      bound = next;
      below = samples_[bucket];
    }
    if (!std::isinf(bound)) fault(name + " has no bucket +Inf");
    if (value(name + "_count") != below) fault(name + ": count and bucket +Inf differ");
    if (!value(name + "_sum")) fault(name + " has no sum");
  }

  std::string faults_;
  std::string family_;  ///< metric family of the last TYPE line
  std::map<std::string, std::string> types_;
  std::set<std::string> helps_;
  std::set<std::string> families_with_samples_;
  std::map<std::string, double> samples_;
  std::map<std::string, std::vector<std::string>> buckets_;
};

}  // namespace camway::testing
