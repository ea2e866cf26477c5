#include "output/sealed_file.h"

#include <cstdio>
#include <cstring>

#include "scene/input.h"

namespace parallux {

namespace {

// So much goes to the file at once.
constexpr std::size_t chunk = std::size_t(1) << 20;
constexpr std::size_t magic_bytes = 8;

template <class T>
std::string_view bytes_of(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

template <class T>
T word_at(const std::string& bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

}  // namespace

SealedFile::SealedFile(const std::filesystem::path& file, const FileKind& kind,
                       std::uint64_t body_bytes)
    : output_(file) {
    (*this)({kind.magic, magic_bytes});
    (*this)(bytes_of(kind.format));
    (*this)(bytes_of(sealed_head + body_bytes + sealed_tail));
}

void SealedFile::operator()(std::string_view bytes) {
    sum_.add(bytes);
    if (pending_.size() + bytes.size() > chunk)
        flush();
    if (bytes.size() > chunk)
        return output_.write(bytes);
    pending_ += bytes;
}

void SealedFile::commit() {
    pending_ += bytes_of(sum_.value());
    flush();
    output_.commit();
}

void SealedFile::flush() {
    output_.write(pending_);
    pending_.clear();
}

void check_sealed(const std::filesystem::path& file, const std::string& bytes,
                  const FileKind& kind) {
    const std::string name = kind.name, remedy = std::string("; ") + kind.remedy;
    auto fail = [&](const std::string& what) { input_error(file, "", what); };
    if (bytes.compare(0, magic_bytes, kind.magic, magic_bytes) != 0)
        fail("not " + name + " of " + kind.maker);
    if (bytes.size() < sealed_head + sealed_tail)
        fail("damaged: it ends too early" + remedy);
    if (const auto format = word_at<std::uint32_t>(bytes, magic_bytes); format != kind.format)
        fail(name + " of format " + std::to_string(format) + ", this version reads format " +
             std::to_string(kind.format) + remedy);
    if (const auto size = word_at<std::uint64_t>(bytes, magic_bytes + 4); size != bytes.size())
        fail("damaged: it has " + std::to_string(bytes.size()) + " bytes in place of " +
             std::to_string(size) + remedy);
    Checksum sum;
    sum.add(std::string_view(bytes).substr(0, bytes.size() - sealed_tail));
    if (sum.value() != word_at<std::uint64_t>(bytes, bytes.size() - sealed_tail))
        fail("damaged: its checksum is wrong" + remedy);
}

std::string read_sealed(const std::filesystem::path& file, const FileKind& kind) {
    std::string bytes = read_file(file, most_sealed_bytes);
    check_sealed(file, bytes, kind);
    return bytes;
}

std::string hash_text(std::uint64_t hash) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

}  // namespace parallux
