#include "output/npz_file.h"

#include <array>
#include <bit>

namespace parallux {

namespace {

static_assert(std::endian::native == std::endian::little);

// CRC-32 as ZIP has it, eight bytes a step (M. Kounavis, F. Berry, A systematic approach to
// building high performance software-based CRC generators, 2005).
class Crc32 {
public:
    Crc32() {
        for (std::uint32_t byte = 0; byte < 256; ++byte) {
            std::uint32_t value = byte;
            for (int bit = 0; bit < 8; ++bit)
                value = value >> 1 ^ (value & 1 ? 0xedb88320u : 0);
            table_[0][byte] = value;
        }
        for (std::size_t k = 1; k < 8; ++k)
            for (std::size_t byte = 0; byte < 256; ++byte) {
                const std::uint32_t before = table_[k - 1][byte];
                table_[k][byte] = before >> 8 ^ table_[0][before & 255];
            }
    }
    std::uint32_t operator()(std::uint32_t crc, std::string_view bytes) const {
        crc = ~crc;
        const auto at = [&](std::size_t k) { return static_cast<unsigned char>(bytes[k]); };
        std::size_t k = 0;
        for (; k + 8 <= bytes.size(); k += 8) {
            std::uint32_t next = 0;
            for (unsigned b = 0; b < 4; ++b)
                next ^= table_[7 - b][(crc >> 8 * b & 255) ^ at(k + b)];
            for (unsigned b = 4; b < 8; ++b)
                next ^= table_[7 - b][at(k + b)];
            crc = next;
        }
        for (; k < bytes.size(); ++k)
            crc = crc >> 8 ^ table_[0][(crc ^ at(k)) & 255];
        return ~crc;
    }

private:
    std::array<std::array<std::uint32_t, 256>, 8> table_;
};

template <class T>
void put(std::string& text, T value) {
    for (std::size_t k = 0; k < sizeof value; ++k)
        text += static_cast<char>(value >> 8 * k & 255);
}

std::string npy_header(const std::string& type, const std::string& shape) {
    std::string text =
        "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
    constexpr std::size_t before = 10, align = 64;
    text.resize((before + text.size() + 1 + align - 1) / align * align - before - 1, ' ');
    text += '\n';
    std::string header = "\x93NUMPY";
    put<std::uint16_t>(header, 1);
    put(header, static_cast<std::uint16_t>(text.size()));
    return header + text;
}

constexpr std::uint16_t needs = 45;               // ZIP 4.5: 64-bit sizes
constexpr std::uint16_t date = 0x21;              // 1 January 1980, so that equal runs are equal
constexpr std::uint32_t see_extra = 0xffffffffu;  // sizes stand in the extra field

// What local headers and the directory share.
std::string common_fields(std::uint32_t crc, const std::string& name, std::uint16_t extra) {
    std::string text;
    put<std::uint16_t>(text, needs);
    put<std::uint32_t>(text, 0);  // no flags, stored
    put<std::uint16_t>(text, 0);
    put<std::uint16_t>(text, date);
    put(text, crc);
    put(text, see_extra);
    put(text, see_extra);
    put(text, static_cast<std::uint16_t>(name.size()));
    put(text, extra);
    return text;
}

std::string sizes_field(std::uint64_t size, std::uint16_t bytes) {
    std::string text;
    put<std::uint16_t>(text, 1);
    put(text, bytes);
    put(text, size);
    put(text, size);
    return text;
}

}  // namespace

void NpzFile::write(std::string_view bytes) {
    output_.write(bytes);
    written_ += bytes.size();
}

void NpzFile::add(const std::string& name, const std::string& type, const std::string& shape,
                  std::string_view bytes) {
    static const Crc32 crc;
    const std::string header = npy_header(type, shape);
    const Member member{name + ".npy", written_, header.size() + bytes.size(),
                        crc(crc(0, header), bytes)};
    std::string local;
    put<std::uint32_t>(local, 0x04034b50);
    write(local + common_fields(member.crc, member.name, 20) + member.name +
          sizes_field(member.size, 16));
    write(header);
    write(bytes);
    members_.push_back(member);
}

void NpzFile::commit() {
    const std::uint64_t begin = written_;
    for (const Member& member : members_) {
        std::string entry;
        put<std::uint32_t>(entry, 0x02014b50);
        put<std::uint16_t>(entry, needs);
        entry += common_fields(member.crc, member.name, 28);
        put<std::uint32_t>(entry, 0);  // no comment, on this disk
        put<std::uint16_t>(entry, 0);
        put<std::uint32_t>(entry, 0);
        put(entry, see_extra);
        entry += member.name + sizes_field(member.size, 24);
        put(entry, member.offset);
        write(entry);
    }
    const std::uint64_t end = written_, count = members_.size();
    std::string last;
    put<std::uint32_t>(last, 0x06064b50);
    put<std::uint64_t>(last, 44);
    put(last, needs);
    put(last, needs);
    put<std::uint64_t>(last, 0);
    for (std::uint64_t value : {count, count, end - begin, begin})
        put(last, value);
    put<std::uint32_t>(last, 0x07064b50);
    put<std::uint32_t>(last, 0);
    put(last, end);
    put<std::uint32_t>(last, 1);
    put<std::uint32_t>(last, 0x06054b50);
    put<std::uint32_t>(last, 0);
    put(last, static_cast<std::uint16_t>(count));
    put(last, static_cast<std::uint16_t>(count));
    put(last, see_extra);
    put(last, see_extra);
    put<std::uint16_t>(last, 0);
    write(last);
    output_.commit();
}

}  // namespace parallux
