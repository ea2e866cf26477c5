#include "cli/interrupt.h"

#include <atomic>
#include <cerrno>
#include <csignal>

#include <pthread.h>
#include <unistd.h>

namespace parallux {

namespace {

// Lock-free, hence fit for a signal handler.
std::atomic<int> signals{0};
std::atomic<bool> keeping{false};
std::atomic<bool> writing{false};
std::atomic<bool> end_after_writing{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);
pthread_t watcher;

extern "C" void on_signal(int number) {
    int saved = errno;
    if (!pthread_equal(pthread_self(), watcher)) {
        pthread_kill(watcher, number);
        errno = saved;
        return;
    }
    bool at_once = signals.fetch_add(1) > 0 || !keeping;
    if (at_once && !writing)
        _exit(exit_interrupted);
    if (at_once)
        end_after_writing = true;
    errno = saved;
}

}  // namespace

void watch_signals() {
    watcher = pthread_self();
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

void keep_results() {
    keeping = true;
}

bool interrupted() {
    return signals > 0;
}

WritingFile::WritingFile() {
    writing = true;
}

WritingFile::~WritingFile() {
    writing = false;
    if (end_after_writing)
        _exit(exit_interrupted);
}

}  // namespace parallux
