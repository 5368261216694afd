# SPDX-License-Identifier: MIT
# cmake "-DFILES=PAGE;SCRIPT;STYLE" -DOUTPUT=CPP -P embed.cmake: writes the definitions that page_files.hpp declares.
set(names page_html page_script page_style)
set(text "#include \"view/page_files.hpp\"\n\nnamespace taut::view\n{\n")
foreach(name file IN ZIP_LISTS names FILES)
    file(READ ${file} bytes HEX)
    string(REGEX REPLACE "(..)" "\\\\x\\1" bytes "${bytes}")
    string(LENGTH "${bytes}" length)
    set(literal "")
    math(EXPR last "(${length} - 1) / 8000")
    foreach(part RANGE ${last}) # compilers bound the length of a literal, and of a line in editors
        math(EXPR begin "${part} * 8000")
        string(SUBSTRING "${bytes}" ${begin} 8000 piece)
        string(APPEND literal "\n    \"${piece}\"")
    endforeach()
    math(EXPR size "${length} / 4")
    string(APPEND text "extern const std::string_view ${name};\nconst std::string_view ${name}(${literal},\n    ${size});\n")
endforeach()
file(WRITE ${OUTPUT} "${text}} // namespace taut::view\n")
