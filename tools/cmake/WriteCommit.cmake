# cmake -D SOURCE_DIR=... -D HEADER=... -P WriteCommit.cmake: writes the commit of the sources as a C++
# header, at every build, but touches the header only when the commit changed. Sources of a release are no
# repository; `git archive` wrote their commit into commit.txt.
file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/commit.txt archived LIMIT_COUNT 1)
if(archived MATCHES "^([0-9a-f]+) [0-9]+$")
  string(SUBSTRING ${CMAKE_MATCH_1} 0 12 commit)
else()
  execute_process(
    COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=12 --exclude=*
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    set(commit unknown)
  endif()
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT [[
// SPDX-License-Identifier: MIT
#pragma once

namespace camway::service {

inline constexpr char kCommit[] = "@commit@";

}  // namespace camway::service
]] @ONLY)
