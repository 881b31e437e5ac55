// SPDX-License-Identifier: Apache-2.0
#include "volume_files/hdf5_source.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <thread>

#include "base/client.h"
#include "base/content_hash.h"

namespace lamina {
namespace {

// Of arrays that are not in chunks: what is read at a time.
constexpr std::array<std::int64_t, 3> no_chunk{64, 64, 64};

const std::array<std::int64_t, 3>& edge_of(const Hdf5Head& head) {
    return head.chunk[0] > 0 ? head.chunk : no_chunk;
}

}  // namespace

Hdf5Source::Hdf5Source(const Hdf5Place& place, std::unique_ptr<Hdf5Process> first)
    : ChunkedSource(first->head().grid.size, edge_of(first->head()), bytes_of(first->head().type)),
      place_(place),
      file_(FileState::of(place.file)),
      taken_(fmt::format("{} {}", fmt::join(first->head().taken, " "),
                         fmt::join(first->head().grid.size, " "))) {
    idle_.push_back(std::move(first));
}

std::unique_ptr<Hdf5Process> Hdf5Source::take_process() const {
    const unsigned most = std::max(1u, std::thread::hardware_concurrency());
    std::unique_lock lock(access_);
    if (idle_.empty() && started_ < most) {
        ++started_;
        lock.unlock();
        // What is to be said of the file, the first one has said.
        const WarningTaker nobody = [](const std::string&) {};
        Client client = ClientScope::current();
        client.warnings = &nobody;
        const ClientScope scope(client);
        return std::make_unique<Hdf5Process>(place_);
    }
    given_back_.wait(lock, [&] { return !idle_.empty(); });
    std::unique_ptr<Hdf5Process> process = std::move(idle_.back());
    idle_.pop_back();
    return process;
}

void Hdf5Source::give_back(std::unique_ptr<Hdf5Process> process) const {
    const std::lock_guard lock(access_);
    idle_.push_back(std::move(process));
    given_back_.notify_one();
}

void Hdf5Source::decode(std::int64_t /*chunk*/, const SampleBox& box, void* to) const {
    std::unique_ptr<Hdf5Process> process = take_process();
    try {
        process->read(box, to);
    } catch (...) {
        give_back(std::move(process));  // for who waits: it says again that it has ended
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
    return fmt::format("{} {} {}", std::filesystem::absolute(place_.file).string(), place_.array,
                       taken_);
}

std::string Hdf5Source::identity() const {
    ContentHash hash;
    hash.add(name());
    hash.add(file_.text());
    hash.add(file_.bytes_hash());
    return hash.hex();
}

}  // namespace lamina
