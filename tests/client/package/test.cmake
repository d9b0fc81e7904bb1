# Installs the client into WORK_DIR, moves it, builds EXAMPLE against it with find_package(camway) and with
# pkg-config, and runs one. cmake -DBUILD_DIR= -DWORK_DIR= -DEXAMPLE= -DNETWORK= -P test.cmake
file(REMOVE_RECURSE ${WORK_DIR})
foreach(component client library)
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix
                          --component ${component}
                  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(RENAME ${WORK_DIR}/prefix ${WORK_DIR}/moved)
foreach(step
    "-S;${CMAKE_CURRENT_LIST_DIR};-B;${WORK_DIR}/build;-G;Ninja;-DCMAKE_PREFIX_PATH=${WORK_DIR}/moved;-DEXAMPLE=${EXAMPLE}"
    "--build;${WORK_DIR}/build")
  execute_process(COMMAND ${CMAKE_COMMAND} ${step} COMMAND_ERROR_IS_FATAL ANY)
endforeach()

# Without a daemon it says so.
execute_process(COMMAND ${NETWORK} ${WORK_DIR}/build/shared_user ERROR_VARIABLE said OUTPUT_VARIABLE said)
if(NOT said MATCHES "no daemon was heard")
  message(SEND_ERROR "with the shared library: ${said}")
endif()
