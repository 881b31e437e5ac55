// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "base/profile.h"

namespace lamina {

using WarningTaker = std::function<void(const std::string&)>;

// Reports something in a user's data that is no error, to the client that this thread works for:
// the text names the file, what was found and what was expected. Safe from any thread.
void warn(const std::string& text);

// Formats a warning as fail() formats an error.
template <typename... Args>
void say(fmt::format_string<Args...> format, Args&&... args) {
    warn(fmt::format(format, std::forward<Args>(args)...));
}

// Receives the progress of long work: a name ("slicing") and the share done, 0 to 1, from one
// thread at a time. If Progress objects are nested, only the outermost reports.
struct ProgressListener {
    std::function<void(const std::string&, double)> report;
    std::atomic<bool> busy{false};
};

// The person or program for whom a thread works. If it is the user of a command, signals request
// the stop (base/process.h), and the terminal shows warnings and progress.
struct Client {
    std::stop_token stop;
    const WarningTaker* warnings = nullptr;  // null: warnings are lost
    ProgressListener* progress = nullptr;
    // Canonical name of the folder that data must be in (base/input_file.h); null: anywhere.
    std::shared_ptr<const std::filesystem::path> only_below = nullptr;
};

// Makes its thread, and tasks (base/parallel.h) started there, work for `client`; may be nested.
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

// Returns work(), and keeps copies of its warnings in `said`.
template <typename Work>
auto keep_warnings(std::vector<std::string>& said, const Work& work) {
    said.clear();
    Client client = ClientScope::current();
    const WarningTaker* const taker = client.warnings;
    const WarningTaker keeper = [&](const std::string& text) {
        said.push_back(text);
        if (taker != nullptr && *taker) (*taker)(text);
    };
    client.warnings = &keeper;
    const ClientScope scope(std::move(client));
    return work();
}

// Returns the canonical name of `folder`, which stays valid if the program changes its working
// directory; null if `folder` is empty. Throws Error, which begins with `key`, if it is no folder.
std::shared_ptr<const std::filesystem::path> allowed_folder(const std::filesystem::path& folder,
                                                            const std::string& key = "only_below");

// Lets its thread open data only below `folder`; if empty, what was allowed stays allowed.
class OnlyBelowScope : public ClientScope {
  public:
    explicit OnlyBelowScope(const std::filesystem::path& folder);
};

// Lets its thread open files anywhere: for lamina's own files, whose names do not come from data.
class OwnFilesScope : public ClientScope {
  public:
    OwnFilesScope();
};

// Throws Interrupted once a stop is requested from this thread's client, by the caller of a library
// function or by a signal (base/process.h). Long loops call it; safe from any thread.
void check_interrupt();

// Reports the progress of long work: to its client's listener some 20 times a second and at the end
// or, if stderr is a terminal, as a line with share done and remaining time, drawn at most twice a
// second and wiped at the end. Only the first Progress, about all of the work, is drawn.
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
