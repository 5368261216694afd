# SPDX-License-Identifier: MIT
# temporaries.cmake -DFOLDER=...: tests have left nothing of theirs where temporary files are. What was left is named, and removed.
file(GLOB left ${FOLDER}/taut* ${FOLDER}/tmp*)
if(left)
    list(TRANSFORM left APPEND "/*" OUTPUT_VARIABLE patterns)
    file(GLOB_RECURSE files ${patterns})
    list(SUBLIST files 0 20 files)
    file(REMOVE_RECURSE ${left})
    list(JOIN left "\n  " lines)
    list(JOIN files "\n  " within)
    message(FATAL_ERROR "Tests have left temporary files:\n  ${lines}\nFirst files:\n  ${within}")
endif()
