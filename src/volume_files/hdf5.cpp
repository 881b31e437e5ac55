// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_formats.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>

#include "base/client.h"
#include "base/content_hash.h"
#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/hdf5_volume.h"
#include "volume_files/isolated_process.h"
#include "volume_files/sample_sources.h"

namespace lamina {
namespace {

// The arguments of Hdf5Volume.
struct Hdf5Place {
    std::string file, array;
    VolumeRequest request;
};

// A question to an Hdf5Process: the arguments of Hdf5Volume::read().
struct Question {
    SampleBox box;
    bool is_all;
};

std::size_t bytes_in(const SampleBox& box, ValueType type) {
    return static_cast<std::size_t>(box.count()) * bytes_of(type);
}

// An isolated process that reads an HDF5 file with libhdf5. For one thread at a time.
class Hdf5Process {
  public:
    // Starts the process and receives the head of its volume. Throws Error.
    explicit Hdf5Process(const Hdf5Place& place)
        : process_(place.file, "libhdf5", [&](IsolatedLine& line) { serve(line, place); }) {
        process_.receive(&head_, sizeof head_);
    }

    const Hdf5Head& head() const { return head_; }
    // Returns all samples. read() must not be called then, because it would overwrite their memory.
    std::shared_ptr<void> read_all() {
        read_shared({{0, 0, 0}, head_.grid.size}, true);
        return shared_.memory;
    }

    void read(const SampleBox& box, void* to) {
        std::memcpy(to, read_shared(box, false), bytes_in(box, head_.type));
    }

  private:
    // Memory that both processes see. Each sizes its mapping by the same questions, so both agree.
    struct Shared {
        std::shared_ptr<void> memory;
        std::size_t bytes = 0;

        // Returns memory for `wanted` bytes. `taker`: this process's end of the line.
        template <typename Taker>
        void* room(std::size_t wanted, Taker& taker) {
            if (wanted > bytes) {
                memory = taker.shared_memory(wanted);
                bytes = wanted;
            }
            return memory.get();
        }
    };

    // Answers questions in the isolated process until no more come.
    static void serve(IsolatedLine& line, const Hdf5Place& place) {
        const Hdf5Volume volume(place.file, place.array, place.request);
        line.answer(&volume.head(), sizeof(Hdf5Head));
        Shared shared;
        for (Question question; line.next(&question, sizeof question);) {
            const std::size_t bytes = bytes_in(question.box, volume.head().type);
            line.allow_bytes(std::max(bytes, volume.chunk_bytes()));
            volume.read(question.box, question.is_all, shared.room(bytes, line));
            line.answer(nullptr, 0);
        }
    }

    // Asks for a box of samples and returns it in the shared memory.
    void* read_shared(const SampleBox& box, bool is_all) {
        void* const samples = shared_.room(bytes_in(box, head_.type), process_);
        const Question question{box, is_all};
        process_.ask(&question, sizeof question);
        process_.receive(nullptr, 0);
        return samples;
    }

    IsolatedProcess process_;
    Hdf5Head head_;
    Shared shared_;
};

// Min edge, in samples, of the boxes that are decoded at once, because each takes a question to a
// process. Smaller chunks are read several at a time; arrays without chunks take this edge.
constexpr std::int64_t least_edge = 64;

std::array<std::int64_t, 3> edge_of(const Hdf5Head& head) {
    std::array<std::int64_t, 3> edge{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t chunk = std::max<std::int64_t>(head.chunk[axis], 1);
        edge[axis] = std::min((least_edge + chunk - 1) / chunk * chunk, head.grid.size[axis]);
    }
    return edge;
}

// Samples in the chunks of an HDF5 file, which isolated processes decode: one for each core, up to
// most_processes. The constructor starts them all, because this process still has few threads then.
class Hdf5Source : public ChunkedSource {
  public:
    Hdf5Source(const Hdf5Place& place, std::unique_ptr<Hdf5Process> first)
        : ChunkedSource(first->head().grid.size, edge_of(first->head()),
                        bytes_of(first->head().type)),
          place_(place),
          file_(FileState::of(place.file)),
          head_(first->head()) {
        idle_.push_back(std::move(first));
        const unsigned count = std::min(most_processes, std::thread::hardware_concurrency());
        while (idle_.size() < count) idle_.push_back(started());
    }

    void check_unchanged() const override { file_.check_unchanged(); }

    // Returns the file's name with the array's appended: each array has an index of its own.
    std::filesystem::path main_file() const override {
        std::string array = place_.array;
        std::ranges::replace(array, '/', '.');
        return place_.file + array;
    }

    std::string name() const override {
        return fmt::format("{} {} {} {}", std::filesystem::absolute(place_.file).string(),
                           place_.array, fmt::join(head_.taken, " "),
                           fmt::join(head_.grid.size, " "));
    }

    std::string identity() const override {
        ContentHash hash;
        hash.add(name());
        hash.add(file_.text());
        hash.add(file_.bytes_hash());
        return hash.hex();
    }

  private:
    void decode(std::int64_t /*chunk*/, const SampleBox& box, void* to) const override {
        std::unique_ptr<Hdf5Process> process;
        try {
            process = take_process();
            process->read(box, to);
        } catch (...) {
            give_back({});  // the process may have ended, or not have sent all
            throw;
        }
        give_back(std::move(process));
    }

    // Starts one more process. Drops its warnings, which the first process has given already.
    std::unique_ptr<Hdf5Process> started() const {
        const WarningTaker nobody = [](const std::string&) {};
        Client client = ClientScope::current();
        client.warnings = &nobody;
        const ClientScope scope(client);
        auto process = std::make_unique<Hdf5Process>(place_);
        const Hdf5Head& head = process->head();
        file_.check_unchanged();
        if (head.grid.size != head_.grid.size || head.type != head_.type ||
            head.taken != head_.taken)
            fail("{}: the file was changed while it was read", place_.file);
        return process;
    }

    // Returns an idle process, as soon as there is one; starts a new one in place of a lost one.
    std::unique_ptr<Hdf5Process> take_process() const {
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

    // Makes a process idle again; null counts as a lost one.
    void give_back(std::unique_ptr<Hdf5Process> process) const {
        const std::lock_guard lock(access_);
        if (process)
            idle_.push_back(std::move(process));
        else
            ++lost_;
        given_back_.notify_one();
    }

    static constexpr unsigned most_processes = 16;

    Hdf5Place place_;
    FileState file_;
    Hdf5Head head_;
    mutable std::mutex access_;
    mutable std::condition_variable given_back_;
    mutable std::vector<std::unique_ptr<Hdf5Process>> idle_;
    mutable unsigned lost_ = 0;  // processes that are to be replaced by new ones
};

// The file and the array ("/PATH") of a path "FILE.h5:/PATH". `array` is empty for a plain file.
struct ArrayPath {
    std::filesystem::path file;
    std::string array;
};

ArrayPath array_path(const std::filesystem::path& path) {
    std::error_code unreadable;
    if (std::filesystem::exists(path, unreadable)) return {path, ""};
    const std::string text = path.string();
    for (std::size_t at = text.find(":/"); at != std::string::npos; at = text.find(":/", at + 1)) {
        const std::filesystem::path file = text.substr(0, at);
        if (std::filesystem::is_regular_file(file, unreadable)) return {file, text.substr(at + 1)};
    }
    return {path, ""};
}

// Describes where an array's samples lie in its file, if the head says it (Hdf5Head::raw).
StoredData raw_data(const std::filesystem::path& file, const Hdf5Head& head) {
    StoredData data;
    data.path = file;
    data.teller = "the array";
    data.type = head.type;
    for (const std::int64_t size : head.grid.size) data.axes.emplace_back(size);
    for (std::size_t i = 0; i < 2; ++i)
        if (head.outer[i] > 1) data.axes.emplace_back(head.outer[i], head.taken[i], "", true);
    set_byte_order(data, head.raw.big_endian);
    data.files = {file};
    data.offset = head.raw.offset;
    return data;
}

}  // namespace

bool is_hdf5(const std::filesystem::path& path) {
    constexpr std::string_view signature("\x89HDF\r\n\x1a\n", 8);
    const std::filesystem::path file = array_path(path).file;
    std::error_code unreadable;
    if (std::filesystem::is_directory(file, unreadable)) return false;
    const std::string beginning = file_beginning(file, 2048 + signature.size());
    for (const std::size_t at : {0, 512, 1024, 2048}) {
        if (beginning.size() > at && std::string_view(beginning).substr(at).starts_with(signature))
            return true;
    }
    return false;
}

Volume open_hdf5(const std::filesystem::path& path, const VolumeRequest& request,
                 const VolumeUse& use) {
    const ArrayPath named = array_path(path);
    expect_regular_file(named.file);
    const Hdf5Place place{named.file.string(), named.array.empty() ? request.array : named.array,
                          request};
    auto process = std::make_unique<Hdf5Process>(place);
    const Hdf5Head& head = process->head();
    const auto type = drawn_type(head.type);
    const bool is_scaled = head.scale != 1 || head.offset != 0;
    if (!type || is_scaled || head.elsewhere) {
        std::string why = fmt::format("its samples are of type {}", name_of(head.type));
        if (is_scaled) why = "its samples are scaled";
        if (head.elsewhere) why = "its samples lie in another file";
        expect_room(path.string(),
                    static_cast<std::uint64_t>(head.grid.sample_count()) * bytes_of(head.type), use,
                    why);
    } else if (stays_in_files(head.grid, *type, use)) {
        if (head.raw.offset < 0 || head.has_missing)
            return stored_volume(head.grid, *type,
                                 std::make_unique<Hdf5Source>(place, std::move(process)));
        return stored_volume(
            head.grid, *type,
            std::make_unique<FileSource>(raw_data(named.file, head), head.grid.size));
    }
    return drawn_volume(head.grid,
                        {path.string(), head.type, process->read_all(), head.scale, head.offset});
}

std::vector<std::filesystem::path> files_of_hdf5(const std::filesystem::path& path) {
    return {array_path(path).file};
}

}  // namespace lamina
