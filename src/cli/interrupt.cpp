#include "cli/interrupt.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>

#include <unistd.h>

#include "cli/terminal.h"
#include "output/output_file.h"

namespace parallux {

namespace {

// Lock-free, hence fit for a signal handler.
std::atomic<int> signals{0};
std::atomic<bool> keeping{false}, wanted{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

extern "C" void on_signal(int number) {
    const int saved = errno;
    if (number == SIGUSR1) {
        wanted = true;
    } else if (signals.fetch_add(1) > 0 || !keeping) {
        remove_temporaries();
        _exit(exit_interrupted);
    }
    errno = saved;
}

}  // namespace

void watch_signals() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    for (int number : {SIGINT, SIGTERM, SIGUSR1})
        sigaction(number, &action, nullptr);
}

void end_cleanly() {
    std::set_terminate([] {
        remove_temporaries();
        if (!std::current_exception())
            std::abort();
        std::_Exit(report_failure());
    });
}

void keep_results() {
    keeping = true;
}

bool interrupted() {
    return signals > 0;
}

bool checkpoint_wanted() {
    return wanted.exchange(false);
}

}  // namespace parallux
