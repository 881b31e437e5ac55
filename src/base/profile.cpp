// SPDX-License-Identifier: Apache-2.0
#include "base/profile.h"

#include <atomic>

namespace lamina {

namespace {

// Number of spans for which memory is reserved at once: enough for some thousand frames.
constexpr std::size_t spans_at_first = 1 << 14;

std::atomic<Profile*> current = nullptr;

}  // namespace

Profile::Profile() {
    spans_.reserve(spans_at_first);
    rows_[std::this_thread::get_id()] = first_row;
    [[maybe_unused]] Profile* const other = current.exchange(this);
    assert(other == nullptr);
}

Profile::~Profile() {
    current = nullptr;
}

Profile* Profile::recording() {
    return current;
}

void Profile::add(const char* name, std::int64_t begin_ns, std::int64_t end_ns,
                  const Counts& counts) {
    const std::lock_guard lock(adding_);
    const int next = row_count();
    const int row = rows_.try_emplace(std::this_thread::get_id(), next).first->second;
    keep({name, begin_ns, end_ns, counts, row});
}

void Profile::add_opengl(const char* name, std::int64_t begin_ns, std::int64_t end_ns) {
    const std::lock_guard lock(adding_);
    keep({name, begin_ns, end_ns, {}, opengl_row});
}

void Profile::keep(const Span& span) {
    if (spans_.size() < most_spans)
        spans_.push_back(span);
    else
        ++left_out_;
}

int Profile::row_count() const {
    return first_row + static_cast<int>(rows_.size());
}

}  // namespace lamina
