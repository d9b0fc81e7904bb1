# cmake -D SOURCE_DIR=... -D COMPILER=... -D FLAGS=... -D HEADER=... -P WriteSceneBuild.cmake: writes a digest
# of the sources that read and prepare scenes, of their compiler and its flags, as a C++ header; touches the
# header only when the digest changed.
file(GLOB_RECURSE sources RELATIVE ${SOURCE_DIR} LIST_DIRECTORIES FALSE
  ${SOURCE_DIR}/daemon/base/* ${SOURCE_DIR}/daemon/geometry/* ${SOURCE_DIR}/daemon/scene/*)
list(APPEND sources tools/cmake/CamwayTargets.cmake)
list(SORT sources)
set(all "${COMPILER} ${FLAGS}")
foreach(source IN LISTS sources)
  file(SHA256 ${SOURCE_DIR}/${source} digest)
  string(APPEND all "\n${digest} ${source}")
endforeach()
string(SHA256 build "${all}")
string(SUBSTRING ${build} 0 32 build)
file(CONFIGURE OUTPUT ${HEADER} CONTENT [[
// SPDX-License-Identifier: MIT
#pragma once

namespace camway::scene {

inline constexpr char kSceneBuild[] = "@build@";

}  // namespace camway::scene
]] @ONLY)
