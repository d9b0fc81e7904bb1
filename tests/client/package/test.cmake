# Installs the client into WORK_DIR, moves it, builds EXAMPLE against it with find_package(camway) and with
# pkg-config, and the programs of EXAMPLES.
# cmake -DBUILD_DIR= -DWORK_DIR= -DEXAMPLE= -DEXAMPLES= -P test.cmake
file(REMOVE_RECURSE ${WORK_DIR})
foreach(component client library library_c)
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix
                          --component ${component}
                  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endforeach()
file(RENAME ${WORK_DIR}/prefix ${WORK_DIR}/moved)
foreach(step
    "-S;${CMAKE_CURRENT_LIST_DIR};-B;${WORK_DIR}/build;-G;Ninja;-DCMAKE_PREFIX_PATH=${WORK_DIR}/moved;-DEXAMPLE=${EXAMPLE};-DEXAMPLES=${EXAMPLES}"
    "--build;${WORK_DIR}/build")
  execute_process(COMMAND ${CMAKE_COMMAND} ${step} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
