# SPDX-License-Identifier: MIT
# cmake "-DFILES=FILE;..." "-DNAMES=NAME;..." -DHEADER=HPP -DNAMESPACE=NAMESPACE -DOUTPUT=CPP -P embed.cmake: writes the
# definitions of the std::string_views that a header declares.
set(text "#include \"${HEADER}\"\n\nnamespace ${NAMESPACE}\n{\n")
foreach(name file IN ZIP_LISTS NAMES FILES)
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
file(WRITE ${OUTPUT} "${text}} // namespace ${NAMESPACE}\n")
