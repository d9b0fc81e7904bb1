# What `cmake --install` puts where: the client for find_package(camway), the wire types for other
# languages, and the programs with a sample configuration and a systemd unit.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

install(TARGETS camwayd camway-import camway)
if(CAMWAY_WITH_INVENTOR)
  install(TARGETS camway-import-inventor)
endif()
if(CAMWAY_WITH_CAD)
  install(TARGETS camway-import-cad)
endif()
install(FILES ${PROJECT_SOURCE_DIR}/scenes/office.obj
        DESTINATION ${CMAKE_INSTALL_DATADIR}/camway/scenes)
install(FILES ${CAMWAY_BLENDER_ZIP} DESTINATION ${CMAKE_INSTALL_DATADIR}/camway/blender)
configure_file(${CMAKE_CURRENT_LIST_DIR}/InstallDaemonFiles.cmake.in
               ${PROJECT_BINARY_DIR}/InstallDaemonFiles.cmake @ONLY)
install(SCRIPT ${PROJECT_BINARY_DIR}/InstallDaemonFiles.cmake)
# The documents keep the folders that they have in the repository, so that the links between them work.
install(FILES README.md ARCHITECTURE.md CHANGELOG.md CONTRIBUTING.md LICENSE SECURITY.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT client)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT client
        FILES_MATCHING PATTERN "*.md" PATTERN "*.svg" PATTERN "*.png")
install(DIRECTORY client/python/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}/client/python COMPONENT client
        FILES_MATCHING PATTERN "*.py")
foreach(folder daemon/paper lcmtypes tests/bench)
  install(FILES ${folder}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder} COMPONENT client)
endforeach()

# The installed client library holds the wire checks too and exports nothing of our build: users need
# LCM and the standard library only.
add_library(camway_client_installed STATIC
  $<TARGET_OBJECTS:camway_client> $<TARGET_OBJECTS:camway_client_engine>
  $<TARGET_OBJECTS:camway_client_messages> $<TARGET_OBJECTS:camway_client_types>
  $<TARGET_OBJECTS:camway_wire>)
set_target_properties(camway_client_installed PROPERTIES
  OUTPUT_NAME camway LINKER_LANGUAGE CXX EXPORT_NAME client)
target_include_directories(camway_client_installed INTERFACE
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(camway_client_installed INTERFACE cxx_std_17)
target_link_libraries(camway_client_installed INTERFACE LCM::lcm Threads::Threads)

# Signing by shared keys, for those who ask for it: COMPONENTS authentication. Its users need libsodium.
add_library(camway_authentication_installed STATIC
  $<TARGET_OBJECTS:camway_client_authentication> $<TARGET_OBJECTS:camway_wire_auth>)
set_target_properties(camway_authentication_installed PROPERTIES
  OUTPUT_NAME camway_authentication LINKER_LANGUAGE CXX EXPORT_NAME authentication)
target_link_libraries(camway_authentication_installed
  INTERFACE camway_client_installed PkgConfig::SODIUM)

set(camway_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/camway)
install(TARGETS camway_client_installed EXPORT camway-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT client)
install(EXPORT camway-targets NAMESPACE camway:: DESTINATION ${camway_package_dir}
        COMPONENT client)
install(TARGETS camway_authentication_installed EXPORT camway-authentication-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT client)
install(EXPORT camway-authentication-targets NAMESPACE camway:: DESTINATION ${camway_package_dir}
        COMPONENT client)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/client/include/camway DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        COMPONENT client FILES_MATCHING PATTERN "*.h")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/lcmtypes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/camway/lcmtypes
        COMPONENT client FILES_MATCHING PATTERN "*.lcm" PATTERN "wire" EXCLUDE)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/camwayConfig.cmake.in
  ${PROJECT_BINARY_DIR}/camwayConfig.cmake INSTALL_DESTINATION ${camway_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/camwayConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/camwayConfig.cmake
              ${PROJECT_BINARY_DIR}/camwayConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindLCM.cmake
        DESTINATION ${camway_package_dir} COMPONENT client)
