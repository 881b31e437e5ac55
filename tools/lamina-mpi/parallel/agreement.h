// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <functional>

#include "parallel/ranks.h"

namespace lamina {

// Does a step of the job on every rank and waits for the others. `work` must not wait for another
// rank. Where it throws on any rank, this function throws on all: on rank 0 its own exception, or
// an Error with the message and the number of the first rank that failed; on others an Error.
void agree(const Ranks& ranks, const std::function<void()>& work);

// Does a step in which ranks wait for one another. Where it throws, no rank can go on: the job ends
// with a message.
void do_or_abort(const Ranks& ranks, const std::function<void()>& work);

}  // namespace lamina
