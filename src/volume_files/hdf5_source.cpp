// SPDX-License-Identifier: Apache-2.0
#include "volume_files/hdf5_source.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <thread>

#include "base/client.h"
#include "base/content_hash.h"
#include "base/error.h"

namespace lamina {
namespace {

// Less is not worth a question: smaller chunks are read several at a time. Arrays that are not in
// chunks are read in boxes of this edge.
constexpr std::int64_t least_edge = 64;

std::array<std::int64_t, 3> edge_of(const Hdf5Head& head) {
    std::array<std::int64_t, 3> edge{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t chunk = std::max<std::int64_t>(head.chunk[axis], 1);
        edge[axis] = std::min((least_edge + chunk - 1) / chunk * chunk, head.grid.size[axis]);
    }
    return edge;
}

}  // namespace

Hdf5Source::Hdf5Source(const Hdf5Place& place, std::unique_ptr<Hdf5Process> first)
    : ChunkedSource(first->head().grid.size, edge_of(first->head()), bytes_of(first->head().type)),
      place_(place),
      file_(FileState::of(place.file)),
      head_(first->head()) {
    idle_.push_back(std::move(first));
    const unsigned count = std::min(most_processes, std::thread::hardware_concurrency());
    while (idle_.size() < count) idle_.push_back(started());
}

// One more. What is to be said of the file, the first one has said.
std::unique_ptr<Hdf5Process> Hdf5Source::started() const {
    const WarningTaker nobody = [](const std::string&) {};
    Client client = ClientScope::current();
    client.warnings = &nobody;
    const ClientScope scope(client);
    auto process = std::make_unique<Hdf5Process>(place_);
    const Hdf5Head& head = process->head();
    file_.check_unchanged();
    if (head.grid.size != head_.grid.size || head.type != head_.type || head.taken != head_.taken)
        fail("{}: the file was changed while it was read", place_.file);
    return process;
}

std::unique_ptr<Hdf5Process> Hdf5Source::take_process() const {
    std::unique_lock lock(access_);
    given_back_.wait(lock, [&] { return !idle_.empty() || lost_ > 0; });
    if (idle_.empty()) {
        --lost_;
        lock.unlock();
        return started();
    }
    std::unique_ptr<Hdf5Process> process = std::move(idle_.back());
    idle_.pop_back();
    return process;
}

void Hdf5Source::give_back(std::unique_ptr<Hdf5Process> process) const {
    const std::lock_guard lock(access_);
    if (process)
        idle_.push_back(std::move(process));
    else
        ++lost_;
    given_back_.notify_one();
}

void Hdf5Source::decode(std::int64_t /*chunk*/, const SampleBox& box, void* to) const {
    std::unique_ptr<Hdf5Process> process;
    try {
        process = take_process();
        process->read(box, to);
    } catch (...) {
        give_back({});  // it may have an answer under way, or have ended
        throw;
    }
    give_back(std::move(process));
}

// Each array of a file has a name of its own.
std::filesystem::path Hdf5Source::main_file() const {
    std::string array = place_.array;
    std::ranges::replace(array, '/', '.');
    return place_.file + array;
}

std::string Hdf5Source::name() const {
    return fmt::format("{} {} {} {}", std::filesystem::absolute(place_.file).string(), place_.array,
                       fmt::join(head_.taken, " "), fmt::join(head_.grid.size, " "));
}

std::string Hdf5Source::identity() const {
    ContentHash hash;
    hash.add(name());
    hash.add(file_.text());
    hash.add(file_.bytes_hash());
    return hash.hex();
}

}  // namespace lamina
