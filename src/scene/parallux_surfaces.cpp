#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "parallux/error.h"
#include "scene/input.h"
#include "scene/parallux_json.h"

namespace parallux {
namespace {

constexpr std::array face_names = {"x-", "x+", "y-", "y+", "z-", "z+"};

// Corners of a box by the bits x + 2y + 4z; each face counter-clockwise seen from outside.
constexpr std::array<std::array<int, 4>, 6> box_faces = {
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

// Rodrigues' rotation about a unit axis.
glm::dvec3 turned(const glm::dvec3& p, const glm::dvec3& axis, double angle) {
    double c = std::cos(angle), s = std::sin(angle);
    return c * p + s * glm::cross(axis, p) + (1 - c) * glm::dot(axis, p) * axis;
}

double largest(const glm::dvec3& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

}  // namespace

CornerSnapper::CornerSnapper(SceneBuilder& builder, double extent)
    : builder_(builder), tolerance_(std::max(extent, 1e-300) * 1e-12) {
}

// Every known corner within the tolerance lies in a cell that the box around `p` touches: one cell
// as a rule, eight at most.
std::uint32_t CornerSnapper::weld(const glm::dvec3& p) {
    double cell = 16 * tolerance_;
    auto key = [&](const glm::dvec3& at) {
        std::string text;
        for (int i = 0; i < 3; ++i)
            text += std::to_string(static_cast<std::int64_t>(std::floor(at[i] / cell))) + " ";
        return text;
    };
    for (int corner = 0; corner < 8; ++corner) {
        glm::dvec3 sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        auto found = cells_.find(key(p + tolerance_ * sign));
        if (found == cells_.end())
            continue;
        glm::dvec3 known = builder_.scene().positions[found->second] / builder_.settings().scale;
        if (largest(known - p) <= tolerance_)
            return found->second;
    }
    return cells_[key(p)] = builder_.weld(p);
}

// An upper bound is enough: it only sets what counts as rounding.
double ParalluxReader::largest_coordinate() const {
    double extent = 0;
    auto list = root_.find("surfaces");
    for (std::size_t i = 0; list && i < list->size(); ++i) {
        JsonView json = list->at(i);
        if (auto box = json.find("box")) {
            extent = std::max(
                {extent, largest(box->at("low").vector()), largest(box->at("high").vector())});
            continue;
        }
        if (curved_kind(json))
            continue;  // theirs are welded by place when they are cut
        JsonView points = json.at(json.has("parallelogram") ? "parallelogram" : "triangle");
        for (std::size_t k = 0; k < points.size(); ++k)
            extent = std::max(extent, largest(points.at(k).vector()));
    }
    return extent * scale_;
}

void ParalluxReader::read_surfaces() {
    auto list = root_.find("surfaces");
    CornerSnapper snapper(builder_, largest_coordinate());
    snapper_ = &snapper;
    for (std::size_t i = 0; list && i < list->size(); ++i) {
        JsonView json = list->at(i);
        json.only({"name",     "comment", "parallelogram", "triangle",  "box",
                   "disk",     "sphere",  "cylinder",      "cone",      "torus",
                   "bilinear", "bicubic", "swept",         "revolved",  "trim",
                   "turned",   "grid",    "material",      "materials", "turn"});
        int kinds = 0;
        for (const char* one : {"parallelogram", "triangle", "box", "disk", "sphere", "cylinder",
                                "cone", "torus", "bilinear", "bicubic", "swept", "revolved"})
            kinds += json.has(one);
        if (kinds != 1)
            json.fail(
                "must have one of parallelogram, triangle, box, disk, sphere, cylinder, "
                "cone, torus, bilinear, bicubic, swept and revolved");
        const bool is_curved = curved_kind(json) != nullptr;
        for (const char* key : {"trim", "turned"})
            if (!is_curved && json.has(key))
                json.at(key).fail("is for curved surfaces only");
        bool is_box = json.has("box");
        for (const char* key : {"materials", "turn"})
            if (!is_box && json.has(key))
                json.at(key).fail("is for boxes only");
        std::string kind = is_box ? "box" : "surface";
        std::uint32_t object =
            add_object(scene_, json.text_or("name", kind + " " + std::to_string(i)));
        is_curved ? read_curved(json, object)
        : is_box  ? read_box(json, object)
                  : read_flat(json, object);
    }
    auto meshes = root_.find("meshes");
    for (std::size_t i = 0; meshes && i < meshes->size(); ++i)
        read_mesh(meshes->at(i));
    snapper_ = nullptr;
}

void ParalluxReader::read_grid(const JsonView& json, Surface& surface) const {
    auto grid = json.find("grid");
    if (!grid)
        return;
    if (grid->size() != 2)
        grid->fail("must have two whole numbers");
    surface.grid_u = static_cast<std::uint16_t>(grid->at(std::size_t(0)).count(1u << 15));
    surface.grid_v = static_cast<std::uint16_t>(grid->at(1).count(1u << 15));
    if (surface.grid_u == 0 || surface.grid_v == 0)
        grid->fail("must be 1 or more");
    if (surface.shape() == Shape::triangle && surface.grid_u != surface.grid_v)
        grid->fail("must be the same number twice on a triangle");
}

std::uint32_t ParalluxReader::own_material(const JsonView& json) {
    if (json.has("material"))
        return material(json.at("material"));
    if (default_ == none)
        default_ = add_material(scene_, default_material(builder_.settings(), false));
    return default_;
}

void ParalluxReader::read_flat(const JsonView& json, std::uint32_t object) {
    bool is_triangle = json.has("triangle");
    JsonView points = json.at(is_triangle ? "triangle" : "parallelogram");
    if (points.size() != 3)
        points.fail(is_triangle ? "must have three corners" : "must have an origin and two edges");
    glm::dvec3 a = points.at(std::size_t(0)).vector() * scale_, b = points.at(1).vector() * scale_,
               c = points.at(2).vector() * scale_;
    Surface surface;
    if (is_triangle)
        surface.corner = {snapper_->weld(a), snapper_->weld(b), snapper_->weld(c), none};
    else
        surface.corner = {snapper_->weld(a), snapper_->weld(a + b), snapper_->weld(a + b + c),
                          snapper_->weld(a + c)};
    surface.object = object;
    surface.material = own_material(json);
    read_grid(json, surface);
    builder_.add(surface);
}

void ParalluxReader::read_box(const JsonView& json, std::uint32_t object) {
    JsonView box = json.at("box");
    box.only({"comment", "low", "high", "inward"});
    glm::dvec3 low = box.at("low").vector() * scale_, high = box.at("high").vector() * scale_;
    for (int i = 0; i < 3; ++i)
        if (!(low[i] < high[i]))
            box.fail("low must be less than high along x, y and z");
    double angle = json.number_or("turn", 0) * pi / 180;
    glm::dvec3 centre = 0.5 * (low + high);
    std::array<std::uint32_t, 8> corner{};
    for (int k = 0; k < 8; ++k) {
        glm::dvec3 p(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z);
        if (angle != 0)
            p = centre + turned(p - centre, up_, angle);
        corner[static_cast<std::size_t>(k)] = snapper_->weld(p);
    }
    auto materials = json.find("materials");
    if (materials)
        materials->only({"x-", "x+", "y-", "y+", "z-", "z+"});
    bool inward = box.boolean_or("inward", false);
    for (std::size_t f = 0; f < 6; ++f) {
        Surface surface;
        for (std::size_t k = 0; k < 4; ++k)
            surface.corner[inward ? (4 - k) % 4 : k] =
                corner[static_cast<std::size_t>(box_faces[f][k])];
        surface.object = object;
        bool own = materials && materials->has(face_names[f]);
        surface.material = material(own ? materials->at(face_names[f]) : json.at("material"));
        read_grid(json, surface);
        builder_.add(surface);
    }
}

void ParalluxReader::read_mesh(const JsonView& json) {
    json.only({"file", "comment", "material", "scale", "translate"});
    JsonView name = json.at("file");
    std::uint32_t own = json.has("material") ? material(json.at("material")) : none;
    if (scene_.bands != 3 && own == none)
        json.fail("a mesh's own materials have three bands; give it a material of this scene");
    auto file = resolve_below(scene_.file, name.path(), name.text());
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending != ".gltf" && ending != ".glb" && ending != ".obj" && ending != ".stl")
        name.fail("must be a .gltf, .glb, .obj or .stl file");
    LoadSettings settings = builder_.settings();
    settings.scale = 1;
    settings.sky = {};  // which is this scene's, as is
    settings.period = {0, 0};
    Scene mesh = load_scene(file, settings);
    double scale = json.has("scale") ? json.at("scale").number(1e-12, 1e12) : 1;
    glm::dvec3 translate = json.has("translate") ? json.at("translate").vector() : glm::dvec3(0);
    append_scene(builder_, mesh, scale * scale_, translate * scale_, own);
}

}  // namespace parallux
