#include "output/table_reader.h"

#include <charconv>
#include <cmath>

#include "output/table_columns.h"
#include "parallux/error.h"
#include "parallux/spectrum.h"

namespace parallux {

namespace {

// Longer rows, larger values than a table can have are damage, and squares of values stay finite.
constexpr std::size_t longest_record = std::size_t{1} << 20;
constexpr double largest_value = 1e39;

}  // namespace

TableReader::TableReader(std::filesystem::path file) : file_(std::move(file)) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file_, ignored) ||
        !bytes_.open(file_, std::ios::in | std::ios::binary))
        throw Error(Fault::input, file_.string() + ": cannot read; give a table of --table");
    read_header();
}

void TableReader::fail(const std::string& what) const {
    throw Error(Fault::input, file_.string() + ":" + std::to_string(record_line_) + ": " + what);
}

bool TableReader::read_record() {
    try {
        return parse_record();
    } catch (const std::ios_base::failure&) {
        fail("cannot read on; is it an ordinary file?");
    }
}

// One record of RFC 4180 into fields_. The states: inside quotes or not; a quote inside quotes is
// the end of them, or the first of a doubled one.
bool TableReader::parse_record() {
    constexpr int end = std::filebuf::traits_type::eof();
    record_line_ = line_;
    fields_.assign(1, {});
    if (bytes_.sgetc() == end)
        return false;
    bool quoted = false;
    for (std::size_t length = 0;; ++length) {
        int c = bytes_.sbumpc();
        if (c == end)
            fail("the file ends inside a row; it was cut short");
        if (length == longest_record)
            fail("a row longer than 1 MiB; this is no table of patches");
        line_ += c == '\n';
        std::string& field = fields_.back();
        if (quoted) {
            if (c != '"')
                field += static_cast<char>(c);
            else if (bytes_.sgetc() == '"')
                field += static_cast<char>(bytes_.sbumpc());
            else
                quoted = false;
        } else if (c == '"' && field.empty()) {
            quoted = true;
        } else if (c == ',') {
            fields_.emplace_back();
        } else if (c == '\n') {
            if (!field.empty() && field.back() == '\r')
                field.pop_back();
            return true;
        } else {
            field += static_cast<char>(c);
        }
    }
}

void TableReader::read_header() {
    if (!read_record())
        fail("the file is empty");
    std::size_t per_band = fields_.size() > place_columns ? fields_.size() - place_columns : 0;
    const bool translucent = fields_.back().rfind("transmittance_", 0) == 0;
    const std::size_t columns = columns_per_band + (translucent ? 1 : 0);
    bands_ = static_cast<std::uint32_t>(per_band / columns);
    if (per_band % columns != 0 || bands_ < 1 || bands_ > max_bands ||
        fields_ != table_columns(bands_, translucent))
        fail("not the header of a table of patches; write one with --table");
    names_ = fields_;
    radiosity_.resize(bands_);
}

double TableReader::number(std::size_t column) const {
    const std::string& text = fields_[column];
    double value = 0;
    auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size() ||
        !(std::abs(value) < largest_value))
        fail(names_[column] + " is no finite number in range: " + text.substr(0, 40));
    return value;
}

bool TableReader::next() {
    if (!read_record())
        return false;
    if (fields_.size() != names_.size())
        fail(std::to_string(fields_.size()) + " columns instead of " +
             std::to_string(names_.size()));
    for (std::size_t column = 0; column < fields_.size(); ++column) {
        bool text = column == name_column || column == material_column || column == side_column;
        bool absent = is_stderr_column(bands_, column) && fields_[column].empty();
        if (!text && !absent)
            number(column);
    }
    const std::uint64_t least = rows_ == 0 ? 0 : patch_ + 1;
    const double patch = number(patch_column);
    if (!(patch >= static_cast<double>(least) && patch < 0x1p32) || patch != std::floor(patch))
        fail("patch " + fields_[patch_column] + " instead of " + std::to_string(least) +
             " or one after it; rows are out of order");
    patch_ = static_cast<std::uint64_t>(patch);
    const std::string& side = fields_[side_column];
    if (side != "front" && side != "back")
        fail("side is neither front nor back: " + side.substr(0, 40));
    area_ = number(area_column);
    if (!(area_ > 0))
        fail("area is not positive: " + fields_[area_column]);
    back_ = side == "back";
    for (std::uint32_t band = 0; band < bands_; ++band)
        radiosity_[band] = number(radiosity_column(band));
    ++rows_;
    return true;
}

}  // namespace parallux
