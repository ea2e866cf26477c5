#pragma once

#include "parallux/result.h"

namespace parallux {

/// The first bytes of a result's file; the last two tell when a transfer has changed line ends.
inline constexpr char result_magic[9] = "PLXRES\r\n";
inline constexpr std::uint32_t result_format = 1;
/// Magic, format and the file's length; then the fields, then a checksum of all before.
inline constexpr std::uint64_t result_head = 8 + 4 + 8;

/// All that a file keeps of a result, in its order, for reading and writing alike: the archive is
/// called with each value.
template <class Archive>
void result_fields(Archive& a, SavedSolution& r) {
    Solution& s = r.solution;
    a(r.version), a(r.scene), a(r.arguments);
    a(r.settings.method), a(r.settings.seed), a(r.settings.target_error);
    a(s.bands), a(s.irradiance), a(s.radiosity), a(s.stderror), a(s.hash);
    Balance& e = s.energy;
    a(e.watts_per_quantum);
    a(e.emitted), a(e.absorbed), a(e.escaped), a(e.unshot), a(e.residual);
    LineCounts& c = s.counts;
    a(c.lines), a(c.nonempty), a(c.hits), a(c.transfers), a(c.odd), a(c.met_backs), a(s.leaks);
    Seconds& t = s.seconds;
    a(t.load), a(t.patches), a(t.first_shot), a(t.global), a(t.gather), a(t.output), a(t.total);
    a(t.serial);
    a(s.relative_rms), a(s.relative_rms_bound), a(s.groups), a(s.bundles), a(s.line_spacing);
    a(s.batch), a(s.threads), a(s.first_shot_rays), a(s.shots), a(s.partial), a(s.warnings);
}

}  // namespace parallux
