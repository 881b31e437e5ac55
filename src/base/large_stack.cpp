// SPDX-License-Identifier: Apache-2.0
#include "base/large_stack.h"

#include <pthread.h>
#include <sys/resource.h>

#include <cstddef>
#include <system_error>

namespace lamina {
namespace {

constexpr std::size_t stack_bytes = 8u << 20;  // the usual limit (ulimit -s)

struct Job {
    const std::function<int()>& work;
    int result = 0;
};

void* do_job(void* given) {
    Job& job = *static_cast<Job*>(given);
    job.result = job.work();
    return nullptr;
}

}  // namespace

int with_large_stack(const std::function<int()>& work) {
    rlimit limit{};
    if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= stack_bytes) return work();
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, stack_bytes);
    pthread_setattr_default_np(&attributes);  // for threads that libraries start
    Job job{work};
    pthread_t thread{};
    const int failure = pthread_create(&thread, &attributes, do_job, &job);
    pthread_attr_destroy(&attributes);
    if (failure != 0) {
        throw std::system_error(failure, std::generic_category(),
                                "no stack of 8 MiB, more than ulimit -s gives");
    }
    pthread_join(thread, nullptr);
    return job.result;
}

}  // namespace lamina
