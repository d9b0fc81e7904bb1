# Sources of a release, which are no repository, know their commit.
# cmake -DSOURCE_DIR= -DWORK_DIR= -P archived_commit.cmake
execute_process(COMMAND git -C ${SOURCE_DIR} rev-parse HEAD
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE code ERROR_QUIET)
if(NOT code EQUAL 0)
  message("not run: these sources are no repository")
  return()
endif()
file(REMOVE_RECURSE ${WORK_DIR})
file(MAKE_DIRECTORY ${WORK_DIR})
execute_process(COMMAND git -C ${SOURCE_DIR} archive --format=tar --output=${WORK_DIR}/sources.tar HEAD tools/cmake
                COMMAND_ERROR_IS_FATAL ANY)
file(ARCHIVE_EXTRACT INPUT ${WORK_DIR}/sources.tar DESTINATION ${WORK_DIR})
execute_process(COMMAND ${CMAKE_COMMAND} -D SOURCE_DIR=${WORK_DIR} -D HEADER=${WORK_DIR}/commit.h
                        -P ${WORK_DIR}/tools/cmake/WriteCommit.cmake
                COMMAND_ERROR_IS_FATAL ANY)
file(READ ${WORK_DIR}/commit.h header)
string(SUBSTRING ${commit} 0 12 short)
if(NOT header MATCHES "\"${short}\"")
  message(FATAL_ERROR "the archive does not say ${short}:\n${header}")
endif()
