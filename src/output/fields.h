#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "parallux/solve.h"
#include "scene/input.h"

// Archives for the fields of our binary files: one list of fields, called with each of these,
// measures, writes and reads them. Numbers as they lie in memory; texts and rows behind their
// length.

namespace parallux {

/// Finds how many bytes the fields take.
class Measure {
public:
    template <class T>
    void operator()(const T&) {
        bytes_ += sizeof(T);
    }
    template <class T, class A>
    void operator()(const std::vector<T, A>& values) {
        bytes_ += sizeof(std::uint64_t) + values.size() * sizeof(T);
    }
    void operator()(const std::string& text) { bytes_ += sizeof(std::uint64_t) + text.size(); }
    void operator()(const std::vector<std::string>& texts) {
        bytes_ += sizeof(std::uint64_t);
        for (const std::string& text : texts)
            (*this)(text);
    }
    std::uint64_t bytes() const { return bytes_; }

private:
    std::uint64_t bytes_ = 0;
};

/// Gives the fields' bytes to a sink, piece by piece.
template <class Sink>
class FieldWriter {
public:
    explicit FieldWriter(Sink& sink) : sink_(sink) {}

    template <class T>
    void operator()(const T& value) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        sink_({reinterpret_cast<const char*>(&value), sizeof value});
    }
    template <class T, class A>
    void operator()(const std::vector<T, A>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        (*this)(std::uint64_t(values.size()));
        sink_({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
    }
    void operator()(const std::string& text) {
        (*this)(std::uint64_t(text.size()));
        sink_(text);
    }
    void operator()(const std::vector<std::string>& texts) {
        (*this)(std::uint64_t(texts.size()));
        for (const std::string& text : texts)
            (*this)(text);
    }

private:
    Sink& sink_;
};

/// Reads the fields of a file whose checksum is right. It may still be made up: nothing is taken
/// that the bytes do not hold. Throws Fault::input that names the file and ends with the remedy.
class FieldReader {
public:
    FieldReader(const std::filesystem::path& file, std::string_view bytes, const char* remedy)
        : file_(file), bytes_(bytes), remedy_(remedy) {}

    void operator()(bool& value) { value = number<std::uint8_t>() != 0; }
    void operator()(Method& value) {
        const auto read = number<std::underlying_type_t<Method>>();
        if (read < 0 || read > std::underlying_type_t<Method>(Method::matrix))
            fail("a method that is none");
        value = Method(read);
    }
    template <class T>
    void operator()(T& value) {
        value = number<T>();
        check(value);
    }
    template <class T, class A>
    void operator()(std::vector<T, A>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        values.resize(count(sizeof(T)));
        std::string_view bytes = take(values.size() * sizeof(T));
        if (!bytes.empty())
            std::memcpy(values.data(), bytes.data(), bytes.size());
        for (const T& value : values)
            check(value);
    }
    void operator()(std::string& text) { text = take(count(1)); }
    void operator()(std::vector<std::string>& texts) {
        texts.resize(count(sizeof(std::uint64_t)));  // at least the length of each
        for (std::string& text : texts)
            (*this)(text);
    }
    void end() const {
        if (!bytes_.empty())
            fail("bytes beyond its end");
    }
    [[noreturn]] void fail(const char* what) const {
        input_error(file_, "", std::string("damaged: ") + what + "; " + remedy_);
    }

private:
    std::string_view take(std::size_t size) {
        if (size > bytes_.size())
            fail("it ends too early");
        std::string_view taken = bytes_.substr(0, size);
        bytes_.remove_prefix(size);
        return taken;
    }
    template <class T>
    T number() {
        static_assert(std::is_arithmetic_v<T>);
        T value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    std::size_t count(std::size_t bytes_each) {
        const auto wanted = number<std::uint64_t>();
        if (wanted > bytes_.size() / bytes_each)
            fail("a count beyond its bytes");
        return static_cast<std::size_t>(wanted);
    }
    template <class T>
    void check(const T& value) const {
        if constexpr (std::is_same_v<T, float>)
            if (!std::isfinite(value))
                fail("a value that is no finite number");
    }

    const std::filesystem::path& file_;
    std::string_view bytes_;
    const char* remedy_;
};

/// Parts that several files have.
template <class Archive>
void fields_of(Archive& a, Balance& e) {
    a(e.watts_per_quantum);
    a(e.emitted), a(e.absorbed), a(e.escaped), a(e.unshot), a(e.residual);
}

template <class Archive>
void fields_of(Archive& a, LineCounts& c) {
    a(c.lines), a(c.nonempty), a(c.hits), a(c.transfers), a(c.odd), a(c.met_backs);
}

template <class Archive>
void fields_of(Archive& a, Seconds& t) {
    a(t.load), a(t.patches), a(t.first_shot), a(t.global), a(t.gather), a(t.output), a(t.total);
    a(t.serial);
}

}  // namespace parallux
