# SPDX-License-Identifier: Apache-2.0
# How every target of the project is made: one library a module, one test program a module.

include(CheckCXXSourceCompiles)

add_library(lamina_options INTERFACE)
target_compile_options(lamina_options INTERFACE -Wall -Wextra -Wpedantic -Wconversion
    # In a joined test a local name may be that of a helper in another file.
    $<IF:$<BOOL:$<TARGET_PROPERTY:LAMINA_SHADOW_LOCALS>>,$<$<CXX_COMPILER_ID:GNU>:-Wshadow=local>,-Wshadow>
    -Wno-sign-conversion -Wnon-virtual-dtor -Woverloaded-virtual
    -ffp-contract=off)
# -ffp-contract=off: the same expression must round in the same way wherever it is compiled.
target_compile_definitions(lamina_options INTERFACE GLM_FORCE_EXPLICIT_CTOR GLM_FORCE_SILENT_WARNINGS)
if(LAMINA_WARNINGS_AS_ERRORS)
    target_compile_options(lamina_options INTERFACE -Werror)
endif()
if(LAMINA_SANITIZE)
    target_compile_options(lamina_options INTERFACE -fsanitize=${LAMINA_SANITIZE}
        -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_link_options(lamina_options INTERFACE -fsanitize=${LAMINA_SANITIZE})
endif()

# Against what a hostile file might find: overwritten stacks and tables of functions, reads and writes past an array
# (which needs optimisation), places known beforehand. Not beside sanitizers, which look closer.
set(LAMINA_HARDENED OFF)
if(NOT LAMINA_SANITIZE AND CMAKE_BUILD_TYPE MATCHES "^(Release|RelWithDebInfo|MinSizeRel)$")
    set(LAMINA_HARDENED ON)
    target_compile_options(lamina_options INTERFACE -fstack-protector-strong)
    target_link_options(lamina_options INTERFACE $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-pie>
        -Wl,-z,relro,-z,now)
    # Where the distribution has chosen a level already, that stays.
    set(CMAKE_REQUIRED_FLAGS -O2)
    check_cxx_source_compiles("#ifdef _FORTIFY_SOURCE\n#error\n#endif\nint main() {}" LAMINA_NEEDS_FORTIFY)
    unset(CMAKE_REQUIRED_FLAGS)
    if(LAMINA_NEEDS_FORTIFY)
        target_compile_definitions(lamina_options INTERFACE _FORTIFY_SOURCE=2)
    endif()
endif()

# lamina_join_sources(TARGET): its sources are compiled eight at a time. Each of them alone spends most of its time on
# headers and templates that the others use too: joined, eight tests of the command line take a quarter of the
# processor time (docs/journal.md). Helpers of two files must not share a name then, although namespaces without names
# hide them. Debug builds compile each source alone: only so is an include missed that the file before it has.
function(lamina_join_sources target)
    if(NOT CMAKE_BUILD_TYPE STREQUAL Debug)
        set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    endif()
endfunction()

# lamina_cold(TARGET): its code runs once a command or a frame of a window, so that optimisation beyond -O1 costs the
# compiler more time than it will ever save.
function(lamina_cold target)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# lamina_module(NAME SOURCES ... VECTOR ... LINK modules and libraries ...): a folder in src or, of a program's own, in
# that program's folder. Files include what it has as "NAME/FILE.h". VECTOR: sources that include themselves for each
# instruction set, and are compiled each by itself.
function(lamina_module name)
    cmake_parse_arguments(MODULE "" "" "SOURCES;VECTOR;LINK" ${ARGN})
    add_library(lamina_${name} STATIC ${MODULE_SOURCES} ${MODULE_VECTOR})
    target_include_directories(lamina_${name} PUBLIC ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/include)
    cmake_path(GET CMAKE_CURRENT_SOURCE_DIR PARENT_PATH beside)
    target_include_directories(lamina_${name} PUBLIC ${beside})
    target_link_libraries(lamina_${name} PUBLIC lamina_options ${MODULE_LINK})
    lamina_join_sources(lamina_${name})
    if(MODULE_VECTOR)
        set_source_files_properties(${MODULE_VECTOR} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
        lamina_vector_module(${name})
    endif()
endfunction()

# lamina_test(NAME SOURCES ... ALONE ... LINK ...): the program test_NAME, registered test by test with CTest. ALONE:
# sources that are not joined with others.
function(lamina_test name)
    cmake_parse_arguments(TEST "" "" "SOURCES;ALONE;LINK" ${ARGN})
    add_executable(test_${name} ${TEST_SOURCES} ${TEST_ALONE})
    lamina_join_sources(test_${name})
    if(TEST_ALONE)
        set_source_files_properties(${TEST_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
    get_target_property(joined test_${name} UNITY_BUILD)
    set_target_properties(test_${name} PROPERTIES LAMINA_SHADOW_LOCALS ${joined})
    target_link_libraries(test_${name} PRIVATE ${TEST_LINK} GTest::gtest_main)
    target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    target_compile_definitions(test_${name} PRIVATE LAMINA_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    # Tests run in the library; with -O1 they are compiled in three quarters of the time. GCC 12 then warns of
    # bounds of strings that it has itself inlined.
    lamina_cold(test_${name})
    target_compile_options(test_${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds>)
    gtest_discover_tests(test_${name} TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 60
        PROPERTIES TIMEOUT 300)
endfunction()

# Code of this module computes with vectors (src/simd). The least of the instruction sets is taken for granted, so that
# there is no version without vectors.
function(lamina_vector_module name)
    target_link_libraries(lamina_${name} PUBLIC hwy::hwy)
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
        target_compile_options(lamina_${name} PUBLIC -msse4.2)
        target_compile_definitions(lamina_${name} PUBLIC HWY_DISABLE_PCLMUL_AES)
    elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
        # Vectors are members of classes, which those of SVE cannot be.
        target_compile_definitions(lamina_${name} PUBLIC
            "HWY_DISABLED_TARGETS=(HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128)")
    endif()
endfunction()
