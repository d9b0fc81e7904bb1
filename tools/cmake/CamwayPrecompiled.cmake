# GCC collects garbage in memory all through a unit that begins with a large precompiled header: 0.9 s a
# unit. With these it lets up to 2 GB come together first.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(camway_flags INTERFACE --param=ggc-min-expand=1000 --param=ggc-min-heapsize=2000000)
endif()

# The headers that are parsed once: of the standard library and of dependencies that most files include,
# none of our own, which change.

set(precompiled_headers
  <algorithm> <array> <atomic> <bit> <cassert> <cerrno> <charconv> <chrono> <cmath> <condition_variable>
  <cstddef> <cstdint> <cstdio> <cstdlib> <cstring> <deque> <filesystem> <fstream> <functional> <iostream>
  <iterator> <limits> <map> <memory> <mutex> <numbers> <numeric> <optional> <random> <set> <span> <sstream>
  <stdexcept> <stop_token> <string> <string_view> <system_error> <thread> <tuple> <type_traits>
  <unordered_map> <utility> <variant> <vector>
  <Eigen/Core> <Eigen/Geometry>)

# add_precompiled(NAME HEADER...)
function(add_precompiled name)
  set(source ${PROJECT_BINARY_DIR}/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "")
  add_library(${name} OBJECT ${source})
  target_link_libraries(${name} PRIVATE camway_flags camway_warnings Eigen3::Eigen)
  target_precompile_headers(${name} PRIVATE ${ARGN})
endfunction()

add_precompiled(camway_precompiled_library ${precompiled_headers})
set_target_properties(camway_precompiled_library PROPERTIES POSITION_INDEPENDENT_CODE ON)
if(CAMWAY_LIGHT)
  add_precompiled(camway_precompiled_light ${precompiled_headers})
  target_compile_options(camway_precompiled_light PRIVATE -O0)
  set_target_properties(camway_precompiled_light PROPERTIES POSITION_INDEPENDENT_CODE ON)
endif()

if(CAMWAY_TESTS)
  find_package(GTest REQUIRED)
  set(tests camway_precompiled_test)
  if(CAMWAY_LIGHT)
    list(APPEND tests camway_precompiled_test_light)
  endif()
  foreach(name IN LISTS tests)
    add_precompiled(${name} ${precompiled_headers} <gmock/gmock.h> <gtest/gtest.h>)
    target_link_libraries(${name} PRIVATE GTest::gtest GTest::gmock)
  endforeach()
  if(CAMWAY_LIGHT)
    target_compile_options(camway_precompiled_test_light PRIVATE -O0)
  endif()
endif()
