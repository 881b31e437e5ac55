// SPDX-License-Identifier: Apache-2.0
#include "volume_files/byte_readers.h"

#include <bzlib.h>
#include <sys/types.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <new>
#include <span>
#include <utility>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"

namespace lamina {
namespace {

// Most bytes, 64 MiB, that are read or decompressed between checks for a requested stop. It must be
// below 2^32, because zlib and libbz2 count bytes in 32 bits.
constexpr std::size_t step_bytes = std::size_t{1} << 26;

class FileReader final : public ByteReader {
  public:
    FileReader(OpenedFile file, std::string name, bool counts_surplus)
        : file_(std::move(file)), name_(std::move(name)), counts_surplus_(counts_surplus) {}

    void read(void* bytes, std::size_t count) override {
        for (std::size_t done = 0; done < count;) {
            check_interrupt();
            const std::size_t wanted = std::min(count - done, step_bytes);
            const std::size_t got =
                std::fread(static_cast<char*>(bytes) + done, 1, wanted, file_.get());
            done += got;
            if (got != wanted) fail("{}: found {} bytes of data, expected {}", name_, done, count);
        }
    }

    void skip(std::size_t count) override {
        const std::uint64_t left = bytes_left(file_.get());
        if (count > left) fail("{}: found {} bytes of data, expected {}", name_, left, count);
        fseeko(file_.get(), static_cast<off_t>(count), SEEK_CUR);
    }

    std::vector<std::string> surplus() override {
        const std::uint64_t left = counts_surplus_ ? bytes_left(file_.get()) : 0;
        if (left == 0) return {};
        return {fmt::format("{} bytes more", left)};
    }

  private:
    OpenedFile file_;
    std::string name_;
    bool counts_surplus_;
};

// Reads compressed data: one or more members, each a stream that unpack() decompresses.
class PackedReader : public ByteReader {
  public:
    void read(void* bytes, std::size_t count) override {
        auto* const first = static_cast<unsigned char*>(bytes);
        for (std::size_t done = 0; done < count;) {
            check_interrupt();
            Output to(first + done, std::min(count - done, step_bytes));
            done += to.size();
            while (!to.empty()) {
                if (unpack_some(to)) continue;
                fail("{}: truncated {} data: found {} bytes, expected {}", name_, format_,
                     done - to.size(), count);
            }
        }
    }

    void skip(std::size_t count) override {
        std::vector<unsigned char> scratch(std::min(count, input_bytes));
        for (std::size_t done = 0; done < count;) {
            const std::size_t step = std::min(count - done, scratch.size());
            read(scratch.data(), step);
            done += step;
        }
    }

    std::vector<std::string> surplus() override {
        const std::uint64_t unpacked = unpack_rest();
        const std::uint64_t behind = in_member_ ? 0 : left_.size() + bytes_left(stream_.get());
        std::vector<std::string> texts;
        if (unpacked > 0) {
            const char* const at_least = unpacked >= most_counted_surplus ? "at least " : "";
            texts.push_back(fmt::format("{}{} bytes of {} data more", at_least, unpacked, format_));
        }
        if (behind > 0)
            texts.push_back(fmt::format("{} bytes behind its {} data, more", behind, format_));
        return texts;
    }

  protected:
    using Input = std::span<const unsigned char>;
    using Output = std::span<unsigned char>;

    PackedReader(OpenedFile stream, std::string name, const char* format)
        : stream_(std::move(stream)),
          name_(std::move(name)),
          format_(format),
          input_(input_bytes) {}
    [[noreturn]] void fail_as_damaged(const char* reason) const {
        fail("{}: damaged {} data: {}", name_, format_, reason);
    }

  private:
    static constexpr std::size_t input_bytes = std::size_t{1} << 20;  // of one read of the file

    // Decompresses some bytes from `from` to `to` and updates both. Returns true at the end of a
    // member; the next call may then start another member.
    virtual bool unpack(Input& from, Output& to) = 0;

    // Decompresses bytes to `to`, and reads on in the file if needed. Returns false at its end.
    bool unpack_some(Output& to) {
        if (left_.empty()) {
            const std::size_t got = std::fread(input_.data(), 1, input_.size(), stream_.get());
            left_ = Input(input_).first(got);
            if (got == 0) return false;
        }
        in_member_ = !unpack(left_, to);
        return true;
    }

    // Decompresses the rest of the member, up to most_counted_surplus bytes, and so verifies its
    // checksum. Returns the number of decompressed bytes.
    std::uint64_t unpack_rest() {
        std::uint64_t unpacked = 0;
        std::vector<unsigned char> scratch(input_bytes);
        while (in_member_ && unpacked < most_counted_surplus) {
            check_interrupt();
            Output to(scratch);
            if (!unpack_some(to))
                fail("{}: truncated {} data: the checksum is missing", name_, format_);
            unpacked += scratch.size() - to.size();
        }
        return unpacked;
    }

    OpenedFile stream_;
    std::string name_;
    const char* format_;
    std::vector<unsigned char> input_;
    Input left_;              // bytes of input_ that are still packed
    bool in_member_ = false;  // a member has begun and not ended
};

class GzipReader final : public PackedReader {
  public:
    GzipReader(OpenedFile stream, std::string name)
        : PackedReader(std::move(stream), std::move(name), "gzip") {
        constexpr int window = 15 + 32;  // zlib.h, inflateInit2: detect the kind of header
        if (inflateInit2(&state_, window) != Z_OK) throw std::bad_alloc();
    }
    ~GzipReader() override { inflateEnd(&state_); }

  private:
    bool unpack(Input& from, Output& to) override {
        state_.next_in = const_cast<Bytef*>(from.data());  // zlib only reads it
        state_.avail_in = static_cast<uInt>(from.size());
        state_.next_out = to.data();
        state_.avail_out = static_cast<uInt>(to.size());
        const int result = inflate(&state_, Z_NO_FLUSH);
        from = from.last(state_.avail_in);
        to = to.last(state_.avail_out);
        if (result == Z_STREAM_END) {
            inflateReset(&state_);
            return true;
        }
        if (result == Z_MEM_ERROR) throw std::bad_alloc();
        if (result != Z_OK && result != Z_BUF_ERROR)
            fail_as_damaged(state_.msg != nullptr ? state_.msg : "no reason given");
        return false;
    }

    z_stream state_{};
};

class Bzip2Reader final : public PackedReader {
  public:
    Bzip2Reader(OpenedFile stream, std::string name)
        : PackedReader(std::move(stream), std::move(name), "bzip2") {
        begin_member();
    }
    ~Bzip2Reader() override { BZ2_bzDecompressEnd(&state_); }

  private:
    void begin_member() {
        constexpr int silent = 0, fast = 0;
        state_ = {};
        if (BZ2_bzDecompressInit(&state_, silent, fast) != BZ_OK) throw std::bad_alloc();
    }

    bool unpack(Input& from, Output& to) override {
        // libbz2 takes char* but only reads.
        state_.next_in = const_cast<char*>(reinterpret_cast<const char*>(from.data()));
        state_.avail_in = static_cast<unsigned>(from.size());
        state_.next_out = reinterpret_cast<char*>(to.data());
        state_.avail_out = static_cast<unsigned>(to.size());
        const int result = BZ2_bzDecompress(&state_);
        from = from.last(state_.avail_in);
        to = to.last(state_.avail_out);
        if (result == BZ_STREAM_END) {
            BZ2_bzDecompressEnd(&state_);
            begin_member();
            return true;
        }
        if (result == BZ_MEM_ERROR) throw std::bad_alloc();
        if (result == BZ_DATA_ERROR_MAGIC) fail_as_damaged("no bzip2 header");
        if (result != BZ_OK) fail_as_damaged("its checksum or its codes are wrong");
        return false;
    }

    bz_stream state_{};
};

class HexReader final : public ByteReader {
  public:
    HexReader(OpenedFile file, std::string name) : file_(std::move(file)), name_(std::move(name)) {}

    void read(void* bytes, std::size_t count) override {
        auto* const to = static_cast<unsigned char*>(bytes);
        for (std::size_t done = 0; done < count; ++done) {
            if (done % step_bytes == 0) check_interrupt();
            const int high = digit(), low = digit();
            if (low < 0) fail("{}: found {} bytes of hex data, expected {}", name_, done, count);
            to[done] = static_cast<unsigned char>(16 * high + low);
        }
    }

    void skip(std::size_t count) override {
        unsigned char byte = 0;
        for (std::size_t done = 0; done < count; ++done) read(&byte, 1);
    }

    std::vector<std::string> surplus() override {
        std::uint64_t letters = 0;
        while (letters < 2 * most_counted_surplus && letter() != EOF) ++letters;
        if (letters == 0) return {};
        return {fmt::format("{} letters of hex data more", letters)};
    }

  private:
    // Returns the value of the next digit; -1 at the end of the file.
    int digit() {
        const int found = letter();
        if (found == EOF) return -1;
        if (std::isxdigit(found) == 0)
            fail("{}: damaged hex data: found byte {}, expected a digit from 0 to f", name_, found);
        return found <= '9' ? found - '0' : std::tolower(found) - 'a' + 10;
    }

    // Returns the next byte that is no space; EOF at the end of the file.
    int letter() {
        int found = std::fgetc(file_.get());
        while (std::isspace(found) != 0) found = std::fgetc(file_.get());
        return found;
    }

    OpenedFile file_;
    std::string name_;
};

class SequenceReader final : public ByteReader {
  public:
    using Paths = std::vector<std::filesystem::path>;
    using Opener = std::function<std::unique_ptr<ByteReader>(const std::filesystem::path&)>;

    SequenceReader(Paths paths, std::size_t bytes_each, Opener open)
        : paths_(std::move(paths)), bytes_each_(bytes_each), open_(std::move(open)) {}

    void read(void* bytes, std::size_t count) override {
        auto* to = static_cast<char*>(bytes);
        use(count, [&](ByteReader& reader, std::size_t step) {
            reader.read(to, step);
            to += step;
        });
    }
    void skip(std::size_t count) override {
        use(count, [](ByteReader& reader, std::size_t step) { reader.skip(step); });
    }
    std::vector<std::string> surplus() override { return surplus_; }

  private:
    // Uses the next `count` bytes: calls step(reader, bytes) for each file that holds some of them.
    template <typename Step>
    void use(std::size_t count, const Step& step) {
        while (count > 0) {
            if (left_ == 0) {
                if (next_ == paths_.size())
                    fail("{}: the last file ends {} bytes too early", paths_.back().string(),
                         count);
                reader_ = open_(paths_[next_]);
                left_ = bytes_each_;
            }
            const std::size_t bytes = std::min(count, left_);
            step(*reader_, bytes);
            count -= bytes;
            left_ -= bytes;
            if (left_ > 0) continue;
            for (const std::string& more : reader_->surplus())
                surplus_.push_back(fmt::format("{} in {}", more, paths_[next_].string()));
            ++next_;
        }
    }

    Paths paths_;
    std::size_t bytes_each_;
    Opener open_;
    std::size_t next_ = 0;  // index in paths_: the file that is open or is opened next
    std::unique_ptr<ByteReader> reader_;
    std::size_t left_ = 0;  // bytes of the open file that are not used yet
    std::vector<std::string> surplus_;
};

}  // namespace

OpenedFile open_to_read(const std::filesystem::path& path, std::int64_t offset) {
    expect_regular_file(path);
    OpenedFile file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file || fseeko(file.get(), offset, SEEK_SET) != 0)
        fail("{}: cannot read: {}", path.string(), std::strerror(errno));
    return file;
}

std::uint64_t bytes_left(std::FILE* file) {
    const off_t here = ftello(file);
    fseeko(file, 0, SEEK_END);
    const off_t end = ftello(file);
    fseeko(file, here, SEEK_SET);
    return end > here ? static_cast<std::uint64_t>(end - here) : 0;
}

std::unique_ptr<ByteReader> file_reader(OpenedFile file, std::string name, bool counts_surplus) {
    return std::make_unique<FileReader>(std::move(file), std::move(name), counts_surplus);
}

std::unique_ptr<ByteReader> gzip_reader(OpenedFile file, std::string name) {
    return std::make_unique<GzipReader>(std::move(file), std::move(name));
}

std::unique_ptr<ByteReader> bzip2_reader(OpenedFile file, std::string name) {
    return std::make_unique<Bzip2Reader>(std::move(file), std::move(name));
}

std::unique_ptr<ByteReader> hex_reader(OpenedFile file, std::string name) {
    return std::make_unique<HexReader>(std::move(file), std::move(name));
}

std::unique_ptr<ByteReader> sequence_reader(
    std::vector<std::filesystem::path> paths, std::size_t bytes_each,
    std::function<std::unique_ptr<ByteReader>(const std::filesystem::path&)> open) {
    return std::make_unique<SequenceReader>(std::move(paths), bytes_each, std::move(open));
}

}  // namespace lamina
