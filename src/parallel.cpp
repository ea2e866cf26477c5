#include "parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <sched.h>

#ifndef PARALLUX_STD_THREADS
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#endif

namespace parallux {

unsigned thread_count(unsigned requested) {
    return requested ? requested : std::max(1u, std::thread::hardware_concurrency());
}

namespace {

// A loop's pieces, dealt to the workers in as many runs: each takes those of its own run first, so
// that from loop to loop it meets what its caches hold, then helps the others.
class Pieces {
public:
    using Body = std::function<void(std::size_t, std::size_t, unsigned)>;

    Pieces(std::size_t count, std::size_t grain, unsigned workers, const Body& body)
        : count_(count), grain_(grain), body_(body), runs_(workers) {
        const std::size_t pieces = (count - 1) / grain + 1;
        for (unsigned run = 0; run < workers; ++run) {
            runs_[run].next = pieces * run / workers;
            runs_[run].end = pieces * (run + 1) / workers;
        }
    }

    void work(unsigned worker) {
        for (std::size_t k = 0; k < runs_.size(); ++k) {
            Run& run = runs_[(worker + k) % runs_.size()];
            for (;;) {
                std::size_t piece = run.next.fetch_add(1, std::memory_order_relaxed);
                if (piece >= run.end || failed_.load(std::memory_order_relaxed))
                    break;
                call(piece, worker);
            }
        }
    }

    void rethrow() const {
        if (failure_)
            std::rethrow_exception(failure_);
    }

private:
    struct alignas(64) Run {
        std::atomic<std::size_t> next{0};
        std::size_t end = 0;
    };

    void call(std::size_t piece, unsigned worker) {
        try {
            body_(piece * grain_, std::min((piece + 1) * grain_, count_), worker);
        } catch (...) {
            std::lock_guard lock(mutex_);
            if (!failure_)
                failure_ = std::current_exception();
            failed_.store(true, std::memory_order_relaxed);
        }
    }

    std::size_t count_, grain_;
    const Body& body_;
    std::vector<Run> runs_;
    std::atomic<bool> failed_{false};
    std::mutex mutex_;
    std::exception_ptr failure_;
};

// The processors that the program may use.
class Processors {
public:
    Processors() { known_ = sched_getaffinity(0, sizeof allowed_, &allowed_) == 0; }

    unsigned count() const { return known_ ? static_cast<unsigned>(CPU_COUNT(&allowed_)) : 0; }
    void bind(unsigned worker) const {
        for (int processor = 0; processor < CPU_SETSIZE; ++processor)
            if (CPU_ISSET(processor, &allowed_) && worker-- == 0) {
                cpu_set_t own;
                CPU_ZERO(&own);
                CPU_SET(processor, &own);
                sched_setaffinity(0, sizeof own, &own);
                return;
            }
    }
    void unbind() const { sched_setaffinity(0, sizeof allowed_, &allowed_); }

private:
    cpu_set_t allowed_;
    bool known_;
};

// Where the threads take up all processors, each keeps one of its own until its binding ends: some
// kernels wake a worker on the processor of the thread that woke it and leave both there, while
// another idles. The processors are the crew's: a new thread begins with its maker's binding.
class Binding {
public:
    Binding(const Processors& processors, unsigned worker, unsigned threads)
        : processors_(processors), bound_(processors.count() == threads) {
        if (bound_)
            processors_.bind(worker);
    }
    ~Binding() {
        if (bound_)
            processors_.unbind();
    }
    Binding(const Binding&) = delete;
    Binding& operator=(const Binding&) = delete;

private:
    const Processors& processors_;
    bool bound_;
};

thread_local Team::Crew* own_crew = nullptr;

// Adds its life to the loops' time; of loops within loops only the outermost.
class LoopWatch {
public:
    LoopWatch() : outermost_(!within_) { within_ = true; }
    ~LoopWatch() {
        if (!outermost_)
            return;
        within_ = false;
        total_ += std::chrono::duration<double>(Clock::now() - start_).count();
    }
    LoopWatch(const LoopWatch&) = delete;
    LoopWatch& operator=(const LoopWatch&) = delete;

    static double total() { return total_; }

private:
    using Clock = std::chrono::steady_clock;
    static thread_local bool within_;
    static thread_local double total_;
    bool outermost_;
    Clock::time_point start_ = Clock::now();
};
thread_local bool LoopWatch::within_ = false;
thread_local double LoopWatch::total_ = 0;

}  // namespace

// Workers that take part in one loop after another. The owner publishes a loop and closes it again
// when no piece is left; a worker that comes too late finds it closed, which is harmless.
class Team::Crew {
public:
    explicit Crew(unsigned threads) : threads_(threads), binding_(processors_, 0, threads) {
#ifdef PARALLUX_STD_THREADS
        for (unsigned worker = 1; worker < threads; ++worker)
            members_.emplace_back([this, worker] { serve(worker); });
#else
        // More threads than cores, for tests, must be allowed first.
        arena_.execute([&] {
            for (unsigned worker = 1; worker < threads; ++worker)
                members_.run([this, worker] { serve(worker); });
        });
#endif
    }

    ~Crew() {
        closing_.store(true);
        call();
#ifdef PARALLUX_STD_THREADS
        for (std::thread& member : members_)
            member.join();
#else
        arena_.execute([&] { members_.wait(); });
#endif
    }

    unsigned threads() const {
        return threads_;
    }
    bool busy() const {
        return pieces_.load(std::memory_order_relaxed) != nullptr;
    }

    void run(Pieces& pieces) {
        pieces_.store(&pieces);
        call();
        pieces.work(0);
        pieces_.store(nullptr);
        while (inside_.load() != 0)
            pause();
    }

private:
    // Turns of waiting on the processor before a worker sleeps; about a millisecond.
    static constexpr int patience = 1 << 15;

    static void pause() {
#if defined(__x86_64__)
        __builtin_ia32_pause();
#else
        std::this_thread::yield();
#endif
    }

    void call() {
        calls_.fetch_add(1);
        calls_.notify_all();
    }

    void serve(unsigned worker) {
        if (closing_.load())
            return;
        Binding binding(processors_, worker, threads_);
        for (unsigned seen = 0; !closing_.load();) {
            seen = next_call(seen);
            ++inside_;
            if (Pieces* pieces = pieces_.load())
                pieces->work(worker);
            --inside_;
        }
    }

    unsigned next_call(unsigned seen) {
        for (int turn = 0; turn < patience; ++turn) {
            if (unsigned call = calls_.load(std::memory_order_acquire); call != seen)
                return call;
            pause();
        }
        calls_.wait(seen);
        return calls_.load();
    }

    unsigned threads_;
    Processors processors_;
    Binding binding_;
    std::atomic<unsigned> calls_{0};
    std::atomic<Pieces*> pieces_{nullptr};
    std::atomic<unsigned> inside_{0};
    std::atomic<bool> closing_{false};
#ifdef PARALLUX_STD_THREADS
    std::vector<std::thread> members_;
#else
    tbb::global_control allowed_{tbb::global_control::max_allowed_parallelism,
                                 std::max(threads_, std::thread::hardware_concurrency())};
    tbb::task_arena arena_{static_cast<int>(threads_)};
    tbb::task_group members_;
#endif
};

Team::Team(unsigned threads) {
    if (own_crew || thread_count(threads) == 1)
        return;
    crew_ = std::make_unique<Crew>(thread_count(threads));
    own_crew = crew_.get();
}

Team::~Team() {
    if (crew_)
        own_crew = nullptr;
}

double seconds_in_loops() {
    return LoopWatch::total();
}

void parallel_for(unsigned threads, std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t, unsigned)>& body) {
    if (count == 0)
        return;
    grain = std::max<std::size_t>(1, grain);
    const std::size_t wanted = (count - 1) / grain + 1;
    std::optional<LoopWatch> watch;
    if (wanted > 1)
        watch.emplace();
    if (wanted == 1 || thread_count(threads) == 1 || (own_crew && own_crew->busy())) {
        for (std::size_t begin = 0; begin < count; begin += grain)
            body(begin, std::min(begin + grain, count), 0);
        return;
    }
    // A loop outside a team, or of other threads than its own, brings its own workers.
    Team::Crew* crew = own_crew;
    std::unique_ptr<Team::Crew> hired;
    if (!crew || crew->threads() != thread_count(threads)) {
        hired = std::make_unique<Team::Crew>(
            static_cast<unsigned>(std::min<std::size_t>(thread_count(threads), wanted)));
        crew = hired.get();
    }
    Pieces pieces(count, grain, crew->threads(), body);
    crew->run(pieces);
    pieces.rethrow();
}

}  // namespace parallux
