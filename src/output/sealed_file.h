#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "output/checksum.h"
#include "output/output_file.h"

namespace parallux {

/// A kind of binary file of ours: magic, format and the file's length; then its body, then a
/// checksum of all before.
struct FileKind {
    const char* magic;     ///< eight bytes; the last two tell when a transfer has changed line ends
    std::uint32_t format;  ///< its number
    const char* name;      ///< "a result"
    const char* maker;     ///< "parallux solve --save"
    const char* remedy;    ///< "solve again with --save"
};

/// Bytes before and behind the body.
inline constexpr std::uint64_t sealed_head = 8 + 4 + 8, sealed_tail = 8;

/// Writes one, piece by piece. Without commit() an older file stays as it was. Throws
/// Fault::output.
class SealedFile {
public:
    SealedFile(const std::filesystem::path& file, const FileKind& kind, std::uint64_t body_bytes);

    void operator()(std::string_view bytes);
    void commit();

private:
    void flush();

    OutputFile output_;
    Checksum sum_;
    std::string pending_;
};

inline constexpr std::uint64_t most_sealed_bytes = std::uint64_t(1) << 36;

/// Throws Fault::input unless these are the bytes of a whole file of that kind: for a file that is
/// none, of another format, cut, longer, or changed in any byte.
void check_sealed(const std::filesystem::path& file, const std::string& bytes,
                  const FileKind& kind);

/// A whole file of that kind; its body lies between head and tail. Throws as check_sealed().
std::string read_sealed(const std::filesystem::path& file, const FileKind& kind);
inline std::string_view body_of(const std::string& sealed) {
    return std::string_view(sealed).substr(sealed_head, sealed.size() - sealed_head - sealed_tail);
}

/// As messages have it: sixteen hexadecimal digits.
std::string hash_text(std::uint64_t hash);

}  // namespace parallux
