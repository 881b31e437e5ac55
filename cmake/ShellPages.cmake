# SPDX-License-Identifier: Apache-2.0
# Manual pages and completions, made by the program from its own command line, in ${PROJECT_BINARY_DIR}/pages.
find_program(GZIP gzip REQUIRED)
set(pages ${PROJECT_BINARY_DIR}/pages)
add_custom_command(OUTPUT ${pages}/made
    COMMAND ${CMAKE_COMMAND} -DLAMINA=$<TARGET_FILE:lamina> -DGZIP=${GZIP} -DFOLDER=${pages}
        -P ${PROJECT_SOURCE_DIR}/cmake/ShellPagesScript.cmake
    DEPENDS lamina ${PROJECT_SOURCE_DIR}/cmake/ShellPagesScript.cmake VERBATIM)
add_custom_target(shell_pages ALL DEPENDS ${pages}/made)

install(DIRECTORY ${pages}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR})
install(FILES ${pages}/lamina DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${pages}/_lamina DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES ${pages}/lamina.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
