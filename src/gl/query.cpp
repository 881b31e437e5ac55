// SPDX-License-Identifier: Apache-2.0
#include "gl/query.h"

#include <glad/gl.h>

#include "gl/api.h"
#include "gl/check.h"

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

}  // namespace lamina::gl
