# SPDX-License-Identifier: Apache-2.0
# cmake --install: the library, its headers and its CMake package, scenes, and what each package says about its licence.
# Programs and the module are installed where they are made. Every rule names a component, which becomes a package
# (Packages.cmake).
include(CMakePackageConfigHelpers)
set(documents ${CMAKE_INSTALL_DATADIR}/doc)

# The library goes with the program: the other packages load it.
install(TARGETS lamina_shared EXPORT laminaTargets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT lamina NAMELINK_COMPONENT lamina-dev)
install(DIRECTORY data/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/lamina COMPONENT lamina)
install(FILES docs/scene.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/lamina COMPONENT lamina)
# As in the repository, so that links hold.
install(FILES README.md DESTINATION ${documents}/lamina COMPONENT lamina)
install(DIRECTORY docs DESTINATION ${documents}/lamina COMPONENT lamina PATTERN conf.py EXCLUDE)

install(DIRECTORY include/lamina DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT lamina-dev)
install(DIRECTORY examples DESTINATION ${documents}/lamina-dev COMPONENT lamina-dev)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/lamina)
install(EXPORT laminaTargets NAMESPACE lamina:: DESTINATION ${package} COMPONENT lamina-dev)
configure_package_config_file(cmake/laminaConfig.cmake.in ${PROJECT_BINARY_DIR}/laminaConfig.cmake
    INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/laminaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/laminaConfig.cmake ${PROJECT_BINARY_DIR}/laminaConfigVersion.cmake
    DESTINATION ${package} COMPONENT lamina-dev)

set(copyright_of_lamina-view packaging/copyright-view)
set(copyright_of_lamina-tetrahedralize ${PROJECT_BINARY_DIR}/copyright-tetrahedralize)
# The form of Debian's copyright files: lines begin with a blank, and empty ones have a dot.
execute_process(COMMAND sed "s/^$/./;s/^/ /" ${PROJECT_SOURCE_DIR}/LICENSES/AGPL-3.0-or-later.txt OUTPUT_VARIABLE agpl
    COMMAND_ERROR_IS_FATAL ANY)
configure_file(packaging/copyright-tetrahedralize.in ${copyright_of_lamina-tetrahedralize} @ONLY)
configure_file(packaging/changelog.Debian.in ${PROJECT_BINARY_DIR}/changelog.Debian @ONLY)
packed_file(${PROJECT_BINARY_DIR}/changelog.Debian changelog.Debian debian_changelog)
packed_file(CHANGELOG.md changelog changelog)
foreach(component IN LISTS LAMINA_COMPONENTS)
    if(DEFINED copyright_of_${component})
        set(copyright_of ${copyright_of_${component}})
    else()
        set(copyright_of packaging/copyright)
    endif()
    install(FILES ${copyright_of} DESTINATION ${documents}/${component} RENAME copyright COMPONENT ${component})
    install(FILES ${debian_changelog} ${changelog} DESTINATION ${documents}/${component} COMPONENT ${component})
endforeach()
