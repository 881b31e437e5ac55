// SPDX-License-Identifier: Apache-2.0
#include "volume_files/isolated_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <fstream>
#include <mutex>
#include <new>
#include <vector>

#include "base/client.h"
#include "base/error.h"

namespace lamina {
namespace {

constexpr rlim_t seconds_for_headers = 5;   // of processor time
constexpr std::size_t most_text = 1 << 16;  // bytes of a warning or refusal

// Kinds of messages from the isolated process; the length (a std::size_t) follows the kind.
enum Message : char { warning = 'W', refusal = 'E', result = 'R' };

// Resizes the file that both processes share and maps it.
std::shared_ptr<void> mapped(int file, std::size_t bytes) {
    if (ftruncate(file, static_cast<off_t>(bytes)) != 0) throw std::bad_alloc();
    void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    return {memory, [bytes](void* mapping) { munmap(mapping, bytes); }};
}

bool send_all(int to, const void* bytes, std::size_t count) {
    const char* at = static_cast<const char*>(bytes);
    while (count > 0) {
        const ssize_t sent = send(to, at, count, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) return false;
        at += sent;
        count -= static_cast<std::size_t>(sent);
    }
    return true;
}

// Limits processor time, from now on, to that of headers and of decompressing `bytes` bytes.
void allow_time(std::size_t bytes) {
    constexpr std::size_t slowest = 1 << 20;  // bytes a second, decompressed
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    rlimit limit{};
    getrlimit(RLIMIT_CPU, &limit);
    limit.rlim_cur =
        std::min<rlim_t>(limit.rlim_max, static_cast<rlim_t>(used.ru_utime.tv_sec) +
                                             static_cast<rlim_t>(used.ru_stime.tv_sec) +
                                             seconds_for_headers + bytes / slowest);
    setrlimit(RLIMIT_CPU, &limit);
}

// Limits address space to its present size, 256 MiB for headers, and 4 * `bytes` for samples, their
// compressed form and a library's buffers. Does nothing with sanitizers, which exceed any limit.
void allow_memory([[maybe_unused]] std::size_t bytes) {
#ifndef LAMINA_SANITIZED
    constexpr std::size_t for_headers = std::size_t{256} << 20, copies = 4;
    std::size_t pages = 0;
    if (!(std::ifstream("/proc/self/statm") >> pages)) return;
    rlimit limit{};
    getrlimit(RLIMIT_AS, &limit);
    const rlim_t there = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, there + for_headers + copies * bytes);
    setrlimit(RLIMIT_AS, &limit);
#endif
}

// The isolated process's end of the line.
class OwnLine final : public IsolatedLine {
  public:
    OwnLine(int line, int memory, pid_t starter)
        : line_(line), memory_(memory), starter_(starter) {}

    // Looks every second if the starter still runs. The line alone does not show it: processes that
    // are started later for other files inherit the starter's end and keep it open.
    bool next(void* question, std::size_t count) override {
        constexpr int milliseconds = 1000;
        pollfd waiting{line_, POLLIN, 0};
        while (poll(&waiting, 1, milliseconds) <= 0)
            if (getppid() != starter_) return false;
        return recv(line_, question, count, MSG_WAITALL) == static_cast<ssize_t>(count);
    }

    void answer(const void* bytes, std::size_t count) override { message(result, bytes, count); }

    void allow_bytes(std::size_t bytes) override {
        allow_time(bytes);
        allow_memory(bytes);
    }

    std::shared_ptr<void> shared_memory(std::size_t bytes) override {
        return mapped(memory_, bytes);
    }

    // Sends a message. Ends this process if the starter does not receive it.
    void message(char kind, const void* bytes, std::size_t count) const {
        const bool heard = send_all(line_, &kind, 1) && send_all(line_, &count, sizeof count) &&
                           send_all(line_, bytes, count);
        if (!heard) _exit(1);
    }
    // Sends a warning or a refusal; names in damaged files may make it very long.
    void text(char kind, const std::string& text) const {
        message(kind, text.data(), std::min(text.size(), most_text));
    }

  private:
    int line_, memory_;
    pid_t starter_;
};

pid_t awaited_starter = -1;  // set in the isolated process

// Ends this process within a second of the starter's end, even if it waits for input that never
// comes. (PR_SET_PDEATHSIG would end it together with the thread that started it.)
void end_with_starter(pid_t starter) {
    awaited_starter = starter;
    struct sigaction action = {};
    action.sa_handler = [](int) {
        if (getppid() != awaited_starter) _exit(1);
    };
    action.sa_flags = SA_RESTART;
    sigaction(SIGALRM, &action, nullptr);
    const itimerval every_second{{1, 0}, {1, 0}};
    setitimer(ITIMER_REAL, &every_second, nullptr);
}

// Does the work in the isolated process, and exits. `too_much`: the message if memory runs out.
[[noreturn]] void run_isolated(OwnLine& line, const std::string& too_much,
                               const IsolatedProcess::Work& work) {
    // Ctrl-C in a terminal reaches both processes. The starter handles it, and ends this one.
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) signal(number, SIG_IGN);
    signal(SIGABRT, SIG_DFL);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    line.allow_bytes(0);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup2(nowhere, STDERR_FILENO);  // libraries print their assertions there
    const WarningTaker taker = [&](const std::string& text) { line.text(warning, text); };
    try {
        const ClientScope scope({{}, &taker, nullptr, ClientScope::current().only_below});
        work(line);
    } catch (const std::bad_alloc&) {
        line.text(refusal, too_much);
    } catch (const std::exception& error) {
        line.text(refusal, error_text(error));
    }
    _exit(0);
}

// Returns how many processes decode `items` pictures, `decoded` bytes in all.
std::size_t processes_for(std::size_t decoded, std::size_t items) {
    // Bytes that a process decodes in some 10 ms, beside which its start does not count.
    constexpr std::size_t least_bytes = std::size_t{4} << 20, most_processes = 16;
    const std::size_t allowed =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    const auto cores = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    return std::min({items, most_processes, 1 + decoded / least_bytes, allowed, cores});
}

}  // namespace

IsolatedProcess::IsolatedProcess(std::string name, const char* library, const Work& work)
    : name_(std::move(name)), library_(library) {
    // One at a time: a process forked meanwhile would inherit this one's line and keep it open.
    static std::mutex starting;
    const std::lock_guard lock(starting);
    int ends[2] = {-1, -1};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        fail("{}: cannot be read: no line to a process: {}", name_, std::strerror(errno));
    memory_ = memfd_create("samples", MFD_CLOEXEC);
    const pid_t starter = getpid();
    process_ = memory_ < 0 ? -1 : fork();
    if (process_ == 0) {
        close(ends[0]);
        end_with_starter(starter);
        OwnLine line(ends[1], memory_, starter);
        run_isolated(line,
                     name_ + ": damaged, or memory is short: " + library +
                         " asks for far more than the samples take",
                     work);
    }
    const int reason = errno;
    close(ends[1]);
    line_ = ends[0];
    if (process_ > 0) return;
    close(line_);
    if (memory_ >= 0) close(memory_);
    fail("{}: cannot be read: no process: {}", name_, std::strerror(reason));
}

IsolatedProcess::~IsolatedProcess() {
    close(line_);
    close(memory_);
    if (!ended_) {
        kill(process_, SIGKILL);
        wait_for();
    }
}

void IsolatedProcess::ask(const void* question, std::size_t count) {
    if (!send_all(line_, question, count)) fail_as_ended();
}

void IsolatedProcess::receive(void* bytes, std::size_t count) {
    for (char kind = 0; receive_all(&kind, 1);) {
        std::size_t length = 0;
        expect_all(&length, sizeof length);
        if (kind == result) {
            if (length == count) return expect_all(bytes, count);
            kill(process_, SIGKILL);  // the library has overwritten memory that is not its own
            fail_as_ended();
        }
        std::string text(std::min(length, most_text), '\0');
        expect_all(text.data(), text.size());
        if (kind == refusal) throw Error(text);
        warn(text);
    }
    fail_as_ended();
}

std::shared_ptr<void> IsolatedProcess::shared_memory(std::size_t bytes) {
    return mapped(memory_, bytes);
}

// Receives `count` bytes. Returns false if the process ends before it has sent them.
bool IsolatedProcess::receive_all(void* bytes, std::size_t count) {
    char* at = static_cast<char*>(bytes);
    while (count > 0) {
        pollfd waiting{line_, POLLIN, 0};
        constexpr int milliseconds = 100;  // between looks for a requested stop
        if (poll(&waiting, 1, milliseconds) <= 0) {
            check_interrupt();
            siginfo_t ended{};
            waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOHANG | WNOWAIT);
            if (ended.si_pid != 0 && poll(&waiting, 1, 0) == 0) return false;
            continue;
        }
        const ssize_t got = recv(line_, at, count, 0);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        at += got;
        count -= static_cast<std::size_t>(got);
        check_interrupt();
    }
    return true;
}

void IsolatedProcess::expect_all(void* bytes, std::size_t count) {
    if (!receive_all(bytes, count)) fail_as_ended();
}

// Waits for the end of the process and returns its status.
int IsolatedProcess::wait_for() {
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    ended_ = true;
    return status;
}

void IsolatedProcess::fail_as_ended() {
    if (ended_) fail("{}: cannot be read: {} has ended", name_, library_);
    const int status = wait_for();
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
        fail("{}: damaged: {} does not come to an end with it", name_, library_);
    fail("{}: damaged: {} ended with signal {} ({})", name_, library_,
         WIFSIGNALED(status) ? WTERMSIG(status) : 0,
         WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : "none");
}

std::shared_ptr<void> memory_for_processes(std::size_t bytes) {
    void* const memory =
        mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    return {memory, [bytes](void* mapping) { munmap(mapping, bytes); }};
}

std::shared_ptr<void> isolated_bytes(
    const std::string& name, const char* library, std::size_t bytes, std::size_t decoded,
    std::size_t largest, std::size_t items,
    const std::function<void(std::size_t, std::size_t, char*)>& fill) {
    constexpr char filled = 1;
    struct Part {
        std::size_t first, end;
    };
    const std::shared_ptr<void> memory = memory_for_processes(bytes);
    const std::size_t all = std::max(bytes, decoded);
    const auto work = [&](IsolatedLine& line) {
        Part part{};
        if (!line.next(&part, sizeof part)) return;
        const std::size_t count = part.end - part.first;
        line.allow_bytes(largest + (largest > all / count ? all : count * largest));
        fill(part.first, part.end, static_cast<char*>(memory.get()));
        line.answer(&filled, sizeof filled);
    };
    std::vector<std::unique_ptr<IsolatedProcess>> processes;
    for (const std::size_t wanted = processes_for(decoded, items); processes.size() < wanted;) {
        try {
            processes.push_back(std::make_unique<IsolatedProcess>(name, library, work));
        } catch (const Error&) {  // too many processes or files: fewer do the same
            if (processes.empty()) throw;
            break;
        }
    }
    const std::size_t count = processes.size();
    for (std::size_t i = 0; i < count; ++i) {
        const Part part{items * i / count, items * (i + 1) / count};
        processes[i]->ask(&part, sizeof part);
    }
    char answer = 0;
    for (const auto& process : processes) process->receive(&answer, sizeof answer);
    return memory;
}

}  // namespace lamina
