/* SPDX-License-Identifier: MIT */
/* The files of the page, as make_page.sh makes them; the assembler is told their folder. */

.macro embed name, file
  .global camway_\name\()_begin, camway_\name\()_end
camway_\name\()_begin:
  .incbin "\file"
camway_\name\()_end:
  .byte 0
.endm

  .section .rodata
  embed page_html_gzip, "index.html.gz"
  embed page_script_gzip, "page.js.gz"
  embed page_style_gzip, "page.css.gz"
  embed page_policy, "policy.txt"
  embed report_script, "report.js"
  embed report_policy, "report_policy.txt"

  .section .note.GNU-stack, "", %progbits
