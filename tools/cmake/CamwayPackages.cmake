# Debian packages by CPack: `cpack --config build/release/CPackConfig.cmake`, or tools/scripts/release.sh. CamwayInstall.cmake
# lists the installed files; this file has the package of each. A package of a component that this
# build does not install is left out.
set(CAMWAY_PACKAGE_MAINTAINER "Camway maintainers <maintainers@camway.example.org>"
    CACHE STRING "Name and address of who answers for the packages")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME camway)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_VENDOR "The Camway authors")
set(CPACK_PACKAGE_CONTACT "${CAMWAY_PACKAGE_MAINTAINER}")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
# CPack puts any other summary than this, its default, before the descriptions of all packages, as their synopsis.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${CMAKE_PROJECT_NAME} built using CMake")
set(CPACK_VERBATIM_VARIABLES TRUE)
set(CPACK_STRIP_FILES TRUE)
# The units and the sample name files by their place on the machine that installs the package.
set(CPACK_SET_DESTDIR TRUE)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEB_COMPONENT_INSTALL TRUE)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION TRUE)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_THREADS 1)  # the bytes of a package do not depend on the number of cores

set(exact "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")

# camway_package(COMPONENT NAME SECTION [SHARED] [ALL] [DEPENDS ...] [RECOMMENDS ...] [SUGGESTS ...]
#                SUMMARY ... DESCRIPTION ...): the package of a component. SHARED: it depends on the
# packages of the shared libraries that its programs and libraries need. ALL: it is the same for every architecture.
macro(camway_package component name section)
  cmake_parse_arguments(arg "SHARED;ALL" "DEPENDS;RECOMMENDS;SUGGESTS;SUMMARY;DESCRIPTION" "" ${ARGN})
  string(TOUPPER ${component} upper)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS ${arg_SHARED})
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${arg_DEPENDS}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_RECOMMENDS "${arg_RECOMMENDS}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_SUGGESTS "${arg_SUGGESTS}")
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${arg_SUMMARY}\n${arg_DESCRIPTION}")
  if(arg_ALL)
    set(CPACK_DEBIAN_${upper}_PACKAGE_ARCHITECTURE all)
  endif()
  list(APPEND camway_packages ${component}=${name})
endmacro()

get_cmake_property(installed COMPONENTS)
set(CPACK_COMPONENTS_ALL "")
set(camway_packages "")

camway_package(tools camway graphics SHARED
  RECOMMENDS "camway-formats ${exact}" SUGGESTS "camway-doc, camwayd"
  SUMMARY "camera paths through keyframes, proved free of collision"
  DESCRIPTION "The command camway plans smooth camera paths through keyframes in a scene,
corrects them until they are free of collision, and proves that. It reads
and writes camera files of other programs, draws floor plans and serves a
page for browsers.")
if(formats IN_LIST installed)
  camway_package(formats camway-formats graphics SHARED DEPENDS "camway ${exact}"
    SUMMARY "scenes of STEP, IGES, Open Inventor and VRML for Camway"
    DESCRIPTION "The programs with which camway and camwayd read such scenes. They are a
package of their own as their libraries, Open CASCADE and Coin, are larger
than all the rest.")
endif()
camway_package(daemon camwayd net SHARED DEPENDS "adduser, camway ${exact}" SUGGESTS "camway-doc"
  SUMMARY "daemon that plans camera paths free of collision, over LCM"
  DESCRIPTION "The daemon holds scenes and answers requests for paths, by messages of LCM.
The package has a unit of systemd, which nothing starts before you have put
your scenes into the configuration, and a system user for it.")
# A program finds the library whose ABI it was linked with, so the package of each is named after its ABI.
camway_package(library libcamway${camway_cxx_abi} libs SHARED
  SUMMARY "shared library of Camway's client, for C++"
  DESCRIPTION "Programs that were linked with this library ask a running camwayd for paths.")
camway_package(library_c libcamway-c${camway_c_abi_major} libs SHARED
  SUMMARY "shared library of Camway's client, for C"
  DESCRIPTION "Programs in C and other languages that were linked with this library ask a
running camwayd for paths.")
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS TRUE)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(debian ${PROJECT_SOURCE_DIR}/tools/packages/debian)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${debian}/triggers)
set(CPACK_DEBIAN_LIBRARY_C_PACKAGE_CONTROL_EXTRA ${debian}/triggers)
set(libraries "libcamway${camway_cxx_abi} ${exact}, libcamway-c${camway_c_abi_major} ${exact}")
camway_package(client libcamway-client-dev libdevel DEPENDS "${libraries}, liblcm-dev"
  RECOMMENDS "libsodium-dev" SUGGESTS "camway-doc"
  SUMMARY "client of Camway's daemon for C++ and C, and its messages"
  DESCRIPTION "Headers, libraries, and files for CMake and pkg-config, to plan camera paths
from programs by a running camwayd; and the types of its messages as .lcm
files, for other languages.")
if(python IN_LIST installed)
  # Its module is for one version of the interpreter.
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  set(interpreter "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next}), python3-numpy")
  camway_package(python python3-camway python SHARED DEPENDS "${interpreter}, camway ${exact}"
    SUMMARY "Camway in Python: planning, and the client of the daemon"
    DESCRIPTION "Plans camera paths that are free of collision, in the process of the program or
by a running camwayd.")
endif()
camway_package(doc camway-doc doc ALL
  SUMMARY "documents of Camway"
  DESCRIPTION "Every field of requests and answers, the messages, formats of scenes and
cameras, operation of the daemon, what is proved and how.")

set(CPACK_DEBIAN_DAEMON_PACKAGE_CONTROL_EXTRA
    ${debian}/conffiles ${debian}/postinst ${debian}/prerm ${debian}/postrm)

list(JOIN camway_packages " " camway_package_list)
# Completes the staged files of each package as Debian wants them.
configure_file(${PROJECT_SOURCE_DIR}/tools/packages/stage_debian.cmake.in
               ${PROJECT_BINARY_DIR}/stage_debian.cmake @ONLY)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_BINARY_DIR}/stage_debian.cmake)
include(CPack)
