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

# add_precompiled_library(NAME [OPTION...]): for the libraries that are compiled with these options, too.
function(add_precompiled_library name)
  add_precompiled(${name} ${precompiled_headers})
  target_compile_options(${name} PRIVATE ${ARGN})
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()

add_precompiled_library(camway_precompiled_library)
if(CAMWAY_LIGHT)
  add_precompiled_library(camway_precompiled_light -O0)
elseif(CMAKE_BUILD_TYPE STREQUAL "Release")
  add_precompiled_library(camway_precompiled_small -Os)
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
