#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "output/output_file.h"
#include "parallux/error.h"

namespace parallux {

/// Text that goes to a file in large pieces. Numbers have as few digits as are read back as the
/// same bits, whatever the locale.
class FactorText {
public:
    explicit FactorText(const std::filesystem::path& file) : output_(file) {}

    FactorText& text(std::string_view words) {
        text_ += words;
        if (text_.size() >= chunk) {
            output_.write(text_);
            text_.clear();
        }
        return *this;
    }
    FactorText& number(double value) {
        if (!std::isfinite(value))
            throw Error(Fault::internal, "a factor is not finite; please report the scene");
        return put(value);
    }
    FactorText& index(std::uint64_t value) { return put(value); }
    /// Quoted as RFC 4180 asks where it would break a row.
    FactorText& word(std::string_view value) {
        if (value.find_first_of(",\"\r\n") == std::string_view::npos)
            return text(value);
        text("\"");
        for (char c : value)
            text(c == '"' ? std::string_view("\"\"") : std::string_view(&c, 1));
        return text("\"");
    }
    void commit() {
        output_.write(text_);
        output_.commit();
    }

private:
    static constexpr std::size_t chunk = std::size_t(1) << 20;

    template <class T>
    FactorText& put(T value) {
        char digits[32];
        return text({digits, std::to_chars(digits, digits + sizeof digits, value).ptr});
    }

    OutputFile output_;
    std::string text_;
};

}  // namespace parallux
