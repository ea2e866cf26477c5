#include "scene/json_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "scene/input.h"

namespace parallux {

Json parse_json(const std::filesystem::path& file, std::string_view text) {
    // A parsed number takes some sixteen times the two bytes it may have in the file.
    constexpr std::size_t limit = std::size_t(1) << 28;
    if (text.size() > limit)
        input_error(file, "", "more than 256 MiB of JSON; keep geometry in binary buffers");
    auto shallow = [&](int depth, Json::parse_event_t, Json&) {
        if (depth > 256)
            input_error(file, "", "JSON nested deeper than 256");
        return true;
    };
    try {
        return Json::parse(text, shallow);
    } catch (const Json::exception& error) {
        std::string_view what = error.what();  // opens with the exception's own name in brackets
        what.remove_prefix(std::min(what.find("] ") + 2, what.size()));
        input_error(file, "", "not valid JSON: " + std::string(what));
    }
}

void JsonView::fail(const std::string& what) const {
    input_error(*file_, path_.empty() ? "/" : path_, what);
}

const Json& JsonView::object() const {
    if (!value_->is_object())
        fail("must be an object");
    return *value_;
}

bool JsonView::has(const char* key) const {
    return object().contains(key);
}

JsonView JsonView::at(const char* key) const {
    auto found = object().find(key);
    if (found == value_->end())
        fail(std::string("\"") + key + "\" is missing");
    return JsonView(*file_, *found, path_ + "/" + key);
}

std::optional<JsonView> JsonView::find(const char* key) const {
    if (!has(key))
        return std::nullopt;
    return at(key);
}

void JsonView::only(std::initializer_list<std::string_view> keys) const {
    for (const auto& [key, value] : object().items()) {
        if (std::find(keys.begin(), keys.end(), key) != keys.end())
            continue;
        std::string known;
        for (std::string_view k : keys)
            known += (known.empty() ? "" : ", ") + std::string(k);
        input_error(*file_, path_ + "/" + key, "unknown key; known here: " + known);
    }
}

std::size_t JsonView::size() const {
    if (!value_->is_array())
        fail("must be an array");
    return value_->size();
}

JsonView JsonView::at(std::size_t index) const {
    if (index >= size())
        fail("has " + std::to_string(size()) + " elements; number " + std::to_string(index) +
             " is wanted");
    return JsonView(*file_, (*value_)[index], path_ + "/" + std::to_string(index));
}

double JsonView::number() const {
    return number(-1e15, 1e15);
}

double JsonView::number(double low, double high) const {
    if (!value_->is_number())
        fail("must be a number");
    double x = value_->get<double>();
    if (!(x >= low && x <= high)) {
        char text[120];
        std::snprintf(text, sizeof text, "%g is outside [%g, %g]", x, low, high);
        fail(text);
    }
    return x;
}

std::uint64_t JsonView::count(std::uint64_t maximum) const {
    double x = value_->is_number() ? value_->get<double>() : -1;
    if (!(x >= 0 && x == std::floor(x)))
        fail("must be a whole number, 0 or more");
    if (x > static_cast<double>(maximum))
        fail(value_->dump() + " is more than " + std::to_string(maximum));
    return static_cast<std::uint64_t>(x);
}

const std::string& JsonView::text() const {
    if (!value_->is_string())
        fail("must be a text");
    return value_->get_ref<const std::string&>();
}

bool JsonView::boolean() const {
    if (!value_->is_boolean())
        fail("must be true or false");
    return value_->get<bool>();
}

glm::dvec3 JsonView::vector() const {
    if (size() != 3)
        fail("must have three numbers");
    return {at(std::size_t(0)).number(), at(1).number(), at(2).number()};
}

double JsonView::number_or(const char* key, double otherwise) const {
    auto found = find(key);
    return found ? found->number() : otherwise;
}

std::uint64_t JsonView::count_or(const char* key, std::uint64_t otherwise,
                                 std::uint64_t maximum) const {
    auto found = find(key);
    return found ? found->count(maximum) : otherwise;
}

std::string JsonView::text_or(const char* key, const std::string& otherwise) const {
    auto found = find(key);
    return found ? found->text() : otherwise;
}

bool JsonView::boolean_or(const char* key, bool otherwise) const {
    auto found = find(key);
    return found ? found->boolean() : otherwise;
}

}  // namespace parallux
