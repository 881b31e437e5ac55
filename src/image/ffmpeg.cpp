// SPDX-License-Identifier: Apache-2.0
#include "image/ffmpeg.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <sstream>
#include <thread>

#include "base/client.h"
#include "base/error.h"
#include "base/process.h"

namespace lamina {
namespace {

constexpr int first_file = 3;  // descriptor of the first file that ffmpeg gets

std::string text_in(const TemporaryFile& file) {
    std::string text;
    std::array<char, 4096> block{};
    std::rewind(file.stream());
    while (const std::size_t count = std::fread(block.data(), 1, block.size(), file.stream()))
        text.append(block.data(), count);
    return text;
}

// Returns the last line that says something.
std::string last_line(const std::string& text) {
    std::istringstream lines(text);
    std::string last;
    for (std::string line; std::getline(lines, line);) {
        if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
    }
    constexpr std::size_t most = 200;
    return shortened(one_line(last), most);
}

std::string outcome_of(int status) {
    return WIFSIGNALED(status) ? fmt::format("ended by signal {}", WTERMSIG(status))
                               : fmt::format("exit code {}", WEXITSTATUS(status));
}

// Copies of descriptors above those that the child sets, so that setting one overwrites no other.
class HighCopies {
  public:
    explicit HighCopies(const std::vector<int>& files) {
        for (const int file : files) {
            constexpr int above = 20;
            copies_.push_back(fcntl(file, F_DUPFD_CLOEXEC, above));
        }
    }
    ~HighCopies() {
        for (const int copy : copies_) close(copy);
    }
    HighCopies(const HighCopies&) = delete;
    HighCopies& operator=(const HighCopies&) = delete;

    const std::vector<int>& all() const { return copies_; }

  private:
    std::vector<int> copies_;
};

}  // namespace

std::filesystem::path require_ffmpeg(const std::string& output, const std::string& encoder) {
    const auto program = find_program("ffmpeg");
    if (!program) {
        fail(
            "{}: found no program ffmpeg in PATH, which makes films: expected it (on Debian and "
            "Ubuntu: apt install ffmpeg), or a film.apng, which needs none",
            output);
    }
    const TemporaryFile listed;
    Ffmpeg ffmpeg(*program, {"-v", "error", "-encoders"}, {}, listed.stream());
    ffmpeg.finish();
    std::istringstream words(text_in(listed));
    for (std::string word; words >> word;)
        if (word == encoder) return *program;
    fail("{}: {} has no encoder {}: expected an ffmpeg with it, or a film.apng, which needs none",
         output, program->string(), encoder);
}

Ffmpeg::Ffmpeg(const std::filesystem::path& program, const std::vector<std::string>& arguments,
               const std::vector<int>& files, std::FILE* out) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) fail("cannot make a pipe: {}", std::strerror(errno));
    input_ = ends[1];
    // A write never waits for a program that has stopped reading.
    fcntl(input_, F_SETFL, O_NONBLOCK);
    try {
        start(program, arguments, files, ends[0], out);
    } catch (...) {
        close(ends[0]);
        close_input();
        throw;
    }
    close(ends[0]);
}

void Ffmpeg::start(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                   const std::vector<int>& files, int in, std::FILE* out) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const HighCopies copies(files);
    posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
    if (out == nullptr)
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    else
        posix_spawn_file_actions_adddup2(&actions, fileno(out), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(messages_.stream()), STDERR_FILENO);
    for (std::size_t i = 0; i < files.size(); ++i)
        posix_spawn_file_actions_adddup2(&actions, copies.all()[i],
                                         first_file + static_cast<int>(i));
    // In a group of its own it does not get the terminal's Ctrl-C: this process ends it.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    std::vector<std::string> words{program.string(), "-nostdin", "-hide_banner", "-y"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const int failure =
        posix_spawn(&id_, program.c_str(), &actions, &attributes, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (failure != 0) {
        id_ = -1;
        fail("{}: cannot be started: {}", program.string(), std::strerror(failure));
    }
}

Ffmpeg::~Ffmpeg() {
    close_input();
    if (id_ < 0) return;
    kill(id_, SIGKILL);
    while (waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
    }
}

void Ffmpeg::close_input() {
    if (input_ >= 0) close(input_);
    input_ = -1;
}

void Ffmpeg::write(std::string_view bytes) {
    while (!bytes.empty()) {
        check_interrupt();
        const ssize_t written = ::write(input_, bytes.data(), bytes.size());
        if (written >= 0) {
            bytes.remove_prefix(static_cast<std::size_t>(written));
        } else if (errno == EAGAIN) {
            constexpr int milliseconds = 100;  // until an interrupt is seen
            pollfd room{input_, POLLOUT, 0};
            poll(&room, 1, milliseconds);
        } else if (errno != EINTR) {
            finish();
            fail("ffmpeg ended before it had read all frames");
        }
    }
}

void Ffmpeg::finish() {
    using namespace std::chrono_literals;
    close_input();
    for (;;) {
        int status = 0;
        const pid_t ended = waitpid(id_, &status, WNOHANG);
        if (ended == id_) {
            id_ = -1;
            if (status == 0) return;
            const std::string said = last_line(text_in(messages_));
            fail("ffmpeg failed ({}){}{}", outcome_of(status), said.empty() ? "" : ": ", said);
        }
        if (ended < 0 && errno != EINTR) fail("waitpid: {}", std::strerror(errno));
        check_interrupt();
        std::this_thread::sleep_for(5ms);
    }
}

}  // namespace lamina
