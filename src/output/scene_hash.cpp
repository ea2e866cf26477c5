#include "output/checksum.h"
#include "parallux/result.h"

namespace parallux {

namespace {

// Values one by one: the gaps within structures hold anything.
class SceneChecksum {
public:
    template <class... T>
    void add(const T&... values) {
        (one(values), ...);
    }
    std::uint64_t value() const { return sum_.value(); }

private:
    template <class T>
    void one(const T& value) {
        static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>);
        sum_.add({reinterpret_cast<const char*>(&value), sizeof value});
    }
    void one(const std::string& text) {
        one(text.size());
        sum_.add(text);
    }
    template <glm::length_t N, class T>
    void one(const glm::vec<N, T>& vector) {
        for (glm::length_t k = 0; k < N; ++k)
            one(vector[k]);
    }
    template <class T, std::size_t N>
    void one(const std::array<T, N>& values) {
        for (const T& value : values)
            one(value);
    }
    template <class T>
    void one(const std::vector<T>& values) {
        one(values.size());
        for (const T& value : values)
            one(value);
    }
    void one(const Spectrum& s) { one(s.value); }
    void one(const Surface& s) { add(s.corner, s.material, s.object, s.grid_u, s.grid_v); }
    void one(const SurfaceAttributes& a) { add(a.uv0, a.uv1, a.colour); }
    void one(const Texture& t) { add(t.width, t.height, t.texels); }
    void one(const Material& m) {
        add(m.name, m.reflectance, m.emission, m.reflectance_texture, m.emission_texture,
            m.reflectance_uv, m.emission_uv, m.two_sided);
        // Other scenes keep the hashes that they had before there was transmittance.
        if (m.own_back || m.is_translucent())
            add(m.own_back, m.transmittance, m.back_reflectance, m.back_transmittance);
        if (const Specular& s = m.specular; s.kind != Specular::Kind::absent)
            add(s.kind, s.share, s.colour, s.grazing, s.roughness, s.ior, s.absorption, s.thin);
    }
    void one(const Light& l) {
        add(l.kind, l.position, l.direction, l.intensity, l.inner_cone, l.outer_cone, l.range,
            l.half_angle);
    }
    void one(const SkyShape& s) { add(s.a, s.b, s.c, s.d, s.e, s.offset, s.sun, s.power); }
    void one(const Sky& s) {
        add(s.kind, s.up, s.zenith, s.horizon, s.ground, s.shape, s.image, s.scale, s.north);
    }
    void one(const SurfaceGrid& g) { add(g.front, g.back, g.nu, g.nv); }

    Checksum sum_;
};

}  // namespace

std::uint64_t scene_hash(const Scene& scene, const Patches& patches) {
    SceneChecksum sum;
    sum.add(scene.bands, scene.positions, scene.surfaces, scene.attributes, scene.materials,
            scene.objects, scene.textures, scene.lights, scene.sky, scene.period);
    sum.add(patches.bands, patches.grids, patches.area, patches.reflectance, patches.emission);
    if (patches.translucent())
        sum.add(patches.transmittance, patches.other);
    if (!patches.specular.empty())
        sum.add(patches.specular);
    return sum.value();
}

}  // namespace parallux
