# SPDX-License-Identifier: Apache-2.0
# teem's NRRD reader. Debian's own TeemConfig.cmake is found and then fails to link, hence this. Defines teem::teem.
include(FindPackageHandleStandardArgs)
find_path(TeemNrrd_INCLUDE_DIR teem/nrrd.h)
find_library(TeemNrrd_LIBRARY teem)
find_package_handle_standard_args(TeemNrrd REQUIRED_VARS TeemNrrd_LIBRARY TeemNrrd_INCLUDE_DIR)
if(TeemNrrd_FOUND AND NOT TARGET teem::teem)
    add_library(teem::teem UNKNOWN IMPORTED)
    set_target_properties(teem::teem PROPERTIES IMPORTED_LOCATION "${TeemNrrd_LIBRARY}"
        INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${TeemNrrd_INCLUDE_DIR}")
endif()
