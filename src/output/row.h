#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "parallux/error.h"

namespace parallux {

/// Appends one row of a CSV table at a time to a text. std::to_chars never asks the locale for its
/// decimal point.
class Row {
public:
    explicit Row(std::string& text) : text_(text) {}

    /// 9 significant digits; throws Fault::internal where a value is not finite.
    Row& number(double value) {
        if (!std::isfinite(value))
            throw Error(Fault::internal, "a table value is not finite; please report the scene");
        separate();
        if (value == 0) {  // common, and never "-0"
            text_ += '0';
            return *this;
        }
        char digits[32];
        auto end =
            std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 9);
        text_.append(digits, end.ptr);
        return *this;
    }
    Row& index(std::uint64_t value) {
        separate();
        char digits[24];
        text_.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
        return *this;
    }
    /// Quoted as RFC 4180 asks where the text would otherwise break the row.
    Row& word(std::string_view value) {
        separate();
        if (value.find_first_of(",\"\r\n") == std::string_view::npos) {
            text_ += value;
            return *this;
        }
        text_ += '"';
        for (char c : value)
            text_.append(c == '"' ? 2 : 1, c);
        text_ += '"';
        return *this;
    }
    void end() {
        text_ += '\n';
        first_ = true;
    }

private:
    void separate() {
        if (!first_)
            text_ += ',';
        first_ = false;
    }

    std::string& text_;
    bool first_ = true;
};

}  // namespace parallux
