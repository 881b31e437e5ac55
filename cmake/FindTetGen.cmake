# SPDX-License-Identifier: Apache-2.0
# TetGen (AGPL-3.0-or-later): it ships no CMake package. Defines TetGen::TetGen.
include(FindPackageHandleStandardArgs)
find_path(TetGen_INCLUDE_DIR tetgen.h)
find_library(TetGen_LIBRARY NAMES tet tetgen)
find_package_handle_standard_args(TetGen REQUIRED_VARS TetGen_LIBRARY TetGen_INCLUDE_DIR)
if(TetGen_FOUND AND NOT TARGET TetGen::TetGen)
    add_library(TetGen::TetGen UNKNOWN IMPORTED)
    set_target_properties(TetGen::TetGen PROPERTIES IMPORTED_LOCATION "${TetGen_LIBRARY}"
        INTERFACE_COMPILE_DEFINITIONS TETLIBRARY
        INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${TetGen_INCLUDE_DIR}")
endif()
