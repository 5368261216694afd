# SPDX-License-Identifier: MIT
# cmake -DMODE=install|subdirectory -DROOT=... -DBUILD=... -P consume.cmake
# Builds and runs a user's project against a taut that was installed without building anything, or with taut as a
# subdirectory.
function(run)
    execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE out)
    if(result)
        message(FATAL_ERROR "${ARGV}\n${out}")
    endif()
endfunction()

file(REMOVE_RECURSE ${BUILD})
set(app ${ROOT}/tests/consumer/app)
if(MODE STREQUAL "install")
    run(${CMAKE_COMMAND} -S ${ROOT} -B ${BUILD}/taut -DTAUT_TESTS=OFF)
    run(${CMAKE_COMMAND} --install ${BUILD}/taut --prefix ${BUILD}/prefix)
    run(${CMAKE_COMMAND} -S ${app} -B ${BUILD}/app -DCMAKE_PREFIX_PATH=${BUILD}/prefix)
else()
    run(${CMAKE_COMMAND} -S ${app} -B ${BUILD}/app -DTAUT_SOURCE=${ROOT})
endif()
run(${CMAKE_COMMAND} --build ${BUILD}/app)
run(${BUILD}/app/app)
run(${BUILD}/app/app_compiled)
