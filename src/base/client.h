// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

namespace lamina {

using WarningTaker = std::function<void(const std::string&)>;

// Reports something in a user's data that is no error and that no result shows: the text names the
// file, what was found and what was expected. It goes to the client that this thread works for.
// Safe from any thread; a taker is called in one thread at a time.
void warn(const std::string& text);

// Hears how far long work is. `report` gets a name ("slicing") and the share that is done, from 0
// to 1, from one thread at a time. If pieces of work are nested, only the outermost reports.
struct ProgressListener {
    std::function<void(const std::string&, double)> report;
    std::atomic<bool> busy{false};
};

// The one for whom a thread works: who may stop it, and who hears its warnings and progress. The
// client of a program is its user: signals request the stop (base/process.h), and the terminal
// shows warnings and, without a listener, progress. Warnings of a client without a taker are lost.
struct Client {
    std::stop_token stop;
    const WarningTaker* warnings = nullptr;
    ProgressListener* progress = nullptr;
    // The folder, by its canonical name, that data must be in (base/input_file.h); null: data may
    // be anywhere.
    std::shared_ptr<const std::filesystem::path> only_below = nullptr;
};

// Makes its thread, and the tasks of base/parallel.h that the thread starts, work for `client`
// while it exists. Scopes may be nested; the innermost counts.
class ClientScope {
  public:
    explicit ClientScope(Client client);
    ~ClientScope();
    ClientScope(const ClientScope&) = delete;
    ClientScope& operator=(const ClientScope&) = delete;

    // Returns this thread's client, or an empty one outside of all scopes.
    static const Client& current();

  private:
    Client before_;
};

// Returns `folder` in the form that Client::only_below has: by its canonical name, which stays
// valid if the program changes its folder; null if the name is empty. Fails with `key` if it is no
// folder.
std::shared_ptr<const std::filesystem::path> allowed_folder(const std::filesystem::path& folder,
                                                            const std::string& key = "only_below");

// Lets its thread open data only below `folder`, unless that is empty.
class OnlyBelowScope {
  public:
    explicit OnlyBelowScope(const std::filesystem::path& folder);

  private:
    ClientScope scope_;
};

// Lets its thread open files anywhere: lamina's own files, which no data name.
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
