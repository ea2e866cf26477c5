#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace parallux {

/// Text from a file, fit for a message or a name: valid UTF-8 without control characters, cut at
/// `limit` bytes. What is replaced becomes '?'.
std::string printable(std::string_view text, std::size_t limit = 100);

/// Throws Fault::input with "file: place: what"; an empty place is left out.
[[noreturn]] void input_error(const std::filesystem::path& file, const std::string& place,
                              const std::string& what);

/// The most bytes one file may have.
inline constexpr std::uint64_t max_file_bytes = std::uint64_t(1) << 32;

/// A whole regular file; pipes and devices are refused because they may never end.
std::string read_file(const std::filesystem::path& file, std::uint64_t limit = max_file_bytes);

/// The file that `uri`, found at `place` in `scene_file`, names: percent-decoded, relative, and
/// below the scene's folder also after following links. A file that is absent is no error here.
std::filesystem::path resolve_below(const std::filesystem::path& scene_file,
                                    const std::string& place, std::string_view uri);

bool is_data_uri(std::string_view uri);
/// The bytes of a base64 `data:` URI.
std::string decode_data_uri(const std::filesystem::path& scene_file, const std::string& place,
                            std::string_view uri);

}  // namespace parallux
