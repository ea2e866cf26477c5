#include "output/output_file.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "parallux/error.h"

namespace parallux {

namespace {

[[noreturn]] void fail(const std::filesystem::path& target, const char* what) {
    throw Error(Fault::output, target.string() + ": cannot " + what + ": " + std::strerror(errno));
}

std::filesystem::path folder_of(const std::filesystem::path& target) {
    return target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
}

}  // namespace

// Where a signal's handler finds a temporary's name: it is there before the file is, and stays
// readable at any time.
struct OutputFile::Name {
    std::atomic<bool> taken{false};
    char text[PATH_MAX] = "";

    static std::array<Name, 16> all;

    static Name* take(const std::string& pattern) {
        for (Name& name : all)
            if (pattern.size() < sizeof name.text && !name.taken.exchange(true)) {
                std::memcpy(name.text, pattern.c_str(), pattern.size() + 1);
                return &name;
            }
        errno = pattern.size() < PATH_MAX ? EMFILE : ENAMETOOLONG;
        return nullptr;
    }
};

std::array<OutputFile::Name, 16> OutputFile::Name::all;

void remove_temporaries() {
    for (const OutputFile::Name& name : OutputFile::Name::all)
        if (name.taken)
            unlink(name.text);
}

OutputFile::OutputFile(std::filesystem::path target) : target_(std::move(target)) {
    // A link is followed, so that the file it names is replaced and not the link itself.
    std::error_code ignored;
    if (std::filesystem::is_symlink(target_, ignored)) {
        std::filesystem::path real = std::filesystem::weakly_canonical(target_, ignored);
        if (!ignored)
            target_ = real;
    }
    if (target_.filename().empty() || std::filesystem::is_directory(target_, ignored)) {
        errno = EISDIR;
        fail(target_, "write");
    }
    // A device or a pipe would be replaced by a file.
    if (std::filesystem::exists(target_, ignored) &&
        !std::filesystem::is_regular_file(target_, ignored))
        throw Error(Fault::output, target_.string() + ": cannot write: it is no regular file");
    // The ending stays last, because image libraries choose the format by it.
    std::string name = "." + target_.stem().string() + ".XXXXXX" + target_.extension().string();
    name_ = Name::take((folder_of(target_) / name).string());
    if (!name_)
        fail(target_, "write");
    descriptor_ =
        mkostemps(name_->text, static_cast<int>(target_.extension().string().size()), O_CLOEXEC);
    if (descriptor_ < 0) {
        name_->taken = false;
        fail(target_, "write");
    }
    // From here on nothing may throw: no destructor would take the file away.
    // An ordinary file's rights, not the private ones of a temporary; an older file keeps its own.
    struct stat old {};
    mode_t mode = 0;
    if (stat(target_.c_str(), &old) == 0) {
        mode = old.st_mode & 07777;
    } else {
        mode_t mask = umask(0);
        umask(mask);
        mode = 0666 & ~mask;
    }
    fchmod(descriptor_, mode);
}

OutputFile::~OutputFile() {
    if (descriptor_ >= 0)
        close(descriptor_);
    if (!committed_)
        unlink(name_->text);
    name_->taken = false;
}

std::filesystem::path OutputFile::temporary() const {
    return name_->text;
}

void OutputFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
        if (n < 0) {
            if (errno == EINTR)
                continue;
            fail(target_, "write");
        }
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
}

void OutputFile::commit() {
    if (fsync(descriptor_) != 0)
        fail(target_, "write");
    int closed = close(descriptor_);
    descriptor_ = -1;
    if (closed != 0)
        fail(target_, "write");
    if (rename(name_->text, target_.c_str()) != 0)
        fail(target_, "replace");
    committed_ = true;
    int folder = open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0)
        fail(target_, "save the folder of");
    int synced = fsync(folder);
    int reason = errno;
    close(folder);
    errno = reason;
    if (synced != 0)
        fail(target_, "save the folder of");
}

void check_writable(const std::filesystem::path& target) {
    OutputFile probe(target);
}

}  // namespace parallux
