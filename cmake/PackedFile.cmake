# SPDX-License-Identifier: Apache-2.0
find_program(GZIP gzip REQUIRED)
add_custom_target(packed_files ALL)

# packed_file(FILE NAME VARIABLE): FILE packed by gzip as NAME.gz, without its date; the path goes to VARIABLE.
function(packed_file file name variable)
    set(output ${PROJECT_BINARY_DIR}/packed/${name}.gz)
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    add_custom_command(OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} -E copy ${file} ${PROJECT_BINARY_DIR}/packed/${name}
        COMMAND ${GZIP} -9nf ${PROJECT_BINARY_DIR}/packed/${name}
        DEPENDS ${file} VERBATIM)
    add_custom_target(packed_${name} DEPENDS ${output})
    add_dependencies(packed_files packed_${name})
    set(${variable} ${output} PARENT_SCOPE)
endfunction()
