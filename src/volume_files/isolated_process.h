// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <functional>
#include <memory>
#include <string>

namespace lamina {

// Connects an isolated process to its starter, the process whose questions it answers.
class IsolatedLine {
  public:
    // Waits for the next question, of `count` bytes. Returns false when no more come.
    virtual bool next(void* question, std::size_t count) = 0;
    virtual void answer(const void* bytes, std::size_t count) = 0;
    // Raises the limits of time and memory to what headers and `bytes` bytes of samples need.
    virtual void allow_bytes(std::size_t bytes) = 0;
    // Maps memory that both processes share. Both ask for one size, and use no earlier mapping.
    virtual std::shared_ptr<void> shared_memory(std::size_t bytes) = 0;

  protected:
    ~IsolatedLine() = default;
};

// Runs a library that may crash or never return on a damaged file in another process. receive()
// then throws an Error; it also rethrows Errors of the work, and passes warnings on. The work must
// start no threads. The process ends with the work, with this object, or with its starter.
class IsolatedProcess {
  public:
    using Work = std::function<void(IsolatedLine&)>;

    // `name` (the file's) and `library`: for messages.
    IsolatedProcess(std::string name, const char* library, const Work& work);
    ~IsolatedProcess();
    IsolatedProcess(const IsolatedProcess&) = delete;
    IsolatedProcess& operator=(const IsolatedProcess&) = delete;

    // Sends a question. Throws Error if the process has ended.
    void ask(const void* question, std::size_t count);
    // Receives the next answer, which has `count` bytes. Throws Error.
    void receive(void* bytes, std::size_t count);
    // Returns memory that both processes see, as IsolatedLine::shared_memory() does.
    std::shared_ptr<void> shared_memory(std::size_t bytes);

  private:
    bool receive_all(void* bytes, std::size_t count);
    void expect_all(void* bytes, std::size_t count);
    int wait_for();
    [[noreturn]] void fail_as_ended();

    std::string name_;
    const char* library_;
    pid_t process_ = -1;
    int line_ = -1, memory_ = -1;  // descriptors of the socket to it, and of shared memory
    bool ended_ = false;
};

// Returns memory of zeros that this process shares with those that it starts later.
std::shared_ptr<void> memory_for_processes(std::size_t bytes);

// Calls fill(first, end, memory) in isolated processes, one for each core that oneTBB may use: each
// decodes its part of `items` pictures into its part of the `bytes` bytes of memory that are
// returned. If some cannot be started, the others share all items. `decoded` and `largest`: how
// many bytes the library decodes for all items, and for one at most. They bound the time and memory
// of each process by its own part and one item more. Few bytes take one process. Throws Error: that
// of the first part that has one.
std::shared_ptr<void> isolated_bytes(
    const std::string& name, const char* library, std::size_t bytes, std::size_t decoded,
    std::size_t largest, std::size_t items,
    const std::function<void(std::size_t, std::size_t, char*)>& fill);

}  // namespace lamina
