// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace camway::view {

/// A file of the page, as it is and compressed by gzip. Both are empty if there is none.
struct PageFile {
  std::string text;
  std::string_view gzip;
};

/// The page that a browser shows. Views are of data of the program, which outlives all who use it.
struct PageFiles {
  PageFile html;
  PageFile script;
  PageFile style;
  /// Policy of a file that holds script and style (`make_review`): no network, and nothing else to
  /// run.
  std::string_view inline_policy;
  /// Script of a report that holds reviews (`ReviewShelf`), and the policy of such a report:
  /// scripts as above and this one, any style.
  std::string_view report_script = {};
  std::string_view report_policy = {};
};

}  // namespace camway::view
