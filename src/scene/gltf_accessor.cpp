#include <algorithm>
#include <cmath>
#include <cstring>

#include "scene/gltf_document.h"

namespace parallux {
namespace {

enum ComponentType : std::uint64_t {
    byte_type = 5120,
    unsigned_byte_type = 5121,
    short_type = 5122,
    unsigned_short_type = 5123,
    unsigned_int_type = 5125,
    float_type = 5126
};

std::uint64_t component_bytes(const JsonView& type) {
    switch (type.count(65535)) {
        case byte_type:
        case unsigned_byte_type:
            return 1;
        case short_type:
        case unsigned_short_type:
            return 2;
        case unsigned_int_type:
        case float_type:
            return 4;
        default:
            type.fail("no such component type");
    }
}

std::uint32_t components_of(const JsonView& type) {
    const std::string& name = type.text();
    if (name == "SCALAR")
        return 1;
    if (name == "VEC2")
        return 2;
    if (name == "VEC3")
        return 3;
    if (name == "VEC4")
        return 4;
    type.fail("must be SCALAR, VEC2, VEC3 or VEC4 here");
}

template <class T>
T load(const char* at) {
    T value;
    std::memcpy(&value, at, sizeof value);  // files need not be aligned
    return value;
}

float component(const char* at, std::uint64_t type, bool normalized) {
    auto scaled = [&](auto value, float largest) {
        auto x = static_cast<float>(value);
        return normalized ? std::max(x / largest, -1.0f) : x;
    };
    switch (type) {
        case byte_type:
            return scaled(load<std::int8_t>(at), 127.0f);
        case unsigned_byte_type:
            return scaled(load<std::uint8_t>(at), 255.0f);
        case short_type:
            return scaled(load<std::int16_t>(at), 32767.0f);
        case unsigned_short_type:
            return scaled(load<std::uint16_t>(at), 65535.0f);
        case unsigned_int_type:
            return scaled(load<std::uint32_t>(at), 4294967295.0f);
        default:
            return load<float>(at);
    }
}

std::uint32_t whole_number(const char* at, std::uint64_t type) {
    switch (type) {
        case unsigned_byte_type:
            return load<std::uint8_t>(at);
        case unsigned_short_type:
            return load<std::uint16_t>(at);
        default:
            return load<std::uint32_t>(at);
    }
}

bool is_unsigned(std::uint64_t type) {
    return type == unsigned_byte_type || type == unsigned_short_type || type == unsigned_int_type;
}

}  // namespace

// The bytes of `count` elements that `owner` (an accessor or a part of a sparse one) places in its
// buffer view. Counts are below 2³², strides below 2⁸ and offsets below 2³³: no overflow.
std::string_view GltfDocument::span(const JsonView& owner, std::uint64_t count,
                                    std::uint64_t element_bytes, std::uint64_t& stride) {
    JsonView index = owner.at("bufferView");
    std::string_view bytes = view_bytes(index);
    std::uint64_t offset = owner.count_or("byteOffset", 0, std::uint64_t(1) << 33);
    stride = element("bufferViews", index).count_or("byteStride", element_bytes, 252);
    if (stride < element_bytes)
        index.fail("byteStride " + std::to_string(stride) + " is less than an element's " +
                   std::to_string(element_bytes) + " bytes");
    std::uint64_t needed = count == 0 ? 0 : offset + (count - 1) * stride + element_bytes;
    if (needed > bytes.size())
        owner.fail("needs " + std::to_string(needed) + " bytes of a buffer view of " +
                   std::to_string(bytes.size()));
    return bytes.substr(std::min<std::uint64_t>(offset, bytes.size()));
}

GltfDocument::Layout GltfDocument::layout(const JsonView& accessor) {
    Layout result;
    result.count = accessor.at("count").count(0xFFFFFFFFu);
    result.component_type = accessor.at("componentType").count(65535);
    result.components = components_of(accessor.at("type"));
    result.normalized = accessor.boolean_or("normalized", false);
    std::uint64_t size = component_bytes(accessor.at("componentType")) * result.components;
    if (accessor.has("bufferView"))
        result.bytes = span(accessor, result.count, size, result.stride);
    else if (result.count > (1u << 20))
        accessor.fail("more than 1048576 elements without a bufferView, so all of them 0");
    // One buffer may be read any number of times over; this is what an honest file may need.
    elements_read_ += result.count;
    if (elements_read_ > (std::uint64_t(1) << 28))
        accessor.fail("more than 268435456 vertices and indices in all; simplify the scene");
    return result;
}

std::vector<float> GltfDocument::read_floats(const JsonView& index, std::uint32_t& components) {
    JsonView accessor = element("accessors", index);
    Layout from = layout(accessor);
    components = from.components;
    std::uint64_t n = from.components, size = component_bytes(accessor.at("componentType"));
    std::vector<float> values(from.count * n, 0.0f);
    auto copy = [&](const char* source, std::uint64_t to) {
        for (std::uint64_t c = 0; c < n; ++c)
            values[to * n + c] = component(source + c * size, from.component_type, from.normalized);
    };
    if (from.stride != 0)
        for (std::uint64_t i = 0; i < from.count; ++i)
            copy(from.bytes.data() + i * from.stride, i);

    // A sparse accessor replaces some elements by others.
    if (auto sparse = accessor.find("sparse")) {
        std::uint64_t count = sparse->at("count").count(from.count);
        JsonView where = sparse->at("indices"), what = sparse->at("values");
        std::uint64_t type = where.at("componentType").count(65535);
        if (!is_unsigned(type))
            where.fail("must be unsigned");
        std::uint64_t index_stride = 0, value_stride = 0;
        auto places = span(where, count, component_bytes(where.at("componentType")), index_stride);
        auto elements = span(what, count, size * n, value_stride);
        for (std::uint64_t i = 0; i < count; ++i) {
            std::uint32_t to = whole_number(places.data() + i * index_stride, type);
            if (to >= from.count)
                where.fail("element " + std::to_string(i) + " is " + std::to_string(to) + " of " +
                           std::to_string(from.count));
            copy(elements.data() + i * value_stride, to);
        }
    }
    return values;
}

std::vector<std::uint32_t> GltfDocument::read_indices(const JsonView& index) {
    JsonView accessor = element("accessors", index);
    Layout from = layout(accessor);
    if (from.components != 1 || !is_unsigned(from.component_type))
        accessor.fail("indices must be unsigned SCALARs");
    if (accessor.has("sparse"))
        accessor.fail("sparse indices are not supported; export them whole");
    std::vector<std::uint32_t> values(from.count, 0);
    if (from.stride != 0)
        for (std::uint64_t i = 0; i < from.count; ++i)
            values[i] = whole_number(from.bytes.data() + i * from.stride, from.component_type);
    return values;
}

}  // namespace parallux
