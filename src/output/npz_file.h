#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "output/output_file.h"

namespace parallux {

/// NumPy's .npz: a ZIP archive (APPNOTE 6.3, stored, with 64-bit sizes) of .npy arrays
/// (format 1.0), in the machine's order of bytes, which must be little-endian. Same arrays, same
/// bytes.
class NpzFile {
public:
    explicit NpzFile(const std::filesystem::path& file) : output_(file) {}

    /// `type` as NumPy describes it, "<f8"; `shape` as Python writes it, "(3,)".
    void add(const std::string& name, const std::string& type, const std::string& shape,
             std::string_view bytes);
    template <class T>
    void add_array(const std::string& name, const std::string& type, const std::vector<T>& values) {
        add(name, type, "(" + std::to_string(values.size()) + ",)",
            {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
    }
    /// Writes the archive's directory and puts the file in its place.
    void commit();

private:
    struct Member {
        std::string name;
        std::uint64_t offset, size;
        std::uint32_t crc;
    };
    void write(std::string_view bytes);

    OutputFile output_;
    std::uint64_t written_ = 0;
    std::vector<Member> members_;
};

}  // namespace parallux
