// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace lamina {

struct ProgramResult {
    int exit_code = 0;  // minus the signal's number if a signal ended the program
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

// A running program, arguments[0] (searched in PATH), with an empty stdin. wait() must be called
// once. Exit code 127: it could not be started. `prepare`: called in the new process before the
// program starts, to set limits, environment or descriptors.
class StartedProgram {
  public:
    explicit StartedProgram(const std::vector<std::string>& arguments,
                            const std::function<void()>& prepare = {}) {
        std::vector<char*> argv;
        for (const std::string& argument : arguments)
            argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        if (out_ == nullptr || err_ == nullptr) throw std::runtime_error("tmpfile failed");
        child_ = fork();
        if (child_ < 0) throw std::runtime_error("fork failed");
        if (child_ == 0) {
            dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
            dup2(fileno(out_), STDOUT_FILENO);
            dup2(fileno(err_), STDERR_FILENO);
            // Signals act as in a terminal, also if the tests were started with other settings.
            for (const int signal : {SIGINT, SIGHUP, SIGPIPE, SIGXFSZ})
                std::signal(signal, SIG_DFL);
            if (prepare) prepare();
            execvp(argv[0], argv.data());
            _exit(127);
        }
    }
    StartedProgram(const StartedProgram&) = delete;
    StartedProgram& operator=(const StartedProgram&) = delete;

    pid_t id() const { return child_; }
    void send(int signal) const { kill(child_, signal); }

    bool has_ended() const {
        siginfo_t info{};
        waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT);
        return info.si_pid == child_;
    }

    // Waits for the end of the program, and returns its output.
    ProgramResult wait() {
        int status = 0;
        waitpid(child_, &status, 0);
        const int exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
        return {exit_code, text_of(out_), text_of(err_)};
    }

  private:
    std::FILE* out_ = std::tmpfile();
    std::FILE* err_ = std::tmpfile();
    pid_t child_ = -1;
};

}  // namespace lamina
