// SPDX-License-Identifier: Apache-2.0
#include "base/output_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>

#include "base/client.h"
#include "base/input_file.h"
#include "base/process.h"

namespace lamina {

void OutputFile::write(const void* bytes, std::size_t count) {
    if (count > 0 && std::fwrite(bytes, 1, count, stream_) != count) give_up(errno);
}

void OutputFile::give_up(int error) const {
    throw WriteError(fmt::format("{}: cannot write: {}", path_.string(), std::strerror(error)));
}

namespace {

constexpr int most_links = 40;  // the limit of Linux

// Returns the path to which symbolic links lead, so that the links stay. The file need not exist.
std::filesystem::path without_links(std::filesystem::path path) {
    std::error_code failure;
    for (int links = 0; std::filesystem::is_symlink(path, failure); ++links) {
        if (links == most_links)
            throw WriteError(path.string() + ": cannot write: links in a loop");
        const auto target = std::filesystem::read_symlink(path, failure);
        if (failure) throw WriteError(path.string() + ": cannot write: " + failure.message());
        path = path.parent_path() / target;
    }
    return path;
}

std::filesystem::path name_beside(const std::filesystem::path& path, int number) {
    const std::string suffix = fmt::format(".lamina-{}.part", number);
    const std::string name = path.filename().string();
    return path.parent_path() / (name.substr(0, NAME_MAX - suffix.size()) + suffix);
}

// Locks a file; false only if another process has it. Succeeds on file systems without locks.
bool lock(int descriptor) {
    return flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

bool is_at(int descriptor, const std::filesystem::path& path) {
    struct stat opened = {};
    struct stat named = {};
    return fstat(descriptor, &opened) == 0 && lstat(path.c_str(), &named) == 0 &&
           opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

// Removes a killed process's temporary file; false if a process uses it or it cannot be removed.
bool remove_abandoned(const std::filesystem::path& path) {
    const int descriptor = open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return errno == ENOENT;
    const bool abandoned = flock(descriptor, LOCK_EX | LOCK_NB) == 0 && is_at(descriptor, path);
    const bool removed = abandoned && unlink(path.c_str()) == 0;
    close(descriptor);
    return removed;
}

std::string descriptor_path(int descriptor) {
    return fmt::format("/proc/self/fd/{}", descriptor);
}

[[noreturn]] void fail_temporary(int error) {
    fail("{}: cannot write temporary files: {}: set TMPDIR to a folder with room for them",
         temporary_folder(), std::strerror(error));
}

int open_nameless(const std::string& folder) {
    const int descriptor = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (descriptor >= 0) return descriptor;
    // In place of O_TMPFILE, which some file systems lack.
    std::string name = folder + "/lamina-XXXXXX";
    const int named = mkostemp(name.data(), O_CLOEXEC);
    if (named >= 0) unlink(name.c_str());
    return named;
}

// Tells whether rename() would replace no file of this name: in a folder with the sticky bit, such
// as /tmp, only the owners of folder and file may.
bool belongs_to_another(const std::filesystem::path& path) {
    struct stat file = {};
    struct stat folder = {};
    const std::string parent = path.has_parent_path() ? path.parent_path().string() : ".";
    if (lstat(path.c_str(), &file) != 0 || stat(parent.c_str(), &folder) != 0) return false;
    const uid_t own = geteuid();
    return (folder.st_mode & S_ISVTX) != 0 && own != 0 && file.st_uid != own &&
           folder.st_uid != own;
}

constexpr const char* first_line = "Written by lamina, which replaces nothing else here:";

bool is_there(const std::filesystem::path& path) {
    std::error_code ignored;  // symlink_status(), because a link that leads nowhere counts, too
    return std::filesystem::exists(std::filesystem::symlink_status(path, ignored));
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path) : OutputFile(without_links(std::move(path))) {
    std::error_code ignored;
    const auto status = std::filesystem::status(path_, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        throw WriteError(fmt::format(
            "{}: cannot write: it is {}, expected a regular file", path_.string(),
            std::filesystem::is_directory(status) ? "a directory" : "a device, pipe or socket"));
    }
    if (path_.filename().string().size() > NAME_MAX) give_up(ENAMETOOLONG);
    if (belongs_to_another(path_)) give_up(EPERM);
    // Other reasons why a folder cannot be seen are those why the file cannot be opened.
    if (const auto folder = path_.parent_path();
        !folder.empty() &&
        std::filesystem::status(folder, ignored).type() == std::filesystem::file_type::not_found) {
        throw WriteError(fmt::format("{}: cannot write: there is no folder {}", path_.string(),
                                     folder.string()));
    }
    if (!open_nameless()) open_named();
    keep_mode();
    open_stream();
}

AtomicFile::~AtomicFile() {
    if (stream_ != nullptr) std::fclose(stream_);
    if (!temporary_.empty()) unlink(temporary_.c_str());
    close(descriptor_);
}

bool AtomicFile::open_nameless() {
    const std::string folder = path_.has_parent_path() ? path_.parent_path().string() : ".";
    descriptor_ = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor_ < 0) return false;
    lock(descriptor_);
    // A nameless file gets a name through /proc, so /proc must exist.
    if (access(descriptor_path(descriptor_).c_str(), F_OK) == 0) return true;
    close(descriptor_);
    return false;
}

void AtomicFile::open_named() {
    for (int number = 0;;) {
        const std::filesystem::path name = name_beside(path_, number);
        descriptor_ = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor_ >= 0) {
            temporary_ = name;
            if (lock(descriptor_) && is_at(descriptor_, name)) return;
            close(descriptor_);  // another process removed the file before it was locked
            temporary_.clear();
            continue;
        }
        if (errno != EEXIST) give_up(errno);
        if (!remove_abandoned(name)) ++number;
    }
}

// Gives the new file the mode of the one it replaces, before anything is written: private data stay
// private. File systems without modes have nothing to keep.
void AtomicFile::keep_mode() const {
    struct stat replaced = {};
    if (stat(path_.c_str(), &replaced) != 0) return;
    constexpr mode_t permissions = S_IRWXU | S_IRWXG | S_IRWXO;
    fchmod(descriptor_, replaced.st_mode & permissions);
}

void AtomicFile::open_stream() {
    const int copy = fcntl(descriptor_, F_DUPFD_CLOEXEC, 0);
    if (copy >= 0) stream_ = fdopen(copy, "wb");
    if (stream_ != nullptr) return;
    const int error = errno;
    if (copy >= 0) close(copy);
    close(descriptor_);
    if (!temporary_.empty()) unlink(temporary_.c_str());
    give_up(error);
}

void AtomicFile::close_stream() {
    if (stream_ == nullptr) return;
    std::FILE* const stream = stream_;
    stream_ = nullptr;
    // Libraries may write in destructors, ignoring errors: the stream's error flag counts.
    const bool broken = std::ferror(stream) != 0;
    if (std::fclose(stream) != 0) give_up(errno);
    if (broken) give_up(EIO);
}

// linkat() cannot replace a file, so the new file gets a temporary name; rename() then replaces.
void AtomicFile::give_name() {
    const std::string unnamed = descriptor_path(descriptor_);
    for (int number = 0; temporary_.empty();) {
        const std::filesystem::path name = name_beside(path_, number);
        if (linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0)
            temporary_ = name;
        else if (errno != EEXIST)
            give_up(errno);
        else if (!remove_abandoned(name))
            ++number;
    }
}

void AtomicFile::complete() {
    close_stream();
    give_name();
}

void AtomicFile::commit() {
    complete();
    std::error_code error;
    std::filesystem::rename(temporary_, path_, error);
    if (error) give_up(error.value());
    temporary_.clear();
}

std::string temporary_folder() {
    const char* const named = std::getenv("TMPDIR");
    return named != nullptr && *named != '\0' ? named : "/tmp";
}

TemporaryFile::TemporaryFile() {
    const int descriptor = open_nameless(temporary_folder());
    if (descriptor < 0) fail_temporary(errno);
    stream_ = fdopen(descriptor, "w+b");
    if (stream_ != nullptr) return;
    const int error = errno;
    close(descriptor);
    fail_temporary(error);
}

void TemporaryFile::write(const void* bytes, std::size_t count) {
    if (std::fwrite(bytes, 1, count, stream_) != count) fail_temporary(errno);
}

void TemporaryFile::rewind() {
    if (std::fflush(stream_) != 0 || std::fseek(stream_, 0, SEEK_SET) != 0) fail_temporary(errno);
}

PipedFile::PipedFile() : OutputFile("stdout") {
    stream_ = file_.stream();
}

void PipedFile::commit() {
    // Libraries may write in destructors, ignoring errors: the stream's error flag counts.
    if (std::ferror(stream_) != 0) give_up(EIO);
    file_.rewind();
    std::array<char, 1 << 16> bytes{};
    for (std::size_t count = bytes.size(); count == bytes.size();) {
        count = std::fread(bytes.data(), 1, bytes.size(), stream_);
        write_result({bytes.data(), count});
    }
    if (std::ferror(stream_) != 0) give_up(errno);
    flush_results();
}

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) fail("{}: cannot make this folder: {}", folder.string(), error.message());
}

OwnFiles::OwnFiles(std::filesystem::path folder, std::string verb)
    : folder_(std::move(folder)), verb_(std::move(verb)) {}

std::set<std::string> OwnFiles::listed() const {
    const std::filesystem::path list = folder_ / list_name;
    if (!is_there(list)) return {};
    const OwnFilesScope own;
    std::istringstream lines(read_file_bytes(list));
    std::string line;
    if (!std::getline(lines, line) || line != first_line)
        fail("{}: not a list of files that lamina wrote: expected a folder without it",
             list.string());
    std::set<std::string> listed;
    while (std::getline(lines, line)) listed.insert(line);
    return listed;
}

void OwnFiles::expect_own(const std::vector<std::string>& names) const {
    // The folder is read before the list: another process that writes there lists its files before
    // it makes them, so they are on the list if found.
    std::vector<std::string> there;
    for (const std::string& name : names) {
        if (is_there(folder_ / name)) there.push_back(name);
    }
    const std::set<std::string> own = listed();
    for (const std::string& name : there) {
        if (own.contains(verb_ + ": " + name)) continue;
        fail("{}: not written by lamina {}: expected a folder without it, or --force to replace it",
             (folder_ / name).string(), verb_);
    }
}

void OwnFiles::write(const std::set<std::string>& lines) const {
    AtomicFile file(folder_ / list_name);
    file.write(std::string(first_line) + "\n");
    for (const std::string& line : lines) file.write(line + "\n");
    file.commit();
}

void OwnFiles::add(const std::vector<std::string>& names) const {
    make_folder(folder_);
    std::set<std::string> lines = listed();
    const std::size_t before = lines.size();
    for (const std::string& name : names) lines.insert(verb_ + ": " + name);
    if (lines.size() != before) write(lines);
}

void OwnFiles::remove_all() const {
    const std::string of_verb = verb_ + ": ";
    std::set<std::string> others;
    for (const std::string& line : listed()) {
        if (!line.starts_with(of_verb)) {
            others.insert(line);
            continue;
        }
        const std::filesystem::path name = line.substr(of_verb.size());
        // Another's list may name files elsewhere.
        if (name == name.filename()) std::filesystem::remove(folder_ / name);
    }
    if (others.empty())
        std::filesystem::remove(folder_ / list_name);
    else
        write(others);
    if (std::filesystem::is_empty(folder_)) std::filesystem::remove(folder_);
}

}  // namespace lamina
