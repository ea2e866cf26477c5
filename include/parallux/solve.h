#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "parallux/checkpoints.h"
#include "parallux/lines.h"
#include "parallux/patches.h"
#include "parallux/scene.h"
#include "parallux/transfer.h"

// Stage 6: the method. solve() is first shot, lines, leftover, result.

namespace parallux {

/// How power is carried between patches, once the first shots are done.
///  bundles      parallel lines, exchanged batch after batch from one snapshot each
///  lines        independent lines as the paper prints it: each sees what the one before it did;
///               in parallel form, with `batch` > 0, from snapshots as bundles do
///  progressive  shots of local rays from the patch with most unshot power [Cohen88]
///  particles    local random walks of equal quanta [Pattanaik92, Shirley91]
///  matrix       the lines are only counted, F_ij = n_ij / n_i, then the system is solved
///  [Sbert93];
///               storage is quadratic in the patches
/// The last three are what the first two are judged against.
enum class Method { bundles, lines, progressive, particles, matrix };

/// How direct light is found: left to the lines, by local rays from the sources, or by form factors
/// (exact where nothing stands between; past what does, in closed form in scenes of up to 256
/// surfaces, else by shadow rays). automatic: for bundles and lines, form factors in scenes of few
/// surfaces and sources, else rays; off for the other methods.
enum class FirstShot { automatic, off, rays, exact };

struct SolveSettings {
    Method method = Method::bundles;
    Direction direction = Direction::bidirectional;
    FirstShot first_shot = FirstShot::automatic;
    /// 0: grows with the lines. Of a run to a stated error: for as many bundles as its first round
    /// has, in later ones in proportion to theirs.
    std::uint64_t first_shot_rays = 0;
    std::uint64_t shots = 0;    ///< then so many more, each from the patch with most unshot power
    std::uint64_t bundles = 0;  ///< 0: from `lines`, else 4096
    std::uint64_t lines = 0;    ///< wanted total, or local rays; 0: from `bundles`
    double line_spacing = 0;    ///< δ, metres; 0: from lines_per_patch
    /// c: δ² = mean patch area / c; 0: 4 with 1500 bundles a group, more with more as their power
    /// 2/3, fewer with fewer, 1 to 64; up to 4 where a bundle would have few; of lines 4.
    double lines_per_patch = 0;
    std::uint32_t batch = 0;  ///< bundles (or as many lines) from one snapshot; 0: of bundles up to
                              ///< min(64, those that pass / 256), of lines one after the other
    /// Share of the bundles that gather once the others have passed, 0 … 1; negative: chosen.
    double gather_share = -1;
    /// Independent runs, of as many bundles each, that the result is the mean of and whose spread
    /// tells its error; 0: eight with 800 bundles or more, else 1, which leaves the error unknown.
    std::uint32_t groups = 0;
    /// Runs until the relative RMS is below this with 95 % confidence, in place of a number of
    /// bundles; 0: off. Of bundles alone, and not of one group. The first round has `groups` groups
    /// of the least bundles that have no bias of their own, later ones as much as is expected to be
    /// missing; a run that is not there after its last round ends with a larger bound.
    double target_error = 0;
    DirectionSet directions = DirectionSet::lattice;
    std::uint64_t seed = 1;
    unsigned threads = 0;          ///< 0: all
    std::uint64_t max_memory = 0;  ///< bytes; 0: no limit
    double time_limit = 0;         ///< seconds; 0: none. A stopped run is marked partial.
    double sphere_radius = 0;      ///< of independent lines; 0: the scene's
    /// Of bundles, and of lines in batches. Those up to here, but for threads, memory and time, are
    /// part of the result: a checkpoint of others is refused.
    Checkpoints checkpoints = {};
};

/// What a run to a stated error still needs, as its rounds so far tell.
struct Forecast {
    double error = 0;           ///< the relative RMS is below this with 95 % confidence
    double target = 0;          ///< and should be below this
    double seconds_so_far = 0;  ///< since the solve began
    std::uint64_t bundles = 0;  ///< expected to be missing
    double seconds = 0;         ///< that they take at the pace so far
};

/// Where a solve stands; given to the callback now and then, always from the calling thread.
struct Progress {
    const char* stage = "";   ///< "first shot", "bundles", "lines", "shots", "particles" …
    double done = 0;          ///< 0 … 1 of the stage
    std::uint64_t lines = 0;  ///< so far
    double seconds = 0;       ///< since the stage began
    /// Set in one call after each round of a run to a stated error that another one follows; gone
    /// after the call.
    const Forecast* forecast = nullptr;
};

/// Returns false to stop after the current batch; the result is then marked partial.
using ProgressCallback = std::function<bool(const Progress&)>;

/// Energy per band in integer quanta: emitted = absorbed + escaped + unshot + residual, and the
/// residual is 0.
struct Balance {
    double watts_per_quantum = 0;
    std::vector<std::int64_t> emitted, absorbed, escaped, unshot, residual;
};

struct Seconds {
    double load = 0, patches = 0, first_shot = 0, global = 0, gather = 0, output = 0, total = 0;
    double serial = 0;  ///< of global: what no further thread would shorten
};

/// Everything a solve returns. Arrays per band lie together: radiosity[patch * bands + band].
struct Solution {
    std::uint32_t bands = 0;
    std::vector<float> radiosity;          ///< B, W/m²
    std::vector<float> irradiance;         ///< H, W/m², never below 0
    std::vector<float> stderror;           ///< of B, from groups; empty when there is but one
    std::vector<std::uint64_t> crossings;  ///< lines that left each patch
    std::uint64_t hash = 0;                ///< over radiosity and irradiance alone
    Balance energy;
    LineCounts counts;
    std::uint64_t leaks = 0;  ///< closed scenes: lists of odd length; others 0
    Seconds seconds;
    double relative_rms = 0;        ///< of all that does not emit, by area, from stderror
    double relative_rms_bound = 0;  ///< what it is below with 95 % confidence
    std::uint32_t groups = 1;       ///< done; stderror has one degree of freedom less
    std::uint64_t bundles = 0;      ///< done; of bundles and of lines in batches
    double line_spacing = 0;
    std::uint32_t batch = 0;
    unsigned threads = 0;
    std::uint64_t first_shot_rays = 0;
    std::uint64_t shots = 0;             ///< done, beyond those from the sources
    std::uint64_t predicted_memory = 0;  ///< bytes, as told before the run; 0: not solved here
    bool partial = false;
    std::vector<std::string> warnings;
};

/// Looks at a run under way. Each of its groups is a whole solution, so that the mean of those that
/// are done has no bias, only a larger error; before the first one is done there is nothing to
/// show.
struct Preview {
    double every = 0;  ///< seconds, at least, from the start to the first and from one to the next
    /// What the groups so far come to, marked partial; without stderror from one group alone.
    /// Called from the calling thread, between groups, which wait; not after the last. What it
    /// throws ends the run. Each call takes the memory of another Solution, which
    /// predicted_memory() leaves out.
    std::function<void(const Solution&)> show;
};

/// Solves H = F B, B = E + ρ H. Equal scene, patches and settings give equal bits on any number of
/// threads, previewed or not, interrupted and resumed or not. Storage is linear in the patches, but
/// for the matrix. Throws Fault::memory before taking more than max_memory, Fault::usage for
/// settings that contradict each other.
Solution solve(const Scene& scene, const Patches& patches, const SolveSettings& settings,
               const ProgressCallback& progress = {}, const Preview& preview = {});

/// The name of a method, as options and statistics have it.
const char* method_name(Method method);

/// Bytes that the process will take at the peak of solve(): the program itself, scene, patches and
/// all that the method needs; not outputs, which come later. What a run takes in truth is 70 to
/// 100 % of it. Throws Fault::usage for settings that contradict each other. Linear, quick.
std::uint64_t predicted_memory(const Scene& scene, const Patches& patches,
                               const SolveSettings& settings);

}  // namespace parallux
