// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "base/error.h"

namespace lamina {

// Returns the message of the Error that `action` throws; "" and a test failure if it throws none.
template <typename Action>
std::string error_of(const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    ADD_FAILURE() << "no Error was thrown";
    return {};
}

inline void expect_says(const std::string& message, std::initializer_list<std::string> parts) {
    for (const std::string& part : parts) {
        EXPECT_NE(message.find(part), std::string::npos)
            << "'" << part << "' is not in: " << message;
    }
}

// Expects an Error of one line that has all of `parts` in it.
template <typename Action>
void expect_error(const Action& action, std::initializer_list<std::string> parts) {
    const std::string message = error_of(action);
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    expect_says(message, parts);
}

}  // namespace lamina
