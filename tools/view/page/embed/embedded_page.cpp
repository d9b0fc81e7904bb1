// SPDX-License-Identifier: MIT
#include "tools/view/page/embed/embedded_page.h"

#include <string_view>

/// Declares the begin and the end of a file in embedded_files.S.
#define CAMWAY_EMBEDDED(name)                    \
  extern "C" const char camway_##name##_begin[]; \
  extern "C" const char camway_##name##_end[]

CAMWAY_EMBEDDED(page_html);
CAMWAY_EMBEDDED(page_html_gzip);
CAMWAY_EMBEDDED(page_script);
CAMWAY_EMBEDDED(page_script_gzip);
CAMWAY_EMBEDDED(page_style);
CAMWAY_EMBEDDED(page_style_gzip);
CAMWAY_EMBEDDED(page_policy);
CAMWAY_EMBEDDED(report_script);
CAMWAY_EMBEDDED(report_policy);

#undef CAMWAY_EMBEDDED

namespace camway::view {

PageFiles embedded_page() {
  return {
      {{camway_page_html_begin, camway_page_html_end},
       {camway_page_html_gzip_begin, camway_page_html_gzip_end}},
      {{camway_page_script_begin, camway_page_script_end},
       {camway_page_script_gzip_begin, camway_page_script_gzip_end}},
      {{camway_page_style_begin, camway_page_style_end},
       {camway_page_style_gzip_begin, camway_page_style_gzip_end}},
      {camway_page_policy_begin, camway_page_policy_end},
      {camway_report_script_begin, camway_report_script_end},
      {camway_report_policy_begin, camway_report_policy_end},
  };
}

}  // namespace camway::view
