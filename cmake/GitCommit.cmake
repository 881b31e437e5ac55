# SPDX-License-Identifier: Apache-2.0

# git_commit_header(TARGET): gives the target git_commit.h, which is written again at a build when
# the commit is another one. "unknown" outside of a repository.
function(git_commit_header target)
    set(header ${CMAKE_CURRENT_BINARY_DIR}/git_commit/git_commit.h)
    add_custom_target(${target}_git_commit
        COMMAND ${CMAKE_COMMAND} -D SOURCE=${PROJECT_SOURCE_DIR} -D OUTPUT=${header}
            -P ${PROJECT_SOURCE_DIR}/cmake/GitCommitScript.cmake
        BYPRODUCTS ${header}
        VERBATIM)
    add_dependencies(${target} ${target}_git_commit)
    target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/git_commit)
endfunction()
