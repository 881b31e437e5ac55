// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_formats.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>
#include <type_traits>

#include "base/client.h"
#include "base/content_hash.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "volume_files/hdf5_layout.h"
#include "volume_files/isolated_process.h"
#include "volume_files/sample_sources.h"

namespace lamina {
namespace {

// Describes a volume in an HDF5 file.
struct Hdf5Head {
    ArrayPlace place;
    std::vector<std::int64_t> shape;  // of the array
    ValueType type = ValueType::uint8;
    double scale = 1, offset = 0;                // as in StoredSamples
    std::array<std::int64_t, 3> chunk{0, 0, 0};  // samples along x, y and z; 0: not in chunks
    // Result of Hdf5Array::raw_place() for the whole array, if its samples are those of the volume
    // in the file's order. Its offset is -1 if there is no such place.
    Hdf5Array::RawPlace raw{-1, false};
    std::vector<std::string> files;  // the file itself, and those that the samples are in
    VolumeContents contents;
    Quantity quantity;
};

// Writes fields one after another, for an isolated process to send: plain ones as they lie in
// memory, texts and lists with their length before them.
struct HeadWriter {
    std::string bytes;

    template <typename Field>
    void operator()(const Field& field) {
        if constexpr (std::is_trivially_copyable_v<Field>) {
            bytes.append(reinterpret_cast<const char*>(&field), sizeof field);
        } else {
            (*this)(field.size());
            for (const auto& one : field) (*this)(one);
        }
    }
};

// Reads what a HeadWriter has written.
struct HeadReader {
    std::string_view left;

    template <typename Field>
    void operator()(Field& field) {
        std::size_t count = sizeof field;
        if constexpr (!std::is_trivially_copyable_v<Field>) (*this)(count);
        if (count > left.size()) fail("libhdf5's process sent too few bytes");
        if constexpr (std::is_trivially_copyable_v<Field>) {
            std::memcpy(&field, left.data(), sizeof field);
            left.remove_prefix(sizeof field);
        } else {
            field.resize(count);
            for (auto& one : field) (*this)(one);
        }
    }
};

template <typename Fields, typename Head>
void for_all_fields(Fields& fields, Head& head) {
    const auto all = [&](auto&... each) { (fields(each), ...); };
    auto& grid = head.place.grid;
    auto& contents = head.contents;
    all(grid.size, grid.centering, grid.origin, grid.step, grid.axes, grid.unit);
    all(head.place.axes, head.place.index, head.shape, head.type, head.scale, head.offset);
    all(head.chunk, head.raw, head.files, head.quantity.name, head.quantity.unit);
    all(contents.arrays, contents.channels, contents.times, contents.levels, contents.is_colour);
}

// Returns a type of as many bytes without a sign.
ValueType without_sign(ValueType type) {
    return number_type(bytes_of(type), true, false).value_or(type);
}

// Tells if NetCDF has written a file, and filled samples of an array that nobody has written. It
// gives every dimension a scale; newer versions write _NCProperties, too.
bool has_fill_of_netcdf(hid_t file, const Hdf5Array& array) {
    const Hdf5Handle root(H5Gopen2(file, "/", H5P_DEFAULT), H5Gclose);
    const Hdf5Handle properties(H5Dget_create_plist(array.id()), H5Pclose);
    H5D_fill_time_t when = H5D_FILL_TIME_IFSET;
    H5Pget_fill_time(properties.id(), &when);
    bool has_scales = true;
    for (std::size_t axis = 0; axis < array.shape().size(); ++axis)
        has_scales &= H5DSget_num_scales(array.id(), static_cast<unsigned>(axis)) > 0;
    return when != H5D_FILL_TIME_NEVER && (has_scales || H5Aexists(root.id(), "_NCProperties") > 0);
}

// A volume in an HDF5 file, read by libhdf5.
class Hdf5Volume {
  public:
    // `array`: its path in the file; empty: the only one. Throws Error.
    Hdf5Volume(const std::string& file, const std::string& array, const VolumeRequest& request);

    const Hdf5Head& head() const { return head_; }
    // Returns the bytes of a chunk along all axes of the array, which libhdf5 unpacks at once even
    // if few samples are read; 0 if the array is not in chunks.
    std::size_t chunk_bytes() const { return chunk_bytes_; }
    // Reads a box, in native byte order, x fastest. `is_all`: a warning counts missing samples.
    void read(const SampleBox& box, bool is_all, void* to) const;

  private:
    void place();
    void find_chunks();

    Hdf5Files files_;
    VolumeContents contents_;
    Hdf5Layout layout_;
    Hdf5Array array_;
    PackedValues values_;
    Hdf5Head head_;
    std::size_t chunk_bytes_ = 0;
};

Hdf5Volume::Hdf5Volume(const std::string& file, const std::string& array,
                       const VolumeRequest& request)
    : files_(file),
      layout_(hdf5_layout(files_, array, request, contents_)),
      array_(files_.open_set(layout_.array), file + ":" + one_line(layout_.array)) {
    head_.files = files_.paths();
    head_.shape = array_.shape();
    const hid_t id = array_.id();
    values_ = values_in(id, array_.name(),
                        layout_.is_unsigned ? without_sign(array_.type()) : array_.type(),
                        has_fill_of_netcdf(files_.file(), array_));
    head_.type = values_.type();
    head_.scale = values_.scale();
    head_.offset = values_.offset();
    place();
    find_chunks();

    std::vector<StoredAxis> axes;
    for (const std::int64_t size : head_.place.grid.size) axes.emplace_back(size);
    std::uint64_t file_bytes = 0;
    for (const std::string& path : head_.files) file_bytes += std::filesystem::file_size(path);
    array_.expect_readable(stored_bytes(array_.name(), axes, bytes_of(array_.type())), file_bytes);
    head_.contents = contents_;
    head_.quantity = {layout_.array.substr(layout_.array.rfind('/') + 1),
                      unit_word(text_of(id, "units"))};
}

// Places the volume in the array and in the world.
void Hdf5Volume::place() {
    DescribedArray described = describe_hdf5(files_, array_, layout_, contents_);
    head_.place = place_array(described, layout_.request, contents_);
    Grid& grid = head_.place.grid;
    if (layout_.grid) {
        for (std::size_t i = 0; i < 3; ++i) {
            grid.step[i] = layout_.grid->step[i];
            if (layout_.grid->centering[i] == Centering::cell) grid.centering[i] = Centering::cell;
        }
        grid.origin = layout_.grid->origin;
        grid.axes = layout_.grid->axes;
        grid.unit = layout_.grid->unit;
        check_grid(array_.name(), grid, {"directions", "origin"});
    }
    for (std::size_t i = 0; i < 3; ++i) {
        if (layout_.size[i] == 0) continue;
        if (layout_.size[i] > grid.size[i]) {
            fail("{}: axis {}: found {} samples, expected {} or more", array_.name(), "xyz"[i],
                 grid.size[i], layout_.size[i]);
        }
        grid.size[i] = layout_.size[i];  // the rest of the last chunk is padding
    }
}

// Finds out how the samples are stored.
void Hdf5Volume::find_chunks() {
    const std::vector<std::int64_t> chunk = array_.chunk();
    const std::array<int, 3>& axes = head_.place.axes;
    for (std::size_t i = 0; i < 3 && !chunk.empty(); ++i)
        head_.chunk[i] = axes[i] < 0 ? 1 : chunk[static_cast<std::size_t>(axes[i])];
    chunk_bytes_ = chunk.empty() ? 0 : bytes_of(array_.type());
    for (const std::int64_t edge : chunk) chunk_bytes_ *= static_cast<std::size_t>(edge);
    const bool as_stored = head_.place.is_in_order() && axes[0] >= 0 && axes[1] >= 0 &&
                           !values_.can_be_missing() && head_.files.size() == 1 &&
                           layout_.size == std::array<std::int64_t, 3>{};
    if (!as_stored) return;
    if (const auto raw = array_.raw_place()) head_.raw = *raw;
}

void Hdf5Volume::read(const SampleBox& box, bool is_all, void* to) const {
    std::vector<std::int64_t> begin = head_.place.index, count(begin.size(), 1);
    const std::array<int, 3>& axes = head_.place.axes;
    for (std::size_t i = 0; i < 3; ++i) {
        if (axes[i] < 0) continue;
        begin[static_cast<std::size_t>(axes[i])] = box.first[i];
        count[static_cast<std::size_t>(axes[i])] = box.size[i];
    }
    const bool in_order = head_.place.is_in_order(), marks = values_.can_be_missing();
    const std::size_t bytes = static_cast<std::size_t>(box.count()) * bytes_of(array_.type());
    ByteBuffer stored(in_order && !marks ? 0 : bytes), ordered(in_order || !marks ? 0 : bytes);
    array_.read(begin, count, in_order && !marks ? to : stored.data());
    if (!in_order)
        copy_in_order(array_.type(), axes, count, std::vector<std::int64_t>(count.size()),
                      stored.data(), marks ? ordered.data() : to);
    if (!marks) return;
    const std::int64_t missing =
        values_.mark(box.count(), in_order ? stored.data() : ordered.data(), to);
    if (is_all) values_.say_missing(missing);
}

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

constexpr std::size_t most_text = 1 << 24;  // bytes of names that a process may send

std::size_t bytes_in(const SampleBox& box, ValueType type) {
    return static_cast<std::size_t>(box.count()) * bytes_of(type);
}

// Sends a text from an isolated process; received() returns it.
void answer_text(IsolatedLine& line, const std::string& text) {
    const std::size_t bytes = text.size();
    line.answer(&bytes, sizeof bytes);
    line.answer(text.data(), bytes);
}

std::string received(IsolatedProcess& process) {
    std::size_t bytes = 0;
    process.receive(&bytes, sizeof bytes);
    std::string text(std::min(bytes, most_text), '\0');
    process.receive(text.data(), text.size());
    return text;
}

// An isolated process that reads an HDF5 file with libhdf5. For one thread at a time.
class Hdf5Process {
  public:
    // Starts the process and receives the head of its volume. Throws Error.
    explicit Hdf5Process(const Hdf5Place& place)
        : process_(place.file, "libhdf5", [&](IsolatedLine& line) { serve(line, place); }) {
        const std::string bytes = received(process_);
        HeadReader reader{bytes};
        for_all_fields(reader, head_);
    }

    const Hdf5Head& head() const { return head_; }
    // Returns all samples. read() must not be called then, because it would overwrite their memory.
    std::shared_ptr<void> read_all() {
        read_shared({{0, 0, 0}, head_.place.grid.size}, true);
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
        HeadWriter writer;
        for_all_fields(writer, volume.head());
        answer_text(line, writer.bytes);
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
        edge[axis] = std::min((least_edge + chunk - 1) / chunk * chunk, head.place.grid.size[axis]);
    }
    return edge;
}

// Samples in the chunks of an HDF5 file, which isolated processes decode: one for each core, up to
// most_processes. The constructor starts them all, because this process still has few threads then.
class Hdf5Source : public ChunkedSource {
  public:
    Hdf5Source(const Hdf5Place& place, std::unique_ptr<Hdf5Process> first)
        : ChunkedSource(first->head().place.grid.size, edge_of(first->head()),
                        bytes_of(first->head().type)),
          place_(place),
          head_(first->head()) {
        for (const std::string& file : head_.files) files_.push_back(FileState::of(file));
        idle_.push_back(std::move(first));
        const unsigned count = std::min(most_processes, std::thread::hardware_concurrency());
        while (idle_.size() < count) idle_.push_back(started());
    }

    void check_unchanged() const override {
        for (const FileState& file : files_) file.check_unchanged();
    }

    // Returns the file's name with the array's appended: each array has an index of its own.
    std::filesystem::path main_file() const override {
        std::string array = place_.array;
        std::ranges::replace(array, '/', '.');
        return place_.file + array;
    }

    std::string name() const override {
        return fmt::format("{} {} {} {}", std::filesystem::absolute(place_.file).string(),
                           place_.array, fmt::join(head_.place.index, " "),
                           fmt::join(head_.place.grid.size, " "));
    }

    std::string identity() const override {
        ContentHash hash;
        hash.add(name());
        for (const FileState& file : files_) {
            hash.add(file.text());
            hash.add(file.bytes_hash());
        }
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
        check_unchanged();
        if (head.place.grid.size != head_.place.grid.size || head.type != head_.type ||
            head.place.index != head_.place.index)
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
    std::vector<FileState> files_;
    Hdf5Head head_;
    mutable std::mutex access_;
    mutable std::condition_variable given_back_;
    mutable std::vector<std::unique_ptr<Hdf5Process>> idle_;
    mutable unsigned lost_ = 0;  // processes that are to be replaced by new ones
};

// Describes where an array's samples lie in its file, if the head says it (Hdf5Head::raw).
StoredData raw_data(const std::filesystem::path& file, const Hdf5Head& head) {
    StoredData data;
    data.path = file;
    data.teller = "the array";
    data.type = head.type;
    const auto& axes = head.place.axes;
    for (std::size_t i = head.shape.size(); i-- > 0;) {
        if (std::ranges::find(axes, static_cast<int>(i)) != axes.end())
            data.axes.emplace_back(head.shape[i]);
        else
            data.axes.emplace_back(head.shape[i], head.place.index[i], "", true);
    }
    if (axes[2] < 0) data.axes.emplace_back(1);
    set_byte_order(data, head.raw.big_endian);
    data.files = {file};
    place_raw(data, static_cast<std::uint64_t>(head.raw.offset));
    return data;
}

}  // namespace

Volume open_hdf5(const std::filesystem::path& path, const VolumeRequest& request,
                 const VolumeUse& use) {
    const ArrayPath named = array_path(path);
    expect_regular_file(named.file);
    const Hdf5Place place{named.file.string(), named.array.empty() ? request.array : named.array,
                          request};
    auto process = std::make_unique<Hdf5Process>(place);
    const Hdf5Head& head = process->head();
    const Quantity quantity = head.quantity;
    const auto type = drawn_type(head.type);
    const bool is_scaled = head.scale != 1 || head.offset != 0;
    if (use.contents != nullptr) *use.contents = head.contents;
    if (!type || is_scaled) {
        std::string why = fmt::format("its samples are of type {}", name_of(head.type));
        if (is_scaled) why = "its samples are scaled";
        expect_room(
            path.string(),
            static_cast<std::uint64_t>(head.place.grid.sample_count()) * bytes_of(head.type), use,
            why);
    } else if (stays_in_files(head.place.grid, *type, use)) {
        if (head.raw.offset < 0)
            return stored_volume(head.place.grid, *type,
                                 std::make_unique<Hdf5Source>(place, std::move(process)))
                .measuring(quantity);
        return stored_volume(
                   head.place.grid, *type,
                   std::make_unique<FileSource>(raw_data(named.file, head), head.place.grid.size))
            .measuring(quantity);
    }
    StoredSamples samples{path.string(), head.type, nullptr, head.scale, head.offset};
    samples.bytes =
        head.raw.offset < 0 ? process->read_all() : read_stored(raw_data(named.file, head)).bytes;
    return drawn_volume(head.place.grid, samples, use.lookup).measuring(quantity);
}

std::vector<std::filesystem::path> files_of_hdf5(const std::filesystem::path& path) {
    const ArrayPath named = array_path(path);
    IsolatedProcess process(named.file.string(), "libhdf5", [&](IsolatedLine& line) {
        Hdf5Files files(named.file.string());
        files.find_files(named.array);
        answer_text(line, json_text(nlohmann::json(files.paths())));
    });
    const auto paths = parse_json(received(process)).get<std::vector<std::string>>();
    return {paths.begin(), paths.end()};
}

}  // namespace lamina
