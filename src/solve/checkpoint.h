#pragma once

#include <cstdint>

#include "solve/checkpoint_writer.h"
#include "solve/estimate.h"
#include "solve/group.h"
#include "solve/rounds.h"

namespace parallux {

/// Over all settings that are part of the result.
std::uint64_t settings_hash(const SolveSettings& settings);

/// What a run has come to, where its listener is asked: all that the rest of it depends on, beside
/// scene, patches and settings.
struct RunState {
    Plan& plan;
    Rounds& rounds;
    Estimate& estimate;
    Group& group;
    Seconds& seconds;
    Banks& banks;
};

/// The run's state in a file, as the settings want it.
class Checkpoint {
public:
    /// Keeps references to all. Throws Fault::usage for a method that has no checkpoints.
    Checkpoint(const Scene& scene, const Patches& patches, const SolveSettings& settings,
               const Regions& regions, const RunState& run);

    /// Where the settings name a file to go on from, sets the state by it; throws Fault::input.
    void resume();
    /// To be called between batches: writes one when it is time, or wanted; `last`: in any case,
    /// and waits for it. Linear in the patches when it does.
    void keep(bool last);
    /// Waits for what is being written, and tells of it.
    void finish() { tell_of(writer_.finish()); }

private:
    std::string bytes() const;
    void check_identity(const std::string& version, std::uint64_t scene,
                        std::uint64_t settings) const;
    void tell_of(const CheckpointWriter::Outcome& outcome) const;

    const Scene& scene_;
    const Patches& patches_;
    const SolveSettings& settings_;
    const Regions& regions_;
    RunState run_;
    std::uint64_t scene_hash_ = 0;
    CheckpointWriter writer_;
    Watch watch_;  // since the run began, or the last one was begun
};

/// Bytes that a checkpoint of the run takes while it is written.
std::uint64_t checkpoint_bytes(std::uint64_t patches, std::uint32_t bands);

}  // namespace parallux
