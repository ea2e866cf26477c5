#include "csv.h"

#include <algorithm>
#include <charconv>

#include "scene/input.h"

namespace parallux {

namespace {

constexpr std::uint64_t most_bytes = std::uint64_t(1) << 30;

// Takes one record from `bytes` at `at`; `line` goes with it. False: it ends within quotes.
bool take_record(const std::string& bytes, std::size_t& at, std::size_t& line,
                 std::vector<std::string>& fields) {
    fields.assign(1, {});
    bool quoted = false;
    while (at < bytes.size()) {
        const char c = bytes[at++];
        line += c == '\n';
        std::string& field = fields.back();
        if (quoted) {
            if (c != '"')
                field += c;
            else if (at < bytes.size() && bytes[at] == '"')
                field += bytes[at++];
            else
                quoted = false;
        } else if (c == '"' && field.empty()) {
            quoted = true;
        } else if (c == ',') {
            fields.emplace_back();
        } else if (c == '\n') {
            break;
        } else if (c != '\r') {
            field += c;
        }
    }
    return !quoted;
}

std::string plain(double value) {
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

}  // namespace

Csv::Csv(std::filesystem::path file) : file_(std::move(file)) {
    const std::string bytes = read_file(file_, most_bytes);
    std::size_t at = bytes.compare(0, 3, "\xEF\xBB\xBF") == 0 ? 3 : 0, line = 1;
    while (at < bytes.size()) {
        Row row{line, {}};
        const bool whole = take_record(bytes, at, line, row.fields);
        if (row.fields.size() == 1 && row.fields[0].empty() && whole)
            continue;
        rows_.push_back(std::move(row));
        if (!whole)
            fail(rows_.size() - 1, "the file ends within quotes");
        const std::size_t fields = rows_.back().fields.size();
        if (header_.empty()) {
            header_ = std::move(rows_.back().fields);
            rows_.clear();
        } else if (fields != header_.size()) {
            fail(rows_.size() - 1, std::to_string(fields) + " fields instead of the header's " +
                                       std::to_string(header_.size()));
        }
    }
    if (header_.empty())
        fail("has no header");
    for (std::size_t i = 0; i < header_.size(); ++i)
        if (std::find(header_.begin(), header_.begin() + i, header_[i]) != header_.begin() + i)
            fail("column " + printable(header_[i]) + " comes twice");
}

std::size_t Csv::find(const std::string& column) const {
    const auto found = std::find(header_.begin(), header_.end(), column);
    return found == header_.end() ? absent : static_cast<std::size_t>(found - header_.begin());
}

std::size_t Csv::need(const std::string& column) const {
    const std::size_t place = find(column);
    if (place == absent)
        fail("has no column " + column);
    return place;
}

const std::string& Csv::text(std::size_t row, std::size_t column) const {
    return rows_[row].fields[column];
}

double Csv::number(std::size_t row, std::size_t column, double low, double high) const {
    const std::string& text = rows_[row].fields[column];
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size() ||
        !(value >= low && value <= high))
        fail(row, printable(header_[column]) + " must be a number from " + plain(low) + " to " +
                      plain(high) + ", not \"" + printable(text) + "\"");
    return value;
}

void Csv::fail(std::size_t row, const std::string& what) const {
    input_error(file_, "line " + std::to_string(rows_[row].line), what);
}

void Csv::fail(const std::string& what) const {
    input_error(file_, "", what);
}

}  // namespace parallux
