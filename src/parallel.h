#pragma once

#include <cstddef>
#include <functional>
#include <memory>

// The one way to loop in parallel.

namespace parallux {

/// Threads that a request means: 0 is every core.
unsigned thread_count(unsigned requested);

/// Calls body(begin, end, worker) over [0, count) in pieces of at most `grain`; `worker` < threads,
/// and no two calls that run at once have the same. Pieces run in any order: the body's result must
/// not depend on it. The first exception a body throws is rethrown after all have ended. Within a
/// body, a further loop runs on the calling thread alone.
void parallel_for(unsigned threads, std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t, unsigned)>& body);

/// Seconds that the calling thread has spent in loops of more than one piece, however many threads
/// they had: the rest of a program's time is what no thread more would shorten.
double seconds_in_loops();

/// Keeps workers at hand for the loops of the thread that made it, while it lives: loops of a few
/// hundred microseconds would be over before sleeping workers wake. Workers wait for the next loop
/// on their processors for about a millisecond, then sleep.
class Team {
public:
    explicit Team(unsigned threads);
    ~Team();
    Team(const Team&) = delete;
    Team& operator=(const Team&) = delete;

    class Crew;

private:
    std::unique_ptr<Crew> crew_;
};

}  // namespace parallux
