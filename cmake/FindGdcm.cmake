# SPDX-License-Identifier: Apache-2.0
# Those libraries of GDCM that read images. Its own GDCMConfig.cmake names all of its libraries, VTK's too, which need
# not be there. Defines Gdcm::Gdcm.
include(FindPackageHandleStandardArgs)
find_path(Gdcm_INCLUDE_DIR gdcmImageReader.h PATH_SUFFIXES gdcm-3.0 gdcm-3.2)
foreach(part MSFF DICT DSED Common)
    find_library(Gdcm_${part}_LIBRARY gdcm${part})
    list(APPEND gdcm_libraries "${Gdcm_${part}_LIBRARY}")
endforeach()
find_package_handle_standard_args(Gdcm REQUIRED_VARS Gdcm_MSFF_LIBRARY Gdcm_DICT_LIBRARY Gdcm_DSED_LIBRARY
    Gdcm_Common_LIBRARY Gdcm_INCLUDE_DIR)
if(Gdcm_FOUND AND NOT TARGET Gdcm::Gdcm)
    add_library(Gdcm::Gdcm INTERFACE IMPORTED)
    set_target_properties(Gdcm::Gdcm PROPERTIES INTERFACE_LINK_LIBRARIES "${gdcm_libraries}"
        INTERFACE_INCLUDE_DIRECTORIES "${Gdcm_INCLUDE_DIR}")
endif()
