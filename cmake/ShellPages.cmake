# SPDX-License-Identifier: Apache-2.0
# Manual pages and completions, made by the program from its own command line, in ${PROJECT_BINARY_DIR}/pages.
set(pages ${PROJECT_BINARY_DIR}/pages)
add_custom_command(OUTPUT ${pages}/made
    COMMAND ${CMAKE_COMMAND} -DLAMINA=$<TARGET_FILE:lamina> -DGZIP=${GZIP} -DFOLDER=${pages}
        -P ${PROJECT_SOURCE_DIR}/cmake/ShellPagesScript.cmake
    DEPENDS lamina ${PROJECT_SOURCE_DIR}/cmake/ShellPagesScript.cmake VERBATIM)
add_custom_target(shell_pages ALL DEPENDS ${pages}/made)

# The page of `lamina view` is that of the viewer, too, and goes with it.
install(DIRECTORY ${pages}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT lamina
    PATTERN lamina-view.1.gz EXCLUDE)
if(TARGET lamina-view)
    install(FILES ${pages}/man1/lamina-view.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT lamina-view)
endif()
if(TARGET lamina-tetrahedralize)
    packed_file(packaging/lamina-tetrahedralize.1 lamina-tetrahedralize.1 page)
    install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT lamina-tetrahedralize)
endif()
install(FILES ${pages}/lamina DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT lamina)
install(FILES ${pages}/_lamina DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT lamina)
install(FILES ${pages}/lamina.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT lamina)
