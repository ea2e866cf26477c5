#include "parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#ifndef PARALLUX_STD_THREADS
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace parallux {

unsigned thread_count(unsigned requested) {
    return requested ? requested : std::max(1u, std::thread::hardware_concurrency());
}

namespace {

// One piece after another until none is left, by one worker.
struct Pieces {
    std::size_t count, grain;
    const std::function<void(std::size_t, std::size_t, unsigned)>& body;
    std::atomic<std::size_t> next{0};
    std::mutex mutex;
    std::exception_ptr failure;

    void work(unsigned worker) {
        for (;;) {
            std::size_t begin = next.fetch_add(grain, std::memory_order_relaxed);
            if (begin >= count)
                return;
            try {
                body(begin, std::min(begin + grain, count), worker);
            } catch (...) {
                std::lock_guard lock(mutex);
                if (!failure)
                    failure = std::current_exception();
                next.store(count, std::memory_order_relaxed);
                return;
            }
        }
    }
};

}  // namespace

void parallel_for(unsigned threads, std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t, unsigned)>& body) {
    if (count == 0)
        return;
    grain = std::max<std::size_t>(1, grain);
    std::size_t pieces_wanted = (count - 1) / grain + 1;
    unsigned workers =
        static_cast<unsigned>(std::min<std::size_t>(thread_count(threads), pieces_wanted));
    Pieces pieces{count, grain, body, {}, {}, {}};
    if (workers == 1) {
        pieces.work(0);
    } else {
#ifdef PARALLUX_STD_THREADS
        std::vector<std::thread> team;
        for (unsigned worker = 1; worker < workers; ++worker)
            team.emplace_back([&pieces, worker] { pieces.work(worker); });
        pieces.work(0);
        for (std::thread& thread : team)
            thread.join();
#else
        // More threads than cores, for tests, must be allowed first.
        std::optional<tbb::global_control> allowed;
        if (workers > std::thread::hardware_concurrency())
            allowed.emplace(tbb::global_control::max_allowed_parallelism, workers);
        // The arena may offer fewer threads than workers: a worker that starts late finds no
        // pieces left, which is harmless.
        tbb::task_arena arena(static_cast<int>(workers));
        arena.execute([&] {
            tbb::parallel_for(
                0u, workers, [&pieces](unsigned worker) { pieces.work(worker); },
                tbb::static_partitioner{});
        });
#endif
    }
    if (pieces.failure)
        std::rethrow_exception(pieces.failure);
}

}  // namespace parallux
