# SPDX-License-Identifier: Apache-2.0

# embed_files(VARIABLE FUNCTION name HEADER file DIRECTORY folder PATTERNS ...): a generated .cpp
# that holds every file below `folder` of these patterns, sorted by name; its path goes to VARIABLE.
# It is written again when such a file changes, appears or goes. It defines
# std::span<const EmbeddedFile> FUNCTION(), which HEADER declares.
function(embed_files variable)
    cmake_parse_arguments(EMBED "" "FUNCTION;HEADER;DIRECTORY" "PATTERNS" ${ARGN})
    list(TRANSFORM EMBED_PATTERNS PREPEND ${EMBED_DIRECTORY}/ OUTPUT_VARIABLE patterns)
    file(GLOB_RECURSE files RELATIVE ${EMBED_DIRECTORY} CONFIGURE_DEPENDS ${patterns})
    list(SORT files)
    # The list is a file of its own, so that a file that goes away is noticed too.
    set(list ${CMAKE_CURRENT_BINARY_DIR}/${variable}.cmake)
    file(CONFIGURE OUTPUT ${list} CONTENT "set(files \"${files}\")\n" @ONLY)

    set(output ${CMAKE_CURRENT_BINARY_DIR}/${variable}.cpp)
    list(TRANSFORM files PREPEND ${EMBED_DIRECTORY}/ OUTPUT_VARIABLE inputs)
    set(script ${PROJECT_SOURCE_DIR}/cmake/EmbedFilesScript.cmake)
    file(RELATIVE_PATH shown ${PROJECT_SOURCE_DIR} ${EMBED_DIRECTORY})
    add_custom_command(
        OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -D LIST=${list} -D DIRECTORY=${EMBED_DIRECTORY} -D OUTPUT=${output}
            -D FUNCTION=${EMBED_FUNCTION} -D HEADER=${EMBED_HEADER} -P ${script}
        DEPENDS ${inputs} ${list} ${script}
        COMMENT "Embedding ${shown}"
        VERBATIM)
    set(${variable} ${output} PARENT_SCOPE)
endfunction()
