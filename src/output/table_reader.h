#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace parallux {

/// Reads a table of write_table row by row, in constant memory. Any bytes may come: whatever is not
/// such a table throws Fault::input with file and line.
class TableReader {
public:
    explicit TableReader(std::filesystem::path file);

    /// Moves to the next patch; false at the end of the table.
    bool next();

    const std::filesystem::path& file() const { return file_; }
    std::uint32_t bands() const { return bands_; }
    /// Its number; tables of receivers leave some out.
    std::uint64_t patch() const { return patch_; }
    double area() const { return area_; }
    bool back() const { return back_; }
    double radiosity(std::uint32_t band) const { return radiosity_[band]; }

    /// Throws Fault::input: file, line of the present row, what.
    [[noreturn]] void fail(const std::string& what) const;

private:
    bool read_record();
    bool parse_record();
    void read_header();
    double number(std::size_t column) const;

    std::filesystem::path file_;
    std::filebuf bytes_;
    std::uint64_t line_ = 1;         // of the bytes read so far
    std::uint64_t record_line_ = 1;  // where the present row begins
    std::uint64_t rows_ = 0, patch_ = 0;
    std::vector<std::string> names_, fields_;
    std::uint32_t bands_ = 0;
    double area_ = 0;
    bool back_ = false;
    std::vector<double> radiosity_;
};

}  // namespace parallux
