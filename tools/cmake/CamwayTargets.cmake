# How every target of this project is built, in one place.

# -ffp-contract=off: a fused multiply-add rounds once where the source says twice. The compiler may
# fuse in one build and not in the next, and then answers are no longer bit-identical.
add_library(camway_flags INTERFACE)
target_compile_options(camway_flags INTERFACE -ffp-contract=off)
target_include_directories(camway_flags INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
# A release holds only functions that something calls, and no path of the machine that built it: two builds
# of the same sources in two folders have the same bytes. Others keep both, for debuggers.
target_compile_options(camway_flags INTERFACE
  "$<$<CONFIG:Release>:-ffunction-sections;-fdata-sections;-ffile-prefix-map=${PROJECT_SOURCE_DIR}/=>")
target_link_options(camway_flags INTERFACE "$<$<CONFIG:Release>:LINKER:--gc-sections,-z,relro,-z,now>")
if(CAMWAY_SANITIZE)
  # Without vptr: GCC 12 checks a wrong address where a member function is called through a pointer,
  # as LCM's C++ header does, and reports or crashes on correct code.
  target_compile_options(camway_flags INTERFACE -fsanitize=${CAMWAY_SANITIZE} -fno-sanitize=vptr
                         -fno-omit-frame-pointer -fno-sanitize-recover=all)
  # Boost.Asio has fences, which the sanitizer of threads takes for nothing; they guard what locks guard, too.
  if(CAMWAY_SANITIZE STREQUAL "thread")
    target_compile_options(camway_flags INTERFACE -Wno-tsan)
  endif()
  target_link_options(camway_flags INTERFACE -fsanitize=${CAMWAY_SANITIZE})
endif()

# In our own code only: dependencies are included as system headers. Warnings are errors in the presets,
# so in CI, and nowhere else: another compiler, or another level of optimisation, may warn of what is right.
add_library(camway_warnings INTERFACE)
target_compile_options(camway_warnings INTERFACE
  -Wall -Wextra -Wpedantic $<$<NOT:$<BOOL:$<TARGET_PROPERTY:CAMWAY_MAY_SHADOW>>>:-Wshadow>
  -Wconversion -Wsign-conversion -Wold-style-cast
  # Clang's -Wdouble-promotion also warns of double -> long double, in which the oracles of tests compute.
  -Wnon-virtual-dtor -Woverloaded-virtual $<$<CXX_COMPILER_ID:GNU>:-Wdouble-promotion> -Wimplicit-fallthrough
  # At -O3, GCC 12 warns of what it inlines: of std::string's operator+ (GCC bug 105651), and of buffers
  # of {fmt} and Boost.Multiprecision.
  "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict;-Wno-stringop-overflow>")

# Where GCC 12 takes for uninitialized what is not; each use says why. Other compilers do not know the flag.
set(CAMWAY_NO_MAYBE_UNINITIALIZED $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)

# Parsing the standard library, Eigen and GoogleTest is three quarters of the time to compile most files,
# so the presets parse them once. Two precompiled headers, as GCC takes none that was compiled with another
# -fPIC. A build without presets has none, and so tells of an #include that is missing.
if(CAMWAY_PRECOMPILE)
  include(CamwayPrecompiled)
  # GCC 12 warns of std::string in a precompiled header as soon as it inlines it.
  target_compile_options(camway_warnings INTERFACE
    "$<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-stringop-overread>")
endif()

# compile_as_one(TARGET): with CAMWAY_UNITY, a room is one unit of translation, which takes half the time
# of its files one by one.
function(compile_as_one name)
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${CAMWAY_UNITY} UNITY_BUILD_BATCH_SIZE 0)
endfunction()

# The rooms whose code computes: a plan spends its time in them. Optimising all others takes a third of
# the time of a build and makes no plan faster. Benchmarks measure, and the campaign of tests/collision
# computes in fifty digits. Where both they and a room instantiate a template, the linker may keep the copy
# that is not optimised.
set(computing_rooms daemon/base daemon/geometry daemon/motion daemon/scene daemon/collision
    daemon/correction daemon/paper daemon/planning/request tools/view/display tests/bench tests/collision)

# The rooms that read words and print them, where a release is compiled for size: they are half of its code, and no
# plan waits for them.
set(talking_rooms daemon/cli_support daemon/http daemon/process tools/camway tools/view)

# is_part_of(RESULT ROOM ...): whether this folder is one of these rooms or lies in one.
function(is_part_of result)
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE folder)
  set(${result} FALSE PARENT_SCOPE)
  foreach(room IN LISTS ARGN)
    cmake_path(IS_PREFIX room ${folder} is_inside)
    if(is_inside)
      set(${result} TRUE PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

# optimise_little(TARGET): compiles a target that is no part of a room that computes without optimisation with
# CAMWAY_LIGHT, and a release's rooms that talk for size. Sets `precompiled` in the caller to the precompiled header
# of its flags.
function(optimise_little name)
  set(precompiled camway_precompiled_library PARENT_SCOPE)
  is_part_of(computes ${computing_rooms})
  is_part_of(talks ${talking_rooms})
  if(CAMWAY_LIGHT AND NOT computes)
    target_compile_options(${name} PRIVATE -O0)
    set(precompiled camway_precompiled_light PARENT_SCOPE)
  elseif(CMAKE_BUILD_TYPE STREQUAL "Release" AND talks AND NOT computes)
    # At -Os, GCC 12 takes an optional that is empty for one whose value is read.
    target_compile_options(${name} PRIVATE -Os ${CAMWAY_NO_MAYBE_UNINITIALIZED})
    set(precompiled camway_precompiled_small PARENT_SCOPE)
  endif()
endfunction()

# camway_library(NAME SOURCES ... DEPENDS ... [PRIVATE_DEPENDS ...])
function(camway_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  add_library(${name} STATIC ${arg_SOURCES})
  optimise_little(${name})
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(${name} PUBLIC camway_flags ${arg_DEPENDS}
                        PRIVATE camway_warnings ${arg_PRIVATE_DEPENDS})
  compile_as_one(${name})
  if(CAMWAY_PRECOMPILE)
    target_precompile_headers(${name} REUSE_FROM ${precompiled})
  endif()
endfunction()

# camway_hot_sources(FILE ...): where detection spends its time. Measured: -O3 makes it a tenth faster
# than -O2, and of all the rest nothing. The same IEEE operations, so the same bits.
function(camway_hot_sources)
  if(NOT CAMWAY_SANITIZE AND CMAKE_BUILD_TYPE MATCHES "^Rel")
    set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS -O3)
    # The precompiled header is for -O2.
    set_property(SOURCE ${ARGN} PROPERTY SKIP_PRECOMPILE_HEADERS ON)
  endif()
endfunction()

# camway_executable(NAME SOURCES ... DEPENDS ...)
function(camway_executable name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  optimise_little(${name})
  target_link_libraries(${name} PRIVATE camway_flags camway_warnings ${arg_DEPENDS})
  compile_as_one(${name})
endfunction()

# The folders of tests whose code starts threads. The thread sanitizer can find nothing in the others, so
# they are not built with it.
set(threaded_tests base client fleet integration nats process scene service tools wire)

# camway_test(NAME [NETWORK] [QUICK] [COMPUTING] SOURCES ... DEPENDS ... [SLOW TEST ...]): one GoogleTest
# program per folder of tests/, whose name is the label of its tests (`ctest -L service`). COMPUTING is for
# tests whose own code takes their time, such as oracles: with CAMWAY_LIGHT, all others are not optimised.
# NETWORK runs each test in a private network namespace of its own, for tests that use LCM. QUICK adds the label
# `quick` to all tests but those named after SLOW, which take more than a second.
function(camway_test name)
  cmake_parse_arguments(arg "NETWORK;QUICK;COMPUTING" "" "SOURCES;DEPENDS;SLOW" ${ARGN})
  add_executable(${name} ${arg_SOURCES} ${PROJECT_SOURCE_DIR}/tests/support/no_scene_cache.cpp)
  target_link_libraries(${name} PRIVATE camway_flags camway_warnings ${arg_DEPENDS} GTest::gtest
                        GTest::gmock GTest::gtest_main Eigen3::Eigen)
  # GCC 12 warns of std::regex, which tests use, with a sanitizer, and of structs of strings at -O3.
  target_compile_options(${name} PRIVATE ${CAMWAY_NO_MAYBE_UNINITIALIZED})
  set(precompiled camway_precompiled_test)
  if(CAMWAY_LIGHT AND NOT arg_COMPUTING)
    target_compile_options(${name} PRIVATE -O0)
    set(precompiled camway_precompiled_test_light)
  endif()
  if(CAMWAY_PRECOMPILE)
    target_precompile_headers(${name} REUSE_FROM ${precompiled})
  endif()
  # Eight files are one unit of translation, which takes a third of their time one by one: most of it goes
  # into instances of the same templates. There a local name may be one of another file.
  set_target_properties(${name} PROPERTIES UNITY_BUILD ${CAMWAY_UNITY} UNITY_BUILD_BATCH_SIZE 8
                                           CAMWAY_MAY_SHADOW ${CAMWAY_UNITY})
  if(arg_NETWORK)
    # The emulator is CMake's word for "what runs the program"; gtest_discover_tests heeds it.
    set_target_properties(${name} PROPERTIES CROSSCOMPILING_EMULATOR
                                             ${PROJECT_SOURCE_DIR}/tools/scripts/netns.sh)
  endif()
  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR FILENAME folder)
  if(CAMWAY_SANITIZE STREQUAL "thread" AND NOT folder IN_LIST threaded_tests)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL TRUE)
    return()
  endif()
  set(timeout_s 300)
  if(CAMWAY_SANITIZE)
    set(timeout_s 1200)
  endif()
  string(REPLACE ";" ":" slow "${arg_SLOW}")
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 TEST_FILTER "-${slow}" TEST_LIST ${name}_fast
                       PROPERTIES TIMEOUT ${timeout_s} LABELS "${folder}")
  if(slow)
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 TEST_FILTER "${slow}" TEST_LIST ${name}_slow
                         PROPERTIES TIMEOUT ${timeout_s} LABELS "${folder}")
  endif()
  if(arg_QUICK)
    # gtest_discover_tests takes no list of labels, so CTest adds the second one when it has the tests.
    set(script ${CMAKE_CURRENT_BINARY_DIR}/${name}_quick.cmake)
    file(WRITE ${script} "foreach(test IN LISTS ${name}_fast)
  set_tests_properties(\"\${test}\" PROPERTIES LABELS \"${folder};quick\")
endforeach()
")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${script})
  endif()
endfunction()
