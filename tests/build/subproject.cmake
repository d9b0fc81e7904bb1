# Configures a project of which Camway is a part, in both usual ways. COMPILE=ON also builds its program.
# cmake -DSOURCE_DIR= -DWORK_DIR= [-DCOMPILE=ON] -P subproject.cmake
foreach(way add_subdirectory FetchContent)
  set(build ${WORK_DIR}/${way})
  file(REMOVE_RECURSE ${build})
  execute_process(
    COMMAND ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/subproject -B ${build} -DWAY=${way}
            -DCAMWAY_SOURCE_DIR=${SOURCE_DIR} -DCMAKE_BUILD_TYPE=Release
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  if(COMPILE)
    execute_process(COMMAND ${CMAKE_COMMAND} --build ${build} --parallel 2 --target user camwayd
                    COMMAND_ERROR_IS_FATAL ANY)
  endif()
  # It installs what it says itself, and nothing of ours.
  file(READ ${build}/cmake_install.cmake rules)
  file(GLOB_RECURSE others ${build}/*/cmake_install.cmake)
  foreach(file IN LISTS others)
    file(READ ${file} more)
    string(APPEND rules "${more}")
  endforeach()
  if(rules MATCHES "file\\(INSTALL" OR rules MATCHES "InstallDaemonFiles")
    message(SEND_ERROR "${way}: a project that Camway is a part of installs Camway")
  endif()
endforeach()
