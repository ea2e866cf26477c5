#include "throughput/embree_scene.h"

#include <algorithm>

#include "parallux/error.h"
#include "patches/patch_values.h"

namespace parallux::throughput {

// Corners and faces: triangles with their last corner twice.
struct EmbreeScene::Mesh {
    std::vector<glm::dvec3> corners;
    std::vector<std::array<std::uint32_t, 4>> faces[2];  // triangles, quads
    std::vector<Primitive> primitives[2];

    void add(const std::array<std::uint32_t, 4>& corner, const Primitive& primitive) {
        const bool triangle = primitive.shape == Shape::triangle;
        faces[!triangle].push_back(
            {corner[0], corner[1], corner[2], triangle ? corner[2] : corner[3]});
        primitives[!triangle].push_back(primitive);
    }

    // The cells of one surface's grid, which share corners.
    void add_cells(const Scene& scene, const Surface& surface, const SurfaceGrid& grid) {
        const bool triangle = surface.shape() == Shape::triangle;
        const auto first = static_cast<std::uint32_t>(corners.size());
        for (std::uint32_t j = 0; j <= grid.nv; ++j)
            for (std::uint32_t i = 0; i <= grid.nu; ++i)
                corners.push_back(
                    surface_point(scene, surface, double(i) / grid.nu, double(j) / grid.nv));
        auto corner = [&](std::uint32_t i, std::uint32_t j) {
            return first + j * (grid.nu + 1) + i;
        };
        for_each_cell(surface.shape(), grid, [&](const Cell& cell) {
            const Primitive primitive{grid.front + cell.index,
                                      grid.back == none ? none : grid.back + cell.index, 1, 1,
                                      surface.shape()};
            std::uint32_t i = triangle ? cell.iu / 2 : cell.iu, j = cell.iv;
            if (triangle && cell.iu % 2)
                add({corner(i + 1, j + 1), corner(i, j + 1), corner(i + 1, j), none}, primitive);
            else
                add({corner(i, j), corner(i + 1, j),
                     triangle ? corner(i, j + 1) : corner(i + 1, j + 1), corner(i, j + 1)},
                    primitive);
        });
    }

    Mesh(const Case& of, Parts parts) : corners(of.scene.positions) {
        for (std::size_t s = 0; s < of.scene.surfaces.size(); ++s) {
            const Surface& surface = of.scene.surfaces[s];
            const SurfaceGrid& grid = of.patches.grids[s];
            if (parts == Parts::patches && grid.nu * grid.nv > 1)
                add_cells(of.scene, surface, grid);
            else
                add(surface.corner, {grid.front, grid.back, grid.nu, grid.nv, surface.shape()});
        }
    }
};

EmbreeScene::EmbreeScene(const Case& of, Parts parts, const EmbreeChoice& choice,
                         RTCFilterFunctionN filter)
    : device_(rtcNewDevice(nullptr)) {
    if (!device_)
        throw Error(Fault::internal, "Embree cannot start on this machine");
    const Bounds bounds = scene_bounds(of.scene);
    centre_ = 0.5 * (bounds.low + bounds.high);
    Mesh mesh(of, parts);
    if (choice.all_quads) {
        mesh.faces[1].insert(mesh.faces[1].end(), mesh.faces[0].begin(), mesh.faces[0].end());
        mesh.primitives[1].insert(mesh.primitives[1].end(), mesh.primitives[0].begin(),
                                  mesh.primitives[0].end());
        mesh.faces[0].clear();
        mesh.primitives[0].clear();
    }
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, choice.context_filter
                                 ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION
                                 : RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);
    for (unsigned kind : {0u, 1u})
        attach(mesh, kind, choice, filter);
    rtcCommitScene(scene_);
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE)
        throw Error(Fault::internal, "Embree cannot build the scene");

    own_numbers_ = true;
    for (std::uint32_t k = 0; k < primitives_.size(); ++k) {
        const Primitive& p = primitives_[k];
        own_numbers_ &= p.front == k && p.back == none && p.nu * p.nv == 1;
    }
}

void EmbreeScene::attach(const Mesh& mesh, unsigned geometry_id, const EmbreeChoice& choice,
                         RTCFilterFunctionN filter) {
    const auto& faces = mesh.faces[geometry_id];
    first_of_[geometry_id] = static_cast<std::uint32_t>(primitives_.size());
    if (faces.empty())
        return;
    primitives_.insert(primitives_.end(), mesh.primitives[geometry_id].begin(),
                       mesh.primitives[geometry_id].end());
    const bool quads = geometry_id == 1;
    const std::size_t sides = quads ? 4 : 3;
    RTCGeometry geometry =
        rtcNewGeometry(device_, quads ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* corners = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.corners.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, quads ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3,
        sides * sizeof(unsigned), faces.size()));
    if (!corners || !indices)
        throw Error(Fault::memory, "no memory for Embree's geometry");
    for (const glm::dvec3& corner : mesh.corners)
        for (int axis = 0; axis < 3; ++axis)
            *corners++ = static_cast<float>(corner[axis] - centre_[axis]);
    for (const auto& face : faces)
        indices = std::copy_n(face.begin(), sides, indices);
    if (!choice.context_filter) {
        rtcSetGeometryIntersectFilterFunction(geometry, filter);
        rtcSetGeometryOccludedFilterFunction(geometry, filter);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_, geometry, geometry_id);
    rtcReleaseGeometry(geometry);
}

EmbreeScene::~EmbreeScene() {
    if (scene_)
        rtcReleaseScene(scene_);
    if (device_)
        rtcReleaseDevice(device_);
}

}  // namespace parallux::throughput
