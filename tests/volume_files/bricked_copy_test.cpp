// SPDX-License-Identifier: Apache-2.0
#include "volume_files/bricked_copy.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "base/memory.h"
#include "expect_boxes.h"
#include "lamina/volume.h"
#include "support/expect_error.h"
#include "support/heard_warnings.h"
#include "support/temporary_folder.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

namespace fs = std::filesystem;

using test::in_files;

// Returns bytes of which the first half are zeros, so that some chunks hold only zeros.
std::string some_bytes(std::size_t count) {
    return std::string(count / 2, '\0') + test::noise_bytes(count - count / 2);
}

std::string gzipped(const std::string& bytes) {
    std::string packed(compressBound(bytes.size()) + 100, '\0');
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

class BrickedCopies : public ::testing::Test {
  protected:
    fs::path nrrd(const std::string& fields, const std::string& data) {
        const fs::path path = folder_ / "a.nrrd";
        write_bytes_to(path, "NRRD0004\n" + fields + "\n" + data);
        return path;
    }
    static void expect_copy(const fs::path& path, const VolumeRequest& request = {}) {
        SCOPED_TRACE(path);
        const BrickedCopy copy = write_bricked_copy(path, request);
        EXPECT_TRUE(fs::exists(copy.folder / ".zarray"));
        test::expect_boxes(read_volume(path, request), open_volume(path, request, in_files));
    }

    TemporaryFolder folder_;
};

TEST_F(BrickedCopies, EqualPackedFiles) {
    const std::string sizes = "dimension: 3\nsizes: 131 67 70\nencoding: gzip\n";
    const std::size_t count = 131 * 67 * 70;
    expect_copy(nrrd("type: uint8\n" + sizes, gzipped(some_bytes(count))));
    for (const char* const endian : {"little", "big"}) {
        expect_copy(nrrd(fmt::format("type: ushort\nendian: {}\n{}", endian, sizes),
                         gzipped(some_bytes(2 * count))));
    }
    const std::string place =
        "space dimension: 3\nspace directions: (0,1,0) (2,0,0) (0,0,-3)\nspace origin: (5,6,7)\n";
    const std::string in_space = place + "sizes: 131 67 70\nencoding: gzip\n";
    expect_copy(nrrd("type: float\nendian: little\ndimension: 3\n" + in_space,
                     gzipped(some_bytes(4 * count))));
}

TEST_F(BrickedCopies, ListWhatTheirFilesHave) {
    const std::string fields =
        "type: uint8\ndimension: 5\nsizes: 3 70 67 2 5\nkinds: vector domain domain domain time\n"
        "encoding: gzip\n";
    const fs::path path = nrrd(fields, gzipped(some_bytes(3 * 70 * 67 * 2 * 5)));
    write_bricked_copy(path, {});
    VolumeContents contents;
    VolumeUse use = in_files;  // the packed file itself would be refused
    use.contents = &contents;
    open_volume(path, {}, use);
    EXPECT_EQ(contents.channels, std::vector<std::string>(3));
    EXPECT_EQ(contents.times, std::vector<std::string>(5));
    EXPECT_TRUE(contents.arrays.empty() && contents.levels.empty());
    EXPECT_FALSE(contents.is_colour);
}

// Flips bits in all files of a copy, also in headers and hashes, and removes files.
TEST_F(BrickedCopies, AreNeverDrawnDamaged) {
    const std::size_t count = 131 * 67 * 70;
    const fs::path path = nrrd("type: uint8\ndimension: 3\nsizes: 131 67 70\nencoding: gzip\n",
                               gzipped(some_bytes(count)));
    const Volume truth = read_volume(path, {});
    const fs::path folder = write_bricked_copy(path, {}).folder;
    std::vector<fs::path> files;
    for (const auto& each : fs::recursive_directory_iterator(folder)) {
        if (each.is_regular_file()) files.push_back(each.path());
    }
    std::ranges::sort(files);
    int refused = 0;
    test::HeardWarnings said;  // filled if the copy is not used
    const auto expect_truth_or_error = [&] {
        said.texts.clear();
        try {
            test::expect_boxes(truth, open_volume(path, {}, in_files));
        } catch (const Error& error) {
            const bool of_a_chunk =
                std::string(error.what()).find(": is damaged") != std::string::npos;
            EXPECT_TRUE(of_a_chunk ||
                        said.all().find("the bricks are damaged") != std::string::npos)
                << error.what();
            refused += of_a_chunk;
        }
    };
    std::uint64_t random = 1;
    for (std::size_t i = 0; i < 40; ++i) {
        const fs::path& file = files[i % files.size()];
        const std::string bytes = read_bytes_of(file);
        std::string flipped = bytes;
        random = random * 6364136223846793005u + 1442695040888963407u;
        flipped[(random >> 33) % flipped.size()] ^= static_cast<char>(1 << (random >> 61));
        write_bytes_to(file, flipped);
        SCOPED_TRACE(file);
        expect_truth_or_error();
        write_bytes_to(file, bytes);
    }
    EXPECT_GT(refused, 10);  // damaged chunks
    for (const fs::path& file : files) {
        const std::string bytes = read_bytes_of(file);
        fs::remove(file);
        SCOPED_TRACE(file);
        expect_truth_or_error();
        write_bytes_to(file, bytes);
    }
}

// Copies one of several channels and times; samples of the others are skipped.
TEST_F(BrickedCopies, EqualTheChosenChannelAndTimeOfAPackedFile) {
    const std::size_t count = 3 * 31 * 17 * 23 * 2;
    const fs::path path = nrrd(
        "type: short\nendian: little\ndimension: 5\nsizes: 3 31 17 23 2\nkinds: vector domain "
        "domain domain time\nencoding: gzip\n",
        gzipped(some_bytes(2 * count)));
    VolumeRequest request;
    request.channel = 2;
    for (const std::int64_t time : {0, 1}) {
        request.time = time;
        expect_copy(path, request);
    }
}

// Copies samples of a type that is drawn as another, and a file of zeros.
TEST_F(BrickedCopies, EqualTheSamplesThatAreDrawn) {
    expect_copy(nrrd("type: int8\ndimension: 3\nsizes: 31 17 23\nencoding: raw\n",
                     some_bytes(31 * 17 * 23)));
    const std::string empty = gzipped(std::string(600 * 600 * 300, '\0'));
    expect_copy(nrrd("type: uint8\ndimension: 3\nsizes: 600 600 300\nencoding: gzip\n", empty));
}

// Chunks are flatter if the memory limit is low.
TEST_F(BrickedCopies, EqualPackedFilesIfMemoryIsLimited) {
    set_memory_limit(std::uint64_t{1} << 20);
    const fs::path path = nrrd("type: uint8\ndimension: 3\nsizes: 300 200 70\nencoding: gzip\n",
                               gzipped(some_bytes(300 * 200 * 70)));
    expect_copy(path);
    set_memory_limit(0);
}

TEST_F(BrickedCopies, AreNotUsedForOtherSamples) {
    const std::string head = "type: uint8\ndimension: 3\nsizes: 31 17 23\nencoding: raw\n";
    const fs::path path = nrrd(head, some_bytes(31 * 17 * 23));
    const fs::path copy = write_bricked_copy(path, {}).folder;
    test::HeardWarnings said;
    EXPECT_EQ(open_volume(path, {}, in_files).store().source().main_file(), copy);
    EXPECT_EQ(said.all(), "");
    fs::last_write_time(path, fs::last_write_time(path) + std::chrono::seconds(5));
    EXPECT_EQ(open_volume(path, {}, in_files).store().source().main_file(), path);
    EXPECT_NE(said.all().find("other samples"), std::string::npos) << said.all();
    said.texts.clear();
    for (const char* const damaged : {"{\"lamina_bricks\": 3}", "{", "{}"}) {
        write_bytes_to(copy / ".zattrs", damaged);
        EXPECT_EQ(open_volume(path, {}, in_files).store().source().main_file(), path);
        EXPECT_NE(said.all().find("damaged"), std::string::npos) << said.all();
        said.texts.clear();
    }
}

TEST_F(BrickedCopies, LeaveNothingAfterAFailure) {
    const fs::path path = nrrd("type: uint8\ndimension: 3\nsizes: 31 17 23\nencoding: gzip\n",
                               gzipped(some_bytes(31 * 17 * 22)));
    expect_error([&] { write_bricked_copy(path, {}); }, {"a.nrrd", "truncated"});
    EXPECT_FALSE(fs::exists(bricked_copy_of(path)));
    EXPECT_FALSE(fs::exists(bricked_copy_of(path).string() + ".part"));
    fs::create_directory(bricked_copy_of(path));
    write_bytes_to(bricked_copy_of(path) / "thesis.txt", "mine");
    expect_error([&] { write_bricked_copy(path, {}); }, {"not written"});
    EXPECT_TRUE(fs::exists(bricked_copy_of(path) / "thesis.txt"));
}

}  // namespace
}  // namespace lamina
