#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "parallux/error.h"

// What stands after an option, read strictly: the whole text, in range, whatever the locale.
// Each throws Fault::usage naming the option and the value.

namespace parallux {

/// Fault::usage "OPTION VALUE: what".
[[noreturn]] void refuse(const std::string& option, const std::string& value,
                         const std::string& what);

/// A whole number in [low, high]; "1e8" is one too.
std::uint64_t parse_count(const std::string& option, const std::string& value, std::uint64_t low,
                          std::uint64_t high = std::numeric_limits<std::uint64_t>::max());

/// A finite number in [low, high].
double parse_real(const std::string& option, const std::string& value, double low, double high);

/// A finite number above 0, in a range that lengths and times have.
double parse_positive(const std::string& option, const std::string& value);

/// Bytes: "500M", "1.5GiB", "200kB"; K, M, G, T and KiB … are powers of 1024, KB … of 1000.
std::uint64_t parse_bytes(const std::string& option, const std::string& value);

/// "640x480", or "640" with height 0.
std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& option,
                                                   const std::string& value);

/// "a,b*": names with commas between them, none empty.
std::vector<std::string> parse_names(const std::string& option, const std::string& value);

/// A file name, which an option's is not.
std::filesystem::path parse_output(const std::string& option, const std::string& value);

/// One of some words.
template <class T>
T parse_choice(const std::string& option, const std::string& value,
               const std::vector<std::pair<std::string, T>>& choices) {
    std::string words;
    for (const auto& [word, meaning] : choices) {
        if (word == value)
            return meaning;
        words += (words.empty() ? "" : ", ") + word;
    }
    refuse(option, value, "expected one of " + words);
}

}  // namespace parallux
