#include <cmath>

#include "output/checksum.h"
#include "output/result_fields.h"
#include "parallux/error.h"
#include "scene/input.h"

namespace parallux {

namespace {

// The fields of a file whose checksum is right. It may still be made up: nothing is taken that the
// bytes do not hold.
class Reader {
public:
    Reader(const std::filesystem::path& file, std::string_view bytes)
        : file_(file), bytes_(bytes) {}

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
    template <class T>
    void operator()(std::vector<T>& values) {
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

private:
    [[noreturn]] void fail(const char* what) const {
        input_error(file_, "", std::string("damaged: ") + what + "; solve again with --save");
    }
    std::string_view take(std::size_t size) {
        if (size > bytes_.size())
            fail("it ends too early");
        std::string_view taken = bytes_.substr(0, size);
        bytes_.remove_prefix(size);
        return taken;
    }
    template <class T>
    T number() {
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
    void check(T value) const {
        if constexpr (std::is_same_v<T, float>)
            if (!std::isfinite(value))
                fail("a value that is no finite number");
    }

    const std::filesystem::path& file_;
    std::string_view bytes_;
};

template <class T>
T word_at(const std::string& bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

// What can be told before any field is read.
void check_whole(const std::filesystem::path& file, const std::string& bytes) {
    auto fail = [&](const std::string& what) { input_error(file, "", what); };
    constexpr std::size_t magic = sizeof result_magic - 1, tail = sizeof(std::uint64_t);
    if (bytes.compare(0, magic, result_magic) != 0)
        fail("not a result of parallux solve --save");
    if (bytes.size() < result_head + tail)
        fail("damaged: it ends too early; solve again with --save");
    if (const auto format = word_at<std::uint32_t>(bytes, magic); format != result_format)
        fail("a result of format " + std::to_string(format) + ", this version reads format " +
             std::to_string(result_format) + "; solve again with --save");
    if (const auto size = word_at<std::uint64_t>(bytes, magic + 4); size != bytes.size())
        fail("damaged: it has " + std::to_string(bytes.size()) + " bytes in place of " +
             std::to_string(size) + "; solve again with --save");
    Checksum sum;
    sum.add(std::string_view(bytes).substr(0, bytes.size() - tail));
    if (sum.value() != word_at<std::uint64_t>(bytes, bytes.size() - tail))
        fail("damaged: its checksum is wrong; solve again with --save");
}

std::string hash_text(std::uint64_t hash) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

}  // namespace

SavedSolution read_result(const std::filesystem::path& file) {
    const std::string bytes = read_file(file, std::uint64_t(1) << 36);
    check_whole(file, bytes);
    SavedSolution result;
    Reader reader(file, std::string_view(bytes).substr(
                            result_head, bytes.size() - result_head - sizeof(std::uint64_t)));
    result_fields(reader, result);
    reader.end();
    return result;
}

void check_result(const std::filesystem::path& file, const SavedSolution& result,
                  const Scene& scene, const Patches& patches) {
    const Solution& solution = result.solution;
    const std::size_t values = patches.count() * patches.bands;
    const std::uint64_t hash = scene_hash(scene, patches);
    if (result.scene == hash && solution.bands == patches.bands &&
        solution.irradiance.size() == values && solution.radiosity.size() == values &&
        (solution.stderror.empty() || solution.stderror.size() == values))
        return;
    input_error(file, "",
                "a result of another scene or other patches: it is of " + hash_text(result.scene) +
                    ", while " + printable(scene.file.filename().string()) + " now gives " +
                    hash_text(hash) + "; solve again with --save");
}

}  // namespace parallux
