#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "parallux/spectrum.h"

// Stage 1: what is there. Metres, W/m² (or lm/m² when the file is photometric), linear Rec. 709.

namespace parallux {

/// A picture in linear values, row 0 at the top, `width * height` texels.
/// Lookup repeats in both directions (glTF's default wrap), v grows downwards (glTF's origin).
struct Texture {
    std::string name;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<glm::vec3> texels;
};

/// What a surface does with light otherwise than diffusely. Of all that arrives, on either side, a
/// share meets this, and the rest the diffuse part.
///  mirror  smooth, or rough by the microfacets of GGX (B. Walter, S. Marschner, H. Li and
///          K. Torrance, Microfacet Models for Refraction through Rough Surfaces, 2007), with what
///          bounces between them given back (C. Kulla and A. Conty, Revisiting Physically Based
///          Shading at Imageworks, 2017): with reflectance 1 it would lose nothing
///  glass   smooth: a body whose fronts look out, with Fresnel's and Snell's laws at each surface;
///          or a thin sheet, which light goes through straight. Two-sided.
struct Specular {
    enum class Kind : std::uint8_t { absent, mirror, glass };
    Kind kind = Kind::absent;
    float share = 1;  ///< 0 … 1, in all bands
    /// Mirror: reflectance seen straight on. Glass: of what passes a surface. The material's
    /// reflectance_texture and vertex colours multiply it.
    Spectrum colour;
    Spectrum grazing;     ///< mirror: reflectance at grazing incidence; Schlick's law between
    float roughness = 0;  ///< mirror: √α of GGX, as glTF has it; 0: smooth
    double ior = 1.5;     ///< glass: refractive index, 1 … 4
    Spectrum absorption;  ///< glass: 1/m inside
    bool thin = false;    ///< glass: a sheet
};

/// What a surface does with light. Values are per band; textures and vertex colours multiply them
/// (a texture's or a colour's three channels apply to scenes of three bands only).
struct Material {
    std::string name;
    Spectrum reflectance;                      ///< ρ, 0 ≤ ρ < 1
    Spectrum emission;                         ///< E = π L_e, W/m² leaving each side that emits
    std::uint32_t reflectance_texture = none;  ///< index into Scene::textures
    std::uint32_t emission_texture = none;     ///< index into Scene::textures
    std::uint32_t reflectance_uv = 0;          ///< which texture coordinate set: 0 or 1
    std::uint32_t emission_uv = 0;
    bool two_sided = false;  ///< two patches a cell, one a side; else the back is inert
    /// τ, what leaves from the other side of what arrives on the front; ρ + τ < 1, and 0 unless
    /// two-sided. Neither textures nor colours multiply it.
    Spectrum transmittance;
    bool own_back = false;  ///< the back has these two values, else the front's
    Spectrum back_reflectance, back_transmittance;

    Specular specular;

    /// Share of what arrives that the diffuse part does not get.
    float specular_share() const {
        return specular.kind == Specular::Kind::absent ? 0 : specular.share;
    }
    const Spectrum& transmittance_of(bool back) const {
        return back && own_back ? back_transmittance : transmittance;
    }
    /// Any side lets light through.
    bool is_translucent() const;
};

enum class Shape : std::uint8_t { parallelogram, triangle };

/// A planar piece of the scene with a (u, v) grid: point(u, v) = p0 + u (p1 - p0) + v (p_last -
/// p0), 0 ≤ u, v ≤ 1, and u + v ≤ 1 on a triangle. Corners run counter-clockwise seen from the
/// front: triangle p0 p1 p2, parallelogram p0 p1 p2 p3 with p2 = p1 + p3 - p0 up to rounding.
struct Surface {
    std::array<std::uint32_t, 4> corner{};  ///< indices into Scene::positions; [3] = none: triangle
    std::uint32_t material = 0;             ///< index into Scene::materials
    std::uint32_t object = 0;               ///< index into Scene::objects
    std::uint32_t grid_u = 0;               ///< cells along u and v; 0: from the wanted patch size
    std::uint32_t grid_v = 0;

    Shape shape() const { return corner[3] == none ? Shape::triangle : Shape::parallelogram; }
    /// The corner at (u, v) = (0, 1).
    std::uint32_t corner_v() const { return corner[3] == none ? corner[2] : corner[3]; }
};

/// Texture coordinates and colour over one surface, affine in (u, v): the values at p0 and at the
/// ends of u and v.
struct SurfaceAttributes {
    std::array<glm::vec2, 3> uv0{};
    std::array<glm::vec2, 3> uv1{};
    std::array<glm::vec3, 3> colour{glm::vec3(1), glm::vec3(1), glm::vec3(1)};
    bool operator==(const SurfaceAttributes&) const = default;
};

/// A light without area.
struct Light {
    enum class Kind : std::uint8_t { point, spot, directional };
    Kind kind = Kind::point;
    std::string name;
    glm::dvec3 position{0};
    glm::dvec3 direction{0, 0, -1};  ///< unit; where the light goes
    Spectrum intensity;              ///< W/sr; for a directional light W/m² across its direction
    double inner_cone = 0;           ///< spot: full strength within this angle, radians
    double outer_cone = pi / 4;      ///< spot: nothing beyond it
    double range = 0;                ///< 0: no limit (glTF's range, a hard end here)
    double half_angle = 0;           ///< directional: of the disc it comes from, radians; 0: none
};

/// Half the angle that the sun's disc subtends from the earth, radians.
inline constexpr double sun_half_angle = 0.2665 * pi / 180;

/// How a sky with a sun varies, in the form that the CIE's general sky (ISO 15469:2004) and Perez's
/// all-weather sky share: radiance ∝ φ(θ) f(χ), φ = 1 + a exp(b / cos θ),
/// f = 1 + c (exp(d χ) - offset) + e cos² χ, θ from the zenith, χ from the sun; nowhere below 0.
struct SkyShape {
    double a = 0, b = 0, c = 0, d = 0, e = 0;
    double offset = 0;
    glm::dvec3 sun{0, 0, 1};  ///< unit, toward it
    double power = 1;         ///< that φ f is raised to; 2 for second moments

    /// (φ f)^power seen `height` = cos θ above the horizon; 0 below it. With b > 0, which Perez's
    /// table has, φ would grow beyond all bounds at the horizon: it stays what it is at 6°.
    double relative(double height, double cos_to_sun) const;
    /// No smaller than the largest of these.
    double bound() const;
};

/// Light from outside the scene; radiance per band, W/(m² sr).
struct Sky {
    enum class Kind : std::uint8_t { dark, uniform, gradient, image, shaped };
    Kind kind = Kind::dark;
    glm::dvec3 up{0, 0, 1};  ///< unit
    Spectrum zenith;         ///< uniform: the radiance everywhere above and below
    Spectrum horizon;  ///< gradient: radiance at the horizon, linear in sin(elevation) to zenith
    Spectrum ground;   ///< gradient, shaped: radiance below the horizon
    SkyShape shape;    ///< shaped: zenith times this
    Texture image;     ///< image: latitude-longitude, top row at `up`
    float scale = 1;   ///< image: multiplies its texels
    glm::dvec3 north{0, 1,
                     0};  ///< image: the direction of its middle column, made orthogonal to up

    /// Radiance seen when looking along unit `direction` out of the scene.
    Spectrum radiance(const glm::dvec3& direction) const;
};

struct Camera {
    std::string name;
    glm::dvec3 position{0};
    glm::dvec3 forward{0, 0, -1};    ///< unit
    glm::dvec3 up{0, 1, 0};          ///< unit, orthogonal to forward
    double vertical_fov = 0.8;       ///< radians
    double aspect = 0;               ///< width / height; 0: the picture's own
    double orthographic_height = 0;  ///< > 0: parallel projection of this height in scene units
};

struct Scene {
    std::filesystem::path file;
    std::uint32_t bands = 3;
    std::vector<glm::dvec3> positions;  ///< welded: equal positions have one index
    std::vector<Surface> surfaces;
    std::vector<SurfaceAttributes> attributes;  ///< empty, or one a surface
    /// Empty, or one a surface, affine in (u, v) as attributes are: the file's second texture
    /// coordinates, for lightmaps; not a number where a mesh has none. Read only when asked for.
    std::vector<std::array<glm::vec2, 3>> lightmap_uv;
    std::vector<Material> materials;
    std::vector<std::string> objects;
    std::vector<Texture> textures;
    std::vector<Light> lights;
    std::vector<Camera> cameras;
    Sky sky;
    std::uint64_t triangles = 0;  ///< as read, zero-area ones included
    std::uint64_t zero_area = 0;  ///< dropped
    /// The scene repeats by these without end, both across the sky's up; zero: not that way.
    std::array<glm::dvec3, 2> period{glm::dvec3(0), glm::dvec3(0)};
    double line_sphere = 0;  ///< radius for independent lines; 0: the scene's own bound
    std::vector<std::string> warnings;
};

/// A sky by its model. Lengths of arrays as elsewhere: a value a band.
///  uniform   the same radiance everywhere, below the horizon too
///  overcast  CIE: L = L_z (1 + 2 sin h) / 3 (P. Moon and D. E. Spencer, Illumination from a
///            non-uniform sky, 1942)
///  clear     CIE standard clear sky: type 12 of the general sky of ISO 15469:2004, which is
///            R. Kittler's of 1967, with L_z at the zenith
///  perez     all-weather sky from direct and diffuse irradiance (R. Perez, R. Seals and
///            J. Michalsky, All-weather model for sky luminance distribution, Solar Energy 50(3),
///            1993), so that the diffuse irradiance is met exactly; clearness and brightness go by
///            the bands' means
///  image     latitude-longitude picture, from outside the scene's folder too
/// With a sun, its disc is a directional light; clear and perez need its place.
struct SkySettings {
    enum class Model : std::uint8_t { from_file, dark, uniform, overcast, clear, perez, image };
    Model model = Model::from_file;
    Spectrum radiance;        ///< uniform; overcast and clear: at the zenith; W/(m² sr)
    Spectrum diffuse;         ///< perez: on a horizontal plane, W/m²
    bool has_sun = false;     ///< in place of the suns that the file has
    double elevation = 0;     ///< of the sun's centre, radians, 0 … π/2
    double azimuth = 0;       ///< radians, from north by east
    Spectrum direct;          ///< of the sun, W/m² across its direction
    bool has_ground = false;  ///< below the horizon
    Spectrum albedo;          ///< times the horizontal irradiance of sky and sun
    std::filesystem::path image;
};

/// How a mesh format that says nothing about a thing is to be read, and the sky over the scene.
struct LoadSettings {
    Spectrum reflectance = Spectrum::constant(0.5f);  ///< of faces without a material
    double scale = 1;                                 ///< multiplies every length of the file
    bool keep_triangles = false;                      ///< do not join triangle pairs
    bool lightmap_uv = false;                         ///< read glTF's TEXCOORD_1 as lightmap_uv
    /// The scene repeats after so much, in the file's units, along the two horizontal axes; 0: not.
    std::array<double, 2> period{0, 0};
    SkySettings sky;  ///< in place of the file's
};

/// Reads a glTF (.gltf, .glb), OBJ, STL or Parallux (.json) scene; the content decides where the
/// ending is unknown. Every index, span and number is checked before use; throws Fault::input
/// naming file and element. Nothing outside the scene's folder is read. Linear in the file.
///  sides: glTF by doubleSided; OBJ two-sided, as its winding means nothing; STL one-sided, fronts
///  by winding; Parallux by two_sided
///  transmittance: Parallux by transmittance, glTF by KHR_materials_diffuse_transmission, which
///  makes a material two-sided; see the README
///  mirrors and glass: Parallux by mirror and glass, glTF by metallic-roughness,
///  KHR_materials_transmission, KHR_materials_ior and KHR_materials_volume
///  sky's up: y in glTF and OBJ, z in STL, as a Parallux scene says
///  reflectance 1 (glTF's default) becomes 0.999, with a warning; a picture that is absent or
///  broken leaves its factor alone, with a warning
///  dropped as zero_area: faces without area, and of meshes also needles whose corners are one
///  point or line as floats; no surface left is Fault::input
Scene load_scene(const std::filesystem::path& file, const LoadSettings& settings = {});

/// point(u, v) of a surface.
glm::dvec3 surface_point(const Scene& scene, const Surface& surface, double u, double v);
/// Unit normal of the front, (p1 - p0) × (p_last - p0).
glm::dvec3 surface_normal(const Scene& scene, const Surface& surface);
/// Area in square metres.
double surface_area(const Scene& scene, const Surface& surface);
/// Reflectance of a side and emission at one point: factor × texture × vertex colour. Reflectance
/// is clamped to [0, 0.999 - transmittance].
Spectrum surface_reflectance(const Scene& scene, std::uint32_t surface, double u, double v,
                             bool back = false);
Spectrum surface_emission(const Scene& scene, std::uint32_t surface, double u, double v);
/// The colour of a surface's specular part at one point: factor × texture × vertex colour, clamped
/// to [0, 1].
Spectrum surface_tint(const Scene& scene, std::uint32_t surface, double u, double v);
/// Whether any surface mirrors or is glass.
bool is_specular(const Scene& scene);

/// Irradiance of an unobstructed plane that faces up, from the sky alone; W/m² per band. By
/// quadrature, to 10⁻⁴.
Spectrum horizontal_irradiance(const Sky& sky);

struct Bounds {
    glm::dvec3 low{0};
    glm::dvec3 high{0};
};
/// Of all corners in use; both zero for an empty scene.
Bounds scene_bounds(const Scene& scene);
/// True when every edge is shared by an even number of faces: each line then meets an even number
/// of surfaces.
bool is_closed(const Scene& scene);

}  // namespace parallux
