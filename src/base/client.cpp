// SPDX-License-Identifier: Apache-2.0
#include "base/client.h"

#include <mutex>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/text.h"

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
    : scope_([&] {
          Client client = client_of_thread;
          if (!folder.empty()) client.only_below = allowed_folder(folder);
          return client;
      }()) {}

OwnFilesScope::OwnFilesScope()
    : scope_([] {
          Client client = client_of_thread;
          client.only_below = nullptr;
          return client;
      }()) {}

void check_interrupt() {
    if (ClientScope::current().stop.stop_requested()) throw Interrupted();
}

}  // namespace lamina
