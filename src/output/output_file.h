#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace parallux {

/// The one way to write a file: bytes go to a temporary in the same folder; commit() checks every
/// write, fsyncs, closes, renames over the target and fsyncs the folder. Destroyed without
/// commit(), the temporary is gone and an older file stays as it was. Throws Fault::output naming
/// the file and the system's reason. At most 16 at a time, on any threads.
class OutputFile {
public:
    explicit OutputFile(std::filesystem::path target);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::string_view bytes);
    void commit();
    /// Where the bytes go until commit(), for libraries that want to open a path themselves.
    std::filesystem::path temporary() const;

private:
    friend void remove_temporaries();
    struct Name;

    std::filesystem::path target_;
    Name* name_ = nullptr;  // of the temporary
    int descriptor_ = -1;
    bool committed_ = false;
};

/// Removes the temporaries of all OutputFiles that there are now: for a signal's handler that ends
/// the program next. Async-signal-safe.
void remove_temporaries();

/// Throws Fault::output unless a file could be written here now. Leaves nothing behind.
void check_writable(const std::filesystem::path& target);

}  // namespace parallux
