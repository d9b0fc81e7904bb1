// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace camway::tools {

/// Opens addresses that have a secret in a browser. Other users can read the command lines of
/// processes, so the browser gets a file that only this user can read, which leads to the address.
/// The destructor removes the file.
class Browser {
 public:
  Browser() = default;
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Opens `url` with xdg-open. Returns why that is not possible; empty on success. Requires a URL
  /// that is text in HTML as it stands.
  std::string open(const std::string& url);

 private:
  std::string file_;
};

}  // namespace camway::tools
