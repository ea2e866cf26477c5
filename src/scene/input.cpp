#include "scene/input.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <new>
#include <system_error>

#include "parallux/error.h"

namespace parallux {
namespace {

// Length of the well-formed UTF-8 sequence at `at`, 0 where there is none (RFC 3629 table).
std::size_t utf8_length(std::string_view text, std::size_t at) {
    auto byte = [&](std::size_t i) {
        return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0u;
    };
    auto tail = [&](std::size_t i) { return (byte(i) & 0xC0u) == 0x80u; };
    unsigned lead = byte(0), second = byte(1);
    if (lead < 0x80)
        return 1;
    if (lead >= 0xC2 && lead <= 0xDF)
        return tail(1) ? 2 : 0;
    if (lead >= 0xE0 && lead <= 0xEF) {
        bool overlong = lead == 0xE0 && second < 0xA0, surrogate = lead == 0xED && second > 0x9F;
        return tail(1) && tail(2) && !overlong && !surrogate ? 3 : 0;
    }
    if (lead >= 0xF0 && lead <= 0xF4) {
        bool overlong = lead == 0xF0 && second < 0x90, beyond = lead == 0xF4 && second > 0x8F;
        return tail(1) && tail(2) && tail(3) && !overlong && !beyond ? 4 : 0;
    }
    return 0;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return -1;
}

std::string percent_decoded(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
        int low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : -1;
        if (uri[i] == '%' && high >= 0 && low >= 0) {
            text += static_cast<char>(high * 16 + low);
            i += 2;
        } else {
            text += uri[i];
        }
    }
    return text;
}

}  // namespace

std::string printable(std::string_view text, std::size_t limit) {
    std::string result;
    for (std::size_t i = 0; i < text.size();) {
        std::size_t length = utf8_length(text, i);
        auto byte = static_cast<unsigned char>(text[i]);
        if (result.size() + length > limit)
            return result + "...";
        // C1 controls (U+0080 … U+009F) also move a terminal's cursor.
        bool c1 = length == 2 && byte == 0xC2 && static_cast<unsigned char>(text[i + 1]) < 0xA0;
        if (length == 0 || c1 || byte < 0x20 || byte == 0x7F)
            result += '?';
        else
            result += text.substr(i, length);
        i += length == 0 ? 1 : length;
    }
    return result;
}

void input_error(const std::filesystem::path& file, const std::string& place,
                 const std::string& what) {
    std::string message = printable(file.string(), 400) + ": ";
    if (!place.empty())
        message += printable(place, 300) + ": ";
    throw Error(Fault::input, message + printable(what, 400));
}

std::string read_file(const std::filesystem::path& file, std::uint64_t limit) {
    std::error_code fault;
    auto status = std::filesystem::status(file, fault);
    if (!std::filesystem::exists(status))
        input_error(file, "", "no such file; check the path");
    if (!std::filesystem::is_regular_file(status))
        input_error(file, "", "not a regular file; give a file, not a folder, pipe or device");
    std::uint64_t size = std::filesystem::file_size(file, fault);
    if (fault)
        input_error(file, "", "cannot be read: " + fault.message());
    if (size > limit)
        input_error(file, "",
                    std::to_string(size) + " bytes, more than the " + std::to_string(limit) +
                        " allowed here; split it");
    std::ifstream stream(file, std::ios::binary);
    std::string bytes;
    try {
        bytes.resize(size);
    } catch (const std::bad_alloc&) {
        throw Error(Fault::memory, printable(file.string(), 400) + ": too large for this machine");
    }
    if (!stream || !stream.read(bytes.data(), static_cast<std::streamsize>(size)))
        input_error(file, "", "cannot be read; check its permissions");
    return bytes;
}

std::filesystem::path resolve_below(const std::filesystem::path& scene_file,
                                    const std::string& place, std::string_view uri) {
    std::string text = percent_decoded(uri);
    auto refuse = [&](const std::string& why) {
        input_error(scene_file, place,
                    "\"" + printable(text) + "\" " + why +
                        "; put the file below the scene's folder and name it relatively");
    };
    if (text.empty())
        refuse("names no file");
    if (text.find('\0') != std::string::npos)
        refuse("holds a zero byte");
    if (text.find("://") != std::string::npos)
        refuse("is not a relative path");
    // OBJ files from Windows separate folders by backslashes.
    for (char& c : text)
        if (c == '\\')
            c = '/';
    std::filesystem::path relative(text);
    if (relative.is_absolute())
        refuse("is an absolute path");
    for (const auto& part : relative)
        if (part == "..")
            refuse("leads out of the scene's folder");
    std::filesystem::path folder = scene_file.parent_path();
    if (folder.empty())
        folder = ".";
    std::error_code fault;
    auto root = std::filesystem::weakly_canonical(folder, fault);
    auto target = fault ? root : std::filesystem::weakly_canonical(folder / relative, fault);
    if (fault)
        refuse("cannot be followed: " + fault.message());
    auto [end, _] = std::mismatch(root.begin(), root.end(), target.begin(), target.end());
    if (end != root.end())
        refuse("leads out of the scene's folder through a link");
    return folder / relative;
}

bool is_data_uri(std::string_view uri) {
    return uri.substr(0, 5) == "data:";
}

std::string decode_data_uri(const std::filesystem::path& scene_file, const std::string& place,
                            std::string_view uri) {
    std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || uri.substr(0, comma).find(";base64") == uri.npos)
        input_error(scene_file, place, "a data: URI without base64 content; embed it as base64");
    static const auto table = [] {
        std::array<signed char, 256> values{};
        values.fill(-1);
        const std::string_view digits =
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        for (std::size_t i = 0; i < digits.size(); ++i)
            values[static_cast<unsigned char>(digits[i])] = static_cast<signed char>(i);
        values['-'] = 62;  // the URL-safe digits, which some exporters use
        values['_'] = 63;
        return values;
    }();
    std::string bytes;
    bytes.reserve((uri.size() - comma) / 4 * 3);
    std::uint32_t bits = 0;
    int count = 0;
    for (std::size_t i = comma + 1; i < uri.size() && uri[i] != '='; ++i) {
        int value = table[static_cast<unsigned char>(uri[i])];
        if (value < 0)
            input_error(scene_file, place,
                        "no base64 at character " + std::to_string(i) + " of the data: URI");
        bits = (bits << 6 | static_cast<std::uint32_t>(value)) & 0xFFFFFFu;
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes += static_cast<char>(bits >> count & 0xFFu);
        }
    }
    return bytes;
}

}  // namespace parallux
