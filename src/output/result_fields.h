#pragma once

#include "output/fields.h"
#include "output/sealed_file.h"
#include "parallux/result.h"

namespace parallux {

inline constexpr FileKind result_kind = {"PLXRES\r\n", 1, "a result", "parallux solve --save",
                                         "solve again with --save"};

/// read_result() of a file that has these bytes.
SavedSolution result_of(const std::filesystem::path& file, const std::string& bytes);

/// All that a file keeps of a result, in its order, for reading and writing alike: the archive is
/// called with each value.
template <class Archive>
void result_fields(Archive& a, SavedSolution& r) {
    Solution& s = r.solution;
    a(r.version), a(r.scene), a(r.arguments);
    a(r.settings.method), a(r.settings.seed), a(r.settings.target_error);
    a(s.bands), a(s.irradiance), a(s.radiosity), a(s.stderror), a(s.hash);
    fields_of(a, s.energy);
    fields_of(a, s.counts);
    a(s.leaks);
    fields_of(a, s.seconds);
    a(s.relative_rms), a(s.relative_rms_bound), a(s.groups), a(s.bundles), a(s.line_spacing);
    a(s.batch), a(s.threads), a(s.first_shot_rays), a(s.shots), a(s.partial), a(s.warnings);
}

}  // namespace parallux
