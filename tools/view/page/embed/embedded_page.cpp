// SPDX-License-Identifier: MIT
#include "tools/view/page/embed/embedded_page.h"

#include <cassert>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/gzip/inflate.h"

/// Declares the begin and the end of a file in embedded_files.S.
#define CAMWAY_EMBEDDED(name)                    \
  extern "C" const char camway_##name##_begin[]; \
  extern "C" const char camway_##name##_end[]

CAMWAY_EMBEDDED(page_html_gzip);
CAMWAY_EMBEDDED(page_script_gzip);
CAMWAY_EMBEDDED(page_style_gzip);
CAMWAY_EMBEDDED(page_policy);
CAMWAY_EMBEDDED(report_script);
CAMWAY_EMBEDDED(report_policy);

#undef CAMWAY_EMBEDDED

namespace camway::view {
namespace {

/// The file as it was before the build compressed it, which the program does without: of the script
/// that is 0.9 MB. Requires what gzip made, or nothing where there is no such file.
PageFile with_text(std::string_view gzip) {
  if (gzip.empty()) return {};
  base::Result<std::string> text = gzip::inflated(gzip);
  assert(text);
  return {*std::move(text), gzip};
}

}  // namespace

PageFiles embedded_page() {
  return {
      with_text({camway_page_html_gzip_begin, camway_page_html_gzip_end}),
      with_text({camway_page_script_gzip_begin, camway_page_script_gzip_end}),
      with_text({camway_page_style_gzip_begin, camway_page_style_gzip_end}),
      {camway_page_policy_begin, camway_page_policy_end},
      {camway_report_script_begin, camway_report_script_end},
      {camway_report_policy_begin, camway_report_policy_end},
  };
}

}  // namespace camway::view
