#include "scene/obj.h"

#include <algorithm>
#include <array>

#include "parallux/error.h"
#include "scene/input.h"

namespace parallux {
namespace {

// Reads OBJ directly: tinyobjloader, the usual reader, sizes arrays by numbers in the file, keeps
// a face's corner count in a byte and gives silent zeros for what it cannot parse.
class ObjReader {
public:
    ObjReader(SceneBuilder& builder, const std::string& text)
        : builder_(builder), textures_(builder.scene()), lines_(builder.scene().file, text) {}

    void read() {
        builder_.scene().sky.up = {0, 1, 0};  // as most exporters have it
        while (lines_.next())
            read_line();
        finish_mesh();
        Scene& scene = builder_.scene();
        unknown_.warn(scene, "material names", "are defined nowhere; the default is used");
        skipped_.warn(scene, "statements", "are neither faces nor vertices and are left out");
    }

private:
    struct Corner {
        std::uint32_t position = 0, uv = none;
    };

    void read_line();
    void read_vertex();
    void read_face();
    Corner read_corner(std::string_view word);
    std::uint32_t resolve(std::string_view digits, std::size_t count, const char* what);
    void use_material(const std::string& name);
    void read_library();
    std::uint32_t vertex_of(const Corner& corner);
    void finish_mesh();

    SceneBuilder& builder_;
    TextureReader textures_;
    ObjLines lines_;
    std::vector<glm::dvec3> positions_;
    std::vector<glm::vec3> colours_;  ///< one a position as soon as one has a colour
    std::vector<glm::vec2> uv_;
    std::map<std::string, std::uint32_t> materials_;
    std::uint32_t material_ = none, default_ = none;
    std::string object_;
    std::uint32_t object_index_ = none;
    Mesh mesh_;  ///< faces since the last change of object or material
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> vertices_;
    std::vector<std::uint32_t> polygon_;
    Tally unknown_, skipped_;
};

void ObjReader::read_line() {
    std::string_view word = lines_.word();
    if (word == "v")
        return read_vertex();
    if (word == "vt") {
        double u = lines_.number(), v = lines_.number_or(0);
        // OBJ counts v from the bottom of the picture, Scene from its top.
        uv_.emplace_back(static_cast<float>(u), static_cast<float>(1 - v));
        return;
    }
    if (word == "f" || word == "fo")
        return read_face();
    if (word == "o" || word == "g") {
        finish_mesh();
        object_ = lines_.rest();
        object_index_ = none;
        return;
    }
    if (word == "usemtl")
        return use_material(lines_.rest());
    if (word == "mtllib")
        return read_library();
    if (word == "p" || word == "l" || word == "curv" || word == "surf")
        skipped_.note(lines_.place());
}

void ObjReader::read_vertex() {
    double x = lines_.number(), y = lines_.number(), z = lines_.number();
    positions_.emplace_back(x, y, z);
    if (positions_.size() >= none)
        lines_.fail("too many vertices");
    // Either x y z w, or x y z r g b.
    double extra[3], first = lines_.number_or(-1);
    extra[0] = first;
    extra[1] = lines_.number_or(-1);
    extra[2] = extra[1] < 0 ? -1 : lines_.number_or(-1);
    bool coloured = extra[0] >= 0 && extra[1] >= 0 && extra[2] >= 0;
    if (coloured || !colours_.empty()) {
        colours_.resize(positions_.size(), glm::vec3(1));
        for (int c = 0; coloured && c < 3; ++c)
            colours_.back()[c] = static_cast<float>(std::min(extra[c], 1e6));
    }
}

// 1 is the first, -1 the last so far.
std::uint32_t ObjReader::resolve(std::string_view digits, std::size_t count, const char* what) {
    std::int64_t i = 0;
    auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), i);
    if (error != std::errc() || end != digits.data() + digits.size())
        lines_.fail("\"" + printable(digits, 40) + "\" is no index");
    std::int64_t n = static_cast<std::int64_t>(count), at = i > 0 ? i - 1 : n + i;
    if (i == 0 || at < 0 || at >= n)
        lines_.fail(std::string(what) + " " + std::to_string(i) + " is used, but there are " +
                    std::to_string(n) + " so far");
    return static_cast<std::uint32_t>(at);
}

ObjReader::Corner ObjReader::read_corner(std::string_view word) {
    std::size_t slash = std::min(word.find('/'), word.size());
    Corner corner;
    corner.position = resolve(word.substr(0, slash), positions_.size(), "vertex");
    if (slash < word.size()) {
        std::string_view rest = word.substr(slash + 1);
        std::string_view uv = rest.substr(0, std::min(rest.find('/'), rest.size()));
        if (!uv.empty())
            corner.uv = resolve(uv, uv_.size(), "texture coordinate");
    }
    return corner;
}

std::uint32_t ObjReader::vertex_of(const Corner& corner) {
    auto [entry, is_new] = vertices_.try_emplace(
        {corner.position, corner.uv}, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (is_new) {
        mesh_.positions.push_back(positions_[corner.position]);
        mesh_.uv0.push_back(corner.uv == none ? glm::vec2(0) : uv_[corner.uv]);
        mesh_.colours.push_back(corner.position < colours_.size() ? colours_[corner.position]
                                                                  : glm::vec3(1));
    }
    return entry->second;
}

void ObjReader::read_face() {
    polygon_.clear();
    for (std::string_view word = lines_.word(); !word.empty(); word = lines_.word())
        polygon_.push_back(vertex_of(read_corner(word)));
    if (polygon_.size() < 3)
        return skipped_.note(lines_.place());
    if (mesh_.place.empty())
        mesh_.place = "faces from " + lines_.place();
    triangulate(mesh_.positions, polygon_, mesh_.indices);
}

void ObjReader::use_material(const std::string& name) {
    auto found = materials_.find(name);
    if (found == materials_.end())
        unknown_.note(printable(name));
    std::uint32_t material = found == materials_.end() ? none : found->second;
    if (material != material_)
        finish_mesh();
    material_ = material;
}

// Several names may stand in one line; blanks may belong to a name. The whole line comes first.
void ObjReader::read_library() {
    Scene& scene = builder_.scene();
    std::string uri = lines_.rest();
    try {
        auto file = resolve_below(scene.file, lines_.place(), uri);
        if (!std::filesystem::exists(file)) {
            scene.warnings.push_back(lines_.place() + ": no material library \"" + printable(uri) +
                                     "\"; its materials are the default");
            return;
        }
        read_mtl(builder_, textures_, file, read_file(file, std::uint64_t(1) << 26), materials_);
    } catch (const std::filesystem::filesystem_error&) {
        lines_.fail("material library \"" + printable(uri) + "\" cannot be looked for");
    }
}

void ObjReader::finish_mesh() {
    if (!mesh_.indices.empty()) {
        Scene& scene = builder_.scene();
        if (object_index_ == none)
            object_index_ = add_object(scene, name_or(object_, scene.file.stem().string()));
        if (material_ == none && default_ == none)
            default_ = add_material(scene, default_material(builder_.settings(), true));
        mesh_.object = object_index_;
        mesh_.material = material_ == none ? default_ : material_;
        const Material& m = scene.materials[mesh_.material];
        if (m.reflectance_texture == none && m.emission_texture == none)
            mesh_.uv0.clear();
        if (colours_.empty())
            mesh_.colours.clear();
        builder_.add(mesh_);
    }
    mesh_ = Mesh();
    vertices_.clear();
}

}  // namespace

bool looks_like_obj(const std::string& bytes) {
    static constexpr std::array keywords = {"v", "vt", "vn", "vp", "f",      "o",
                                            "g", "s",  "l",  "p",  "mtllib", "usemtl"};
    ObjLines lines({}, std::string_view(bytes).substr(0, 65536));
    return lines.next() &&
           std::find(keywords.begin(), keywords.end(), lines.word()) != keywords.end();
}

void read_obj(SceneBuilder& builder, const std::string& bytes) {
    ObjReader(builder, bytes).read();
}

}  // namespace parallux
