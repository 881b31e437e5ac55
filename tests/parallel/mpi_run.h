// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "cli/run_program.h"

namespace lamina {

// Returns the command that starts a program on `ranks` ranks, even if there are fewer processors.
inline std::vector<std::string> on_ranks(int ranks, const std::vector<std::string>& program) {
    std::vector<std::string> command{
        MPIRUN, "--oversubscribe",    "--mca", "mpi_yield_when_idle", "1",
        "-n",   std::to_string(ranks)};
    command.insert(command.end(), program.begin(), program.end());
    return command;
}

// Lets Open MPI run as root, as tests do in containers.
inline void allow_root() {
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
}

// Runs a program on several ranks. In rare cases Open MPI 4 reports a rank that ended well as
// "exiting improperly", because it sees the end before it sees MPI_Finalize (open-mpi/ompi issues
// 7833 and 9389). Then the program is run again, at most twice.
inline ProgramResult mpi_run(int ranks, const std::vector<std::string>& program) {
    for (int attempt = 0;; ++attempt) {
        ProgramResult result = run_program(on_ranks(ranks, program), allow_root);
        const bool in_doubt = result.exit_code == 1 &&
                              result.err.find("exiting improperly") != std::string::npos &&
                              result.err.find("lamina:") == std::string::npos;
        if (!in_doubt || attempt == 2) return result;
        std::fprintf(stderr, "Run again: %s\n", result.err.c_str());
    }
}

}  // namespace lamina
