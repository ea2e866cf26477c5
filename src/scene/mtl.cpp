#include <algorithm>

#include "scene/input.h"
#include "scene/obj.h"

namespace parallux {
namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

// Options of a map statement stand before its file: a name and this many values.
std::size_t option_values(std::string_view option) {
    if (option == "-o" || option == "-s" || option == "-t")
        return 3;
    return option == "-mm" ? 2 : 1;
}

std::string map_file(ObjLines& lines) {
    std::string rest = lines.rest();
    std::string_view left = rest;
    auto word = [&] {
        std::size_t end = std::min(left.find_first_of(" \t"), left.size());
        std::string_view w = left.substr(0, end);
        left.remove_prefix(std::min(left.find_first_not_of(" \t", end), left.size()));
        return w;
    };
    while (!left.empty() && left[0] == '-') {
        std::size_t values = option_values(word());
        // Three-valued options may leave out the last two.
        auto is_number = [&] {
            return !left.empty() && (std::isdigit(static_cast<unsigned char>(left[0])) != 0 ||
                                     left[0] == '.' || left[0] == '-');
        };
        for (std::size_t i = 0; i < values && (i == 0 || is_number()); ++i)
            word();
    }
    return std::string(left);
}

}  // namespace

bool ObjLines::next() {
    while (!text_.empty()) {
        line_ = next_line_;
        joined_.clear();
        for (bool more = true; more && !text_.empty();) {
            std::size_t end = std::min(text_.find('\n'), text_.size());
            std::string_view line = text_.substr(0, end);
            text_.remove_prefix(std::min(end + 1, text_.size()));
            ++next_line_;
            while (!line.empty() && line.back() == '\r')
                line.remove_suffix(1);
            more = !line.empty() && line.back() == '\\';
            if (more)
                line.remove_suffix(1);
            if (more || !joined_.empty())
                left_ = joined_ += std::string(line) + " ";
            else
                left_ = line;
        }
        while (!left_.empty() && is_blank(left_.front()))
            left_.remove_prefix(1);
        if (!left_.empty() && left_.front() != '#')
            return true;
    }
    return false;
}

std::string_view ObjLines::word() {
    while (!left_.empty() && is_blank(left_.front()))
        left_.remove_prefix(1);
    std::size_t n = 0;
    while (n < left_.size() && !is_blank(left_[n]))
        ++n;
    std::string_view result = left_.substr(0, n);
    left_.remove_prefix(n);
    if (!result.empty() && result[0] == '#') {  // a comment ends the line
        left_ = {};
        return {};
    }
    return result;
}

std::string ObjLines::rest() {
    while (!left_.empty() && is_blank(left_.front()))
        left_.remove_prefix(1);
    while (!left_.empty() && is_blank(left_.back()))
        left_.remove_suffix(1);
    return std::string(std::exchange(left_, {}));
}

double ObjLines::number() {
    std::string_view w = word();
    std::string_view digits = w.substr(!w.empty() && w[0] == '+' ? 1 : 0);
    double x = 0;
    auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
    if (error != std::errc() || end != digits.data() + digits.size() || !(std::abs(x) <= 1e15))
        fail(w.empty() ? "a number is missing"
                       : "\"" + printable(w, 40) + "\" is no number up to 1e15");
    return x;
}

double ObjLines::number_or(double otherwise) {
    std::string_view before = left_;
    if (word().empty())
        return otherwise;
    left_ = before;
    return number();
}

void ObjLines::fail(const std::string& what) const {
    input_error(file_, place(), what);
}

void read_mtl(SceneBuilder& builder, TextureReader& textures, const std::filesystem::path& file,
              const std::string& text, std::map<std::string, std::uint32_t>& materials) {
    Scene& scene = builder.scene();
    ObjLines lines(file, text);
    Material* m = nullptr;
    Tally white;
    auto colour = [&](double largest) {
        Spectrum value;
        double red = lines.number();
        if (red < 0 || red > largest)
            lines.fail("a colour outside [0, " + std::to_string(largest) + "]");
        double green = lines.number_or(red), blue = lines.number_or(green);
        for (auto [band, x] : {std::pair(0, red), std::pair(1, green), std::pair(2, blue)}) {
            if (x < 0 || x > largest)
                lines.fail("a colour outside [0, " + std::to_string(largest) + "]");
            value[static_cast<std::size_t>(band)] = static_cast<float>(x);
        }
        return value;
    };
    while (lines.next()) {
        std::string_view word = lines.word();
        if (word == "newmtl") {
            Material fresh = default_material(builder.settings(), true);
            std::string name = lines.rest();
            fresh.name = name_or(name, "unnamed");
            materials[name] = add_material(scene, fresh);
            m = &scene.materials.back();
        } else if (m == nullptr) {
            continue;  // before the first material nothing is meant
        } else if (word == "Kd") {
            m->reflectance = colour(1);
            for (std::size_t b = 0; b < 3; ++b)
                if (m->reflectance[b] > max_reflectance) {
                    m->reflectance[b] = max_reflectance;
                    white.note(m->name);
                }
        } else if (word == "Ke") {
            m->emission = colour(1e14);
            for (float& e : m->emission.value)
                e = static_cast<float>(pi * static_cast<double>(e));
        } else if (word == "map_Kd") {
            m->reflectance_texture = textures.read(lines.place(), map_file(lines));
        } else if (word == "map_Ke") {
            m->emission_texture = textures.read(lines.place(), map_file(lines));
        }
    }
    white.warn(scene, "colours", "have reflectance 1 and are taken as 0.999");
}

}  // namespace parallux
