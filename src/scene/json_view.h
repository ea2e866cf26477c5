#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

namespace parallux {

using Json = nlohmann::json;

/// Parses JSON of bounded size and depth (256). Throws Fault::input.
Json parse_json(const std::filesystem::path& file, std::string_view text);

/// A value in a JSON file together with where it stands. Every access checks the type and throws
/// Fault::input naming the file and the JSON path, so that no loader meets an unchecked value.
class JsonView {
public:
    JsonView(const std::filesystem::path& file, const Json& value, std::string path = "")
        : file_(&file), value_(&value), path_(std::move(path)) {}

    const std::filesystem::path& file() const { return *file_; }
    const std::string& path() const { return path_; }
    [[noreturn]] void fail(const std::string& what) const;

    bool is_number() const { return value_->is_number(); }
    bool is_string() const { return value_->is_string(); }
    bool is_array() const { return value_->is_array(); }
    bool is_object() const { return value_->is_object(); }

    // Objects.
    bool has(const char* key) const;
    JsonView at(const char* key) const;  ///< which must be there
    std::optional<JsonView> find(const char* key) const;
    /// Refuses any key that is not listed; a misspelt one would otherwise go unnoticed.
    void only(std::initializer_list<std::string_view> keys) const;
    const Json& object() const;

    // Arrays.
    std::size_t size() const;
    JsonView at(std::size_t index) const;

    // Values. Numbers are finite and at most 10¹⁵ in size.
    double number() const;
    double number(double low, double high) const;
    std::uint64_t count(std::uint64_t maximum) const;
    const std::string& text() const;
    bool boolean() const;
    glm::dvec3 vector() const;

    // A value or, where the key is absent, a default.
    double number_or(const char* key, double otherwise) const;
    std::uint64_t count_or(const char* key, std::uint64_t otherwise, std::uint64_t maximum) const;
    std::string text_or(const char* key, const std::string& otherwise) const;
    bool boolean_or(const char* key, bool otherwise) const;

private:
    const std::filesystem::path* file_;
    const Json* value_;
    std::string path_;
};

}  // namespace parallux
