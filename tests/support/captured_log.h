// SPDX-License-Identifier: MIT
#pragma once

#include <spdlog/logger.h>
#include <spdlog/sinks/ostream_sink.h>

#include <memory>
#include <sstream>
#include <string>

namespace camway::testing {

/// A logger whose lines ("info reload: done") a test can read, from one thread at a time.
class CapturedLog {
 public:
  CapturedLog()
      : sink_(std::make_shared<spdlog::sinks::ostream_sink_mt>(text_)),
        logger_(std::make_shared<spdlog::logger>("test", sink_)) {
    logger_->set_pattern("%l %v");
  }

  [[nodiscard]] const std::shared_ptr<spdlog::logger>& logger() const { return logger_; }
  /// Not while another thread may log.
  [[nodiscard]] std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::shared_ptr<spdlog::sinks::ostream_sink_mt> sink_;
  std::shared_ptr<spdlog::logger> logger_;
};

}  // namespace camway::testing
