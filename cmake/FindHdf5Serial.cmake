# SPDX-License-Identifier: Apache-2.0
# HDF5 without MPI, in C. CMake's own FindHDF5 compiles a C program to find it, and this project has no C compiler.
# Defines Hdf5Serial::Hdf5.
include(FindPackageHandleStandardArgs)
find_path(Hdf5Serial_INCLUDE_DIR hdf5_hl.h PATH_SUFFIXES hdf5/serial)
find_library(Hdf5Serial_LIBRARY NAMES hdf5 hdf5_serial PATH_SUFFIXES hdf5/serial)
find_library(Hdf5Serial_HL_LIBRARY NAMES hdf5_hl hdf5_serial_hl PATH_SUFFIXES hdf5/serial)
find_package_handle_standard_args(Hdf5Serial REQUIRED_VARS Hdf5Serial_LIBRARY Hdf5Serial_HL_LIBRARY
    Hdf5Serial_INCLUDE_DIR)
if(Hdf5Serial_FOUND AND NOT TARGET Hdf5Serial::Hdf5)
    add_library(Hdf5Serial::Hdf5 INTERFACE IMPORTED)
    set_target_properties(Hdf5Serial::Hdf5 PROPERTIES
        INTERFACE_LINK_LIBRARIES "${Hdf5Serial_HL_LIBRARY};${Hdf5Serial_LIBRARY}"
        INTERFACE_INCLUDE_DIRECTORIES "${Hdf5Serial_INCLUDE_DIR}")
endif()
