#include "output/result_fields.h"

namespace parallux {

void write_result(const std::filesystem::path& file, const SavedSolution& result) {
    // The fields' list is one for both ways, and reading has to change them.
    auto& fields = const_cast<SavedSolution&>(result);
    Measure measure;
    result_fields(measure, fields);
    SealedFile output(file, result_kind, measure.bytes());
    FieldWriter writer(output);
    result_fields(writer, fields);
    output.commit();
}

}  // namespace parallux
