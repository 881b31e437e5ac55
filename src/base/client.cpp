// SPDX-License-Identifier: Apache-2.0
#include "base/client.h"

#include <utility>

namespace lamina {
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

OnlyBelowScope::OnlyBelowScope(const std::filesystem::path& folder)
    : scope_([&] {
          Client client = client_of_thread;
          if (!folder.empty()) client.only_below = &folder;
          return client;
      }()) {}

OwnFilesScope::OwnFilesScope()
    : scope_([] {
          Client client = client_of_thread;
          client.only_below = nullptr;
          return client;
      }()) {}

}  // namespace lamina
