// SPDX-License-Identifier: Apache-2.0
#include "base/json_stdin.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "base/interrupt.h"
#include "base/json_text.h"

namespace lamina {
namespace {

constexpr int milliseconds_between_checks = 100;

// Waits until something can be read, or the other end is closed.
void wait_for_input() {
    for (;;) {
        check_interrupt();
        pollfd input{STDIN_FILENO, POLLIN, 0};
        const int ready = poll(&input, 1, milliseconds_between_checks);
        if (ready > 0 || (ready < 0 && errno != EINTR)) return;
    }
}

std::string text_of_stdin() {
    std::string text;
    std::array<char, 1 << 16> bytes{};
    for (;;) {
        wait_for_input();
        const ssize_t count = read(STDIN_FILENO, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail("cannot read: {}", std::strerror(errno));
        if (count == 0) return text;
        text.append(bytes.data(), static_cast<std::size_t>(count));
        if (text.size() > most_json_bytes)
            fail("found more than {} bytes, expected at most as many of JSON", most_json_bytes);
    }
}

}  // namespace

nlohmann::json load_json_from_stdin() {
    try {
        return parse_json(text_of_stdin());
    } catch (const Error& problem) {
        fail("{}: {}", stdin_name, problem.what());
    }
}

}  // namespace lamina
