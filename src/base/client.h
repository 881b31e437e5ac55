// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

namespace lamina {

// Something in a user's data that is no error and that no result shows: the text names the file,
// what was found and what was expected. It goes to the client that this thread works for
// (base/client.h). Safe from any thread; a taker is called in one thread at a time.
using WarningTaker = std::function<void(const std::string&)>;
void warn(const std::string& text);

// Hears how far long work is. `report` gets what is done ("slicing") and its share from 0 to 1,
// from one thread at a time. Of several pieces of work within each other only the outermost
// reports.
struct ProgressListener {
    std::function<void(const std::string&, double)> report;
    std::atomic<bool> busy{false};
};

// Whom a thread works for. The client of a program is its user: signals request the stop
// (base/process.h), and the terminal shows warnings and, without a listener, progress. Nobody
// hears warnings of a client without a taker.
struct Client {
    std::stop_token stop;
    const WarningTaker* warnings = nullptr;
    ProgressListener* progress = nullptr;
    // The folder that data must be in, by its canonical name (base/input_file.h): anywhere if null.
    std::shared_ptr<const std::filesystem::path> only_below = nullptr;
};

// While it is there, its thread, and the tasks of base/parallel.h that it starts, work for
// `client`. Of several scopes in one thread the last one counts.
class ClientScope {
  public:
    explicit ClientScope(Client client);
    ~ClientScope();
    ClientScope(const ClientScope&) = delete;
    ClientScope& operator=(const ClientScope&) = delete;

    // This thread's; an empty one where there is no scope.
    static const Client& current();

  private:
    Client before_;
};

// Gives `folder` as Client::only_below has it: by its canonical name, so that it stays the same one
// wherever the program works; null if the name is empty. Fails with `key` if it is no folder.
std::shared_ptr<const std::filesystem::path> allowed_folder(const std::filesystem::path& folder,
                                                            const std::string& key = "only_below");

// While it is there, its thread may open data below `folder` only, if that is not empty.
class OnlyBelowScope {
  public:
    explicit OnlyBelowScope(const std::filesystem::path& folder);

  private:
    ClientScope scope_;
};

// While it is there, its thread may open files anywhere: lamina's own, which no data name.
class OwnFilesScope {
  public:
    OwnFilesScope();

  private:
    ClientScope scope_;
};

// Throws Interrupted once the client that this thread works for (base/client.h) has requested a
// stop: the caller of a library's function, or a signal (base/process.h). Long loops call it;
// safe from any thread.
void check_interrupt();

}  // namespace lamina
