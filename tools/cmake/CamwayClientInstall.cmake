# The installed client. Its libraries hold the wire checks too and export nothing of our build: users need
# LCM and the standard library only. docs/versions.md says what their versions promise.
#
#   libcamway.a             C++ and C
#   libcamway.so.0.1        C++: its ABI is that of a minor version
#   libcamway_c.so.1        C: its ABI outlives minor versions, so that programs need not be built again

set(camway_client_objects
  $<TARGET_OBJECTS:camway_client> $<TARGET_OBJECTS:camway_client_engine>
  $<TARGET_OBJECTS:camway_client_messages> $<TARGET_OBJECTS:camway_client_types>
  $<TARGET_OBJECTS:camway_wire>)
# The numbers of the ABIs: that of C is written in its header, that of C++ follows the version.
file(STRINGS ${PROJECT_SOURCE_DIR}/client/include/camway/c/base.h camway_c_abi REGEX "define CAMWAY_ABI_M(AJOR|INOR) ")
list(TRANSFORM camway_c_abi REPLACE ".* " "")
list(GET camway_c_abi 0 camway_c_abi_major)
list(JOIN camway_c_abi "." camway_c_abi)
set(camway_cxx_abi ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(camway_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/camway)

# camway_installed_library(TARGET STATIC|SHARED FILE NAME): a library of the given objects, as camway::NAME.
function(camway_installed_library target kind file name)
  add_library(${target} ${kind} ${ARGN})
  set_target_properties(${target} PROPERTIES
    OUTPUT_NAME ${file} EXPORT_NAME ${name} LINKER_LANGUAGE CXX POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
endfunction()

# camway_versioned(TARGET ABI VERSION MAP): the names and exported symbols of a shared library.
function(camway_versioned target abi version map)
  configure_file(${PROJECT_SOURCE_DIR}/client/abi/${map} ${PROJECT_BINARY_DIR}/${map} @ONLY)
  set_target_properties(${target} PROPERTIES
    SOVERSION ${abi} VERSION ${version} LINK_DEPENDS ${PROJECT_BINARY_DIR}/${map})
  target_link_libraries(${target} PRIVATE LCM::lcm Threads::Threads)
  target_link_options(${target} PRIVATE -Wl,--version-script=${PROJECT_BINARY_DIR}/${map})
  if(CAMWAY_SANITIZE)
    target_link_options(${target} PRIVATE -fsanitize=${CAMWAY_SANITIZE})
  else()
    target_link_options(${target} PRIVATE -Wl,--no-undefined)
  endif()
endfunction()

camway_installed_library(camway_client_installed STATIC camway client_static
  ${camway_client_objects} $<TARGET_OBJECTS:camway_client_c>)
target_compile_features(camway_client_installed INTERFACE cxx_std_17)
target_link_libraries(camway_client_installed INTERFACE LCM::lcm Threads::Threads)

camway_installed_library(camway_client_shared SHARED camway client_shared ${camway_client_objects})
target_compile_features(camway_client_shared INTERFACE cxx_std_17)
target_link_libraries(camway_client_shared INTERFACE Threads::Threads)
camway_versioned(camway_client_shared ${camway_cxx_abi} ${PROJECT_VERSION} camway.map)

# The one for C signs, too: programs in C cannot link what is in C++.
camway_installed_library(camway_c_shared SHARED camway_c c
  ${camway_client_objects} $<TARGET_OBJECTS:camway_client_c>
  $<TARGET_OBJECTS:camway_client_authentication> $<TARGET_OBJECTS:camway_wire_auth>)
camway_versioned(camway_c_shared ${camway_c_abi_major} ${camway_c_abi}.0 camway_c.map)
target_link_libraries(camway_c_shared PRIVATE PkgConfig::SODIUM)

# Signing by shared keys, for those who ask for it: COMPONENTS authentication. Its users need libsodium. It
# has the wire checks itself, which the shared library does not export.
camway_installed_library(camway_authentication_installed STATIC camway_authentication authentication
  $<TARGET_OBJECTS:camway_client_authentication> $<TARGET_OBJECTS:camway_wire_auth>
  $<TARGET_OBJECTS:camway_wire>)
target_link_libraries(camway_authentication_installed INTERFACE LCM::lcm PkgConfig::SODIUM)

# The targets are in sets of their own, as a package may have the one without the other.
install(TARGETS camway_client_installed EXPORT camway-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT client)
install(TARGETS camway_client_shared EXPORT camway-shared-targets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT client)
install(TARGETS camway_c_shared EXPORT camway-c-targets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library_c NAMELINK_COMPONENT client)
install(TARGETS camway_authentication_installed EXPORT camway-authentication-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT client)
foreach(set camway camway-shared camway-c camway-authentication)
  install(EXPORT ${set}-targets NAMESPACE camway:: DESTINATION ${camway_package_dir} COMPONENT client)
endforeach()

# Files for pkg-config. The prefix is found from the place of the file, so the files can be moved.
file(RELATIVE_PATH camway_prefix_from_pc /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
foreach(library client c)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/camway-${library}.pc.in ${PROJECT_BINARY_DIR}/camway-${library}.pc
                 @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/camway-${library}.pc
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT client)
endforeach()
