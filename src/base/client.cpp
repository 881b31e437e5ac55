// SPDX-License-Identifier: Apache-2.0
#include "base/client.h"

#include <unistd.h>
#include <algorithm>
#include <mutex>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/process.h"

namespace lamina {

void warn(const std::string& text) {
    static std::mutex one_at_a_time;
    const WarningTaker* const taker = ClientScope::current().warnings;
    if (taker == nullptr || !*taker) return;
    const std::lock_guard lock(one_at_a_time);
    (*taker)(text);
}

namespace {

thread_local Client client_of_thread;

// Returns this thread's client, limited to data below `folder`; not limited if it is null.
Client allowed_below(std::shared_ptr<const std::filesystem::path> folder) {
    Client client = client_of_thread;
    client.only_below = std::move(folder);
    return client;
}

// Least time between two drawings on the terminal, and between two reports to a listener.
constexpr double redraw_seconds = 0.5, report_seconds = 0.05;
bool quiet_process = false;
std::atomic<bool> one_is_shown{false};

// Clears a flag at the end of its scope.
struct FlagRelease {
    std::atomic_flag& flag;
    ~FlagRelease() { flag.clear(); }
};

}  // namespace

ClientScope::ClientScope(Client client)
    : before_(std::exchange(client_of_thread, std::move(client))) {}

ClientScope::~ClientScope() {
    client_of_thread = std::move(before_);
}

const Client& ClientScope::current() {
    return client_of_thread;
}

std::shared_ptr<const std::filesystem::path> allowed_folder(const std::filesystem::path& folder,
                                                            const std::string& key) {
    if (folder.empty()) return nullptr;
    std::error_code unreadable;
    auto name = std::filesystem::canonical(folder, unreadable);
    if (unreadable || !std::filesystem::is_directory(name, unreadable))
        fail("{}: found {}, expected a folder", key, shortened(folder.string()));
    return std::make_shared<const std::filesystem::path>(std::move(name));
}

OnlyBelowScope::OnlyBelowScope(const std::filesystem::path& folder)
    : ClientScope(
          allowed_below(folder.empty() ? client_of_thread.only_below : allowed_folder(folder))) {}

OwnFilesScope::OwnFilesScope() : ClientScope(allowed_below(nullptr)) {}

void check_interrupt() {
    if (ClientScope::current().stop.stop_requested()) throw Interrupted();
}

Progress::Progress(std::string label, std::int64_t total)
    : listener_(ClientScope::current().progress),
      label_(std::move(label)),
      total_(std::max<std::int64_t>(total, 1)),
      visible_(begin()) {}

Progress::~Progress() {
    if (visible_) (listener_ != nullptr ? listener_->busy : one_is_shown) = false;
    if (drawn_ && listener_ == nullptr) replace_line("");
}

// Returns false if nobody listens, or if a Progress around this one reports already.
bool Progress::begin() {
    if (listener_ != nullptr) return listener_->report && !listener_->busy.exchange(true);
    return !quiet_process && isatty(STDERR_FILENO) != 0 && !one_is_shown.exchange(true);
}

void Progress::set_quiet(bool quiet) {
    quiet_process = quiet;
}

bool Progress::is_quiet() {
    return quiet_process;
}

// One thread at a time draws. Others go on without waiting, because a listener may run tasks that
// call advance(). The drawing thread then checks for the end, which a listener must always hear.
void Progress::advance(std::int64_t steps) {
    done_ += steps;
    if (!visible_) return;
    const double pause = listener_ != nullptr ? report_seconds : redraw_seconds;
    const auto ends = [&] { return listener_ != nullptr && done_ >= total_ && !ended_; };
    do {
        if (drawing_.test_and_set()) return;
        const FlagRelease release{drawing_};
        const bool last = ends();
        if (ended_ || (!last && watch_.seconds() - last_drawn_ < pause)) continue;
        ended_ = last;
        last_drawn_ = watch_.seconds();
        draw(done_);
    } while (ends());
}

void Progress::draw(std::int64_t done) {
    drawn_ = true;
    const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(total_));
    if (listener_ != nullptr) return listener_->report(label_, share);
    const double left = share > 0 ? last_drawn_ * (1 - share) / share : 0;
    replace_line(fmt::format("{} {:3.0f} %, {:.0f} s left", label_, 100 * share, left));
}

}  // namespace lamina
