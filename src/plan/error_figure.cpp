// SPDX-License-Identifier: Apache-2.0
#include "lamina/error_figure.h"

#include <fmt/format.h>

#include "base/enum_words.h"

namespace lamina {

const char* name_of(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::unknown:
            return "unknown";
        case ErrorKind::derived:
            return "derived";
        case ErrorKind::trials:
            return "trials";
        case ErrorKind::sampled:
            return "sampled";
    }
    unreachable_enum();
}

std::string text_of(const ErrorFigure& error) {
    switch (error.kind) {
        case ErrorKind::unknown:
            return "unknown";
        case ErrorKind::derived:
            return fmt::format("at most {:.3g} / 255", error.value);
        case ErrorKind::trials:
            return fmt::format("{:.3g} / 255 by trials on {} rays", error.value, error.rays);
        case ErrorKind::sampled:
            return fmt::format("{:.3g} / 255, sampled on {} rays", error.value, error.rays);
    }
    unreachable_enum();
}

}  // namespace lamina
