#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "random.h"

namespace parallux {

static_assert(std::endian::native == std::endian::little, "files here are little endian");

/// 64 bits over a row of bytes, by words. Each step is one to one in the word and in what came
/// before, so that a change within one word never goes unseen.
class Checksum {
public:
    void add(std::string_view bytes) {
        length_ += bytes.size();
        while (!bytes.empty()) {
            const std::size_t taken = std::min(bytes.size(), sizeof word_ - filled_);
            std::memcpy(reinterpret_cast<char*>(&word_) + filled_, bytes.data(), taken);
            bytes.remove_prefix(taken);
            filled_ += taken;
            if (filled_ == sizeof word_) {
                sum_ = next(sum_, word_);
                word_ = 0, filled_ = 0;
            }
        }
    }
    std::uint64_t value() const { return next(next(sum_, word_), length_); }

private:
    static std::uint64_t next(std::uint64_t sum, std::uint64_t word) {
        return mix64((sum + 0x9e3779b97f4a7c15ull) ^ word);
    }

    std::uint64_t sum_ = 0, word_ = 0, length_ = 0;
    std::size_t filled_ = 0;
};

}  // namespace parallux
