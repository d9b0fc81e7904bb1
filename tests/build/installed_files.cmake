# Installs BUILD_DIR into a prefix that its configuration does not know, and looks at what is there.
# cmake -DBUILD_DIR= -DWORK_DIR= -DPYTHON= -DPACKAGE_PYTHON= -DWITH_INVENTOR= -DWITH_CAD= -P installed_files.cmake
file(REMOVE_RECURSE ${WORK_DIR})
set(prefix ${WORK_DIR}/prefix)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix}
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

set(importers bin/camway-import)
if(WITH_INVENTOR)
  list(APPEND importers bin/camway-import-inventor)
endif()
if(WITH_CAD)
  list(APPEND importers bin/camway-import-cad)
endif()
foreach(file bin/camwayd bin/camway ${importers} lib/systemd/system/camwayd.service
             lib/systemd/system/camwayd-planner@.service
             share/camway/camwayd.toml share/camway/scenes/office.obj
             share/camway/scenes/requests/office-graze-column.json share/camway/blender/camway_blender.zip share/camway/lcmtypes/camway_plan_request_t.lcm
             share/doc/camway/docs/wire.md share/doc/camway/docs/images/demo.svg
             share/doc/camway/lcmtypes/README.md
             share/doc/camway/README.md share/doc/camway/LICENSE share/doc/camway/SECURITY.md
             share/man/man1/camway.1 share/man/man1/camway-scene.1 share/man/man5/camwayd.toml.5
             share/man/man8/camwayd.8 share/bash-completion/completions/camway
             share/zsh/site-functions/_camwayd share/fish/vendor_completions.d/camway.fish
             include/camway/client.h)
  if(NOT EXISTS ${prefix}/${file})
    message(SEND_ERROR "${file} is not installed")
  endif()
endforeach()

# Every link of an installed document leads to an installed file, also where only the documents are.
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/doc --component doc
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
foreach(folder ${prefix} ${WORK_DIR}/doc)
  execute_process(COMMAND ${PYTHON} -B ${CMAKE_CURRENT_LIST_DIR}/../documents/check_links.py --source ${folder} --links-only
                  RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT code EQUAL 0)
    message(SEND_ERROR "documents in ${folder}:\n${said}")
  endif()
endforeach()

# The documents' first example runs with what is installed.
execute_process(COMMAND ${prefix}/bin/camway plan --request ${prefix}/share/camway/scenes/requests/office-graze-column.json
                        --response ${WORK_DIR}/column.json
                WORKING_DIRECTORY / OUTPUT_QUIET ERROR_VARIABLE said RESULT_VARIABLE code)
if(NOT code EQUAL 0 OR NOT said MATCHES "the path is proved free of collision")
  message(SEND_ERROR "the installed request of the documents: ${said}")
endif()

# The package for Python finds the installed program that reads scenes.
if(PACKAGE_PYTHON)
  set(ENV{PYTHONPATH} ${prefix}/lib/python3/dist-packages)
  set(ENV{CAMWAY_CACHE_DIR} "")
  set(code "import camway; print(camway.__file__, camway.Scene.load('${prefix}/share/camway/scenes/office.obj'))")
  execute_process(COMMAND ${PACKAGE_PYTHON} -B -c "${code}" WORKING_DIRECTORY / OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(NOT said MATCHES "^${prefix}/lib/python3/dist-packages/camway/.* of 29544 triangles>")
    message(SEND_ERROR "the installed package for Python: ${said}")
  endif()
  unset(ENV{PYTHONPATH})
endif()

file(READ ${prefix}/lib/systemd/system/camwayd-planner@.service unit)
string(FIND "${unit}" "ExecStart=\"${prefix}/bin/camwayd\" --config /etc/camway/planner.toml\n" place)
if(place EQUAL -1)
  message(SEND_ERROR "the unit of planners does not start the daemon:\n${unit}")
endif()

file(READ ${prefix}/lib/systemd/system/camwayd.service unit)
foreach(line "ExecStart=\"${prefix}/bin/camwayd\" --config /etc/camway/camwayd.toml\n"
             "${prefix}/share/camway/camwayd.toml")
  string(FIND "${unit}" "${line}" place)
  if(place EQUAL -1)
    message(SEND_ERROR "the unit does not say ${line}")
  endif()
endforeach()
if(unit MATCHES "@[a-zA-Z_]+@")
  message(SEND_ERROR "${CMAKE_MATCH_0} in the unit was not replaced")
endif()

# The sample is right where it is installed, and copied elsewhere, by whomever, from wherever.
file(COPY ${prefix}/share/camway/camwayd.toml DESTINATION ${WORK_DIR}/etc)
foreach(sample ${prefix}/share/camway/camwayd.toml ${WORK_DIR}/etc/camwayd.toml)
  execute_process(COMMAND ${prefix}/bin/camwayd --config ${sample} --check-config
                  WORKING_DIRECTORY / COMMAND_ERROR_IS_FATAL ANY)
endforeach()

# For packagers: the files go below DESTDIR, the paths in them do not.
set(ENV{DESTDIR} ${WORK_DIR}/staged)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix /opt/camway
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(STRINGS ${WORK_DIR}/staged/opt/camway/lib/systemd/system/camwayd.service start
     REGEX "^ExecStart=\"/opt/camway/bin/camwayd\" ")
if(NOT start)
  message(SEND_ERROR "with DESTDIR the unit does not start /opt/camway/bin/camwayd")
endif()
unset(ENV{DESTDIR})

# A prefix that is relative, and has a blank in it, which systemd would take for the end of the command.
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix "a folder"
                WORKING_DIRECTORY ${WORK_DIR} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(READ "${WORK_DIR}/a folder/lib/systemd/system/camwayd.service" unit)
string(FIND "${unit}" "ExecStart=\"${WORK_DIR}/a folder/bin/camwayd\" " place)
if(place EQUAL -1)
  message(SEND_ERROR "with a relative prefix the unit does not start the daemon there:\n${unit}")
endif()
execute_process(COMMAND "${WORK_DIR}/a folder/bin/camwayd" --check-config
                        --config "${WORK_DIR}/a folder/share/camway/camwayd.toml"
                WORKING_DIRECTORY / COMMAND_ERROR_IS_FATAL ANY)
find_program(systemd_analyze systemd-analyze)
if(systemd_analyze)
  foreach(unit camwayd.service camwayd-planner@1.service)
    execute_process(COMMAND ${systemd_analyze} verify "${WORK_DIR}/a folder/lib/systemd/system/${unit}"
                    ERROR_VARIABLE said OUTPUT_VARIABLE said)
    if(said MATCHES "not executable|absolute path")
      message(SEND_ERROR "systemd does not take the unit ${unit}: ${said}")
    endif()
  endforeach()
endif()
