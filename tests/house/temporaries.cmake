# SPDX-License-Identifier: MIT
# temporaries.cmake -DFOLDER=...: tests have left nothing of theirs where temporary files are. What was left is named, and removed.
file(GLOB left ${FOLDER}/taut* ${FOLDER}/tmp*)
if(left)
    file(REMOVE_RECURSE ${left})
    list(JOIN left "\n  " lines)
    message(FATAL_ERROR "Tests have left temporary files:\n  ${lines}")
endif()
