#include "cli/values.h"

#include <charconv>
#include <cmath>

namespace parallux {

namespace {

constexpr std::uint32_t largest_side = 16384;  // pixels; 3 GiB of layers when square

/// True when the whole text is one number of this type.
template <class T>
bool read_all(const std::string& text, T& value) {
    auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && stop == text.data() + text.size();
}

std::string plain(double value) {
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

}  // namespace

void refuse(const std::string& option, const std::string& value, const std::string& what) {
    throw Error(Fault::usage, option + " " + (value.empty() ? "''" : value) + ": " + what);
}

std::uint64_t parse_count(const std::string& option, const std::string& value, std::uint64_t low,
                          std::uint64_t high) {
    std::uint64_t count = 0;
    double real = 0;
    bool whole = read_all(value, count);
    // Up to 2⁵³ a double holds whole numbers exactly.
    if (!whole && read_all(value, real) && real >= 0 && real <= 0x1p53 &&
        real == std::floor(real)) {
        count = static_cast<std::uint64_t>(real);
        whole = true;
    }
    if (!whole || count < low || count > high)
        refuse(
            option, value,
            "expected a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    return count;
}

double parse_real(const std::string& option, const std::string& value, double low, double high) {
    double real = 0;
    if (!read_all(value, real) || !(real >= low && real <= high))
        refuse(option, value, "expected a number from " + plain(low) + " to " + plain(high));
    return real;
}

double parse_positive(const std::string& option, const std::string& value) {
    double real = 0;
    if (!read_all(value, real) || !(real >= 1e-12 && real <= 1e15))
        refuse(option, value, "expected a number above 0 (1e-12 to 1e15)");
    return real;
}

std::uint64_t parse_bytes(const std::string& option, const std::string& value) {
    std::size_t digits = value.find_first_not_of("0123456789.");
    std::string suffix = digits == std::string::npos ? "" : value.substr(digits);
    double number = 0, unit = 1;
    bool known = read_all(value.substr(0, digits), number);
    if (!suffix.empty() && suffix != "B") {
        std::size_t power = std::string("KMGT").find(suffix[0] == 'k' ? 'K' : suffix[0]);
        std::string rest = suffix.substr(1);
        known =
            known && power != std::string::npos && (rest.empty() || rest == "iB" || rest == "B");
        unit = std::pow(rest == "B" ? 1000.0 : 1024.0, static_cast<double>(power + 1));
    }
    double bytes = number * unit;
    if (!known || !(bytes >= 1 && bytes <= 0x1p62))
        refuse(option, value, "expected bytes above 0, as in 500M, 1.5GiB or 200000000");
    return static_cast<std::uint64_t>(bytes);
}

std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& option,
                                                   const std::string& value) {
    std::size_t cross = value.find('x');
    std::uint32_t width = 0, height = 0;
    bool good = read_all(value.substr(0, cross), width) && width >= 1 && width <= largest_side;
    if (cross != std::string::npos)
        good = good && read_all(value.substr(cross + 1), height) && height >= 1 &&
               height <= largest_side;
    if (!good)
        refuse(option, value,
               "expected WIDTHxHEIGHT or WIDTH in pixels, each from 1 to " +
                   std::to_string(largest_side));
    return {width, height};
}

std::vector<std::string> parse_names(const std::string& option, const std::string& value) {
    std::vector<std::string> names(1);
    for (char c : value)
        if (c == ',')
            names.emplace_back();
        else
            names.back() += c;
    for (const std::string& name : names)
        if (name.empty() || value.starts_with("--"))
            refuse(option, value, "expected names with commas between them");
    return names;
}

std::filesystem::path parse_output(const std::string& option, const std::string& value) {
    if (value.empty() || value.starts_with("--"))
        refuse(option, value, "expected a file name");
    return value;
}

}  // namespace parallux
