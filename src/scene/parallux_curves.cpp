#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "lines/directions.h"
#include "parallux/error.h"
#include "scene/input.h"
#include "scene/parallux_json.h"
#include "surfaces/curve.h"

namespace parallux {
namespace {

using Profile = Curve::Profile;

double positive(const JsonView& json, const char* key) {
    return json.at(key).number(1e-15, 1e15);
}

glm::dvec3 unit(const JsonView& json) {
    const glm::dvec3 v = json.vector();
    const double length = glm::length(v);
    if (!(length > 0))
        json.fail("must not be zero");
    return v / length;
}

// The frame of a surface about an axis; angles begin at `start`, made orthogonal, or anywhere.
void set_frame(const JsonView& json, const glm::dvec3& axis, Curve& curve) {
    glm::dvec3 x, y;
    frame_across(axis, x, y);
    if (auto start = json.find("start")) {
        const glm::dvec3 wanted = start->vector();
        const glm::dvec3 across = wanted - glm::dot(wanted, axis) * axis;
        if (!(glm::length(across) > 1e-9 * glm::length(wanted)))
            start->fail("must not lie along the axis");
        x = glm::normalize(across);
        y = glm::cross(axis, x);
    }
    curve.frame = glm::dmat3(x, y, axis);
    curve.turn = json.has("angle") ? json.at("angle").number(1e-6, 360) / 360 : 1;
}

void set_line(Curve& curve, double r0, double z0, double r1, double z1) {
    curve.profile = Profile::line;
    curve.point[0] = {r0, z0, 0};
    curve.point[1] = {r1, z1, 0};
}

void set_arc(Curve& curve, double from_axis, double radius, double start, double end) {
    curve.profile = Profile::arc;
    curve.point[0] = {from_axis, 0, 0};
    curve.point[1] = {1, 0, 0};
    curve.point[2] = {0, 1, 0};
    curve.radius = radius;
    curve.start = start;
    curve.end = end;
}

// The pieces of a profile: a line between two points, or cubics through every third of 3 n + 1.
std::vector<Curve> profiles(const JsonView& points, const Curve& like, int dimensions) {
    const std::size_t count = points.size();
    if (count != 2 && (count < 4 || count % 3 != 1 || count > 3 * 4096 + 1))
        points.fail("must have 2 points (a line) or 4, 7, 10 … (cubic Bézier pieces)");
    std::vector<glm::dvec3> at;
    for (std::size_t k = 0; k < count; ++k) {
        const JsonView point = points.at(k);
        if (dimensions == 3) {
            at.push_back(point.vector());
            continue;
        }
        if (point.size() != 2)
            point.fail("must be the distance from the axis and the height along it");
        at.emplace_back(point.at(std::size_t(0)).number(0, 1e15), point.at(1).number(), 0);
    }
    std::vector<Curve> pieces;
    for (std::size_t k = 0; k + 1 < count; k += 3) {
        Curve piece = like;
        piece.profile = count == 2 ? Profile::line : Profile::cubic;
        for (std::size_t i = 0; i < (count == 2 ? 2u : 4u); ++i)
            piece.point[i] = at[k + i];
        pieces.push_back(piece);
    }
    return pieces;
}

// Its front turned to the other side.
void turn_over(Curve& curve) {
    std::swap(curve.low.y, curve.high.y);
}

std::vector<Curve> about_axis(const JsonView& json, const std::string& kind) {
    Curve curve;
    if (kind == "disk") {
        json.only({"comment", "centre", "normal", "radius", "inner", "start", "angle"});
        curve.origin = json.at("centre").vector();
        set_frame(json, unit(json.at("normal")), curve);
        const double radius = positive(json, "radius");
        const double inner = json.has("inner") ? json.at("inner").number(0, 1e15) : 0;
        if (!(inner < radius))
            json.at("inner").fail("must be less than the radius");
        set_line(curve, inner, 0, radius, 0);  // ∂r × ∂φ is the normal
    } else if (kind == "sphere") {
        json.only({"comment", "centre", "radius", "axis", "start", "angle", "inward"});
        curve.origin = json.at("centre").vector();
        set_frame(json, json.has("axis") ? unit(json.at("axis")) : glm::dvec3(0, 0, 1), curve);
        set_arc(curve, 0, positive(json, "radius"), -pi / 2, pi / 2);
    } else if (kind == "torus") {
        json.only({"comment", "centre", "axis", "radius", "tube", "start", "angle", "inward"});
        curve.origin = json.at("centre").vector();
        set_frame(json, unit(json.at("axis")), curve);
        const double radius = positive(json, "radius"), tube = positive(json, "tube");
        if (!(tube <= radius))
            json.at("tube").fail("must not be more than the radius");
        set_arc(curve, radius, tube, -pi, pi);
    } else {
        const bool cone = kind == "cone";
        if (cone)
            json.only({"comment", "base", "axis", "radius", "top", "start", "angle", "inward"});
        else
            json.only({"comment", "base", "axis", "radius", "start", "angle", "inward"});
        curve.origin = json.at("base").vector();
        const glm::dvec3 axis = json.at("axis").vector();
        set_frame(json, unit(json.at("axis")), curve);
        const double radius = positive(json, "radius");
        const double top = !cone ? radius : json.has("top") ? json.at("top").number(0, 1e15) : 0;
        set_line(curve, radius, 0, top, glm::length(axis));
    }
    if (kind != "disk" && !json.boolean_or("inward", false))
        turn_over(curve);
    return {curve};
}

std::vector<Curve> by_profile(const JsonView& json, const std::string& kind) {
    Curve curve;
    std::vector<Curve> pieces;
    if (kind == "revolved") {
        json.only({"comment", "base", "axis", "profile", "start", "angle", "inward"});
        curve.origin = json.at("base").vector();
        set_frame(json, unit(json.at("axis")), curve);
        pieces = profiles(json.at("profile"), curve, 2);
        // A profile that goes up has its front outside.
        if (!json.boolean_or("inward", false))
            for (Curve& piece : pieces)
                turn_over(piece);
    } else {
        json.only({"comment", "profile", "sweep", "turned"});
        curve.kind = Curve::Kind::swept;
        curve.sweep = json.at("sweep").vector();
        pieces = profiles(json.at("profile"), curve, 3);
    }
    return pieces;
}

// A patch of four corners as one of sixteen, which is the same to the last point.
std::vector<Curve> patch_of(const JsonView& points, bool bilinear) {
    if (points.size() != (bilinear ? 4u : 16u))
        points.fail(bilinear ? "must have four corners, one after the other round it"
                             : "must have sixteen points, u running first");
    Curve curve;
    curve.kind = Curve::Kind::bicubic;
    if (!bilinear) {
        for (std::size_t k = 0; k < 16; ++k)
            curve.point[k] = points.at(k).vector();
        return {curve};
    }
    const glm::dvec3 a = points.at(std::size_t(0)).vector(), b = points.at(1).vector(),
                     c = points.at(2).vector(), d = points.at(3).vector();
    for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t i = 0; i < 4; ++i) {
            const double u = double(i) / 3, v = double(j) / 3;
            curve.point[4 * j + i] = (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * d + u * c);
        }
    return {curve};
}

}  // namespace

const char* ParalluxReader::curved_kind(const JsonView& json) {
    for (const char* kind : {"disk", "sphere", "cylinder", "cone", "torus", "bilinear", "bicubic",
                             "swept", "revolved"})
        if (json.has(kind))
            return kind;
    return nullptr;
}

void ParalluxReader::read_curved(const JsonView& json, std::uint32_t object) {
    const std::string kind = curved_kind(json);
    const JsonView shape = json.at(kind.c_str());
    std::vector<Curve> curves;
    if (kind == "bilinear" || kind == "bicubic")
        curves = patch_of(shape, kind == "bilinear");
    else if (kind == "swept" || kind == "revolved")
        curves = by_profile(shape, kind);
    else
        curves = about_axis(shape, kind);
    for (Curve& curve : curves) {
        read_trim(json, curve);
        if (json.boolean_or("turned", false))
            turn_over(curve);
        add_curve(json, curve, object);
    }
}

// What is left of the whole, in its own (u, v), before its front is turned.
void ParalluxReader::read_trim(const JsonView& json, Curve& curve) const {
    auto trim = json.find("trim");
    if (!trim)
        return;
    if (trim->size() != 2 || trim->at(std::size_t(0)).size() != 2 || trim->at(1).size() != 2)
        trim->fail("must be two points of (u, v)");
    const JsonView low = trim->at(std::size_t(0)), high = trim->at(1);
    glm::dvec2 a, b;
    for (int axis = 0; axis < 2; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        a[axis] = low.at(k).number(0, 1);
        b[axis] = high.at(k).number(0, 1);
        if (!(b[axis] - a[axis] > 1e-9))
            trim->fail("its first point must be less than its second, in u and v");
        if (curve.low[axis] > curve.high[axis])
            std::swap(a[axis], b[axis]);
    }
    curve.low = a;
    curve.high = b;
}

void ParalluxReader::add_curve(const JsonView& json, Curve curve, std::uint32_t object) {
    const double scale = scale_ * builder_.settings().scale;
    curve.origin *= scale;
    curve.sweep *= scale;
    curve.radius *= scale;
    for (std::size_t k = 0; k < curve.point.size(); ++k)
        if (curve.profile != Profile::arc || k == 0)
            curve.point[k] *= scale;
    const double area = curve_area(curve, 0, 1, 0, 1);
    const Bounds bounds = curve_bounds(curve, 0, 1, 0, 1, 16);
    const double extent = glm::length(bounds.high - bounds.low);
    if (!(extent <= 1e15))
        json.fail("reaches beyond 1e15");
    if (!(area > 1e-12 * extent * extent))
        json.fail("has no area");
    Surface surface;
    const glm::dvec2 uv[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (std::size_t k = 0; k < 4; ++k)
        surface.corner[k] =
            builder_.weld(curve_at(curve, uv[k].x, uv[k].y).at / builder_.settings().scale);
    surface.object = object;
    surface.material = own_material(json);
    read_grid(json, surface);
    surface.curve = static_cast<std::uint32_t>(scene_.curves.size());
    scene_.curves.push_back(curve);
    builder_.add(surface);
}

}  // namespace parallux
