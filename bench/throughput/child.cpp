#include "throughput/child.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "parallux/error.h"
#include "throughput/engine.h"

namespace parallux::throughput {

namespace {

// What comes back from the child: the run, or what went wrong.
struct Answer {
    ChildRun run;
    int fault = 0;
    char what[1024] = "";
};

ChildRun run(const std::string& name, const CaseSettings& settings, unsigned threads) {
    const Case of = make_case(name, settings);
    const Measured measured = BundleEngine(of).run(threads);
    return {of.patches.count(), of.lines_per_bundle, of.bundles, measured.lines_per_second(), 0};
}

}  // namespace

ChildRun run_in_child(const std::string& name, const CaseSettings& settings, unsigned threads) {
    int pipe_ends[2];
    if (pipe(pipe_ends) != 0)
        throw Error(Fault::internal, "no pipe to a child process");
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0)
        throw Error(Fault::internal, "no child process");
    if (child == 0) {
        Answer answer;
        try {
            answer.run = run(name, settings, threads);
        } catch (const Error& error) {
            answer.fault = static_cast<int>(error.fault());
            std::snprintf(answer.what, sizeof answer.what, "%s", error.what());
        } catch (...) {
            _exit(1);
        }
        _exit(write(pipe_ends[1], &answer, sizeof answer) != sizeof answer);
    }
    close(pipe_ends[1]);
    Answer answer;
    const bool whole = read(pipe_ends[0], &answer, sizeof answer) == sizeof answer;
    close(pipe_ends[0]);
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    if (!whole || status != 0)
        throw Error(Fault::internal, "the run of " + name + " in a child process failed");
    if (answer.fault != 0)
        throw Error(static_cast<Fault>(answer.fault), answer.what);
    answer.run.peak_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    return answer.run;
}

void sweep() {
    std::printf("the paper's scene, RGB, 4 lines a patch\n%9s %8s %9s %9s %9s %10s %9s %8s\n",
                "patches", "bundles", "Mlines/s", "ns/line", "Mlines/s", "ns/line", "peak, MiB",
                "B/patch");
    std::printf("%18s %19s %20s\n", "", "1 thread", "2 threads");
    std::vector<double> times;
    for (std::uint64_t patches : {10'000u, 100'000u, 1'000'000u, 10'000'000u}) {
        // Some 10⁸ lines, but 64 bundles at least.
        CaseSettings settings;
        settings.patches = patches;
        settings.bundles = std::clamp<std::uint64_t>(100'000'000 / patches, 64, 8192);
        const ChildRun one = run_in_child("paper-12150", settings, 1);
        const ChildRun two = run_in_child("paper-12150", settings, 2);
        times.push_back(1e9 / one.lines_per_second);
        std::printf("%9llu %8llu %9.1f %9.2f %9.1f %10.2f %9.0f %8.0f\n",
                    static_cast<unsigned long long>(two.patches),
                    static_cast<unsigned long long>(two.bundles), one.lines_per_second * 1e-6,
                    times.back(), two.lines_per_second * 1e-6, 1e9 / two.lines_per_second,
                    static_cast<double>(two.peak_bytes) / 0x1p20, two.bytes_per_patch());
        std::fflush(stdout);
    }
    std::printf("time a line, largest over smallest scene, 1 thread: %.2f\n",
                times.back() / times.front());
}

}  // namespace parallux::throughput
