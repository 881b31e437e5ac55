# SPDX-License-Identifier: Apache-2.0
# libcerf (erfcx, dawson): Debian ships no CMake package for it. Defines cerf::cerf.
include(FindPackageHandleStandardArgs)
find_path(Cerf_INCLUDE_DIR cerf.h)
find_library(Cerf_LIBRARY cerf)
find_package_handle_standard_args(Cerf REQUIRED_VARS Cerf_LIBRARY Cerf_INCLUDE_DIR)
if(Cerf_FOUND AND NOT TARGET cerf::cerf)
    add_library(cerf::cerf UNKNOWN IMPORTED)
    set_target_properties(cerf::cerf PROPERTIES IMPORTED_LOCATION "${Cerf_LIBRARY}"
        INTERFACE_INCLUDE_DIRECTORIES "${Cerf_INCLUDE_DIR}")
endif()
