# SPDX-License-Identifier: MIT
# cmake -DPYTHON=... -DROOT=... -DFOLDER=... -P cpp_reference.cmake: makes the pages of the C++ reference.
file(REMOVE_RECURSE ${FOLDER})
execute_process(COMMAND ${PYTHON} ${ROOT}/docs/site/cpp_reference.py ${FOLDER} COMMAND_ERROR_IS_FATAL ANY)
file(READ ${FOLDER}/parameterize.md page)
foreach(line "## `parameterize_params`" "any_energy energy" "Throws parameter" "map_result|parameterize\\(queue")
    if(NOT page MATCHES "${line}")
        message(FATAL_ERROR "parameterize.md does not say ${line}")
    endif()
endforeach()
if(page MATCHES "return ")
    message(FATAL_ERROR "parameterize.md shows the body of a function")
endif()
