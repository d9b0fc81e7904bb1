// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <mutex>
#include <ostream>
#include <streambuf>
#include <string>

#include "daemon/service/log/log.h"

namespace camway::testing {

/// A log whose lines ("info reload: done") a test can read while other threads write. Thread-safe.
class CapturedLog {
 public:
  explicit CapturedLog(service::LogLevel level = service::LogLevel::kInfo)
      : log_(std::make_shared<service::Log>(out_, service::LogFormat::kText, level)) {}

  [[nodiscard]] const std::shared_ptr<service::Log>& log() const { return log_; }

  /// Returns all lines without their times.
  [[nodiscard]] std::string text() const {
    std::string text = buffer_.text();
    static constexpr std::string_view kName = "[camwayd] [";
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t name = text.find(kName, begin);
      if (name == std::string::npos) break;
      const std::size_t end = text.find(']', name + kName.size());
      const std::string level = text.substr(name + kName.size(), end - name - kName.size());
      text.replace(begin, end + 1 - begin, level);
      begin = text.find('\n', begin);
      if (begin != std::string::npos) ++begin;
    }
    return text;
  }
  void clear() { buffer_.clear(); }

 private:
  class Buffer final : public std::streambuf {
   public:
    [[nodiscard]] std::string text() const {
      const std::lock_guard lock(mutex_);
      return text_;
    }
    void clear() {
      const std::lock_guard lock(mutex_);
      text_.clear();
    }

   private:
    int_type overflow(int_type c) override {
      const std::lock_guard lock(mutex_);
      if (!traits_type::eq_int_type(c, traits_type::eof())) text_ += traits_type::to_char_type(c);
      return traits_type::not_eof(c);
    }
    std::streamsize xsputn(const char* data, std::streamsize size) override {
      const std::lock_guard lock(mutex_);
      text_.append(data, static_cast<std::size_t>(size));
      return size;
    }

    mutable std::mutex mutex_;  ///< guards text_
    std::string text_;
  };

  Buffer buffer_;
  std::ostream out_{&buffer_};
  std::shared_ptr<service::Log> log_;
};

}  // namespace camway::testing
