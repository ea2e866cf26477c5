#include "output/result_fields.h"
#include "scene/input.h"

namespace parallux {

SavedSolution read_result(const std::filesystem::path& file) {
    return result_of(file, read_file(file, most_sealed_bytes));
}

SavedSolution result_of(const std::filesystem::path& file, const std::string& bytes) {
    check_sealed(file, bytes, result_kind);
    SavedSolution result;
    FieldReader reader(file, body_of(bytes), result_kind.remedy);
    result_fields(reader, result);
    reader.end();
    return result;
}

void check_result(const std::filesystem::path& file, const SavedSolution& result,
                  const Scene& scene, const Patches& patches) {
    const Solution& solution = result.solution;
    const std::size_t values = patches.count() * patches.bands;
    const std::uint64_t hash = scene_hash(scene, patches);
    if (result.scene == hash && solution.bands == patches.bands &&
        solution.irradiance.size() == values && solution.radiosity.size() == values &&
        (solution.stderror.empty() || solution.stderror.size() == values))
        return;
    input_error(file, "",
                "a result of another scene or other patches: it is of " + hash_text(result.scene) +
                    ", while " + printable(scene.file.filename().string()) + " now gives " +
                    hash_text(hash) + "; solve again with --save");
}

}  // namespace parallux
