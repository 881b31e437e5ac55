// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "base/profile.h"

namespace lamina {

using WarningTaker = std::function<void(const std::string&)>;

// Reports something in a user's data that is no error, to the client that this thread works for:
// the text names the file, what was found and what was expected. Safe from any thread.
void warn(const std::string& text);

// Hears how far long work is. `report` gets a name ("slicing") and the share that is done, from 0
// to 1, from one thread at a time. If pieces of work are nested, only the outermost reports.
struct ProgressListener {
    std::function<void(const std::string&, double)> report;
    std::atomic<bool> busy{false};
};

// The one for whom a thread works. A program's is its user: signals request the stop
// (base/process.h), and the terminal shows warnings and progress. Without a taker warnings are
// lost.
struct Client {
    std::stop_token stop;
    const WarningTaker* warnings = nullptr;
    ProgressListener* progress = nullptr;
    // Canonical name of the folder that data must be in (base/input_file.h); null: anywhere.
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

// Returns `folder` by its canonical name, which stays valid if the program changes its folder; null
// if the name is empty. Fails with `key` if it is no folder.
std::shared_ptr<const std::filesystem::path> allowed_folder(const std::filesystem::path& folder,
                                                            const std::string& key = "only_below");

// Lets its thread open data only below `folder`, unless that is empty.
class OnlyBelowScope : public ClientScope {
  public:
    explicit OnlyBelowScope(const std::filesystem::path& folder);
};

// Lets its thread open files anywhere: lamina's own files, which no data name.
class OwnFilesScope : public ClientScope {
  public:
    OwnFilesScope();
};

// Throws Interrupted once this thread's client has requested a stop: the caller of a library's
// function, or a signal (base/process.h). Long loops call it; safe from any thread.
void check_interrupt();

// A line on stderr with the share done and the time left, on terminals alone, drawn at most twice a
// second and wiped at the end. If several exist, only the first is drawn, that of the whole work. A
// client that listens is told some 20 times a second and at the end.
class Progress {
  public:
    Progress(std::string label, std::int64_t total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void advance(std::int64_t steps = 1);  // safe from any thread

    static void set_quiet(bool quiet);  // for the whole process (--quiet)
    static bool is_quiet();

  private:
    void draw(std::int64_t done);
    bool begin();

    ProgressListener* listener_;  // null: the terminal
    std::string label_;
    std::int64_t total_;
    bool visible_;
    std::atomic<std::int64_t> done_{0};
    std::atomic_flag drawing_;        // set while a thread draws
    std::atomic<bool> ended_{false};  // true once a listener has heard the end
    double last_drawn_ = 0;
    bool drawn_ = false;
    Stopwatch watch_;
};

}  // namespace lamina
