#include "output/checksum.h"
#include "output/output_file.h"
#include "output/result_fields.h"

namespace parallux {

namespace {

// So much goes to the file at once.
constexpr std::size_t chunk = std::size_t(1) << 20;

// Finds how many bytes the fields take.
class Measure {
public:
    template <class T>
    void operator()(const T&) {
        bytes_ += sizeof(T);
    }
    template <class T>
    void operator()(const std::vector<T>& values) {
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

// Numbers as they lie in memory; texts and rows behind their length.
class Writer {
public:
    explicit Writer(OutputFile& output) : output_(output) {}

    template <class T>
    void operator()(const T& value) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        raw({reinterpret_cast<const char*>(&value), sizeof value});
    }
    template <class T>
    void operator()(const std::vector<T>& values) {
        (*this)(std::uint64_t(values.size()));
        raw({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
    }
    void operator()(const std::string& text) {
        (*this)(std::uint64_t(text.size()));
        raw(text);
    }
    void operator()(const std::vector<std::string>& texts) {
        (*this)(std::uint64_t(texts.size()));
        for (const std::string& text : texts)
            (*this)(text);
    }
    void raw(std::string_view bytes) {
        sum_.add(bytes);
        if (pending_.size() + bytes.size() > chunk)
            flush();
        if (bytes.size() > chunk)
            return output_.write(bytes);
        pending_ += bytes;
    }
    void finish() {
        (*this)(sum_.value());
        flush();
    }

private:
    void flush() {
        output_.write(pending_);
        pending_.clear();
    }

    OutputFile& output_;
    Checksum sum_;
    std::string pending_;
};

}  // namespace

void write_result(const std::filesystem::path& file, const SavedSolution& result) {
    // The fields' list is one for both ways, and reading has to change them.
    auto& fields = const_cast<SavedSolution&>(result);
    Measure measure;
    result_fields(measure, fields);
    OutputFile output(file);
    Writer writer(output);
    writer.raw({result_magic, sizeof result_magic - 1});
    writer(result_format);
    writer(result_head + measure.bytes() + sizeof(std::uint64_t));
    result_fields(writer, fields);
    writer.finish();
    output.commit();
}

}  // namespace parallux
