#include "solve/checkpoint.h"

#include <new>

#include "output/checksum.h"
#include "parallux/error.h"
#include "parallux/result.h"
#include "solve/checkpoint_fields.h"
#include "solve/keeping.h"

namespace parallux {

namespace {

// What tells runs apart, before any of their state.
struct Identity {
    std::string version;
    std::uint64_t scene = 0, settings = 0;

    template <class Archive>
    void fields(Archive& a) {
        a(version), a(scene), a(settings);
    }
};

}  // namespace

std::uint64_t settings_hash(const SolveSettings& s) {
    Checksum sum;
    auto sink = [&](std::string_view bytes) { sum.add(bytes); };
    FieldWriter a(sink);
    a(s.method), a(s.direction), a(s.first_shot), a(s.first_shot_rays), a(s.shots), a(s.bundles);
    a(s.lines), a(s.line_spacing), a(s.lines_per_patch), a(s.batch), a(s.gather_share);
    a(s.groups), a(s.target_error), a(s.directions), a(s.seed), a(s.sphere_radius);
    return sum.value();
}

Checkpoint::Checkpoint(const Scene& scene, const Patches& patches, const SolveSettings& settings,
                       const Regions& regions, const RunState& run)
    : scene_(scene),
      patches_(patches),
      settings_(settings),
      regions_(regions),
      run_(run),
      writer_(settings.checkpoints.file) {
    if (!settings.checkpoints.any())
        return;
    const bool batches = settings.method == Method::bundles ||
                         (settings.method == Method::lines && settings.batch > 0);
    if (!batches)
        throw Error(Fault::usage,
                    "--checkpoint and --resume need --method bundles, or lines with --batch");
    scene_hash_ = scene_hash(scene, patches);
}

void Checkpoint::resume() {
    const std::filesystem::path& file = settings_.checkpoints.resume;
    if (file.empty())
        return;
    const std::string bytes = read_sealed(file, checkpoint_kind);
    FieldReader reader(file, body_of(bytes), checkpoint_kind.remedy);
    Identity identity;
    identity.fields(reader);
    check_identity(identity.version, identity.scene, identity.settings);
    fields_of(reader, run_, patches_, regions_);
    reader.end();
    const char* impossible = "a state that no run comes to";
    if (!run_.rounds.sound())
        reader.fail(impossible);
    // What the trial told and the rounds before set the plan of this one.
    run_.plan = make_plan(scene_, patches_, settings_, Trial(run_.plan.trial));
    run_.rounds.replay(run_.plan);
    if (!sound(run_, patches_))
        reader.fail(impossible);
    Group& group = run_.group;
    const double quanta = group.state.emission.quanta;
    group.state.emission = emission_of(patches_, group.direct);
    group.state.emission.quanta = quanta;
}

void Checkpoint::check_identity(const std::string& version, std::uint64_t scene,
                                std::uint64_t settings) const {
    const std::filesystem::path& file = settings_.checkpoints.resume;
    const std::string remedy = std::string("; ") + checkpoint_kind.remedy;
    if (version != PARALLUX_VERSION)
        input_error(file, "",
                    "a checkpoint of version " + printable(version) + ", this is " +
                        PARALLUX_VERSION + remedy);
    if (scene != scene_hash_)
        input_error(file, "",
                    "a checkpoint of another scene or other patches: it is of " + hash_text(scene) +
                        ", while " + printable(scene_.file.filename().string()) + " now gives " +
                        hash_text(scene_hash_) + remedy);
    if (const std::uint64_t own = settings_hash(settings_); settings != own)
        input_error(file, "",
                    "a checkpoint of other settings: they were " + hash_text(settings) +
                        " and are now " + hash_text(own) +
                        "; give those that it was begun with, or solve from the beginning");
}

std::string Checkpoint::bytes() const {
    run_.banks.collect(run_.plan.threads);
    if (run_.group.pass.leftover)
        run_.group.pass.leftover->ways.collect();
    Identity identity{PARALLUX_VERSION, scene_hash_, settings_hash(settings_)};
    Measure measure;
    identity.fields(measure);
    fields_of(measure, run_, patches_, regions_);
    std::string bytes;
    bytes.reserve(measure.bytes());
    auto append = [&](std::string_view more) { bytes += more; };
    FieldWriter writer(append);
    identity.fields(writer);
    fields_of(writer, run_, patches_, regions_);
    return bytes;
}

std::uint64_t checkpoint_bytes(std::uint64_t patches, std::uint32_t bands) {
    // A bank, the groups before, direct light, what was sent and is carried, and the ways kept.
    return patches *
               (lanes(bands) * 8 + (bands * 8 + 8) + bands * 4 + bands * 8 + lanes(bands) * 4) +
           keeping_bytes(patches, bands);
}

void Checkpoint::keep(bool last) {
    const Checkpoints& wanted = settings_.checkpoints;
    if (wanted.file.empty())
        return;
    tell_of(writer_.outcome());
    if (!last) {
        // What is asked for while one is being written is for the next.
        if (writer_.busy())
            return;
        const bool asked = wanted.wanted && wanted.wanted();
        if (!asked && watch_.seconds() < wanted.every)
            return;
    }
    tell_of(writer_.finish());
    watch_ = Watch();
    try {
        writer_.write(bytes());
    } catch (const std::bad_alloc&) {
        tell_of(wanted.file.string() + ": not enough memory for a checkpoint");
    }
    if (last)
        tell_of(writer_.finish());
}

void Checkpoint::tell_of(const CheckpointWriter::Outcome& outcome) const {
    if (outcome && settings_.checkpoints.written)
        settings_.checkpoints.written(*outcome);
}

}  // namespace parallux
