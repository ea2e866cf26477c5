#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace parallux {

/// A table that a user wrote: a header, then rows with as many fields, as RFC 4180 has it; empty
/// lines and a byte order mark are passed over. Any bytes may come: whatever is no such table
/// throws Fault::input with file and line.
class Csv {
public:
    static constexpr std::size_t absent = ~std::size_t(0);

    explicit Csv(std::filesystem::path file);

    const std::vector<std::string>& columns() const { return header_; }
    /// The place of a column; absent when there is none of this name.
    std::size_t find(const std::string& column) const;
    /// The same; refuses the file when there is none.
    std::size_t need(const std::string& column) const;
    std::size_t rows() const { return rows_.size(); }
    const std::string& text(std::size_t row, std::size_t column) const;
    /// A finite number in [low, high]; refuses the file where there is another text.
    double number(std::size_t row, std::size_t column, double low, double high) const;

    /// Where a row begins in the file, from 1.
    std::size_t line(std::size_t row) const { return rows_[row].line; }

    /// Throws Fault::input: file, line of the row, what.
    [[noreturn]] void fail(std::size_t row, const std::string& what) const;
    /// Throws Fault::input about the header.
    [[noreturn]] void fail(const std::string& what) const;

private:
    struct Row {
        std::size_t line;
        std::vector<std::string> fields;
    };

    std::filesystem::path file_;
    std::vector<std::string> header_;
    std::vector<Row> rows_;
};

}  // namespace parallux
