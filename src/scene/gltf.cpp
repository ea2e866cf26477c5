#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "scene/gltf_materials.h"
#include "scene/gltf_nodes.h"
#include "scene/input.h"

namespace parallux {
namespace {

class GltfReader {
public:
    GltfReader(SceneBuilder& builder, std::string bytes)
        : builder_(builder),
          document_(builder.scene().file, std::move(bytes)),
          materials_(document_, builder) {}

    void read() {
        builder_.scene().sky.up = {0, 1, 0};  // glTF's up
        visited_.resize(document_.length("nodes"), false);
        for (std::uint64_t root : roots())
            read_tree(root);
        materials_.finish();
        skipped_.warn(builder_.scene(), "primitives", "are not made of triangles and are left out");
        skinned_.warn(builder_.scene(), "nodes", "have a skin and stand in their bind pose");
    }

private:
    struct Place {
        std::uint64_t node;
        glm::dmat4 parent;
        int depth;
    };

    std::vector<std::uint64_t> roots() const;
    void read_tree(std::uint64_t root);
    void read_node(const JsonView& node, const glm::dmat4& world);
    void read_primitive(const JsonView& primitive, const glm::dmat4& world, std::uint32_t object);
    void read_positions(const JsonView& accessor, const glm::dmat4& world, Mesh& mesh);
    std::vector<std::uint32_t> triangles(const JsonView& primitive, std::uint64_t mode,
                                         std::size_t vertices);
    std::vector<glm::vec2> read_uv(const JsonView& attributes, const UvSource& source,
                                   std::size_t vertices);
    std::vector<glm::vec3> read_colours(const JsonView& attributes, std::size_t vertices);

    SceneBuilder& builder_;
    GltfDocument document_;
    GltfMaterials materials_;
    std::vector<bool> visited_;
    Tally skipped_, skinned_;
};

// The default scene's nodes, else the first scene's; without scenes every node without a parent.
std::vector<std::uint64_t> GltfReader::roots() const {
    std::vector<std::uint64_t> result;
    JsonView root = document_.root();
    std::uint64_t nodes = document_.length("nodes");
    if (document_.length("scenes") > 0) {
        auto chosen = root.find("scene");
        JsonView scene = chosen ? document_.element("scenes", *chosen)
                                : document_.element("scenes", std::uint64_t(0));
        if (auto list = scene.find("nodes"))
            for (std::size_t i = 0; i < list->size(); ++i)
                result.push_back(list->at(i).count(none));
        return result;
    }
    std::vector<bool> is_child(nodes, false);
    for (std::uint64_t i = 0; i < nodes; ++i)
        if (auto children = document_.element("nodes", i).find("children"))
            for (std::size_t k = 0; k < children->size(); ++k) {
                std::uint64_t child = children->at(k).count(none);
                if (child < nodes)
                    is_child[child] = true;
            }
    for (std::uint64_t i = 0; i < nodes; ++i)
        if (!is_child[i])
            result.push_back(i);
    return result;
}

void GltfReader::read_tree(std::uint64_t root) {
    std::vector<Place> open{{root, glm::dmat4(1), 1}};
    while (!open.empty()) {
        Place place = open.back();
        open.pop_back();
        if (place.node >= visited_.size())
            document_.root().fail("node " + std::to_string(place.node) +
                                  " is named, but there are " + std::to_string(visited_.size()));
        JsonView node = document_.element("nodes", place.node);
        if (visited_[place.node])
            node.fail("is reached twice; nodes must form trees without cycles");
        visited_[place.node] = true;
        if (place.depth > 256)
            node.fail("lies deeper than 256 nodes");
        glm::dmat4 world = place.parent * node_transform(node);
        read_node(node, world);
        if (auto children = node.find("children"))
            for (std::size_t i = children->size(); i-- > 0;)
                open.push_back({children->at(i).count(none), world, place.depth + 1});
    }
}

void GltfReader::read_node(const JsonView& node, const glm::dmat4& world) {
    Scene& scene = builder_.scene();
    double scale = builder_.settings().scale;
    if (node.has("camera"))
        add_gltf_camera(scene, document_, node, world, scale);
    add_gltf_light(scene, document_.root(), node, world, scale);
    auto reference = node.find("mesh");
    if (!reference)
        return;
    if (node.has("skin"))
        skinned_.note(printable(node.path()));
    JsonView mesh = document_.element("meshes", *reference);
    std::string name = name_or(
        node.text_or("name", ""),
        name_or(mesh.text_or("name", ""), "mesh " + std::to_string(reference->count(none))));
    std::uint32_t object = add_object(scene, name);
    JsonView primitives = mesh.at("primitives");
    for (std::size_t i = 0; i < primitives.size(); ++i)
        read_primitive(primitives.at(i), world, object);
}

void GltfReader::read_primitive(const JsonView& primitive, const glm::dmat4& world,
                                std::uint32_t object) {
    std::uint64_t mode = primitive.count_or("mode", 4, 6);
    JsonView attributes = primitive.at("attributes");
    auto positions = attributes.find("POSITION");
    if (mode < 4 || !positions)
        return skipped_.note(printable(primitive.path()));
    auto extensions = primitive.find("extensions");
    for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"})
        if (extensions && extensions->has(name) &&
            !document_.element("accessors", *positions).has("bufferView"))
            extensions->fail(std::string(name) + " is not supported; export without it");

    Mesh mesh;
    mesh.place = primitive.path();
    mesh.object = object;
    read_positions(*positions, world, mesh);
    mesh.indices = triangles(primitive, mode, mesh.positions.size());
    // A mirrored node turns its triangles' winding round; their fronts stay fronts.
    if (glm::determinant(glm::dmat3(world)) < 0)
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
            std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);

    const GltfMaterial& material = materials_.of(primitive);
    mesh.material = material.index;
    if (material.uv0)
        mesh.uv0 = read_uv(attributes, *material.uv0, mesh.positions.size());
    if (material.uv1)
        mesh.uv1 = read_uv(attributes, *material.uv1, mesh.positions.size());
    if (builder_.settings().lightmap_uv)
        mesh.lightmap_uv = read_uv(attributes, {.set = 1}, mesh.positions.size());
    mesh.colours = read_colours(attributes, mesh.positions.size());
    builder_.add(mesh);
}

void GltfReader::read_positions(const JsonView& accessor, const glm::dmat4& world, Mesh& mesh) {
    std::uint32_t components = 0;
    std::vector<float> values = document_.read_floats(accessor, components);
    if (components != 3)
        accessor.fail("POSITION must be VEC3");
    mesh.positions.resize(values.size() / 3);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.positions[i] =
            glm::dvec3(world * glm::dvec4(values[3 * i], values[3 * i + 1], values[3 * i + 2], 1));
}

std::vector<std::uint32_t> GltfReader::triangles(const JsonView& primitive, std::uint64_t mode,
                                                 std::size_t vertices) {
    std::vector<std::uint32_t> order;
    if (auto indices = primitive.find("indices")) {
        order = document_.read_indices(*indices);
        for (std::size_t i = 0; i < order.size(); ++i)
            if (order[i] >= vertices)
                indices->fail("index " + std::to_string(i) + " is " + std::to_string(order[i]) +
                              ", but there are " + std::to_string(vertices) + " vertices");
    } else {
        order.resize(vertices);
        for (std::size_t i = 0; i < vertices; ++i)
            order[i] = static_cast<std::uint32_t>(i);
    }
    if (mode == 4) {
        if (order.size() % 3 != 0)
            primitive.fail(std::to_string(order.size()) + " corners are no whole triangles");
        return order;
    }
    std::vector<std::uint32_t> result;
    for (std::size_t i = 2; i < order.size(); ++i) {
        bool strip = mode == 5, odd = strip && i % 2 == 1;
        std::uint32_t a = strip ? order[i - 2] : order[0], b = order[i - 1];
        result.insert(result.end(), {odd ? b : a, odd ? a : b, order[i]});
    }
    return result;
}

std::vector<glm::vec2> GltfReader::read_uv(const JsonView& attributes, const UvSource& source,
                                           std::size_t vertices) {
    std::string name = "TEXCOORD_" + std::to_string(source.set);
    auto accessor = attributes.find(name.c_str());
    if (!accessor)
        return {};
    std::uint32_t components = 0;
    std::vector<float> values = document_.read_floats(*accessor, components);
    if (components != 2 || values.size() / 2 != vertices)
        accessor->fail("must hold a VEC2 for each of the " + std::to_string(vertices) +
                       " vertices");
    std::vector<glm::vec2> uv(vertices);
    for (std::size_t i = 0; i < vertices; ++i) {
        uv[i] = source.apply({values[2 * i], values[2 * i + 1]});
        if (!(std::abs(uv[i].x) < 1e30f && std::abs(uv[i].y) < 1e30f))
            accessor->fail("element " + std::to_string(i) + " is not a number or beyond 1e30");
    }
    return uv;
}

std::vector<glm::vec3> GltfReader::read_colours(const JsonView& attributes, std::size_t vertices) {
    auto accessor = attributes.find("COLOR_0");
    if (!accessor)
        return {};
    std::uint32_t n = 0;
    std::vector<float> values = document_.read_floats(*accessor, n);
    if (n < 3 || values.size() / n != vertices)
        accessor->fail("must hold a VEC3 or VEC4 for each of the " + std::to_string(vertices) +
                       " vertices");
    std::vector<glm::vec3> colours(vertices);
    bool all_white = true;
    for (std::size_t i = 0; i < vertices; ++i)
        for (int c = 0; c < 3; ++c) {
            float x = values[n * i + static_cast<std::size_t>(c)];
            if (!(x >= 0 && x <= 1e6f))
                accessor->fail("element " + std::to_string(i) + " is not a colour");
            colours[i][c] = x;
            all_white = all_white && x == 1;
        }
    return all_white ? std::vector<glm::vec3>() : colours;
}

}  // namespace

void read_gltf(SceneBuilder& builder, std::string bytes) {
    GltfReader(builder, std::move(bytes)).read();
}

}  // namespace parallux
