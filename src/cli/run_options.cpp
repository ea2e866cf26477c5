#include "cli/method_options.h"
#include "cli/option_group.h"
#include "cli/options.h"
#include "cli/values.h"
#include "vectors.h"

namespace parallux {

void add_patches(CLI::App& app, PatchSettings& patches) {
    const OptionGroup option{app, "Patches"};
    auto* size = option("--patch-size", "L", "Wanted side, in the scene's units",
                        [&](auto& v) { patches.size = parse_positive("--patch-size", v); });
    auto* count = option("--patches", "N", "Wanted number in all [10000]", [&](auto& v) {
        patches.count = parse_count("--patches", v, 1, 0x7fffffff);
    });
    size->excludes(count);
    app.add_flag_callback(
           "--no-clusters", [&] { patches.clusters = false; },
           "Give every fine triangle a patch of its own")
        ->group(option.name);
}

void add_workers(CLI::App& app, SolveOptions& o) {
    const OptionGroup option{app, "Run"};
    option("--threads", "T", "0: all [0]", [&](auto& v) {
        o.solve.threads = static_cast<unsigned>(parse_count("--threads", v, 0, 4096));
        o.picture.threads = o.bake.threads = o.lightmap_settings.threads = o.solve.threads;
    });
    option("--vectors", "SET",
           "Instruction set: auto, plain, sse4, avx2 or avx512; part of the speed alone [auto]",
           [&](auto& v) {
               if (!use_vectors(v.c_str()))
                   refuse("--vectors", v,
                          "expected auto, plain, sse4, avx2 or avx512, as far as this "
                          "machine has them");
           });
    app.add_flag("--quiet", o.quiet, "No progress, summary or warnings; failures are still told")
        ->group(option.name);
}

void add_run(CLI::App& app, SolveOptions& o) {
    add_workers(app, o);
    const OptionGroup option{app, "Run"};
    option("--max-memory", "M", "Refuse to start a solve above this: 500M, 4GiB [no limit]",
           [&](auto& v) { o.solve.max_memory = parse_bytes("--max-memory", v); });
    option("--time-limit", "S", "Seconds after which to stop with a partial result [none]",
           [&](auto& v) { o.solve.time_limit = parse_positive("--time-limit", v); });
    option("--progress", "P", "auto, on (a bar), off, or json (one object a line) [auto]",
           [&](auto& v) {
               o.progress = parse_choice<ProgressMode>("--progress", v,
                                                       {{"auto", ProgressMode::automatic},
                                                        {"on", ProgressMode::on},
                                                        {"off", ProgressMode::off},
                                                        {"json", ProgressMode::json}});
           });
}

void add_checkpoints(CLI::App& app, SolveOptions& o) {
    Checkpoints& checkpoints = o.solve.checkpoints;
    const OptionGroup option{app, "Run"};
    auto* file = option(
        "--checkpoint", "FILE",
        "Keep the run's state here while it goes on, and when it is stopped by SIGINT, SIGTERM or "
        "--time-limit; SIGUSR1 asks for it at once",
        [&](auto& v) { checkpoints.file = parse_output("--checkpoint", v); });
    option("--checkpoint-every", "S", "At most so often, in seconds [60]", [&](auto& v) {
        checkpoints.every = parse_positive("--checkpoint-every", v);
    })->needs(file);
    option("--resume", "FILE",
           "Go on from a checkpoint of this very scene and these settings, on any number of "
           "threads; the result has the same bits",
           [&](auto& v) { checkpoints.resume = parse_output("--resume", v); });
}

}  // namespace parallux
