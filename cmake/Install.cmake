# SPDX-License-Identifier: Apache-2.0
# cmake --install: programs, the shared library, its headers and its CMake package.
include(CMakePackageConfigHelpers)

install(TARGETS lamina RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(TARGET lamina-tetrahedralize)
    install(TARGETS lamina-tetrahedralize RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(TARGETS lamina_shared EXPORT laminaTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/lamina DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/lamina)
install(EXPORT laminaTargets NAMESPACE lamina:: DESTINATION ${package})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/laminaConfig.cmake.in ${PROJECT_BINARY_DIR}/laminaConfig.cmake
    INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/laminaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/laminaConfig.cmake ${PROJECT_BINARY_DIR}/laminaConfigVersion.cmake
    DESTINATION ${package})
