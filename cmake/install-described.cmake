# SPDX-License-Identifier: MIT
# Where the program was built: its pages of man and its completions for shells, as it prints them. taut_program, and the
# folders taut_mandir and taut_datadir are set where this is installed from (tools/CMakeLists.txt).
if(EXISTS "${taut_program}")
    get_filename_component(made "${taut_program}" DIRECTORY)
    set(made "${made}/../described")
    file(REMOVE_RECURSE "${made}")
    file(MAKE_DIRECTORY "${made}")
    execute_process(COMMAND "${taut_program}" man "${made}/man1" RESULT_VARIABLE failure ERROR_VARIABLE what)
    foreach(shell_file bash=taut zsh=_taut fish=taut.fish)
        string(REGEX MATCH "(.*)=(.*)" shell_file ${shell_file})
        if(NOT failure)
            file(MAKE_DIRECTORY "${made}/${CMAKE_MATCH_1}")
            execute_process(COMMAND "${taut_program}" completion ${CMAKE_MATCH_1} RESULT_VARIABLE failure
                            OUTPUT_FILE "${made}/${CMAKE_MATCH_1}/${CMAKE_MATCH_2}" ERROR_VARIABLE what)
        endif()
    endforeach()
    if(failure) # a program of another machine
        message(WARNING "taut's pages of man and completions are not installed: ${failure} ${what}")
    else()
        set(prefix "${CMAKE_INSTALL_PREFIX}")
        file(INSTALL "${made}/man1" DESTINATION "${prefix}/${taut_mandir}")
        file(INSTALL "${made}/bash/taut" DESTINATION "${prefix}/${taut_datadir}/bash-completion/completions")
        file(INSTALL "${made}/zsh/_taut" DESTINATION "${prefix}/${taut_datadir}/zsh/site-functions")
        file(INSTALL "${made}/fish/taut.fish" DESTINATION "${prefix}/${taut_datadir}/fish/vendor_completions.d")
    endif()
endif()
