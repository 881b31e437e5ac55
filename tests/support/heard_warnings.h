// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/client.h"

namespace lamina::test {

// While it exists, collects the warnings of its thread and of the tasks that the thread starts.
class HeardWarnings {
  public:
    HeardWarnings() : scope_(client()) {}

    std::vector<std::string> texts;
    std::string all() const {
        std::string joined;
        for (const std::string& text : texts) joined += text;
        return joined;
    }
    // Expects a warning with this part, and forgets all.
    void expect_said(const std::string& part) {
        EXPECT_NE(all().find(part), std::string::npos) << "'" << part << "' is not in: " << all();
        texts.clear();
    }

  private:
    Client client() {
        Client client = ClientScope::current();
        client.warnings = &taker_;
        return client;
    }

    WarningTaker taker_ = [this](const std::string& text) { texts.push_back(text); };
    ClientScope scope_;
};

}  // namespace lamina::test
