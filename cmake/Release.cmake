# SPDX-License-Identifier: Apache-2.0
# What packages say about themselves: their components, who made them, and when.
# The default is a placeholder, an address that cannot exist: whoever publishes packages gives their own (README.md).
set(LAMINA_CONTACT "The lamina developers <lamina@localhost.invalid>" CACHE STRING
    "Maintainer of the packages, \"Name <address>\"; reports of faults go there")
set(LAMINA_PACKAGE_RELEASE 1)
set(LAMINA_COMPONENTS lamina lamina-dev)
foreach(target IN ITEMS lamina-view lamina-tetrahedralize)
    if(TARGET ${target})
        list(APPEND LAMINA_COMPONENTS ${target})
    endif()
endforeach()
if(TARGET lamina_python)
    list(APPEND LAMINA_COMPONENTS python3-lamina)
endif()

# The date of the commit, so that one commit gives the same packages; outside of a repository today's.
execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} log -1 --format=%cD OUTPUT_VARIABLE LAMINA_RELEASE_MAIL_DATE
    ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT LAMINA_RELEASE_MAIL_DATE)
    execute_process(COMMAND date -R OUTPUT_VARIABLE LAMINA_RELEASE_MAIL_DATE OUTPUT_STRIP_TRAILING_WHITESPACE)
endif()
