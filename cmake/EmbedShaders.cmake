# SPDX-License-Identifier: Apache-2.0

# embed_shaders(VARIABLE DIRECTORY): a generated .cpp that holds every shader below DIRECTORY; its
# path goes to VARIABLE. It is written again when a shader changes, appears or goes.
function(embed_shaders variable directory)
    file(GLOB_RECURSE shaders RELATIVE ${directory} CONFIGURE_DEPENDS
        ${directory}/*.vert ${directory}/*.frag ${directory}/*.glsl)
    list(SORT shaders)
    # The list is a file of its own, so that a shader that goes away is noticed too.
    set(list ${CMAKE_CURRENT_BINARY_DIR}/embedded_shaders.cmake)
    file(CONFIGURE OUTPUT ${list} CONTENT "set(shaders \"${shaders}\")\n" @ONLY)

    set(output ${CMAKE_CURRENT_BINARY_DIR}/embedded_shaders.cpp)
    list(TRANSFORM shaders PREPEND ${directory}/ OUTPUT_VARIABLE inputs)
    set(script ${PROJECT_SOURCE_DIR}/cmake/EmbedShadersScript.cmake)
    add_custom_command(
        OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -D LIST=${list} -D DIRECTORY=${directory} -D OUTPUT=${output}
            -P ${script}
        DEPENDS ${inputs} ${list} ${script}
        COMMENT "Embedding the shaders"
        VERBATIM)
    set(${variable} ${output} PARENT_SCOPE)
endfunction()
