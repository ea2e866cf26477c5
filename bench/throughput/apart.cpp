#include "throughput/apart.h"

#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include "parallux/error.h"

namespace parallux::throughput {

namespace {

struct Answer {
    double seconds;
    LineCounts counts;
};

void keep_to_processor(unsigned number) {
    cpu_set_t allowed, own;
    if (sched_getaffinity(0, sizeof allowed, &allowed) != 0)
        return;
    CPU_ZERO(&own);
    for (int processor = 0; processor < CPU_SETSIZE; ++processor)
        if (CPU_ISSET(processor, &allowed) && number-- == 0)
            CPU_SET(processor, &own);
    if (CPU_COUNT(&own) == 1)
        sched_setaffinity(0, sizeof own, &own);
}

// In the child: one thread needs none of the parent's workers, which a fork leaves behind.
[[noreturn]] void solve_and_answer(const Case& of, unsigned number, int end) {
    try {
        keep_to_processor(number);
        const Solution solution = solve(of.scene, of.patches, of.settings(1));
        const Answer answer{solution.seconds.global, solution.counts};
        _exit(write(end, &answer, sizeof answer) != sizeof answer);
    } catch (...) {
        _exit(1);  // the parent says that it failed
    }
}

}  // namespace

Measured ApartEngine::run(unsigned threads) {
    int ends[2];
    if (pipe(ends) != 0)
        throw Error(Fault::internal, "no pipe to child processes");
    for (unsigned k = 0; k < threads; ++k) {
        const pid_t child = fork();
        if (child < 0)
            throw Error(Fault::internal, "no child process");
        if (child == 0)
            solve_and_answer(case_, k, ends[1]);
    }
    close(ends[1]);
    Measured all;
    double rate = 0;
    for (unsigned k = 0; k < threads; ++k) {
        Answer answer;
        if (read(ends[0], &answer, sizeof answer) != sizeof answer)
            throw Error(Fault::internal, "a run in a child process failed");
        all.counts += answer.counts;
        rate += static_cast<double>(answer.counts.lines) / answer.seconds;
    }
    close(ends[0]);
    while (wait(nullptr) > 0) {
    }
    all.seconds = static_cast<double>(all.counts.lines) / rate;
    return all;
}

}  // namespace parallux::throughput
