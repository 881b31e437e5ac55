// SPDX-License-Identifier: Apache-2.0
#include "gl/timeline.h"

#include <algorithm>
#include <limits>

#include <glad/gl.h>
#include "base/profile.h"

namespace lamina::gl {

namespace {

GLenum target_of(Query::Kind kind) {
    return kind == Query::Kind::samples_passed ? GL_SAMPLES_PASSED : GL_TIMESTAMP;
}

unsigned new_query(Query::Kind kind) {
    GLuint id = 0;
    api().CreateQueries(target_of(kind), 1, &id);
    return id;
}

bool is_recording() {
    if (Profile::recording() == nullptr) return false;
    GLint bits = 0;
    api().GetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &bits);
    return bits > 0;
}

// Returns the host's clock minus OpenGL's in nanoseconds, from the quickest of several readings.
std::int64_t clock_offset() {
    constexpr int looks = 5;
    std::int64_t shortest = std::numeric_limits<std::int64_t>::max(), offset = 0;
    for (int i = 0; i < looks; ++i) {
        GLint64 opengl = 0;
        const std::int64_t before = Stopwatch::now();
        api().GetInteger64v(GL_TIMESTAMP, &opengl);
        const std::int64_t between = Stopwatch::now() - before;
        if (between >= shortest) continue;
        shortest = between;
        offset = before + between / 2 - opengl;
    }
    return offset;
}

}  // namespace

Query::Query(Kind kind) : kind_(kind), handle_(new_query(kind)) {
    check("making a query");
}

void Query::begin() {
    api().BeginQuery(target_of(kind_), handle_.id());
}

void Query::end() {
    api().EndQuery(target_of(kind_));
}

void Query::stamp() {
    api().QueryCounter(handle_.id(), GL_TIMESTAMP);
}

std::uint64_t Query::result() const {
    GLuint64 value = 0;
    api().GetQueryObjectui64v(handle_.id(), GL_QUERY_RESULT, &value);
    check("reading a query");
    return value;
}

// Flushes, so that the commands before a span are submitted apart from those in it: llvmpipe draws
// tile after tile, meets a timestamp query in each tile and keeps the last time.
void Timeline::begin(const char* name) {
    if (!is_recording()) return;
    api().Flush();
    if (count_ == spans_.size()) spans_.emplace_back();
    spans_[count_].name = name;
    spans_[count_].begin.stamp();
    api().Flush();
}

void Timeline::end() {
    if (is_recording()) spans_[count_++].end.stamp();
}

void Timeline::collect() {
    if (count_ == 0) return;
    api().Finish();
    const std::int64_t offset = clock_offset();
    for (std::size_t i = 0; i < count_; ++i) {
        const auto begin = static_cast<std::int64_t>(spans_[i].begin.result());
        const auto end = static_cast<std::int64_t>(spans_[i].end.result());
        if (Profile* const profile = Profile::recording())
            profile->add_opengl(spans_[i].name, begin + offset, std::max(begin, end) + offset);
    }
    count_ = 0;
}

}  // namespace lamina::gl
