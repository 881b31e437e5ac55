# SPDX-License-Identifier: Apache-2.0

# git_commit_source(TARGET): gives the target a source that defines `const char* const git_commit`, which is written again
# at a build when the commit is another one. "unknown" outside of a repository. A source and no header, so that a commit
# compiles nothing else again.
function(git_commit_source target)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/git_commit/git_commit.cpp)
    add_custom_target(${target}_git_commit
        COMMAND ${CMAKE_COMMAND} -D SOURCE=${PROJECT_SOURCE_DIR} -D OUTPUT=${source}
            -P ${PROJECT_SOURCE_DIR}/cmake/GitCommitScript.cmake
        BYPRODUCTS ${source}
        VERBATIM)
    add_dependencies(${target} ${target}_git_commit)
    set_source_files_properties(${source} PROPERTIES GENERATED ON SKIP_UNITY_BUILD_INCLUSION ON)
    target_sources(${target} PRIVATE ${source})
endfunction()
