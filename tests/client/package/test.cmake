# Installs the client into WORK_DIR and builds EXAMPLE against it with find_package(camway).
# cmake -DBUILD_DIR= -DWORK_DIR= -DEXAMPLE= -P test.cmake
file(REMOVE_RECURSE ${WORK_DIR})
foreach(step
    "--install;${BUILD_DIR};--prefix;${WORK_DIR}/prefix;--component;client"
    "-S;${CMAKE_CURRENT_LIST_DIR};-B;${WORK_DIR}/build;-G;Ninja;-DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix;-DEXAMPLE=${EXAMPLE}"
    "--build;${WORK_DIR}/build")
  execute_process(COMMAND ${CMAKE_COMMAND} ${step} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
