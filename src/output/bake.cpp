#include "parallux/bake.h"

#include <cmath>

#include <glm/common.hpp>

#include "output/bake_mesh.h"
#include "output/bake_values.h"
#include "output/bake_writers.h"
#include "output/output_file.h"
#include "output/tone.h"
#include "parallux/error.h"

namespace parallux {

namespace {

// Brings the usual radiance to middle grey, as pictures are exposed.
double unlit_factor(const Patches& patches, const Solution& solution,
                    const BakeSettings& settings) {
    double factor = middle_grey * std::exp2(settings.exposure) / usual_luminance(patches, solution);
    return settings.quantity == Quantity::radiance ? factor : factor / pi;
}

class Baker {
public:
    Baker(const Scene& scene, const Patches& patches, const Solution& solution, Bake& bake)
        : scene_(scene),
          patches_(patches),
          bake_(bake),
          values_(scene, patches, solution, bake.settings),
          builder_(bake) {}

    void run() {
        for (std::uint32_t s = 0; s < scene_.surfaces.size(); ++s) {
            // A curved surface is no face of the original mesh: it goes as its cells.
            const bool whole =
                bake_.settings.mesh == BakeMesh::original && !scene_.surfaces[s].is_curved();
            std::uint32_t cells =
                whole ? 1 : cell_count(scene_.surfaces[s].shape(), patches_.grids[s]);
            for (std::uint32_t cell = 0; cell < cells; ++cell)
                add(s, whole ? none : cell);
        }
        builder_.finish();
    }

private:
    // The front, and where there is one the back: turned round, unless its values are the same.
    void add(std::uint32_t surface, std::uint32_t cell) {
        BakeFace front = coloured(surface, false, cell);
        if (patches_.grids[surface].back == none)
            return builder_.add(front);
        const BakeFace back = coloured(surface, true, cell);
        front.both_sides = true;
        for (std::uint32_t k = 0; k < front.count; ++k)
            front.both_sides =
                front.both_sides &&
                front.corner[k].colour == back.corner[(front.count - k) % front.count].colour;
        builder_.add(front);
        if (!front.both_sides)
            builder_.add(back);
    }

    BakeFace coloured(std::uint32_t surface, bool back, std::uint32_t cell) const {
        FaceFrame frame = face_frame(scene_, patches_, surface, back, cell);
        std::array<float, max_bands> values{};
        for (std::uint32_t k = 0; k < frame.face.count; ++k) {
            const glm::dvec2 uv = frame.uv[k];
            if (cell == none)
                values_.at(surface, back, uv.x, uv.y, values.data());
            else
                values_.in_cell(surface, back, cell, uv.x, uv.y, values.data());
            frame.face.corner[k].colour = shown(colour_of(values.data(), values_.bands()));
        }
        return frame.face;
    }

    glm::vec3 shown(const glm::vec3& colour) const {
        if (!bake_.settings.unlit)
            return colour;
        return glm::clamp(static_cast<float>(bake_.factor) * colour, 0.0f, 1.0f);
    }

    const Scene& scene_;
    const Patches& patches_;
    Bake& bake_;
    BakeValues values_;
    BakeBuilder builder_;
};

}  // namespace

Bake make_bake(const Scene& scene, const Patches& patches, const Solution& solution,
               const BakeSettings& settings) {
    Bake bake;
    bake.settings = settings;
    if (settings.unlit)
        bake.factor = unlit_factor(patches, solution, settings);
    Baker(scene, patches, solution, bake).run();
    bake.uv1.clear(), bake.uv2.clear();  // only the scene's own pictures go with vertex colours
    bool pictures = false;
    for (const BakePart& part : bake.parts)
        pictures = pictures || keeps_picture(scene, settings, part.material);
    if (!pictures)
        bake.uv0.clear();
    return bake;
}

void write_bake(const std::filesystem::path& file, const Scene& scene, const Bake& bake) {
    std::string ending = file.extension().string();
    for (char& c : ending)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    OutputFile output(file);
    if (ending == ".ply")
        write_ply(output, scene, bake);
    else if (ending == ".glb" || ending == ".gltf")
        write_gltf(output, file, scene, bake, ending == ".glb", {});
    else
        throw Error(Fault::output, file.string() + ": cannot write '" + ending +
                                       "' bakes; name the file .glb, .gltf or .ply");
    output.commit();
}

}  // namespace parallux
