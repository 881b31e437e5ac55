// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <functional>
#include <memory>
#include <string>

#include "lamina/volume.h"
#include "volume_files/stored_samples.h"

namespace lamina {

// The line of an isolated process to the process that started it.
class IsolatedLine {
  public:
    // Takes the next question, of `count` bytes. Returns false when no more come.
    virtual bool next(void* question, std::size_t count) = 0;
    virtual void answer(const void* bytes, std::size_t count) = 0;
    // Allows the processor time and memory that so many bytes of samples take, beside those of
    // headers.
    virtual void allow_bytes(std::size_t bytes) = 0;
    // Returns memory that both processes see, of the size that was asked for last.
    virtual std::shared_ptr<void> shared_memory(std::size_t bytes) = 0;

  protected:
    ~IsolatedLine() = default;
};

// A process that works with `library`, which may crash at a damaged file, or never end: both become
// an Error here. Its warnings and its Error are passed on. The work must start no threads. The
// process ends with this object, with its work, and when the client requests a stop.
class IsolatedProcess {
  public:
    using Work = std::function<void(IsolatedLine&)>;

    // `name`: the file's, for messages.
    IsolatedProcess(std::string name, const char* library, const Work& work);
    ~IsolatedProcess();
    IsolatedProcess(const IsolatedProcess&) = delete;
    IsolatedProcess& operator=(const IsolatedProcess&) = delete;

    void ask(const void* question, std::size_t count);
    // Receives the next answer, which has `count` bytes. Throws Error.
    void receive(void* bytes, std::size_t count);
    // Returns memory that both processes see. The other one must no longer use what it had before.
    std::shared_ptr<void> shared_memory(std::size_t bytes);

  private:
    bool receive_all(void* bytes, std::size_t count);
    void expect_all(void* bytes, std::size_t count);
    int wait_for();
    [[noreturn]] void fail_as_ended();

    std::string name_;
    const char* library_;
    pid_t process_ = -1;
    int line_ = -1, memory_ = -1;
    bool ended_ = false;
};

// The grid and the samples that a reader has taken of a file.
struct ReadSamples {
    Grid grid;
    StoredSamples samples;
};

// Calls `read` in a process of its own. Its samples are in the line's shared_memory(). `name`: the
// file's, for messages. Throws Error.
ReadSamples read_isolated(const std::string& name, const char* library,
                          const std::function<ReadSamples(IsolatedLine&)>& read);

}  // namespace lamina
