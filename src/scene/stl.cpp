#include <bit>
#include <charconv>
#include <cstring>
#include <string_view>

#include "scene/input.h"
#include "scene/loaders.h"

namespace parallux {
namespace {

std::uint32_t facet_count(const std::string& bytes) {
    std::uint32_t n = 0;
    for (std::size_t i = 0; i < 4; ++i)
        n |= std::uint32_t(static_cast<unsigned char>(bytes[80 + i])) << (8 * i);
    return n;
}

// Some writers begin binary files with "solid", too: only the size tells.
bool is_binary(const std::string& bytes) {
    return bytes.size() >= 84 && bytes.size() == 84 + 50 * std::uint64_t(facet_count(bytes));
}

void read_binary(SceneBuilder& builder, const std::string& bytes, Mesh& mesh) {
    std::uint32_t facets = facet_count(bytes);
    mesh.positions.resize(3 * std::size_t(facets));
    for (std::size_t f = 0; f < facets; ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            float xyz[3];
            std::memcpy(xyz, bytes.data() + 84 + 50 * f + 12 * (k + 1), sizeof xyz);
            mesh.positions[3 * f + k] = {xyz[0], xyz[1], xyz[2]};
        }
    mesh.object = add_object(builder.scene(), builder.scene().file.stem().string());
}

// Words of an ASCII file, with the line they stand in.
class Words {
public:
    explicit Words(std::string_view text) : text_(text) {}

    std::string_view next() {
        while (at_ < text_.size() && is_space(text_[at_]))
            line_ += text_[at_++] == '\n';
        std::size_t from = at_;
        while (at_ < text_.size() && !is_space(text_[at_]))
            ++at_;
        return text_.substr(from, at_ - from);
    }
    std::string_view rest_of_line() {
        std::size_t from = at_;
        at_ = std::min(text_.find('\n', at_), text_.size());
        return text_.substr(from, at_ - from);
    }
    std::string line() const { return "line " + std::to_string(line_); }

private:
    static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

    std::string_view text_;
    std::size_t at_ = 0;
    std::uint64_t line_ = 1;
};

class AsciiReader {
public:
    AsciiReader(SceneBuilder& builder, const std::string& text, std::uint32_t material)
        : builder_(builder), words_(text), material_(material) {}

    void read() {
        for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
            if (word == "solid") {
                finish_solid();
                name_ = trimmed(words_.rest_of_line());
            } else if (word == "facet") {
                read_facet();
            } else if (word == "endsolid") {
                words_.rest_of_line();
            } else {
                fail(word, "\"facet\", \"solid\" or \"endsolid\"");
            }
        }
        finish_solid();
    }

private:
    [[noreturn]] void fail(std::string_view found, const std::string& wanted) {
        input_error(builder_.scene().file, words_.line(),
                    (found.empty() ? "the file ends" : "\"" + printable(found, 40) + "\" stands") +
                        " where " + wanted + " must be");
    }
    void expect(std::string_view wanted) {
        std::string_view word = words_.next();
        if (word != wanted)
            fail(word, "\"" + std::string(wanted) + "\"");
    }
    double number() {
        std::string_view word = words_.next();
        std::string_view digits = word.substr(!word.empty() && word[0] == '+' ? 1 : 0);
        double x = 0;
        auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
        if (error != std::errc() || end != digits.data() + digits.size())
            fail(word, "a number");
        return x;
    }
    void read_facet() {
        expect("normal");  // which the corners say better
        for (int i = 0; i < 3; ++i)
            words_.next();
        expect("outer");
        expect("loop");
        for (int k = 0; k < 3; ++k) {
            expect("vertex");
            double x = number(), y = number(), z = number();
            builder_.check({x, y, z}, words_.line(), mesh_.positions.size());
            mesh_.positions.emplace_back(x, y, z);
        }
        expect("endloop");
        expect("endfacet");
    }
    void finish_solid() {
        if (mesh_.positions.empty())
            return;
        mesh_.place = "solid before " + words_.line();
        mesh_.material = material_;
        mesh_.object =
            add_object(builder_.scene(), name_or(name_, builder_.scene().file.stem().string()));
        mesh_.indices.resize(mesh_.positions.size());
        for (std::size_t i = 0; i < mesh_.indices.size(); ++i)
            mesh_.indices[i] = static_cast<std::uint32_t>(i);
        builder_.add(mesh_);
        mesh_ = Mesh();
    }
    static std::string trimmed(std::string_view text) {
        std::size_t from = text.find_first_not_of(" \t\r");
        std::size_t to = text.find_last_not_of(" \t\r");
        return from == text.npos ? "" : std::string(text.substr(from, to - from + 1));
    }

    SceneBuilder& builder_;
    Words words_;
    std::uint32_t material_;
    std::string name_;
    Mesh mesh_;
};

}  // namespace

bool looks_like_stl(const std::string& bytes) {
    return is_binary(bytes) || bytes.compare(0, 6, "solid ") == 0 ||
           bytes.compare(0, 6, "solid\n") == 0 || bytes.compare(0, 6, "solid\r") == 0;
}

void read_stl(SceneBuilder& builder, const std::string& bytes) {
    Scene& scene = builder.scene();
    // Winding says which side is out, as the format demands: one-sided.
    std::uint32_t material = add_material(scene, default_material(builder.settings(), false));
    if (!is_binary(bytes)) {
        std::size_t begin = bytes.find_first_not_of(" \t\r\n");
        if (begin == bytes.npos || bytes.compare(begin, 5, "solid") != 0) {
            std::string counted =
                bytes.size() >= 84 ? std::to_string(facet_count(bytes)) + " facets" : "a header";
            input_error(scene.file, "",
                        "no STL: ASCII begins with \"solid\", and " + std::to_string(bytes.size()) +
                            " bytes do not hold " + counted + "; it may be cut short");
        }
        return AsciiReader(builder, bytes, material).read();
    }
    Mesh mesh;
    mesh.place = "facets";
    mesh.material = material;
    read_binary(builder, bytes, mesh);
    mesh.indices.resize(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        mesh.indices[i] = static_cast<std::uint32_t>(i);
    builder.add(mesh);
}

}  // namespace parallux
