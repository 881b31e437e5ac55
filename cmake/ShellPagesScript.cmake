# SPDX-License-Identifier: Apache-2.0
# Run by ShellPages.cmake: has LAMINA write its pages into FOLDER; manual pages are packed by GZIP.
file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER}/man1)

function(write_page file)
    execute_process(COMMAND ${LAMINA} ${ARGN} OUTPUT_FILE ${FOLDER}/${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

write_page(man1/lamina.1 man)
file(READ ${FOLDER}/man1/lamina.1 program)
string(REGEX MATCHALL "lamina\\\\-[a-z]+ \\(1\\)" verbs "${program}")
foreach(verb IN LISTS verbs)
    string(REGEX REPLACE "lamina\\\\-([a-z]+) .*" "\\1" verb "${verb}")
    write_page(man1/lamina-${verb}.1 man ${verb})
endforeach()
file(GLOB manual ${FOLDER}/man1/*.1)
execute_process(COMMAND ${GZIP} -9n ${manual} COMMAND_ERROR_IS_FATAL ANY)
write_page(lamina completion bash)
write_page(_lamina completion zsh)
write_page(lamina.fish completion fish)
file(TOUCH ${FOLDER}/made)
