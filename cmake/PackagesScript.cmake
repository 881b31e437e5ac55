# SPDX-License-Identifier: Apache-2.0
# Run by cpack before packages are made: the library is where the system looks, so programs need not say where it is.
file(GLOB_RECURSE programs "${CPACK_TEMPORARY_DIRECTORY}/*/usr/bin/*" "${CPACK_TEMPORARY_DIRECTORY}/*/_lamina*.so")
foreach(program IN LISTS programs)
    file(RPATH_REMOVE FILE ${program})
endforeach()
