# SPDX-License-Identifier: Apache-2.0
# cpack (tools/packages): a Debian package for each component.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME lamina)
set(CPACK_PACKAGE_VENDOR "The lamina developers")
set(CPACK_PACKAGE_CONTACT "${LAMINA_CONTACT}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL ${LAMINA_COMPONENTS})
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${LAMINA_PACKAGE_RELEASE})
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/src/library)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/PackagesScript.cmake)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# lamina_package(COMPONENT SUMMARY TEXT [DEPENDS text] [RECOMMENDS text] [SUGGESTS text] [SECTION name])
function(lamina_package component summary text)
    cmake_parse_arguments(PACKAGE "" "DEPENDS;RECOMMENDS;SUGGESTS;SECTION" "" ${ARGN})
    string(TOUPPER ${component} upper)
    foreach(variable IN ITEMS DEPENDS RECOMMENDS SUGGESTS SECTION)
        if(PACKAGE_${variable})
            set(CPACK_DEBIAN_${upper}_PACKAGE_${variable} "${PACKAGE_${variable}}" PARENT_SCOPE)
        endif()
    endforeach()
    set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${component} PARENT_SCOPE)
    set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
endfunction()

set(same_version "lamina (= ${PROJECT_VERSION}-${LAMINA_PACKAGE_RELEASE})")
lamina_package(lamina "volume renderer that says how wrong each picture is"
"Draws volumes (CT, microscopy, simulations) and tetrahedral meshes by
slicing and by projected tetrahedra, and holds every picture against a
reference tracer in double precision. This package has the program, its
library and shipped scenes."
    RECOMMENDS "libegl1, libegl-mesa0" SUGGESTS "ffmpeg, lamina-view, lamina-tetrahedralize, python3-lamina, libosmesa6")
lamina_package(lamina-dev "headers of the volume renderer lamina"
"Headers, CMake package and examples of lamina's library, for programs in
C++20."
    DEPENDS "${same_version}, libglm-dev" SECTION libdevel)
lamina_package(lamina-view "volume viewer that shows the error of what it draws"
"A window on volumes and tetrahedral meshes: transfer function, every
setting of a scene, two pictures held against each other, and the reference
tracer that replaces the picture by the truth."
    DEPENDS "${same_version}, fonts-dejavu-core, libgl1")
lamina_package(python3-lamina "volume renderer lamina as a Python module"
"A NumPy array in, a picture and its error out. VTK's pictures can be held
against the truth."
    DEPENDS "${same_version}, ${LAMINA_PYTHON_DEPENDS}, python3-numpy" SUGGESTS "python3-vtk9" SECTION python)
lamina_package(lamina-tetrahedralize "Delaunay tetrahedra for lamina (linked with TetGen)"
"The program that lamina starts to make adaptive tetrahedral meshes of
volumes. It is linked with TetGen and therefore, unlike the rest of lamina,
under the GNU Affero General Public License, version 3 or later."
    DEPENDS "${same_version}")

# Packages that are linked with the library depend on the very version that they were made with: the interface may change.
file(WRITE ${PROJECT_BINARY_DIR}/shlibs "liblamina ${PROJECT_VERSION_MAJOR} ${same_version}\n")
file(WRITE ${PROJECT_BINARY_DIR}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LAMINA_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/shlibs ${PROJECT_BINARY_DIR}/triggers)
include(CPack)
