// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

namespace lamina {

struct ProgramResult {
    int exit_code = 0;  // minus the signal's number when a signal ended the program
    std::string out;
    std::string err;
};

inline std::string text_of(std::FILE* file) {
    std::string text;
    char block[4096];
    std::rewind(file);
    while (const std::size_t count = std::fread(block, 1, sizeof block, file)) {
        text.append(block, count);
    }
    std::fclose(file);
    return text;
}

// Runs the program arguments[0] (looked for in PATH) with an empty stdin, waits for its end, and
// keeps what it wrote. Exit code 127: the program could not be started.
inline ProgramResult run_program(const std::vector<std::string>& arguments) {
    std::vector<char*> argv;
    for (const std::string& argument : arguments)
        argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    std::FILE* const out = std::tmpfile();
    std::FILE* const err = std::tmpfile();
    if (out == nullptr || err == nullptr) throw std::runtime_error("tmpfile failed");
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("fork failed");
    if (child == 0) {
        dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
        dup2(fileno(out), STDOUT_FILENO);
        dup2(fileno(err), STDERR_FILENO);
        execvp(argv[0], argv.data());
        _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    const int exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    return {exit_code, text_of(out), text_of(err)};
}

}  // namespace lamina
