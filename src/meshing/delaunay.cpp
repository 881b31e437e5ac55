// SPDX-License-Identifier: Apache-2.0
#include "meshing/delaunay.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <sstream>
#include <thread>

#include "base/client.h"
#include "base/error.h"
#include "base/output_file.h"
#include "base/process.h"
#include "meshing/tetrahedralize_protocol.h"

extern char** environ;

namespace lamina {
namespace {

void write_points(TemporaryFile& file, std::span<const glm::dvec3> points) {
    static_assert(sizeof(glm::dvec3) == sizeof(TetrahedralizePoint));
    const auto count = static_cast<TetrahedralizeCount>(points.size());
    file.write(&count, sizeof count);
    file.write(points.data(), points.size_bytes());
    file.rewind();
}

// Returns the last line that is not blank: why it failed, after TetGen's own messages.
std::string last_line(const std::string& text) {
    std::istringstream lines(text);
    std::string line, last;
    while (std::getline(lines, line)) {
        if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
    }
    return one_line(last);
}

// A pipe for the child's messages, which could not be written to a file if the disk is full.
class Messages {
  public:
    Messages() {
        if (pipe2(ends_, O_CLOEXEC) != 0) fail("cannot make a pipe: {}", std::strerror(errno));
        fcntl(ends_[0], F_SETFL, O_NONBLOCK);
    }
    ~Messages() {
        close(ends_[0]);
        close(ends_[1]);
    }
    Messages(const Messages&) = delete;
    Messages& operator=(const Messages&) = delete;

    int writing_end() const { return ends_[1]; }
    // Reads what has been written since the last call, without waiting for more.
    void collect() {
        char block[4096];
        for (ssize_t count; (count = read(ends_[0], block, sizeof block)) > 0;) {
            text_.append(block, static_cast<std::size_t>(count));
            if (text_.size() > 65536) text_.erase(0, text_.size() - 32768);
        }
    }
    const std::string& text() const { return text_; }

  private:
    int ends_[2] = {-1, -1};
    std::string text_;
};

bool is_ended_by_user(int status) {
    if (!WIFSIGNALED(status)) return false;
    const int signal = WTERMSIG(status);
    return signal == SIGINT || signal == SIGTERM || signal == SIGHUP;
}

// A running program. Ends with this object, and with this process (tetrahedralize_parent_option).
class Child {
  public:
    Child(const std::filesystem::path& program, std::FILE* in, std::FILE* out, int err) {
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, fileno(in), STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions, fileno(out), STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions, err, STDERR_FILENO);
        std::string name = program.string(), option = tetrahedralize_parent_option,
                    parent = std::to_string(getpid());
        char* const argv[] = {name.data(), option.data(), parent.data(), nullptr};
        const int failure = posix_spawn(&id_, name.c_str(), &actions, nullptr, argv, environ);
        posix_spawn_file_actions_destroy(&actions);
        if (failure != 0) {
            id_ = -1;
            fail("{}: cannot be started: {}", name, std::strerror(failure));
        }
    }
    ~Child() {
        if (id_ < 0) return;
        kill(id_, SIGKILL);
        while (waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
        }
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    // Waits until the program ends. Returns waitpid()'s status. Throws Interrupted.
    int wait(Messages& messages) {
        using namespace std::chrono_literals;
        for (std::chrono::microseconds pause = 200us;;
             pause = std::min<decltype(pause)>(2 * pause, 20ms)) {
            int status = 0;
            const pid_t ended = waitpid(id_, &status, WNOHANG);
            messages.collect();  // in each round: a full pipe would stop the child
            if (ended == id_) {
                id_ = -1;
                // Ctrl-C ends the child as well, which is no failure of its own. The child may end
                // before this process's signal has reached the stop token.
                if (is_ended_by_user(status)) std::this_thread::sleep_for(100ms);
                check_interrupt();
                return status;
            }
            if (ended < 0 && errno != EINTR) fail("waitpid: {}", std::strerror(errno));
            check_interrupt();
            std::this_thread::sleep_for(pause);
        }
    }

  private:
    pid_t id_ = -1;
};

std::string outcome_of(int status) {
    return WIFSIGNALED(status) ? fmt::format("ended by signal {}", WTERMSIG(status))
                               : fmt::format("exit code {}", WEXITSTATUS(status));
}

template <typename Element>
void read_list(std::FILE* file, std::vector<Element>& list, std::size_t count) {
    list.resize(count);
    if (std::fread(list.data(), sizeof(Element), count, file) != count) {
        fail("cannot read the answer of {}", tetrahedralize_program);
    }
}

DelaunayTets read_tets(std::FILE* file, std::size_t points) {
    std::fseek(file, 0, SEEK_END);
    const long length = std::ftell(file);
    std::rewind(file);
    TetrahedralizeCount count = 0;
    if (length < static_cast<long>(sizeof count) ||
        std::fread(&count, sizeof count, 1, file) != 1) {
        fail("{} gave no answer", tetrahedralize_program);
    }
    const std::int64_t present = (length - static_cast<long>(sizeof count)) /
                                 static_cast<long>(2 * sizeof(TetrahedralizeTet));
    if (count <= 0 || count != present) {
        fail("{} promised {} tets and gave {}", tetrahedralize_program, count, present);
    }
    DelaunayTets answer;
    read_list(file, answer.tets, static_cast<std::size_t>(count));
    read_list(file, answer.neighbors, static_cast<std::size_t>(count));
    const auto check = [](const auto& lists, std::int64_t first, std::int64_t end) {
        for (const auto& list : lists) {
            for (const std::int32_t index : list) {
                if (index < first || index >= end) {
                    fail("{}: index {} is out of range", tetrahedralize_program, index);
                }
            }
        }
    };
    check(answer.tets, 0, static_cast<std::int64_t>(points));
    check(answer.neighbors, -1, count);
    return answer;
}

}  // namespace

std::filesystem::path require_tetrahedralizer() {
    const auto program = find_program(tetrahedralize_program);
    if (!program) {
        fail(
            "{} is neither beside lamina nor in PATH: build lamina with TetGen (libtet1.5-dev, "
            "-DLAMINA_WITH_TETGEN=ON), or use --kuhn (mesh.kuhn), which needs none",
            tetrahedralize_program);
    }
    return *program;
}

DelaunayTets delaunay_by_process(const std::filesystem::path& program,
                                 std::span<const glm::dvec3> points) {
    TemporaryFile in, out;
    Messages messages;
    write_points(in, points);
    Child child(program, in.stream(), out.stream(), messages.writing_end());
    const int status = child.wait(messages);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        const std::string reason = last_line(messages.text());
        if (WIFEXITED(status) && WEXITSTATUS(status) == tetrahedralize_no_room) {
            fail(
                "{}: no room for the tetrahedra of {} points: {}: set TMPDIR to a folder with more",
                temporary_folder(), points.size(), reason);
        }
        fail("no tetrahedra from {} points: {} ({})", points.size(),
             reason.empty() ? tetrahedralize_program : reason, outcome_of(status));
    }
    return read_tets(out.stream(), points.size());
}

}  // namespace lamina
