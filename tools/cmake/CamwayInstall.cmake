# What `cmake --install` puts where: the client for find_package(camway), the wire types for other
# languages, and the programs with a sample configuration and a systemd unit.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# A component is a package, too (CamwayPackages.cmake).
install(TARGETS camway camway-import COMPONENT tools)
install(TARGETS camwayd COMPONENT daemon)
if(CAMWAY_WITH_INVENTOR)
  install(TARGETS camway-import-inventor COMPONENT formats)
endif()
if(CAMWAY_WITH_CAD)
  install(TARGETS camway-import-cad COMPONENT formats)
endif()
install(FILES ${PROJECT_SOURCE_DIR}/scenes/office.obj
        DESTINATION ${CMAKE_INSTALL_DATADIR}/camway/scenes COMPONENT tools)
# The requests of the documents' examples name their scene as ../office.obj.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenes/requests
        DESTINATION ${CMAKE_INSTALL_DATADIR}/camway/scenes COMPONENT tools
        FILES_MATCHING PATTERN "office-*.json")
install(FILES ${CAMWAY_BLENDER_ZIP} DESTINATION ${CMAKE_INSTALL_DATADIR}/camway/blender COMPONENT tools)
configure_file(${CMAKE_CURRENT_LIST_DIR}/InstallDaemonFiles.cmake.in
               ${PROJECT_BINARY_DIR}/InstallDaemonFiles.cmake @ONLY)
install(SCRIPT ${PROJECT_BINARY_DIR}/InstallDaemonFiles.cmake COMPONENT daemon)
# The documents keep the folders that they have in the repository, so that the links between them work.
install(FILES README.md ARCHITECTURE.md CHANGELOG.md CONTRIBUTING.md LICENSE SECURITY.md
        DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc
        FILES_MATCHING PATTERN "*.md" PATTERN "*.svg" PATTERN "*.png")
install(DIRECTORY client/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}/client COMPONENT doc)
install(FILES client/abi/symbols.txt client/abi/layouts.txt DESTINATION ${CMAKE_INSTALL_DOCDIR}/client/abi
        COMPONENT doc)
install(FILES lcmtypes/fingerprints.txt DESTINATION ${CMAKE_INSTALL_DOCDIR}/lcmtypes COMPONENT doc)
install(DIRECTORY client/python/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}/client/python COMPONENT doc
        FILES_MATCHING PATTERN "*.py")
foreach(folder daemon/paper lcmtypes tests/bench)
  install(FILES ${folder}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR}/${folder} COMPONENT doc)
endforeach()

include(${CMAKE_CURRENT_LIST_DIR}/CamwayClientInstall.cmake)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/client/include/camway DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        COMPONENT client FILES_MATCHING PATTERN "*.h")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/lcmtypes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/camway/lcmtypes
        COMPONENT client FILES_MATCHING PATTERN "*.lcm" PATTERN "wire" EXCLUDE)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/camwayConfig.cmake.in
  ${PROJECT_BINARY_DIR}/camwayConfig.cmake INSTALL_DESTINATION ${camway_package_dir}
  PATH_VARS CMAKE_INSTALL_LIBDIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/camwayConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/camwayConfig.cmake
              ${PROJECT_BINARY_DIR}/camwayConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/FindLCM.cmake
        DESTINATION ${camway_package_dir} COMPONENT client)

include(CamwayPackages)
