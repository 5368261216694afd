# SPDX-License-Identifier: MIT
# Installs what the programs say of themselves: pages of man, and completions for bash, zsh and fish. Included from the
# generated install script with taut_program, taut_mpi_program (or none), taut_mandir and taut_datadir; a program that
# was not built, or does not run here, is passed over.
function(taut_install_described name program)
    if(NOT EXISTS "${program}")
        return()
    endif()
    get_filename_component(made "${program}" DIRECTORY)
    set(made "${made}/../described/${name}")
    file(REMOVE_RECURSE "${made}")
    file(MAKE_DIRECTORY "${made}")
    execute_process(COMMAND "${program}" man "${made}/man1" RESULT_VARIABLE failure ERROR_VARIABLE what)
    foreach(shell_file bash=${name} zsh=_${name} fish=${name}.fish)
        string(REGEX MATCH "(.*)=(.*)" shell_file ${shell_file})
        if(NOT failure)
            file(MAKE_DIRECTORY "${made}/${CMAKE_MATCH_1}")
            execute_process(COMMAND "${program}" completion ${CMAKE_MATCH_1} RESULT_VARIABLE failure
                            OUTPUT_FILE "${made}/${CMAKE_MATCH_1}/${CMAKE_MATCH_2}" ERROR_VARIABLE what)
        endif()
    endforeach()
    if(failure) # a program of another machine
        message(WARNING "pages of man and completions of ${name} are not installed: ${failure} ${what}")
    else()
        set(prefix "${CMAKE_INSTALL_PREFIX}")
        file(INSTALL "${made}/man1" DESTINATION "${prefix}/${taut_mandir}")
        file(INSTALL "${made}/bash/${name}" DESTINATION "${prefix}/${taut_datadir}/bash-completion/completions")
        file(INSTALL "${made}/zsh/_${name}" DESTINATION "${prefix}/${taut_datadir}/zsh/site-functions")
        file(INSTALL "${made}/fish/${name}.fish" DESTINATION "${prefix}/${taut_datadir}/fish/vendor_completions.d")
    endif()
endfunction()

taut_install_described(taut "${taut_program}")
if(DEFINED taut_mpi_program)
    taut_install_described(taut-mpi "${taut_mpi_program}")
endif()
