// SPDX-License-Identifier: Apache-2.0
#include "waiting.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace lamina::python {
namespace {

// The working thread tells the waiting one by this.
struct News {
    struct Progress {
        std::string activity;
        double share = 0;
    };

    std::mutex access;
    std::condition_variable ended;
    bool done = false;
    std::exception_ptr failure;
    std::optional<Progress> progress;
};

void do_work(const StoppableWork& work, News& news, std::stop_token stop) {
    std::exception_ptr failure;
    try {
        work(std::move(stop), [&](const std::string& activity, double share) {
            const std::lock_guard lock(news.access);
            news.progress = {activity, share};
        });
    } catch (...) {
        failure = std::current_exception();
    }
    const std::lock_guard lock(news.access);
    news.failure = failure;
    news.done = true;
    news.ended.notify_one();
}

// Throws what Python raises.
void look_after_python(const py::object& progress, const std::optional<News::Progress>& said) {
    const py::gil_scoped_acquire held;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (said && !progress.is_none()) progress(said->activity, said->share);
}

}  // namespace

void run_waiting(const StoppableWork& work, const py::object& progress) {
    using namespace std::chrono_literals;
    News news;
    std::exception_ptr raised;
    {
        const py::gil_scoped_release released;
        std::jthread worker([&](std::stop_token stop) { do_work(work, news, std::move(stop)); });
        std::unique_lock lock(news.access);
        while (!news.ended.wait_for(lock, 20ms, [&] { return news.done; })) {
            const auto said = std::exchange(news.progress, std::nullopt);
            lock.unlock();
            try {
                look_after_python(progress, said);
            } catch (...) {
                raised = std::current_exception();
                worker.request_stop();
                break;
            }
            lock.lock();
        }
    }  // waits for the worker
    if (raised) std::rethrow_exception(raised);
    if (news.failure) std::rethrow_exception(news.failure);
    look_after_python(progress, news.progress);  // what was said after the last look
}

}  // namespace lamina::python
