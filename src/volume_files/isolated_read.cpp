// SPDX-License-Identifier: Apache-2.0
#include "volume_files/isolated_read.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <optional>

#include "base/client.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/warning.h"

namespace lamina {
namespace {

constexpr rlim_t seconds_for_headers = 5;

// What the other process sends: one of these letters, a length, and so many bytes.
enum Message : char { warning = 'W', refusal = 'E', result = 'R' };

// Of fixed size, between processes of one program.
struct ResultHead {
    Grid grid;
    ValueType type;
    double scale, offset;
    std::size_t bytes;  // of the samples
};

int shared_file = -1;  // in the process of its own: what its samples are in

std::shared_ptr<void> mapped(int file, std::size_t bytes) {
    void* const memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    return {memory, [bytes](void* mapping) { munmap(mapping, bytes); }};
}

// In the process of its own: writes all or ends it.
void send_all(int to, const void* bytes, std::size_t count) {
    const char* at = static_cast<const char*>(bytes);
    while (count > 0) {
        const ssize_t sent = write(to, at, count);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) _exit(1);  // nobody listens any more
        at += sent;
        count -= static_cast<std::size_t>(sent);
    }
}

void send_message(int to, char kind, const void* bytes, std::size_t count) {
    send_all(to, &kind, 1);
    send_all(to, &count, sizeof count);
    send_all(to, bytes, count);
}

void send_text(int to, char kind, const std::string& text) {
    send_message(to, kind, text.data(), text.size());
}

[[noreturn]] void run_child(int to, int samples, const std::string& too_much,
                            const std::function<ReadSamples()>& read) {
    shared_file = samples;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    // A terminal interrupts both processes: the other one hears of it, and ends this one.
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) signal(number, SIG_IGN);
    for (const int number : {SIGPIPE, SIGABRT}) signal(number, SIG_DFL);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    allow_bytes(0);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup2(nowhere, STDERR_FILENO);  // what libraries print of their assertions
    const WarningTaker taker = [&](const std::string& text) { send_text(to, warning, text); };
    try {
        const ClientScope scope({{}, &taker, nullptr});
        const ReadSamples found = read();
        const ResultHead head{
            found.grid, found.samples.type, found.samples.scale, found.samples.offset,
            static_cast<std::size_t>(found.grid.sample_count()) * bytes_of(found.samples.type)};
        send_message(to, result, &head, sizeof head);
    } catch (const std::bad_alloc&) {
        send_text(to, refusal, too_much);
    } catch (const std::exception& error) {
        send_text(to, refusal, error.what());
    }
    _exit(0);
}

// The process that reads, and what it sends.
class Child {
  public:
    Child(std::string name, const char* library, const std::function<ReadSamples()>& read)
        : name_(std::move(name)), library_(library) {
        int ends[2] = {-1, -1};
        if (pipe2(ends, O_CLOEXEC) != 0)
            fail("{}: cannot be read: no pipe: {}", name_, std::strerror(errno));
        samples_ = memfd_create("samples", MFD_CLOEXEC);
        process_ = samples_ < 0 ? -1 : fork();
        if (process_ == 0) {
            close(ends[0]);
            run_child(ends[1], samples_,
                      name_ + ": damaged, or memory is short: " + library +
                          " asks for far more than the samples take",
                      read);
        }
        const int reason = errno;
        close(ends[1]);
        from_ = ends[0];
        if (process_ > 0) return;
        close_files();
        errno = reason;
        fail("{}: cannot be read: no process: {}", name_, std::strerror(errno));
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        close_files();
        if (!ended_) {
            kill(process_, SIGKILL);
            wait_for();
        }
    }

    ReadSamples receive() {
        for (char kind = 0; receive_all(&kind, 1);) {
            std::size_t count = 0;
            expect_all(&count, sizeof count);
            if (kind == result) {
                ResultHead head;
                expect_all(&head, sizeof head);
                return {head.grid,
                        {name_, head.type, mapped(samples_, head.bytes), head.scale, head.offset}};
            }
            constexpr std::size_t most_text = 1 << 16;
            std::string text(std::min(count, most_text), '\0');
            expect_all(text.data(), text.size());
            if (kind == refusal) throw Error(text);
            warn(text);
        }
        fail_as_ended();
    }

  private:
    void close_files() {
        close(from_);
        if (samples_ >= 0) close(samples_);
    }

    // False at the end.
    bool receive_all(void* bytes, std::size_t count) {
        char* at = static_cast<char*>(bytes);
        while (count > 0) {
            pollfd waiting{from_, POLLIN, 0};
            constexpr int milliseconds = 100;  // between looks for a requested stop
            if (poll(&waiting, 1, milliseconds) <= 0) {
                check_interrupt();
                continue;
            }
            const ssize_t got = read(from_, at, std::min<std::size_t>(count, 1 << 26));
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) return false;
            at += got;
            count -= static_cast<std::size_t>(got);
            check_interrupt();
        }
        return true;
    }

    void expect_all(void* bytes, std::size_t count) {
        if (!receive_all(bytes, count)) fail_as_ended();
    }

    int wait_for() {
        int status = 0;
        while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
        }
        ended_ = true;
        return status;
    }

    [[noreturn]] void fail_as_ended() {
        const int status = wait_for();
        if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
            fail("{}: damaged: {} does not come to an end with it", name_, library_);
        fail("{}: damaged: {} ended with signal {} ({})", name_, library_,
             WIFSIGNALED(status) ? WTERMSIG(status) : 0,
             WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : "none");
    }

    std::string name_;
    const char* library_;
    pid_t process_ = -1;
    int from_ = -1, samples_ = -1;
    bool ended_ = false;
};

// A few seconds, and what so many bytes take.
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

// Address space beside what there is: for headers, and for copies of the bytes: the samples, what
// is packed, and what a library holds while it unpacks. Sanitizers reserve more than any limit.
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

}  // namespace

void allow_bytes(std::size_t bytes) {
    allow_time(bytes);
    allow_memory(bytes);
}

std::shared_ptr<void> shared_sample_memory(std::size_t bytes) {
    if (ftruncate(shared_file, static_cast<off_t>(bytes)) != 0) throw std::bad_alloc();
    return mapped(shared_file, bytes);
}

ReadSamples read_isolated(const std::string& name, const char* library,
                          const std::function<ReadSamples()>& read) {
    return Child(name, library, read).receive();
}

}  // namespace lamina
