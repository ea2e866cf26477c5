#pragma once

#include <string>

#include "output/checksum.h"
#include "output/sealed_file.h"

namespace parallux::fuzz {

template <class T>
std::string raw(T value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// A whole file with this body: the head and checksum that would else turn away nearly every input.
inline std::string sealed(const FileKind& kind, const std::string& body) {
    std::string bytes = std::string(kind.magic, 8) + raw(kind.format) +
                        raw(std::uint64_t(sealed_head + body.size() + sealed_tail)) + body;
    Checksum sum;
    sum.add(bytes);
    return bytes + raw(sum.value());
}

}  // namespace parallux::fuzz
