// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "cli/run_program.h"

namespace lamina {

// The command that runs a program on `ranks` ranks, more than there are processors, too.
inline std::vector<std::string> on_ranks(int ranks, const std::vector<std::string>& program) {
    std::vector<std::string> command{
        MPIRUN, "--oversubscribe",    "--mca", "mpi_yield_when_idle", "1",
        "-n",   std::to_string(ranks)};
    command.insert(command.end(), program.begin(), program.end());
    return command;
}

// Containers run tests as root, which Open MPI does not do unless it is asked twice.
inline void allow_root() {
    setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
}

inline ProgramResult mpi_run(int ranks, const std::vector<std::string>& program) {
    return run_program(on_ranks(ranks, program), allow_root);
}

}  // namespace lamina
